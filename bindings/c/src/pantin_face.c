/* Faces: see pantin_face.h.
 *
 * The steps and the rounding are those of the crate pantin-face, so that both draw the same pixels. Sums and products that a strange model can make
 * overflow are taken on uint32_t. The right shift of a negative number is taken to round down, as it does with every compiler for small machines. */
#include "pantin_face.h"
#include "pantin_figure_tables.h"

/* A byte of a model. */
#define BYTE(address) PANTIN_U8(address)

typedef char right_shift_rounds_down[(-1 >> 1) == -1 ? 1 : -1];

#define ONE ((int32_t)32768)
#define HALF ((int32_t)16384)
#define FULL ((int32_t)32768)
#define NO_SHAPE 255u
#define NAME_BYTES 7u
#define GRAZING 4
/* In place of the cosine of a vertex that no line needs. */
#define NOT_DRAWN (-128)
#define CORNERS 64u
#define CROSSINGS 8u
#define EDGE 10u
#define NEVER ((int32_t)0x7fffffff)

enum { LINEAR = 0, EASED, SPHERICAL, IMPROVED };
enum { UNSIGNED = 0, SIGNED, HEAD };
enum { BEFORE = 1, ROUNDED = 2, FRESH = 4 };

/* ---- Numbers ---- */

