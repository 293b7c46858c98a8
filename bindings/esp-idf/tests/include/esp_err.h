/* What the component and its examples use of ESP-IDF 5.3 to 5.5, for tests on this machine. Its own headers have more. */
#pragma once
#include <stdint.h>
typedef int esp_err_t;
#define ESP_OK 0
#define ESP_ERR_NO_MEM 0x101
#define ESP_ERR_INVALID_ARG 0x102
#define ESP_ERR_INVALID_STATE 0x103
#define ESP_ERR_INVALID_SIZE 0x104
void test_failed(const char *what);
#define ESP_ERROR_CHECK(call) \
    do { \
        if ((call) != ESP_OK) test_failed(#call); \
    } while (0)
