#pragma once

#include <cstdio>
#include <vector>

#include "esphome/components/display/display.h"
#include "esphome/components/pantin/face.h"
#include "esphome/core/log.h"

namespace esphome::memory {

/// Records what is drawn: pixel by pixel, and in blocks as a panel without a buffer gets them.
class MemoryDisplay : public display::Display {
 public:
  MemoryDisplay(int width, int height, display::DisplayType type)
      : pixels(width * height), type_(type), width_(width), height_(height) {}

  void update() override { this->do_update_(); }
  display::DisplayType get_display_type() override { return this->type_; }

  void draw_pixel_at(int x, int y, Color color) override {
    if (x >= 0 && x < this->width_ && y >= 0 && y < this->height_ && this->get_clipping().inside(x, y))
      this->pixels[y * this->width_ + x] = color;
  }

  void draw_pixels_at(int x_start, int y_start, int w, int h, const uint8_t *ptr, display::ColorOrder order,
                      display::ColorBitness bitness, bool big_endian, int x_offset, int y_offset, int x_pad) override {
    this->blocks++;
    this->block_rows += h;
    display::Display::draw_pixels_at(x_start, y_start, w, h, ptr, order, bitness, big_endian, x_offset, y_offset, x_pad);
  }

  /// Writes the pixels to a file `name`.ppm in the working folder.
  void save(const char *name) const {
    FILE *file = fopen((std::string(name) + ".ppm").c_str(), "wb");
    fprintf(file, "P6 %d %d 255\n", this->width_, this->height_);
    for (Color color : this->pixels) {
      const uint8_t bytes[3] = {color.r, color.g, color.b};
      fwrite(bytes, 1, sizeof bytes, file);
    }
    fclose(file);
  }

  /// The number of pixels in a part of the display that differ from those of an earlier picture.
  int differing(const std::vector<Color> &other, int top, int bottom) const {
    int count = 0;
    for (int i = top * this->width_; i < bottom * this->width_; i++)
      count += this->pixels[i].raw_32 != other[i].raw_32;
    return count;
  }

  /// Compares the display with the picture that the C library draws of a face, whose left upper corner is at x, y. Prints how many pixels are lit in the
  /// picture, how many of those between two rows of the display differ, and how many are lit outside of the picture or these rows.
  void compare(const char *name, pantin::Face *face, int x, int y, int top = 0, int bottom = 2047) const {
    const int width = face->get_face()->width, height = face->get_face()->height;
    std::vector<uint16_t> rows(width * height);
    pantin_face_draw(face->get_face(), PANTIN_RGB565, rows.data(), width * 2, 0, height);
    int lit = 0, wrong = 0, outside = 0;
    for (uint16_t pixel : rows)
      lit += pixel != 0;
    for (int i = 0; i < this->width_ * this->height_; i++) {
      const int column = i % this->width_ - x, row = i / this->width_ - y;
      const uint16_t pixel = display::ColorUtil::color_to_565(this->pixels[i]);
      if (column < 0 || column >= width || row < 0 || row >= height || row + y < top || row + y >= bottom) {
        outside += pixel != 0;
      } else {
        wrong += pixel != rows[row * width + column];
      }
    }
    ::printf("%s: %d lit, %d wrong, %d outside\n", name, lit, wrong, outside);
  }

  std::vector<Color> pixels;
  int blocks{0}, block_rows{0};

 protected:
  int get_width_internal() override { return this->width_; }
  int get_height_internal() override { return this->height_; }

  display::DisplayType type_;
  int width_, height_;
};

}  // namespace esphome::memory