static int32_t sum(int32_t a, int32_t b) { return (int32_t)((uint32_t)a + (uint32_t)b); }
static int32_t difference(int32_t a, int32_t b) { return (int32_t)((uint32_t)a - (uint32_t)b); }
static int32_t product(int32_t a, int32_t b) { return (int32_t)((uint32_t)a * (uint32_t)b); }
static int32_t doubled(int32_t a, uint8_t times) { return (int32_t)((uint32_t)a << times); }
static int32_t least(int32_t a, int32_t b) { return a < b ? a : b; }
static int32_t most(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t clamp(int32_t x, int32_t low, int32_t high) { return x < low ? low : x > high ? high : x; }
static int32_t size_of(int32_t x) { return x < 0 ? difference(0, x) : x; }
static int16_t low16(int32_t x) { return (int16_t)(uint16_t)(uint32_t)x; }
static int8_t low8(int32_t x) { return (int8_t)(uint8_t)(uint32_t)x; }
static int16_t narrow(int32_t x) { return (int16_t)clamp(x, -32768L, 32767L); }

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

static int32_t sine(int32_t angle) {
    int32_t sin, cos;
    sin_cos(angle, &sin, &cos);
    return sin;
}

/* ---- Bytes ---- */

/* A place in a model, and how many bytes follow it there. Once bytes are missing, it has none left and `result` says so. */
typedef struct bytes {
    const uint8_t *at;
    uint32_t left;
    pantin_result result;
} bytes;

static const uint8_t *take(bytes *b, uint32_t count) {
    const uint8_t *at = b->at;
    if (count > b->left) {
        b->result = PANTIN_ERROR_LENGTH;
        b->left = 0;
        return at;
    }
    b->at += count;
    b->left -= count;
    return at;
}

static uint8_t u8(bytes *b) {
    const uint8_t *at = b->at;
    if (b->left == 0) {
        b->result = PANTIN_ERROR_LENGTH;
        return 0;
    }
    b->at++;
    b->left--;
    return BYTE(at);
}

static uint16_t u16_at(const uint8_t *at) { return (uint16_t)(BYTE(at) | (uint16_t)BYTE(at + 1) << 8); }
static int16_t i16_at(const uint8_t *at) { return (int16_t)u16_at(at); }

static uint16_t u16(bytes *b) {
    uint16_t low = u8(b);
    return (uint16_t)(low | (uint16_t)u8(b) << 8);
}

static uint16_t index_of(bytes *b, uint8_t wide) { return wide ? u16(b) : u8(b); }

/* Index number `i` of a list. */
static uint16_t index_at(const uint8_t *list, uint32_t i, uint8_t wide) { return wide ? u16_at(list + 2 * i) : BYTE(list + i); }

static bytes whole(const uint8_t *at) {
    bytes b;
    b.at = at;
    b.left = 0xffffffffu;
    b.result = PANTIN_OK;
    return b;
}

/* ---- Model ---- */

typedef struct curve {
    const uint8_t *indices;
    uint8_t flags, shade, count;
} curve;
enum { CLOSED = 1, MIRRORED = 2, STRAIGHT = 16, SMALL = 32, FILLED = 64 };

typedef struct opening {
    const uint8_t *upper, *lower, *members;
    int16_t drop;
    uint8_t mirrored, release, upper_count, lower_count, member_count;
} opening;

typedef struct shape {
    const uint8_t *deltas, *rotations;
    uint16_t delta_bytes, rotation_bytes, scale;
    int16_t centre[3], angle; /* of the arc; the angle is 0 if there is none */
    uint8_t interpolation, kind;
} shape;

typedef struct rotation {
    const uint8_t *members;
    int16_t centre[3], angle;
    uint8_t axis, runs;
} rotation;

static uint32_t vertex_count(const pantin_face_model *m) { return m->middles + 2u * m->pairs; }

static uint16_t mirror(const pantin_face_model *m, uint16_t index) {
    if (index < m->middles) return index;
    return (uint16_t)(index < (uint16_t)(m->middles + m->pairs) ? index + m->pairs : index - m->pairs);
}

static void read_curve(bytes *b, uint8_t wide, curve *c) {
    c->flags = u8(b);
    c->shade = u8(b);
    c->count = u8(b);
    if (c->flags >> 7 || c->count < 2 || (c->flags & (FILLED | CLOSED)) == FILLED) b->result = PANTIN_ERROR_RIG;
    c->indices = take(b, (uint32_t)c->count << wide);
}

static void read_opening(bytes *b, uint8_t wide, opening *o) {
    o->mirrored = u8(b);
    o->release = u8(b);
    o->drop = (int16_t)u16(b);
    o->upper_count = u8(b);
    o->lower_count = u8(b);
    o->member_count = u8(b);
    o->upper = take(b, (uint32_t)o->upper_count << wide);
    o->lower = take(b, (uint32_t)o->lower_count << wide);
    o->members = take(b, (uint32_t)o->member_count << wide);
    if (o->mirrored > 1 || o->upper_count < 2 || o->lower_count < 2) b->result = PANTIN_ERROR_RIG;
}

static void read_shape(bytes *b, shape *s) {
    uint8_t head = u8(b), i;
    s->interpolation = head & 3;
    s->kind = head >> 2;
    s->scale = u16(b);
    s->delta_bytes = u16(b);
    s->rotation_bytes = u16(b);
    s->deltas = take(b, s->delta_bytes);
    s->rotations = take(b, s->rotation_bytes);
    s->angle = 0;
    if (s->kind > HEAD) b->result = PANTIN_ERROR_RIG;
    if (s->interpolation == SPHERICAL && s->delta_bytes && b->result == PANTIN_OK) {
        if (s->delta_bytes < 8) {
            b->result = PANTIN_ERROR_LENGTH;
            return;
        }
        for (i = 0; i < 3; i++) s->centre[i] = i16_at(s->deltas + 2 * i);
        s->angle = i16_at(s->deltas + 6);
        s->deltas += 8;
        s->delta_bytes = (uint16_t)(s->delta_bytes - 8);
        if (s->angle < 1 || s->angle > 21845) b->result = PANTIN_ERROR_RIG;
    }
}

static void read_rotation(bytes *b, uint8_t wide, rotation *r) {
    uint8_t i;
    r->axis = u8(b);
    r->runs = u8(b);
    for (i = 0; i < 3; i++) r->centre[i] = (int16_t)u16(b);
    r->angle = (int16_t)u16(b);
    r->members = take(b, (uint32_t)r->runs * (3u + wide));
    if (r->axis > 2) b->result = PANTIN_ERROR_RIG;
}

static void check_index(bytes *b, uint16_t index, uint32_t below) {
    if (index >= below) b->result = PANTIN_ERROR_RIG;
}

static void check_list(bytes *b, const pantin_face_model *m, const uint8_t *list, uint32_t count, uint32_t below) {
    uint32_t i;
    for (i = 0; i < count && b->result == PANTIN_OK; i++) check_index(b, index_at(list, i, m->wide), below);
}

/* The range of vertices that may move: in the middle, on the left, on the right. */
static void moving_range(const pantin_face_model *m, uint8_t part, uint32_t *from, uint32_t *to) {
    *from = part == 0 ? 0 : m->middles + (part == 2 ? m->pairs : 0u);
    *to = *from + m->moving[part != 0];
}

static void check_run(bytes *b, const pantin_face_model *m, uint16_t first, uint8_t count) {
    uint32_t from, to;
    uint8_t part;
    for (part = 0; part < 3 && count > 0; part++) {
        moving_range(m, part, &from, &to);
        if (first >= from && (uint32_t)first + count <= to) return;
    }
    b->result = PANTIN_ERROR_RIG;
}

static void check_curves(bytes *b, const pantin_face_model *m) {
    uint32_t stored = (uint32_t)m->middles + m->pairs;
    uint8_t i;
    curve c;
    for (i = 0; i < m->curve_count && b->result == PANTIN_OK; i++) {
        read_curve(b, m->wide, &c);
        if (b->result == PANTIN_OK) check_list(b, m, c.indices, c.count, c.flags & MIRRORED ? stored : vertex_count(m));
    }
}

static void check_openings(bytes *b, const pantin_face_model *m) {
    uint8_t i, member;
    opening o;
    for (i = 0; i < m->opening_count && b->result == PANTIN_OK; i++) {
        read_opening(b, m->wide, &o);
        if (o.release != NO_SHAPE && o.release >= m->shape_count) b->result = PANTIN_ERROR_RIG;
        if (b->result != PANTIN_OK) return;
        for (member = 0; member < o.member_count && b->result == PANTIN_OK; member++) check_run(b, m, index_at(o.members, member, m->wide), 1);
        check_list(b, m, o.upper, o.upper_count, vertex_count(m));
        check_list(b, m, o.lower, o.lower_count, vertex_count(m));
    }
}

static void check_shapes(bytes *b, const pantin_face_model *m) {
    uint8_t i, run;
    for (i = 0; i < m->shape_count && b->result == PANTIN_OK; i++) {
        shape s;
        bytes part;
        read_shape(b, &s);
        if (b->result != PANTIN_OK) return;
        part = whole(s.deltas);
        part.left = s.delta_bytes;
        while (part.left && part.result == PANTIN_OK) {
            uint16_t first = index_of(&part, m->wide);
            uint8_t count = u8(&part);
            take(&part, 3u * count);
            if (part.result == PANTIN_OK) check_run(&part, m, first, count);
        }
        if (part.result == PANTIN_OK) {
            part.at = s.rotations;
            part.left = s.rotation_bytes;
        }
        while (part.left && part.result == PANTIN_OK) {
            rotation r;
            bytes members;
            read_rotation(&part, m->wide, &r);
            members = whole(r.members);
            for (run = 0; run < r.runs && part.result == PANTIN_OK; run++) {
                uint16_t first = index_of(&members, m->wide);
                uint8_t count = u8(&members);
                u8(&members);
                check_run(&part, m, first, count);
            }
        }
        if (part.result != PANTIN_OK) b->result = part.result;
    }
}

/* Reads the sections of a model, and checks every index. */
static pantin_result read_model(pantin_face_model *m, const uint8_t *model, uint32_t length) {
    bytes b = whole(model);
    uint32_t stored, i;
    uint8_t flags;
    b.left = length;
    memset(m, 0, sizeof *m);
    if (u8(&b) != 1) return length ? PANTIN_ERROR_VERSION : PANTIN_ERROR_LENGTH;
    flags = u8(&b);
    m->wide = flags & 1;
    m->exponent = (int8_t)u8(&b);
    m->middles = u16(&b);
    m->pairs = u16(&b);
    m->moving[0] = u16(&b);
    m->moving[1] = u16(&b);
    m->triangle_count = u16(&b);
    m->outline_count = u16(&b);
    m->name_count = u16(&b);
    m->fixed_count = u8(&b);
    m->curve_count = u8(&b);
    m->opening_count = u8(&b);
    m->shape_count = u8(&b);
    if (b.result != PANTIN_OK) return b.result;
    stored = (uint32_t)m->middles + m->pairs;
    if (flags > 1 || vertex_count(m) > (m->wide ? 32768u : 256u) || vertex_count(m) == 0 || m->outline_count > m->triangle_count ||
        m->moving[0] > m->middles || m->moving[1] > m->pairs || m->shape_count > PANTIN_FACE_SHAPES || m->exponent < -24 || m->exponent > 24) {
        return PANTIN_ERROR_RIG;
    }
    m->points = take(&b, stored * 6);
    m->normals = take(&b, stored * 3);
    m->triangles = take(&b, (uint32_t)m->triangle_count * 3 << m->wide);
    m->fixed = take(&b, (uint32_t)m->fixed_count << m->wide);
    if (b.result != PANTIN_OK) return b.result;
    check_list(&b, m, m->triangles, (uint32_t)m->triangle_count * 3, stored);
    check_list(&b, m, m->fixed, m->fixed_count, vertex_count(m));
    m->curves = b.at;
    check_curves(&b, m);
    m->openings = b.at;
    check_openings(&b, m);
    m->shapes = b.at;
    check_shapes(&b, m);
    m->names = take(&b, (uint32_t)m->name_count * NAME_BYTES);
    if (b.result != PANTIN_OK) return b.result;
    for (i = 0; i < m->name_count; i++) {
        if ((BYTE(m->names + i * NAME_BYTES + 4) & 63) >= m->shape_count) return PANTIN_ERROR_RIG;
    }
    return b.left ? PANTIN_ERROR_RIG : PANTIN_OK;
}

static void neutral(const pantin_face_model *m, uint32_t index, int16_t *to) {
    uint32_t stored = index < (uint32_t)m->middles + m->pairs ? index : index - m->pairs;
    const uint8_t *at = m->points + 6 * stored;
    to[0] = i16_at(at);
    if (stored != index) to[0] = low16(-(int32_t)to[0]);
    to[1] = i16_at(at + 2);
    to[2] = i16_at(at + 4);
}

/* ---- Weights ---- */

#define HASH_START 0x811c9dc5u
#define HASH_FACTOR 0x01000193u

static int has_name(const pantin_face_model *m, uint32_t hash) {
    uint32_t i;
    for (i = 0; i < m->name_count; i++) {
        const uint8_t *at = m->names + i * NAME_BYTES;
        if ((u16_at(at) | (uint32_t)u16_at(at + 2) << 16) == hash) return 1;
    }
    return 0;
}

static uint32_t hash_of(const char *name, uint8_t capital) {
    uint32_t hash = HASH_START, i;
    for (i = 0; name[i]; i++) {
        uint8_t letter = (uint8_t)name[i];
        if (capital && i == 0 && letter >= 'a' && letter <= 'z') letter = (uint8_t)(letter - 32);
        hash = (hash ^ letter) * HASH_FACTOR;
    }
    return hash;
}

/* The hash of a name that the model has, as given or with a capital first letter. Returns 0 if there is none. */
static int find_name(const pantin_face_model *m, const char *name, uint32_t *hash) {
    size_t length = strlen(name);
    *hash = hash_of(name, 0);
    if (has_name(m, *hash)) return 1;
    *hash = hash_of(name, 1);
    return length > 0 && length <= 32 && has_name(m, *hash);
}

/* value * 2^shift in Q15, -2 to 2. */
static int32_t shifted(int32_t value, int32_t shift) {
    if (shift < -30) return 0;
    if (shift < 0) {
        value >>= -shift;
    } else if (shift < 8) {
        value = doubled(value, (uint8_t)shift);
    } else {
        value = value > 0 ? 2 * FULL : value < 0 ? -2 * FULL : 0;
    }
    return clamp(value, -2 * FULL, 2 * FULL);
}

static int16_t stored(int32_t weight) { return narrow(weight >> 1); }
static int32_t used(int16_t weight) { return clamp((int32_t)weight * 2, -FULL, FULL); }

static void add_weight(int16_t (*weights)[2], uint8_t target, int32_t weight) {
    int16_t *pair = weights[target & 63];
    if (target & 64) pair[0] = narrow((int32_t)pair[0] + stored(weight));
    if (target & 128) pair[1] = narrow((int32_t)pair[1] + stored(weight));
}

/* Adds a weight to what a name drives, or sets it. */
static void drive_name(const pantin_face_model *m, int16_t (*weights)[2], uint32_t hash, int32_t weight, uint8_t set) {
    uint32_t i;
    weight = clamp(weight, -2 * FULL, 2 * FULL);
    for (i = 0; i < m->name_count; i++) {
        const uint8_t *at = m->names + i * NAME_BYTES;
        uint8_t target;
        int32_t value;
        if (u16_at(at) != (hash & 0xffff) || u16_at(at + 2) != hash >> 16) continue;
        target = BYTE(at + 4);
        value = shifted(weight * (int8_t)BYTE(at + 5), (int8_t)BYTE(at + 6));
        if (set) {
            if (target & 64) weights[target & 63][0] = stored(value);
            if (target & 128) weights[target & 63][1] = stored(value);
        } else {
            add_weight(weights, target, value);
        }
    }
}

static void add_name(pantin_face *f, const char *name, int32_t weight) {
    uint32_t hash;
    if (weight && find_name(&f->model, name, &hash)) drive_name(&f->model, f->weights, hash, weight, 0);
}

/* The part of its distance that a vertex has moved at a weight; both in Q15. */
static int32_t eased(uint8_t interpolation, int32_t weight) {
    int32_t sin, cos;
    if (interpolation == EASED) {
        sin_cos(doubled(weight, 16), &sin, &cos);
        return weight < 0 ? -((ONE - cos) >> 1) : (ONE - cos) >> 1;
    }
    return interpolation == IMPROVED ? sine(doubled(weight, 15)) : weight;
}

/* ---- From weights to vertices ---- */

/* Adds a run of deltas: x times the first factor (Q8), y and z times the second. */
static void add_run(const pantin_face *f, const uint8_t *deltas, uint8_t count, uint16_t first, int32_t across, int32_t factor) {
    int16_t(*vertex)[3] = f->vertices + first;
    for (; count > 0; count--, vertex++, deltas += 3) {
        int32_t x = (int8_t)BYTE(deltas), y = (int8_t)BYTE(deltas + 1), z = (int8_t)BYTE(deltas + 2);
        (*vertex)[0] = low16((*vertex)[0] + (sum(product(x, across), 128) >> 8));
        (*vertex)[1] = low16((*vertex)[1] + (sum(product(y, factor), 128) >> 8));
        (*vertex)[2] = low16((*vertex)[2] + (sum(product(z, factor), 128) >> 8));
    }
}

/* Moves the vertices of a run away from the centre of a shape's arc. */
static void push_run(const pantin_face *f, const shape *s, const uint8_t *deltas, uint8_t count, uint16_t first, int32_t sign, int32_t away) {
    uint8_t axis;
    for (; count > 0; count--, first++, deltas += 3) {
        int32_t largest = 0, bent;
        int16_t from[3];
        for (axis = 0; axis < 3; axis++) largest = most(largest, size_of((int8_t)BYTE(deltas + axis)));
        bent = product(away, (largest * largest * 65) >> 12) >> 8;
        neutral(&f->model, first, from);
        for (axis = 0; axis < 3; axis++) {
            int32_t centre = axis == 0 ? sign * s->centre[0] : s->centre[axis];
            f->vertices[first][axis] = low16(f->vertices[first][axis] + (sum(product(from[axis] - centre, bent), ONE >> 1) >> 15));
        }
    }
}

/* Smaller factors move no vertex by more than 16 steps: such deltas are skipped. */
#define MIN_FACTOR 32

static void add_deltas(const pantin_face *f, const shape *s, const int32_t *pair) {
    int32_t factor[2], away[2] = {0, 0};
    uint8_t side;
    bytes b = whole(s->deltas);
    for (side = 0; side < 2; side++) {
        if (s->angle) {
            int32_t all = most(sine(doubled(s->angle * ONE, 1)), 1);
            int32_t along = doubled(sine(doubled(product(s->angle, pair[side]), 1)), 15) / all;
            int32_t from = doubled(sine(doubled(product(s->angle, ONE - pair[side]), 1)), 15) / all;
            away[side] = from + along - ONE;
            factor[side] = product(along, s->scale >> 1) >> 14;
        } else {
            factor[side] = product(eased(s->interpolation, pair[side]), s->scale) >> 15;
        }
    }
    if (!s->angle && most(size_of(factor[0]), size_of(factor[1])) < MIN_FACTOR) return;
    b.left = s->delta_bytes;
    while (b.left) {
        uint16_t first = index_of(&b, f->model.wide);
        uint8_t count = u8(&b);
        const uint8_t *deltas = take(&b, 3u * count);
        for (side = 0; side < 2; side++) {
            uint16_t at = side ? mirror(&f->model, first) : first;
            if (s->angle ? pair[side] == 0 : size_of(factor[side]) < MIN_FACTOR) continue;
            if (s->angle) push_run(f, s, deltas, count, at, side ? -1 : 1, away[side]);
            add_run(f, deltas, count, at, side ? difference(0, factor[side]) : factor[side], factor[side]);
        }
    }
}

/* c and s (Q15) of a part (255ths) of an angle (2^-16 turns) at a weight (Q15). */
static void coefficients(int16_t of, uint8_t part, uint8_t interpolation, int32_t weight, int32_t *c_s) {
    int32_t angle = ((int32_t)of * (part + (part >> 7))) >> 8, sin, cos, t;
    if (interpolation == SPHERICAL) {
        sin_cos(doubled(product(angle, weight), 1), &c_s[1], &c_s[0]);
        return;
    }
    t = eased(interpolation, weight);
    sin_cos(doubled(angle, 16), &sin, &cos);
    c_s[0] = ONE + ((size_of(t) * ((cos - ONE) >> 1)) >> 14);
    c_s[1] = (t * sin) >> 15;
}

/* Rotates vertices about a line parallel to an axis, given its point. */
static void move_about(const pantin_face *f, const rotation *r, int32_t centre_x, const int32_t *c_s, uint32_t first, uint8_t count) {
    uint8_t b = (uint8_t)((r->axis + 1) % 3), c = (uint8_t)((r->axis + 2) % 3);
    int32_t centre_b = b == 0 ? centre_x : r->centre[b], centre_c = c == 0 ? centre_x : r->centre[c];
    for (; count > 0; count--, first++) {
        int16_t *vertex = f->vertices[first];
        int32_t from_b = vertex[b] - centre_b, from_c = vertex[c] - centre_c;
        int32_t to_b = sum(sum(product(from_b, c_s[0]), product(from_c, -c_s[1])), HALF) >> 15;
        int32_t to_c = sum(sum(product(from_c, c_s[0]), product(from_b, c_s[1])), HALF) >> 15;
        vertex[b] = low16(sum(to_b, centre_b));
        vertex[c] = low16(sum(to_c, centre_c));
    }
}

static void rotate(const pantin_face *f, const shape *s, const rotation *r, const int32_t *pair) {
    const pantin_face_model *m = &f->model;
    bytes b = whole(r->members);
    int16_t image_angle = r->axis == 0 ? r->angle : low16(-(int32_t)r->angle);
    int32_t image_x = low16(-(int32_t)r->centre[0]);
    uint8_t run;
    for (run = 0; run < r->runs; run++) {
        uint16_t first = index_of(&b, m->wide);
        uint8_t count = u8(&b), part = u8(&b);
        int32_t c_s[2];
        if (first < m->middles) {
            coefficients(r->angle, part, s->interpolation, (pair[0] + pair[1]) >> 1, c_s);
            move_about(f, r, r->centre[0], c_s, first, count);
            continue;
        }
        coefficients(r->angle, part, s->interpolation, pair[0], c_s);
        if (pair[0]) move_about(f, r, r->centre[0], c_s, first, count);
        if (pair[1]) {
            coefficients(image_angle, part, s->interpolation, pair[1], c_s);
            move_about(f, r, image_x, c_s, mirror(m, first), count);
        }
    }
}

/* Applies the shapes one after the other. */
static void apply_shapes(pantin_face *f) {
    bytes b = whole(f->model.shapes);
    uint8_t i, side;
    memset(f->head, 0, sizeof f->head);
    memset(f->pivot, 0, sizeof f->pivot);
    for (i = 0; i < f->model.shape_count; i++) {
        shape s;
        bytes rotations;
        int32_t pair[2];
        read_shape(&b, &s);
        for (side = 0; side < 2; side++) {
            pair[side] = used(f->weights[i][side]);
            if (s.kind == UNSIGNED) pair[side] = most(pair[side], 0);
        }
        if (s.kind != HEAD && f->weights[i][0] == 0 && f->weights[i][1] == 0) continue;
        if (s.kind != HEAD && s.delta_bytes) add_deltas(f, &s, pair);
        rotations = whole(s.rotations);
        rotations.left = s.rotation_bytes;
        while (rotations.left) {
            rotation r;
            read_rotation(&rotations, f->model.wide, &r);
            if (s.kind == HEAD) {
                memcpy(f->pivot, r.centre, sizeof f->pivot);
                f->head[r.axis] = sum(f->head[r.axis], doubled(product(r.angle, pair[0]), 1));
            } else {
                rotate(f, &s, &r, pair);
            }
        }
    }
}

/* ---- Openings ---- */

typedef struct edge {
    int16_t at[EDGE][2];
    int32_t left, right, low, high; /* the extent of the vertices between the corners */
    uint8_t count;
} edge;

static void read_edge(const pantin_face *f, edge *e, const uint8_t *list, uint8_t count, uint8_t mirrored) {
    uint8_t i;
    e->count = (uint8_t)least(count, EDGE);
    e->left = e->low = NEVER;
    e->right = e->high = -NEVER - 1;
    for (i = 0; i < e->count; i++) {
        uint16_t index = index_at(list, i, f->model.wide);
        const int16_t *vertex = f->vertices[mirrored ? mirror(&f->model, index) : index];
        e->at[i][0] = vertex[0];
        e->at[i][1] = vertex[1];
        if (i == 0 || i == e->count - 1) continue;
        e->left = least(e->left, vertex[0]);
        e->right = most(e->right, vertex[0]);
        e->low = least(e->low, vertex[1]);
        e->high = most(e->high, vertex[1]);
    }
}

/* The edge's height at `x`, by bisection between two vertices. */
static int32_t height_at(const edge *e, int32_t x) {
    uint8_t i, n;
    for (i = 0; i + 1 < e->count; i++) {
        const int16_t *from = e->at[i], *to = e->at[i + 1], *swap = from;
        int32_t a[2], b[2];
        if (from[0] > to[0]) {
            from = to;
            to = swap;
        }
        if (from[0] > x || x > to[0]) continue;
        for (n = 0; n < 2; n++) {
            a[n] = from[n];
            b[n] = to[n];
        }
        for (n = 0; n < 4; n++) {
            int32_t middle = (a[0] + b[0]) >> 1, height = (a[1] + b[1]) >> 1;
            if (x <= middle) {
                b[0] = middle;
                b[1] = height;
            } else {
                a[0] = middle;
                a[1] = height;
            }
        }
        return (a[1] + b[1]) >> 1;
    }
    return e->at[e->count - 1][1];
}

/* Moves the members of all openings between the edges of their opening. */
static void clip_members(const pantin_face *f) {
    bytes b = whole(f->model.openings);
    uint8_t i, mirrored, member;
    for (i = 0; i < f->model.opening_count; i++) {
        opening o;
        int32_t drop;
        read_opening(&b, f->model.wide, &o);
        drop = o.release < f->model.shape_count ? ((int32_t)o.drop * most(used(f->weights[o.release][0]), 0)) >> 15 : 0;
        for (mirrored = 0; mirrored <= o.mirrored; mirrored++) {
            edge upper, lower;
            int32_t left, right;
            read_edge(f, &upper, o.upper, o.upper_count, mirrored);
            read_edge(f, &lower, o.lower, o.lower_count, mirrored);
            left = least(least(upper.left, upper.at[0][0]), upper.at[upper.count - 1][0]);
            right = most(most(upper.right, upper.at[0][0]), upper.at[upper.count - 1][0]);
            for (member = 0; member < o.member_count; member++) {
                uint16_t index = index_at(o.members, member, f->model.wide);
                int16_t *vertex = f->vertices[mirrored ? mirror(&f->model, index) : index];
                int32_t x = least(most(vertex[0], left), right), y = vertex[1];
                if (x < upper.left || x > upper.right || y > upper.low) y = least(y, height_at(&upper, x));
                if (x < lower.left || x > lower.right || y < lower.high) y = most(y, height_at(&lower, x) - drop);
                vertex[0] = low16(x);
                vertex[1] = low16(y);
            }
        }
    }
}

/* Moves the vertices as the weights say. */
static void morph(pantin_face *f) {
    uint32_t from, to;
    uint8_t part;
    for (part = 0; part < 3; part++) {
        moving_range(&f->model, part, &from, &to);
        for (; from < to; from++) neutral(&f->model, from, f->vertices[from]);
    }
    apply_shapes(f);
    clip_members(f);
}

/* ---- Camera ---- */

static void turn(int32_t (*r)[3], uint8_t axis, int32_t angle) {
    int32_t sin, cos, *b = r[(axis + 1) % 3], *c = r[(axis + 2) % 3];
    uint8_t i;
    if (angle == 0) return;
    sin_cos(angle, &sin, &cos);
    for (i = 0; i < 3; i++) {
        int32_t from_b = b[i], from_c = c[i];
        b[i] = (from_b * cos + from_c * sin + HALF) >> 15;
        c[i] = (from_c * cos - from_b * sin + HALF) >> 15;
    }
}

/* Columns of no rotation. */
static void identity(int32_t (*r)[3]) {
    uint8_t i;
    memset(r, 0, 3 * sizeof *r);
    for (i = 0; i < 3; i++) r[i][i] = ONE;
}

/* The head's rotation: about y, then x, then z. */
static void head_rotation(int32_t (*r)[3], const int32_t *angles) {
    identity(r);
    turn(r, 1, angles[1]);
    turn(r, 0, angles[0]);
    turn(r, 2, angles[2]);
}

/* A row vector times a rotation. */
static void row_times(const int32_t *row, int32_t (*r)[3], int32_t *to) {
    uint8_t i;
    for (i = 0; i < 3; i++) to[i] = (row[0] * r[i][0] + row[1] * r[i][1] + row[2] * r[i][2] + HALF) >> 15;
}

/* The image of a vector of up to 2^15, in two halves. */
static void image_of(int32_t (*r)[3], const int16_t *v, int32_t *to) {
    uint8_t i, axis, wide = 0;
    for (axis = 0; axis < 3; axis++) wide = (uint8_t)(wide | (v[axis] < -16384 || v[axis] >= 16384));
    for (i = 0; i < 3; i++) {
        int32_t high = 0, low = HALF;
        for (axis = 0; axis < 3; axis++) {
            low = sum(low, r[axis][i] * (wide ? v[axis] & (ONE - 1) : v[axis]));
            if (wide) high = sum(high, r[axis][i] * (v[axis] >> 15));
        }
        to[i] = sum(high, low >> 15);
    }
}

/* What projects vertices in one orientation. */
typedef struct projection {
    int32_t across[2][3], offset[2], towards[3];
} projection;

static int32_t scaled(const pantin_face *f, int32_t x) { return (x * f->scale + HALF) >> 15; }

static void set_projection(const pantin_face *f, projection *p, int32_t (*head)[3], const int32_t *offset) {
    uint8_t row, axis;
    for (row = 0; row < 2; row++) {
        int32_t direction[3], along = doubled(1, f->shift) >> 1;
        for (axis = 0; axis < 3; axis++) {
            direction[axis] = row == 1 ? -f->rows[1][axis] : f->rows[0][axis];
            along = sum(along, product(scaled(f, direction[axis]), offset[axis]));
        }
        row_times(direction, head, p->across[row]);
        for (axis = 0; axis < 3; axis++) p->across[row][axis] = scaled(f, p->across[row][axis]);
        p->offset[row] = along;
    }
    row_times(f->rows[2], head, p->towards);
}

static int32_t along(const int32_t *row, const int16_t *v) { return sum(sum(product(row[0], v[0]), product(row[1], v[1])), product(row[2], v[2])); }

static void project_point(const pantin_face *f, const projection *p, uint32_t index) {
    const int16_t *v = f->vertices[index];
    int32_t magnification = sum(4096, product(along(p->towards, v) >> 15, f->nearer) >> 16);
    uint8_t axis;
    for (axis = 0; axis < 2; axis++) {
        int32_t flat = sum(along(p->across[axis], v), p->offset[axis]) >> f->shift;
        f->points[index][axis] = low16(sum(product(flat, magnification) >> 12, f->centre[axis]));
    }
}

static void project(const pantin_face *f, const projection *p, uint32_t index) {
    if (f->facing[index] != NOT_DRAWN) project_point(f, p, index);
}

/* ---- Outline ---- */

/* The part of a line, Q8, at which a value that is `from` at its start and `to` at its end passes 0. */
static int32_t zero_crossing(int32_t from, int32_t to) {
    int32_t size = size_of(from - to);
    return size == 0 || size > 255 ? 0 : (size_of(from) * (ONE / size)) >> 7;
}

static void between(const int16_t *from, const int16_t *to, int32_t part, int16_t *at) {
    uint8_t axis;
    for (axis = 0; axis < 2; axis++) at[axis] = low16(from[axis] + (((to[axis] - from[axis]) * part) >> 8));
}

/* Corners of stored triangle `i`, or of its mirror image. */
static void triangle(const pantin_face_model *m, uint32_t i, uint8_t mirrored, uint16_t *corners) {
    uint8_t n;
    for (n = 0; n < 3; n++) {
        uint16_t index = index_at(m->triangles, 3 * i + n, m->wide);
        corners[mirrored && n ? 3 - n : n] = mirrored && index >= m->middles ? (uint16_t)(index + m->pairs) : index;
    }
}

/* Where the outline crosses a triangle: its lone corner first, and the parts of the edges to the others. Returns 0 if it does not. */
static int crossed(const pantin_face *f, uint16_t *corners, uint8_t *parts) {
    int32_t a = f->facing[corners[0]], b = f->facing[corners[1]], c = f->facing[corners[2]];
    uint16_t x = corners[0], y = corners[1], z = corners[2];
    uint8_t n;
    if (((a ^ b) | (a ^ c)) >= 0) return 0;
    if ((a ^ b) >= 0) {
        corners[0] = z;
        corners[1] = x;
        corners[2] = y;
    } else if ((a ^ c) >= 0) {
        corners[0] = y;
        corners[1] = z;
        corners[2] = x;
    }
    for (n = 0; n < 2; n++) parts[n] = (uint8_t)least(zero_crossing(f->facing[corners[0]], f->facing[corners[n + 1]]), 255);
    return 1;
}

static void find_outline(pantin_face *f) {
    uint32_t i;
    uint8_t mirrored, n;
    f->outline_kept = 0;
    f->outline_overflown = f->model.wide;
    for (i = 0; i < f->model.outline_count && !f->outline_overflown; i++) {
        for (mirrored = 0; mirrored < (f->model.pairs ? 2 : 1); mirrored++) {
            uint16_t corners[3];
            uint8_t parts[2];
            pantin_face_crossed *kept = f->outline + f->outline_kept;
            triangle(&f->model, i, mirrored, corners);
            if (!crossed(f, corners, parts)) continue;
            if (f->outline_kept == PANTIN_FACE_OUTLINE) {
                f->outline_overflown = 1;
                break;
            }
            for (n = 0; n < 3; n++) kept->corners[n] = (uint8_t)corners[n];
            memcpy(kept->parts, parts, 2);
            f->outline_kept++;
        }
    }
}

static int is_drawn(const pantin_face *f, const curve *c) { return (c->flags >> 2 & 3) <= f->detail && !(c->flags & SMALL && f->detail > 0); }

/* Marks the vertices that no line needs. Large pictures and wide models need all. */
static void mark_unneeded(pantin_face *f) {
    uint8_t needed[32], i, n;
    uint16_t index;
    bytes b = whole(f->model.curves);
    if (f->detail >= 3 || f->model.wide || f->outline_overflown) return;
    memset(needed, 0, sizeof needed);
    for (i = 0; i < f->outline_kept; i++) {
        for (n = 0; n < 3; n++) needed[f->outline[i].corners[n] >> 3] |= (uint8_t)(1 << (f->outline[i].corners[n] & 7));
    }
    for (i = 0; i < f->model.curve_count; i++) {
        curve c;
        read_curve(&b, 0, &c);
        for (n = 0; n < c.count && is_drawn(f, &c); n++) {
            index = BYTE(c.indices + n);
            needed[index >> 3] |= (uint8_t)(1 << (index & 7));
            if (c.flags & MIRRORED) {
                index = mirror(&f->model, index);
                needed[index >> 3 & 31] |= (uint8_t)(1 << (index & 7));
            }
        }
    }
    for (index = 0; index < vertex_count(&f->model); index++) {
        if (!(needed[index >> 3] >> (index & 7) & 1)) f->facing[index] = NOT_DRAWN;
    }
}

/* Finds which vertices face the camera. */
static void find_facing(pantin_face *f) {
    const pantin_face_model *m = &f->model;
    int32_t angles[3], head[3][3], to[3];
    uint32_t i, stored_count = (uint32_t)m->middles + m->pairs;
    for (i = 0; i < 3; i++) angles[i] = doubled(f->rounded[i], 26);
    head_rotation(head, angles);
    row_times(f->rows[2], head, to);
    for (i = 0; i < stored_count; i++) {
        const uint8_t *at = m->normals + 3 * i;
        int32_t across = to[0] * (int8_t)BYTE(at), up = to[1] * (int8_t)BYTE(at + 1) + to[2] * (int8_t)BYTE(at + 2);
        f->facing[i] = low8((up + across) >> 15);
        if (i >= m->middles) f->facing[i + m->pairs] = low8((up - across) >> 15);
    }
    find_outline(f);
    mark_unneeded(f);
}

/* Finds the vertices on the display. */
static void place(pantin_face *f) {
    projection p;
    int32_t head[3][3], carried[3], offset[3];
    int8_t rounded[3];
    uint32_t i, from, to;
    uint8_t axis, part, all;
    for (axis = 0; axis < 3; axis++) rounded[axis] = low8(((f->head[axis] >> 25) + 1) >> 1);
    if (!(f->known & ROUNDED) || memcmp(rounded, f->rounded, 3) != 0) {
        memcpy(f->rounded, rounded, 3);
        find_facing(f);
        f->known = (uint8_t)((f->known | ROUNDED) & ~BEFORE);
    }
    all = !(f->known & BEFORE) || memcmp(f->head, f->before, sizeof f->head) != 0 || memcmp(f->pivot, f->pivot_before, sizeof f->pivot) != 0;
    memcpy(f->before, f->head, sizeof f->head);
    memcpy(f->pivot_before, f->pivot, sizeof f->pivot);
    f->known |= BEFORE;
    head_rotation(head, f->head);
    image_of(head, f->pivot, carried);
    for (axis = 0; axis < 3; axis++) offset[axis] = difference(difference(f->pivot[axis], carried[axis]), f->middle[axis]);
    set_projection(f, &p, head, offset);
    for (part = 0; part < 3 && !all; part++) {
        moving_range(&f->model, part, &from, &to);
        for (; from < to; from++) project(f, &p, from);
    }
    if (!all) return;
    for (i = 0; i < vertex_count(&f->model); i++) project(f, &p, i);
    identity(head);
    for (axis = 0; axis < 3; axis++) offset[axis] = difference(0, f->middle[axis]);
    set_projection(f, &p, head, offset);
    for (i = 0; i < f->model.fixed_count; i++) project_point(f, &p, index_at(f->model.fixed, i, f->model.wide));
}

/* ---- Pixels ---- */

/* What is drawn on. */
typedef struct paint {
    const pantin_face *f;
    uint8_t *rows;
    size_t stride;
    pantin_face_span callback;
    void *context;
    pantin_face_format format;
    int32_t top, bottom; /* rows top to bottom - 1 */
    uint16_t ink;
    uint8_t shade;
} paint;

static uint16_t colour(const paint *p, uint8_t shade) {
    const uint16_t *palette = p->f->palette;
    uint32_t light = shade, value;
    if (p->format < PANTIN_RGB565) {
        if (palette) return p->format == PANTIN_L8 ? palette[shade >> 4] & 255 : palette[shade >> 4] != 0;
        return p->format == PANTIN_L8 ? shade : shade > 0;
    }
    value = palette ? palette[shade >> 4] : ((255 * light) >> 11) << 11 | ((236 * light) >> 10) << 5 | (205 * light) >> 11;
    return (uint16_t)(p->format == PANTIN_RGB565 ? value : value << 8 | value >> 8);
}

static void fill_bits(const paint *p, uint8_t *row, int32_t from, int32_t to) {
    uint8_t lowest = p->format == PANTIN_I1_LSB;
    uint8_t *at = row + (from >> 3), *last = row + (to >> 3);
    uint8_t head = (uint8_t)(lowest ? 255u << (from & 7) : 255u >> (from & 7));
    uint8_t tail = (uint8_t)(lowest ? 255u >> (7 - (to & 7)) : 255u << (7 - (to & 7)));
    for (; at <= last; at++) {
        uint8_t mask = head;
        if (at == last) mask &= tail;
        *at = (uint8_t)(p->ink ? *at | mask : *at & ~mask);
        head = 255;
    }
}

/* Sets pixels from column `from` to column `to`, which belongs to them, of a row that is drawn. */
static void span(const paint *p, int32_t y, int32_t from, int32_t to) {
    uint8_t *row;
    from = most(from, 0);
    to = least(to, (int32_t)p->f->width - 1);
    if (from > to) return;
    if (p->callback) {
        p->callback(p->context, (uint16_t)from, (uint16_t)y, (uint16_t)(to - from + 1), p->shade);
        return;
    }
    row = p->rows + (size_t)(y - p->top) * p->stride;
    if (p->format == PANTIN_L8) {
        memset(row + from, p->ink, (size_t)(to - from + 1));
    } else if (p->format < PANTIN_L8) {
        fill_bits(p, row, from, to);
    } else {
        uint16_t *at = (uint16_t *)(void *)row + from;
        int32_t left = to - from + 1;
        for (; left >= 4; left -= 4, at += 4) at[0] = at[1] = at[2] = at[3] = p->ink;
        for (; left > 0; left--) *at++ = p->ink;
    }
}

/* Draws a line a pixel wide, ends in sixteenths of a pixel: Bresenham's, from the end with the lower coordinate along its longer way. */
static void line(const paint *p, const int16_t *from, const int16_t *to) {
    int32_t a[2], b[2], step, rise, fall, rest, start, cross;
    uint8_t axis, steep, back;
    int32_t far, start_x;
    for (axis = 0; axis < 2; axis++) {
        a[axis] = from[axis] >> 4;
        b[axis] = to[axis] >> 4;
    }
    if (most(a[1], b[1]) < p->top || least(a[1], b[1]) >= p->bottom || most(a[0], b[0]) < 0 || least(a[0], b[0]) >= p->f->width) return;
    steep = size_of(b[1] - a[1]) > size_of(b[0] - a[0]);
    if (a[steep] > b[steep]) {
        for (axis = 0; axis < 2; axis++) {
            int32_t swap = a[axis];
            a[axis] = b[axis];
            b[axis] = swap;
        }
    }
    far = b[steep] - a[steep];
    back = b[!steep] < a[!steep];
    rise = 2 * size_of(b[!steep] - a[!steep]);
    fall = 2 * far;
    /* The first step on the rows of a steep line, on the columns of another. */
    start = steep ? most(p->top - a[1], 0) : most(-a[0], 0);
    far = least(far, steep ? p->bottom - 1 - a[1] : (int32_t)p->f->width - 1 - a[0]);
    rest = rise * start + (fall >> 1);
    cross = fall ? rest / fall : 0;
    rest -= cross * fall;
    cross = back ? a[!steep] - cross : a[!steep] + cross;
    for (step = start_x = start; step <= far; step++) {
        int32_t at = cross;
        rest += rise;
        if (rest >= fall) {
            rest -= fall;
            cross += back ? -1 : 1;
        }
        if (steep) {
            span(p, a[1] + step, at, at);
        } else if (at != cross || step == far) {
            if (at >= p->top && at < p->bottom) span(p, at, a[0] + start_x, a[0] + step);
            start_x = step + 1;
        }
    }
}

/* ---- Polygons ---- */

typedef struct polygon {
    int16_t at[CORNERS][2];
    uint8_t count;
} polygon;

/* Where the edge between two corners crosses the middle of a row. */
static int16_t crossing(const int16_t *from, const int16_t *to, int32_t height) {
    int32_t across = product(to[0] - from[0], height - from[1]), down = to[1] - from[1];
    if (down == -1 && across == -NEVER - 1) return from[0];
    return low16(sum(from[0], across / down));
}

/* Finds the edges that a height crosses, by the index of their first corner. Returns the height of the next corner below it. */
static int32_t find_edges(const polygon *g, int32_t height, uint8_t *edges, uint8_t *count) {
    int32_t until = NEVER;
    uint8_t i, found = 0, above = g->at[0][1] <= height;
    for (i = 0; i < g->count; i++) {
        uint8_t next = (uint8_t)(i + 1 < g->count ? i + 1 : 0), next_above = g->at[next][1] <= height;
        if (g->at[i][1] > height) until = least(until, g->at[i][1]);
        if (above != next_above && found < CROSSINGS) edges[found++] = i;
        above = next_above;
    }
    *count = found;
    return until;
}

/* Fills the rows whose middle is inside: between the first and the second edge that crosses it, the third and the fourth, and so on. */
static void fill(const paint *p, const polygon *g) {
    int32_t low = NEVER, high = -NEVER, row, last, until;
    uint8_t edges[CROSSINGS], count, i, j;
    for (i = 0; i < g->count; i++) {
        low = least(low, g->at[i][1]);
        high = most(high, g->at[i][1]);
    }
    row = most(low >> 4, p->top);
    last = least(high >> 4, p->bottom - 1);
    while (row <= last) {
        until = find_edges(g, row * 16 + 8, edges, &count);
        for (; row <= last && row * 16 + 8 < until; row++) {
            int16_t at[CROSSINGS];
            for (i = 0; i < count; i++) {
                const int16_t *from = g->at[edges[i]], *to = g->at[edges[i] + 1 < g->count ? edges[i] + 1 : 0];
                int16_t x = crossing(from, to, row * 16 + 8);
                for (j = i; j > 0 && at[j - 1] > x; j--) at[j] = at[j - 1];
                at[j] = x;
            }
            for (i = 0; i + 1 < count; i = (uint8_t)(i + 2)) span(p, row, at[i] >> 4, at[i + 1] >> 4);
        }
    }
}

/* ---- Strokes ---- */

/* A vertex on the display. */
typedef struct screen_vertex {
    int16_t at[2];
    int8_t facing;
} screen_vertex;

static void begin(paint *p, uint8_t shade) {
    p->shade = shade;
    p->ink = colour(p, shade);
}

static void get_vertex(const pantin_face *f, uint16_t index, screen_vertex *v) {
    v->at[0] = f->points[index][0];
    v->at[1] = f->points[index][1];
    v->facing = f->facing[index];
}

/* Draws the part of a line that faces the camera. */
static void visible(const paint *p, const screen_vertex *from, const screen_vertex *to) {
    const screen_vertex *near = from->facing > GRAZING ? from : to, *far = near == from ? to : from;
    int16_t end[2];
    if (near->facing <= GRAZING) return;
    if (far->facing > GRAZING) {
        line(p, from->at, to->at);
        return;
    }
    between(near->at, far->at, zero_crossing(near->facing - GRAZING, far->facing - GRAZING), end);
    line(p, near->at, end);
}

/* Weights (128ths) of four vertices for the points between the second and the third: one point, or three. */
static const int8_t fine_points[4][4] = {{-8, 72, 72, -8}, {-9, 111, 29, -3}, {-8, 72, 72, -8}, {-3, 29, 111, -9}};

static void blend(const screen_vertex *ends, const int8_t *weights, screen_vertex *to) {
    int32_t a = ends[1].facing, b = ends[2].facing, quarters = weights[1] > weights[2] ? 1 : 3 - (weights[1] == weights[2]);
    uint8_t axis, i;
    for (axis = 0; axis < 2; axis++) {
        int32_t total = 64;
        for (i = 0; i < 4; i++) total += (int32_t)ends[i].at[axis] * weights[i];
        to->at[axis] = low16(total >> 7);
    }
    to->facing = low8(a + (((b - a) * quarters) >> 2));
}

/* The vertex at a position of a curve, which can lie past its end. */
static void curve_vertex(const pantin_face *f, const curve *c, uint8_t mirrored, uint16_t position, screen_vertex *v) {
    uint16_t index;
    if (position >= c->count) position = (uint16_t)(c->flags & CLOSED ? position - c->count : c->count - 1);
    index = position < c->count ? index_at(c->indices, position, f->model.wide) : 0;
    get_vertex(f, mirrored ? mirror(&f->model, index) : index, v);
}

/* Draws a curve; a filled one gathers its corners first. */
static void draw_curve(const paint *p, const curve *c, uint8_t mirrored, uint8_t detail) {
    const pantin_face *f = p->f;
    const int8_t(*fine)[4] = detail > 1 ? fine_points + 1 : fine_points;
    uint8_t points = (uint8_t)(c->flags & STRAIGHT || detail == 0 ? 0 : detail == 1 ? 1 : 3), filled = c->flags & FILLED, i;
    uint16_t segment, segments = (uint16_t)(c->flags & CLOSED ? c->count : c->count - 1);
    screen_vertex ends[4], last, next;
    polygon corners;
    corners.count = 0;
    curve_vertex(f, c, mirrored, (uint16_t)(c->flags & CLOSED ? c->count - 1 : 0), &ends[0]);
    for (i = 1; i < 4; i++) curve_vertex(f, c, mirrored, (uint16_t)(i - 1), &ends[i]);
    if (filled && ends[1].facing <= GRAZING) return;
    for (segment = 0; segment < segments; segment++) {
        last = ends[1];
        if (filled && corners.count < CORNERS) memcpy(corners.at[corners.count++], last.at, sizeof last.at);
        if (filled || ends[1].facing > GRAZING || ends[2].facing > GRAZING) {
            for (i = 0; i < points; i++) {
                blend(ends, fine[i], &next);
                if (!filled) visible(p, &last, &next);
                if (filled && corners.count < CORNERS) memcpy(corners.at[corners.count++], next.at, sizeof next.at);
                last = next;
            }
            if (!filled) visible(p, &last, &ends[2]);
        }
        memmove(ends, ends + 1, 3 * sizeof *ends);
        curve_vertex(f, c, mirrored, (uint16_t)(segment + 3), &ends[3]);
    }
    if (filled) fill(p, &corners);
}

/* Whether a curve can have pixels in the rows: points between vertices lie at most an eighth of its height beyond them. */
static int in_rows(const paint *p, const curve *c, uint8_t mirrored) {
    const pantin_face *f = p->f;
    int32_t low = NEVER, high = -NEVER, beyond;
    uint8_t i;
    for (i = 0; i < c->count; i++) {
        uint16_t index = index_at(c->indices, i, f->model.wide);
        int32_t y = f->points[mirrored ? mirror(&f->model, index) : index][1];
        low = least(low, y);
        high = most(high, y);
    }
    /* A closed curve of two vertices also uses the model's first vertex. */
    if (c->count < 3) return 1;
    beyond = ((high - low) >> 3) + 32;
    return (high + beyond) >> 4 >= p->top && (low - beyond) >> 4 < p->bottom;
}

static void draw_mesh(paint *p) {
    const pantin_face *f = p->f;
    uint32_t i;
    uint8_t mirrored, n;
    begin(p, 44);
    for (i = 0; i < f->model.triangle_count; i++) {
        for (mirrored = 0; mirrored < (f->model.pairs ? 2 : 1); mirrored++) {
            uint16_t corners[3];
            screen_vertex ends[3];
            triangle(&f->model, i, mirrored, corners);
            for (n = 0; n < 3; n++) get_vertex(f, corners[n], &ends[n]);
            /* The other one of the two triangles of an edge draws it. */
            for (n = 0; n < 3; n++) {
                uint8_t to = (uint8_t)(n == 2 ? 0 : n + 1);
                if (corners[n] < corners[to]) visible(p, &ends[n], &ends[to]);
            }
        }
    }
}

static void draw_crossed(const paint *p, const uint16_t *corners, const uint8_t *parts) {
    int16_t (*points)[2] = p->f->points, from[2], to[2];
    between(points[corners[0]], points[corners[1]], parts[0], from);
    between(points[corners[0]], points[corners[2]], parts[1], to);
    line(p, from, to);
}

static void draw_outline(paint *p) {
    const pantin_face *f = p->f;
    uint32_t i;
    uint16_t corners[3];
    uint8_t mirrored, n, parts[2];
    begin(p, 200);
    for (i = 0; i < f->outline_kept && !f->outline_overflown; i++) {
        for (n = 0; n < 3; n++) corners[n] = f->outline[i].corners[n];
        draw_crossed(p, corners, f->outline[i].parts);
    }
    for (i = 0; i < f->model.outline_count && f->outline_overflown; i++) {
        for (mirrored = 0; mirrored < (f->model.pairs ? 2 : 1); mirrored++) {
            triangle(&f->model, i, mirrored, corners);
            if (crossed(f, corners, parts)) draw_crossed(p, corners, parts);
        }
    }
}

static void draw_all(paint *p) {
    const pantin_face *f = p->f;
    bytes b = whole(f->model.curves);
    uint8_t i, mirrored;
    if (f->detail >= 3) draw_mesh(p);
    draw_outline(p);
    for (i = 0; i < f->model.curve_count; i++) {
        curve c;
        read_curve(&b, f->model.wide, &c);
        if (!is_drawn(f, &c)) continue;
        begin(p, c.shade);
        for (mirrored = 0; mirrored < (c.flags & MIRRORED ? 2 : 1); mirrored++) {
            if (in_rows(p, &c, mirrored)) draw_curve(p, &c, mirrored, f->detail);
        }
    }
}

/* ---- Emotes, eyes and mouth ---- */

/* The emote's own weights: sums are used from -1 to 1. */
static void read_pose(pantin_face *f) {
    uint16_t i;
    uint8_t side;
    memset(f->weights, 0, f->model.shape_count * sizeof *f->weights);
    if (!f->playing) return;
    for (i = 0; i < f->drive_count; i++) {
        const pantin_face_drive *d = f->drives + i;
        int32_t raw = f->player.pose[d->channel] >> 16;
        if (raw) add_weight(f->weights, d->target, shifted(raw * d->mantissa, d->shift));
    }
    for (i = 0; i < f->model.shape_count; i++) {
        for (side = 0; side < 2; side++) f->weights[i][side] = (int16_t)clamp(f->weights[i][side], -16384, 16384);
    }
}

/* Adds what is left of the difference to the emote before. */
static void add_transition(pantin_face *f) {
    int32_t t, left;
    uint8_t i, side;
    if (f->since_ms >= f->transition_ms) return;
    t = (int32_t)((uint32_t)f->since_ms * (uint32_t)ONE / f->transition_ms);
    /* 3 t^2 - 2 t^3 is at most 1: the product fits 31 bits. */
    left = ONE - ((((t * t) >> 15) * (3 * ONE - 2 * t)) >> 15);
    for (i = 0; i < f->model.shape_count; i++) {
        for (side = 0; side < 2; side++) f->weights[i][side] = narrow(f->weights[i][side] + ((f->offset[i][side] * left) >> 15));
    }
}

static const char *const viseme_names[14] = {"viseme_pp", "viseme_ff", "viseme_th", "viseme_dd", "viseme_kk", "viseme_ch", "viseme_ss",
                                             "viseme_nn", "viseme_rr", "viseme_aa", "viseme_e",  "viseme_i",  "viseme_o",  "viseme_u"};

/* Notes what visemes move. */
static void note_spoken(pantin_face *f) {
    uint32_t hash, i;
    uint8_t viseme;
    for (viseme = 0; viseme < 14; viseme++) {
        if (!find_name(&f->model, viseme_names[viseme], &hash)) continue;
        for (i = 0; i < f->model.name_count; i++) {
            const uint8_t *at = f->model.names + i * NAME_BYTES;
            uint8_t target = BYTE(at + 4);
            if (u16_at(at) == (hash & 0xffff) && u16_at(at + 2) == hash >> 16) f->spoken[target & 63] |= target >> 6;
        }
    }
}

/* The emote gives way to speech. */
static void give_way(pantin_face *f) {
    uint8_t i, side;
    if (f->speaking == 0) return;
    for (i = 0; i < f->model.shape_count; i++) {
        for (side = 0; side < 2; side++) {
            int32_t weight = clamp(f->weights[i][side], -16384, 16384);
            if (f->spoken[i] >> side & 1) f->weights[i][side] = (int16_t)(weight - ((weight * f->speaking) >> 15));
        }
    }
}

/* Lids go down in 60 ms, stay for 30 ms and go up in 90 ms. */
#define BLINK_MS 180

static int32_t blink_weight(const pantin_face *f) {
    if (f->blink_ms == 0 || f->blink_ms >= BLINK_MS) return 0;
    if (f->blink_ms < 60) return f->blink_ms * FULL / 60;
    return f->blink_ms < 90 ? FULL : (BLINK_MS - f->blink_ms) * FULL / 90;
}

/* The weights that are shown. */
static void compose(pantin_face *f) {
    int32_t look[2];
    uint8_t i, side, speaks = 0;
    read_pose(f);
    add_transition(f);
    give_way(f);
    for (i = 0; i < f->model.shape_count; i++) {
        for (side = 0; side < 2; side++) f->weights[i][side] = narrow((int32_t)f->weights[i][side] + f->own[i][side]);
    }
    for (i = 0; i < 14; i++) {
        if (f->visemes[i] == 0) continue;
        speaks = 1;
        add_name(f, viseme_names[i], f->visemes[i] * 2);
    }
    if (!speaks) add_name(f, viseme_names[9], f->mouth * 2);
    for (side = 0; side < 2; side++) {
        int32_t moved = f->glance_ms >= 50 ? f->glance[side] : f->glance_from[side] + (f->glance[side] - f->glance_from[side]) * f->glance_ms / 50;
        look[side] = clamp((f->look[side] + moved) * 2, -FULL, FULL);
    }
    add_name(f, "look_left", look[0]);
    add_name(f, look[1] > 0 ? "look_up" : "look_down", size_of(look[1]));
    add_name(f, "blink", blink_weight(f));
}

/* Brings weights, vertices and points up to date. */
static void prepare(pantin_face *f) {
    if (f->known & FRESH) return;
    compose(f);
    morph(f);
    place(f);
    f->known |= FRESH;
}

static uint32_t random_below(pantin_face *f, uint32_t below) {
    f->random = f->random * 1664525u + 1013904223u;
    return (f->random >> 16) * below >> 16;
}

static void live_for(pantin_face *f, uint16_t ms) {
    if (f->blink_ms) f->blink_ms = (uint8_t)(f->blink_ms + ms < BLINK_MS ? f->blink_ms + ms : 0);
    if (f->glance_ms < 50) f->glance_ms = (uint16_t)least(f->glance_ms + ms, 50);
    if (!f->live) return;
    if (f->next_blink_ms > ms) {
        f->next_blink_ms = (uint16_t)(f->next_blink_ms - ms);
    } else {
        f->blink_ms = 1;
        /* One of eight blinks is double. */
        f->next_blink_ms = (uint16_t)(random_below(f, 8) ? 2000 + random_below(f, 4000) : 300);
    }
    if (f->next_glance_ms > ms) {
        f->next_glance_ms = (uint16_t)(f->next_glance_ms - ms);
    } else {
        memcpy(f->glance_from, f->glance, sizeof f->glance);
        f->glance[0] = (int16_t)((int32_t)random_below(f, 5000) - 2500);
        f->glance[1] = (int16_t)((int32_t)random_below(f, 3000) - 1500);
        f->glance_ms = 0;
        f->next_glance_ms = (uint16_t)(700 + random_below(f, 2600));
    }
}

/* ---- Functions for the program ---- */

/* The memory that a model needs, and where its parts lie. */
static uint32_t lend(pantin_face *f, uint32_t *memory) {
    uint32_t vertices = vertex_count(&f->model), pairs = f->model.shape_count * 4u;
    uint8_t *at = (uint8_t *)memory;
    uint32_t used_bytes = 3 * pairs + vertices * 11 + (f->model.outline_count && !f->model.wide ? PANTIN_FACE_OUTLINE * 5u : 0);
    if (memory) {
        f->weights = (int16_t(*)[2])(void *)at;
        f->own = (int16_t(*)[2])(void *)(at + pairs);
        f->offset = (int16_t(*)[2])(void *)(at + 2 * pairs);
        at += 3 * pairs;
        f->points = (int16_t(*)[2])(void *)at;
        f->vertices = (int16_t(*)[3])(void *)(at + vertices * 4);
        f->facing = (int8_t *)(at + vertices * 10);
        f->outline = (pantin_face_crossed *)(void *)(at + vertices * 11);
    }
    return (used_bytes + 3) & ~(uint32_t)3;
}

pantin_result pantin_face_open(pantin_face *face, const uint8_t *model, uint32_t length, uint32_t *memory, size_t size) {
    pantin_result result;
    uint32_t i;
    memset(face, 0, sizeof *face);
    result = read_model(&face->model, model, length);
    face->needed = result == PANTIN_OK ? lend(face, NULL) : 0;
    if (result == PANTIN_OK && (!memory || size < face->needed)) result = PANTIN_NO_ROOM;
    if (result != PANTIN_OK) {
        memset(&face->model, 0, sizeof face->model);
        return result;
    }
    memset(memory, 0, face->needed);
    lend(face, memory);
    face->rest = memory + face->needed / 4;
    face->rest_bytes = (uint32_t)(size - face->needed);
    face->transition_ms = face->since_ms = 300;
    face->glance_ms = 50;
    for (i = 0; i < vertex_count(&face->model); i++) neutral(&face->model, i, face->vertices[i]);
    note_spoken(face);
    pantin_face_aim(face, 0, 0);
    return PANTIN_OK;
}

static int32_t fit(int32_t available, int32_t size) { return (doubled(least(available, 65536L), 14) / size) * 4; }

pantin_result pantin_face_size(pantin_face *face, uint16_t width, uint16_t height) {
    static const uint8_t details[3] = {96, 150, 190};
    int32_t low[3], high[3], tall, wide, columns = (int32_t)width * 16, rows = (int32_t)height * 16, scale, covered;
    uint32_t i;
    uint8_t axis, excess = 0;
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    if (width == 0 || height == 0 || width > 2047 || height > 2047) return PANTIN_NOT_FOUND;
    for (i = 0; i < (uint32_t)face->model.middles + face->model.pairs; i++) {
        int16_t point[3];
        neutral(&face->model, i, point);
        for (axis = 0; axis < 3; axis++) {
            low[axis] = i ? least(low[axis], point[axis]) : point[axis];
            high[axis] = i ? most(high[axis], point[axis]) : point[axis];
        }
    }
    tall = most(high[1] - low[1], 1);
    wide = most(2 * most(high[0], -low[0]), 1);
    scale = clamp(least(fit(rows * 60 / 64, tall), fit(columns, wide)), 1, ONE << 5);
    while (scale >> (15 + excess)) excess++;
    covered = product(tall >> 4, scale >> 4) >> 12;
    face->width = width;
    face->height = height;
    face->centre[0] = columns / 2;
    face->centre[1] = rows / 2;
    face->shifted[0] = face->shifted[1] = 0;
    face->scale = scale >> excess;
    face->shift = (uint8_t)(16 - excess);
    face->nearer = least((ONE << 13) / (tall * 4), ONE >> 1);
    face->middle[0] = face->middle[2] = 0;
    face->middle[1] = high[1] - tall / 60 * 31;
    for (face->detail = 0; face->detail < 3 && covered >= details[face->detail];) face->detail++;
    face->known = 0;
    return PANTIN_OK;
}

pantin_result pantin_face_shift(pantin_face *face, int16_t x, int16_t y) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    if (x < -1023 || x > 1023 || y < -1023 || y > 1023) return PANTIN_NOT_FOUND;
    face->centre[0] += (x - face->shifted[0]) * 16;
    face->centre[1] += (y - face->shifted[1]) * 16;
    face->shifted[0] = x;
    face->shifted[1] = y;
    face->known &= ROUNDED;
    return PANTIN_OK;
}

