/* Plays key clips, version 2 of the format. Numbers in parentheses are sections of FORMAT.md. It is empty unless PANTIN_KEYS is defined.
 *
 * The words of (18) are in the lent channels, from the end of the last one on towards the first. Numbers of 64 bits wrap as uint64_t. */
#include "pantin.h"

#ifdef PANTIN_KEYS
#include "pantin_keys.h"

enum { LINEAR = 0, CATMULL_ROM = 1, NATURAL = 2, DISCRETE = 3, NO_GRID = 4 };
enum { RESTS = 0, CONSTANT = 1, KEYED = 2 };
enum { BY_BEFORE, BY_ITSELF, BY_ANOTHER };
enum {
    AT_CONSTANT = 9, AT_QUANTUM = 18, AT_SAME_GRID = 21, AT_NEW_GRID = 22, AT_INTERPOLATION = 23, AT_ENDS = 38, AT_HALF = 42, AT_COUNT = 43,
    AT_GAP = 55, AT_CLOSED = 79, AT_BY_HALF = 85, AT_BY_LEADER = 86, AT_SAME_DISTANCE = 89, AT_DISTANCE = 90, AT_SIGN = 102, AT_SHIFT = 104,
    AT_EXACT = 105, AT_LENGTH = 106, AT_NEGATIVE = 202, CONTEXTS = 204
};
#define STATE_WORDS 5u
#define MAX_WORDS 65535u
#define PART_FRAMES 64u
#define MOST ((int64_t)1 << 26)
#define ANGLE 63u /* a scale: all others are bits of a fraction */

static const uint16_t quanta[12] = {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000};
static const uint16_t rates[16] = {40960, 25206, 18204, 14247, 11703, 9930, 8623, 7620, 6827, 6183, 5650, 5201, 4819, 4489, 4201, 3948};

/* The lent channels hold five words each, also where a compiler aligns nothing. */
typedef char pantin_channel_is_five_words[sizeof(pantin_channel) == 4 * STATE_WORDS ? 1 : -1];

/* ---- Arithmetic (18) ---- */

static int64_t plus(int64_t a, int64_t b) { return (int64_t)((uint64_t)a + (uint64_t)b); }
static int64_t less(int64_t a, int64_t b) { return (int64_t)((uint64_t)a - (uint64_t)b); }
static int64_t times(int64_t a, int64_t b) { return (int64_t)((uint64_t)a * (uint64_t)b); }

/* The nearest quotient; halves away from zero. Small divisors, as lengths of spans are, take digits of 16 bits, which are divisions of 32. */
static int64_t divide(int64_t value, uint32_t by) {
    uint64_t size = (value < 0 ? 0u - (uint64_t)value : (uint64_t)value) + (by >> 1);
    if (by >> 16) {
        size /= by;
    } else {
        uint32_t high = (uint32_t)(size >> 32), low = (uint32_t)size, rest, digit;
        uint64_t quotient = 0;
        if (high) { quotient = (uint64_t)(high / by) << 32; high %= by; }
        rest = high << 16 | low >> 16;
        digit = rest / by;
        rest = (rest - digit * by) << 16 | (low & 0xffff);
        size = quotient | digit << 16 | rest / by;
    }
    return (int64_t)(value < 0 ? 0u - size : size);
}

static int64_t shift_rounded(int64_t value, unsigned bits) {
    value = plus(value, (int64_t)1 << (bits - 1));
    return value < 0 ? ~(~value >> bits) : value >> bits;
}

/* A product of a number in 2^-30. */
static int64_t scaled(int32_t one, int32_t other) { return shift_rounded((int64_t)one * other, 30); }

/* The raw value of thousandths, not yet wrapped to 32 bits. */
static int64_t raw_value(uint8_t scale, int32_t thousandths) {
    if (scale == ANGLE) return shift_rounded(thousandths * (int64_t)3127499741, 18);
    return shift_rounded(thousandths * (int64_t)2199023256, 41u - scale);
}

/* ---- Words ---- */

static uint8_t *word_at(const pantin_player *p, uint32_t at) {
    return (uint8_t *)(p->moving + p->clip->states) - 4 * ((size_t)at + 1);
}

