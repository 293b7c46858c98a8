// Plays a clip while it arrives over the serial port, and prints the first channel of each frame:
//   cat walk.ptn > /dev/ttyUSB0
// At most 2 KB are kept: the clip's rig and a window of its motion. For boards with 8 KB of RAM or more.
#include <pantin.h>

static uint8_t memory[2048];
static int32_t pose[64];
static pantin_channel moving[64];
static pantin_stream stream;
static pantin_player player;
static bool started;

void setup() {
  Serial.begin(115200);
  pantin_open_stream(&stream, memory, sizeof memory, NULL);
}

// Shows the next frame if its bytes have arrived.
void show() {
  pantin_result result;
  if (!started) {
    result = pantin_start(&player, &stream.clip, pose, 64, moving, 64);
    started = true;
  } else if (!player.started) {
    result = pantin_continue(&player);
  } else {
    result = pantin_step(&player);
  }
  if (result == PANTIN_OK) Serial.println(pose[0]);
}

void loop() {
  static uint8_t byte;
  static bool waiting;
  if (!waiting && Serial.available() > 0) {
    byte = (uint8_t)Serial.read();
    waiting = true;
  }
  // A byte for which there is no room yet is pushed again after the next frame.
  if (waiting && pantin_push(&stream, &byte, 1) == 1) waiting = false;
  if (stream.opened) show();
}