pantin_result pantin_face_aim(pantin_face *face, int16_t orbit, int16_t tilt) {
    int32_t r[3][3];
    uint8_t row, axis;
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    identity(r);
    turn(r, 0, product(tilt, 11930465));
    turn(r, 1, product(-(int32_t)orbit, 11930465));
    for (row = 0; row < 3; row++) {
        for (axis = 0; axis < 3; axis++) face->rows[row][axis] = r[axis][row];
    }
    face->known = 0;
    return PANTIN_OK;
}

pantin_result pantin_face_palette(pantin_face *face, const uint16_t *palette) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->palette = palette;
    return PANTIN_OK;
}

pantin_result pantin_face_emotes(pantin_face *face, const pantin_emote *emotes, uint16_t count) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->emotes = emotes;
    face->emote_count = count;
    return PANTIN_OK;
}

/* Finds what a clip's scalars drive, and keeps it in `drives`, which may be NULL. Returns the number of drives. */
static uint32_t bind(const pantin_face_model *m, const pantin_rig *rig, pantin_face_drive *drives) {
    pantin_scalar scalar;
    uint32_t count = 0, i;
    pantin_first_scalar(&scalar, rig);
    while (pantin_next_scalar(&scalar)) {
        uint32_t hash = HASH_START;
        for (i = 0; i < scalar.name.length; i++) hash = (hash ^ pantin_name_byte(&scalar.name, i)) * HASH_FACTOR;
        for (i = 0; i < m->name_count; i++) {
            const uint8_t *at = m->names + i * NAME_BYTES;
            if (u16_at(at) != (hash & 0xffff) || u16_at(at + 2) != hash >> 16) continue;
            if (drives) {
                drives[count].channel = scalar.channel;
                drives[count].target = BYTE(at + 4);
                drives[count].mantissa = (int8_t)BYTE(at + 5);
                drives[count].shift = (int8_t)clamp((int32_t)scalar.exponent + (int8_t)BYTE(at + 6), -128, 127);
            }
            count++;
        }
    }
    return count;
}

