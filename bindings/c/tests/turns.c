/* Prints the rotation of each joint at each frame of a clip, one line each, as turns.txt of the test vectors has them, and behind it the two checksums of
 * turn-sums.txt.
 *
 *     turns CLIP.ptn [RIG.rig]
 *
 * For emulated boards, which may have no arguments, CLIP_FILE names the file when it is compiled. */
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "pantin_turn.h"

static void check(int held, const char *what) {
    if (!held) {
        printf("failed: %s\n", what);
        exit(1);
    }
}

static uint16_t crc;

static void note(const int32_t *numbers, unsigned count) {
    unsigned i, bit, byte;
    for (i = 0; i < count; i++) {
        for (byte = 0; byte < 4; byte++) {
            crc = (uint16_t)(crc ^ (uint16_t)((((uint32_t)numbers[i] >> (8 * byte)) & 0xff) << 8));
            for (bit = 0; bit < 8; bit++) crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
        }
    }
}

static void print(const int32_t *numbers, unsigned count) {
    while (count-- > 0) printf(" %ld", (long)*numbers++);
}

static int32_t pose[1023];
static pantin_channel moving[1023];

/* References to all joints; a joint that has a name of its own is found by it. */
static pantin_joint_ref *refer(const pantin_clip *clip) {
    pantin_joint_ref *joints = (pantin_joint_ref *)calloc(clip->rig.joints + 1u, sizeof *joints), named;
    pantin_joint at;
    char text[1024];
    pantin_first_joint(&at, &clip->rig);
    while (pantin_next_joint(&at)) {
        check(pantin_refer(clip, &at, &joints[at.index]) == PANTIN_OK, "reference");
        if (at.end_site || at.name.length == 0) continue;
        pantin_copy_name(&at.name, text, sizeof text);
        check(pantin_find(clip, text, &named) == PANTIN_OK, "joint by name");
        if (named.index == at.index) check(memcmp(&named, &joints[at.index], sizeof named) == 0, "the same joint by name");
    }
    return joints;
}

static void joint_is_no(const pantin_player *player, pantin_joint_ref *joint, pantin_result why) {
    int32_t numbers[9];
    check(pantin_euler(player, joint, PANTIN_XYZ, numbers) == why, "no angles");
    check(pantin_quaternion(player, joint, numbers) == why, "no quaternion");
    check(pantin_matrix(player, joint, numbers) == why, "no matrix");
    check(pantin_angle(player, joint, numbers) == why, "no angle");
    check(pantin_raw_value(player, joint, 0, numbers) == why, "no raw value");
}

int main(int argc, char **argv) {
    uint32_t length, rig_length;
    pantin_source source, rig_source;
    pantin_clip clip;
    pantin_rig rig;
    pantin_player player;
    pantin_joint_ref *joints, none;
    uint8_t *bytes, *rig_bytes = NULL;
    unsigned i, order;
#ifdef CLIP_FILE
    (void)argv;
    argc = 0;
    bytes = file(CLIP_FILE, &length);
#else
    if (argc < 2) return 2;
    bytes = file(argv[1], &length);
#endif
    if (argc > 2) {
        rig_bytes = file(argv[2], &rig_length);
        pantin_memory(&rig_source, rig_bytes, rig_length);
        check(pantin_open_rig(&rig, &rig_source, 0, rig_length) == PANTIN_OK, "rig");
    }
    pantin_memory(&source, bytes, length);
    check(pantin_open(&clip, &source, argc > 2 ? &rig : NULL) == PANTIN_OK, "open");
    check(pantin_start(&player, &clip, pose, 1023, moving, 1023) == PANTIN_OK, "start");
    joints = refer(&clip);
    check(pantin_find(&clip, "no such joint", &none) == PANTIN_NOT_FOUND && !none.found, "a missing joint is an error");
    joint_is_no(&player, &none, PANTIN_NOT_FOUND);
    if (clip.rig.joints > 0) {
        /* Of another rig, then of a clip that codes the joint otherwise, which is noticed. */
        none = joints[0];
        none.rig_id++;
        if (none.channels > 0) joint_is_no(&player, &none, PANTIN_ERROR_OTHER_RIG);
        check(pantin_raw_value(&player, &joints[0], joints[0].channels, pose) == PANTIN_NOT_FOUND, "a channel past the last");
        for (i = 0; i < clip.rig.joints; i++) {
            joints[i].coding++;
            joints[i].form = PANTIN_FORM_CHAIN;
            joints[i].exponential = (uint8_t)!joints[i].exponential;
        }
    }
    do {
        pantin_joint at;
        pantin_first_joint(&at, &clip.rig);
        for (i = 0; i < clip.rig.joints; i++) {
            int32_t matrix[9], own[3], quaternion[4], angle, angles[6 * 3];
            char name[64];
            check(pantin_next_joint(&at) == 1, "joint");
            pantin_copy_name(&at.name, name, sizeof name);
            check(pantin_matrix(&player, &joints[i], matrix) == PANTIN_OK, "matrix");
            check(pantin_angle(&player, &joints[i], &angle) == PANTIN_OK, "angle");
            check(pantin_quaternion(&player, &joints[i], quaternion) == PANTIN_OK, "quaternion");
            for (order = PANTIN_XYZ; order <= PANTIN_ZYX; order++) {
                check(pantin_euler(&player, &joints[i], (pantin_order)order, angles + 3 * order) == PANTIN_OK, "angles");
            }
            /* What is no order is the joint's own. */
            order = joints[i].order == PANTIN_NO_ORDER ? PANTIN_XYZ : joints[i].order;
            check(pantin_euler(&player, &joints[i], (pantin_order)PANTIN_NO_ORDER, own) == PANTIN_OK, "own order");
            check(memcmp(own, angles + 3 * order, 3 * sizeof *angles) == 0, "angles in the own order");
            printf("%s %lu", name, (unsigned long)player.frame);
            print(angles + 3 * PANTIN_XYZ, 3);
            print(angles + 3 * PANTIN_ZXY, 3);
            print(quaternion, 4);
            crc = 0xffff;
            note(matrix, 9);
            note(&angle, 1);
            note(angles, 18);
            printf(" %04x", crc);
            crc = 0xffff;
            note(angles, 18);
            printf(" %04x", crc);
            crc = 0xffff;
            note(quaternion, 4);
            note(matrix, 9);
            note(&angle, 1);
            printf("%04x\n", crc);
        }
    } while (pantin_step(&player) == PANTIN_OK);
    free(joints);
    free(bytes);
    free(rig_bytes);
    return 0;
}
