/* Faces: a face model and emotes, drawn as pixels into rows that the caller lends.
 *
 * Like the decoder it allocates nothing, uses no floating point and needs only stdint.h, stddef.h and string.h. The pixels are those of the crate
 * pantin-face, bit for bit. MODEL.md of that crate describes models; `pantin face model` makes them. pantin_face_data.h has the cartoon model and the
 * 23 emotes.
 *
 *     static uint32_t memory[PANTIN_FACE_WORDS(97, 12)];
 *     static uint16_t rows[16 * 240];
 *     static pantin_face face;
 *
 *     if (pantin_face_open(&face, pantin_cartoon, sizeof pantin_cartoon, memory, sizeof memory) == PANTIN_OK &&
 *         pantin_face_size(&face, 240, 240) == PANTIN_OK) {
 *         pantin_face_emotes(&face, pantin_emotes, PANTIN_EMOTES);
 *         pantin_face_live(&face, 1);
 *         pantin_face_emote(&face, "happy");
 *         for (;;) {
 *             pantin_face_step(&face, 33);
 *             for (y = 0; y < 240; y += 16) {
 *                 pantin_face_draw(&face, PANTIN_RGB565, rows, 480, y, y + 16);
 *                 send(rows, y, y + 16);
 *             }
 *         }
 *     }
 *
 * Weights are numbers in Q15: PANTIN_FACE_FULL is 1, the whole effect of a unit. A function that is called for a face of zeroes, before
 * pantin_face_open succeeded, returns PANTIN_ERROR_HEAD and changes nothing.
 *
 * Faces are for 32-bit processors: on AVR, whose int has 16 bits, they are not tested. On an ESP8266 a model is read from program memory: declare it
 * with PROGMEM. Emotes are read from RAM.
 */
#ifndef PANTIN_FACE_H
#define PANTIN_FACE_H

#include "pantin.h"
#include "pantin_format.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A full weight. */
#define PANTIN_FACE_FULL 32768L

/* Shapes that a model has at most. */
#define PANTIN_FACE_SHAPES 48

/* Triangles of the outline that are kept from frame to frame; if there are more, each drawing searches for all of them. */
#define PANTIN_FACE_OUTLINE 48

/* The length of the memory for a face of so many vertices that plays clips of so many channels, in elements of uint32_t. The cartoon has 97 vertices,
 * the wireframe face 239 and an outline; our emotes have at most 7 channels. The numbers suffice where each channel drives at most two shapes. */
#define PANTIN_FACE_WORDS(vertices, channels) \
    (((vertices) * 11 + 3 + PANTIN_FACE_SHAPES * 12 + ((vertices) > 128 ? PANTIN_FACE_OUTLINE * 5 : 0) + (channels) * 36) / 4 + 2)

/* Formats of rows: see pantin_format.h. */
typedef pantin_format pantin_face_format;

/* An emote: a clip that drives a face, by its name. */
typedef struct pantin_emote {
    const char *name;
    const uint8_t *bytes; /* of a .ptn file with a rig of its own */
    uint32_t length;
} pantin_emote;

/* Which shape a channel of a clip drives. */
typedef struct pantin_face_drive {
    uint16_t channel;
    uint8_t target;
    int8_t mantissa, shift;
} pantin_face_drive;

/* A triangle that the outline crosses: the corner that is alone on its side, the others, and where the edges to them are crossed in 256ths. */
typedef struct pantin_face_crossed {
    uint8_t corners[3], parts[2];
} pantin_face_crossed;

/* The sections of a model that was checked. */
typedef struct pantin_face_model {
    const uint8_t *points, *normals, *triangles, *fixed, *curves, *openings, *shapes, *names;
    uint16_t middles, pairs, moving[2];
    uint16_t triangle_count, outline_count, name_count;
    uint8_t fixed_count, curve_count, opening_count, shape_count;
    uint8_t wide;  /* 1: indices of vertices take two bytes */
    int8_t exponent;
} pantin_face_model;

/* A face. Fields may be read; only the functions change them. */
typedef struct pantin_face {
    pantin_face_model model;
    uint32_t needed;   /* after PANTIN_NO_ROOM: the bytes of memory that suffice */
    int16_t (*vertices)[3];
    int16_t (*points)[2]; /* vertices on the display, in sixteenths of a pixel */
    int16_t (*weights)[2]; /* what is shown: Q14, of the left and the right side of each shape */
    int16_t (*own)[2];     /* what pantin_face_weight set */
    int16_t (*offset)[2];  /* the difference that a transition takes away */
    pantin_face_crossed *outline;
    int8_t *facing;    /* the cosine between each vertex's normal and the direction to the camera, 127 is 1 */
    uint32_t *rest;    /* memory for the clip */
    uint32_t rest_bytes;
    /* The camera. */
    int32_t rows[3][3], centre[2], scale, nearer, middle[3];
    uint8_t shift, detail, outline_overflown, outline_kept;
    uint16_t width, height;
    int16_t shifted[2];
    int32_t head[3], before[3]; /* angles of the head in 2^-32 turns: of the weights, and of the last projection */
    int16_t pivot[3], pivot_before[3];
    int8_t rounded[3];
    uint8_t known; /* bit 0: `before` holds; bit 1: `rounded` holds; bit 2: weights changed since the last drawing */
    /* Emotes. */
    const pantin_emote *emotes;
    const uint16_t *palette;
    pantin_source source;
    pantin_clip clip;
    pantin_player player;
    pantin_face_drive *drives;
    uint16_t emote_count, drive_count;
    uint32_t clock_ns; /* since the frame that is shown */
    uint16_t transition_ms, since_ms; /* the length of transitions, and the time since the last one began */
    uint8_t playing;   /* 1 from pantin_face_emote or pantin_face_play on */
    uint8_t finished;  /* 1 once a clip without a loop has shown its last frame */
    /* Eyes and mouth. */
    uint8_t live;
    uint8_t blink_ms;
    uint16_t next_blink_ms, next_glance_ms, glance_ms;
    uint32_t random;
    int16_t look[2], glance[2], glance_from[2], mouth;
    int16_t visemes[14];
    uint16_t speaking;     /* Q15: how far speech has the mouth to itself */
    uint8_t spoken[PANTIN_FACE_SHAPES];   /* for each shape, the sides that visemes move: 1 is the left one, 2 the right one */
} pantin_face;

