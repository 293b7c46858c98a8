/* The calls of M5Unified, and of the M5GFX that it brings, which the examples use. */
#pragma once
#include <Arduino.h>
class M5GFX {
  public:
    void drawFastHLine(int32_t x, int32_t y, int32_t w, uint32_t color);
    template <typename T> void pushImage(int32_t x, int32_t y, int32_t w, int32_t h, const T *data);
};
class M5Canvas : public M5GFX {
  public:
    explicit M5Canvas(M5GFX *parent);
    void setColorDepth(int bits);
    void *createSprite(int32_t w, int32_t h);
    void fillSprite(uint32_t color);
    void pushSprite(int32_t x, int32_t y);
};
struct Button_Class {
    bool wasPressed(void) const;
    bool isPressed(void) const;
};
struct Mic_Class {
    bool begin(void);
    bool record(int16_t *samples, size_t count, uint32_t rate, bool stereo = false);
};
struct M5Unified {
    M5GFX Display;
    Mic_Class Mic;
    Button_Class BtnA, BtnB, BtnC;
    void begin(void);
    void update(void);
};
extern M5Unified M5;
