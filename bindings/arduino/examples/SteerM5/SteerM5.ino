// Steers a character on an M5Stack Core (Basic, Gray, Fire, Core2, CoreS3): button A held lets it walk, B lets it jump, C lets it dance. It draws on M5Unified's display.
#include <M5Unified.h>
#include <PantinCharacter.h>
#include <PantinSolid.h>

#include "character.h" // pantin expand motions/character.ptb -o character.h

const uint16_t WIDTH = 320, HEIGHT = 240, ROWS = 16;

PantinCharacter<BANK_CHARACTER_CHANNELS> hero;
PantinSolid<BANK_CHARACTER_CHANNELS, BANK_CHARACTER_FIGURE_JOINTS, BANK_CHARACTER_WORKSPACE> body;
PantinInput go, jump, dance;
uint16_t rows[ROWS * WIDTH];

void setup() {
  M5.begin();
  Serial.begin(115200);
  if (!hero.begin(BANK_CHARACTER, BANK_CHARACTER_LEN)) Serial.println(hero.error());
  if (!body.begin(hero, WIDTH, HEIGHT)) Serial.println("the figure has no room");
  go = hero.input("go");
  jump = hero.input("jump");
  dance = hero.input("dance");
  if (!go || !jump || !dance) Serial.println("the state machine has no such input");
}

void loop() {
  M5.update();
  hero.hold(go, M5.BtnA.isPressed());
  hero.hold(dance, M5.BtnC.isPressed());
  if (M5.BtnB.wasPressed()) hero.press(jump);
  if (hero.update(millis())) body.draw(hero, M5.Display, rows, ROWS);
}
