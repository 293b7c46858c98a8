/* A pantin clip: 82 bytes, 33 frames at 30.000 frames a second. */
/* Channels, in the order of a pose, as the clip codes them: */
/*    0 viseme_e */
/*    1 viseme_nn */
/*    2 viseme_o */
#if defined(PANTIN_CLIP_HELLO_ID) && PANTIN_CLIP_HELLO_ID != 1100061191
#error "two clips have the name CLIP_HELLO: rename one of their files"
#endif
#ifndef PANTIN_CLIP_HELLO_H
#define PANTIN_CLIP_HELLO_H
#define PANTIN_CLIP_HELLO_ID 1100061191

#define CLIP_HELLO_LEN 82
#define CLIP_HELLO_FRAMES 33
#define CLIP_HELLO_FRAME_TIME_NS 33333333
#define CLIP_HELLO_CHANNELS 3
#define CLIP_HELLO_MOVING 3
#define CLIP_HELLO_FIGURE_JOINTS 0
#define CLIP_HELLO_WORKSPACE 0
/* Initializes an array of CLIP_HELLO_CHANNELS strings. */
#define CLIP_HELLO_NAMES "viseme_e", \
    "viseme_nn", \
    "viseme_o"

#ifdef __AVR__
#include <avr/pgmspace.h>
#define PANTIN_FLASH PROGMEM
#else
#define PANTIN_FLASH
#endif

static const unsigned char CLIP_HELLO[CLIP_HELLO_LEN] PANTIN_FLASH = {
    80, 110, 1, 1, 40, 192, 132, 61, 0, 1, 0, 3, 1, 8, 118, 105, 115, 101, 109, 101,
    95, 101, 1, 9, 118, 105, 115, 101, 109, 101, 95, 110, 110, 1, 8, 118, 105, 115, 101, 109,
    101, 95, 111, 22, 251, 36, 3, 33, 0, 1, 236, 239, 157, 103, 105, 222, 202, 211, 106, 52,
    165, 73, 98, 167, 167, 182, 182, 182, 4, 190, 236, 78, 70, 225, 213, 178, 29, 7, 119, 36,
    248, 133,
};

#endif
