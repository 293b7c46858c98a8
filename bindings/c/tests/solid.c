/* Prints checksums of pictures of solid figures and of figures of lines, for comparison with those of the crate pantin-figure
 * (xtask/commands/src/bindings/solid.rs):
 *
 *     solid CLIP.ptn LOOK [RIG.rig] : of a character's bytes, or - for the default one
 *     solid CLIP.ptn mutants LOOK COUNT : of damaged characters
 *
 * Compiled with SOLID_ALONE, it prints only the figure of the clip, for the module of MicroPython, which has no places and no second figure. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "pantin_solid.h"
#include "room.h"
#include "rows.h"

enum { BONES = 254, DRIVES = 1016, JOINTS = 192, CHAOS = 40, STEP = 3 };

static pantin_bone bones[BONES];
static pantin_drive drives[DRIVES];
static pantin_slot slots[PANTIN_FIGURE_SLOTS];
static pantin_joint_info scratch[JOINTS];
static pantin_solid solid;

/* A second figure of the same rig, which stands in the first one's world. */
static pantin_bone other_bones[BONES];
static pantin_drive other_drives[DRIVES];
static pantin_slot other_slots[PANTIN_FIGURE_SLOTS];
static pantin_solid other;

static const struct {
    uint16_t width, height;
    pantin_view view;
} shots[] = {
    {128, 64, {-50, 12, 0, PANTIN_RIG_UP}}, {240, 240, {0, 0, 1, PANTIN_RIG_UP}}, {84, 48, {-90, 35, 0, PANTIN_RIG_UP}},
    {171, 320, {140, -20, 0, PANTIN_RIG_UP}}, {480, 300, {20, 60, 1, 6}},
};

static pantin_result draw_solid(int format, void *rows, size_t stride, uint16_t y0, uint16_t y1) {
    return pantin_solid_draw(&solid, (pantin_format)format, rows, stride, y0, y1, 1);
}

static pantin_result draw_lines(int format, void *rows, size_t stride, uint16_t y0, uint16_t y1) {
    return pantin_figure_draw(&solid.figure, (pantin_format)format, rows, stride, y0, y1, 1);
}

static pantin_result draw_both(int format, void *rows, size_t stride, uint16_t y0, uint16_t y1) {
    const pantin_solid *both[2];
    both[0] = &solid;
    both[1] = &other;
    return pantin_solid_draw_together(both, 2, (pantin_format)format, rows, stride, y0, y1, 1);
}

static void print(const int32_t *values) {
    pantin_solid_pose(&solid, values);
    printf("%08x", (unsigned)checksum(draw_solid, solid.figure.width, solid.figure.height));
    pantin_figure_pose(&solid.figure, values);
    printf(" %08x\n", (unsigned)checksum(draw_lines, solid.figure.width, solid.figure.height));
}

/* Somewhere in the world, near the origin or far. */
static pantin_placement stand(uint32_t n) {
    pantin_placement at;
    uint32_t x = n * 1664525u + 1013904223u;
    uint8_t i;
    for (i = 0; i < 2; i++) {
        x = x * 1664525u + 1013904223u;
        at.place[i] = (int64_t)((int32_t)(x & 0xffffff00u) >> (n % 20)) * (n % 20 ? 1 : 0x1000001);
    }
    at.heading = n % 5 ? (int32_t)(x * 5 & 0xffffff00u) : 0;
    return at;
}

/* The pose in two places of one world. */
static void print_both(const int32_t *values, uint32_t n) {
    pantin_placement at = stand(n);
    pantin_solid_pose_at(&solid, values, &at);
    at = stand(n + 7);
    pantin_solid_pose_at(&other, values, &at);
    printf("both %08x\n", (unsigned)checksum(draw_both, solid.figure.width, solid.figure.height));
}

/* The pose somewhere in the world. */
static void print_at(const int32_t *values, uint32_t n) {
    pantin_placement at = stand(n);
    pantin_solid_pose_at(&solid, values, &at);
    printf("at %08x", (unsigned)checksum(draw_solid, solid.figure.width, solid.figure.height));
    pantin_figure_pose_at(&solid.figure, values, &at);
    printf(" %08x\n", (unsigned)checksum(draw_lines, solid.figure.width, solid.figure.height));
}

static int set_up(pantin_player *player, uint8_t shot) {
    pantin_result result;
    const uint8_t *look = solid.look;
    memset(&solid, 0, sizeof solid);
    solid.look = look;
    pantin_figure_memory(&solid.figure, bones, BONES, drives, DRIVES, slots, PANTIN_FIGURE_SLOTS);
    need(draw_solid(PANTIN_L8, bones, 1, 0, 0) == PANTIN_ERROR_HEAD, "nothing is drawn before the set-up");
    need(pantin_solid_aim(&solid, player, &shots[shot].view) == PANTIN_ERROR_HEAD, "no camera before the set-up");
    pantin_solid_pose(&solid, player->pose);
    result = pantin_solid_set_up(&solid, player, shots[shot].width, shots[shot].height, scratch, JOINTS);
    if (result != PANTIN_OK) return 0;
    need(pantin_solid_aim(&solid, player, &shots[shot].view) == PANTIN_OK && player->frame == 0, "aim");
    need(draw_solid(PANTIN_RGB565_SWAPPED + 1, bones, 4096, 0, 1) == PANTIN_NOT_FOUND, "no such format");
    need(draw_solid(PANTIN_L8, bones, solid.figure.width, 0, (uint16_t)(solid.figure.height + 1)) == PANTIN_NOT_FOUND, "rows beyond the display");
    need(draw_solid(PANTIN_RGB565, bones, solid.figure.width * 2u - 1, 0, 1) == PANTIN_NO_ROOM, "a short row");
    return 1;
}

