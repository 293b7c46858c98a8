/* Figures: see pantin_figure.h.
 *
 * The steps and the rounding are those of the crate pantin-figure, so that both draw the same pixels. Sums that damaged clips can make overflow
 * are taken on uint32_t. The right shift of a negative number is taken to round down, as it does with every compiler for small machines. */
#include "pantin_figure_parts.h"
#include "pantin_figure_tables.h"

typedef char right_shift_rounds_down[(-1 >> 1) == -1 ? 1 : -1];

#define FRACTION 15
#define ONE ((int32_t)32768)
#define HALF ((int32_t)16384)
#define NONE 255u
#define NO_FINGER 0xffffu
#define ABSENT 7u
#define DISTANCE 4
#define LARGEST_SCALE ((int32_t)16384)
#define SAMPLES 48u
/* Of a clip with more bytes of motion, the camera is chosen by the first of equal parts that are no larger. */
#define SURVEYED_BYTES 16384u

enum { PLACEMENT = 1, END_SITE = 2, HEAD = 4, KEPT = 8, BEARS = 16, FORKS = 32, PARENT = 64 };

const pantin_view pantin_default_view = {-50, 12, 0, PANTIN_RIG_UP};

/* ---- Numbers ---- */

static int32_t sum(int32_t a, int32_t b) { return (int32_t)((uint32_t)a + (uint32_t)b); }
static int32_t difference(int32_t a, int32_t b) { return (int32_t)((uint32_t)a - (uint32_t)b); }
static int32_t least(int32_t a, int32_t b) { return a < b ? a : b; }
static int32_t most(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t clamp(int32_t x, int32_t low, int32_t high) { return x < low ? low : x > high ? high : x; }
static int16_t narrow(int32_t x) { return (int16_t)clamp(x, -32768L, 32767L); }
static uint32_t size_of(int32_t x) { return x < 0 ? 0u - (uint32_t)x : (uint32_t)x; }

static uint8_t bits_of(uint32_t x) {
    uint8_t bits = 0;
    for (; x; x >>= 1) bits++;
    return bits;
}

static int32_t saturated(int negative) { return negative ? -0x7fffffffL - 1 : 0x7fffffffL; }

static int32_t saturating_sum(int32_t a, int32_t b) {
    int32_t c = sum(a, b);
    return ((a ^ c) & (b ^ c)) < 0 ? saturated(a < 0) : c;
}

static int32_t saturating_difference(int32_t a, int32_t b) {
    int32_t c = difference(a, b);
    return ((a ^ b) & (a ^ c)) < 0 ? saturated(a < 0) : c;
}

/* value / 2^shift, rounded; a negative shift multiplies and saturates. */
static int32_t shift_right(int32_t value, int16_t shift) {
    if (shift >= 32) return 0;
    if (shift > 0) return saturating_sum(value >> (shift - 1), 1) >> 1;
    if (shift == 0 || value == 0) return value;
    if (shift > -32 && 32 - bits_of(size_of(value)) > -shift) return (int32_t)((uint32_t)value << -shift);
    return value < 0 ? -0x7fffffffL : 0x7fffffffL;
}

static uint32_t integer_root(uint32_t square) {
    uint32_t root = 0, bit = 0x8000u;
    for (; bit; bit >>= 1) {
        uint32_t next = root | bit;
        if (next * next <= square) root = next;
    }
    return root;
}

static uint8_t bits_of_largest(const int32_t *v, uint8_t count) {
    uint32_t all = 0;
    while (count-- > 0) all |= size_of(v[count]);
    return bits_of(all);
}

int32_t pantin_figure_length(const int32_t *v) {
    uint8_t shift = bits_of_largest(v, 3), i;
    uint32_t square = 0;
    shift = (uint8_t)(shift > 15 ? shift - 15 : 0);
    for (i = 0; i < 3; i++) square += size_of(v[i] >> shift) * size_of(v[i] >> shift);
    return (int32_t)(integer_root(square) << shift);
}

static int32_t length_of(const int16_t *v) {
    int32_t wide[3];
    uint8_t i;
    for (i = 0; i < 3; i++) wide[i] = v[i];
    return pantin_figure_length(wide);
}

/* The direction of a vector in Q15. Returns 0 for a vector of no length. */
int pantin_figure_direction(int32_t *v) {
    uint8_t bits = bits_of_largest(v, 3), i;
    uint32_t square = 0;
    int32_t length;
    if (bits == 0) return 0;
    for (i = 0; i < 3; i++) {
        v[i] = bits >= 15 ? v[i] >> (bits - 15) : (int32_t)((uint32_t)v[i] << (15 - bits));
        square += size_of(v[i]) * size_of(v[i]);
    }
    length = most((int32_t)integer_root(square), 1);
    for (i = 0; i < 3; i++) v[i] = v[i] * ONE / length;
    return 1;
}

static void cross(const int32_t *a, const int32_t *b, int32_t *to) {
    to[0] = (a[1] * b[2] - a[2] * b[1]) >> 15;
    to[1] = (a[2] * b[0] - a[0] * b[2]) >> 15;
    to[2] = (a[0] * b[1] - a[1] * b[0]) >> 15;
}

/* ---- Rotations ---- */

/* Sine and cosine in Q15 of an angle in 2^-32 turns. */
static void sin_cos(int32_t angle, int32_t *sine, int32_t *cosine) {
    uint32_t nearest = (uint32_t)angle + ((uint32_t)1 << 24);
    uint8_t index = (uint8_t)(nearest >> 25);
    int32_t sin = PANTIN_I32(pantin_circle + 2 * (index & 31)), cos = PANTIN_I32(pantin_circle + 2 * (index & 31) + 1);
    int32_t rest = (int32_t)((nearest >> 9) & 0xffff) - ONE, half_square, swap;
    if (index & 32) {
        swap = sin;
        sin = cos;
        cos = -swap;
    }
    if (index & 64) {
        sin = -sin;
        cos = -cos;
    }
    rest = (rest * 25736) >> 15;
    half_square = (rest * rest) >> 14;
    *sine = (sin + (((cos >> 7) * rest) >> 13) - (((sin >> 7) * half_square) >> 20) + 64) >> 7;
    *cosine = (cos - (((sin >> 7) * rest) >> 13) - (((cos >> 7) * half_square) >> 20) + 64) >> 7;
}

static void turn(int32_t (*r)[3], uint8_t axis, int32_t angle) {
    int32_t sin, cos, *b = r[(axis + 1) % 3], *c = r[(axis + 2) % 3];
    uint8_t i;
    if (angle == 0) return;
    sin_cos(angle, &sin, &cos);
    for (i = 0; i < 3; i++) {
        int32_t from_b = b[i], from_c = c[i];
        b[i] = (from_b * cos + from_c * sin + HALF) >> FRACTION;
        c[i] = (from_c * cos - from_b * sin + HALF) >> FRACTION;
    }
}

/* The image of a vector whose components are within 2^15 and whose length is below 2^16. */
void pantin_figure_apply(int32_t (*r)[3], const int32_t *v, int32_t *to) {
    int32_t x = v[0], y = v[1], z = v[2];
    uint8_t i;
    for (i = 0; i < 3; i++) to[i] = (r[0][i] * x + r[1][i] * y + r[2][i] * z + HALF) >> FRACTION;
}

/* The image of a vector of any length: cut off at 2^29. */
void pantin_figure_apply_any(int32_t (*r)[3], const int32_t *v, int32_t *to) {
    int32_t high[3], low[3];
    uint8_t i, wide = 0;
    for (i = 0; i < 3; i++) {
        wide = (uint8_t)(wide | (v[i] < -16384L || v[i] >= 16384L));
        high[i] = clamp(v[i], -0x20000000L, 0x20000000L) >> FRACTION;
        low[i] = v[i] & 0x7fff;
    }
    if (!wide) {
        pantin_figure_apply(r, v, to);
        return;
    }
    pantin_figure_apply(r, low, low);
    for (i = 0; i < 3; i++) to[i] = r[0][i] * high[0] + r[1][i] * high[1] + r[2][i] * high[2] + low[i];
}

#ifndef PANTIN_EULER_ONLY
/* x times a factor of up to 23 bits, in Q15: in two products. */
static int32_t scaled(int32_t x, int32_t factor) { return (x * (factor >> 7) + ((x * (factor & 0x7f)) >> 7) + HALF) >> FRACTION; }

static int32_t twice(int32_t q30) { return (q30 + 8192) >> 14; }

int32_t pantin_figure_inverse_length(uint32_t square) {
    uint32_t above = square > 0x40000000u ? square - 0x40000000u : 0;
    int16_t index = (int16_t)(above >> 23);
    int32_t from = PANTIN_I32(pantin_inverse_root + index);
    return from + (((PANTIN_I32(pantin_inverse_root + index + 1) - from) * (int32_t)((above >> 8) & 0x7fff)) >> FRACTION);
}

#ifndef __AVR__
/* For solid figures and feet, which an AVR has no room for. */
int32_t pantin_figure_dot(const int32_t *a, const int32_t *b) { return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + HALF) >> FRACTION; }

