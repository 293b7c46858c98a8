#include "face.h"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cstring>
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
  const size_t words = PANTIN_FACE_WORDS(97, this->channels_());
  this->memory_.reset(new (std::nothrow) uint32_t[words]);
  if (this->buffer_ == nullptr || this->memory_ == nullptr) {
    this->mark_failed(LOG_STR("There is not enough memory for the face"));
    return;
  }
  if (pantin_face_open(&this->face_, this->model_, this->length_, this->memory_.get(), words * sizeof(uint32_t)) != PANTIN_OK ||
      pantin_face_size(&this->face_, this->width_, this->height_) != PANTIN_OK) {
    this->mark_failed(LOG_STR("The model of the face is damaged"));
    return;
  }
  pantin_face_emotes(&this->face_, pantin_emotes, PANTIN_EMOTES);
  pantin_face_live(&this->face_, random_uint32() | 1);
  if (this->talk_.rate == 0)
    pantin_talk_open(&this->talk_, RATE);
  this->is_open_ = true;
  this->emote(this->first_emote_);
  if (!this->first_clip_.empty())
    this->play(this->first_clip_);
  pantin_face_transition(&this->face_, this->transition_ms_);
  if (this->display_ != nullptr)
    this->sent_.resize((this->height_ + ROWS - 1) / ROWS);
#ifdef USE_LVGL
  if (this->parent_ != nullptr && !this->make_image_())
    this->mark_failed(LOG_STR("There is not enough memory for the image of the face"));
#endif
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
  this->draw_changes_();
}

void Face::dump_config() {
  ESP_LOGCONFIG(TAG,
                "Face:\n"
                "  Size: %ux%u\n"
                "  Model: %" PRIu32 " bytes",
                this->width_, this->height_, this->length_);
  if (this->display_ != nullptr) {
    ESP_LOGCONFIG(TAG, "  Sends its rows to the display at %d, %d", this->x_, this->y_);
  }
#ifdef USE_LVGL
  if (this->image_ != nullptr) {
    ESP_LOGCONFIG(TAG, "  Image in a widget of LVGL at %d, %d", this->x_, this->y_);
  }
#endif
}

bool Face::emote(const std::string &name) {
  if (!this->is_open_) {
    this->first_emote_ = name;
    this->first_clip_.clear();
    return !this->is_failed();
  }
  const pantin_result result = pantin_face_emote(&this->face_, name.c_str());
  if (result == PANTIN_NOT_FOUND) {
    ESP_LOGW(TAG, "There is no emote '%s'", name.c_str());
  } else if (result != PANTIN_OK) {
    ESP_LOGW(TAG, "The emote '%s' does not play: result %d of pantin.h", name.c_str(), result);
  }
  return result == PANTIN_OK;
}

/// Channels of the clip that has most of them; emotes have fewer than 12.
uint16_t Face::channels_() const {
  uint16_t most = 12;
  for (const pantin_emote &own : this->clips_) {
    pantin_source source;
    pantin_clip clip;
    pantin_memory(&source, own.bytes, own.length);
    if (pantin_open(&clip, &source, nullptr) == PANTIN_OK)
      most = std::max(most, clip.rig.channels);
  }
  return most;
}

bool Face::play(const std::string &name) {
  if (!this->is_open_) {
    this->first_clip_ = name;
    return !this->is_failed();
  }
  for (const pantin_emote &own : this->clips_) {
    if (name != own.name)
      continue;
    const pantin_result result = pantin_face_play(&this->face_, own.bytes, own.length);
    if (result == PANTIN_NOT_FOUND) {
      ESP_LOGW(TAG, "No scalar of the clip '%s' drives the face", own.name);
    } else if (result != PANTIN_OK) {
      ESP_LOGW(TAG, "The clip '%s' does not play: result %d of pantin.h", own.name, result);
    }
    return result == PANTIN_OK;
  }
  ESP_LOGW(TAG, "There is no clip '%s'", name.c_str());
  return false;
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

/// Draws the face for a display or a widget, if it has one.
void Face::draw_changes_() {
  pantin_format format = PANTIN_RGB565;
  if (this->display_ != nullptr) {
    if (this->big_endian_ != (std::endian::native == std::endian::big))
      format = PANTIN_RGB565_SWAPPED;
#ifdef USE_LVGL
  } else if (this->image_ != nullptr) {
#endif
  } else {
    return;
  }
  for (uint16_t first = 0; first < this->height_; first = this->end_(first)) {
    if (!this->rows_(format, this->width_ * 2, first))
      return;
    const int height = this->end_(first) - first;
    if (this->display_ != nullptr)
      this->send_(first, height);
#ifdef USE_LVGL
    if (this->image_ != nullptr)
      this->show_(first, height);
#endif
  }
}

/// Sends a band to the display if it changed. One change in 2^32 has the checksum of the band before and is sent with the next one.
void Face::send_(uint16_t first, int height) {
  uint32_t sum = FNV_BASIS;
  for (int i = 0; i < this->width_ * height; i++)
    sum = (sum ^ this->buffer_[i]) * FNV_PRIME;
  if (sum == this->sent_[first / ROWS])
    return;
  this->sent_[first / ROWS] = sum;
  this->display_->draw_pixels_at(this->x_, this->y_ + first, this->width_, height,
                                 reinterpret_cast<const uint8_t *>(this->buffer_.get()), display::COLOR_ORDER_RGB,
                                 display::COLOR_BITNESS_565, this->big_endian_);
}

#ifdef USE_LVGL
/// Makes an image in the widget, with all pixels of the face. Returns false if memory is used up.
bool Face::make_image_() {
  const size_t stride = this->width_ * 2;
  uint8_t *pixels = RAMAllocator<uint8_t>().allocate(stride * this->height_);
  if (pixels == nullptr)
    return false;
  memset(pixels, 0, stride * this->height_);
  lv_image_header_t &header = this->picture_.header;
  header.magic = LV_IMAGE_HEADER_MAGIC;
  header.cf = LV_COLOR_FORMAT_RGB565;
  header.w = this->width_;
  header.h = this->height_;
  header.stride = stride;
  this->picture_.data = pixels;
  this->picture_.data_size = stride * this->height_;
  this->image_ = lv_image_create(this->parent_);
  lv_image_set_src(this->image_, &this->picture_);
  lv_obj_set_pos(this->image_, this->x_, this->y_);
  return true;
}

/// Copies a band to the image if it changed, and lets LVGL draw it again.
void Face::show_(uint16_t first, int height) {
  const size_t stride = this->width_ * 2;
  uint8_t *rows = const_cast<uint8_t *>(this->picture_.data) + first * stride;
  if (memcmp(rows, this->buffer_.get(), height * stride) == 0)
    return;
  memcpy(rows, this->buffer_.get(), height * stride);
  lv_area_t area;
  lv_obj_get_coords(this->image_, &area);
  area.y1 += first;
  area.y2 = area.y1 + height - 1;
  lv_obj_invalidate_area(this->image_, &area);
}
#endif

}  // namespace esphome::pantin