static uint32_t get(const pantin_player *p, uint32_t at) {
    uint32_t word = 0;
    if (at < STATE_WORDS * p->clip->states) memcpy(&word, word_at(p, at), 4);
    return word;
}

static void set(const pantin_player *p, uint32_t at, uint32_t word) {
    if (at < STATE_WORDS * p->clip->states) memcpy(word_at(p, at), &word, 4);
}

/* ---- Grids and keys (20): a grid is a word, then its times, two to a word ---- */

typedef struct {
    uint32_t at;
    uint16_t last, before;
    uint8_t interpolation, half;
} grid_of;

typedef struct {
    grid_of grid;
    uint32_t at;
    uint8_t stride, scale;
} keys_of;

static grid_of grid_at(const pantin_player *p, uint32_t at) {
    uint32_t word = get(p, at);
    grid_of grid;
    grid.at = at;
    grid.last = word & 8191;
    grid.interpolation = (word >> 13) & 3;
    grid.half = (word >> 15) & 1;
    grid.before = (uint16_t)(word >> 16);
    return grid;
}

static uint32_t time_of(const pantin_player *p, const grid_of *grid, uint32_t key) {
    uint32_t word = get(p, grid->at + 1 + key / 2);
    return key & 1 ? word >> 16 : word & 0xffff;
}

static void set_time(const pantin_player *p, const grid_of *grid, uint32_t key, uint32_t frame) {
    uint32_t at = grid->at + 1 + key / 2, word = get(p, at);
    set(p, at, key & 1 ? (word & 0xffff) | frame << 16 : (word & 0xffff0000u) | frame);
}

static uint32_t length_of(const pantin_player *p, const grid_of *grid, uint32_t key) {
    return time_of(p, grid, key + 1) - time_of(p, grid, key);
}

/* The last key of no later frame. */
static uint32_t key_at(const pantin_player *p, const grid_of *grid, uint32_t frame) {
    uint32_t from = 0, to = grid->last + 1u;
    while (from + 1 < to) {
        uint32_t middle = (from + to) / 2;
        if (time_of(p, grid, middle) <= frame) from = middle;
        else to = middle;
    }
    return from;
}

static keys_of keys_at(const pantin_player *p, uint32_t grid, uint32_t at, uint8_t scale) {
    keys_of keys;
    keys.grid = grid_at(p, grid);
    keys.at = at;
    keys.stride = keys.grid.interpolation >= NATURAL ? 2 : 1;
    keys.scale = scale;
    return keys;
}

/* Of a channel: its fields for segments hold where its grid and its keys are. */
static keys_of keys_of_channel(const pantin_player *p, const pantin_channel *c) {
    return keys_at(p, c->leader | (uint32_t)c->step << 8, (uint8_t)c->prev_sign | (uint32_t)c->more << 8, c->mode);
}

static int32_t value_of(const pantin_player *p, const keys_of *keys, uint32_t key) { return (int32_t)get(p, keys->at + key * keys->stride); }

static int64_t rise(const pantin_player *p, const keys_of *keys, uint32_t key) {
    return raw_value(keys->scale, value_of(p, keys, key + 1)) - raw_value(keys->scale, value_of(p, keys, key));
}

/* The slope of a chord in raw units a frame, in 2^-8. */
static int64_t chord(const pantin_player *p, const keys_of *keys, uint32_t key) {
    return divide(rise(p, keys, key) * 256, length_of(p, &keys->grid, key));
}

/* ---- Bits (19) ---- */

typedef struct {
    pantin_player *p;
    uint32_t range, code;
    uint32_t end;    /* the frame of every grid's last key */
    uint32_t moving; /* channels with keys so far */
    uint32_t words, grids, newest, running, most_keys, distance;
    uint8_t looped, has_half, malformed, status;
    uint8_t quantum_of[3];
    uint16_t contexts[CONTEXTS]; /* the chance in the high 12 bits, the count in the low 4 */
} reading;