void pantin_figure_cross(const int32_t *a, const int32_t *b, int32_t *to) {
    uint8_t i;
    for (i = 0; i < 3; i++) {
        uint8_t next = (uint8_t)((i + 1) % 3), last = (uint8_t)((i + 2) % 3);
        to[i] = (a[next] * b[last] - a[last] * b[next] + HALF) >> FRACTION;
    }
}

int pantin_figure_aim_along(int32_t *v, int32_t *length) {
    uint8_t bits = bits_of_largest(v, 3), up = (uint8_t)(bits > 31 ? 0 : 31 - bits), down = 16, i;
    uint32_t square = 0, part;
    int32_t inverse, wide[3];
    if (bits == 0) return 0;
    for (i = 0; i < 3; i++) {
        wide[i] = (int32_t)((uint32_t)v[i] << up);
        v[i] = wide[i] >> down;
        square += (uint32_t)(v[i] * v[i]);
    }
    if (square < 0x40000000u) {
        down = 15;
        square = 0;
        for (i = 0; i < 3; i++) {
            v[i] = wide[i] >> down;
            part = (uint32_t)v[i] * (uint32_t)v[i];
            square = square + part < square ? 0xffffffffu : square + part;
        }
    }
    inverse = pantin_figure_inverse_length(square) >> 7;
    for (i = 0; i < 3; i++) v[i] = (v[i] * inverse + HALF) >> FRACTION;
    *length = ((int32_t)((square >> 16) + (square >> 15 & 1)) * inverse) >> 14;
    if (down < up) {
        *length >>= up - down;
    } else {
        *length = least(*length, (int32_t)0x40000000 >> (down - up)) * ((int32_t)1 << (down - up));
    }
    return 1;
}

int32_t pantin_figure_angle(int32_t y, int32_t x) {
    int32_t across = (int32_t)size_of(y), along = (int32_t)size_of(x), small = least(across, along), large = most(across, along), angle;
    uint8_t index = (uint8_t)(small >> 8 < 93 ? PANTIN_U8(pantin_nearest + (small >> 8)) : 16);
    angle = ((small * (PANTIN_I32(pantin_circle + 2 * index + 1) >> 7) - large * (PANTIN_I32(pantin_circle + 2 * index) >> 7) + HALF) >> FRACTION) * 20861;
    angle += (int32_t)index << 25;
    if (across > along) angle = (int32_t)0x40000000 - angle;
    if (x < 0) angle = (int32_t)(0x80000000u - (uint32_t)angle);
    return y < 0 ? difference(0, angle) : angle;
}
#endif

/* Turns a rotation by a quaternion w, x, y, z of length 1 in Q15. */
static void turn_unit(int32_t (*r)[3], const int32_t *q) {
    int32_t w = q[0], x = q[1], y = q[2], z = q[3], local[3][3];
    uint8_t i;
    local[0][0] = ONE - twice(y * y + z * z);
    local[0][1] = twice(x * y + w * z);
    local[0][2] = twice(x * z - w * y);
    local[1][0] = twice(x * y - w * z);
    local[1][1] = ONE - twice(x * x + z * z);
    local[1][2] = twice(y * z + w * x);
    local[2][0] = twice(x * z + w * y);
    local[2][1] = twice(y * z - w * x);
    local[2][2] = ONE - twice(x * x + y * y);
    for (i = 0; i < 3; i++) pantin_figure_apply(r, local[i], local[i]);
    memcpy(r, local, sizeof local);
}

static void turn_exponential(int32_t (*r)[3], const int32_t *map) {
    uint32_t square = 0;
    int32_t q[4], place, from, scale;
    uint8_t i, index;
    for (i = 0; i < 3; i++) {
        int32_t high = map[i] >> 16, low = (map[i] >> 4) & 0xfff, part = high * high + ((high * low) >> 11);
        square = part < 0 && square < size_of(part) ? 0 : square + (uint32_t)part;
    }
    index = (uint8_t)(square >> 24);
    place = (int32_t)((square >> 12) & 0xfff);
    if (index > 192) return;
    from = PANTIN_I32(pantin_half_angle + 2 * index);
    q[0] = shift_right(from + (((PANTIN_I32(pantin_half_angle + 2 * index + 2) - from) * place) >> 12), 7);
    from = PANTIN_I32(pantin_half_angle + 2 * index + 1);
    scale = from + (((PANTIN_I32(pantin_half_angle + 2 * index + 3) - from) * place) >> 12);
    for (i = 0; i < 3; i++) q[i + 1] = scaled(shift_right(map[i], 15), scale);
    turn_unit(r, q);
}

static uint32_t square_of(const int32_t *q, int16_t shift) {
    uint32_t total = 0;
    uint8_t i;
    for (i = 0; i < 4; i++) {
        uint32_t x = size_of(shift_right(q[i], shift)), square = x > 0xffff ? 0xffffffffu : x * x;
        total = total + square < total ? 0xffffffffu : total + square;
    }
    return total;
}

static void turn_quaternion(int32_t (*r)[3], int32_t *q) {
    uint8_t bits = bits_of_largest(q, 4), i;
    int16_t shift = (int16_t)(bits - 15);
    uint32_t square;
    int32_t inverse;
    if (bits == 0) return;
    square = square_of(q, shift);
    if (square < 0x40000000u) square = square_of(q, --shift);
    inverse = pantin_figure_inverse_length(square);
    for (i = 0; i < 4; i++) q[i] = scaled(shift_right(q[i], shift), inverse);
    turn_unit(r, q);
}
#endif

/* ---- Names ---- */

