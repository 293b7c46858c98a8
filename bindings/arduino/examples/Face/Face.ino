// Moves a simple face on an SSD1306 OLED by the scalar channels of a clip: a mouth that says "hello".
#include <Adafruit_GFX.h>
#include <Adafruit_SSD1306.h>
#include <PantinPlayer.h>
#include <Wire.h>

#include "hello.h"

Adafruit_SSD1306 display(128, 64, &Wire, -1);
PantinPlayer<CLIP_HELLO_CHANNELS> player;

void setup() {
  Serial.begin(115200);
  display.begin(SSD1306_SWITCHCAPVCC, 0x3C);
  player.begin(CLIP_HELLO, CLIP_HELLO_LEN);
}

// The value of a scalar: a clip that lacks it leaves that part of the mouth at rest, and says so.
float value(const char *name) {
  float value = 0;
  if (!player.scalar(name, value)) {
    Serial.print("the clip has no scalar ");
    Serial.println(name);
  }
  return value;
}

void loop() {
  if (!player.update(millis())) return;
  float wide = value("viseme_e"), round = value("viseme_o"), open = value("viseme_nn") / 3;
  if (round > open) open = round;
  if (wide / 2 > open) open = wide / 2;
  int16_t width = (int16_t)(24 + 16 * wide - 10 * round), height = (int16_t)(2 + 18 * open);
  display.clearDisplay();
  display.fillCircle(44, 22, 5, 1);
  display.fillCircle(84, 22, 5, 1);
  display.drawRoundRect(64 - width / 2, 48 - height / 2, width, height, height / 2, 1);
  display.display();
}
