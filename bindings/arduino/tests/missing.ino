/* Asks for joints and scalars that a clip has and lacks, prints what is wrong, then "done", and ends. */
#include <PantinPlayer.h>
#include <avr/sleep.h>

#include "hello.h"

PantinPlayer<CLIP_HELLO_CHANNELS> player;

static void expect(bool held, const char *what) {
    if (held) return;
    Serial.print("wrong: ");
    Serial.println(what);
}

void setup() {
    float value = 7, degrees[3] = {7, 7, 7};
    int16_t angles[3];
    int32_t raw[9];
    Serial.begin(115200);
    expect(!player.scalar("viseme_o", value) && value == 7, "a scalar before a clip");
    expect(player.begin(CLIP_HELLO, CLIP_HELLO_LEN), "begin");
    expect(!player.scalar("nothing", value) && value == 7, "a scalar that is missing");
    expect(player.scalar("viseme_o", value) && value > -0.05 && value < 1, "a scalar that is there");
    PantinJoint joint = player.find("nobody");
    expect(!joint, "a joint that is missing");
    expect(!player.euler(joint, PANTIN_XYZ, degrees) && degrees[0] == 7, "its angles");
    expect(!player.centidegrees(joint, PANTIN_XYZ, angles) && !player.rawValue(joint, 0, raw[0]), "its other angles");
    int32_t quaternion[4];
    expect(!player.quaternion(joint, quaternion) && !player.matrix(joint, raw), "its quaternion and matrix");
    Serial.println("done");
    Serial.flush();
    cli();
    sleep_enable();
    sleep_cpu();
}

void loop() {}
