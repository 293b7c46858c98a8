// Shows a walking figure on a colour display with TFT_eSPI, through a sprite so that it does not flicker.
#include <PantinPlayer.h>
#include <TFT_eSPI.h>

#include "walk.h"

TFT_eSPI tft;
TFT_eSprite sprite(&tft);
PantinFigure<CLIP_WALK_CHANNELS, CLIP_WALK_FIGURE_JOINTS, CLIP_WALK_WORKSPACE> figure;

void setup() {
  tft.init();
  sprite.setColorDepth(8);
  sprite.createSprite(160, 128);
  figure.begin(CLIP_WALK, CLIP_WALK_LEN, 160, 128);
}

void loop() {
  if (!figure.update(millis())) return;
  sprite.fillSprite(TFT_BLACK);
  figure.draw(sprite, TFT_WHITE);
  sprite.pushSprite(0, 0);
}
