/* A pantin clip: 652 bytes, 160 frames at 120.000 frames a second. */
/* Channels, in the order of a pose, as the clip codes them: */
/*    0 root: Zposition */
/*    1 hips: Xposition, Yposition, Yrotation */
/*    4 chest: Yrotation */
/*    5 neck: Yrotation, Xrotation */
/*    7 head: Xrotation */
/*    8 left-upper-arm: Xrotation */
/*    9 left-forearm: Xrotation */
/*   10 left-hand: Xrotation */
/*   11 right-upper-arm: Xrotation */
/*   12 right-forearm: Xrotation */
/*   13 right-hand: Xrotation */
/*   14 left-thigh: Xrotation */
/*   15 left-shin: Xrotation */
/*   16 left-foot: Xrotation */
/*   17 left-toes: Xrotation */
/*   18 right-thigh: Xrotation */
/*   19 right-shin: Xrotation */
/*   20 right-foot: Xrotation */
/*   21 right-toes: Xrotation */
#if defined(PANTIN_CLIP_WALK_ID) && PANTIN_CLIP_WALK_ID != 2602699132
#error "two clips have the name CLIP_WALK: rename one of their files"
#endif
#ifndef PANTIN_CLIP_WALK_H
#define PANTIN_CLIP_WALK_H
#define PANTIN_CLIP_WALK_ID 2602699132

#define CLIP_WALK_LEN 652
#define CLIP_WALK_FRAMES 160
#define CLIP_WALK_FRAME_TIME_NS 8333333
#define CLIP_WALK_CHANNELS 22
#define CLIP_WALK_MOVING 20
#define CLIP_WALK_FIGURE_JOINTS 25
#define CLIP_WALK_WORKSPACE 29
/* Initializes an array of CLIP_WALK_CHANNELS strings. */
#define CLIP_WALK_NAMES "root.Zposition", \
    "hips.Xposition", \
    "hips.Yposition", \
    "hips.Yrotation", \
    "chest.Yrotation", \
    "neck.Yrotation", \
    "neck.Xrotation", \
    "head.Xrotation", \
    "left-upper-arm.Xrotation", \
    "left-forearm.Xrotation", \
    "left-hand.Xrotation", \
    "right-upper-arm.Xrotation", \
    "right-forearm.Xrotation", \
    "right-hand.Xrotation", \
    "left-thigh.Xrotation", \
    "left-shin.Xrotation", \
    "left-foot.Xrotation", \
    "left-toes.Xrotation", \
    "right-thigh.Xrotation", \
    "right-shin.Xrotation", \
    "right-foot.Xrotation", \
    "right-toes.Xrotation"

#ifdef __AVR__
#include <avr/pgmspace.h>
#define PANTIN_FLASH PROGMEM
#else
#define PANTIN_FLASH
#endif

