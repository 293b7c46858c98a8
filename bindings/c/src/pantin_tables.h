/* Tables of the format (section 6), as sizes of symbols. `cargo xtask vectors` writes this file. */
#ifndef PANTIN_TABLES_H
#define PANTIN_TABLES_H

#include "pantin_flash.h"

#define PANTIN_MAGIC_0 80
#define PANTIN_MAGIC_1 110
#define PANTIN_VERSION 1
#define PANTIN_LISTED 127
#define PANTIN_START_MODE 63
#define PANTIN_FIRST_STEP 44

static const uint8_t pantin_frame_rates[10] PANTIN_FLASH = {
    0, 120, 60, 30, 24, 25, 50, 100, 36, 15
};

static const uint8_t pantin_lengths[16] PANTIN_FLASH = {
    1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96
};

static const uint8_t pantin_status_in[32] PANTIN_FLASH = {
    0, 1, 2, 2, 1, 1, 2, 2, 3, 2, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 5, 5, 5, 5, 6, 5, 5, 5, 7, 7, 7, 7
};

static const uint8_t pantin_mode_after[65] PANTIN_FLASH = {
    0, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 1, 0, 1, 1, 1, 4, 1, 5, 2, 6, 2, 6, 6, 6, 3, 0, 0, 0, 0, 0, 4, 0, 4, 0, 4, 0, 4,
    4, 4, 0, 0, 0, 6, 0, 6, 0, 0, 4, 0, 0, 4, 0, 0, 0, 0, 0, 0, 7, 4
};

static const uint8_t pantin_number_in[96] PANTIN_FLASH = {
    0, 0, 1, 2, 3, 4, 2, 3, 4, 5, 6, 5, 0, 0, 1, 2, 7, 1, 2, 3, 4, 8, 8, 6, 0, 0, 9, 2, 3, 1, 7, 3, 4, 10, 10, 6, 0, 11, 9, 7, 3, 7,
    3, 3, 4, 12, 13, 13, 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 14, 0, 0, 0, 0, 0, 5, 0, 0, 14, 0, 0, 14, 0, 0, 0, 0, 0, 0, 0, 0,
    15, 0, 0, 14, 0, 0, 9, 0, 0, 9, 0, 0, 15, 0
};

static const uint16_t pantin_status[8][4] PANTIN_FLASH = {
    {
        2180, 598, 1283, 35
    },
    {
        2018, 1473, 553, 52
    },
    {
        1073, 781, 2195, 47
    },
    {
        701, 374, 2892, 129
    },
    {
        448, 258, 1854, 1536
    },
    {
        3928, 15, 115, 38
    },
    {
        3037, 59, 868, 132
    },
    {
        2020, 34, 507, 1535
    }
};

static const uint16_t pantin_step_change[25] PANTIN_FLASH = {
    1820, 456, 960, 109, 361, 56, 92, 10, 26, 30, 8, 64, 18, 54, 6, 15, 3, 1, 1, 1, 1, 1, 1, 1, 1
};

static const uint16_t pantin_position[33] PANTIN_FLASH = {
    11, 373, 519, 679, 690, 604, 445, 283, 216, 115, 68, 35, 28, 7, 5, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1
};

static const uint16_t pantin_velocity[33] PANTIN_FLASH = {
    2523, 340, 58, 484, 272, 195, 108, 60, 23, 9, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1
};

static const uint16_t pantin_mode[8][33] PANTIN_FLASH = {
    {
        2689, 825, 250, 112, 40, 25, 22, 5, 12, 7, 5, 1, 3, 4, 1, 1, 1, 17, 44, 19, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1
    },
    {
        764, 1033, 768, 569, 285, 244, 161, 85, 40, 26, 11, 4, 5, 7, 1, 2, 1, 3, 19, 23, 17, 2, 15, 1, 2, 1, 1, 1, 1, 1, 1, 1, 1
    },
    {
        55, 119, 268, 378, 493, 460, 575, 474, 327, 272, 184, 129, 147, 88, 36, 53, 1, 1, 4, 5, 3, 1, 5, 1, 6, 1, 3, 2, 1, 1, 1, 1,
        1
    },
    {
        15, 33, 76, 112, 249, 240, 402, 456, 323, 393, 299, 238, 384, 244, 130, 474, 1, 1, 3, 1, 1, 1, 4, 1, 2, 1, 3, 2, 1, 2, 2, 1,
        1
    },
    {
        5, 7, 1, 1, 60, 1, 88, 1, 87, 1, 87, 87, 87, 1, 1, 1, 173, 1, 261, 1, 68, 2375, 1, 1, 87, 1, 1, 1, 1, 1, 1, 1, 605
    },
    {
        1, 5, 5, 5, 1, 7, 5, 5, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 3, 2, 2, 4022, 2, 2, 2, 3, 2, 2, 2, 2, 1
    },
    {
        1, 1, 1, 3, 6, 1, 12, 2, 10, 3, 6, 6, 2, 1, 1, 1, 3, 1, 5, 1, 1, 1, 1, 116, 5, 1721, 1, 1033, 688, 459, 1, 1, 1
    },
    {
        366, 428, 397, 117, 445, 300, 173, 95, 413, 131, 103, 714, 59, 41, 177, 47, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
        74
    }
};