pantin_result pantin_face_play(pantin_face *face, const uint8_t *clip, uint32_t length) {
    pantin_source source;
    pantin_clip opened;
    pantin_result result;
    uint32_t channels, moving, count, i;
    uint8_t side;
    int16_t (*swap)[2];
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    pantin_memory(&source, clip, length);
    result = pantin_open(&opened, &source, NULL);
    if (result != PANTIN_OK) return result;
    channels = opened.rig.channels;
    count = bind(&face->model, &opened.rig, NULL);
    if (count == 0) return PANTIN_NOT_FOUND;
    moving = channels;
#ifdef PANTIN_KEYS
    /* A key clip has states beside its channels. */
    if (opened.states > channels) moving = opened.states;
#endif
    i = channels * (uint32_t)sizeof(int32_t) + moving * (uint32_t)sizeof(pantin_channel) + count * (uint32_t)sizeof(pantin_face_drive);
    if (count > 0xffff || i > face->rest_bytes) {
        face->needed = lend(face, NULL) + i;
        return PANTIN_NO_ROOM;
    }
    /* What is shown now is where the transition begins. */
    read_pose(face);
    add_transition(face);
    swap = face->weights;
    face->weights = face->offset;
    face->offset = swap;
    pantin_memory(&face->source, clip, length);
    face->playing = 0;
    face->finished = 0;
    face->clock_ns = 0;
    face->since_ms = 0;
    face->known &= BEFORE | ROUNDED;
    result = pantin_open(&face->clip, &face->source, NULL);
    if (result == PANTIN_OK) {
        uint8_t *at = (uint8_t *)face->rest;
        pantin_channel *states = (pantin_channel *)(void *)(at + channels * sizeof(int32_t));
        face->drives = (pantin_face_drive *)(void *)(states + moving);
        face->drive_count = (uint16_t)bind(&face->model, &face->clip.rig, face->drives);
        result = pantin_start(&face->player, &face->clip, (int32_t *)face->rest, channels, states, moving);
        face->playing = result == PANTIN_OK;
    }
    read_pose(face);
    for (i = 0; i < face->model.shape_count; i++) {
        for (side = 0; side < 2; side++) {
            int32_t before = clamp(face->offset[i][side], -16384, 16384);
            face->offset[i][side] = narrow(before - face->weights[i][side]);
        }
    }
    return result;
}

