/* Prints the lines of a clip's figure on some displays and from some sides, for comparison with those of the crate pantin-figure.
 *
 *     figure CLIP.ptn [RIG.rig] */
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "pantin_figure.h"

enum { BONES = 254, DRIVES = 1016, JOINTS = 192, CHAOS = 40 };

static pantin_bone bones[BONES];
static pantin_drive drives[DRIVES];
static pantin_slot slots[PANTIN_FIGURE_SLOTS];
static pantin_joint_info scratch[JOINTS];
static int32_t pose[1023];
static pantin_channel moving[1023];

static const struct {
    uint16_t width, height;
    pantin_view view;
} shots[] = {
    {128, 64, {-50, 12, 0, PANTIN_RIG_UP}},
    {128, 64, {0, 0, 1, PANTIN_RIG_UP}},
    {320, 240, {-90, 35, 0, PANTIN_RIG_UP}},
    {240, 240, {140, -20, 1, 6}},
};

static void print_lines(pantin_figure *figure, const int32_t *values) {
    pantin_ground ground;
    pantin_line line;
    pantin_head head;
    uint8_t i;
    pantin_figure_pose(figure, values);
    pantin_first_ground(&ground, figure);
    while (pantin_next_ground(&ground, &line)) {
        if (figure->dotted) {
            printf("d %d %d %u\n", line.from[0], line.from[1], line.shade);
        } else {
            printf("g %d %d %d %d %d %u\n", line.from[0], line.from[1], line.to[0], line.to[1], line.depth, line.shade);
        }
    }
    for (i = 0; pantin_figure_line(figure, i, &line); i++) {
        printf("b %d %d %d %d %d %u %u %u\n", line.from[0], line.from[1], line.to[0], line.to[1], line.depth, line.shade, line.part, line.width);
    }
    if (pantin_figure_head(figure, &head)) printf("h %d %d %d %u\n", head.centre[0], head.centre[1], head.radius, head.shade);
}

int main(int argc, char **argv) {
    uint32_t length, rig_length, i, x = 1;
    uint16_t c;
    pantin_source source, rig_source;
    pantin_clip clip;
    pantin_rig rig;
    pantin_player player;
    pantin_figure figure;
    uint8_t *bytes, *rig_bytes = NULL;
    if (argc < 2) return 2;
    bytes = file(argv[1], &length);
    pantin_memory(&source, bytes, length);
    if (argc > 2) {
        rig_bytes = file(argv[2], &rig_length);
        pantin_memory(&rig_source, rig_bytes, rig_length);
        if (pantin_open_rig(&rig, &rig_source, 0, rig_length) != PANTIN_OK) return 3;
    }
    if (pantin_open(&clip, &source, argc > 2 ? &rig : NULL) != PANTIN_OK) return 3;
    if (pantin_start(&player, &clip, pose, 1023, moving, 1023) != PANTIN_OK) return 3;
    for (i = 0; i < sizeof shots / sizeof *shots; i++) {
        pantin_result result;
        pantin_figure_memory(&figure, bones, BONES, drives, DRIVES, slots, PANTIN_FIGURE_SLOTS);
        result = pantin_figure_set_up(&figure, &player, shots[i].width, shots[i].height, scratch, JOINTS);
        if (result != PANTIN_OK) {
            printf("none\n");
            continue;
        }
        if (pantin_figure_aim(&figure, &player, &shots[i].view) != PANTIN_OK || player.frame != 0) return 4;
        printf("figure %u bones %u lines\n", figure.bone_count, figure.line_count);
        do print_lines(&figure, pose);
        while (pantin_step(&player) == PANTIN_OK);
    }
    /* Poses that no clip contains. */
    if (figure.line_count > 0) {
        uint32_t n;
        printf("chaos\n");
        for (n = 0; n < CHAOS; n++) {
            for (c = 0; c < clip.rig.channels; c++) {
                x = x * 1664525u + 1013904223u;
                pose[c] = (int32_t)(x & 0xffffff00u) >> (n % 16);
            }
            print_lines(&figure, pose);
        }
    }
    fprintf(stderr, "%u bones, %u drives, %u slots\n", figure.bone_count, figure.drive_count, figure.slot_count);
    free(bytes);
    free(rig_bytes);
    return 0;
}
