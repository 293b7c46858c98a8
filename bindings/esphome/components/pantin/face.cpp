#include "face.h"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <new>

#include "esphome/core/application.h"
#include "esphome/core/helpers.h"
#include "esphome/core/log.h"

#include "pantin_face_data.h"

namespace esphome::pantin {

static const char *const TAG = "pantin";

/// Milliseconds from picture to picture.
static const uint32_t PERIOD_MS = 33;
/// A longer pause, for example while the firmware is updated, counts as one period.
static const uint32_t LONGEST_MS = 1000;
/// Rows that are drawn at a time.
static const uint16_t ROWS = 16;
/// Of the sound, without a call of set_sound_rate().
static const uint32_t RATE = 16000;
/// Of the checksum FNV-1a, which takes pixels here in place of bytes.
static const uint32_t FNV_BASIS = 2166136261;
static const uint32_t FNV_PRIME = 16777619;

void Face::setup() {
  this->buffer_.reset(new (std::nothrow) uint16_t[static_cast<size_t>(this->width_) * std::min(ROWS, this->height_)]);
  if (this->buffer_ == nullptr) {
    this->mark_failed(LOG_STR("There is not enough memory for 16 rows of the face"));
    return;
  }
  if (pantin_face_open(&this->face_, this->model_, this->length_, this->memory_, sizeof this->memory_) != PANTIN_OK ||
      pantin_face_size(&this->face_, this->width_, this->height_) != PANTIN_OK) {
    this->mark_failed(LOG_STR("The model of the face is damaged"));
    return;
  }
  pantin_face_emotes(&this->face_, pantin_emotes, PANTIN_EMOTES);
  pantin_face_live(&this->face_, random_uint32() | 1);
  if (this->talk_.rate == 0)
    pantin_talk_open(&this->talk_, RATE);
  this->emote(this->initial_emote_);
  pantin_face_transition(&this->face_, this->transition_ms_);
  if (this->display_ != nullptr)
    this->sent_.resize((this->height_ + ROWS - 1) / ROWS);
}

void Face::loop() {
  const uint32_t now = App.get_loop_component_start_time();
  const uint32_t elapsed = now - this->last_ms_;
  if (elapsed < PERIOD_MS)
    return;
  this->last_ms_ = now;
  const uint16_t ms = elapsed > LONGEST_MS ? PERIOD_MS : elapsed;
  pantin_talk_step(&this->talk_, ms);
  for (uint8_t i = 1; i <= PANTIN_TALK_VISEMES; i++)
    pantin_face_viseme(&this->face_, i, this->talk_.weights[i - 1]);
  pantin_face_speaking(&this->face_, this->opened_by_level_ ? PANTIN_FACE_FULL : this->talk_.speaking);
  pantin_face_step(&this->face_, ms);
  if (this->display_ != nullptr)
    this->draw_changes_();
}

void Face::dump_config() {
  ESP_LOGCONFIG(TAG,
                "Face:\n"
                "  Size: %ux%u\n"
                "  Model: %" PRIu32 " bytes",
                this->width_, this->height_, this->length_);
  if (this->display_ != nullptr) {
    ESP_LOGCONFIG(TAG, "  Draws itself at %d, %d", this->x_, this->y_);
  }
}

bool Face::emote(const std::string &name) {
  const pantin_result result = pantin_face_emote(&this->face_, name.c_str());
  if (result == PANTIN_NOT_FOUND) {
    ESP_LOGW(TAG, "There is no emote '%s'", name.c_str());
  }
  return result == PANTIN_OK;
}

void Face::level(float level) {
  const int32_t opened = static_cast<int32_t>(clamp(level, 0.0f, 1.0f) * PANTIN_FACE_FULL);
  this->opened_by_level_ = opened > 0;
  pantin_face_mouth(&this->face_, opened);
}

void Face::look(float x, float y) {
  const float full = PANTIN_FACE_FULL;
  pantin_face_look(&this->face_, static_cast<int32_t>(clamp(x, -1.0f, 1.0f) * full),
                   static_cast<int32_t>(clamp(y, -1.0f, 1.0f) * full));
}

bool Face::set_sound_rate(uint32_t rate) {
  if (this->talk_.rate == rate)
    return true;
  pantin_talk other;
  if (pantin_talk_open(&other, rate) != PANTIN_OK)
    return false;
  this->talk_ = other;
  return true;
}

uint16_t Face::end_(uint16_t first) const { return std::min<uint32_t>(first + ROWS, this->height_); }

/// Draws a band of rows into the buffer. Returns false if the face has failed.
bool Face::rows_(pantin_format format, size_t stride, uint16_t first) {
  return pantin_face_draw(&this->face_, format, this->buffer_.get(), stride, first, this->end_(first)) == PANTIN_OK;
}

void Face::draw(display::Display &it, int x, int y) {
  if (this->is_failed() || this->buffer_ == nullptr)
    return;
  const bool lit = it.get_display_type() == display::DISPLAY_TYPE_BINARY;
  const size_t stride = lit ? (this->width_ + 7) / 8 : this->width_ * 2;
  const display::Rect clipping = it.get_clipping();
  const auto *bytes = reinterpret_cast<const uint8_t *>(this->buffer_.get());
  for (uint16_t first = 0; first < this->height_; first = this->end_(first)) {
    const int height = this->end_(first) - first;
    if (clipping.is_set() && (y + first >= clipping.y2() || y + first + height <= clipping.y))
      continue;
    if (!this->rows_(lit ? PANTIN_I1 : PANTIN_RGB565, stride, first))
      return;
    if (!lit) {
      // Displays override this function to send pixels past the buffer that their lambda draws into; the base class draws into that buffer.
      it.display::Display::draw_pixels_at(x, y + first, this->width_, height, bytes, display::COLOR_ORDER_RGB,
                                          display::COLOR_BITNESS_565, std::endian::native == std::endian::big, 0, 0, 0);
      continue;
    }
    for (int row = 0; row < height; row++) {
      for (int column = 0; column < this->width_; column++) {
        const bool on = bytes[row * stride + column / 8] & 0x80 >> column % 8;
        it.draw_pixel_at(x + column, y + first + row, on ? display::COLOR_ON : display::COLOR_OFF);
      }
    }
  }
}

/// Sends the bands whose pixels changed. One change in 2^32 has the checksum of the band before and is sent with the next one.
void Face::draw_changes_() {
  const bool swapped = this->big_endian_ != (std::endian::native == std::endian::big);
  for (uint16_t first = 0; first < this->height_; first = this->end_(first)) {
    const size_t stride = this->width_ * 2;
    if (!this->rows_(swapped ? PANTIN_RGB565_SWAPPED : PANTIN_RGB565, stride, first))
      return;
    const int height = this->end_(first) - first;
    const auto *bytes = reinterpret_cast<const uint8_t *>(this->buffer_.get());
    uint32_t sum = FNV_BASIS;
    for (int i = 0; i < this->width_ * height; i++)
      sum = (sum ^ this->buffer_[i]) * FNV_PRIME;
    if (sum == this->sent_[first / ROWS])
      continue;
    this->sent_[first / ROWS] = sum;
    this->display_->draw_pixels_at(this->x_, this->y_ + first, this->width_, height, bytes, display::COLOR_ORDER_RGB,
                                   display::COLOR_BITNESS_565, this->big_endian_);
  }
}

}  // namespace esphome::pantin
