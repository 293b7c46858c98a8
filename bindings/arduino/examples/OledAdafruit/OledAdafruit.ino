// Shows a walking figure on an SSD1306 OLED (128x64, I2C) with Adafruit_GFX. The display's own memory takes 1 KB of RAM.
#include <Adafruit_GFX.h>
#include <Adafruit_SSD1306.h>
#include <PantinPlayer.h>
#include <Wire.h>

#include "walk.h"

Adafruit_SSD1306 display(128, 64, &Wire, -1);
PantinFigure<CLIP_WALK_CHANNELS, CLIP_WALK_FIGURE_JOINTS, CLIP_WALK_WORKSPACE> figure;

void setup() {
  display.begin(SSD1306_SWITCHCAPVCC, 0x3C);
  figure.begin(CLIP_WALK, CLIP_WALK_LEN, 128, 64);
}

void loop() {
  if (!figure.update(millis())) return;
  display.clearDisplay();
  figure.draw(display);
  display.display();
}