static uint8_t lower(const pantin_name *name, uint32_t i) {
    uint8_t c = pantin_name_byte(name, i);
    return (uint8_t)(c >= 'A' && c <= 'Z' ? c + 32 : c);
}

uint8_t pantin_figure_names(const pantin_name *name, const char *words) {
    for (;;) {
        uint32_t i;
        uint8_t j;
        for (i = 0; i < name->length; i++) {
            for (j = 0; words[j] && words[j] != '|' && lower(name, i + j) == (uint8_t)words[j]; j++) {}
            if (!words[j] || words[j] == '|') return 1;
        }
        while (*words && *words != '|') words++;
        if (!*words++) return 0;
    }
}

/* Length of the word for a side with which a name goes on at `start`, or 0. */
static uint8_t side_at(const pantin_name *name, uint32_t start, uint8_t *left) {
    uint8_t side, i;
    const char *word;
    for (side = 0; side < 2; side++) {
        word = side ? "right" : "left";
        for (i = 0; word[i] && lower(name, start + i) == (uint8_t)word[i]; i++) {}
        if (!word[i]) {
            *left = !side;
            return i;
        }
    }
    i = lower(name, start);
    *left = i == 'l';
    return i == 'l' || i == 'r';
}

/* Of two names that differ in "left" and "right" or "l" and "r" alone: 1 if `a` is the left one, 0 if `b` is. Otherwise -1. */
static int8_t left_of(const pantin_name *a, const pantin_name *b) {
    uint32_t i = 0, j;
    uint8_t left, other_left, word, other_word;
    while (i < a->length && i < b->length && lower(a, i) == lower(b, i)) i++;
    word = side_at(a, i, &left);
    other_word = side_at(b, i, &other_left);
    if (!word || !other_word || left == other_left || a->length - word != b->length - other_word) return -1;
    for (j = i + other_word, i += word; i < a->length; i++, j++) {
        if (lower(a, i) != lower(b, j)) return -1;
    }
    return (int8_t)left;
}

/* ---- Joints of the rig, while the figure is set up ---- */

typedef struct {
    pantin_joint_info *of;
    uint8_t count;
    uint8_t hips; /* the last joint that only places the figure */
    int16_t exponent;
    int32_t size;
} table;

static pantin_joint_info *info_at(const table *t, uint8_t index) { return index < t->count ? &t->of[index] : NULL; }

static void set(pantin_joint_info *info, uint8_t flag, int on) {
    info->flags = (uint8_t)(on ? info->flags | flag : info->flags & ~flag);
}

/* Raw components of a joint's bone. Bit i of the result: component i comes from a position channel. */
static uint8_t raw_bone(const pantin_joint *joint, const int32_t *pose, int32_t *bone) {
    uint8_t c, moved = 0;
    memcpy(bone, joint->offset, sizeof joint->offset);
    for (c = 0; c < joint->channels; c++) {
        uint8_t kind = pantin_joint_kind(joint, c);
        if (kind < PANTIN_EULER_X) {
            bone[kind] = pose[joint->first_channel + c];
            moved = (uint8_t)(moved | 1 << kind);
        }
    }
    return moved;
}

/* Moves to the next joint unless something could not be read: set-up reports that at its end. */
static int next_joint(pantin_joint *joint) { return joint->rig->source->error == PANTIN_OK && pantin_next_joint(joint); }

/* 1 if the only child of the root places the figure too: three positions in place of an offset. */
static uint8_t placement_end(const pantin_rig *rig) {
    pantin_joint joint;
    uint16_t children = 0;
    uint8_t placed = 0, c;
    pantin_first_joint(&joint, rig);
    while (next_joint(&joint)) {
        children = (uint16_t)(children + (joint.parent == 0 && !joint.helper));
        if (joint.index == 1) {
            uint8_t positions = 0;
            for (c = 0; c < joint.channels; c++) positions = (uint8_t)(positions + (pantin_joint_kind(&joint, c) < PANTIN_EULER_X));
            placed = positions == 3 && joint.offset[0] == 0 && joint.offset[1] == 0 && joint.offset[2] == 0;
        }
    }
    return (uint8_t)(children == 1 && placed);
}

/* Drops what hangs on a joint that is dropped, then measures the chains of bones and the figure. */
static void measure(table *t) {
    uint8_t i;
    pantin_joint_info *info, *parent;
    int32_t reach;
    for (i = 0; i < t->count; i++) {
        parent = info_at(t, t->of[i].parent);
        if (parent && !(parent->flags & KEPT)) {
            t->of[i].length = 0;
            set(&t->of[i], KEPT, 0);
        }
    }
    for (i = t->count; i-- > 0;) {
        info = &t->of[i];
        parent = info_at(t, info->parent);
        if (parent) {
            uint16_t chain = (uint16_t)least((int32_t)info->reach + info->length / 8, 0xffff);
            set(parent, FORKS, parent->flags & PARENT);
            set(parent, PARENT, 1);
            if (chain >= parent->reach) {
                parent->reach = chain;
                parent->link = i;
            }
        }
    }
    t->size = 16384;
    info = info_at(t, t->hips);
    reach = info ? (int32_t)info->reach * 8 : 0;
    if (reach > 0) t->size = reach + reach / 4;
}

static void read_table(table *t, const pantin_rig *rig, const int32_t *pose, int8_t position_exponent) {
    pantin_joint joint;
    int32_t bone[3];
    int16_t longest = -1000;
    uint8_t moved, i, has_head = 0;
    t->hips = placement_end(rig);
    pantin_first_joint(&joint, rig);
    while (next_joint(&joint)) {
        if (joint.index <= t->hips) continue;
        moved = raw_bone(&joint, pose, bone);
        for (i = 0; i < 3; i++) {
            int16_t bits = (int16_t)((moved >> i & 1 ? position_exponent : rig->offset_exponent) + bits_of(size_of(bone[i])));
            if (bone[i] != 0 && bits > longest) longest = bits;
        }
    }
    t->exponent = (int16_t)((longest == -1000 ? 0 : longest) - 14);
    pantin_first_joint(&joint, rig);
    while (next_joint(&joint)) {
        pantin_joint_info *info = &t->of[joint.index];
        uint8_t head = (uint8_t)(!has_head && pantin_figure_names(&joint.name, "head|kopf"));
        has_head |= head;
        memset(info, 0, sizeof *info);
        info->finger = NO_FINGER;
        info->link = NONE;
        info->parent = (uint8_t)(joint.parent == PANTIN_NO_PARENT ? NONE : joint.parent);
        if (joint.index > t->hips && !joint.helper) {
            moved = raw_bone(&joint, pose, bone);
            for (i = 0; i < 3; i++) {
                int16_t exponent = moved >> i & 1 ? position_exponent : rig->offset_exponent;
                info->bone[i] = (int16_t)shift_right(bone[i], (int16_t)(t->exponent - exponent));
            }
            info->length = (uint16_t)length_of(info->bone);
        }
        info->flags = (uint8_t)((joint.helper ? 0 : KEPT) | (joint.index <= t->hips ? PLACEMENT : 0) | (joint.end_site ? END_SITE : 0) |
                                (head ? HEAD : 0));
    }
    measure(t);
}