pantin_result pantin_face_emote(pantin_face *face, const char *name) {
    uint16_t i;
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    for (i = 0; name && i < face->emote_count; i++) {
        if (strcmp(face->emotes[i].name, name) == 0) return pantin_face_play(face, face->emotes[i].bytes, face->emotes[i].length);
    }
    return PANTIN_NOT_FOUND;
}

pantin_result pantin_face_transition(pantin_face *face, uint16_t ms) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->transition_ms = ms;
    return PANTIN_OK;
}

pantin_result pantin_face_weight(pantin_face *face, const char *name, int32_t weight) {
    uint32_t hash;
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    if (!name || !find_name(&face->model, name, &hash)) return PANTIN_NOT_FOUND;
    drive_name(&face->model, face->own, hash, weight, 1);
    face->known &= BEFORE | ROUNDED;
    return PANTIN_OK;
}

pantin_result pantin_face_look(pantin_face *face, int32_t x, int32_t y) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->look[0] = stored(clamp(x, -FULL, FULL));
    face->look[1] = stored(clamp(y, -FULL, FULL));
    face->known &= BEFORE | ROUNDED;
    return PANTIN_OK;
}

pantin_result pantin_face_mouth(pantin_face *face, int32_t level) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->mouth = stored(clamp(level, 0, FULL));
    face->known &= BEFORE | ROUNDED;
    return PANTIN_OK;
}

