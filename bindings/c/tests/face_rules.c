/* What a face promises besides its pixels: errors that change nothing, transitions without a jump, eyes that live by themselves, rows that are the
 * same however they are divided.
 *
 *     face_rules FACE.model KEYS.ptn */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "pantin_face.h"
#include "pantin_face_data.h"

enum { WORDS = PANTIN_FACE_WORDS(97, 6), SIDE = 96, SHAPES = PANTIN_FACE_SHAPES };

static uint32_t memory[WORDS], large[4096];
static uint16_t rows[SIDE * SIDE], other[SIDE * SIDE];
static pantin_face face;

static void need(int held, const char *what, const char *name) {
    if (held) return;
    printf("failed: %s %s\n", what, name);
    exit(1);
}

static void open_cartoon(pantin_face *f, uint32_t *words, size_t size) {
    need(pantin_face_open(f, pantin_cartoon, sizeof pantin_cartoon, words, size) == PANTIN_OK, "open", "");
    need(pantin_face_size(f, SIDE, SIDE) == PANTIN_OK, "size", "");
    need(pantin_face_emotes(f, pantin_emotes, PANTIN_EMOTES) == PANTIN_OK, "emotes", "");
}

static void draw(uint16_t *to) { need(pantin_face_draw(&face, PANTIN_RGB565, to, 2 * SIDE, 0, SIDE) == PANTIN_OK, "draw", ""); }

static void nothing(void *context, uint16_t x, uint16_t y, uint16_t count, uint8_t shade) {
    (void)context, (void)x, (void)y, (void)count, (void)shade;
}

static void closed_faces(void) {
    static pantin_face closed;
    uint8_t byte = 7;
    need(pantin_face_size(&closed, 64, 64) == PANTIN_ERROR_HEAD && pantin_face_shift(&closed, 0, 0) == PANTIN_ERROR_HEAD &&
             pantin_face_aim(&closed, 0, 0) == PANTIN_ERROR_HEAD && pantin_face_palette(&closed, NULL) == PANTIN_ERROR_HEAD &&
             pantin_face_emotes(&closed, pantin_emotes, 1) == PANTIN_ERROR_HEAD && pantin_face_emote(&closed, "happy") == PANTIN_ERROR_HEAD &&
             pantin_face_play(&closed, pantin_emote_sad, sizeof pantin_emote_sad) == PANTIN_ERROR_HEAD &&
             pantin_face_transition(&closed, 1) == PANTIN_ERROR_HEAD && pantin_face_weight(&closed, "joy", 0) == PANTIN_ERROR_HEAD &&
             pantin_face_look(&closed, 0, 0) == PANTIN_ERROR_HEAD && pantin_face_mouth(&closed, 0) == PANTIN_ERROR_HEAD &&
             pantin_face_viseme(&closed, 1, 0) == PANTIN_ERROR_HEAD && pantin_face_speaking(&closed, 0) == PANTIN_ERROR_HEAD && pantin_face_live(&closed, 1) == PANTIN_ERROR_HEAD &&
             pantin_face_step(&closed, 1) == PANTIN_ERROR_HEAD && pantin_face_draw(&closed, PANTIN_L8, &byte, 1, 0, 0) == PANTIN_ERROR_HEAD &&
             pantin_face_spans(&closed, nothing, NULL, 0, 0) == PANTIN_ERROR_HEAD && byte == 7,
         "every call before open is refused", "");
    /* After open, but without a size. */
    need(pantin_face_open(&closed, pantin_cartoon, sizeof pantin_cartoon, memory, sizeof memory) == PANTIN_OK, "open", "");
    need(pantin_face_draw(&closed, PANTIN_L8, &byte, 1, 0, 1) == PANTIN_ERROR_HEAD && byte == 7, "a face without a size draws nothing", "");
    need(pantin_face_open(&closed, pantin_cartoon, sizeof pantin_cartoon, memory, 100) == PANTIN_NO_ROOM && closed.needed > 1000, "no room", "");
    need(pantin_face_size(&closed, 64, 64) == PANTIN_ERROR_HEAD, "a face that did not open stays closed", "");
}