/* Drops what would only be a blot on a small display: fingers but the longest, what is in the head, ends of limbs too short to see. */
static void prune(table *t) {
    int32_t eighths = t->size / 8, shortest = t->size / 64;
    uint8_t i;
    for (i = 0; i < t->count; i++) {
        pantin_joint_info *info = &t->of[i], *parent = info_at(t, info->parent);
        uint16_t finger;
        uint8_t hand, longest, is_short, shows;
        if (!parent) continue;
        hand = (parent->flags & FORKS) && parent->reach < eighths / 6;
        finger = hand ? 0 : parent->finger;
        longest = parent->link == i;
        is_short = parent->finger == NO_FINGER || parent->finger < eighths / 25;
        shows = finger == NO_FINGER || (longest && is_short);
        set(info, KEPT, (info->flags & KEPT) && (parent->flags & KEPT) && !(parent->flags & HEAD) && shows);
        info->finger = finger == NO_FINGER ? (uint16_t)NO_FINGER : (uint16_t)least((int32_t)finger + info->length / 8, NO_FINGER - 1);
    }
    for (i = t->count; i-- > 0;) {
        pantin_joint_info *info = &t->of[i], *parent = info_at(t, info->parent);
        uint8_t kept = (info->flags & KEPT) && ((info->flags & (PLACEMENT | HEAD | BEARS)) || info->length >= shortest);
        set(info, KEPT, kept);
        info->weight = (uint8_t)least(info->weight + kept, 255);
        if (parent) {
            if (kept) set(parent, BEARS, 1);
            parent->weight = (uint8_t)least((int32_t)parent->weight + info->weight, 255);
        }
    }
}

/* The kept child of a joint that comes after `done`, its child too, or the first: the one with fewer joints on it comes first. */
static uint8_t lightest(const table *t, uint8_t parent, uint8_t done) {
    uint8_t i, best = NONE;
    for (i = 0; i < t->count; i++) {
        const pantin_joint_info *info = &t->of[i];
        if (info->parent != parent || !(info->flags & KEPT)) continue;
        if (done != NONE && (info->weight < t->of[done].weight || (info->weight == t->of[done].weight && i <= done))) continue;
        if (best == NONE || info->weight < t->of[best].weight) best = i;
    }
    return best;
}

/* The kept joint after `index` (NONE: the first) in an order in which few rotations wait for their joints. NONE if there is none. */
static uint8_t after(const table *t, uint8_t index) {
    uint8_t done = NONE;
    for (;;) {
        uint8_t child = lightest(t, index, done);
        if (child != NONE) return child;
        if (index >= t->count) return NONE;
        done = index;
        index = t->of[index].parent;
    }
}

/* ---- The figure ---- */

void pantin_figure_memory(pantin_figure *f, pantin_bone *bones, size_t bone_room, pantin_drive *drives, size_t drive_room, pantin_slot *slots,
                          size_t slot_room) {
    memset(f, 0, sizeof *f);
    f->bones = bones;
    f->drives = drives;
    f->slots = slots;
    f->bone_room = (uint16_t)(bone_room > PANTIN_MAX_BONES ? PANTIN_MAX_BONES : bone_room);
    f->drive_room = (uint16_t)(drive_room > PANTIN_MAX_CHANNELS ? PANTIN_MAX_CHANNELS : drive_room);
    f->slot_room = (uint16_t)(slot_room > PANTIN_FIGURE_SLOTS ? PANTIN_FIGURE_SLOTS : slot_room);
}

/* What the first channels of `count` kinds from `first` do together; with `first` PANTIN_EULER_X and `in_turn`, Euler channels in their order. */
static pantin_result group(const pantin_joint *joint, uint8_t act, uint8_t first, uint8_t count, uint8_t in_turn, pantin_drive *drive) {
    uint8_t members[4], c, i = 0, low = NONE;
    memset(members, NONE, sizeof members);
    for (c = 0; c < joint->channels; c++) {
        uint8_t kind = pantin_joint_kind(joint, c), member = (uint8_t)(kind - first);
        if (in_turn) member = member < 3 ? i++ : (uint8_t)NONE;
        if (member < count && members[member] == NONE) {
            members[member] = c;
            if (c < low) low = c;
        }
    }
    if (low == NONE) low = 0;
    drive->first = (uint16_t)(joint->first_channel + low);
    drive->what = act;
    for (i = 0; i < count; i++) {
        uint8_t behind = members[i] == NONE ? ABSENT : (uint8_t)(members[i] - low);
        if (members[i] != NONE && behind >= ABSENT) return PANTIN_ERROR_RIG;
        drive->what = (uint16_t)(drive->what | behind << (3 + 3 * i));
    }
    return PANTIN_OK;
}

static pantin_result push_drive(pantin_figure *f, const pantin_drive *drive, uint8_t *count) {
    if (f->drive_count >= f->drive_room) return PANTIN_NO_ROOM;
    f->drives[f->drive_count++] = *drive;
    ++*count;
    return PANTIN_OK;
}

/* Adds what drives a joint. What turns one that nothing hangs on is left out. What works as a group turns after all Euler angles: the map in their place,
   the quaternion, the joint's own map (FORMAT.md 11). */
static pantin_result add_drives(pantin_figure *f, const pantin_joint *joint, uint8_t turns, uint8_t exponential, uint8_t *count) {
#ifndef PANTIN_EULER_ONLY
    /* First kind, number of kinds and act of each group. */
    static const uint8_t GROUPS[3][3] = {{PANTIN_EULER_X, 3, PANTIN_DRIVE_MAP}, {PANTIN_QUATERNION_W, 4, PANTIN_DRIVE_UNIT}, {PANTIN_EXPONENTIAL_X, 3, PANTIN_DRIVE_MAP}};
#endif
    uint8_t c, i, moved = 0, groups = 0;
    pantin_drive drive;
    pantin_result result;
    *count = 0;
    for (c = 0; c < joint->channels; c++) {
        uint8_t kind = pantin_joint_kind(joint, c);
        result = PANTIN_OK;
        if (kind < PANTIN_EULER_X) {
            if (moved) continue;
            moved = 1;
            result = group(joint, PANTIN_DRIVE_PLACE, PANTIN_POSITION_X, 3, 0, &drive);
        } else if (kind < PANTIN_QUATERNION_W && !exponential && turns) {
            drive.first = (uint16_t)(joint->first_channel + c);
            drive.what = (uint16_t)(kind - PANTIN_EULER_X);
        } else {
            groups |= (uint8_t)(kind < PANTIN_QUATERNION_W ? 1 : kind < PANTIN_EXPONENTIAL_X ? 2 : 4);
            continue;
        }
        if (result == PANTIN_OK) result = push_drive(f, &drive, count);
        if (result != PANTIN_OK) return result;
    }
    for (i = 0; turns && i < 3; i++) {
        if (!(groups >> i & 1)) continue;
#ifdef PANTIN_EULER_ONLY
        return PANTIN_ERROR_RIG;
#else
        result = group(joint, GROUPS[i][2], GROUPS[i][0], GROUPS[i][1], (uint8_t)(i == 0), &drive);
        if (result == PANTIN_OK) result = push_drive(f, &drive, count);
        if (result != PANTIN_OK) return result;
#endif
    }
    return PANTIN_OK;
}

static pantin_bone *push(pantin_figure *f) {
    pantin_bone *bone = NULL;
    if (f->bone_count < f->bone_room) {
        bone = &f->bones[f->bone_count++];
        memset(bone, 0, sizeof *bone);
        bone->slot = bone->parent_slot = NONE;
        bone->part = PANTIN_MIDDLE;
    }
    return bone;
}

