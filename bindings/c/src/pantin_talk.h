/* Lips for speech: from sound as it is played or recorded, or from visemes that a speech engine names with their times.
 *
 * Like the decoder it allocates nothing, uses no floating point and needs only stdint.h, stddef.h and string.h. The weights are those of the Rust
 * module pantin_face::talk, bit for bit; its documentation says how they are found.
 *
 *     static pantin_talk talk;
 *     static pantin_face face;                          // of pantin_face.h
 *     uint8_t viseme;
 *
 *     pantin_talk_open(&talk, 16000);
 *     for (;;) {
 *         pantin_talk_push(&talk, samples, count);      // all that was played since the last picture
 *         pantin_talk_step(&talk, 33);
 *         for (viseme = 1; viseme <= PANTIN_TALK_VISEMES; viseme++) pantin_face_viseme(&face, viseme, talk.weights[viseme - 1]);
 *         pantin_face_speaking(&face, talk.speaking);   // an emote's open mouth gives way
 *         pantin_face_step(&face, 33);
 *     }
 *
 * A second of 16 kHz takes 1.6 million instructions on a Cortex-M3 and 2.5 million on a Cortex-M0; the structure has 264 bytes.
 */
#ifndef PANTIN_TALK_H
#define PANTIN_TALK_H

#include "pantin.h"

#ifdef __cplusplus
extern "C" {
#endif

/* MPEG-4's visemes, 1 to 14: p b m, f v, th, t d, k g, ch sh, s z, n l, r, aa, e, i, o, u. */
#define PANTIN_TALK_VISEMES 14

/* A full weight. */
#define PANTIN_TALK_FULL 32768L

/* Visemes that wait for their time, at most. */
#define PANTIN_TALK_WAITING 16

/* A mouth that speaks. Fields may be read; only the functions change them. */
typedef struct pantin_talk {
    uint16_t weights[PANTIN_TALK_VISEMES]; /* Q15, 0 to PANTIN_TALK_FULL, of the visemes 1 to 14 */
    uint16_t targets[PANTIN_TALK_VISEMES]; /* where the weights go */
    uint16_t speaking;      /* Q15: PANTIN_TALK_FULL while there is sound or a viseme, and for 0.4 s after it */
    uint8_t gap;            /* steps of 10 ms for which speech goes on if no viseme follows */
    /* Sound. */
    uint32_t rate, phase;   /* samples a second; 8000 is added for each sample, and `rate` subtracted for each one at 8 kHz */
    int32_t sum;            /* of the samples since then */
    int32_t mean;           /* of the sound, which is subtracted: sixteenths */
    int32_t before[2];      /* the last two samples without their mean, in sixteenths */
    int32_t bands[6][2];    /* what each band made of them, in sixteenths */
    uint32_t levels[6];     /* sums of magnitudes in each band since the last hop */
    int32_t lowest[2];      /* the lowest level of this 0.8 s and of those before, as binary logarithms with 8 bits behind the point */
    int32_t loudest;        /* how loud speech is, likewise */
    uint8_t samples;        /* at 8 kHz since the last hop */
    uint8_t hops;           /* of this 0.8 s */
    uint8_t count;          /* of samples in `sum` */
    /* Visemes with times. */
    uint8_t viseme;         /* the one that is shown: 0 for none */
    uint8_t waiting;        /* how many follow */
    uint8_t visemes[PANTIN_TALK_WAITING];
    uint32_t times[PANTIN_TALK_WAITING]; /* when they begin */
    uint32_t now;           /* milliseconds since pantin_talk_open, a multiple of ten */
    uint16_t rest;          /* milliseconds that are not part of `now` yet */
    uint16_t silent_ms;     /* since samples were pushed */
} pantin_talk;

/* Begins with a closed mouth. `rate` is that of the samples in Hz, 8,000 to 48,000; PANTIN_NOT_FOUND for another, with which the mouth
 * hears nothing. Sound of another rate needs it again. */
pantin_result pantin_talk_open(pantin_talk *talk, uint32_t rate);

/* Listens to `count` samples of one channel: before each picture, all that was played or recorded since the last one. The weights follow every 10 ms of sound, unless a viseme is shown. No effect before pantin_talk_open. */
void pantin_talk_push(pantin_talk *talk, const int16_t *samples, size_t count);

/* Shows a viseme, 1 to 14, or none, 0, from `at` on until the next one's time: milliseconds of talk->now; a time in the past counts as now. Sound has no
 * effect while a viseme is shown or waits. PANTIN_NOT_FOUND for another number, for a time before that of one that waits, and before pantin_talk_open;
 * PANTIN_NO_ROOM if PANTIN_TALK_WAITING visemes wait already. */
pantin_result pantin_talk_viseme(pantin_talk *talk, uint8_t viseme, uint32_t at);

/* Lets time pass: visemes become due, the weights approach theirs every 10 ms, and the mouth closes if no samples came for 150 ms. The samples of a
 * time are pushed before its step, which may be longer. */
void pantin_talk_step(pantin_talk *talk, uint16_t ms);

#ifdef __cplusplus
}
#endif

#endif