static void refusals(void) {
    static uint8_t damaged[sizeof pantin_emote_happy];
    uint32_t i;
    open_cartoon(&face, memory, sizeof memory);
    need(pantin_face_emote(&face, "happy") == PANTIN_OK, "emote", "happy");
    pantin_face_step(&face, 500);
    draw(rows);
    need(pantin_face_size(&face, 0, 10) == PANTIN_NOT_FOUND && pantin_face_size(&face, 10, 2048) == PANTIN_NOT_FOUND, "sizes", "");
    need(pantin_face_emote(&face, "hapy") == PANTIN_NOT_FOUND && pantin_face_emote(&face, "") == PANTIN_NOT_FOUND, "names of emotes", "");
    need(pantin_face_weight(&face, "hapy", 1) == PANTIN_NOT_FOUND && pantin_face_weight(&face, "", 1) == PANTIN_NOT_FOUND, "names of units", "");
    need(pantin_face_emote(&face, NULL) == PANTIN_NOT_FOUND && pantin_face_weight(&face, NULL, 1) == PANTIN_NOT_FOUND, "no name", "");
    need(pantin_face_viseme(&face, 15, 1) == PANTIN_NOT_FOUND, "visemes", "");
    need(pantin_face_shift(&face, 1024, 0) == PANTIN_NOT_FOUND, "shifts", "");
    need(pantin_face_draw(&face, PANTIN_RGB565, other, 2 * SIDE - 1, 0, 1) == PANTIN_NO_ROOM, "narrow rows", "");
    need(pantin_face_draw(&face, PANTIN_RGB565, other, 2 * SIDE, 0, SIDE + 1) == PANTIN_NOT_FOUND, "rows below", "");
    need(pantin_face_draw(&face, PANTIN_RGB565, other, 2 * SIDE, 2, 1) == PANTIN_NOT_FOUND, "rows backwards", "");
    need(pantin_face_draw(&face, (pantin_face_format)9, other, 2 * SIDE, 0, 1) == PANTIN_NOT_FOUND, "formats", "");
    /* Clips with any bit flipped, cut at any place, or without a scalar of the face. */
    for (i = 0; i < 8 * sizeof damaged; i++) {
        memcpy(damaged, pantin_emote_happy, sizeof damaged);
        damaged[i / 8] ^= (uint8_t)(1 << i % 8);
        need(pantin_face_play(&face, damaged, sizeof damaged) != PANTIN_OK, "a damaged clip", "");
    }
    for (i = 0; i < sizeof damaged; i++) need(pantin_face_play(&face, pantin_emote_happy, i) != PANTIN_OK, "a cut clip", "");
    draw(other);
    need(memcmp(rows, other, sizeof rows) == 0, "refusals change nothing", "");
}

/* The weights that are used. */
static void copy_weights(int16_t (*to)[2]) {
    uint8_t i, side;
    need(pantin_face_draw(&face, PANTIN_RGB565, rows, 2 * SIDE, 0, 1) == PANTIN_OK, "draw", "");
    for (i = 0; i < face.model.shape_count; i++) {
        for (side = 0; side < 2; side++) {
            int16_t weight = face.weights[i][side];
            to[i][side] = weight < -16384 ? -16384 : weight > 16384 ? 16384 : weight;
        }
    }
}

static int largest_change(int16_t (*a)[2], int16_t (*b)[2]) {
    int most = 0;
    uint8_t i, side;
    for (i = 0; i < face.model.shape_count; i++) {
        for (side = 0; side < 2; side++) {
            int change = abs(a[i][side] - b[i][side]);
            if (change > most) most = change;
        }
    }
    return most;
}

static void transitions(void) {
    static int16_t before[SHAPES][2], after[SHAPES][2];
    uint16_t from, to, ms, random = 1;
    int worst = 0, own = 0, change;
    open_cartoon(&face, memory, sizeof memory);
    /* How far the emotes themselves move weights from frame to frame. */
    pantin_face_transition(&face, 0);
    for (to = 0; to < PANTIN_EMOTES; to++) {
        need(pantin_face_emote(&face, pantin_emotes[to].name) == PANTIN_OK, "emote", pantin_emotes[to].name);
        copy_weights(after);
        for (ms = 0; ms < 2500; ms = (uint16_t)(ms + 5)) {
            memcpy(before, after, sizeof before);
            pantin_face_step(&face, 5);
            copy_weights(after);
            change = largest_change(before, after);
            if (change > own) own = change;
        }
    }
    pantin_face_transition(&face, 300);
    for (from = 0; from < PANTIN_EMOTES; from++) {
        for (to = 0; to < PANTIN_EMOTES; to++) {
            need(pantin_face_emote(&face, pantin_emotes[from].name) == PANTIN_OK, "emote", pantin_emotes[from].name);
            random = (uint16_t)(random * 25173u + 13849u);
            /* Also while the transition before is under way. */
            pantin_face_step(&face, (uint16_t)(random % 700));
            copy_weights(before);
            need(pantin_face_emote(&face, pantin_emotes[to].name) == PANTIN_OK, "emote", pantin_emotes[to].name);
            copy_weights(after);
            need(largest_change(before, after) <= 1, "an emote begins with a jump:", pantin_emotes[to].name);
            for (ms = 0; ms < 400; ms = (uint16_t)(ms + 5)) {
                memcpy(before, after, sizeof before);
                pantin_face_step(&face, 5);
                copy_weights(after);
                change = largest_change(before, after);
                if (change > worst) worst = change;
            }
        }
    }
    printf("largest change in 5 ms: %d of 16384 in transitions, %d in emotes alone\n", worst, own);
    /* The ease is steepest in its middle: half again as steep as a line from -1 to 1 in 300 ms. */
    need(worst <= own + 2 * 16384 * 3 / 2 * 5 / 300 + 4, "a transition jumps", "");
}