pantin_result pantin_face_viseme(pantin_face *face, uint8_t viseme, int32_t weight) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    if (viseme > 14) return PANTIN_NOT_FOUND;
    if (viseme == 0) {
        memset(face->visemes, 0, sizeof face->visemes);
    } else {
        face->visemes[viseme - 1] = stored(clamp(weight, -FULL, FULL));
    }
    face->known &= BEFORE | ROUNDED;
    return PANTIN_OK;
}

pantin_result pantin_face_speaking(pantin_face *face, int32_t weight) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->speaking = (uint16_t)clamp(weight, 0, FULL);
    face->known &= BEFORE | ROUNDED;
    return PANTIN_OK;
}

pantin_result pantin_face_live(pantin_face *face, uint32_t seed) {
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->live = seed != 0;
    face->random = seed;
    memcpy(face->glance_from, face->glance, sizeof face->glance);
    memset(face->glance, 0, sizeof face->glance);
    face->glance_ms = 0;
    face->next_blink_ms = (uint16_t)(500 + random_below(face, 2000));
    face->next_glance_ms = (uint16_t)(500 + random_below(face, 1500));
    return PANTIN_OK;
}

/* Frames of a clip that a call shows at most: clips of more than 1000 frames a second fall behind. */
#define MOST_FRAMES 1000

