// Steers a character by two buttons on a colour display with TFT_eSPI: one held lets it walk, the other lets it jump. For an ESP32 or another 32-bit board.
#include <PantinCharacter.h>
#include <PantinSolid.h>
#include <TFT_eSPI.h>

#include "character.h" // pantin expand motions/character.ptb -o character.h

const uint8_t GO = 0, JUMP = 35; // the buttons, which connect to ground
const uint16_t WIDTH = 240, HEIGHT = 135, ROWS = 15;

TFT_eSPI tft;
PantinCharacter<BANK_CHARACTER_CHANNELS> hero;
PantinSolid<BANK_CHARACTER_CHANNELS, BANK_CHARACTER_FIGURE_JOINTS, BANK_CHARACTER_WORKSPACE> body;
PantinInput go, jump;
uint16_t rows[ROWS * WIDTH];
bool pressed;

void setup() {
  Serial.begin(115200);
  pinMode(GO, INPUT_PULLUP);
  pinMode(JUMP, INPUT_PULLUP);
  tft.init();
  tft.setRotation(1);
  if (!hero.begin(BANK_CHARACTER, BANK_CHARACTER_LEN)) Serial.println(hero.error());
  if (!body.begin(hero, WIDTH, HEIGHT)) Serial.println("the figure has no room");
  go = hero.input("go");
  jump = hero.input("jump");
  if (!go || !jump) Serial.println("the state machine has no such input");
}

void loop() {
  hero.hold(go, digitalRead(GO) == LOW);
  bool down = digitalRead(JUMP) == LOW;
  if (down && !pressed) hero.press(jump);
  pressed = down;
  if (!hero.update(millis())) return;
  body.draw(hero, tft, rows, ROWS);
  char state[24];
  if (hero.entered() && hero.stateName(state, sizeof state)) Serial.println(state);
}
