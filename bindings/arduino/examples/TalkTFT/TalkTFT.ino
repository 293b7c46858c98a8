// A face on a colour display (TFT_eSPI) that speaks: it shows an emote, and its lips follow the sound that is played.
#include <PantinFace.h>
#include <TFT_eSPI.h>
#include <pantin_face_data.h>

TFT_eSPI tft;
TFT_eSprite sprite(&tft);
PantinFace face;

// A tone that comes and goes, in place of speech: give these samples to I2S as well, or take those of a microphone.
int16_t samples[480];
uint32_t played, until;

// All sound that is due: 16 samples a millisecond.
void speak(uint32_t now) {
  while (now != until) {
    uint32_t ms = now - until < 30 ? now - until : 30;
    for (size_t i = 0; i < 16 * ms; i++, played++) {
      bool loud = played / 4000 % 2 != 0;
      samples[i] = loud ? (played * 700 % 16000 < 8000 ? 6000 : -6000) : 0;
    }
    face.sound(samples, 16 * ms);
    until += ms;
  }
}

void setup() {
  Serial.begin(115200);
  tft.init();
  sprite.setColorDepth(16);
  if (!sprite.createSprite(240, 240)) Serial.println("no memory for a picture of 240 by 240");
  if (!face.begin(pantin_cartoon, sizeof pantin_cartoon, 240, 240)) Serial.println("the model is damaged");
  face.emotes(pantin_emotes, PANTIN_EMOTES);
  if (!face.emote("happy")) Serial.println("there is no such emote");
  until = millis();
}

void loop() {
  uint32_t now = millis();
  speak(now);
  if (!face.update(now)) return;
  sprite.fillSprite(TFT_BLACK);
  face.draw(sprite);
  sprite.pushSprite(0, 0);
}