/* Opens a model of `length` bytes, checks it, and lends the face `size` bytes of memory. Nothing is shown until pantin_face_size was called. Returns
 * PANTIN_NO_ROOM if the memory is too small (face->needed is what suffices without a clip), PANTIN_ERROR_LENGTH for a model that is cut,
 * PANTIN_ERROR_VERSION or PANTIN_ERROR_RIG for one that contradicts itself. */
pantin_result pantin_face_open(pantin_face *face, const uint8_t *model, uint32_t length, uint32_t *memory, size_t size);

/* Sets the size of the picture in pixels, each from 1 to 2047: the face fills it. PANTIN_NOT_FOUND for another size. */
pantin_result pantin_face_size(pantin_face *face, uint16_t width, uint16_t height);

/* Moves the face in the picture by whole pixels to the right and down, at most 1023. pantin_face_size moves it back. */
pantin_result pantin_face_shift(pantin_face *face, int16_t x, int16_t y);

/* Sets from where the face is seen, in degrees: `orbit` about the vertical axis (at 90 the face looks to the left of the picture), `tilt` above the
 * horizon. */
pantin_result pantin_face_aim(pantin_face *face, int16_t orbit, int16_t tilt);

/* Sets the colours of 16 brightnesses, the background first, as values of RGB565; of L8 the low byte counts, of I1 whether it is 0. The array is not
 * copied. NULL: white shades that are slightly warm, as the crate has them. */
pantin_result pantin_face_palette(pantin_face *face, const uint16_t *palette);

/* Lends the face a list of emotes. */
pantin_result pantin_face_emotes(pantin_face *face, const pantin_emote *emotes, uint16_t count);

/* Plays an emote of the list; the face goes over to it in the time of pantin_face_transition. Returns PANTIN_NOT_FOUND if the list has no such name:
 * the face goes on as before, and face->emotes lists the names. PANTIN_NO_ROOM if the memory is too small for its clip: face->needed is what
 * suffices, and the face stays as it is. */
pantin_result pantin_face_emote(pantin_face *face, const char *name);

/* The same for a clip of one's own: scalars with names that the model has drive the face. A clip without such scalars gives PANTIN_NOT_FOUND. */
pantin_result pantin_face_play(pantin_face *face, const uint8_t *clip, uint32_t length);

/* Sets the duration of transitions between emotes in milliseconds: 0 for none. 300 without a call. */
pantin_result pantin_face_transition(pantin_face *face, uint16_t ms);

/* Sets all shapes that `name` drives (a unit, an emotion, a blend shape of ARKit), in addition to the emote, until it is set again. `weight` is in Q15,
 * from -2 to 2. PANTIN_NOT_FOUND if the model has no such name. */
pantin_result pantin_face_weight(pantin_face *face, const char *name, int32_t weight);

/* Turns the eyes: `x` to the right of the picture, `y` up, in Q15, from -1 to 1. */
pantin_result pantin_face_look(pantin_face *face, int32_t x, int32_t y);

/* Opens the mouth, in Q15, from 0 to 1. No effect while a viseme has a weight. */
pantin_result pantin_face_mouth(pantin_face *face, int32_t level);

/* Sets the weight of one of MPEG-4's visemes, 1 to 14, in Q15; viseme 0 sets all to 0. PANTIN_NOT_FOUND for another number. */
pantin_result pantin_face_viseme(pantin_face *face, uint8_t viseme, int32_t weight);

/* Says how far speech has the mouth to itself, 0 to PANTIN_FACE_FULL: talk.speaking of pantin_talk.h. Emotes give way by that in the units of visemes, such
 * as open_mouth and pucker, so that the lips of a surprised face meet, too. */
pantin_result pantin_face_speaking(pantin_face *face, int32_t weight);

/* Lets the face blink and glance about by itself: `seed` chooses when; 0 ends it. */
pantin_result pantin_face_live(pantin_face *face, uint32_t seed);

/* Lets time pass: the frame that is due, transitions, eyes. Returns PANTIN_OK, or the error of reading the clip. */
pantin_result pantin_face_step(pantin_face *face, uint16_t ms);

/* Draws rows y0 to y1 - 1 of the picture: `rows` takes them from its start, `stride` bytes each. They are cleared before. y1 is at most the picture's
 * height, otherwise PANTIN_NOT_FOUND; PANTIN_NO_ROOM if `stride` is too small for a row. */
pantin_result pantin_face_draw(pantin_face *face, pantin_face_format format, void *rows, size_t stride, uint16_t y0, uint16_t y1);

/* Takes `count` pixels of row `y` from column `x` on. Shade 0 is the background. */
typedef void (*pantin_face_span)(void *context, uint16_t x, uint16_t y, uint16_t count, uint8_t shade);

/* Passes the rows to a function, in spans; later ones cover earlier ones. The background is not passed but where a shape has its colour. */
pantin_result pantin_face_spans(pantin_face *face, pantin_face_span span, void *context, uint16_t y0, uint16_t y1);

#ifdef __cplusplus
}
#endif

#endif
