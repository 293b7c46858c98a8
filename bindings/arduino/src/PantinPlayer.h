/* Pantin for Arduino: plays a clip or a bank, and draws it as a wireframe figure.
 *
 *     PantinFigure<CLIP_WALK_CHANNELS, CLIP_WALK_FIGURE_JOINTS, CLIP_WALK_WORKSPACE> figure;
 *     figure.begin(CLIP_WALK, CLIP_WALK_LEN, 128, 64);
 *     if (figure.update(millis())) figure.draw(display);
 *
 * The numbers are in the header that `pantin expand walk.ptn -o walk.h` writes; all memory is in the object. Clips are read from flash. */
#ifndef PANTIN_PLAYER_H
#define PANTIN_PLAYER_H

#include "pantin.h"
#include "pantin_figure.h"
#include "pantin_turn.h"

/* The bytes of a clip or a bank, which stay in flash. */
class PantinContent {
  public:
    pantin_source *open(const uint8_t *bytes, uint32_t length) {
#if defined(__AVR__) || defined(ESP8266)
        pantin_paged(&pages, length, pantin_read_progmem, const_cast<uint8_t *>(bytes), page, sizeof page);
#else
        pantin_memory(&pages.source, bytes, length);
#endif
        return &pages.source;
    }

  private:
    pantin_pages pages;
#if defined(__AVR__) || defined(ESP8266)
    uint8_t page[64];
#endif
};

/* A joint, found once by PantinPlayer::find. False if the rig has no such joint. */
class PantinJoint : public pantin_joint_ref {
  public:
    PantinJoint() { found = 0; }
    explicit operator bool() const { return found != 0; }

    /* The order of its Euler angles in the rig, in which it should be read (pantin_turn.h says why); PANTIN_XYZ if the rig has none for it. */
    pantin_order eulerOrder() const { return found && order <= PANTIN_ZYX ? static_cast<pantin_order>(order) : PANTIN_XYZ; }
};