static int split(reading *r, uint32_t chance) {
    uint32_t ones = (r->range >> 12) * chance;
    int bit = r->code < ones;
    if (bit) {
        r->range = ones;
    } else {
        r->code -= ones;
        r->range -= ones;
    }
    while (r->range < (uint32_t)1 << 24) {
        r->range <<= 8;
        r->code = r->code << 8 | pantin_keys_byte(&r->p->reader);
    }
    return bit;
}

static int bit_of(reading *r, unsigned context) {
    uint32_t chance = r->contexts[context] >> 4, count = r->contexts[context] & 15u, rate = rates[count];
    int bit = split(r, chance);
    if (bit) chance += ((4096 - chance) * rate) >> 16;
    else chance -= (chance * rate) >> 16;
    if (chance < 40) chance = 40;
    if (chance > 4056) chance = 4056;
    r->contexts[context] = (uint16_t)(chance << 4 | (count < 15 ? count + 1 : 15));
    return bit;
}

static uint32_t raw_bits(reading *r, uint32_t count) {
    uint32_t value = 0;
    while (count-- > 0) value = value << 1 | (uint32_t)split(r, 2048);
    return value;
}

static uint32_t unary(reading *r, unsigned first, uint32_t most) {
    uint32_t ones = 0;
    while (ones < most && bit_of(r, first + (ones < 11 ? (unsigned)ones : 11u))) ones++;
    return ones;
}

static uint32_t gamma_of(reading *r, unsigned first) {
    uint32_t bits = unary(r, first, 12);
    return ((uint32_t)1 << bits | raw_bits(r, bits)) - 1;
}

/* ---- Channels (20) ---- */

/* Takes words that no channel needs, the one that is read included. */
static void take(reading *r, uint32_t words) {
    uint32_t states = r->p->clip->states, free = r->moving + 1 < states ? (states - r->moving - 1) * STATE_WORDS : 0;
    r->words += words;
    if (r->words > MAX_WORDS || r->words > free) r->malformed = 1;
}

static uint32_t gap_of(reading *r, uint32_t room, uint32_t after) {
    uint32_t left = room - after - 1, bits = 0, gap;
    while ((after + 2) << (bits + 1) <= ((3 * left) >> 2) + after + 1) bits++;
    gap = unary(r, bits ? AT_GAP + 12 : AT_GAP, (left - 1) >> bits) << bits;
    gap |= raw_bits(r, bits);
    if (gap >= left) r->malformed = 1;
    return gap + 1;
}

static grid_of new_grid(reading *r, uint8_t interpolation) {
    pantin_player *p = r->p;
    uint32_t inner = 0, end = r->end, last = 1, at = r->words, frame = 0, key;
    uint8_t half = 0;
    grid_of grid = {0, 0, 0, 0, 0};
    if (!bit_of(r, AT_ENDS + interpolation)) {
        half = r->has_half && bit_of(r, AT_HALF);
        inner = gamma_of(r, AT_COUNT);
        last = inner + 1;
        if (half) {
            end >>= 1;
            last *= 2;
        }
    }
    if (inner >= end) r->malformed = 1;
    take(r, 2 + last / 2);
    if (r->malformed) return grid;
    set(p, at, last | (uint32_t)interpolation << 13 | (uint32_t)half << 15 | r->newest << 16);
    grid = grid_at(p, at);
    for (key = 0; key <= inner && !r->malformed; key++) {
        set_time(p, &grid, key, frame);
        if (half) set_time(p, &grid, key + inner + 1, frame + end);
        if (key < inner) frame += gap_of(r, end - frame, inner - key - 1);
    }
    set_time(p, &grid, last, r->end);
    return grid;
}