/* Sets the second figure up in the world of the first. */
static void share(pantin_player *player, uint8_t shot) {
    const pantin_solid *many[PANTIN_SOLID_TOGETHER + 1];
    uint8_t i;
    for (i = 0; i <= PANTIN_SOLID_TOGETHER; i++) many[i] = &solid;
    memset(&other, 0, sizeof other);
    need(draw_both(PANTIN_L8, bones, 4096, 0, 0) == PANTIN_NOT_FOUND, "a figure that was not set up");
    pantin_figure_memory(&other.figure, other_bones, BONES, other_drives, DRIVES, other_slots, PANTIN_FIGURE_SLOTS);
    need(pantin_solid_set_up(&other, player, 33, 44, scratch, JOINTS) == PANTIN_OK, "set up");
    need(draw_both(PANTIN_L8, bones, 4096, 0, 0) == PANTIN_NOT_FOUND, "figures of two sizes");
    need(pantin_solid_draw_together(many, PANTIN_SOLID_TOGETHER + 1, PANTIN_L8, bones, 4096, 0, 0, 1) == PANTIN_NO_ROOM, "many figures");
    need(pantin_solid_draw_together(many, 0, PANTIN_L8, bones, 4096, 0, 0, 1) == PANTIN_ERROR_HEAD, "no figures");
    pantin_solid_share_camera(&other, &solid);
    need(pantin_solid_set_up(&other, player, shots[shot].width, shots[shot].height, scratch, JOINTS) == PANTIN_OK, "set up");
    pantin_solid_share_camera(&other, &solid);
}

static void mutants(pantin_player *player, const char *path, uint32_t count) {
    uint32_t length, n, flips, x = 1;
    uint8_t *look = file(path, &length), *mutant = (uint8_t *)malloc(length);
    need(mutant != NULL, "memory");
    for (n = 0; n < count; n++) {
        memcpy(mutant, look, length);
        for (flips = 0; flips <= n % 3; flips++) {
            x = x * 1664525u + 1013904223u;
            mutant[(x >> 8) % length] ^= (uint8_t)(1u << (x >> 29));
        }
        if (pantin_solid_look(&solid, mutant, length) != PANTIN_OK) {
            puts("refused");
            continue;
        }
        need(set_up(player, (uint8_t)(n % 3)), "set up");
        need(pantin_seek(player, n % player->clip->frames) == PANTIN_OK, "seek");
        print(pose);
    }
    free(look);
    free(mutant);
}

static void frames(pantin_player *player) {
    uint32_t frame, x = 1, n;
    uint16_t c;
    uint8_t shot;
    pantin_result refused;
    for (shot = 0; shot < sizeof shots / sizeof *shots; shot++) {
        need(pantin_restart(player) == PANTIN_OK, "restart");
        if (!set_up(player, shot)) {
            puts("none");
            continue;
        }
        printf("build %u\n", solid.build);
        share(player, shot);
        for (frame = 0; frame < player->clip->frames; frame += STEP) {
            need(pantin_seek(player, frame) == PANTIN_OK, "seek");
            print(pose);
#ifndef SOLID_ALONE
            if (frame % (4 * STEP) == 0) print_at(pose, frame / STEP);
            if (frame % (6 * STEP) == 0) print_both(pose, frame / STEP);
#endif
        }
    }
#ifdef SOLID_ALONE
    return;
#endif
    /* Poses that no clip contains. */
    for (n = 0; n < CHAOS && solid.figure.width; n++) {
        for (c = 0; c < player->clip->rig.channels; c++) {
            x = x * 1664525u + 1013904223u;
            pose[c] = (int32_t)(x & 0xffffff00u) >> (n % 16);
        }
        print(pose);
        print_at(pose, n);
        print_both(pose, n);
    }
    need(pantin_restart(player) == PANTIN_OK, "restart");
    for (n = 0; n < 4 && solid.figure.width; n++) {
        refused = pantin_solid_set_up(&solid, player, (uint16_t)(n == 0 ? 0 : n == 1 ? 2048 : 64), (uint16_t)(n == 2 ? 0 : n == 3 ? 2048 : 64), scratch, JOINTS);
        need(refused == PANTIN_NOT_FOUND && !solid.figure.width, "no such display");
        solid.figure.width = 1;
    }
}

int main(int argc, char **argv) {
    uint32_t length, rig_length, look_length;
    pantin_source source, rig_source;
    pantin_clip clip;
    pantin_rig rig;
    pantin_player player;
    uint8_t *bytes, *rig_bytes = NULL, *look = NULL;
    uint8_t damaged = argc == 5;
    if (argc < 3) return 2;
    bytes = file(argv[1], &length);
    pantin_memory(&source, bytes, length);
    if (argc == 4) {
        rig_bytes = file(argv[3], &rig_length);
        pantin_memory(&rig_source, rig_bytes, rig_length);
        need(pantin_open_rig(&rig, &rig_source, 0, rig_length) == PANTIN_OK, "rig");
    }
    need(pantin_open(&clip, &source, argc == 4 ? &rig : NULL) == PANTIN_OK, "open");
    need(pantin_start(&player, &clip, pose, 1023, moving, ROOM) == PANTIN_OK, "start");
    if (damaged) {
        mutants(&player, argv[3], (uint32_t)atol(argv[4]));
    } else {
        if (strcmp(argv[2], "-") != 0) {
            look = file(argv[2], &look_length);
            need(pantin_solid_look(&solid, look, look_length) == PANTIN_OK, "look");
        }
        frames(&player);
    }
    fprintf(stderr, "%u bones, %u parts\n", solid.figure.bone_count, solid.part_count);
    free(bytes);
    free(rig_bytes);
    free(look);
    return 0;
}