/* Plays clips of at most ChannelCount channels: for servos, lights and faces. */
template <uint16_t ChannelCount> class PantinPlayer {
  public:
    /* Opens a clip or a bank, and shows frame 0 (of a bank: of its first clip). Returns false if it is damaged, has too many channels, or is a key clip
     * (`pantin convert --segments` writes another one) and PANTIN_KEYS is not defined for the whole build. */
    bool begin(const uint8_t *bytes, uint32_t length) {
        ready = false;
        pantin_source *source = content.open(bytes, length);
        isBank = pantin_open_bank(&bank, source) == PANTIN_OK;
        if (!isBank) return pantin_open(&clip, source, NULL) == PANTIN_OK && start();
        pantin_entry first;
        pantin_first_entry(&first, &bank);
        return pantin_next_entry(&first) && pantin_open_entry(&clip, &first) == PANTIN_OK && start();
    }

    /* Shows the frame that is due at a time in milliseconds: pass millis(). Returns true if the pose changed. A clip starts again at its end, unless
     * repeat(false) was called. */
    bool update(uint32_t now) {
        if (!ready) return false;
        if (!running) last = now;
        uint32_t elapsed = now - last;
        last = now;
        running = true;
        /* After a long pause the motion goes on where it was. */
        if (elapsed > 1000) elapsed = 0;
        if (!stopped && !ended) due += static_cast<uint64_t>(elapsed) * 10000u * percent;
        bool changed = fresh;
        passed = fresh ? 1 : 0;
        fresh = false;
        while (due >= clip.frame_time_ns) {
            due -= clip.frame_time_ns;
            if (player.frame + 1 >= clip.frames && !repeats) {
                ended = true;
                due = 0;
                break;
            }
            if (pantin_step(&player) != PANTIN_OK && pantin_restart(&player) != PANTIN_OK) return false;
            if (passed < clip.frames) passed++;
            changed = true;
        }
        return changed;
    }

    /* Whether a clip starts again at its end: true without a call. */
    void repeat(bool again) { repeats = again; }

    /* Whether a clip that does not repeat has shown its last frame for its time. */
    bool finished() const { return ended; }

    /* Holds the pose until resume() or play(). */
    void stop() { stopped = true; }
    void resume() { stopped = false; }

    /* Sets the speed in percent, 0 to 1000: 100 without a call. */
    void speed(uint16_t percentage) { percent = percentage > 1000 ? 1000 : percentage; }

    /* Shows a frame: the next update() returns true. Returns false if the clip has no such frame. A frame that lies back is found from frame 0, or from
     * the clip's index. */
    bool seek(uint32_t frame) {
        if (!ready || frame >= clip.frames || pantin_seek(&player, frame) != PANTIN_OK) return false;
        due = 0;
        ended = false;
        fresh = true;
        return true;
    }

    /* Whether an event of this name, such as "left_foot_down", lies on one of the frames that the last update() reached. */
    bool event(const char *name) {
        pantin_event event;
        if (!ready || passed == 0) return false;
        pantin_first_event(&event, &clip);
        while (pantin_next_event(&event)) {
            /* Frames since then, around the end of the clip. */
            uint32_t since = player.frame >= event.frame ? player.frame - event.frame : player.frame + clip.frames - event.frame;
            pantin_name called;
            if (event.frame < clip.frames && since < passed && pantin_event_name(&clip, event.id, &called) && pantin_name_is(&called, name)) return true;
        }
        return false;
    }

    /* Starts a clip of a bank by its name. Returns false if there is none; the clip before has ended then. */
    bool play(const char *name) {
        ready = false;
        return isBank && pantin_open_named(&clip, &bank, name) == PANTIN_OK && start();
    }

    /* Starts the clip again. Returns false if none was opened. */
    bool play() { return ready && start(); }

    /* Finds a joint by name: once, in setup(). The result is false if the rig has no such joint. It is valid for all clips of a bank. */
    PantinJoint find(const char *name) {
        PantinJoint joint;
        if (ready) (void)pantin_find(&clip, name, &joint);
        return joint;
    }

    /* Gives the joint's three Euler angles in degrees, -180 to 180, rounded to 0.01, however the clip codes it: degrees[0] is about the first axis of the
     * order. Pass joint.eulerOrder(), in which a joint that has one axis has its angle in degrees[0]. Returns false, and leaves `degrees`, if there is no
     * such joint. */
    bool euler(PantinJoint &joint, pantin_order order, float (&degrees)[3]) {
        int32_t angles[3];
        if (!ready || pantin_euler(&player, &joint, order, angles) != PANTIN_OK) return false;
        for (uint8_t i = 0; i < 3; i++) degrees[i] = static_cast<float>(pantin_centidegrees(angles[i])) / 100.0f;
        return true;
    }

    /* The same in hundredths of a degree, without floating point: -18000 to 18000. */
    bool centidegrees(PantinJoint &joint, pantin_order order, int16_t (&angles)[3]) {
        int32_t raw[3];
        if (!ready || pantin_euler(&player, &joint, order, raw) != PANTIN_OK) return false;
        for (uint8_t i = 0; i < 3; i++) angles[i] = pantin_centidegrees(raw[i]);
        return true;
    }

    /* Gives the unit quaternion w, x, y, z in 2^-30. Returns false if there is no such joint. */
    bool quaternion(PantinJoint &joint, int32_t (&wxyz)[4]) { return ready && pantin_quaternion(&player, &joint, wxyz) == PANTIN_OK; }

    /* Gives the rotation matrix in 2^-30, row by row. Returns false if there is no such joint. */
    bool matrix(PantinJoint &joint, int32_t (&rows)[9]) { return ready && pantin_matrix(&player, &joint, rows) == PANTIN_OK; }

    /* Gives the raw value of one of the joint's channels as the clip codes it, which is no angle if that is an exponential map or a quaternion.
     * Returns false if there is no such joint or channel. */
    bool rawValue(const PantinJoint &joint, uint8_t channel, int32_t &value) {
        return ready && pantin_raw_value(&player, &joint, channel, &value) == PANTIN_OK;
    }

    /* Gives the value of a scalar channel, for example a unit of a face from 0 to 1. Returns false, and leaves `value`, if the clip has no such scalar. */
    bool scalar(const char *name, float &value) {
        pantin_scalar found;
        if (!ready || !pantin_find_scalar(&clip.rig, name, &found)) return false;
        value = static_cast<float>(pose[found.channel]);
        for (int exponent = found.exponent - 31; exponent < 0; exponent++) value /= 2;
        for (int exponent = found.exponent - 31; exponent > 0; exponent--) value *= 2;
        return true;
    }

    /* The frame that is shown, and their number: 0 if no clip was opened. */
    uint32_t frame() const { return ready ? player.frame : 0; }
    uint32_t frames() const { return ready ? clip.frames : 0; }

    /* For PantinSolid: the player, NULL before begin(); and the pose that is shown. */
    pantin_player *playing() { return ready ? &player : NULL; }
    template <class Solid> void setPose(Solid *solid) const {
        if (ready) pantin_solid_pose(solid, player.pose);
    }

  protected:
    bool start() {
        ready = pantin_start(&player, &clip, pose, ChannelCount, moving, ChannelCount) == PANTIN_OK;
        running = stopped = ended = false;
        fresh = true;
        passed = 0;
        due = 0;
        return ready;
    }

    PantinContent content;
    pantin_bank bank;
    pantin_clip clip;
    pantin_player player;
    int32_t pose[ChannelCount];
    pantin_channel moving[ChannelCount];
    uint64_t due;
    uint32_t last, passed; /* the time of the last update; frames that it reached */
    uint16_t percent = 100;
    bool isBank = false, ready = false, running = false, fresh = false, stopped = false, ended = false, repeats = true;
};

