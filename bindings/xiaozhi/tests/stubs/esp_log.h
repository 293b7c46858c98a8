/* The log of ESP-IDF: lines go to standard error, and the last one is kept. */
#pragma once

#include <cstdio>

inline char log_line[256];
inline int log_lines;

#define ESP_LOG_TO(level, tag, ...)                          \
    do {                                                     \
        snprintf(log_line, sizeof log_line, __VA_ARGS__);    \
        log_lines++;                                         \
        fprintf(stderr, "%s %s: %s\n", level, tag, log_line); \
    } while (0)
#define ESP_LOGE(tag, ...) ESP_LOG_TO("E", tag, __VA_ARGS__)
#define ESP_LOGW(tag, ...) ESP_LOG_TO("W", tag, __VA_ARGS__)
