// Runs a cartridge image in mGBA without a window and writes what the display shows.
//
//     run ROM FRAMES [FRAME:KEYS]...
//
// Standard output gets FRAMES pictures of 240x160 pixels, 16 bits each (red in the lowest five bits, then green, blue), little-endian:
// what the display showed in each frame. From the start of frame FRAME on, the buttons of the bits KEYS are held.
//
//     run --cycles ROM FRAMES [FRAME:KEYS]...
//
// Standard output gets instead a line for each stretch between the marking instructions `mov r9, r9` and `mov r10, r10`: the frame in
// which it ended, its clock cycles and its instructions.
#include <mgba/core/core.h>
#include <mgba/core/log.h>
#include <mgba/core/timing.h>
#include <mgba/internal/arm/arm.h>
#include <mgba-util/vfs.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 240,
    HEIGHT = 160,
    START = 0xe1a09009,
    STOP = 0xe1a0a00a,
    THUMB_START = 0x46c9,
    THUMB_STOP = 0x46d2,
};

static color_t pixels[WIDTH * HEIGHT];

static void quiet(struct mLogger* logger, int category, enum mLogLevel level, const char* format, va_list arguments) {
    (void) logger, (void) category;
    // What a program does wrong, such as an access to memory that is not there, is an error of the image.
    if (level & (mLOG_FATAL | mLOG_ERROR | mLOG_GAME_ERROR)) {
        vfprintf(stderr, format, arguments);
        fputc('\n', stderr);
    }
}

static int fail(const char* what) {
    fprintf(stderr, "%s\n", what);
    return 1;
}

static uint32_t keys_at(int frame, int count, char** script) {
    uint32_t keys = 0;
    for (int index = 0; index < count; ++index) {
        int from = 0;
        unsigned held = 0;
        if (sscanf(script[index], "%d:%u", &from, &held) == 2 && from <= frame) {
            keys = held;
        }
    }
    return keys;
}

static void write_picture(void) {
    unsigned char bytes[2 * WIDTH * HEIGHT];
    for (int index = 0; index < WIDTH * HEIGHT; ++index) {
        unsigned value = M_RGB8_TO_BGR5(pixels[index]);
        bytes[2 * index] = value & 0xff;
        bytes[2 * index + 1] = value >> 8;
    }
    fwrite(bytes, 1, sizeof bytes, stdout);
}

// The stretch that is open.
static uint32_t began;
static long instructions;
static int open_stretch;

static void step(struct mCore* core, int frame) {
    struct ARMCore* cpu = core->cpu;
    int thumb = cpu->executionMode != MODE_ARM;
    uint32_t next = cpu->prefetch[0];
    core->step(core);
    ++instructions;
    if (next == (thumb ? THUMB_START : START)) {
        began = mTimingCurrentTime(core->timing);
        instructions = 0;
        open_stretch = 1;
    } else if (next == (thumb ? THUMB_STOP : STOP) && open_stretch) {
        // The last instruction is the marker.
        printf("%d %u %ld\n", frame, mTimingCurrentTime(core->timing) - began, instructions - 1);
        open_stretch = 0;
    }
}

int main(int count, char** words) {
    int cycles = count > 1 && !strcmp(words[1], "--cycles");
    int first = 1 + cycles;
    if (count < first + 2) {
        return fail("Usage: run [--cycles] ROM FRAMES [FRAME:KEYS]...");
    }
    struct mLogger logger = { .log = quiet };
    mLogSetDefaultLogger(&logger);
    struct VFile* rom = VFileOpen(words[first], O_RDONLY);
    if (!rom) {
        return fail("the image cannot be opened");
    }
    struct mCore* core = mCoreFindVF(rom);
    if (!core || core->platform(core) != mPLATFORM_GBA) {
        return fail("mGBA takes the image for no cartridge of this console");
    }
    core->init(core);
    mCoreInitConfig(core, NULL);
    mCoreConfigSetDefaultValue(&core->config, "idleOptimization", "ignore");
    mCoreLoadConfig(core);
    core->setVideoBuffer(core, pixels, WIDTH);
    if (!core->loadROM(core, rom)) {
        return fail("the image cannot be loaded");
    }
    core->reset(core);
    int frames = atoi(words[first + 1]);
    for (int frame = 0; frame < frames; ++frame) {
        core->setKeys(core, keys_at(frame, count - first - 2, words + first + 2));
        if (cycles) {
            uint32_t before = core->frameCounter(core);
            while (core->frameCounter(core) == before) {
                step(core, frame);
            }
        } else {
            core->runFrame(core);
            write_picture();
        }
    }
    core->deinit(core);
    return 0;
}
