/* Lips for speech: see pantin_talk.h. The steps are those of talk.rs of the Rust crate pantin-face, with the same names.
 *
 * The right shift of a negative number is taken to round down, as it does with every compiler for small machines. */
#include "pantin_talk.h"

#include <string.h>

typedef char right_shift_rounds_down[(-1 >> 1) == -1 ? 1 : -1];

/* The rate of the samples that are measured, and their number in a hop of 10 ms. */
#define BAND_RATE 8000
#define HOP 80

/* The weights go towards their targets once in this time. */
#define TICK_MS 10

/* The time without samples after which the mouth closes. */
#define SILENT_MS 150

/* Steps of 10 ms for which speech goes on without a viseme: longer than the gaps of p, b and m. */
#define GAP 40

/* Noise is the lowest level of at least this number of hops. */
#define LOWEST_HOPS 80

/* Levels are binary logarithms with 8 bits behind the point: 256 is a factor of two. What is softer than SOFTEST is silence, a mean magnitude of 11. */
#define SOFTEST 2500
#define LOUDEST 8192
#define ABOVE_NOISE 448
#define SPEECH_ABOVE_NOISE 1200

/* Bands by their middle in Hz. */
enum { L300, L650, L1000, L1500, L2200, L3200, BANDS };

/* Places of visemes among the weights. */
enum { SS = 6, AA = 9, E, I, O, U };

/* Each band's resonator: twice the radius of its pole times the cosine of the angle, and the square of the radius, in 512ths. */
static const int16_t resonators[BANDS][2] = {{862, 384}, {774, 384}, {627, 384}, {339, 384}, {-139, 384}, {-655, 320}};

/* 4096 / n. */
static const int16_t reciprocals[7] = {0, 4096, 2048, 1365, 1024, 819, 683};

/* The level of a sum of magnitudes, above 0. */
static int32_t logarithm(uint32_t x) {
    int32_t bits = 0;
    while (x >> bits >> 1) bits++;
    return bits * 256 + (int32_t)((bits < 8 ? x << (8 - bits) : x >> (bits - 8)) & 255);
}

/* A weight that grows from 0 at `none` to its full at `full`. */
static uint16_t ramp(int32_t level, int32_t none, int32_t full) {
    if (level <= none) return 0;
    if (level >= full) return PANTIN_TALK_FULL;
    return (uint16_t)((level - none) * PANTIN_TALK_FULL / (full - none));
}

static uint16_t part(uint16_t weight, int32_t of) { return (uint16_t)((uint32_t)weight * (uint32_t)of >> 15); }

static int32_t greater(int32_t a, int32_t b) { return a > b ? a : b; }

/* A step of all weights towards their targets: half of the way, and five eighths where a weight falls, so that lips meet in a short gap. */
static void approach(pantin_talk *t) {
    int i, quiet = 1;
    for (i = 0; i < PANTIN_TALK_VISEMES; i++) quiet &= t->targets[i] == 0;
    if (!quiet) {
        t->gap = GAP;
    } else if (t->gap) {
        t->gap--;
    }
    if (t->gap == 0) {
        t->speaking = (uint16_t)(t->speaking - ((t->speaking + 7) >> 3));
    } else {
        t->speaking = (uint16_t)(t->speaking + ((PANTIN_TALK_FULL - t->speaking + 3) >> 2));
    }
    for (i = 0; i < PANTIN_TALK_VISEMES; i++) {
        int32_t rest = (int32_t)t->targets[i] - t->weights[i];
        int32_t step = rest < 0 ? -((-rest * 5) >> 3) : rest >> 1;
        t->weights[i] = (uint16_t)(t->weights[i] + (step ? step : rest));
    }
}

/* Follows the lowest and the loudest level; returns 1 if a hop of such levels is louder than noise. */
static int audible(pantin_talk *t, int32_t all, int32_t open) {
    int32_t noise;
    if (all < t->lowest[0]) t->lowest[0] = all;
    noise = greater(t->lowest[0] < t->lowest[1] ? t->lowest[0] : t->lowest[1], SOFTEST);
    if (++t->hops == LOWEST_HOPS) {
        t->hops = 0;
        t->lowest[1] = t->lowest[0];
        t->lowest[0] = all;
    }
    if (open > t->loudest) {
        t->loudest += (open - t->loudest + 3) >> 2;
    } else {
        t->loudest -= t->hops & 1;
    }
    t->loudest = greater(t->loudest, noise + SPEECH_ABOVE_NOISE);
    return all >= noise + ABOVE_NOISE;
}