static grid_of read_grid(reading *r) {
    uint32_t back = 0, n;
    uint8_t interpolation = NO_GRID, high;
    unsigned first;
    grid_of grid;
    if (r->grids > 0) {
        grid = grid_at(r->p, r->running);
        if (bit_of(r, AT_SAME_GRID)) return grid;
        if (!bit_of(r, AT_NEW_GRID)) {
            for (n = r->grids - 1; n > 0; n >>= 1) back++;
            back = raw_bits(r, back);
            if (back >= r->grids) {
                r->malformed = 1;
                return grid;
            }
            grid = grid_at(r->p, r->newest);
            while (back-- > 0) grid = grid_at(r->p, grid.before);
            r->running = grid.at;
            return grid;
        }
        interpolation = grid.interpolation;
    }
    first = AT_INTERPOLATION + 3u * interpolation;
    high = (uint8_t)bit_of(r, first);
    grid = new_grid(r, (uint8_t)(high << 1 | bit_of(r, first + 1u + high)));
    r->grids++;
    r->newest = r->running = grid.at;
    if (grid.interpolation >= NATURAL && grid.last >= r->most_keys) r->most_keys = grid.last + 1u;
    return grid;
}

/* The value that the leader has at its own key of a frame. */
static int32_t led(reading *r, uint32_t leader, uint32_t frame) {
    keys_of keys;
    int32_t drift = 0;
    uint32_t key;
    if (leader >= r->moving) {
        r->malformed = 1;
        return 0;
    }
    keys = keys_of_channel(r->p, &r->p->moving[leader]);
    if (r->looped && frame >= r->end) {
        frame -= r->end;
        drift = value_of(r->p, &keys, keys.grid.last) - value_of(r->p, &keys, 0);
    }
    key = key_at(r->p, &keys.grid, frame);
    if (time_of(r->p, &keys.grid, key) != frame) r->malformed = 1;
    return value_of(r->p, &keys, key) + drift;
}

static int32_t residual(reading *r, uint8_t other, uint8_t *length_class) {
    uint32_t length = unary(r, AT_LENGTH + 12u * (4u * other + *length_class), 27), size;
    int negative;
    *length_class = length < 3 ? 1 : length < 5 ? 2 : 3;
    if (length == 0) return 0;
    negative = bit_of(r, AT_NEGATIVE + other);
    size = (uint32_t)1 << (length - 1);
    size |= raw_bits(r, length - 1);
    return negative ? -(int32_t)size : (int32_t)size;
}

static int32_t thousandths(reading *r, int32_t count, uint32_t quantum) {
    int64_t value = (int64_t)count * quantum;
    if (value < MOST && -value < MOST) return (int32_t)value;
    r->malformed = 1;
    return 0;
}

static void read_values(reading *r, const keys_of *keys, uint8_t kind_class, int32_t value, uint32_t quantum, int closed) {
    pantin_player *p = r->p;
    uint32_t last = keys->grid.last, key, leader = 0, later = 0;
    int32_t offset = 0;
    uint8_t source = BY_BEFORE, negative = 0, exact = 0, length_class[2] = {0, 0};
    if (keys->grid.half && bit_of(r, AT_BY_HALF)) {
        source = BY_ITSELF;
        negative = (uint8_t)bit_of(r, AT_SIGN);
        exact = (uint8_t)bit_of(r, AT_EXACT);
    } else if (r->moving > 0 && bit_of(r, AT_BY_LEADER + kind_class)) {
        source = BY_ANOTHER;
        if (!bit_of(r, AT_SAME_DISTANCE)) r->distance = 1 + gamma_of(r, AT_DISTANCE);
        leader = r->moving - r->distance;
        negative = (uint8_t)bit_of(r, AT_SIGN + 1);
        if (r->has_half && bit_of(r, AT_SHIFT)) later = r->end >> 1;
    }
    for (key = 0; key <= last && !r->malformed; key++) {
        uint8_t other = 1;
        int32_t base = 0, more;
        if (closed && key == last) {
            set(p, keys->at + key * keys->stride, (uint32_t)value_of(p, keys, 0));
            return;
        }
        if (source == BY_ITSELF && key >= last / 2 && key < last) base = value_of(p, keys, key - last / 2);
        else if (source == BY_ANOTHER) base = led(r, leader, time_of(p, &keys->grid, key) + later);
        else other = 0;
        if (other) {
            value = (int32_t)divide(base, quantum);
            value = (negative ? -value : value) + offset;
        }
        if (!other || !exact) {
            more = residual(r, other, &length_class[other]);
            value += more;
            if (key == 0 && source == BY_ANOTHER) offset = more;
        }
        set(p, keys->at + key * keys->stride, (uint32_t)thousandths(r, value, quantum));
    }
}

