#pragma once

#include <memory>
#include <string>
#include <vector>

#include "esphome/components/display/display.h"
#include "esphome/core/automation.h"
#include "esphome/core/component.h"
#include "esphome/core/defines.h"
#ifdef USE_LVGL
#include "esphome/components/lvgl/lvgl_proxy.h"
#endif

#include "pantin_face.h"
#include "pantin_talk.h"

namespace esphome::pantin {

/// A face that shows emotes, blinks and glances by itself, and speaks. It is drawn in a display's lambda by draw(), or draws itself on the display of
/// set_display() or in the widget of set_widget().
///
/// All functions are for the main loop.
class Face : public Component {
 public:
  /// `model` is not copied: an array of pantin_face_data.h or pantin_face_themes.h.
  Face(uint16_t width, uint16_t height, const uint8_t *model, uint32_t length)
      : model_(model), length_(length), width_(width), height_(height) {}

  void set_initial_emote(const char *name) { this->first_emote_ = name; }
  void set_transition(uint16_t ms) { this->transition_ms_ = ms; }

  /// Gives the face a clip, before setup(). Name and bytes are not copied.
  void add_clip(const char *name, const uint8_t *bytes, uint32_t length) { this->clips_.push_back({name, bytes, length}); }

  /// Lets the face draw itself on a display without a lambda: the rows that changed, every 33 ms, with the left upper corner at x, y.
  void set_display(display::Display *display, int x, int y, bool big_endian) {
    this->display_ = display;
    this->x_ = x;
    this->y_ = y;
    this->big_endian_ = big_endian;
  }

#ifdef USE_LVGL
  /// Lets the face draw itself in a widget of LVGL: an image with its left upper corner at x, y of the widget, which changes every 33 ms.
  void set_widget(lv_obj_t *parent, int x, int y) {
    this->parent_ = parent;
    this->x_ = x;
    this->y_ = y;
  }
#endif

  void setup() override;
  void loop() override;
  void dump_config() override;
  float get_setup_priority() const override { return setup_priority::PROCESSOR; }

  /// Draws the face, for a display's lambda: id(face).draw(it, x, y). On a display with two colours it is drawn in one.
  void draw(display::Display &it, int x, int y);

  /// Goes over to an emote. Returns false for an unknown name: the face stays as it is, and the log has a warning.
  bool emote(const std::string &name);

  /// Plays a clip of the configuration, or of add_clip(), in place of an emote. Returns false for an unknown name and for a clip that does not play: the
  /// face stays as it is, and the log has a warning.
  bool play(const std::string &name);

  /// Whether the clip that plays has no loop and has shown its last frame.
  bool is_finished() const { return this->face_.finished != 0; }

  /// Opens the mouth, 0 to 1, until the next call. No effect while push_pcm() or viseme() move the lips.
  void level(float level);

  /// Turns the eyes, -1 to 1, to the right of the picture and up.
  void look(float x, float y);

  /// Moves the lips by sound: the samples of one channel as they are played, at least every 33 ms.
  void push_pcm(const int16_t *samples, size_t count) { pantin_talk_push(&this->talk_, samples, count); }

  /// Sets the rate of the sound that follows, 8,000 to 48,000 Hz: 16,000 without a call. Returns false for another.
  bool set_sound_rate(uint32_t rate);

  /// Shows a viseme of MPEG-4, 1 to 14, or none, 0, `ms` milliseconds from now. Returns false for another number, a time before one that waits, and if 16 wait.
  bool viseme(uint8_t number, uint32_t ms) { return pantin_talk_viseme(&this->talk_, number, this->talk_.now + ms) == PANTIN_OK; }

  /// The face and its lips in the C library, for all else that pantin_face.h does: pantin_face_weight, pantin_face_palette.
  pantin_face *get_face() { return &this->face_; }
  pantin_talk *get_talk() { return &this->talk_; }

 protected:
  uint16_t channels_() const;
  void draw_changes_();
  void send_(uint16_t first, int height);
#ifdef USE_LVGL
  bool make_image_();
  void show_(uint16_t first, int height);
#endif
  bool rows_(pantin_format format, size_t stride, uint16_t first);
  uint16_t end_(uint16_t first) const;

  /// Memory for the cartoon, which has more vertices than the other models, for emotes and for the longest clip.
  std::unique_ptr<uint32_t[]> memory_;
  std::vector<pantin_emote> clips_;
  pantin_face face_{};
  pantin_talk talk_{};
  const uint8_t *model_;
  uint32_t length_;
  uint32_t last_ms_{0};
  /// Pixels of ROWS rows, and a checksum of each such band as it was sent.
  std::unique_ptr<uint16_t[]> buffer_;
  std::vector<uint32_t> sent_;
  /// What setup() shows: also what is asked for before it, as `on_boot` does.
  std::string first_emote_{"neutral"};
  std::string first_clip_;
  bool is_open_{false};
  display::Display *display_{nullptr};
#ifdef USE_LVGL
  lv_obj_t *parent_{nullptr};
  lv_obj_t *image_{nullptr};
  lv_image_dsc_t picture_{};
#endif
  int x_{0}, y_{0};
  uint16_t width_, height_;
  uint16_t transition_ms_{300};
  bool big_endian_{true};
  bool opened_by_level_{false};
};

template<typename... Ts> class EmoteAction : public Action<Ts...>, public Parented<Face> {
 public:
  TEMPLATABLE_VALUE(std::string, emote)
  void play(const Ts &...x) override { this->parent_->emote(this->emote_.value(x...)); }
};

template<typename... Ts> class PlayAction : public Action<Ts...>, public Parented<Face> {
 public:
  TEMPLATABLE_VALUE(std::string, clip)
  void play(const Ts &...x) override { this->parent_->play(this->clip_.value(x...)); }
};

template<typename... Ts> class LevelAction : public Action<Ts...>, public Parented<Face> {
 public:
  TEMPLATABLE_VALUE(float, level)
  void play(const Ts &...x) override { this->parent_->level(this->level_.value(x...)); }
};

template<typename... Ts> class LookAction : public Action<Ts...>, public Parented<Face> {
 public:
  TEMPLATABLE_VALUE(float, x)
  TEMPLATABLE_VALUE(float, y)
  void play(const Ts &...x) override { this->parent_->look(this->x_.value(x...), this->y_.value(x...)); }
};

}  // namespace esphome::pantin