/* The mouth's targets by the levels of a hop. */
static void listen(pantin_talk *t) {
    int32_t level[BANDS], open, voice;
    uint16_t jaw, hiss, loud, wide, narrow, front, rounded;
    int i;
    for (i = 0; i < BANDS; i++) {
        level[i] = logarithm(t->levels[i] + HOP);
        t->levels[i] = 0;
    }
    memset(t->targets, 0, sizeof t->targets);
    open = greater(level[L650], level[L1000]);
    voice = greater(open, level[L300]);
    if (!audible(t, greater(voice, level[L3200]), open)) return;
    hiss = ramp(level[L3200] - voice, -150, 100);
    t->targets[SS] = part(hiss, ramp(level[L3200] - t->loudest, -1100, -700));
    /* Where the voice has its energy: below 500 Hz in i and u, above in aa, e and o; above 1800 Hz in e and i; in o and u below. */
    wide = part(ramp(level[L650] - level[L300], -300, -100), PANTIN_TALK_FULL - hiss);
    narrow = (uint16_t)(PANTIN_TALK_FULL - hiss - wide);
    jaw = part(wide, ramp(open - t->loudest, -750, -150));
    front = ramp(level[L2200] - level[L1000], -470, -310);
    rounded = part(ramp(level[L300] - level[L1000], 80, 220), PANTIN_TALK_FULL - front);
    t->targets[E] = part(jaw, front);
    t->targets[O] = part(jaw, rounded);
    t->targets[AA] = (uint16_t)(jaw - t->targets[E] - t->targets[O]);
    /* i and u open the jaw little: they have their whole weight where m and n, which are softer, have none. */
    loud = part(narrow, ramp(voice - t->loudest, -420, -235));
    t->targets[U] = part(loud, ramp(level[L1500] - level[L2200], -40, 120));
    t->targets[I] = (uint16_t)(loud - t->targets[U]);
}

/* Takes up one sample at 8 kHz. */
static void sample(pantin_talk *t, int32_t x) {
    int i;
    int32_t driven;
    t->mean += (x * 16 - t->mean) >> 4;
    x = x * 16 - t->mean;
    driven = (x - t->before[1]) >> 3;
    t->before[1] = t->before[0];
    t->before[0] = x;
    for (i = 0; i < BANDS; i++) {
        int32_t *band = t->bands[i];
        int32_t y = driven + ((resonators[i][0] * band[0] - resonators[i][1] * band[1]) >> 9);
        band[1] = band[0];
        band[0] = y;
        t->levels[i] += (uint32_t)(y < 0 ? -y : y) >> 4;
    }
    if (++t->samples < HOP) return;
    t->samples = 0;
    if (t->viseme || t->waiting) {
        memset(t->levels, 0, sizeof t->levels);
        return;
    }
    listen(t);
    approach(t);
}

pantin_result pantin_talk_open(pantin_talk *talk, uint32_t rate) {
    memset(talk, 0, sizeof *talk);
    if (rate < BAND_RATE || rate > 6 * BAND_RATE) return PANTIN_NOT_FOUND;
    talk->rate = rate;
    talk->lowest[0] = LOUDEST;
    return PANTIN_OK;
}

void pantin_talk_push(pantin_talk *talk, const int16_t *samples, size_t count) {
    if (talk->rate == 0) return;
    if (count) talk->silent_ms = 0;
    for (; count; count--, samples++) {
        talk->sum += *samples;
        talk->count++;
        talk->phase += BAND_RATE;
        if (talk->phase < talk->rate) continue;
        talk->phase -= talk->rate;
        sample(talk, (talk->sum * reciprocals[talk->count]) >> 12);
        talk->sum = 0;
        talk->count = 0;
    }
}

pantin_result pantin_talk_viseme(pantin_talk *talk, uint8_t viseme, uint32_t at) {
    if (viseme > PANTIN_TALK_VISEMES || talk->rate == 0) return PANTIN_NOT_FOUND;
    if (talk->waiting == PANTIN_TALK_WAITING) return PANTIN_NO_ROOM;
    if (talk->waiting && (int32_t)(at - talk->times[talk->waiting - 1]) < 0) return PANTIN_NOT_FOUND;
    talk->visemes[talk->waiting] = viseme;
    talk->times[talk->waiting++] = at;
    return PANTIN_OK;
}

/* Shows the visemes that are due. */
static void due(pantin_talk *t) {
    while (t->waiting && (int32_t)(t->now - t->times[0]) >= 0) {
        t->viseme = t->visemes[0];
        t->waiting--;
        memmove(t->visemes, t->visemes + 1, t->waiting);
        memmove(t->times, t->times + 1, t->waiting * sizeof t->times[0]);
    }
}

void pantin_talk_step(pantin_talk *talk, uint16_t ms) {
    uint32_t left = (uint32_t)talk->rest + ms;
    /* The time of a step before which there was sound is the sound's own. */
    uint16_t most = talk->silent_ms == 0 ? SILENT_MS - TICK_MS : SILENT_MS;
    for (; left >= TICK_MS; left -= TICK_MS) {
        int timed = talk->viseme || talk->waiting;
        talk->now += TICK_MS;
        due(talk);
        talk->silent_ms = (uint16_t)(timed ? SILENT_MS : talk->silent_ms >= most ? talk->silent_ms : talk->silent_ms + TICK_MS);
        if (talk->silent_ms < SILENT_MS) continue;
        memset(talk->targets, 0, sizeof talk->targets);
        if (talk->viseme) talk->targets[talk->viseme - 1] = PANTIN_TALK_FULL;
        approach(talk);
    }
    talk->rest = (uint16_t)left;
}