static void eyes(void) {
    static pantin_face twin;
    uint32_t ms, blinks = 0, closed = 0, same = 0, glances = 0;
    int16_t seen[2] = {0, 0};
    open_cartoon(&face, memory, sizeof memory);
    open_cartoon(&twin, large, sizeof large);
    draw(other);
    pantin_face_live(&face, 5);
    pantin_face_live(&twin, 6);
    for (ms = 0; ms < 60000; ms += 20) {
        uint8_t before = face.blink_ms;
        pantin_face_step(&face, 20);
        pantin_face_step(&twin, 20);
        blinks += face.blink_ms == 1 && before != 1;
        glances += face.glance[0] != seen[0];
        seen[0] = face.glance[0];
        same += face.blink_ms == twin.blink_ms && face.glance[0] == twin.glance[0];
        draw(rows);
        closed += memcmp(rows, other, sizeof rows) != 0;
    }
    need(blinks >= 10 && blinks <= 30, "10 to 30 blinks a minute", "");
    need(glances >= 15 && glances <= 85, "15 to 85 glances a minute", "");
    need(closed > 200 && same < 2900, "the eyes move, by their seed", "");
    pantin_face_live(&face, 0);
    for (ms = 0; ms < 600; ms += 20) pantin_face_step(&face, 20);
    draw(rows);
    need(memcmp(rows, other, sizeof rows) == 0, "at rest again", "");
    pantin_face_look(&face, PANTIN_FACE_FULL, 0);
    draw(rows);
    need(memcmp(rows, other, sizeof rows) != 0, "a look is seen", "");
}

/* The middle of what is lit in the eyes' rows, in columns times 256. */
static int32_t middle_of_dark(void) {
    int32_t total = 0, count = 0;
    int x, y;
    draw(rows);
    /* The pupil of the eye on the right: dark between lit pixels. */
    for (y = SIDE / 5; y < SIDE / 2; y++) {
        int first = -1, last = -1;
        for (x = SIDE / 2; x < SIDE; x++) {
            if (!rows[y * SIDE + x]) continue;
            if (first < 0) first = x;
            last = x;
        }
        for (x = first; x >= 0 && x < last; x++) {
            if (rows[y * SIDE + x]) continue;
            total += x * 256;
            count++;
        }
    }
    return count ? total / count : -1;
}

static void looks(void) {
    int32_t right, left;
    open_cartoon(&face, memory, sizeof memory);
    pantin_face_look(&face, PANTIN_FACE_FULL / 2, 0);
    right = middle_of_dark();
    pantin_face_look(&face, -PANTIN_FACE_FULL / 2, 0);
    left = middle_of_dark();
    need(left > 0 && right > left + 256, "a look to the right moves the pupil to the right", "");
}

static void mouths(void) {
    open_cartoon(&face, memory, sizeof memory);
    draw(other);
    pantin_face_mouth(&face, PANTIN_FACE_FULL);
    draw(rows);
    need(memcmp(rows, other, sizeof rows) != 0, "an open mouth is seen", "");
    pantin_face_viseme(&face, 1, PANTIN_FACE_FULL);
    draw(rows);
    pantin_face_mouth(&face, 0);
    draw(other);
    need(memcmp(rows, other, sizeof rows) == 0, "visemes win over the mouth", "");
    pantin_face_viseme(&face, 0, 0);
    draw(rows);
    need(memcmp(rows, other, sizeof rows) != 0, "viseme 0 ends them", "");
}

/* Lips of a face whose emote opens the mouth meet while it speaks. */
static void open_mouths(void) {
    static const char *const open[] = {"surprised", "shocked", "laughing", "crying", "silly", "delicious"};
    uint32_t i;
    for (i = 0; i < sizeof open / sizeof *open; i++) {
        uint8_t jaw = 0, shape;
        open_cartoon(&face, memory, sizeof memory);
        need(pantin_face_emote(&face, open[i]) == PANTIN_OK && pantin_face_step(&face, 600) == PANTIN_OK, "an emote", open[i]);
        draw(rows);
        for (shape = 0; shape < face.model.shape_count; shape++) jaw |= face.spoken[shape] && face.weights[shape][0] > 1000;
        need(jaw, "the emote opens the mouth", open[i]);
        pantin_face_speaking(&face, PANTIN_FACE_FULL);
        draw(other);
        for (shape = 0; shape < face.model.shape_count; shape++) {
            need(!face.spoken[shape] || face.weights[shape][0] == 0, "the emote gives way to speech", open[i]);
        }
        pantin_face_speaking(&face, 0);
        draw(other);
        need(memcmp(rows, other, sizeof rows) == 0, "the emote comes back", open[i]);
    }
}

