/* Pantin for Arduino: a body with volume on a colour display, of a clip (PantinPlayer) or of a character (PantinCharacter).
 *
 *     PantinPlayer<CLIP_WALK_CHANNELS> player;
 *     PantinSolid<CLIP_WALK_CHANNELS, CLIP_WALK_FIGURE_JOINTS, CLIP_WALK_WORKSPACE> body;
 *     uint16_t rows[16 * 240];
 *     player.begin(CLIP_WALK, CLIP_WALK_LEN);
 *     body.begin(player, 240, 240);
 *     if (player.update(millis())) body.draw(player, display, rows, 16);
 *
 * For 32-bit processors. All memory but the rows is in the object. */
#ifndef PANTIN_SOLID_ARDUINO_H
#define PANTIN_SOLID_ARDUINO_H

#include <string.h>

#include "PantinPlayer.h"
#include "pantin_solid.h"

/* A figure of at most BoneCount bones, of rigs with at most ChannelCount channels and JointCount joints. */
template <uint16_t ChannelCount, uint16_t BoneCount, uint16_t JointCount> class PantinSolid {
  public:
    /* Changes colours, radii and attachments: bytes that `pantin expand FILE.look -o look.h` writes, which are not copied. Call it before begin(). Returns
     * false for bytes that are no character: nothing changes then. */
    bool look(const uint8_t *bytes, uint32_t length) { return pantin_solid_look(&solid, bytes, length) == PANTIN_OK; }

    /* Sets the figure up for what plays, and a display's size, and chooses the camera: once, before the first update(). Returns false if nothing was begun or
     * the rig is too large. */
    template <class Source> bool begin(Source &source, uint16_t width, uint16_t height) {
        pantin_figure_memory(&solid.figure, bones, BoneCount, drives, ChannelCount, slots, PANTIN_FIGURE_SLOTS);
        ready = false;
        redraw();
        pantin_player *player = source.playing();
        if (!player || pantin_solid_set_up(&solid, player, width, height, scratch, JointCount) != PANTIN_OK) return false;
        ready = pantin_solid_aim(&solid, player, &viewed) == PANTIN_OK;
        return ready;
    }

    /* Looks from another side, in degrees: see pantin_view. `fixed` lets the camera show all that the clip covers, instead of following the hips. Call it before
     * begin(). */
    void view(int16_t orbit, int16_t tilt, bool fixed = false) {
        viewed.orbit = orbit;
        viewed.tilt = tilt;
        viewed.fixed = fixed;
    }

    /* Whether the figure stands on a floor and has a shadow: true without a call. */
    void floor(bool shown) { floored = shown; }

    /* Draws the pose of what plays on a display or sprite with 16-bit colours, at a place, `count` rows of the buffer at a time: TFT_eSPI and M5GFX (pushImage,
     * with setSwapBytes(false), their default), or Adafruit_GFX (drawRGBBitmap). The buffer has a number for each pixel of these rows. The first picture is
     * sent whole; of later ones, the columns that are lit or were, of these rows. Call redraw() if something else was drawn there. */
    template <class Source, class Display> bool draw(const Source &source, Display &display, uint16_t *buffer, uint16_t count, int16_t x = 0, int16_t y = 0) {
        if (!ready || !count) return false;
        source.setPose(&solid);
        uint16_t width = solid.figure.width, height = solid.figure.height;
        bool known = shownRows == count && shownAt[0] == x && shownAt[1] == y;
        /* Until all of it is sent. */
        redraw();
        uint16_t index = 0;
        for (uint16_t top = 0; top < height; top = static_cast<uint16_t>(top + count), index++) {
            uint16_t bottom = static_cast<uint16_t>(height - top < count ? height : top + count), lines = static_cast<uint16_t>(bottom - top);
            if (!rows(format(display, 0), buffer, width * 2u, top, bottom)) return false;
            Columns now = lit(buffer, width, lines), changed = {0, width};
            if (index < STRETCHES) {
                if (known) changed = {now.from < shown[index].from ? now.from : shown[index].from, now.to > shown[index].to ? now.to : shown[index].to};
                shown[index] = now;
            }
            if (changed.from >= changed.to) continue;
            uint16_t wide = static_cast<uint16_t>(changed.to - changed.from);
            for (uint16_t line = 0; line < lines && wide < width; line++)
                memmove(buffer + static_cast<size_t>(line) * wide, buffer + static_cast<size_t>(line) * width + changed.from, wide * 2u);
            push(display, static_cast<int16_t>(x + changed.from), static_cast<int16_t>(y + top), wide, lines, buffer, 0);
        }
        shownRows = count;
        shownAt[0] = x;
        shownAt[1] = y;
        return true;
    }

    /* Sends the next picture whole: the display shows something else where the figure is drawn, or two sprites take turns. */
    void redraw() { shownRows = 0; }

    /* Draws rows y0 to y1 - 1 of the last pose into a buffer of `stride` bytes a row, in any format: PANTIN_I1 for drawBitmap of Adafruit_GFX, PANTIN_I1_LSB
     * for drawXBM of U8g2. */
    bool rows(pantin_format as, void *buffer, size_t stride, uint16_t y0, uint16_t y1) const {
        return ready && pantin_solid_draw(&solid, as, buffer, stride, y0, y1, floored) == PANTIN_OK;
    }

    /* Takes the pose of what plays, for rows(). */
    template <class Source> void pose(const Source &source) {
        if (ready) source.setPose(&solid);
    }

    pantin_solid solid = pantin_solid();

  private:
    /* Columns from `from` to before `to`; none if `from` is not less. */
    struct Columns {
        uint16_t from, to;
    };
    /* Stretches of rows whose lit columns are remembered. Those beyond are sent whole. */
    enum { STRETCHES = 32 };

    /* The columns in which rows of a buffer have lit pixels. */
    static Columns lit(const uint16_t *pixels, uint16_t width, uint16_t lines) {
        Columns found = {width, 0};
        for (; lines; lines--, pixels += width) {
            uint16_t from = 0, to = width;
            while (from < found.from && !pixels[from]) from++;
            while (to > found.to && !pixels[to - 1]) to--;
            found = {from, to};
        }
        return found;
    }

    /* Displays that take pixels as they are sent, and those that take numbers. */
    template <class Surface> static auto format(Surface &d, int) -> decltype(d.pushImage(0, 0, 1, 1, static_cast<uint16_t *>(NULL)), PANTIN_RGB565) {
        return PANTIN_RGB565_SWAPPED;
    }
    template <class Surface> static pantin_format format(Surface &, long) { return PANTIN_RGB565; }
    template <class Surface>
    static auto push(Surface &d, int16_t x, int16_t y, uint16_t w, uint16_t h, uint16_t *pixels, int) -> decltype(d.pushImage(x, y, w, h, pixels), void()) {
        d.pushImage(x, y, w, h, pixels);
    }
    template <class Surface> static void push(Surface &d, int16_t x, int16_t y, uint16_t w, uint16_t h, uint16_t *pixels, long) {
        d.drawRGBBitmap(x, y, pixels, static_cast<int16_t>(w), static_cast<int16_t>(h));
    }

    pantin_view viewed = pantin_default_view;
    pantin_bone bones[BoneCount];
    pantin_drive drives[ChannelCount];
    pantin_slot slots[PANTIN_FIGURE_SLOTS];
    pantin_joint_info scratch[JointCount];
    bool ready = false, floored = true;
    /* What was sent last: rows at a time (0: what the display shows is not known), where, and the lit columns of each stretch. */
    uint16_t shownRows = 0;
    int16_t shownAt[2] = {0, 0};
    Columns shown[STRETCHES];
};

#endif