/* The bits of a channel's fraction, or ANGLE; more than 32 if it must rest. */
static uint8_t scale_of(const pantin_clip *clip, uint8_t kind, int8_t exponent) {
    int fraction = kind < PANTIN_EULER_X ? -clip->exponent : kind == PANTIN_SCALAR ? 31 - exponent : 30;
    if (kind >= PANTIN_EULER_X && (kind < PANTIN_QUATERNION_W || (kind > PANTIN_QUATERNION_Z && kind != PANTIN_SCALAR))) return ANGLE;
    return (uint8_t)(fraction < 0 || fraction > 32 ? 33 : fraction);
}

/* A position at rest, in thousandths of the rig's unit. */
static int32_t rest_of(const pantin_clip *clip, int32_t offset) {
    int8_t e = clip->rig.offset_exponent;
    int64_t rest = (int64_t)offset * 1000;
    rest = e < 0 ? shift_rounded(rest, (unsigned)-e) : rest * ((int64_t)1 << (e > 20 ? 20 : e));
    return rest < MOST && -rest < MOST ? (int32_t)rest : 0;
}

static void read_channel(reading *r, const pantin_key_channel *channel, uint16_t slot, int8_t exponent) {
    pantin_player *p = r->p;
    uint8_t kind = channel->kind, scale = scale_of(p->clip, kind, exponent), length_class = 0;
    uint8_t kind_class = kind < PANTIN_EULER_X ? 1 : scale == ANGLE ? 0 : 2;
    unsigned before = 3u * r->status + kind_class;
    uint32_t quantum, at;
    int32_t rest;
    int closed;
    grid_of grid;
    keys_of keys;
    pantin_channel *c;
    r->status = bit_of(r, before) ? KEYED : bit_of(r, AT_CONSTANT + before) ? CONSTANT : RESTS;
    if (r->status == RESTS) return;
    if (!bit_of(r, AT_QUANTUM + kind_class)) r->quantum_of[kind_class] = (uint8_t)raw_bits(r, 4);
    if (scale == 33 || r->quantum_of[kind_class] > 11) {
        r->malformed = 1;
        return;
    }
    quantum = quanta[r->quantum_of[kind_class]];
    rest = (int32_t)divide(kind < PANTIN_EULER_X ? rest_of(p->clip, channel->offset) : 0, quantum);
    if (r->status == CONSTANT) {
        rest += residual(r, 0, &length_class);
        p->pose[slot] = (int32_t)(uint32_t)(uint64_t)raw_value(scale, thousandths(r, rest, quantum));
        return;
    }
    grid = read_grid(r);
    at = r->words;
    if (r->malformed) return;
    keys = keys_at(p, grid.at, at, scale);
    take(r, (grid.last + 1u) * keys.stride);
    if (r->malformed) return;
    closed = bit_of(r, AT_CLOSED + 2u * kind_class + (grid.last == 1));
    read_values(r, &keys, kind_class, rest, quantum, closed);
    c = &p->moving[r->moving++];
    c->channel = slot;
    c->mode = scale;
    c->leader = (uint8_t)grid.at;
    c->step = (uint8_t)(grid.at >> 8);
    c->prev_sign = (int8_t)(uint8_t)at;
    c->more = (uint8_t)(at >> 8);
}

/* Reads all channels, or shows the rig at rest if a rule is broken already. */
static pantin_result read_channels(reading *r) {
    pantin_player *p = r->p;
    const pantin_rig *rig = &p->clip->rig;
    pantin_scalar scalar;
    pantin_first_scalar(&scalar, rig);
    pantin_first_joint(&p->joint, rig);
    for (p->resume = 0; p->resume < rig->channels; p->resume++) {
        pantin_key_channel channel;
        pantin_result result;
        if (p->clip->source->error != PANTIN_OK) return p->clip->source->error;
        result = pantin_keys_channel(p, &channel);
        if (result != PANTIN_OK) return result;
        if (channel.kind == PANTIN_SCALAR && !pantin_next_scalar(&scalar)) return PANTIN_ERROR_READ;
        p->pose[p->resume] = channel.rest;
        if (!r->malformed) read_channel(r, &channel, p->resume, channel.kind == PANTIN_SCALAR ? scalar.exponent : 0);
    }
    return p->clip->source->error;
}

