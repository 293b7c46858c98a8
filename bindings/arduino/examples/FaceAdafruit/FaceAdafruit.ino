// A face on an SSD1306 OLED (128x64, I2C) with Adafruit_GFX. A line over the serial port is an emote: happy, sad, sleepy.
#include <Adafruit_GFX.h>
#include <Adafruit_SSD1306.h>
#include <PantinFace.h>
#include <Wire.h>
#include <pantin_face_data.h>

Adafruit_SSD1306 display(128, 64, &Wire, -1);
PantinFace face;

void setup() {
  Serial.begin(115200);
  display.begin(SSD1306_SWITCHCAPVCC, 0x3C);
  if (!face.begin(pantin_cartoon, sizeof pantin_cartoon, 128, 64)) Serial.println("the model is damaged");
  face.emotes(pantin_emotes, PANTIN_EMOTES);
}

void loop() {
  if (Serial.available()) {
    String name = Serial.readStringUntil('\n');
    name.trim();
    if (!face.emote(name.c_str())) Serial.println("there is no such emote");
  }
  if (!face.update(millis())) return;
  display.clearDisplay();
  face.drawLit(display);
  display.display();
}
