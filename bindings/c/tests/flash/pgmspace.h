/* Program memory of an ESP8266: for its compiler a section of its own, which is measured; on this machine a section whose bytes flash.c takes away, so that
 * what is not read by these functions is wrong. */
#ifndef PANTIN_TEST_PGMSPACE_H
#define PANTIN_TEST_PGMSPACE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __XTENSA__
#define PROGMEM __attribute__((section(".irom.text.pantin")))
#define pgm_read_dword(address) (*(const uint32_t *)(address))
#define pgm_read_word(address) ((uint16_t)(*(const uint32_t *)((uintptr_t)(address) & ~(uintptr_t)3) >> ((uintptr_t)(address) & 2) * 8))
#define pgm_read_byte(address) ((uint8_t)(*(const uint32_t *)((uintptr_t)(address) & ~(uintptr_t)3) >> ((uintptr_t)(address) & 3) * 8))
void *memcpy_P(void *to, const void *from, size_t count);
#else
#define PROGMEM __attribute__((section("flash")))
const void *moved_flash(const void *address);
#define pgm_read_dword(address) (*(const uint32_t *)moved_flash(address))
#define pgm_read_word(address) (*(const uint16_t *)moved_flash(address))
#define pgm_read_byte(address) (*(const uint8_t *)moved_flash(address))
#define memcpy_P(to, from, count) memcpy(to, moved_flash(from), count)
#endif

#endif
