// A face on an SSD1306 OLED (128x64, I2C) with U8g2: each emote in turn, for 3 s. For an ESP8266, an ESP32 or another 32-bit board.
#include <PantinFace.h>
#include <U8g2lib.h>
#include <Wire.h>
#include <pantin_face_data.h>

U8G2_SSD1306_128X64_NONAME_1_HW_I2C display(U8G2_R0);
PantinFace face;
uint32_t next;
uint16_t emote;

void setup() {
  Serial.begin(115200);
  display.begin();
  if (!face.begin(pantin_cartoon, sizeof pantin_cartoon, 128, 64)) Serial.println("the model is damaged");
  face.emotes(pantin_emotes, PANTIN_EMOTES);
}

void loop() {
  if (millis() >= next) {
    face.emote(pantin_emotes[emote].name);
    emote = (emote + 1) % PANTIN_EMOTES;
    next = millis() + 3000;
  }
  if (!face.update(millis())) return;
  display.firstPage();
  do face.drawLit(display);
  while (display.nextPage());
}
