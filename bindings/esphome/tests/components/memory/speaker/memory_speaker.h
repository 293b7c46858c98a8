#pragma once

#include "esphome/components/speaker/speaker.h"
#include "esphome/core/component.h"

namespace esphome::memory {

/// Takes sound, and says that it plays it when the test tells it to.
class MemorySpeaker : public Component, public speaker::Speaker {
 public:
  size_t play(const uint8_t *data, size_t length) override {
    if (this->state_ != speaker::STATE_RUNNING)
      return 0;
    this->waiting += this->audio_stream_info_.bytes_to_frames(length);
    return length;
  }
  void start() override { this->state_ = speaker::STATE_RUNNING; }
  void stop() override { this->state_ = speaker::STATE_STOPPED; }
  bool has_buffered_data() const override { return this->waiting > 0; }

  /// Plays sound that waits, at most `frames`.
  void advance(uint32_t frames) {
    const uint32_t played = frames < this->waiting ? frames : this->waiting;
    this->waiting -= played;
    this->audio_output_callback_.call(played, 0);
  }

  uint32_t waiting{0};
};

}  // namespace esphome::memory