/* The crown in the head's own frame: its End Site, or else a tenth of the figure in the direction of the bone that leads to the head. */
static void crown_offset(const table *t, uint8_t head, int16_t *offset) {
    const pantin_joint_info *info = &t->of[head];
    int32_t tenth = t->size / 10;
    uint8_t i;
    for (i = 0; i < t->count; i++) {
        const pantin_joint_info *end = &t->of[i];
        if ((end->flags & END_SITE) && end->parent == head && end->length > tenth / 3) {
            memcpy(offset, end->bone, sizeof end->bone);
            return;
        }
    }
    for (i = 0; i < 3; i++) offset[i] = (int16_t)((int32_t)info->bone[i] * 64 / most(info->length / 64, 1) * (tenth / 64) / 64);
}

static pantin_result add_joint(pantin_figure *f, const pantin_clip *clip, const pantin_joint *joint, table *t) {
    uint8_t index = (uint8_t)joint->index, drives, c, at;
    pantin_joint_info *info = &t->of[index], *parent = info_at(t, info->parent);
    uint8_t head = info->flags & HEAD, placement = info->flags & PLACEMENT;
    pantin_bone *bone;
    pantin_result result = add_drives(f, joint, head || (info->flags & BEARS), (uint8_t)pantin_joint_is_exponential(clip, joint), &drives);
    if (result != PANTIN_OK) return result;
    at = (uint8_t)f->bone_count;
    bone = push(f);
    if (!bone) return PANTIN_NO_ROOM;
    if (placement && index < 2) {
        for (c = 0; c < 3; c++) f->places[index][c] = shift_right(joint->offset[c], (int16_t)(t->exponent - clip->rig.offset_exponent));
    }
    memcpy(bone->offset, info->bone, sizeof info->bone);
    bone->parent = parent ? parent->link : (uint8_t)NONE;
    bone->joint = index;
    bone->kind = placement || info->length == 0 ? PANTIN_HIDDEN : PANTIN_BONE;
    bone->drives = drives;
    for (c = 0; c < joint->channels; c++) bone->moves |= pantin_joint_kind(joint, c) < PANTIN_EULER_X;
    info->link = at;
    if (head) {
        f->crown = (uint8_t)f->bone_count;
        bone = push(f);
        if (!bone) return PANTIN_NO_ROOM;
        crown_offset(t, index, bone->offset);
        bone->parent = at;
        bone->joint = index;
        bone->kind = PANTIN_CROWN;
        f->head_radius = least(most(length_of(bone->offset) / 2, t->size / 22), t->size / 14);
    }
    return PANTIN_OK;
}

int pantin_figure_go_to(pantin_joint *joint, const pantin_rig *rig, uint8_t index) {
    if (joint->index == 0xffff || joint->index > index) pantin_first_joint(joint, rig);
    while (joint->index != index) {
        if (!next_joint(joint)) return 0;
    }
    return 1;
}

/* Finds the side of each bone by joints whose names are counterparts. Across the first pair whose bones differ the figure faces forward. */
static void find_sides(pantin_figure *f, const pantin_rig *rig, const table *t) {
    pantin_joint own, other;
    uint16_t best = 0xffff;
    uint8_t i;
    f->sides[0] = f->sides[1] = NONE;
    pantin_first_joint(&own, rig);
    for (i = 0; i < f->bone_count; i++) {
        pantin_bone *bone = &f->bones[i];
        int8_t left = -1;
        if (bone->parent != NONE) bone->part = f->bones[bone->parent].part;
        if (!pantin_figure_go_to(&own, rig, bone->joint)) return;
        pantin_first_joint(&other, rig);
        while (left < 0 && next_joint(&other)) {
            if (other.index != own.index && (t->of[other.index].flags & KEPT)) left = left_of(&own.name, &other.name);
        }
        if (left >= 0) {
            const pantin_joint_info *mine = &t->of[own.index], *theirs = &t->of[other.index];
            uint16_t pair = (uint16_t)(least(own.index, other.index) << 8 | most(own.index, other.index));
            bone->part = left ? PANTIN_LEFT : PANTIN_RIGHT;
            if (pair < best && (mine->bone[0] != theirs->bone[0] || mine->bone[1] != theirs->bone[1] || mine->bone[2] != theirs->bone[2])) {
                best = pair;
                f->sides[0] = left ? mine->link : theirs->link;
                f->sides[1] = left ? theirs->link : mine->link;
            }
        }
    }
}

/* Gives every joint that others hang on a slot until the last of those has been placed. */
static pantin_result share_slots(pantin_figure *f) {
    uint16_t used = 0;
    uint8_t i, j;
    for (i = 0; i < f->bone_count; i++) {
        pantin_bone *bone = &f->bones[i];
        uint8_t last = bone->parent != NONE, bears = 0;
        if (bone->parent != NONE) bone->parent_slot = f->bones[bone->parent].slot;
        for (j = (uint8_t)(i + 1); j < f->bone_count; j++) {
            if (f->bones[j].parent == bone->parent) last = 0;
            if (f->bones[j].parent == i) bears = 1;
        }
        if (last && bone->parent_slot != NONE) used = (uint16_t)(used & ~(1u << bone->parent_slot));
        if (!bears) continue;
        bone->slot = 0;
        while (used >> bone->slot & 1) bone->slot++;
        if (bone->slot >= f->slot_room) return PANTIN_NO_ROOM;
        used = (uint16_t)(used | 1u << bone->slot);
        if (bone->slot >= f->slot_count) f->slot_count = (uint16_t)(bone->slot + 1u);
    }
    return PANTIN_OK;
}

static pantin_result build(pantin_figure *f, const pantin_clip *clip, const int32_t *pose, table *t) {
    pantin_joint joint;
    pantin_result result;
    uint8_t index = NONE;
    read_table(t, &clip->rig, pose, clip->exponent);
    prune(t);
    f->bone_count = f->drive_count = f->slot_count = f->line_count = 0;
    f->position_shift = (int16_t)(t->exponent - clip->exponent);
    f->exponent = t->exponent;
    f->size = t->size;
    f->head_radius = 0;
    f->crown = NONE;
    f->up = clip->rig.up;
    pantin_first_joint(&joint, &clip->rig);
    while ((index = after(t, index)) != NONE) {
        if (!pantin_figure_go_to(&joint, &clip->rig, index)) return PANTIN_ERROR_READ;
        result = add_joint(f, clip, &joint, t);
        if (result != PANTIN_OK) return result;
    }
    f->hips = t->count > t->hips ? t->of[t->hips].link : 0;
    find_sides(f, &clip->rig, t);
    for (index = 0; index < f->bone_count; index++) {
        if (f->bones[index].kind == PANTIN_BONE && f->bones[index].parent != NONE) f->bones[f->line_count++].order = index;
    }
    return share_slots(f);
}

pantin_result pantin_figure_set_up(pantin_figure *f, pantin_player *player, uint16_t width, uint16_t height, pantin_joint_info *scratch,
                                   size_t scratch_room) {
    const pantin_clip *clip = player->clip;
    pantin_source *source = clip->rig.source;
    pantin_result result = pantin_restart(player), restarted;
    table t;
    if (result != PANTIN_OK) return result;
    if (width == 0 || height == 0 || width > 2047 || height > 2047) return PANTIN_NOT_FOUND;
    if (clip->rig.joints > scratch_room || clip->rig.joints > 255) return PANTIN_NO_ROOM;
    t.of = scratch;
    t.count = (uint8_t)clip->rig.joints;
    f->width = width;
    f->height = height;
    f->offset[0] = f->offset[1] = 0;
    source->error = PANTIN_OK;
    result = build(f, clip, player->pose, &t);
    if (source->error != PANTIN_OK) result = source->error;
    /* The scratch memory may have been the moving channels'. */
    restarted = pantin_restart(player);
    return result != PANTIN_OK ? result : restarted;
}