static const unsigned char CLIP_WALK[CLIP_WALK_LEN] PANTIN_FLASH = {
    80, 110, 1, 3, 239, 3, 192, 132, 61, 242, 1, 29, 0, 1, 0, 2, 0, 128, 128, 190,
    1, 0, 4, 114, 111, 111, 116, 3, 1, 16, 4, 0, 0, 0, 4, 104, 105, 112, 115, 0,
    2, 0, 128, 128, 20, 128, 128, 2, 5, 115, 112, 105, 110, 101, 1, 3, 4, 0, 230, 204,
    31, 180, 230, 4, 5, 99, 104, 101, 115, 116, 2, 4, 52, 0, 204, 153, 47, 180, 230, 6,
    4, 110, 101, 99, 107, 1, 5, 3, 0, 128, 128, 18, 128, 128, 4, 4, 104, 101, 97, 100,
    16, 6, 0, 128, 128, 42, 128, 128, 2, 0, 4, 128, 128, 6, 128, 128, 38, 128, 128, 4,
    13, 108, 101, 102, 116, 45, 115, 104, 111, 117, 108, 100, 101, 114, 1, 8, 3, 128, 128, 30,
    0, 0, 14, 108, 101, 102, 116, 45, 117, 112, 112, 101, 114, 45, 97, 114, 109, 1, 9, 3,
    128, 128, 8, 153, 179, 57, 0, 12, 108, 101, 102, 116, 45, 102, 111, 114, 101, 97, 114, 109,
    1, 10, 3, 0, 0, 128, 128, 52, 9, 108, 101, 102, 116, 45, 104, 97, 110, 100, 16, 11,
    0, 0, 128, 128, 34, 0, 4, 255, 255, 5, 128, 128, 38, 128, 128, 4, 14, 114, 105, 103,
    104, 116, 45, 115, 104, 111, 117, 108, 100, 101, 114, 1, 13, 3, 255, 255, 29, 0, 0, 15,
    114, 105, 103, 104, 116, 45, 117, 112, 112, 101, 114, 45, 97, 114, 109, 1, 14, 3, 255, 255,
    7, 153, 179, 57, 0, 13, 114, 105, 103, 104, 116, 45, 102, 111, 114, 101, 97, 114, 109, 1,
    15, 3, 0, 0, 128, 128, 52, 10, 114, 105, 103, 104, 116, 45, 104, 97, 110, 100, 16, 16,
    0, 0, 128, 128, 34, 1, 2, 3, 128, 128, 16, 255, 255, 7, 0, 10, 108, 101, 102, 116,
    45, 116, 104, 105, 103, 104, 1, 18, 3, 0, 255, 255, 83, 0, 9, 108, 101, 102, 116, 45,
    115, 104, 105, 110, 1, 19, 3, 0, 255, 255, 81, 0, 9, 108, 101, 102, 116, 45, 102, 111,
    111, 116, 16, 20, 0, 255, 255, 15, 255, 255, 9, 1, 20, 3, 0, 255, 255, 12, 128, 128,
    26, 9, 108, 101, 102, 116, 45, 116, 111, 101, 115, 16, 22, 0, 255, 255, 2, 128, 128, 14,
    1, 2, 3, 255, 255, 15, 255, 255, 7, 0, 11, 114, 105, 103, 104, 116, 45, 116, 104, 105,
    103, 104, 1, 24, 3, 0, 255, 255, 83, 0, 10, 114, 105, 103, 104, 116, 45, 115, 104, 105,
    110, 1, 25, 3, 0, 255, 255, 81, 0, 10, 114, 105, 103, 104, 116, 45, 102, 111, 111, 116,
    16, 26, 0, 255, 255, 15, 255, 255, 9, 1, 26, 3, 0, 255, 255, 12, 128, 128, 26, 10,
    114, 105, 103, 104, 116, 45, 116, 111, 101, 115, 16, 28, 0, 255, 255, 2, 128, 128, 14, 38,
    147, 149, 1, 1, 160, 1, 233, 209, 47, 169, 85, 176, 106, 12, 170, 109, 174, 38, 247, 30,
    229, 197, 31, 246, 74, 130, 156, 127, 175, 148, 179, 34, 7, 71, 247, 232, 211, 169, 126, 70,
    11, 60, 109, 167, 202, 232, 215, 172, 34, 147, 100, 243, 87, 66, 249, 173, 244, 103, 105, 217,
    200, 16, 71, 18, 207, 21, 226, 119, 180, 209, 55, 150, 237, 177, 196, 79, 204, 224, 249, 152,
    67, 1, 207, 180, 86, 150, 240, 84, 195, 84, 235, 150, 24, 109, 252, 234, 231, 149, 104, 15,
    40, 92, 118, 163, 95, 245, 29, 54, 158, 242, 79, 121, 65, 121, 120, 226, 143, 66, 237, 166,
    193, 34, 72, 161, 70, 83, 60, 3, 210, 135, 163, 160, 188, 26, 125, 183, 98, 123, 95, 109,
    125, 104, 104, 64, 250, 74, 248, 14, 221, 80, 120, 182,
};

#endif
