// Moves four servos on a PCA9685 as the arms and legs of a walk. It needs no display and fits an Arduino Uno.
//
// For your own motion, bound each angle that a servo gets, here by 1 degree, and write a clip of segments, the kind that this program plays:
//     pantin convert walk.bvh -o walk.ptn --max-channel-error 1 --segments
// The walk.h beside this sketch was converted for displays: with a bound on places alone. Its four joints here are at most 0.6 degrees off.
#include <Adafruit_PWMServoDriver.h>
#include <PantinPlayer.h>
#include <Wire.h>

#include "walk.h"

const uint8_t SERVOS = 4;
const char *const NAMES[SERVOS] = {"left-upper-arm", "right-upper-arm", "left-thigh", "right-thigh"};

Adafruit_PWMServoDriver servos;
PantinPlayer<CLIP_WALK_CHANNELS> player;
PantinJoint joints[SERVOS];

// Where the angle about x stands among three angles, for each order from PANTIN_XYZ to PANTIN_ZYX.
const uint8_t ABOUT_X[] = {0, 0, 1, 2, 1, 2};

// Turns a servo to an angle: 1500 microseconds are its middle, 500 to 2500 are -90 to 90 degrees. Angles beyond are limited.
void turn(uint8_t servo, int16_t centidegrees) {
  servos.writeMicroseconds(servo, (uint16_t)(1500 + (int32_t)constrain(centidegrees, -9000, 9000) / 9));
}

void setup() {
  Serial.begin(115200);
  servos.begin();
  Wire.setClock(400000); // At 100 kHz, four servos would take 4 ms a frame.
  servos.setPWMFreq(50);
  if (!player.begin(CLIP_WALK, CLIP_WALK_LEN)) {
    Serial.println(F("the clip is damaged, has too many channels, or is a key clip: convert it with --segments"));
  }
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
    // A servo whose joint the clip lacks does not move. In the joint's own order the angles are the clip's.
    int16_t angles[3];
    pantin_order order = joints[i].eulerOrder();
    if (player.centidegrees(joints[i], order, angles)) turn(i, angles[ABOUT_X[order]]);
  }
}
