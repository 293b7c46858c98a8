/* A file in memory whose reads can be made to fail, for programs of one source file. */
#ifndef FAILING_H
#define FAILING_H

#include <stdint.h>
#include <string.h>

static const uint8_t *bytes;
static uint32_t length, reads, first_failing, last_failing;

static int read_bytes(void *context, uint32_t position, uint8_t *into, uint16_t count) {
    (void)context;
    reads++;
    memset(into, 0xee, count);
    if (reads >= first_failing && reads <= last_failing) return 1;
    memcpy(into, bytes + position, count);
    return 0;
}

/* The next call's reads `from` to `to` fail; none for 0. */
static void let_fail(uint32_t from, uint32_t to) {
    reads = 0;
    first_failing = from;
    last_failing = to;
}

#endif
