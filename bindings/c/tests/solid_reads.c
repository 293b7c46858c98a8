/* Lets each read of a paged source fail in turn while a figure is set up and its camera is chosen: the call returns an error, and the same call again gives
 * what it gives without it.
 *
 *     solid_reads CLIP.ptn */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "failing.h"
#include "file.h"
#include "pantin_solid.h"

enum { CHANNELS = 128, BONES = 64, JOINTS = 64, PAGE = 32 };

/* A figure with its memory, and a file with one read that fails. */
typedef struct {
    pantin_channel moving[CHANNELS];
    int32_t pose[CHANNELS];
    pantin_bone bones[BONES];
    pantin_drive drives[CHANNELS];
    pantin_slot slots[PANTIN_FIGURE_SLOTS];
    pantin_joint_info scratch[JOINTS];
    uint8_t page[PAGE];
    pantin_pages pages;
    pantin_clip clip;
    pantin_player player;
    pantin_solid solid;
} actor;

static actor now, kept, other;

static void check(int held, const char *what, uint32_t k) {
    if (held) return;
    printf("failed: %s, read %u\n", what, (unsigned)k);
    exit(1);
}

static pantin_result set_up_lines(void) { return pantin_figure_set_up(&now.solid.figure, &now.player, 240, 240, now.scratch, JOINTS); }
static pantin_result aim_lines(void) { return pantin_figure_aim(&now.solid.figure, &now.player, &pantin_default_view); }
static pantin_result set_up(void) { return pantin_solid_set_up(&now.solid, &now.player, 240, 240, now.scratch, JOINTS); }
static pantin_result aim(void) { return pantin_solid_aim(&now.solid, &now.player, &pantin_default_view); }

/* Whether two figures show the same in the first pose. */
static int same_picture(void) {
    static uint8_t picture[2][240 * 240];
    uint8_t i;
    for (i = 0; i < 2; i++) {
        now = i ? other : now;
        check(pantin_restart(&now.player) == PANTIN_OK, "restart", 0);
        pantin_solid_pose(&now.solid, now.pose);
        if (now.solid.build != PANTIN_LINES || !now.solid.figure.scale) {
            if (pantin_solid_draw(&now.solid, PANTIN_L8, picture[i], 240, 0, 240, 1) != PANTIN_OK) return 0;
        } else {
            pantin_figure_pose(&now.solid.figure, now.pose);
            if (pantin_figure_draw(&now.solid.figure, PANTIN_L8, picture[i], 240, 0, 240, 1) != PANTIN_OK) return 0;
        }
    }
    return memcmp(picture[0], picture[1], sizeof picture[0]) == 0;
}

/* A call for which every n-th read fails, or many do. `drawn` says that it leaves a figure that can be drawn. */
static void fails(pantin_result (*call)(void), const char *what, int drawn) {
    uint32_t k, count;
    kept = now;
    let_fail(0, 0);
    check(call() == PANTIN_OK, what, 0);
    other = now;
    count = reads;
    check(count > 3, "the call reads", 0);
    for (k = 1; k <= count; k++) {
        uint32_t last;
        for (last = k; last <= k + 60; last += 30) {
            now = kept;
            let_fail(k, last);
            check(call() == PANTIN_ERROR_READ, what, k);
            let_fail(0, 0);
            check(call() == PANTIN_OK, "the call again", k);
            check(now.solid.build == other.solid.build && memcmp(&now.solid.person, &other.solid.person, sizeof now.solid.person) == 0 &&
                      memcmp(now.solid.head_axes, other.solid.head_axes, sizeof now.solid.head_axes) == 0,
                  "the person", k);
            check(memcmp(now.drives, other.drives, sizeof now.drives) == 0 && now.solid.figure.bone_count == other.solid.figure.bone_count, "the figure", k);
            if (drawn && k % 16 == 0) check(same_picture(), "the picture", k);
        }
    }
    now = other;
    printf("%s: %u reads\n", what, (unsigned)count);
}

int main(int argc, char **argv) {
    uint8_t *content;
    if (argc < 2) return 2;
    content = file(argv[1], &length);
    bytes = content;
    pantin_paged(&now.pages, length, read_bytes, NULL, now.page, PAGE);
    check(pantin_open(&now.clip, &now.pages.source, NULL) == PANTIN_OK, "open", 0);
    check(pantin_start(&now.player, &now.clip, now.pose, CHANNELS, now.moving, CHANNELS) == PANTIN_OK, "start", 0);
    pantin_figure_memory(&now.solid.figure, now.bones, BONES, now.drives, CHANNELS, now.slots, PANTIN_FIGURE_SLOTS);
    fails(set_up_lines, "set-up of lines", 0);
    fails(aim_lines, "camera of lines", 1);
    fails(set_up, "set-up", 0);
    fails(aim, "camera", 1);
    free(content);
    return 0;
}
