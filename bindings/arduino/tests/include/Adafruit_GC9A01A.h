/* The calls of Adafruit_GC9A01A that the examples use. */
#pragma once
#include <Adafruit_GFX.h>
class Adafruit_GC9A01A : public Adafruit_GFX {
  public:
    Adafruit_GC9A01A(int8_t cs, int8_t dc, int8_t rst = -1);
    void begin(uint32_t frequency = 0);
    void drawPixel(int16_t x, int16_t y, uint16_t color) override;
};