static uint8_t greys[SIDE * SIDE];

static void paint(void *context, uint16_t x, uint16_t y, uint16_t count, uint8_t shade) {
    need(context == greys && x + count <= SIDE && y < SIDE && count > 0, "a span inside", "");
    memset(greys + y * SIDE + x, shade, count);
}

static void divisions(void) {
    static uint8_t whole[SIDE * SIDE];
    static uint16_t palette[16];
    uint16_t height, y, i;
    open_cartoon(&face, memory, sizeof memory);
    pantin_face_emote(&face, "laughing");
    pantin_face_shift(&face, -9, 20);
    pantin_face_step(&face, 700);
    need(pantin_face_draw(&face, PANTIN_L8, whole, SIDE, 0, SIDE) == PANTIN_OK, "draw", "");
    for (height = 1; height < 40; height++) {
        memset(greys, 0, sizeof greys);
        for (y = 0; y < SIDE; y = (uint16_t)(y + height)) {
            uint16_t end = (uint16_t)(y + height < SIDE ? y + height : SIDE);
            need(pantin_face_draw(&face, PANTIN_L8, greys + y * SIDE, SIDE, y, end) == PANTIN_OK, "draw", "");
        }
        need(memcmp(greys, whole, sizeof whole) == 0, "bands are the whole picture", "");
    }
    memset(greys, 0, sizeof greys);
    need(pantin_face_spans(&face, paint, greys, 0, SIDE) == PANTIN_OK, "spans", "");
    need(memcmp(greys, whole, sizeof whole) == 0, "spans are the picture", "");
    for (i = 0; i < 16; i++) palette[i] = (uint16_t)(0x1234 + 0x1111 * i);
    pantin_face_palette(&face, palette);
    draw(rows);
    for (i = 0; i < SIDE * SIDE; i++) need(rows[i] == palette[whole[i] >> 4], "colours of one's own", "");
    need(pantin_face_draw(&face, PANTIN_RGB565_SWAPPED, other, 2 * SIDE, 0, SIDE) == PANTIN_OK, "draw", "");
    for (i = 0; i < SIDE * SIDE; i++) need(other[i] == (uint16_t)(rows[i] << 8 | rows[i] >> 8), "bytes exchanged", "");
}

/* Every emote of the wireframe model, in memory that was announced; then memory for a tenth of it. */
static void wireframe(const char *path) {
    uint32_t length, n;
    uint8_t *model = file(path, &length);
    need(pantin_face_open(&face, model, length, large, PANTIN_FACE_WORDS(239, 6) * 4) == PANTIN_OK, "open", path);
    pantin_face_size(&face, SIDE, SIDE);
    pantin_face_emotes(&face, pantin_emotes, PANTIN_EMOTES);
    for (n = 0; n < PANTIN_EMOTES; n++) need(pantin_face_emote(&face, pantin_emotes[n].name) == PANTIN_OK, "emote", pantin_emotes[n].name);
    need(pantin_face_open(&face, model, length, large, face.needed + 8) == PANTIN_OK, "open", path);
    pantin_face_size(&face, SIDE, SIDE);
    pantin_face_emotes(&face, pantin_emotes, PANTIN_EMOTES);
    n = face.needed;
    need(pantin_face_emote(&face, "happy") == PANTIN_NO_ROOM && face.needed > n, "no room for a clip", "");
    draw(rows);
    free(model);
}

/* A key clip has more states than its rig has channels. */
static void key_clips(const char *path) {
    uint32_t length, needed;
    uint8_t *clip = file(path, &length);
    open_cartoon(&face, memory, sizeof memory);
    open_cartoon(&face, large, face.needed);
    need(pantin_face_play(&face, clip, length) == PANTIN_NO_ROOM, "no room for a key clip", path);
    needed = face.needed;
    open_cartoon(&face, large, needed);
    need(pantin_face_play(&face, clip, length) == PANTIN_OK, "what is needed suffices for a key clip", path);
    draw(rows);
    need(pantin_face_step(&face, 500) == PANTIN_OK, "a key clip plays", path);
    draw(other);
    need(memcmp(rows, other, sizeof rows) != 0, "a key clip moves the face", path);
    open_cartoon(&face, large, needed - 4);
    need(pantin_face_play(&face, clip, length) == PANTIN_NO_ROOM && face.needed == needed, "no room for a key clip", path);
    free(clip);
}

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    closed_faces();
    refusals();
    transitions();
    eyes();
    looks();
    mouths();
    open_mouths();
    divisions();
    wireframe(argv[1]);
    key_clips(argv[2]);
    return 0;
}
