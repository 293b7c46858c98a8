/* The calls of U8g2 that the examples use. */
#pragma once
#include <Arduino.h>
typedef uint16_t u8g2_uint_t;
struct u8g2_cb_t {};
extern const u8g2_cb_t u8g2_cb_r0;
#define U8G2_R0 (&u8g2_cb_r0)
#define U8X8_PIN_NONE 255
class U8G2 {
  public:
    bool begin(void);
    void firstPage(void);
    uint8_t nextPage(void);
    void drawPixel(u8g2_uint_t x, u8g2_uint_t y);
    void drawLine(u8g2_uint_t x1, u8g2_uint_t y1, u8g2_uint_t x2, u8g2_uint_t y2);
    void setDrawColor(uint8_t color);
    void drawHLine(u8g2_uint_t x, u8g2_uint_t y, u8g2_uint_t w);
    void drawDisc(u8g2_uint_t x0, u8g2_uint_t y0, u8g2_uint_t rad, uint8_t opt = 15);
};
class U8G2_SSD1306_128X64_NONAME_1_HW_I2C : public U8G2 {
  public:
    U8G2_SSD1306_128X64_NONAME_1_HW_I2C(const u8g2_cb_t *rotation, uint8_t reset = U8X8_PIN_NONE);
};
