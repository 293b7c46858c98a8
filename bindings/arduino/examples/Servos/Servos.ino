// Moves four servos on a PCA9685 as the arms and legs of a walk. It needs no display and fits an Arduino Uno.
#include <Adafruit_PWMServoDriver.h>
#include <PantinPlayer.h>
#include <Wire.h>

#include "walk.h"

Adafruit_PWMServoDriver servos;
PantinPlayer<CLIP_WALK_CHANNELS> player;

// Turns a servo to an angle: 1500 microseconds are its middle, 500 to 2500 are -90 to 90 degrees.
void turn(uint8_t servo, float degrees) {
  servos.writeMicroseconds(servo, (uint16_t)(1500 + constrain(degrees, -90.0f, 90.0f) * (1000.0f / 90)));
}

void setup() {
  servos.begin();
  servos.setPWMFreq(50);
  player.begin(CLIP_WALK, CLIP_WALK_LEN);
}

void loop() {
  if (!player.update(millis())) return;
  turn(0, player.joint("left-upper-arm"));
  turn(1, player.joint("right-upper-arm"));
  turn(2, player.joint("left-thigh"));
  turn(3, player.joint("right-thigh"));
}