/* ---- Kinematics ---- */

static void own_offset(const pantin_figure *f, uint8_t index, const pantin_drive *drives, const int32_t *pose, int32_t *offset) {
    const pantin_bone *bone = &f->bones[index];
    uint8_t d, i;
    for (i = 0; i < 3; i++) offset[i] = index < 2 && index <= f->hips && bone->kind == PANTIN_HIDDEN ? f->places[index][i] : bone->offset[i];
    for (d = 0; d < bone->drives; d++) {
        uint16_t what = drives[d].what;
        if ((what & 7) != PANTIN_DRIVE_PLACE) continue;
        for (i = 0; i < 3; i++) {
            uint8_t behind = what >> (3 + 3 * i) & 7;
            if (behind != ABSENT) offset[i] = shift_right(pose[drives[d].first + behind], f->position_shift);
        }
    }
}

void pantin_figure_rotate(int32_t (*r)[3], const pantin_bone *bone, const pantin_drive *drives, const int32_t *pose) {
    uint8_t d;
    for (d = 0; d < bone->drives; d++) {
        const int32_t *from = pose + drives[d].first;
        uint8_t act = drives[d].what & 7;
        if (act < PANTIN_DRIVE_PLACE) {
            turn(r, act, *from);
#ifndef PANTIN_EULER_ONLY
        } else if (act != PANTIN_DRIVE_PLACE) {
            int32_t members[4];
            uint8_t i;
            for (i = 0; i < 4; i++) {
                uint8_t behind = drives[d].what >> (3 + 3 * i) & 7;
                members[i] = behind == ABSENT || (act == PANTIN_DRIVE_MAP && i == 3) ? 0 : from[behind];
            }
            if (act == PANTIN_DRIVE_MAP) {
                turn_exponential(r, members);
            } else {
                turn_quaternion(r, members);
            }
#endif
        }
    }
}

/* Places the first `count` joints about `origin`, turned by `view`. */
void pantin_figure_place(const pantin_figure *f, const int32_t *pose, int32_t (*view)[3], const int32_t *origin, uint16_t count,
                         pantin_figure_visit each, void *context) {
    const pantin_drive *drives = f->drives;
    uint8_t index, i;
    for (index = 0; index < f->bone_count && index < count; index++) {
        const pantin_bone *bone = &f->bones[index];
        pantin_slot *above = bone->parent_slot == NONE ? NULL : &f->slots[bone->parent_slot];
        int32_t (*turned)[3] = above ? above->rotation : view;
        int32_t position[3], offset[3];
        if (above && !bone->moves) {
            for (i = 0; i < 3; i++) offset[i] = bone->offset[i];
            pantin_figure_apply(turned, offset, position);
        } else {
            own_offset(f, index, drives, pose, offset);
            for (i = 0; i < 3 && !above; i++) offset[i] = difference(offset[i], origin[i]);
            pantin_figure_apply_any(turned, offset, position);
        }
        for (i = 0; i < 3 && above; i++) position[i] = sum(position[i], above->position[i]);
        each(context, index, position);
        if (bone->slot != NONE && index + 1u < count) {
            pantin_slot *own = &f->slots[bone->slot];
            if (own != above) memcpy(own->rotation, turned, sizeof own->rotation);
            memcpy(own->position, position, sizeof position);
            pantin_figure_rotate(own->rotation, bone, drives, pose);
        }
        drives += bone->drives;
    }
}

void pantin_figure_world(int32_t (*view)[3]) {
    memset(view, 0, 3 * sizeof *view);
    view[0][0] = view[1][1] = view[2][2] = ONE;
}

static void keep_last(void *context, uint8_t index, const int32_t *position) {
    (void)index;
    memcpy(context, position, 3 * sizeof *position);
}

void pantin_figure_hips(const pantin_figure *f, const int32_t *pose, int32_t *hips) {
    int32_t view[3][3];
    memset(hips, 0, 3 * sizeof *hips);
    if (f->hips == 0 && f->bone_count > 0) {
        own_offset(f, 0, f->drives, pose, hips);
    } else if (f->hips < f->bone_count) {
        int32_t origin[3] = {0, 0, 0};
        pantin_figure_world(view);
        pantin_figure_place(f, pose, view, origin, (uint16_t)(f->hips + 1u), keep_last, hips);
    }
}

/* ---- Camera ---- */

int32_t pantin_figure_magnification(int32_t depth) {
    int32_t distance = clamp(depth + 16384, 0, 32767);
    uint8_t index = (uint8_t)(distance >> 8);
    return (int32_t)PANTIN_U16(pantin_magnification + 2 * index) +
           (((int32_t)(int16_t)PANTIN_U16(pantin_magnification + 2 * index + 1) * (distance & 0xff)) >> 8);
}

/* A place in the camera's axes on the display. Returns its depth. */
int32_t pantin_figure_project(const pantin_figure *f, const int32_t *place, int32_t *to) {
    int32_t depth = ((int32_t)narrow(place[2] >> f->shift) * f->depth_factor) >> f->depth_shift, factor = pantin_figure_magnification(depth);
    uint8_t i;
    for (i = 0; i < 2; i++) to[i] = (((int32_t)narrow(place[i] >> f->shift) * factor) >> f->spare) + f->centre[i];
    return depth;
}

static int32_t project(const pantin_figure *f, const int32_t *place, int16_t *to) {
    int32_t wide[2], depth = pantin_figure_project(f, place, wide);
    to[0] = narrow(wide[0]);
    to[1] = narrow(wide[1]);
    return depth;
}

void pantin_figure_see(void *context, uint8_t index, const int32_t *position) {
    pantin_figure *f = (pantin_figure *)context;
    pantin_bone *bone = &f->bones[index];
    bone->depth = narrow(project(f, position, bone->place));
}

void pantin_figure_follow(pantin_figure *f) {
    uint8_t axis;
    for (axis = 0; axis < 3; axis++) {
        if (f->fixed_axes >> axis & 1) f->target[axis] = f->fixed[axis];
    }
}

void pantin_figure_values(pantin_figure *f, const int32_t *pose, pantin_figure_visit each, void *context) {
    pantin_figure_hips(f, pose, f->target);
    pantin_figure_follow(f);
    pantin_figure_place(f, pose, f->view, f->target, PANTIN_MAX_BONES + 1, each, context);
}

/* What a clip asks of the camera: the least and greatest coordinates, and the sum of left minus right. */
typedef struct {
    const pantin_figure *figure;
    int32_t low[3], high[3], leftward[3], left[3];
} bounds;