/* ---- Curves (21): three words a key behind all keys are the pivots, factors and dependences of a grid ---- */

typedef struct {
    reading *r;
    uint32_t at[3];
    grid_of grid;
} solver;

static int32_t number(solver *s, int64_t value) {
    if (value < -2147483647 - 1 || value > 2147483647) s->r->malformed = 1;
    return (int32_t)value;
}

static int32_t reach_of(const solver *s, uint32_t span, uint32_t *hold) {
    uint32_t length = length_of(s->r->p, &s->grid, span);
    uint32_t part = s->grid.interpolation == DISCRETE ? (uint32_t)divide(65536, length) : 0;
    if (hold) *hold = (length << 17) + part;
    return (int32_t)((length << 16) - part);
}

static int64_t bend(int64_t before, int64_t after) { return (after - before) * 1536; }

/* Where the last chord ended, and the last span's length and reach: grids of equal spans need one division for it. */
typedef struct {
    int64_t ended;
    uint32_t length;
    int32_t reach;
} chain;

/* The chord that follows, of a channel. */
static int64_t next_chord(const solver *s, const keys_of *keys, uint32_t key, chain *c) {
    const pantin_player *p = s->r->p;
    uint32_t length = length_of(p, &s->grid, key);
    int64_t from = c->ended;
    if (length != c->length) c->reach = reach_of(s, key, NULL);
    c->length = length;
    if (!keys) return 0;
    c->ended = raw_value(keys->scale, value_of(p, keys, key + 1));
    return divide((c->ended - from) * 256, length);
}

/* Eliminates, and substitutes back: for a channel's second differences, or without keys for the dependences on the first key. Returns what the
 * neighbours of a loop's first key pull it by, less its bend. */
static int64_t sweep(solver *s, const keys_of *keys) {
    const pantin_player *p = s->r->p;
    uint32_t at = keys ? keys->at + 1 : s->at[2], stride = keys ? 2 : 1, last = s->grid.last, key;
    int32_t end = keys ? 0 : (int32_t)1 << 30, value = end, first_reach;
    int64_t first, before, sum;
    chain c = {0, 0, 0};
    if (keys) c.ended = raw_value(keys->scale, value_of(p, keys, 0));
    before = first = next_chord(s, keys, 0, &c);
    first_reach = c.reach;
    set(p, at, (uint32_t)end);
    set(p, at + last * stride, (uint32_t)end);
    for (key = 1; key < last; key++) {
        int64_t pull = (int64_t)c.reach * value, after = next_chord(s, keys, key, &c);
        value = number(s, divide(less(bend(before, after), pull), get(p, s->at[0] + key)));
        set(p, at + key * stride, (uint32_t)value);
        before = after;
    }
    value = end;
    for (key = last; --key > 0;) {
        value = number(s, (int32_t)get(p, at + key * stride) - scaled((int32_t)get(p, s->at[1] + key), value));
        set(p, at + key * stride, (uint32_t)value);
    }
    sum = plus((int64_t)first_reach * value, (int64_t)c.reach * (int32_t)get(p, at + (last - 1) * stride));
    return less(sum, bend(before, first));
}

static void prepare(solver *s) {
    const pantin_player *p = s->r->p;
    uint32_t hold, held, first, key;
    int32_t factor = 0, reach = reach_of(s, 0, &hold);
    first = hold;
    for (key = 1; key < s->grid.last; key++) {
        int32_t right = reach_of(s, key, &held);
        uint32_t pivot = hold + held - (uint32_t)scaled(reach, factor);
        factor = (int32_t)divide((int64_t)right << 30, pivot);
        set(p, s->at[0] + key, pivot);
        set(p, s->at[1] + key, (uint32_t)factor);
        reach = right;
        hold = held;
    }
    if (s->r->looped) set(p, s->at[0], hold + first + (uint32_t)shift_rounded(sweep(s, NULL), 30));
}