pantin_result pantin_face_step(pantin_face *face, uint16_t ms) {
    uint32_t left = ms, frames = 0;
    if (!face->vertices) return PANTIN_ERROR_HEAD;
    face->since_ms = (uint16_t)least((int32_t)face->since_ms + ms, 0xffff);
    live_for(face, ms);
    face->known &= BEFORE | ROUNDED;
    while (left && face->playing && !face->finished) {
        /* At most 4 * 10^9 ns fit 32 bits. */
        uint32_t part = left < 4000 ? left : 4000, ns = part * 1000000u;
        left -= part;
        while (ns && frames < MOST_FRAMES) {
            uint32_t until = face->clip.frame_time_ns - face->clock_ns;
            pantin_result result;
            if (ns < until) {
                face->clock_ns += ns;
                break;
            }
            ns -= until;
            face->clock_ns = 0;
            frames++;
            result = pantin_step(&face->player);
            if (result == PANTIN_END && face->clip.looped) result = pantin_restart(&face->player);
            if (result == PANTIN_END) {
                face->finished = 1;
                break;
            }
            if (result != PANTIN_OK) {
                face->playing = 0;
                return result;
            }
        }
    }
    return PANTIN_OK;
}

static pantin_result check_rows(const pantin_face *face, uint16_t y0, uint16_t y1) {
    if (!face->vertices || face->width == 0) return PANTIN_ERROR_HEAD;
    return y0 > y1 || y1 > face->height ? PANTIN_NOT_FOUND : PANTIN_OK;
}

