/* Moves the section of program memory away before the program begins, and overwrites it: see pgmspace.h. */
#define _DEFAULT_SOURCE
#include "pgmspace.h"

#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

extern const uint8_t __start_flash[], __stop_flash[];
static uint8_t *copy;

__attribute__((constructor)) static void move(void) {
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), from = (uintptr_t)__start_flash / page * page;
    size_t length = (uintptr_t)__stop_flash - (uintptr_t)__start_flash;
    copy = (uint8_t *)malloc(length);
    if (!copy || mprotect((void *)from, (uintptr_t)__stop_flash - from, PROT_READ | PROT_WRITE) != 0) abort();
    memcpy(copy, __start_flash, length);
    memset((void *)(uintptr_t)__start_flash, 0xa5, length);
}

/* Models that a test reads from a file are elsewhere. */
const void *moved_flash(const void *address) {
    uintptr_t at = (uintptr_t)address;
    return at >= (uintptr_t)__start_flash && at < (uintptr_t)__stop_flash ? copy + (at - (uintptr_t)__start_flash) : address;
}