static void solve(solver *s, const keys_of *keys) {
    const pantin_player *p = s->r->p;
    int64_t pulled = sweep(s, keys);
    uint32_t key;
    int32_t first;
    if (!s->r->looped || s->r->malformed) return;
    first = number(s, divide(less(0, pulled), get(p, s->at[0])));
    for (key = 0; key <= s->grid.last; key++) {
        uint32_t at = keys->at + 1 + 2 * key;
        set(p, at, (uint32_t)number(s, (int32_t)get(p, at) + scaled((int32_t)get(p, s->at[2] + key), first)));
    }
}

static void solve_all(reading *r) {
    uint32_t i, prepared = MAX_WORDS + 1;
    solver s;
    s.r = r;
    for (i = 0; i < 3; i++) s.at[i] = r->words + i * r->most_keys;
    for (i = 0; i < r->moving && !r->malformed; i++) {
        keys_of keys = keys_of_channel(r->p, &r->p->moving[i]);
        if (keys.stride < 2) continue;
        s.grid = keys.grid;
        if (prepared != keys.grid.at) prepare(&s);
        prepared = keys.grid.at;
        if (!r->malformed) solve(&s, &keys);
    }
}

/* ---- Playing (22) ---- */

static int64_t tangent(const pantin_player *p, const keys_of *keys, uint32_t key) {
    uint32_t last = keys->grid.last, before = key - 1, after = key;
    if (key == 0 || key == last) {
        if (!p->clip->looped) return chord(p, keys, key == 0 ? 0 : last - 1);
        before = last - 1;
        after = 0;
    }
    return divide((rise(p, keys, before) + rise(p, keys, after)) * 256, length_of(p, &keys->grid, before) + length_of(p, &keys->grid, after));
}

typedef struct {
    int64_t p, rise;
    int32_t w[2];
    uint32_t frames;
} span;

static span span_at(const pantin_player *p, const keys_of *keys, uint32_t key) {
    span s;
    s.p = raw_value(keys->scale, value_of(p, keys, key));
    s.rise = rise(p, keys, key);
    s.w[0] = s.w[1] = 0;
    s.frames = length_of(p, &keys->grid, key);
    if (keys->grid.interpolation >= NATURAL) {
        s.w[0] = (int32_t)get(p, keys->at + 1 + 2 * key);
        s.w[1] = (int32_t)get(p, keys->at + 3 + 2 * key);
    } else if (keys->grid.interpolation == CATMULL_ROM) {
        int64_t straight = 6 * chord(p, keys, key), from = tangent(p, keys, key), to = tangent(p, keys, key + 1);
        s.w[0] = (int32_t)(uint32_t)(uint64_t)divide(straight - 4 * from - 2 * to, s.frames << 8);
        s.w[1] = (int32_t)(uint32_t)(uint64_t)divide(2 * from + 4 * to - straight, s.frames << 8);
    }
    return s;
}

/* Value and second difference at a frame of a span. */
static int64_t point(const span *s, uint32_t frames, int64_t *w) {
    int64_t n = frames, all = s->frames, bent;
    *w = s->w[n != 0];
    if (n == 0) return s->p;
    if (n == all) return s->p + s->rise;
    bent = times((2 * all - n) * s->w[0] + (all + n) * s->w[1], n * (all - n));
    *w = s->w[0] + divide(n * ((int64_t)s->w[1] - s->w[0]), s->frames);
    return s->p + divide(n * s->rise, s->frames) - divide(bent, 6 * s->frames);
}