/* Draws clips as a figure of at most BoneCount bones, from rigs of at most JointCount joints. */
template <uint16_t ChannelCount, uint16_t BoneCount, uint16_t JointCount> class PantinFigure : public PantinPlayer<ChannelCount> {
    typedef PantinPlayer<ChannelCount> Player;

  public:
    /* Opens a clip or a bank for a display of `width` times `height` pixels. */
    bool begin(const uint8_t *bytes, uint32_t length, uint16_t width, uint16_t height) {
        columns = width;
        rows = height;
        viewed = pantin_default_view;
        return Player::begin(bytes, length) && setUp();
    }

    bool play(const char *name) { return Player::play(name) && setUp(); }
    bool play() { return Player::play(); }

    /* Looks from elsewhere: degrees about the vertical and above the horizon. `fixed`: the camera does not follow the figure. */
    bool view(int16_t orbit, int16_t tilt, bool fixed = false) {
        viewed.orbit = orbit;
        viewed.tilt = tilt;
        viewed.fixed = fixed;
        return aim();
    }

    /* Draws the figure in its pose over what the display shows, in a colour of the display's own numbers (1: a lit pixel of an OLED).
     * `Display` is a display of Adafruit_GFX, TFT_eSPI or U8g2. */
    template <class Display> void draw(Display &display, uint16_t color = 1) {
        if (!this->ready || !drawable) return;
        pantin_figure_pose(&figure, this->pose);
        pantin_ground ground;
        pantin_line line;
        pantin_head head;
        pantin_first_ground(&ground, &figure);
        while (figure.dotted && pantin_next_ground(&ground, &line)) dot(display, line.from[0] >> 4, line.from[1] >> 4, color, 0);
        for (uint8_t i = 0; pantin_figure_line(&figure, i, &line); i++) stroke(display, line, color);
        if (pantin_figure_head(&figure, &head)) {
            int16_t radius = static_cast<int16_t>((head.radius + 8) >> 4);
            disc(display, head.centre[0] >> 4, head.centre[1] >> 4, radius < 1 ? 1 : radius, color, 0);
        }
    }

  private:
    bool setUp() {
        pantin_figure_memory(&figure, bones, BoneCount, drives, ChannelCount, slots, PANTIN_FIGURE_SLOTS);
        drawable = pantin_figure_set_up(&figure, &this->player, columns, rows, scratch, JointCount) == PANTIN_OK;
        return aim();
    }

    bool aim() {
        drawable = drawable && pantin_figure_aim(&figure, &this->player, &viewed) == PANTIN_OK;
        return drawable;
    }

    /* A line in its width: lines side by side, across the longer way. */
    template <class Display> void stroke(Display &display, const pantin_line &line, uint16_t color) {
        int16_t x0 = line.from[0] >> 4, y0 = line.from[1] >> 4, x1 = line.to[0] >> 4, y1 = line.to[1] >> 4;
        int16_t across = x0 < x1 ? x1 - x0 : x0 - x1, down = y0 < y1 ? y1 - y0 : y0 - y1;
        for (uint8_t i = 0; i < line.width; i++) {
            int16_t aside = static_cast<int16_t>(i - line.width / 2);
            if (down > across) {
                stretch(display, x0 + aside, y0, x1 + aside, y1, color, 0);
            } else {
                stretch(display, x0, y0 + aside, x1, y1 + aside, color, 0);
            }
        }
    }

    /* Displays whose calls take a colour (Adafruit_GFX, TFT_eSPI), and those that do not and take no places left of 0 (U8g2). */
    template <class Surface> static auto dot(Surface &d, int16_t x, int16_t y, uint16_t color, int) -> decltype(d.drawPixel(x, y, color), void()) {
        d.drawPixel(x, y, color);
    }
    template <class Surface> void dot(Surface &d, int16_t x, int16_t y, uint16_t, long) {
        if (inside(x, y)) d.drawPixel(x, y);
    }
    template <class Surface>
    static auto stretch(Surface &d, int16_t x0, int16_t y0, int16_t x1, int16_t y1, uint16_t color, int)
        -> decltype(d.drawLine(x0, y0, x1, y1, color), void()) {
        d.drawLine(x0, y0, x1, y1, color);
    }
    template <class Surface> void stretch(Surface &d, int16_t x0, int16_t y0, int16_t x1, int16_t y1, uint16_t, long) {
        if (inside(x0, y0) && inside(x1, y1)) d.drawLine(x0, y0, x1, y1);
    }
    template <class Surface>
    static auto disc(Surface &d, int16_t x, int16_t y, int16_t r, uint16_t color, int) -> decltype(d.fillCircle(x, y, r, color), void()) {
        d.fillCircle(x, y, r, color);
    }
    template <class Surface> void disc(Surface &d, int16_t x, int16_t y, int16_t r, uint16_t, long) {
        if (inside(x - r, y - r) && inside(x + r, y + r)) d.drawDisc(x, y, r);
    }
    bool inside(int16_t x, int16_t y) const { return x >= 0 && y >= 0 && x < static_cast<int16_t>(columns) && y < static_cast<int16_t>(rows); }

    pantin_figure figure;
    pantin_view viewed;
    pantin_bone bones[BoneCount];
    pantin_drive drives[ChannelCount];
    pantin_slot slots[PANTIN_FIGURE_SLOTS];
    pantin_joint_info scratch[JointCount];
    uint16_t columns, rows;
    bool drawable = false;
};

#endif
