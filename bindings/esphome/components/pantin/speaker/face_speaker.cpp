#include "face_speaker.h"

#include <algorithm>
#include <cinttypes>

#include "esphome/core/log.h"

namespace esphome::pantin {

static const char *const TAG = "pantin.speaker";

/// The least rate of the samples that wait: lips are found in sound of 8 kHz.
static const uint32_t LEAST_RATE = 8000;
/// The greatest rate of those samples, with sound of 11.025, 12, 22.05, 24 or 44.1 kHz. Sound of 12 to 16 kHz makes buffer_duration shorter.
static const uint32_t GREATEST_RATE = 12000;
/// Samples that the face gets at a time.
static const uint32_t CHUNK = 128;

void FaceSpeaker::setup() {
  this->capacity_ = this->buffer_ms_ * GREATEST_RATE / 1000;
  this->waiting_ = RAMAllocator<int16_t>().allocate(this->capacity_);
  if (this->waiting_ == nullptr) {
    this->mark_failed(LOG_STR("There is not enough memory for buffer_duration"));
    return;
  }
  this->output_speaker_->add_audio_output_callback([this](uint32_t frames, int64_t timestamp) {
    this->just_played_.fetch_add(frames, std::memory_order_relaxed);
    this->audio_output_callback_.call(frames, timestamp);
  });
}

void FaceSpeaker::dump_config() {
  ESP_LOGCONFIG(TAG,
                "Speaker of a face:\n"
                "  Buffer: %" PRIu32 " ms",
                this->buffer_ms_);
}

void FaceSpeaker::loop() {
  if (this->output_speaker_->is_stopped()) {
    this->state_ = speaker::STATE_STOPPED;
  } else if (this->state_ == speaker::STATE_STARTING && this->output_speaker_->is_running()) {
    this->state_ = speaker::STATE_RUNNING;
  }
  int16_t samples[CHUNK];
  uint32_t rate;
  while (const uint32_t count = this->take_(samples, &rate)) {
    if (this->parent_->set_sound_rate(rate))
      this->parent_->push_pcm(samples, count);
  }
}

/// Takes samples that were played. Returns how many, at most CHUNK.
uint32_t FaceSpeaker::take_(int16_t *samples, uint32_t *rate) {
  LockGuard lock(this->mutex_);
  this->played_ += this->just_played_.exchange(0, std::memory_order_relaxed);
  if (this->written_ > this->read_ + this->capacity_)
    this->read_ = this->written_ - this->capacity_;
  // After a stop, the output speaker may still report sound of before.
  this->played_ = std::min(this->played_, (this->written_ + 1) * this->frames_per_sample_ - 1);
  const uint64_t end = this->played_ / this->frames_per_sample_;
  uint32_t count = 0;
  for (; this->read_ < end && count < CHUNK; this->read_++)
    samples[count++] = this->waiting_[this->read_ % this->capacity_];
  *rate = this->rate_;
  return count;
}

/// Drops what waits, and prepares for sound in the format of the stream.
void FaceSpeaker::reset_() {
  const uint32_t rate = this->audio_stream_info_.get_sample_rate();
  LockGuard lock(this->mutex_);
  this->frames_per_sample_ = std::max<uint32_t>(1, rate / LEAST_RATE);
  this->rate_ = rate / this->frames_per_sample_;
  this->written_ = this->read_ = this->played_ = 0;
  this->frames_ = 0;
  this->sum_ = 0;
  this->just_played_.store(0, std::memory_order_relaxed);
}

void FaceSpeaker::start() {
  if (this->output_speaker_->is_stopped()) {
    // It plays sound in the format in which it comes.
    this->output_speaker_->set_audio_stream_info(this->audio_stream_info_);
    this->reset_();
  }
  this->state_ = speaker::STATE_STARTING;
  this->output_speaker_->start();
}

void FaceSpeaker::stop() {
  this->state_ = speaker::STATE_STOPPING;
  this->output_speaker_->stop();
  this->reset_();
}

void FaceSpeaker::finish() {
  this->state_ = speaker::STATE_STOPPING;
  this->output_speaker_->finish();
}

size_t FaceSpeaker::play(const uint8_t *data, size_t length) {
  if (this->is_stopped())
    this->start();
  const size_t taken = this->output_speaker_->play(data, length);
  this->keep_(data, taken);
  return taken;
}

#ifdef USE_ESP32
size_t FaceSpeaker::play(const uint8_t *data, size_t length, TickType_t ticks_to_wait) {
  if (this->is_stopped())
    this->start();
  const size_t taken = this->output_speaker_->play(data, length, ticks_to_wait);
  this->keep_(data, taken);
  return taken;
}
#endif

/// The mean of the channels of a frame, in 16 bits.
int32_t FaceSpeaker::mono_(const uint8_t *frame) const {
  const size_t channels = this->audio_stream_info_.get_channels();
  const size_t bytes = this->audio_stream_info_.samples_to_bytes(1);
  int32_t sum = 0;
  for (size_t i = 0; i < channels; i++) {
    // Samples are little-endian: the last two bytes are the highest.
    const uint8_t *high = frame + (i + 1) * bytes - 2;
    sum += static_cast<int16_t>(high[0] | high[1] << 8);
  }
  return sum / static_cast<int32_t>(channels);
}

/// Keeps what the output speaker took until it is played. If there is more than buffer_duration, the lips miss the oldest.
void FaceSpeaker::keep_(const uint8_t *data, size_t length) {
  if (this->waiting_ == nullptr || this->audio_stream_info_.get_bits_per_sample() < 16)
    return;
  const size_t frame_bytes = this->audio_stream_info_.frames_to_bytes(1);
  LockGuard lock(this->mutex_);
  for (; length >= frame_bytes; data += frame_bytes, length -= frame_bytes) {
    this->sum_ += this->mono_(data);
    if (++this->frames_ < this->frames_per_sample_)
      continue;
    this->waiting_[this->written_++ % this->capacity_] = this->sum_ / static_cast<int32_t>(this->frames_per_sample_);
    this->frames_ = 0;
    this->sum_ = 0;
  }
}

}  // namespace esphome::pantin
