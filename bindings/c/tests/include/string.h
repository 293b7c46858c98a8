/* What the decoder needs of string.h, for a compiler without a C library. */
#ifndef PANTIN_TEST_STRING_H
#define PANTIN_TEST_STRING_H
#include <stddef.h>
void *memcpy(void *to, const void *from, size_t count);
void *memmove(void *to, const void *from, size_t count);
void *memset(void *to, int byte, size_t count);
int memcmp(const void *a, const void *b, size_t count);
int strcmp(const char *a, const char *b);
size_t strlen(const char *text);
#endif
