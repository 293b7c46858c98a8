/* Checksums of pictures in all formats. */
#ifndef PANTIN_TEST_ROWS_H
#define PANTIN_TEST_ROWS_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "pantin.h"
#include "pantin_format.h"

enum { BAND = 13 };

static void need(int held, const char *what) {
    if (held) return;
    printf("failed: %s\n", what);
    exit(1);
}

static uint32_t fold(uint32_t hash, const uint8_t *bytes, size_t count) {
    while (count-- > 0) hash = (hash ^ *bytes++) * 0x01000193u;
    return hash;
}

/* The checksum of a picture in all formats, drawn in bands of rows. Each band is memory of its own, so that a sanitizer notices what is written
 * beyond it. */
static uint32_t checksum(pantin_result (*draw)(int format, void *rows, size_t stride, uint16_t y0, uint16_t y1), uint16_t width, uint16_t height) {
    uint32_t hash = 0x811c9dc5u;
    int format;
    uint16_t y, next;
    for (format = PANTIN_I1; format <= PANTIN_RGB565_SWAPPED; format++) {
        size_t stride = format < PANTIN_L8 ? (width + 7u) / 8 : format == PANTIN_L8 ? width : width * 2u;
        for (y = 0; y < height; y = next) {
            uint8_t *rows;
            next = (uint16_t)(y + BAND < height ? y + BAND : height);
            rows = (uint8_t *)malloc((next - y) * stride);
            need(rows != NULL, "memory");
            need(draw(format, rows, stride, y, next) == PANTIN_OK, "draw");
            /* Bits past the last column are not part of the picture. */
            if (format < PANTIN_L8 && width % 8) {
                size_t row;
                for (row = 0; row < (size_t)(next - y); row++) {
                    rows[(row + 1) * stride - 1] &= (uint8_t)(format == PANTIN_I1 ? 0xff00 >> (width % 8) : 0xff >> (8 - width % 8));
                }
            }
            hash = fold(hash, rows, (next - y) * stride);
            free(rows);
        }
    }
    return hash;
}

#endif