static void include(void *context, uint8_t index, const int32_t *position) {
    bounds *b = (bounds *)context;
    const pantin_figure *f = b->figure;
    uint8_t i;
    for (i = 0; i < 3 && index >= f->hips; i++) {
        b->low[i] = least(b->low[i], position[i]);
        b->high[i] = most(b->high[i], position[i]);
    }
    /* Left minus right, whichever comes first. */
    if (index == f->sides[0] || index == f->sides[1]) {
        uint8_t other = f->sides[index == f->sides[0]];
        for (i = 0; i < 3; i++) {
            if (index < other) {
                b->left[i] = position[i];
            } else {
                int32_t left = index == f->sides[0] ? position[i] : b->left[i], right = index == f->sides[0] ? b->left[i] : position[i];
                b->leftward[i] = saturating_sum(b->leftward[i], saturating_difference(left, right) >> 6);
            }
        }
    }
}

static int32_t half_extent(const bounds *b, uint8_t axis) { return saturating_difference(b->high[axis] >> 1, b->low[axis] >> 1); }

/* Right, down and away for a view. */
static void axes(int32_t (*rows)[3], const int32_t *up, const int32_t *facing, const pantin_view *view) {
    int32_t sin, cos, left[3], level[3];
    uint8_t i;
    sin_cos((int32_t)((uint32_t)(int32_t)view->orbit * 11930465u), &sin, &cos);
    cross(up, facing, left);
    for (i = 0; i < 3; i++) level[i] = (cos * facing[i] + sin * left[i] + HALF) >> FRACTION;
    sin_cos((int32_t)((uint32_t)(int32_t)view->tilt * 11930465u), &sin, &cos);
    cross(up, level, rows[0]);
    for (i = 0; i < 3; i++) {
        rows[1][i] = (sin * level[i] - cos * up[i] + HALF) >> FRACTION;
        rows[2][i] = (-cos * level[i] - sin * up[i] + HALF) >> FRACTION;
    }
}

/* A camera for what `b` saw, with a size of `scale` sixteenths of a pixel and the target in the top left corner. */
static void set_camera(pantin_figure *f, const bounds *b, const int32_t *up, const int32_t *facing, const pantin_view *view, int32_t scale) {
    int32_t rows[3][3], size = f->size, shorter, factor;
    int16_t fine;
    uint8_t i, j, cut, room = 0, depth_bits = 0;
    f->fixed_axes = 0;
    for (i = 0; i < 3; i++) {
        f->fixed[i] = sum(b->low[i] >> 1, b->high[i] >> 1);
        if (view->fixed) size = most(size, half_extent(b, i));
    }
    if (view->fixed) {
        f->fixed_axes = 7;
    } else if (half_extent(b, f->ground_axis) <= f->size) {
        f->fixed_axes = (uint8_t)(1 << f->ground_axis);
    }
    cut = bits_of((uint32_t)size);
    cut = (uint8_t)(cut > 13 ? cut - 13 : 0);
    shorter = most(size >> cut, 1);
    while ((scale << (room + 1)) / shorter <= 37000 && room < 16) room++;
    factor = (scale << room) / shorter;
    fine = (int16_t)(room + cut - FRACTION);
    axes(rows, up, facing, view);
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 3; j++) f->view[j][i] = (rows[i][j] * factor + HALF) >> FRACTION;
    }
    f->shift = (uint8_t)(fine > 2 ? fine - 2 : 0);
    fine = (int16_t)(fine - f->shift);
    f->spare = (uint8_t)(14 + fine);
    while (((int32_t)1 << (depth_bits + 1)) / (DISTANCE * scale) < ONE && depth_bits < 29) depth_bits++;
    f->depth_factor = ((int32_t)1 << depth_bits) / (DISTANCE * scale);
    f->depth_shift = (uint8_t)most(depth_bits - 15 + fine, 0);
    f->centre[0] = f->centre[1] = 0;
    f->scale = scale;
    f->camera_size = size;
}

void pantin_figure_widen(pantin_extent *e, const int16_t *place, int16_t radius) {
    int32_t x = place[0], y = place[1];
    e->side = most(e->side, (x < 0 ? -x : x) + radius);
    e->top = least(e->top, y - radius);
    e->bottom = most(e->bottom, y + radius);
}

static int32_t fit(uint16_t pixels, int32_t covered, int32_t trial) { return (((int32_t)pixels * 9 / 10) << 4) * 64 / most(covered / (trial / 64), 1); }

/* Which way is up and where the figure faces, in Q15 of the world's axes. */
static void orient(pantin_figure *f, bounds *b, uint8_t rig_up, int32_t *up, int32_t *facing) {
    uint8_t axis = (uint8_t)((rig_up & 3) % 3), i;
    for (i = 0; i < 3; i++) up[i] = facing[i] = 0;
    up[axis] = rig_up & 4 ? -ONE : ONE;
    b->leftward[axis] = 0;
    if (pantin_figure_direction(b->leftward)) {
        cross(b->leftward, up, facing);
    } else if (axis == 2) {
        facing[1] = -ONE;
    } else {
        facing[2] = ONE;
    }
    f->ground_axis = axis;
    f->ground_height = rig_up & 4 ? b->high[axis] : b->low[axis];
}

/* Moves to the next of the frames by which the camera is chosen. */
static int next_sample(pantin_player *player, uint32_t *frame, pantin_result *result) {
    uint32_t parts = (player->clip->end - player->clip->start + SURVEYED_BYTES - 1) / SURVEYED_BYTES;
    uint32_t frames = player->clip->frames / parts + (player->clip->frames % parts != 0), stride = (frames + SAMPLES - 1) / SAMPLES;
    if (*result != PANTIN_OK || *frame >= frames) return 0;
    *result = pantin_seek(player, *frame);
    *frame += stride;
    return *result == PANTIN_OK;
}

void pantin_figure_cover_head(const void *context, const pantin_figure *f, pantin_extent *e) {
    pantin_head head;
    (void)context;
    if (pantin_figure_head(f, &head)) pantin_figure_widen(e, head.centre, head.radius);
}

pantin_result pantin_figure_aim(pantin_figure *f, pantin_player *player, const pantin_view *view) {
    return pantin_figure_aim_for(f, player, view, pantin_figure_cover_head, NULL);
}

pantin_result pantin_figure_aim_for(pantin_figure *f, pantin_player *player, const pantin_view *view, pantin_figure_cover cover,
                                    const void *context) {
    uint32_t now = player->frame, frame = 0;
    pantin_result result = player->started ? PANTIN_OK : pantin_restart(player);
    int32_t up[3], facing[3], scale, trial;
    uint8_t i, finer;
    bounds b;
    pantin_extent e;
    int32_t origin[3] = {0, 0, 0};
    b.figure = f;
    for (i = 0; i < 3; i++) {
        b.low[i] = 0x7fffffffL;
        b.high[i] = -0x7fffffffL - 1;
        b.leftward[i] = 0;
    }
    pantin_figure_world(f->view);
    while (next_sample(player, &frame, &result)) pantin_figure_place(f, player->pose, f->view, origin, PANTIN_MAX_BONES + 1, include, &b);
    orient(f, &b, view->up == PANTIN_RIG_UP ? f->up : view->up, up, facing);
    f->dotted = (uint32_t)f->width * f->height < 45000u;
    finer = f->dotted ? 3 : 2;
    i = bits_of((uint32_t)f->size);
    f->ground_spacing = (uint8_t)(i > finer + 1 ? i - finer : 1);
    /* A fixed camera sees as far as a size to all sides, in 16 bits. */
    trial = view->fixed ? LARGEST_SCALE / 4 : LARGEST_SCALE;
    set_camera(f, &b, up, facing, view, trial);
    memset(&e, 0, sizeof e);
    frame = 0;
    while (next_sample(player, &frame, &result)) {
        pantin_figure_values(f, player->pose, pantin_figure_see, f);
        for (i = 0; i < f->line_count; i++) {
            const pantin_bone *bone = &f->bones[f->bones[i].order];
            pantin_figure_widen(&e, f->bones[bone->parent].place, 0);
            pantin_figure_widen(&e, bone->place, 0);
        }
        cover(context, f, &e);
    }
    scale = clamp(least(fit(f->height, e.bottom - e.top, trial), fit(f->width, 2 * e.side, trial)), 1, LARGEST_SCALE);
    set_camera(f, &b, up, facing, view, scale);
    f->centre[0] = (int32_t)f->offset[0] * 16 + ((int32_t)f->width << 4) / 2;
    f->centre[1] = (int32_t)f->offset[1] * 16 + ((int32_t)f->height << 4) / 2 - (e.top + e.bottom) / 2 * scale / trial;
    if (result == PANTIN_OK) result = pantin_seek(player, now);
    if (result == PANTIN_OK) return PANTIN_OK;
    /* It is still the frame to which the next call goes back. */
    player->frame = now;
    player->started = 0;
    return result;
}

