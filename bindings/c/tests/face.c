/* Prints checksums of pictures of faces, for comparison with those of the crate pantin-face (tests/harness/vectors/faces.rs):
 *
 *     face emotes MODEL... : of every emote and of an o in its last frame, in the shots of the list below
 *     face frames MODEL... : the same with a line for each frame
 *     face chaos MODEL WIDTH HEIGHT ORBIT TILT PICTURES : with weights that no clip contains
 *     face mutants MODEL COUNT : of damaged models
 *
 * MODEL... are face.model and small.model. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "pantin_face.h"
#include "pantin_face_data.h"
#include "rows.h"

enum { CARTOON = 0, SMALL, FACE, WORDS = 8192 };

static const struct {
    uint8_t model;
    uint16_t width, height;
    int16_t orbit, tilt;
} shots[] = {
    {CARTOON, 64, 48, 0, 0}, {CARTOON, 128, 64, 0, 0}, {CARTOON, 240, 240, 0, 0}, {CARTOON, 171, 320, -20, 10},
    {SMALL, 84, 48, 0, 0},   {FACE, 128, 64, 0, 0},    {FACE, 125, 160, 40, -5},  {FACE, 240, 240, 0, 0},
};
static const char *const names[] = {"cartoon", "small", "face"};

static uint32_t memory[WORDS];
static pantin_face face;

static pantin_result draw(int format, void *rows, size_t stride, uint16_t y0, uint16_t y1) {
    return pantin_face_draw(&face, (pantin_face_format)format, rows, stride, y0, y1);
}

static void open_face(const uint8_t *model, uint32_t length, uint16_t width, uint16_t height, int16_t orbit, int16_t tilt) {
    need(pantin_face_open(&face, model, length, memory, sizeof memory) == PANTIN_OK, "open");
    need(pantin_face_size(&face, width, height) == PANTIN_OK, "size");
    need(pantin_face_aim(&face, orbit, tilt) == PANTIN_OK, "aim");
    need(pantin_face_emotes(&face, pantin_emotes, PANTIN_EMOTES) == PANTIN_OK, "emotes");
    need(pantin_face_transition(&face, 0) == PANTIN_OK, "transition");
}

/* A picture in which the mouth shows an o, and the emote gives way by three quarters. */
static uint32_t speaking(void) {
    uint32_t sum;
    need(pantin_face_viseme(&face, 13, 20000) == PANTIN_OK && pantin_face_speaking(&face, PANTIN_FACE_FULL * 3 / 4) == PANTIN_OK, "speech");
    sum = checksum(draw, face.width, face.height);
    need(pantin_face_viseme(&face, 0, 0) == PANTIN_OK && pantin_face_speaking(&face, 0) == PANTIN_OK, "the end of speech");
    return sum;
}

static uint32_t with(uint32_t whole, uint32_t sum, int each) {
    uint8_t bytes[4];
    bytes[0] = (uint8_t)sum;
    bytes[1] = (uint8_t)(sum >> 8);
    bytes[2] = (uint8_t)(sum >> 16);
    bytes[3] = (uint8_t)(sum >> 24);
    if (each) printf("%08x\n", (unsigned)sum);
    return fold(whole, bytes, 4);
}

static void emotes(int each, const uint8_t *const *models, const uint32_t *lengths) {
    uint32_t i, n, frame;
    for (i = 0; i < sizeof shots / sizeof *shots; i++) {
        uint8_t m = shots[i].model;
        printf("%s %ux%u %d %d\n", names[m], shots[i].width, shots[i].height, shots[i].orbit, shots[i].tilt);
        open_face(models[m], lengths[m], shots[i].width, shots[i].height, shots[i].orbit, shots[i].tilt);
        for (n = 0; n < PANTIN_EMOTES; n++) {
            uint32_t whole = 0x811c9dc5u;
            need(pantin_face_emote(&face, pantin_emotes[n].name) == PANTIN_OK, "emote");
            if (each) puts(pantin_emotes[n].name);
            for (frame = 0; frame < face.clip.frames; frame++) {
                need(face.player.frame == frame, "the frame that is due");
                whole = with(whole, checksum(draw, face.width, face.height), each);
                if (frame + 1 == face.clip.frames) whole = with(whole, speaking(), each);
                /* 30 frames a second: 33 ms, and a third of one. */
                need(pantin_face_step(&face, (uint16_t)(33 + (frame % 3 == 0))) == PANTIN_OK, "step");
            }
            if (!each) printf("%s %08x\n", pantin_emotes[n].name, (unsigned)whole);
        }
    }
}

static void chaos(uint32_t pictures) {
    uint32_t x = 1, picture;
    uint8_t i, side;
    for (picture = 0; picture < pictures; picture++) {
        for (i = 0; i < face.model.shape_count; i++) {
            for (side = 0; side < 2; side++) {
                x = x * 1664525u + 1013904223u;
                face.own[i][side] = 0;
                if (picture % 2 || x >> 28 == 0) face.own[i][side] = (int16_t)((int16_t)(x >> 12) >> (picture % 3));
            }
        }
        need(pantin_face_look(&face, 0, 0) == PANTIN_OK, "weights changed");
        printf("%08x\n", (unsigned)checksum(draw, face.width, face.height));
    }
}

static uint32_t random_state = 1;

static uint32_t random_below(uint32_t below) {
    random_state = random_state * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)random_state * below >> 32);
}

static void mutants(const uint8_t *model, uint32_t length, uint32_t count) {
    uint8_t *mutant = (uint8_t *)malloc(length);
    uint32_t *exact, flips;
    need(mutant != NULL, "memory");
    while (count-- > 0) {
        memcpy(mutant, model, length);
        for (flips = random_below(3) + 1; flips > 0; flips--) {
            uint32_t at = random_below(length);
            mutant[at] ^= (uint8_t)(1 << random_below(8));
        }
        if (pantin_face_open(&face, mutant, length, NULL, 0) != PANTIN_NO_ROOM) {
            puts("refused");
            continue;
        }
        exact = (uint32_t *)malloc(face.needed);
        need(exact != NULL && pantin_face_open(&face, mutant, length, exact, face.needed) == PANTIN_OK, "open");
        need(pantin_face_size(&face, 61, 40) == PANTIN_OK, "size");
        chaos(2);
        free(exact);
    }
    free(mutant);
}

int main(int argc, char **argv) {
    const uint8_t *models[3];
    uint32_t lengths[3];
    if (argc == 8 && strcmp(argv[1], "chaos") == 0) {
        uint8_t *model = file(argv[2], lengths);
        open_face(model, *lengths, (uint16_t)atoi(argv[3]), (uint16_t)atoi(argv[4]), (int16_t)atoi(argv[5]), (int16_t)atoi(argv[6]));
        chaos((uint32_t)atol(argv[7]));
        free(model);
        return 0;
    }
    if (argc != 4) return 2;
    if (strcmp(argv[1], "mutants") == 0) {
        uint8_t *model = file(argv[2], lengths);
        mutants(model, *lengths, (uint32_t)atol(argv[3]));
        free(model);
        return 0;
    }
    models[CARTOON] = pantin_cartoon;
    lengths[CARTOON] = sizeof pantin_cartoon;
    models[FACE] = file(argv[2], &lengths[FACE]);
    models[SMALL] = file(argv[3], &lengths[SMALL]);
    emotes(strcmp(argv[1], "frames") == 0, models, lengths);
    free((void *)(uintptr_t)models[FACE]);
    free((void *)(uintptr_t)models[SMALL]);
    return 0;
}