pantin_result pantin_face_draw(pantin_face *face, pantin_face_format format, void *rows, size_t stride, uint16_t y0, uint16_t y1) {
    pantin_result result = check_rows(face, y0, y1);
    size_t bytes_of_row;
    paint p;
    uint16_t y;
    if (result != PANTIN_OK) return result;
    if ((unsigned)format > PANTIN_RGB565_SWAPPED) return PANTIN_NOT_FOUND;
    bytes_of_row = format < PANTIN_L8 ? (face->width + 7u) / 8 : format == PANTIN_L8 ? face->width : face->width * 2u;
    if (stride < bytes_of_row) return PANTIN_NO_ROOM;
    if (y0 == y1) return PANTIN_OK;
    prepare(face);
    memset(&p, 0, sizeof p);
    p.f = face;
    p.rows = (uint8_t *)rows;
    p.stride = stride;
    p.format = format;
    p.top = y0;
    p.bottom = y1;
    begin(&p, 0);
    if ((p.ink & 255) == p.ink >> 8 || format < PANTIN_RGB565) {
        uint8_t with = (uint8_t)(format < PANTIN_L8 && p.ink ? 255 : p.ink);
        for (y = y0; y < y1; y++) memset(p.rows + (size_t)(y - y0) * stride, with, bytes_of_row);
    } else {
        for (y = y0; y < y1; y++) span(&p, y, 0, face->width - 1);
    }
    draw_all(&p);
    return PANTIN_OK;
}

pantin_result pantin_face_spans(pantin_face *face, pantin_face_span callback, void *context, uint16_t y0, uint16_t y1) {
    pantin_result result = check_rows(face, y0, y1);
    paint p;
    if (result != PANTIN_OK) return result;
    prepare(face);
    memset(&p, 0, sizeof p);
    p.f = face;
    p.callback = callback;
    p.context = context;
    p.top = y0;
    p.bottom = y1;
    draw_all(&p);
    return PANTIN_OK;
}
