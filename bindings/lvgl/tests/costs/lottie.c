/* Writes an emote of the cartoon face as Lottie, as a designer would draw it: each filled shape is a path with key frames, between which Lottie interpolates.
 *
 *     lottie EMOTE FRAMES STEP > face.json */
#include <stdio.h>
#include <stdlib.h>

#include "pantin_face.h"
#include "pantin_face_data.h"

enum { SIZE = 240, MOST = 100 };

static uint32_t memory[PANTIN_FACE_WORDS(97, 12)];
static pantin_face face;
static int16_t places[MOST][97][2];
static uint16_t rows[SIZE * SIZE];

/* The shape as it is at a key frame. */
static void shape(const uint8_t *curve, int mirrored, uint32_t key) {
    uint16_t i, stored = (uint16_t)(face.model.middles + face.model.pairs);
    int side;
    printf("\"i\":[");
    for (i = 0; i < curve[2]; i++) printf("%s[0,0]", i ? "," : "");
    printf("],\"o\":[");
    for (i = 0; i < curve[2]; i++) printf("%s[0,0]", i ? "," : "");
    printf("],\"v\":[");
    for (i = 0; i < curve[2]; i++) {
        uint16_t index = curve[3 + i];
        if (mirrored && index >= face.model.middles) index = (uint16_t)(index < stored ? index + face.model.pairs : index - face.model.pairs);
        printf("%s[", i ? "," : "");
        for (side = 0; side < 2; side++) printf("%s%.1f", side ? "," : "", places[key][index][side] / 16.0);
        printf("]");
    }
    printf("],\"c\":true");
}

static void layer(const uint8_t *curve, int mirrored, uint32_t number, uint32_t frames, uint32_t step, uint32_t keys) {
    uint32_t key;
    printf("%s{\"ty\":4,\"ind\":%u,\"ip\":0,\"op\":%u,\"st\":0,\"ks\":{\"o\":{\"a\":0,\"k\":100},\"r\":{\"a\":0,\"k\":0},\"p\":{\"a\":0,\"k\":[0,0,0]},"
           "\"a\":{\"a\":0,\"k\":[0,0,0]},\"s\":{\"a\":0,\"k\":[100,100,100]}},\"shapes\":[{\"ty\":\"gr\",\"it\":[{\"ty\":\"sh\",\"ks\":{\"a\":1,\"k\":[",
           number ? "," : "", (unsigned)number + 1, (unsigned)frames);
    for (key = 0; key < keys; key++) {
        printf("%s{\"t\":%u,\"s\":[{", key ? "," : "", (unsigned)(key * step));
        shape(curve, mirrored, key);
        printf("}],\"i\":{\"x\":[1],\"y\":[1]},\"o\":{\"x\":[0],\"y\":[0]}}");
    }
    printf("]}},{\"ty\":\"fl\",\"c\":{\"a\":0,\"k\":[%.2f,%.2f,%.2f,1]},\"o\":{\"a\":0,\"k\":100}},{\"ty\":\"tr\",\"p\":{\"a\":0,\"k\":[0,0]},"
           "\"a\":{\"a\":0,\"k\":[0,0]},\"s\":{\"a\":0,\"k\":[100,100]},\"r\":{\"a\":0,\"k\":0},\"o\":{\"a\":0,\"k\":100}}]}]}",
           curve[1] / 255.0, curve[1] * 236 / 65025.0, curve[1] * 205 / 65025.0);
}

int main(int argc, char **argv) {
    const uint8_t *curves[64];
    const uint8_t *at;
    uint32_t frames, step, keys = 0, frame, number = 0;
    int i, mirrored, count = 0;
    uint16_t v;
    if (argc != 4) return 2;
    frames = (uint32_t)atoi(argv[2]);
    step = (uint32_t)atoi(argv[3]);
    if (pantin_face_open(&face, pantin_cartoon, sizeof pantin_cartoon, memory, sizeof memory) != PANTIN_OK) return 3;
    if (pantin_face_size(&face, SIZE, SIZE) != PANTIN_OK || pantin_face_emotes(&face, pantin_emotes, PANTIN_EMOTES) != PANTIN_OK) return 3;
    pantin_face_transition(&face, 0);
    if (pantin_face_emote(&face, argv[1]) != PANTIN_OK) return 3;
    for (frame = 0; frame <= frames; frame++) {
        if (pantin_face_draw(&face, PANTIN_RGB565, rows, SIZE * 2, 0, SIZE) != PANTIN_OK) return 3;
        if (frame % step == 0 && keys < MOST) {
            for (v = 0; v < 97; v++) {
                places[keys][v][0] = face.points[v][0];
                places[keys][v][1] = face.points[v][1];
            }
            keys++;
        }
        pantin_face_step(&face, frame % 3 ? 33 : 34);
    }
    for (at = face.model.curves, i = 0; i < face.model.curve_count; i++, at += 3 + at[2]) {
        /* Shapes that a prop would open are nothing in this emote. */
        if (at[0] & 0x40 && !(at[0] & 0x10)) curves[count++] = at;
    }
    printf("{\"v\":\"5.7.0\",\"fr\":30,\"ip\":0,\"op\":%u,\"w\":%d,\"h\":%d,\"assets\":[],\"layers\":[", (unsigned)frames, SIZE, SIZE);
    /* The first layer is the topmost. */
    while (count--) {
        for (mirrored = curves[count][0] & 2 ? 1 : 0; mirrored >= 0; mirrored--) {
            layer(curves[count], mirrored, number++, frames, step, keys);
        }
    }
    printf("]}\n");
    return 0;
}
