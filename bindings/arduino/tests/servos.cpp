/* A driver of servos for the tests: it takes as long as a PCA9685 by I2C at 400 kHz, and prints how many times servo 0 is set in each of five seconds. */
#include <Adafruit_PWMServoDriver.h>
#include <avr/sleep.h>

enum { SECONDS = 5, MICROSECONDS = 300 };

Adafruit_PWMServoDriver::Adafruit_PWMServoDriver() {}
bool Adafruit_PWMServoDriver::begin(uint8_t) { return true; }
void Adafruit_PWMServoDriver::setPWMFreq(float) {}

void Adafruit_PWMServoDriver::writeMicroseconds(uint8_t number, uint16_t) {
    static uint32_t second = 0;
    static uint16_t frames = 0;
    static uint8_t seconds = 0;
    delayMicroseconds(MICROSECONDS);
    if (number != 0) return;
    frames++;
    if (second == 0) {
        second = millis();
        frames = 0;
    } else if (millis() - second >= 1000) {
        Serial.println(frames);
        second += 1000;
        frames = 0;
        if (++seconds == SECONDS) {
            Serial.flush();
            cli();
            sleep_enable();
            sleep_cpu();
        }
    }
}
