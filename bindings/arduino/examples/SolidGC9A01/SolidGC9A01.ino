// Shows a walking figure with volume on a round GC9A01 display (240x240, SPI) with Adafruit_GFX. For an ESP32, an RP2040 or another 32-bit board.
#include <Adafruit_GC9A01A.h>
#include <PantinSolid.h>

#include "cat.h"
#include "walk.h"

const uint16_t ROWS = 16; // drawn at a time: 7.5 KB of RAM

Adafruit_GC9A01A display(5, 16, 17); // CS, DC, RST
PantinPlayer<CLIP_WALK_CHANNELS> player;
PantinSolid<CLIP_WALK_CHANNELS, CLIP_WALK_FIGURE_JOINTS, CLIP_WALK_WORKSPACE> body;
uint16_t rows[ROWS * 240];

void setup() {
  Serial.begin(115200);
  display.begin();
  body.look(LOOK_CAT, LOOK_CAT_LEN);
  if (!player.begin(CLIP_WALK, CLIP_WALK_LEN)) {
    Serial.println("the clip is damaged, has too many channels, or is a key clip: convert it with --segments");
  }
  if (!body.begin(player, 240, 240)) Serial.println("the figure has no room");
}

void loop() {
  if (player.update(millis())) body.draw(player, display, rows, ROWS);
}
