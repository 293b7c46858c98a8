// A face on an M5Stack Core2, CoreS3 or another board of M5Unified with a microphone: its lips follow what is said. It draws on an M5Canvas.
#include <M5Unified.h>
#include <PantinFace.h>
#include <pantin_face_data.h>

const size_t SAMPLES = 480; // 30 ms at 16 kHz

M5Canvas canvas(&M5.Display);
PantinFace face;
int16_t samples[2][SAMPLES]; // one is recorded while the other is used
uint8_t turn;

void setup() {
  M5.begin();
  Serial.begin(115200);
  canvas.setColorDepth(16);
  if (!canvas.createSprite(240, 240)) Serial.println("no memory for a picture of 240 by 240");
  if (!face.begin(pantin_cartoon, sizeof pantin_cartoon, 240, 240)) Serial.println("the model is damaged");
  face.emotes(pantin_emotes, PANTIN_EMOTES);
  if (!face.emote("listening")) Serial.println("there is no such emote");
  M5.Mic.begin();
}

void loop() {
  M5.update();
  if (M5.Mic.record(samples[turn], SAMPLES, 16000)) {
    turn ^= 1;
    face.sound(samples[turn], SAMPLES);
  }
  if (M5.BtnA.wasPressed()) face.emote("happy");
  if (!face.update(millis())) return;
  canvas.fillSprite(0);
  face.draw(canvas);
  canvas.pushSprite(0, 0);
}