/* Sets a channel to a frame: to the start of the part in which it is, and on from there. */
static void show(pantin_player *p, pantin_channel *c, uint32_t frame) {
    keys_of keys = keys_of_channel(p, c);
    uint32_t key = key_at(p, &keys.grid, frame), passed, begin, j, c2, c3;
    int64_t from, to, w, w_to, k;
    span s;
    if (key == keys.grid.last) {
        c->v = c->w = c->k = 0;
        c->left = (uint8_t)frame;
        p->pose[c->channel] = (int32_t)(uint32_t)(uint64_t)raw_value(c->mode, value_of(p, &keys, key));
        return;
    }
    s = span_at(p, &keys, key);
    passed = frame - time_of(p, &keys.grid, key);
    begin = passed / PART_FRAMES * PART_FRAMES;
    j = s.frames - begin < PART_FRAMES ? s.frames - begin : PART_FRAMES;
    from = point(&s, begin, &w);
    to = point(&s, begin + j, &w_to);
    k = divide(w_to - w, j);
    w += k;
    c2 = j * (j - 1) / 2;
    c3 = j < 3 ? 0 : c2 * (j - 2) / 3;
    c->v = (uint32_t)(uint64_t)divide(less(less(to - from, times(c2, w)), times(c3, k)), j);
    c->w = (uint32_t)(uint64_t)w;
    c->k = (uint32_t)(uint64_t)k;
    c->left = (uint8_t)(frame - passed + begin + j);
    j = passed - begin;
    c2 = j == 0 ? 0 : j * (j - 1) / 2;
    c3 = j < 3 ? 0 : c2 * (j - 2) / 3;
    p->pose[c->channel] = (int32_t)((uint32_t)(uint64_t)from + j * c->v + c2 * c->w + c3 * c->k);
    c->v += j * c->w + c2 * c->k;
    c->w += j * c->k;
}

void pantin_keys_seek(pantin_player *p, uint32_t frame) {
    uint16_t i;
    for (i = 0; i < p->resume; i++) show(p, &p->moving[i], frame);
    p->frame = frame;
}

void pantin_keys_starts(const pantin_player *p) {
    uint16_t i;
    for (i = 0; i < p->resume; i++) {
        pantin_channel *c = &p->moving[i];
        keys_of keys = keys_of_channel(p, c);
        c->w = (uint32_t)raw_value(keys.scale, value_of(p, &keys, 0));
        c->k = 0;
    }
}

void pantin_keys_step(pantin_player *p) {
    uint16_t i;
    p->frame++;
    for (i = 0; i < p->resume; i++) {
        pantin_channel *c = &p->moving[i];
        if (c->left == (uint8_t)p->frame) {
            show(p, c, p->frame);
            continue;
        }
        p->pose[c->channel] = (int32_t)((uint32_t)p->pose[c->channel] + c->v);
        c->v += c->w;
        c->w += c->k;
    }
}

pantin_result pantin_keys_start(pantin_player *p) {
    const pantin_clip *clip = p->clip;
    reading r;
    uint32_t words, free;
    pantin_result result;
    unsigned i;
    p->moving_count = clip->states;
    if (p->moving_count > p->moving_room) return PANTIN_NO_ROOM;
    memset(&r, 0, sizeof r);
    r.p = p;
    r.range = 0xffffffffu;
    r.looped = clip->looped;
    r.end = clip->looped ? clip->frames : clip->frames - 1;
    r.has_half = clip->looped && (r.end & 1) == 0;
    r.distance = 1;
    for (i = 0; i < 3; i++) r.quantum_of[i] = 6;
    for (i = 0; i < CONTEXTS; i++) r.contexts[i] = 2048u << 4;
    p->reader.position = clip->symbols;
    for (i = 0; i < 4; i++) r.code = r.code << 8 | pantin_keys_byte(&p->reader);
    result = read_channels(&r);
    if (result != PANTIN_OK) return result;
    words = r.words + 3 * r.most_keys;
    free = (clip->states - r.moving) * STATE_WORDS;
    if (words > MAX_WORDS || words > free || words + STATE_WORDS <= free) r.malformed = 1;
    if (!r.malformed) solve_all(&r);
    if (r.malformed) {
        r.moving = 0;
        result = read_channels(&r);
        if (result != PANTIN_OK) return result;
    }
    p->resume = (uint16_t)r.moving;
    p->started = 1;
    clip->source->done = clip->end;
    pantin_keys_seek(p, 0);
    return PANTIN_OK;
}
#else
/* A source file must declare something. */
typedef int pantin_keys_are_off;
#endif
