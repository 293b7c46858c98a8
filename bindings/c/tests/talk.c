/* Prints the weights of lips that hear pseudo-random sounds and visemes, to be compared with the crate's.
 *
 *     talk RATE ROUNDS */
#include <stdio.h>
#include <stdlib.h>

#include "pantin_talk.h"

static uint32_t random_state = 1;

static uint32_t random_below(uint32_t below) {
    random_state = random_state * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)random_state * below >> 32);
}

/* Each call allocates its samples, so that a sanitizer notices what is read beyond them. */
static void sound(pantin_talk *talk) {
    uint32_t count = random_below(700), period = random_below(200) + 2, loud = random_below(16), i;
    int16_t *samples = (int16_t *)malloc(count * sizeof *samples + 1);
    if (!samples) exit(1);
    for (i = 0; i < count; i++) {
        int32_t noise = (int32_t)random_below(65536) - 32768;
        samples[i] = (int16_t)((i % period < period / 2 ? 32767 - noise / 4 : noise) >> loud);
    }
    pantin_talk_push(talk, samples, count);
    free(samples);
}

int main(int argc, char **argv) {
    pantin_talk talk;
    uint32_t rounds, i;
    if (argc != 3) return 2;
    printf("%d\n", pantin_talk_open(&talk, (uint32_t)atol(argv[1])) == PANTIN_OK);
    for (rounds = (uint32_t)atol(argv[2]); rounds; rounds--) {
        if (random_below(3)) sound(&talk);
        if (random_below(3)) pantin_talk_step(&talk, (uint16_t)random_below(90));
        if (random_below(9) == 0) {
            uint8_t viseme = (uint8_t)random_below(17);
            uint32_t at = talk.now + random_below(300) - 20;
            if (viseme > 12) viseme = 0;
            printf("%d\n", pantin_talk_viseme(&talk, viseme, at) == PANTIN_OK);
        }
        for (i = 0; i < PANTIN_TALK_VISEMES; i++) printf("%u ", talk.weights[i]);
        printf("%u\n", talk.speaking);
    }
    return 0;
}
