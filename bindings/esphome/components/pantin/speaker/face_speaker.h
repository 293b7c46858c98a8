#pragma once

#include <atomic>

#include "esphome/components/pantin/face.h"
#include "esphome/components/speaker/speaker.h"
#include "esphome/core/component.h"
#include "esphome/core/helpers.h"

namespace esphome::pantin {

/// A speaker that passes sound on to another one, and gives a face each sample at the time when it is played.
///
/// Other tasks may call play(); the output speaker may report what it played from its own task.
class FaceSpeaker : public Component, public speaker::Speaker, public Parented<Face> {
 public:
  void set_output_speaker(speaker::Speaker *speaker) { this->output_speaker_ = speaker; }
  /// The sound that may wait in the output speaker: the lips miss sound that waits longer.
  void set_buffer_duration(uint32_t ms) { this->buffer_ms_ = ms; }

  void setup() override;
  void loop() override;
  void dump_config() override;
  float get_setup_priority() const override { return setup_priority::DATA; }

#ifdef USE_ESP32
  size_t play(const uint8_t *data, size_t length, TickType_t ticks_to_wait) override;
#endif
  size_t play(const uint8_t *data, size_t length) override;

  void start() override;
  void stop() override;
  void finish() override;
  bool has_buffered_data() const override { return this->output_speaker_->has_buffered_data(); }

  void set_pause_state(bool pause_state) override { this->output_speaker_->set_pause_state(pause_state); }
  bool get_pause_state() const override { return this->output_speaker_->get_pause_state(); }
  void set_volume(float volume) override { this->output_speaker_->set_volume(volume); }
  float get_volume() override { return this->output_speaker_->get_volume(); }
  void set_mute_state(bool mute_state) override { this->output_speaker_->set_mute_state(mute_state); }
  bool get_mute_state() override { return this->output_speaker_->get_mute_state(); }

 protected:
  void reset_();
  uint32_t take_(int16_t *samples, uint32_t *rate);
  void keep_(const uint8_t *data, size_t length);
  int32_t mono_(const uint8_t *frame) const;

  speaker::Speaker *output_speaker_{nullptr};
  /// Samples at about 8 kHz that wait for being played: sample `i` since the start is at `i % capacity_`.
  int16_t *waiting_{nullptr};
  uint32_t capacity_{0};
  /// Since the start: samples that were written, samples that the face got, frames that were played.
  uint64_t written_{0}, read_{0}, played_{0};
  /// Frames of the stream that are one sample, and the number and the sum of those that are part of the next one.
  uint32_t frames_per_sample_{1}, frames_{0};
  int32_t sum_{0};
  /// Of the samples, in Hz.
  uint32_t rate_{16000};
  /// Protects all of the above.
  Mutex mutex_;
  /// Frames that the output speaker has played and that are not part of played_ yet.
  std::atomic<uint32_t> just_played_{0};
  uint32_t buffer_ms_{700};
};

}  // namespace esphome::pantin
