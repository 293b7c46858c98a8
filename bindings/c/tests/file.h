/* Reads the files of the tests. */
#ifndef PANTIN_TEST_FILE_H
#define PANTIN_TEST_FILE_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Reads a file to its end, or ends the program: not every C library of an emulated board can seek. */
static uint8_t *file(const char *path, uint32_t *length) {
    FILE *f = fopen(path, "rb");
    uint8_t *bytes = NULL;
    int byte;
    *length = 0;
    if (!f) exit(2);
    while ((byte = getc(f)) != EOF) {
        if (*length % 1024 == 0) bytes = (uint8_t *)realloc(bytes, *length + 1024);
        if (!bytes) exit(2);
        bytes[(*length)++] = (uint8_t)byte;
    }
    fclose(f);
    /* Of the right size, so that a sanitizer notices what is read past its end. */
    return (uint8_t *)realloc(bytes, *length ? *length : 1);
}

#endif
