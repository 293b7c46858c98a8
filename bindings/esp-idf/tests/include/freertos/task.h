#pragma once
#include "freertos/FreeRTOS.h"
void vTaskDelay(TickType_t ticks);
TickType_t xTaskGetTickCount(void);
int xTaskDelayUntil(TickType_t *previous, TickType_t ticks);