void pantin_figure_shift(pantin_figure *f, int16_t x, int16_t y) {
    f->offset[0] = (int16_t)(f->offset[0] + x);
    f->offset[1] = (int16_t)(f->offset[1] + y);
    f->centre[0] += (int32_t)x * 16;
    f->centre[1] += (int32_t)y * 16;
}

/* ---- Lines ---- */

static int32_t between(const pantin_bone *from, const pantin_bone *to) { return ((int32_t)from->depth + to->depth) >> 1; }

static uint8_t shade_of(int32_t depth) { return (uint8_t)clamp(176 - ((depth * 5) >> 7), 80, 255); }

/* Twice the depth of a bone's middle, then its index. */
static int32_t key(const pantin_figure *f, uint8_t index) {
    const pantin_bone *bone = &f->bones[index];
    return ((int32_t)f->bones[bone->parent].depth + bone->depth) * 256 - index;
}

void pantin_figure_sort(pantin_figure *f) {
    uint8_t i, place, moving;
    int32_t own;
    for (i = 1; i < f->line_count; i++) {
        moving = f->bones[i].order;
        own = key(f, moving);
        for (place = i; place > 0 && key(f, f->bones[place - 1].order) < own; place--) f->bones[place].order = f->bones[place - 1].order;
        f->bones[place].order = moving;
    }
}

void pantin_figure_pose(pantin_figure *f, const int32_t *pose) {
    pantin_figure_values(f, pose, pantin_figure_see, f);
    pantin_figure_sort(f);
}

int pantin_figure_line(const pantin_figure *f, uint8_t index, pantin_line *line) {
    const pantin_bone *bone, *from;
    int32_t depth, breadth = f->scale / 64;
    if (index >= f->line_count) return 0;
    bone = &f->bones[f->bones[index].order];
    from = &f->bones[bone->parent];
    depth = between(from, bone);
    memcpy(line->from, from->place, sizeof line->from);
    memcpy(line->to, bone->place, sizeof line->to);
    line->depth = (int16_t)depth;
    line->shade = shade_of(depth);
    line->part = bone->part;
    line->width = (uint8_t)clamp((breadth - ((breadth * depth) >> 14)) >> 4, 1, 9);
    return 1;
}

int32_t pantin_figure_seen(const pantin_figure *f, int32_t length) {
    uint8_t cut = bits_of((uint32_t)f->camera_size);
    cut = (uint8_t)(cut > 13 ? cut - 13 : 0);
    return least(length >> cut, 32767) * f->scale / most(f->camera_size >> cut, 1);
}

int pantin_figure_head(const pantin_figure *f, pantin_head *head) {
    const pantin_bone *from, *to;
    uint8_t i;
    int32_t radius;
    if (f->crown == NONE) return 0;
    to = &f->bones[f->crown];
    from = &f->bones[to->parent];
    for (i = 0; i < 2; i++) head->centre[i] = (int16_t)(((int32_t)from->place[i] + to->place[i]) >> 1);
    radius = pantin_figure_seen(f, f->head_radius);
    head->radius = narrow((radius * pantin_figure_magnification(to->depth)) >> 14);
    head->shade = shade_of(between(from, to));
    return 1;
}

/* ---- Ground ---- */

void pantin_first_ground(pantin_ground *g, const pantin_figure *f) {
    int32_t corner[3], spacing = (int32_t)1 << f->ground_spacing, view[3][3];
    uint8_t next, rows = f->dotted ? 7 : 5;
    memcpy(view, f->view, sizeof view);
    g->figure = f;
    g->row = g->column = 0;
    corner[f->ground_axis] = difference(f->ground_height, f->target[f->ground_axis]);
    for (next = 1; next < 3; next++) {
        uint8_t axis = (uint8_t)((f->ground_axis + next) % 3);
        int32_t step[3] = {0, 0, 0}, past = sum(f->target[axis], spacing / 2) & (spacing - 1);
        corner[axis] = spacing / 2 - past - rows / 2 * spacing;
        step[axis] = spacing;
        pantin_figure_apply_any(view, step, g->steps[next - 1]);
    }
    pantin_figure_apply_any(view, corner, g->corner);
    memcpy(g->place, g->corner, sizeof g->place);
}

static int32_t along(int32_t from, int32_t step, int8_t times) { return sum(from, (int32_t)((uint32_t)step * (uint32_t)(int32_t)times)); }

int pantin_next_ground(pantin_ground *g, pantin_line *line) {
    const pantin_figure *f = g->figure;
    int32_t place[3], depth;
    uint8_t i;
    memset(line, 0, sizeof *line);
    line->part = PANTIN_GROUND;
    line->width = 1;
    if (f->dotted) {
        /* Without the corners. */
        int8_t cut = (int8_t)((g->row < 3 ? 3 - g->row : g->row - 3) - 1);
        if (cut < 0) cut = 0;
        if (g->row >= 7) return 0;
        for (i = 0; i < 3; i++) place[i] = along(g->place[i], g->steps[0][i], (int8_t)(cut + g->column));
        depth = project(f, place, line->from);
        memcpy(line->to, line->from, sizeof line->to);
        line->shade = (uint8_t)clamp(112 - (depth >> 7), 32, 208);
        if (++g->column == 7 - 2 * cut) {
            g->column = 0;
            g->row++;
            for (i = 0; i < 3; i++) g->place[i] = sum(g->place[i], g->steps[1][i]);
        }
    } else {
        /* Rows 0 to 4 go along the second step, 5 to 9 along the first. */
        uint8_t first = g->row < 5;
        if (g->row >= 10) return 0;
        if (g->row == 5) memcpy(g->place, g->corner, sizeof g->place);
        for (i = 0; i < 3; i++) place[i] = along(g->place[i], g->steps[first][i], 4);
        depth = project(f, g->place, line->from);
        depth = (depth + project(f, place, line->to)) >> 1;
        line->shade = (uint8_t)clamp(40 - (depth >> 9), 24, 56);
        for (i = 0; i < 3; i++) g->place[i] = sum(g->place[i], g->steps[!first][i]);
        g->row++;
    }
    line->depth = narrow(depth);
    return 1;
}
