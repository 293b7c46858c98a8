// Shows a walking figure on an SSD1306 OLED (128x64, I2C) with U8g2, page by page: little RAM for the display.
#include <PantinPlayer.h>
#include <U8g2lib.h>
#include <Wire.h>

#include "walk.h"

U8G2_SSD1306_128X64_NONAME_1_HW_I2C display(U8G2_R0);
PantinFigure<CLIP_WALK_CHANNELS, CLIP_WALK_FIGURE_JOINTS, CLIP_WALK_WORKSPACE> figure;

void setup() {
  display.begin();
  figure.begin(CLIP_WALK, CLIP_WALK_LEN, 128, 64);
}

void loop() {
  if (!figure.update(millis())) return;
  display.firstPage();
  do figure.draw(display);
  while (display.nextPage());
}
