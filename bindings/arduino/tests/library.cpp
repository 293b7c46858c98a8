// The classes of the library on this machine: what a clip does at its end, seeking, speed, events, and a face whose pixels are those of pantin_face.h.
#include <PantinFace.h>
#include <PantinPlayer.h>
#include <pantin_face_data.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "run.h"

#define NEED(held) need(held, #held, __LINE__)

static void need(bool held, const char *what, int line) {
    if (held) return;
    std::printf("line %d failed: %s\n", line, what);
    std::exit(1);
}

static PantinPlayer<CLIP_RUN_CHANNELS> player;

// Frames last 33.3 ms.
static void clips() {
    NEED(!player.update(0) && !player.seek(0) && !player.event("left_foot_down"));
    NEED(player.begin(CLIP_RUN, CLIP_RUN_LEN));
    uint32_t frames = player.frames(), now = 1000, steps = 0, laps = 0, before = 0;
    NEED(player.update(now) && player.frame() == 0);
    // Three laps at 100 percent, in pictures of 10 ms.
    while (laps < 3) {
        now += 10;
        player.update(now);
        if (player.event("left_foot_down")) steps++;
        NEED(!player.event("no such event"));
        if (player.frame() < before) laps++;
        before = player.frame();
    }
    std::printf("%u steps of the left foot in three laps of %u frames\n", steps, frames);
    NEED(steps == 3 && !player.finished());
    // Half the speed takes twice the time; no speed holds the pose.
    NEED(player.seek(2) && player.update(now) && player.frame() == 2);
    player.speed(50);
    for (int i = 0; i < 20; i++) player.update(now += 10);
    NEED(player.frame() == 5);
    player.speed(0);
    for (int i = 0; i < 20; i++) NEED(!player.update(now += 10));
    player.speed(100);
    player.stop();
    for (int i = 0; i < 20; i++) NEED(!player.update(now += 10));
    player.resume();
    for (int i = 0; i < 20; i++) player.update(now += 10);
    NEED(player.frame() == 11);
    // One pass to the end.
    player.repeat(false);
    NEED(player.play() && !player.finished());
    for (uint32_t i = 0; i < frames * 4 + 10; i++) player.update(now += 10);
    NEED(player.finished() && player.frame() == frames - 1);
    NEED(player.seek(0) && !player.finished());
    NEED(!player.seek(frames));
}

// A display of 16-bit colours.
struct Screen {
    uint16_t pixels[120][160];
    void drawFastHLine(int16_t x, int16_t y, int16_t w, uint16_t color) {
        NEED(x >= 0 && y >= 0 && w > 0 && x + w <= 160 && y < 120);
        for (int16_t i = 0; i < w; i++) pixels[y][x + i] = color;
    }
};

// One of 1 bit, with U8g2's calls.
struct Mono {
    uint8_t pixels[64][128], ink;
    void setDrawColor(uint8_t color) { ink = color; }
    void drawHLine(uint16_t x, uint16_t y, uint16_t w) {
        NEED(w > 0 && x + w <= 128 && y < 64);
        std::memset(&pixels[y][x], ink, w);
    }
};

static PantinFace face, small;
static Screen screen;
static Mono mono;
static uint16_t rows[120][160];
static uint8_t bits[64][16];

static void faces() {
    static int16_t samples[480];
    NEED(!face.update(0) && !face.emote("happy"));
    NEED(!face.begin(pantin_cartoon, 100, 160, 120));
    NEED(face.begin(pantin_cartoon, sizeof pantin_cartoon, 160, 120) && small.begin(pantin_cartoon, sizeof pantin_cartoon, 128, 64));
    NEED(face.emotes(pantin_emotes, PANTIN_EMOTES) && small.emotes(pantin_emotes, PANTIN_EMOTES));
    NEED(!face.emote("nobody") && face.emote("happy") && small.emote("sad"));
    NEED(!face.soundRate(7000) && face.soundRate(16000) && !face.viseme(15, 0) && !face.weight("no such unit", 1));
    for (int i = 0; i < 480; i++) samples[i] = i * 700 % 16000 < 8000 ? 6000 : -6000;
    uint32_t pictures = 0;
    for (uint32_t now = 0; now < 9000; now += 15) {
        if (now == 3000) NEED(face.emote("surprised") && face.look(0.5f, -0.25f));
        if (now == 6000) NEED(face.weight("smile_left", 0.5f) && face.viseme(1, 100) && face.viseme(0, 400));
        NEED(face.update(now) == small.update(now));
        if (face.face.since_ms == 0 && now % 45 != 0) continue;
        if (now % 90 == 0) face.sound(samples, now < 4000 ? 480 : 0);
        std::memset(screen.pixels, 0, sizeof screen.pixels);
        std::memset(mono.pixels, 0, sizeof mono.pixels);
        face.draw(screen);
        small.drawLit(mono);
        NEED(face.rows(PANTIN_RGB565, rows, sizeof rows[0], 0, 120) && small.rows(PANTIN_I1, bits, sizeof bits[0], 0, 64));
        NEED(std::memcmp(screen.pixels, rows, sizeof rows) == 0);
        for (int y = 0; y < 64; y++) {
            for (int x = 0; x < 128; x++) NEED(mono.pixels[y][x] == (bits[y][x / 8] >> (7 - x % 8) & 1));
        }
        pictures++;
    }
    std::printf("%u pictures, %u bytes for a face\n", pictures, static_cast<unsigned>(sizeof face));
    NEED(pictures > 200);
}

int main() {
    clips();
    faces();
    return 0;
}