static const uint16_t pantin_number[16][27] PANTIN_FLASH = {
    {
        27, 570, 380, 419, 679, 350, 167, 104, 235, 111, 65, 149, 124, 106, 121, 117, 75, 94, 72, 42, 26, 23, 12, 8, 6, 7, 7
    },
    {
        7, 16, 10, 52, 50, 140, 103, 201, 180, 264, 160, 328, 162, 418, 243, 546, 262, 444, 153, 189, 81, 44, 27, 8, 3, 1, 4
    },
    {
        154, 145, 38, 441, 32, 313, 139, 595, 60, 218, 163, 308, 183, 302, 168, 216, 252, 92, 170, 27, 61, 3, 11, 1, 2, 1, 1
    },
    {
        86, 120, 24, 722, 7, 586, 9, 1051, 19, 421, 12, 366, 39, 244, 24, 206, 60, 37, 38, 5, 12, 3, 1, 1, 1, 1, 1
    },
    {
        121, 100, 38, 141, 17, 103, 6, 290, 41, 252, 29, 342, 77, 457, 80, 748, 184, 495, 209, 229, 79, 31, 16, 8, 1, 1, 1
    },
    {
        365, 21, 44, 48, 43, 63, 221, 56, 20, 96, 50, 192, 159, 63, 31, 358, 216, 320, 281, 348, 318, 183, 190, 140, 93, 97, 80
    },
    {
        227, 49, 105, 45, 125, 45, 83, 71, 55, 67, 98, 134, 72, 209, 74, 483, 134, 740, 202, 561, 167, 204, 70, 46, 19, 10, 1
    },
    {
        42, 159, 20, 1156, 42, 136, 50, 460, 21, 896, 101, 345, 35, 282, 9, 139, 92, 48, 42, 3, 9, 1, 4, 1, 1, 1, 1
    },
    {
        283, 136, 183, 139, 135, 101, 108, 229, 81, 220, 85, 168, 81, 314, 96, 483, 93, 454, 218, 168, 179, 43, 74, 7, 15, 2, 1
    },
    {
        151, 184, 146, 522, 173, 188, 200, 295, 94, 298, 66, 369, 78, 222, 82, 349, 84, 291, 73, 126, 37, 34, 12, 5, 3, 11, 3
    },
    {
        176, 114, 128, 119, 130, 124, 75, 192, 63, 155, 78, 344, 46, 395, 44, 712, 23, 635, 134, 199, 129, 28, 39, 4, 7, 2, 1
    },
    {
        1047, 831, 763, 272, 291, 116, 124, 62, 80, 27, 17, 63, 43, 49, 13, 49, 67, 31, 37, 24, 24, 16, 14, 10, 10, 7, 9
    },
    {
        167, 125, 100, 365, 86, 146, 114, 214, 58, 252, 37, 437, 54, 328, 69, 574, 73, 433, 110, 207, 67, 41, 26, 4, 3, 4, 2
    },
    {
        153, 35, 34, 38, 11, 121, 31, 41, 32, 124, 34, 179, 15, 231, 13, 879, 52, 1031, 66, 654, 68, 187, 31, 27, 3, 4, 2
    },
    {
        48, 60, 84, 61, 36, 51, 53, 56, 37, 23, 38, 42, 15, 15, 57, 159, 114, 213, 245, 386, 310, 473, 444, 343, 334, 206, 193
    },
    {
        44, 10, 34, 11, 4, 7, 10, 13, 4, 8, 7, 38, 10, 7, 24, 89, 37, 119, 58, 220, 78, 334, 116, 363, 108, 1976, 367
    }
};

static const uint16_t pantin_far[32] PANTIN_FLASH = {
    23, 26, 52, 101, 201, 307, 425, 579, 625, 547, 497, 330, 189, 99, 57, 20, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1
};

static const uint32_t pantin_steps[32] PANTIN_FLASH = {
    536870912, 178956970, 89478485, 53687091, 35791394, 25565281, 14913080, 9761289, 6882960, 3947580, 2556528, 1789569, 1016800,
    456522, 258111, 115307, 536870912, 134217728, 53687091, 26843545, 15339168, 9586980, 4473924, 2440322, 1474920, 657930, 348617,
    206488, 89717, 27391, 11732, 3529
};

/* Each name ends with a space. */
static const char pantin_live_link[] PANTIN_FLASH =
    "EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft "
    "EyeWideLeft EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight "
    "EyeSquintRight EyeWideRight JawForward JawRight JawLeft JawOpen "
    "MouthClose MouthFunnel MouthPucker MouthRight MouthLeft MouthSmileLeft "
    "MouthSmileRight MouthFrownLeft MouthFrownRight MouthDimpleLeft MouthDimpleRight MouthStretchLeft "
    "MouthStretchRight MouthRollLower MouthRollUpper MouthShrugLower MouthShrugUpper MouthPressLeft "
    "MouthPressRight MouthLowerDownLeft MouthLowerDownRight MouthUpperUpLeft MouthUpperUpRight BrowDownLeft "
    "BrowDownRight BrowInnerUp BrowOuterUpLeft BrowOuterUpRight CheekPuff CheekSquintLeft "
    "CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut HeadYaw HeadPitch "
    "HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw RightEyePitch "
    "RightEyeRoll ";

#endif
