/* The calls of TFT_eSPI that the examples use. */
#pragma once
#include <Arduino.h>
#define TFT_BLACK 0x0000
#define TFT_WHITE 0xFFFF
class TFT_eSPI {
  public:
    void init(uint8_t tc = 0);
    void setRotation(uint8_t rotation);
    void pushImage(int32_t x, int32_t y, int32_t w, int32_t h, uint16_t *data);
    void pushImage(int32_t x, int32_t y, int32_t w, int32_t h, const uint16_t *data);
    virtual void drawPixel(int32_t x, int32_t y, uint32_t color);
    virtual void drawLine(int32_t xs, int32_t ys, int32_t xe, int32_t ye, uint32_t color);
    virtual void drawFastHLine(int32_t x, int32_t y, int32_t w, uint32_t color);
    void fillCircle(int32_t x, int32_t y, int32_t r, uint32_t color);
};
class TFT_eSprite : public TFT_eSPI {
  public:
    explicit TFT_eSprite(TFT_eSPI *tft);
    void *createSprite(int16_t width, int16_t height, uint8_t frames = 1);
    void *setColorDepth(int8_t bits);
    void fillSprite(uint32_t color);
    void pushSprite(int32_t x, int32_t y);
};
