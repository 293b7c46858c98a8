// The classes of the library on this machine: what a clip does at its end, seeking, speed, events; a face, a character and a body with volume whose pixels
// and poses are those of the functions in C. The macros are names that a sketch may have defined before it includes the library.
#define CHANNELS 1
#define BONES 2
#define JOINTS 3
#define LAYERS 4
#define FEET 5
#define VERTICES 6
#define D 7

#include <PantinCharacter.h>
#include <PantinFace.h>
#include <PantinPlayer.h>
#include <PantinSolid.h>
#include <pantin_face_data.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "hero.h"
#include "run.h"

#define NEED(held) need(held, #held, __LINE__)

static void need(bool held, const char *what, int line) {
    if (held) return;
    std::printf("line %d failed: %s\n", line, what);
    std::exit(1);
}

// An object in memory that holds other bytes than 0, as one on the heap does.
template <class Object> static Object &inUsedMemory() {
    alignas(Object) static unsigned char memory[sizeof(Object)];
    std::memset(memory, 0xa5, sizeof(Object));
    return *new (memory) Object;
}

// What is called too early does nothing, and says so.
static void beforeBegin() {
    static const int16_t samples[160] = {0};
    PantinFace &face = inUsedMemory<PantinFace>();
    face.sound(samples, 160);
    NEED(!face.emote("happy") && !face.emotes(pantin_emotes, PANTIN_EMOTES) && !face.look(0, 0) && !face.weight("joy", 1) && !face.viseme(1, 0));
    NEED(!face.live(1) && !face.palette(NULL) && !face.update(0) && !face.rows(PANTIN_RGB565, NULL, 480, 0, 1));
    NEED(face.soundRate(8000) && face.begin(pantin_cartoon, sizeof pantin_cartoon, 64, 48) && face.talk.rate == 8000);
    PantinPlayer<CLIP_RUN_CHANNELS> &player = inUsedMemory<PantinPlayer<CLIP_RUN_CHANNELS>>();
    float value = 7, degrees[3];
    PantinJoint joint = player.find("hips");
    NEED(!player.update(0) && !player.play() && !player.play("run") && !player.seek(0) && !player.event("left_foot_down") && !player.finished());
    NEED(player.frame() == 0 && player.frames() == 0 && !joint && !player.euler(joint, PANTIN_XYZ, degrees) && !player.scalar("joy", value) && value == 7);
    // Bytes that do not open leave no clip of before.
    NEED(player.begin(CLIP_RUN, CLIP_RUN_LEN) && !player.begin(CLIP_RUN, 20) && !player.update(0) && !player.play() && player.frames() == 0);
    PantinFigure<CLIP_RUN_CHANNELS, 40, 40> &figure = inUsedMemory<PantinFigure<CLIP_RUN_CHANNELS, 40, 40>>();
    NEED(!figure.view(30, 10) && !figure.play() && !figure.play("run"));
    PantinCharacter<BANK_HERO_CHANNELS> &hero = inUsedMemory<PantinCharacter<BANK_HERO_CHANNELS>>();
    NEED(!hero.update(0) && !hero.input("go") && !hero.press(PantinInput(0)) && !hero.in("idle") && !hero.entered() && !hero.playing());
    hero.home();
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
    NEED(face.soundRate(8000) && !face.soundRate(7000) && face.talk.rate == 8000 && face.soundRate(16000) && !face.viseme(15, 0) && !face.weight("no such unit", 1));
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

static PantinCharacter<BANK_HERO_CHANNELS> hero;
static PantinCharacter<BANK_HERO_CHANNELS, 0, false> slider;
static PantinCharacter<BANK_HERO_CHANNELS - 1> narrow;

// A character that buttons steer: it walks on, and its poses are those of the functions in C with feet.
static void characters() {
    float cm[2] = {7, 7}, degrees = 7;
    char name[24] = "x";
    NEED(!hero.update(0) && !hero.input("go") && !hero.press(PantinInput(0)) && !hero.in("idle") && !hero.event("left_foot_down") && !hero.entered());
    NEED(!hero.place(cm) && cm[0] == 7 && !hero.heading(degrees) && degrees == 7 && !hero.stateName(name, sizeof name) && !*name && !hero.playing());
    NEED(!narrow.begin(BANK_HERO, BANK_HERO_LEN) && narrow.error() == PANTIN_NO_ROOM);
    NEED(!hero.begin(BANK_HERO, 100) && hero.error() != PANTIN_OK && !hero.update(1));
    NEED(!hero.begin(CLIP_RUN, CLIP_RUN_LEN) && hero.error() != PANTIN_OK);
    NEED(hero.begin(BANK_HERO, BANK_HERO_LEN) && hero.error() == PANTIN_OK && slider.begin(BANK_HERO, BANK_HERO_LEN));
    PantinInput go = hero.input("go"), jump = hero.input("jump");
    NEED(go && jump && !hero.input("nothing") && !hero.parameter("go") && !hero.hold(hero.input("nothing"), true) && !hero.set(PantinInput(), 1));
    NEED(hero.stateName(name, 3) && std::strcmp(name, "id") == 0 && hero.in("idle") && !hero.in("walk") && !hero.in("nothing"));
    uint32_t now = 500, steps = 0, held = 0, apart = 0;
    NEED(hero.update(now) && slider.update(now));
    for (int i = 0; i < 400; i++) {
        now += 16;
        if (i == 20) NEED(hero.hold(go, true) && slider.hold(slider.input("go"), true));
        if (i == 330) NEED(hero.press(jump) && slider.press(jump));
        NEED(hero.update(now) && slider.update(now));
        steps += hero.event("left_foot_down");
        NEED(!hero.event("no such event"));
        held += pantin_character_held(&hero.character, 0) != PANTIN_NO_JOINT;
        apart += std::memcmp(hero.character.animator.pose, slider.character.animator.pose, BANK_HERO_CHANNELS * 4) != 0;
        if (i == 300) NEED(hero.in("walk") && hero.stateName(name, sizeof name) && std::strcmp(name, "walk") == 0);
    }
    NEED(hero.in("jump") && hero.place(cm) && hero.heading(degrees) && degrees > -1 && degrees < 1);
    NEED(cm[0] * cm[0] + cm[1] * cm[1] > 100 * 100 && cm[0] * cm[0] + cm[1] * cm[1] < 1500 * 1500);
    NEED(steps > 3 && held > 100 && apart > 50);
    // While it is stopped nothing moves, and it goes on at another speed.
    hero.stop();
    NEED(!hero.update(now += 500));
    hero.resume();
    hero.speed(0);
    uint32_t frame = hero.character.animator.track.player.frame;
    for (int i = 0; i < 20; i++) NEED(hero.update(now += 16));
    NEED(hero.character.animator.track.player.frame == frame);
    hero.home();
    NEED(hero.update(now += 16) && hero.place(cm) && cm[0] == 0 && cm[1] == 0);
    hero.speed(100);
    std::printf("%u steps, a foot held in %u of 400 updates, %u bytes for a character\n", steps, held, static_cast<unsigned>(sizeof hero));
}

// A display with the calls of TFT_eSPI, and one with those of Adafruit_GFX.
struct Sent {
    uint16_t pixels[100][90];
    uint32_t count;
    void pushImage(int32_t x, int32_t y, int32_t w, int32_t h, uint16_t *data) {
        NEED(x >= 3 && y >= 2 && w > 0 && x + w <= 83 && y + h <= 100);
        count += static_cast<uint32_t>(w * h);
        for (int32_t row = 0; row < h; row++) std::memcpy(&pixels[y + row][x], data + row * w, static_cast<size_t>(w) * 2);
    }
};
struct Bitmap {
    uint16_t pixels[100][90];
    uint32_t count;
    void drawRGBBitmap(int16_t x, int16_t y, uint16_t *data, int16_t w, int16_t h) {
        NEED(x >= 0 && y >= 0 && w > 0 && x + w <= 80 && y + h <= 96);
        count += static_cast<uint32_t>(w * h);
        for (int16_t row = 0; row < h; row++) std::memcpy(&pixels[y + row][x], data + row * w, static_cast<size_t>(w) * 2);
    }
};

static PantinSolid<CLIP_RUN_CHANNELS, CLIP_RUN_FIGURE_JOINTS, CLIP_RUN_WORKSPACE> body;
static PantinSolid<BANK_HERO_CHANNELS, BANK_HERO_FIGURE_JOINTS, BANK_HERO_WORKSPACE> heroBody;
static Sent sent;
static Bitmap bitmap;

static void bodies() {
    static uint16_t rows[16 * 80], whole[96 * 80], swapped[96 * 80];
    uint32_t lit = 0, now = 0, pushed = 0;
    uint8_t nothing[4] = {0, 0, 0, 0};
    NEED(!body.draw(player, bitmap, rows, 16) && !body.rows(PANTIN_L8, rows, 80, 0, 1) && !body.look(nothing, sizeof nothing));
    PantinPlayer<CLIP_RUN_CHANNELS> unopened;
    NEED(!body.begin(unopened, 80, 96));
    NEED(player.begin(CLIP_RUN, CLIP_RUN_LEN) && !body.begin(player, 0, 96) && body.begin(player, 80, 96));
    NEED(hero.begin(BANK_HERO, BANK_HERO_LEN) && heroBody.begin(hero, 80, 96));
    for (int i = 0; i < 30; i++) {
        now += 33;
        player.update(now);
        NEED(hero.update(now));
        /* What was drawn by others is sent over: all of the first picture, and of the next one after redraw(). */
        if (i == 0 || i == 20) std::memset(bitmap.pixels, i + 1, sizeof bitmap.pixels);
        if (i == 20) body.redraw();
        bitmap.count = sent.count = 0;
        NEED(body.draw(player, bitmap, rows, 16) && heroBody.draw(hero, sent, rows, 13, 3, 2));
        NEED((bitmap.count == 80 * 96) == (i == 0 || i == 20) && (sent.count == 80 * 96) == (i == 0));
        pushed += bitmap.count + sent.count;
        NEED(body.rows(PANTIN_RGB565, whole, 160, 0, 96) && heroBody.rows(PANTIN_RGB565_SWAPPED, swapped, 160, 0, 96));
        for (int y = 0; y < 96; y++) {
            NEED(std::memcmp(bitmap.pixels[y], whole + 80 * y, 160) == 0 && std::memcmp(&sent.pixels[y + 2][3], swapped + 80 * y, 160) == 0);
            for (int x = 0; x < 80; x++) lit += whole[80 * y + x] != 0;
        }
    }
    NEED(!body.rows(PANTIN_L8, whole, 80, 0, 97) && lit > 30 * 500);
    /* Another place, and another number of rows, are sent whole. */
    sent.count = 0;
    NEED(heroBody.draw(hero, sent, rows, 13, 3, 3) && heroBody.draw(hero, sent, rows, 16, 3, 3) && sent.count == 2 * 80 * 96);
    std::printf("%u pixels of a body, %u %% of the pictures sent, %u bytes for it\n", lit, pushed / (2 * 30 * 80 * 96 / 100),
                static_cast<unsigned>(sizeof body));
}

int main() {
    beforeBegin();
    clips();
    faces();
    characters();
    bodies();
    return 0;
}
