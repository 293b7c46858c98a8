// Moves four servos on a PCA9685 as the arms and legs of a walk. It needs no display and fits an Arduino Uno.
//
// Convert clips for servos with a bound on each joint's angle, here 1 degree; --max-error alone bounds distances:
//     pantin convert walk.bvh -o walk.ptn --max-joint-error 1
#include <Adafruit_PWMServoDriver.h>
#include <PantinPlayer.h>
#include <Wire.h>

#include "walk.h"

const uint8_t SERVOS = 4;
const char *const NAMES[SERVOS] = {"left-upper-arm", "right-upper-arm", "left-thigh", "right-thigh"};

Adafruit_PWMServoDriver servos;
PantinPlayer<CLIP_WALK_CHANNELS> player;
PantinJoint joints[SERVOS];

// Turns a servo to an angle: 1500 microseconds are its middle, 500 to 2500 are -90 to 90 degrees. Angles beyond are limited.
void turn(uint8_t servo, int16_t centidegrees) {
  servos.writeMicroseconds(servo, (uint16_t)(1500 + (int32_t)constrain(centidegrees, -9000, 9000) / 9));
}

void setup() {
  Serial.begin(115200);
  servos.begin();
  Wire.setClock(400000); // At 100 kHz, four servos would take 4 ms a frame.
  servos.setPWMFreq(50);
  if (!player.begin(CLIP_WALK, CLIP_WALK_LEN)) Serial.println("the clip is damaged or has too many channels");
  for (uint8_t i = 0; i < SERVOS; i++) {
    joints[i] = player.find(NAMES[i]);
    if (!joints[i]) {
      Serial.print("the clip has no joint ");
      Serial.println(NAMES[i]);
    }
  }
}

void loop() {
  if (!player.update(millis())) return;
  for (uint8_t i = 0; i < SERVOS; i++) {
    // A servo whose joint the clip lacks does not move. angles[0] is about the x axis.
    int16_t angles[3];
    if (player.centidegrees(joints[i], PANTIN_XYZ, angles)) turn(i, angles[0]);
  }
}
