/* The calls of Adafruit_PWMServoDriver that the examples use. */
#pragma once
#include <Arduino.h>
class Adafruit_PWMServoDriver {
  public:
    Adafruit_PWMServoDriver();
    bool begin(uint8_t prescale = 0);
    void setPWMFreq(float frequency);
    void writeMicroseconds(uint8_t number, uint16_t microseconds);
};
