/* The animator: see pantin_animator.h.
 *
 * The steps and the rounding are those of the crate pantin-animator. Sums that wrap there are taken on unsigned numbers. The right shift of a negative
 * number is taken to round down, as in pantin_figure.c. */
#include "pantin_animator_parts.h"
#include "pantin_parts.h"
#include "pantin_turn_parts.h"

#ifdef PANTIN_KEYS
#include "pantin_keys.h"
#endif

#define ONE_Q30 0x40000000L
#define HALF_TURN ((int32_t)(-0x7fffffffL - 1))
#define LEAST_VALUE (-0x7fffffffL)
#define MOST_LAPS 64
#define NO_CHANNEL 0xffffu
/* A loop whose root comes back to within this stays in its place, or keeps its heading: 5 cm and 5 degrees. */
#define RETURNS_CM 5
#define RETURNS_TURN 59652323u
/* An eighth of a turn: a rotation farther from frame 0 turns on from lap to lap. */
#define FAR_TURN 0x20000000u

/* Why a track is stale: its player has to be started again, and a transition has ended by that. */
enum { STALE = 1, STALE_AND_ENDED };

/* ---- Numbers ---- */

static int32_t sum(int32_t a, int32_t b) { return (int32_t)((uint32_t)a + (uint32_t)b); }
static int32_t difference(int32_t a, int32_t b) { return (int32_t)((uint32_t)a - (uint32_t)b); }
static int32_t times(int32_t a, int32_t b) { return (int32_t)((uint32_t)a * (uint32_t)b); }
static int64_t wide_sum(int64_t a, int64_t b) { return (int64_t)((uint64_t)a + (uint64_t)b); }
static uint32_t size_of(int32_t x) { return x < 0 ? 0u - (uint32_t)x : (uint32_t)x; }
static uint64_t wide_size(int64_t x) { return x < 0 ? 0u - (uint64_t)x : (uint64_t)x; }
static int64_t clamp(int64_t x, int64_t low, int64_t high) { return x < low ? low : x > high ? high : x; }

/* Rounded down, as remainders are at least 0. */
static int64_t quotient(int64_t a, int64_t b) { return a / b - (a % b < 0); }

uint64_t pantin_animator_root(uint64_t square) {
    uint64_t root = 0, bit = (uint64_t)1 << 62;
    while (bit > square) bit >>= 2;
    for (; bit; bit >>= 2) {
        uint64_t next = root + bit;
        root >>= 1;
        if (square >= next) {
            square -= next;
            root += bit;
        }
    }
    return root;
}

/* The length of up to three numbers, below 2^32. */
static int64_t length_of(const int32_t *v, uint8_t count) {
    uint64_t square = 0;
    while (count-- > 0) {
        uint64_t part = (uint64_t)size_of(v[count]) * size_of(v[count]);
        square = square + part < square ? ~(uint64_t)0 : square + part;
    }
    return (int64_t)pantin_animator_root(square);
}

/* A difference times a weight of 0 to 2^15, rounded down. */
static int32_t weighted(int32_t x, uint16_t weight) {
    uint32_t low = (uint32_t)x & 0xffff;
    return sum((x >> 16) * weight * 2, (int32_t)((low * weight) >> 15));
}

/* A velocity times a factor in 2^-16. */
static int32_t scaled(int32_t v, int64_t factor) { return factor == 65536 ? v : (int32_t)(uint32_t)(uint64_t)((v * factor) >> 16); }

/* ---- Groups of channels ---- */

static uint8_t family_of(uint8_t kind) {
    if (kind < PANTIN_EULER_X || kind == PANTIN_SCALAR) return 4;
    return kind < PANTIN_QUATERNION_W ? 1 : kind < PANTIN_EXPONENTIAL_X ? 2 : 3;
}

static void push_group(const pantin_animator_memory *m, uint16_t *count, const pantin_group *group) {
    if (!group->length) return;
    if (*count < m->group_room) m->groups[*count] = *group;
    ++*count;
}

/* Closes a run of channels of one family. */
static void close_run(pantin_group *run, uint8_t family, uint8_t exponential, uint8_t is_order) {
    run->shape = PANTIN_FREE;
    if (family == 1 && run->length == 3) run->shape = exponential ? PANTIN_MAP : is_order ? PANTIN_EULER : PANTIN_FREE;
    if (family == 2 && run->length == 4) run->shape = PANTIN_UNIT;
    if (family == 3 && run->length == 3) run->shape = PANTIN_MAP;
}

static pantin_result find_groups(pantin_animator *a, const pantin_clip *clip) {
    const pantin_animator_memory *m = a->memory;
    const pantin_rig *rig = &clip->rig;
    pantin_joint joint;
    pantin_group run;
    uint16_t count = 0, i;
    pantin_first_joint(&joint, rig);
    while (pantin_next_joint(&joint)) {
        uint8_t axes = 0, turns = 0, family = 0, exponential, c;
        for (c = 0; c < joint.channels; c++) {
            uint8_t kind = pantin_joint_kind(&joint, c);
            if (family_of(kind) != 1) continue;
            if (turns < 3) axes = (uint8_t)(axes | 1u << (kind - PANTIN_EULER_X));
            turns++;
        }
        exponential = turns == 3 && pantin_joint_is_exponential(clip, &joint);
        memset(&run, 0, sizeof run);
        run.bit = joint.index;
        run.first = joint.first_channel;
        for (c = 0; c < joint.channels; c++) {
            uint8_t own = family_of(pantin_joint_kind(&joint, c));
            if (own != family) {
                close_run(&run, family, exponential, axes == 7);
                push_group(m, &count, &run);
                run.first = (uint16_t)(joint.first_channel + c);
                run.length = 0;
                family = own;
            }
            run.length++;
        }
        close_run(&run, family, exponential, axes == 7);
        push_group(m, &count, &run);
    }
    if (rig->source->error != PANTIN_OK) return rig->source->error;
    for (i = 0; i < rig->scalars; i++) {
        run.first = (uint16_t)(rig->channels - rig->scalars + i);
        run.bit = (uint16_t)(rig->joints + i);
        run.length = 1;
        run.shape = PANTIN_FREE;
        push_group(m, &count, &run);
    }
    a->group_count = count;
    return count > m->group_room ? PANTIN_NO_ROOM : PANTIN_OK;
}

static uint64_t apart(const int32_t *a, const int32_t *b, uint8_t count) {
    uint64_t total = 0;
    while (count-- > 0) total += size_of(difference(a[count], b[count]));
    return total;
}

/* Of an exponential map the one that is a turn shorter, the other way, if it is nearer to another one. */
static void nearest_map(int32_t *from, const int32_t *to, uint8_t count) {
    int64_t now = 0, other = 0, length, shorter[4];
    uint8_t i;
    for (i = 0; i < count; i++) now += (int64_t)wide_size((int64_t)from[i] - to[i]);
    /* A turn less is 2^32 away in these sums or farther, less 3 for rounding. */
    if (now < ((int64_t)1 << 31) - 3) return;
    length = length_of(from, count);
    if (length == 0) return;
    for (i = 0; i < count; i++) {
        shorter[i] = from[i] * (length - ((int64_t)1 << 32)) / length;
        if (shorter[i] != (int32_t)shorter[i]) return;
        other += (int64_t)wide_size(shorter[i] - to[i]);
    }
    if (other >= now) return;
    for (i = 0; i < count; i++) from[i] = (int32_t)shorter[i];
}

/* Writes to `from` what is the same rotation and nearest to `to`, a channel. */
void pantin_animator_nearest(uint8_t shape, int32_t *from, const int32_t *to, uint8_t count) {
    int64_t dot = 0;
    uint8_t i;
    if (shape == PANTIN_EULER && count == 3) {
        int32_t other[3];
        other[0] = sum(from[0], HALF_TURN);
        other[1] = difference(HALF_TURN, from[1]);
        other[2] = sum(from[2], HALF_TURN);
        if (apart(other, to, 3) < apart(from, to, 3)) memcpy(from, other, sizeof other);
    } else if (shape == PANTIN_MAP) {
        nearest_map(from, to, count);
    } else if (shape == PANTIN_UNIT) {
        for (i = 0; i < count; i++) dot += ((int64_t)from[i] * to[i]) >> 2;
        for (i = 0; i < count && dot < 0; i++) from[i] = difference(0, from[i]);
    }
}

/* ---- Rotations in channels ---- */

static uint8_t kind_at(const pantin_joint_ref *joint, uint8_t channel) {
    uint8_t pair = joint->kinds[channel >> 1];
    return channel & 1 ? (uint8_t)(pair >> 4) : (uint8_t)(pair & 15);
}

/* Which component each channel of a map or a quaternion holds. The angles of a joint that is coded as a map hold x, y, z in turn. */
void pantin_animator_places(const pantin_joint_ref *joint, uint8_t count, uint8_t *places) {
    uint8_t c, at = 0;
    memset(places, 0, 15);
    for (c = 0; c < joint->channels; c++) {
        uint8_t kind = kind_at(joint, c), place = at;
        if (kind < PANTIN_EULER_X) continue;
        if (kind >= PANTIN_EXPONENTIAL_X) {
            place = (uint8_t)(kind - PANTIN_EXPONENTIAL_X + (count == 4));
        } else if (kind >= PANTIN_QUATERNION_W) {
            place = (uint8_t)(kind - PANTIN_QUATERNION_W);
            if (count != 4 && place > 0) place--;
        } else if (count != 4 && at > 3) {
            place = 3;
        }
        places[at++] = place;
    }
}

/* The order of a joint with three Euler angles. */
static uint8_t order_of(const pantin_joint_ref *joint) {
    uint8_t axes[3] = {0, 0, 0}, count = 0, c;
    for (c = 0; c < joint->channels && count < 3; c++) {
        uint8_t kind = kind_at(joint, c);
        if (family_of(kind) == 1) axes[count++] = (uint8_t)(kind - PANTIN_EULER_X);
    }
    return (uint8_t)(2 * axes[0] + (axes[1] > axes[2]));
}

/* The unit quaternion of a group of channels. Returns 0 for channels that are each by themselves. */
static int unit_of(uint8_t shape, const pantin_joint_ref *joint, const int32_t *own, uint8_t count, int32_t *q) {
    uint8_t places[15], axes[3], i;
    memset(q, 0, 4 * sizeof *q);
    if (shape == PANTIN_EULER) {
        if (count < 3) return 0;
        pantin_turn_axes(order_of(joint), axes);
        q[0] = ONE_Q30;
        for (i = 0; i < 3; i++) pantin_turn_about(q, axes[i], own[i]);
        return 1;
    }
    if (shape == PANTIN_FREE) return 0;
    pantin_animator_places(joint, (uint8_t)(shape == PANTIN_MAP ? 3 : 4), places);
    for (i = 0; i < count; i++) {
        uint8_t at = (uint8_t)(places[i] + (shape == PANTIN_MAP));
        if (at < 4) q[at] = own[i];
    }
    if (shape == PANTIN_MAP) {
        pantin_turn_exponential(q);
    } else {
        pantin_turn_normalize(q);
    }
    return 1;
}

/* The exponential map of a unit quaternion, of at most half a turn. */
void pantin_animator_map(const int32_t *q, int32_t *map) {
    int32_t unit[4];
    int64_t angle, sine = length_of(q + 1, 3);
    uint8_t i;
    memcpy(unit, q, sizeof unit);
    pantin_turn_normalize(unit);
    angle = size_of(pantin_turn_angle(unit));
    for (i = 0; i < 3; i++) {
        int64_t part = sine ? (q[0] < 0 ? -(int64_t)q[i + 1] : q[i + 1]) * angle / sine : 0;
        map[i] = (int32_t)clamp(part, LEAST_VALUE, 0x7fffffffL);
    }
}

/* Writes a rotation into a group of channels. */
static void write_turn(uint8_t shape, const pantin_joint_ref *joint, int32_t *q, int32_t *own, uint8_t count) {
    uint8_t places[15], i;
    int32_t parts[4] = {0, 0, 0, 0};
    if (shape == PANTIN_EULER) {
        pantin_turn_normalize(q);
        pantin_turn_angles(q, order_of(joint), parts);
        for (i = 0; i < count && i < 3; i++) own[i] = parts[i];
        return;
    }
    if (shape == PANTIN_FREE) return;
    if (shape == PANTIN_MAP) {
        pantin_animator_map(q, parts);
    } else {
        memcpy(parts, q, sizeof parts);
    }
    pantin_animator_places(joint, (uint8_t)(shape == PANTIN_MAP ? 3 : 4), places);
    for (i = 0; i < count; i++) own[i] = places[i] < 4 ? parts[places[i]] : 0;
}

/* The yaw of a unit quaternion about the vertical axis: the first angle of its matrix. */
static int32_t yaw_of_unit(const pantin_animator *a, const int32_t *q) {
    static const uint8_t orders[3] = {PANTIN_XYZ, PANTIN_YXZ, PANTIN_ZXY};
    uint8_t axes[3], i, j, k, n;
    int32_t rows[9], x[2], y[2], third, images[2], odd = a->axis == 1;
    pantin_turn_axes(orders[a->axis], axes);
    i = axes[0];
    j = axes[1];
    k = axes[2];
    pantin_turn_matrix(q, rows);
    third = pantin_turn_atan2(odd ? rows[3 * i + j] : -rows[3 * i + j], rows[4 * i]);
    pantin_turn_sin_cos(third, &y[0], &y[1]);
    for (n = 0; n < 2; n++) {
        uint8_t row = n ? k : j;
        x[0] = odd ? -rows[3 * row + i] : rows[3 * row + i];
        x[1] = rows[3 * row + j];
        images[n] = pantin_turn_dot(x, y);
    }
    return pantin_turn_atan2(odd ? -images[1] : images[1], images[0]);
}

static int32_t yaw_of(const pantin_animator *a, const int32_t *pose) {
    int32_t q[4];
    pantin_turn_unit(pose, &a->root, q);
    return yaw_of_unit(a, q);
}

/* Turns the root about the vertical axis, in its channels: one that has up to two angles keeps them, but for one that turns about that axis first. */
static void turn_root(const pantin_animator *a, int32_t angle, int32_t *own, uint8_t count) {
    int32_t q[4], about[4] = {ONE_Q30, 0, 0, 0};
    uint8_t c = 0;
    if (angle == 0) return;
    if (unit_of(a->turns.shape, &a->root, own, count, q)) {
        pantin_turn_about(about, a->axis, angle);
        pantin_turn_multiply(about, q);
        write_turn(a->turns.shape, &a->root, about, own, count);
        return;
    }
    while (c < a->root.channels && kind_at(&a->root, c) < PANTIN_EULER_X) c++;
    if (c < a->root.channels && kind_at(&a->root, c) == PANTIN_EULER_X + a->axis && count > 0) own[0] = sum(own[0], angle);
}

/* The number of channels that turn the root, as far as they are one rotation or less. */
static uint8_t turn_count(const pantin_animator *a) { return a->turns.length > 4 ? 0 : a->turns.length; }

/* ---- Headings ---- */

void pantin_animator_heading(pantin_heading *h, int32_t angle) {
    h->angle = angle;
    h->sine = 0;
    h->cosine = ONE_Q30;
    if (angle != 0) pantin_turn_sin_cos(angle, &h->sine, &h->cosine);
}

/* A vector of channels' range, rotated, in Q30. */
static void products(const pantin_heading *h, int32_t a, int32_t b, int64_t *to) {
    to[0] = (int64_t)a * h->cosine - (int64_t)b * h->sine;
    to[1] = (int64_t)a * h->sine + (int64_t)b * h->cosine;
}

void pantin_animator_rotate(const pantin_heading *h, int32_t a, int32_t b, int64_t *to) {
    uint8_t i;
    if (h->angle == 0) {
        to[0] = a;
        to[1] = b;
        return;
    }
    products(h, a, b, to);
    for (i = 0; i < 2; i++) to[i] = (to[i] + 0x20000000L) >> 30;
}

/* Turns a way beyond that range: in parts of 2^30, whose products are whole. */
static void rotate_wide(const pantin_heading *h, int64_t a, int64_t b, int64_t *to) {
    int64_t high[2];
    if (h->angle == 0) {
        to[0] = a;
        to[1] = b;
    } else if (a == (int32_t)a && b == (int32_t)b) {
        pantin_animator_rotate(h, (int32_t)a, (int32_t)b, to);
    } else {
        pantin_animator_rotate(h, (int32_t)(a & (ONE_Q30 - 1)), (int32_t)(b & (ONE_Q30 - 1)), to);
        products(h, (int32_t)(a >> 30), (int32_t)(b >> 30), high);
        to[0] = wide_sum(to[0], high[0]);
        to[1] = wide_sum(to[1], high[1]);
    }
}

/* ---- Tracks ---- */

static uint32_t frame_of(const pantin_track *t) { return t->player.frame; }

/* Moving channels: behind their states, a player of a key clip keeps the keys. */
static uint16_t moving_count(const pantin_player *p) {
#ifdef PANTIN_KEYS
    if (p->clip->flags & PANTIN_KEY_CLIP) return p->resume;
#endif
    return p->moving_count;
}

/* How far this instant is on the way from its frame to the next, in 2^-16. */
uint16_t pantin_animator_part(const pantin_track *t) {
    if (t->rest == 0) return 0;
    return (uint16_t)(t->rest / (int64_t)t->clip.frame_time_ns);
}

static pantin_result go_to(pantin_track *t, uint32_t frame) {
    uint32_t ahead;
    pantin_result result = PANTIN_OK;
    if (frame >= t->clip.frames) frame = t->clip.frames - 1;
    ahead = frame - frame_of(t);
    if (ahead != 0) t->closed = 0;
    if (ahead > 8) return pantin_seek(&t->player, frame);
    for (; ahead > 0 && result == PANTIN_OK; ahead--) result = pantin_step(&t->player);
    return result;
}

static void set_speed(pantin_track *t, int32_t speed) {
    t->speed = (int32_t)clamp(speed, -4 * PANTIN_SPEED, 4 * PANTIN_SPEED);
    t->ended = t->stands = 0;
}

static pantin_result start_player(pantin_track *t, pantin_channel *moving, size_t moving_room, int32_t *values, size_t value_room) {
    return pantin_start(&t->player, &t->clip, values, value_room, moving, moving_room);
}

/* Plays another clip from a frame. On an error the old clip plays on. */
static pantin_result start_track(pantin_track *t, const pantin_clip *clip, size_t value_room, uint32_t frame, int32_t speed) {
    pantin_clip old = t->clip;
    uint32_t at = frame_of(t);
    int32_t *values = t->player.pose;
    pantin_channel *moving = t->player.moving;
    uint16_t room = t->player.moving_room;
    pantin_result result;
    t->clip = *clip;
    result = start_player(t, moving, room, values, value_room);
    if (result != PANTIN_OK) {
        pantin_result again;
        t->clip = old;
        again = start_player(t, moving, room, values, value_room);
        if (again == PANTIN_OK) again = go_to(t, at);
        return again != PANTIN_OK ? again : result;
    }
    result = go_to(t, frame);
    t->rest = 0;
    t->ended = t->closed = t->lapped = t->seam.known = 0;
    set_speed(t, speed);
    return result;
}

static pantin_result seek_track(pantin_track *t, uint32_t frame) {
    pantin_result result = go_to(t, frame);
    t->rest = 0;
    t->ended = t->stands = 0;
    return result;
}

/* Adds a weight of what the channels move between the frame and this instant. */
static void add_part(const pantin_track *t, uint16_t weight, int32_t *out) {
    uint16_t i, part = (uint16_t)(((uint32_t)(pantin_animator_part(t) >> 1) * weight) >> 15);
    if (t->rest == 0) return;
    for (i = 0; i < moving_count(&t->player); i++) {
        const pantin_channel *c = &t->player.moving[i];
        out[c->channel] = sum(out[c->channel], weighted((int32_t)c->v, part));
    }
}

/* A length in raw units of position channels. */
static uint32_t raw_of_cm(const pantin_clip *clip, int64_t cm) {
    int64_t micro_cm = cm * 1000000;
    int8_t shift = clip->exponent;
    micro_cm = shift >= 0 ? micro_cm >> shift : micro_cm << (shift < -31 ? 31 : -shift);
    return (uint32_t)clamp(micro_cm / clip->rig.unit_micro_cm, 0, (int64_t)1 << 31);
}

/* How far a channel goes from the last frame of a loop to frame 0, whose value is in its acceleration. */
static int32_t way_of(const pantin_track *t, const pantin_channel *c) { return difference((int32_t)c->w, t->player.pose[c->channel]); }

static uint32_t gap_of(const pantin_track *t, const pantin_channel *c) { return size_of(difference(way_of(t, c), (int32_t)c->v)); }

/* Makes the velocities on a loop's last frame lead to frame 0, but for positions and rotations that do not come back: they go on as they did. The
   accelerations become the values at frame 0. */
static pantin_result lead_to_start(pantin_track *t) {
    const pantin_player *p = &t->player;
    pantin_channel *c = p->moving, *end = p->moving + moving_count(p), *last;
    uint32_t bound = raw_of_cm(&t->clip, RETURNS_CM);
    pantin_joint joint;
    pantin_result result = pantin_keep_starts(p);
    if (result != PANTIN_OK) return result;
    pantin_first_joint(&joint, &t->clip.rig);
    while (c < end && pantin_next_joint(&joint)) {
        uint16_t behind = (uint16_t)(joint.first_channel + joint.channels);
        uint8_t turns_on = 0;
        for (last = c; last < end && last->channel < behind; last++) {
            if (pantin_joint_kind(&joint, (uint8_t)(last->channel - joint.first_channel)) >= PANTIN_EULER_X && gap_of(t, last) > FAR_TURN) turns_on = 1;
        }
        for (; c < last; c++) {
            uint8_t kind = pantin_joint_kind(&joint, (uint8_t)(c->channel - joint.first_channel));
            if (!(kind < PANTIN_EULER_X ? gap_of(t, c) > bound : turns_on)) c->v = (uint32_t)way_of(t, c);
        }
    }
    for (; c < end; c++) c->v = (uint32_t)way_of(t, c);
    return t->clip.rig.source->error;
}

/* The root at one instant, with values of its channels or what they move to. */
enum { NEXT = 0, FIRST, NOW };

static int32_t moved(int32_t p, const pantin_channel *c, uint8_t what) {
    return what == NEXT ? sum(p, (int32_t)c->v) : what == FIRST ? (int32_t)c->w : p;
}

static void root_turns(const pantin_animator *a, const pantin_track *t, uint8_t what, int32_t *turns) {
    const pantin_player *p = &t->player;
    uint8_t i, count = (uint8_t)(a->turns.length < 4 ? a->turns.length : 4);
    uint16_t m;
    memset(turns, 0, 4 * sizeof *turns);
    for (i = 0; i < count; i++) turns[i] = p->pose[a->turns.first + i];
    for (m = 0; m < moving_count(p); m++) {
        uint16_t at = (uint16_t)(p->moving[m].channel - a->turns.first);
        if (at < 4) turns[at] = moved(turns[at], &p->moving[m], what);
    }
}

static void root_at(const pantin_animator *a, const pantin_track *t, uint8_t what, int32_t *place, int32_t *yaw) {
    const pantin_player *p = &t->player;
    int32_t turns[4], q[4];
    uint8_t i;
    uint16_t m;
    for (i = 0; i < 2; i++) {
        uint16_t channel = a->place_channels[i];
        place[i] = channel == NO_CHANNEL ? 0 : p->pose[channel];
        for (m = 0; m < moving_count(p); m++) {
            if (p->moving[m].channel == channel) place[i] = moved(place[i], &p->moving[m], what);
        }
    }
    root_turns(a, t, what, turns);
    /* Less than a whole rotation does not turn from lap to lap. */
    *yaw = unit_of(a->turns.shape, &a->root, turns, turn_count(a), q) ? yaw_of_unit(a, q) : 0;
}

static void find_seam(const pantin_animator *a, pantin_track *t, uint8_t what, const int32_t *next, int32_t next_yaw) {
    const pantin_clip *clip = &t->clip;
    pantin_seam *seam = &t->seam;
    int64_t units = (int64_t)RETURNS_CM * 1000000, way[2];
    int32_t yaw;
    uint8_t i, near = 1, turns;
    int8_t shift = clip->exponent;
    root_at(a, t, what, seam->first, &yaw);
    units = shift >= 0 ? units >> shift : (int64_t)((uint64_t)units << (shift < -40 ? 40 : -shift));
    units = clamp(units / (int64_t)clip->rig.unit_micro_cm, 0, units > 0 ? units : 0);
    yaw = difference(next_yaw, yaw);
    turns = size_of(yaw) > RETURNS_TURN && a->place_channels[0] != NO_CHANNEL && a->place_channels[1] != NO_CHANNEL;
    for (i = 0; i < 2; i++) {
        way[i] = (int64_t)next[i] - seam->first[i];
        if (wide_size(way[i]) > (uint64_t)units) near = 0;
    }
    for (i = 0; i < 2; i++) seam->place[i] = near && !turns ? 0 : way[i];
    seam->yaw = turns ? yaw : 0;
    seam->known = 1;
}

/* On the last frame of a loop, lets the velocities lead to frame 0: those of the root, if this is the animator's track, to where the next lap begins. */
static pantin_result close_loop(pantin_track *t, pantin_animator *a) {
    int32_t next[2] = {0, 0}, next_yaw = 0, turns[4];
    uint8_t i, count;
    uint16_t m;
    pantin_result result;
    if (t->closed || !t->clip.looped || frame_of(t) + 1 < t->clip.frames) return PANTIN_OK;
    /* Without the lap to come, the root moves on as it did. */
    if (a && !t->seam.known) root_at(a, t, NEXT, next, &next_yaw);
    result = lead_to_start(t);
    if (result != PANTIN_OK) return result;
    t->closed = 1;
    if (!a) return PANTIN_OK;
    if (!t->seam.known) find_seam(a, t, FIRST, next, next_yaw);
    root_turns(a, t, FIRST, turns);
    count = t->seam.yaw ? turn_count(a) : 0;
    if (t->seam.yaw) {
        turn_root(a, t->seam.yaw, turns, count);
        pantin_animator_nearest(a->turns.shape, turns, t->player.pose + a->turns.first, count);
    }
    for (m = 0; m < moving_count(&t->player); m++) {
        pantin_channel *c = &t->player.moving[m];
        uint16_t at = (uint16_t)(c->channel - a->turns.first);
        int32_t to;
        for (i = 0; i < 2 && a->place_channels[i] != c->channel; i++) {}
        if (i < 2) {
            to = sum((int32_t)c->w, (int32_t)(uint32_t)(uint64_t)t->seam.place[i]);
        } else if (at < count) {
            to = turns[at];
        } else {
            continue;
        }
        c->v = (uint32_t)difference(to, t->player.pose[c->channel]);
    }
    return PANTIN_OK;
}

/* Whether the crate keeps how a loop begins, which shows where it goes over the seam. */
static void keep_start(pantin_track *t, const pantin_animator *a) {
    if (a && t == &a->track && a->left == 0 && t->clip.looped && moving_count(&t->player) == t->player.moving_count) t->lapped = 1;
}

/* Goes from the last frame of a loop to frame 0. In the first lap, learns where a lap takes the root. */
static pantin_result lap(pantin_track *t, pantin_animator *a) {
    int32_t next[2] = {0, 0}, next_yaw = 0;
    uint8_t learns = a && !t->seam.known;
    pantin_result result;
    /* Without the lap to come, the root moves on as it did. */
    if (learns) root_at(a, t, NEXT, next, &next_yaw);
    result = go_to(t, 0);
    if (result == PANTIN_OK && learns) find_seam(a, t, NOW, next, next_yaw);
    if (!t->lapped) keep_start(t, a);
    return result;
}

/* A stretch of play. */
typedef struct {
    uint32_t from, to;
    uint8_t from_rest, to_rest, forward;
    int32_t laps;
} passage;

/* Takes whole frames out of the time after the frame: as many as come back. */
static int64_t take_steps(pantin_track *t, int64_t frame_time) {
    int64_t steps = quotient(t->rest, frame_time);
    t->rest -= steps * frame_time;
    return steps;
}

/* Lets time pass, up to 2^42 ns. `left_ns` is the time that is left after the end of a clip that is no loop. */
static pantin_result advance(pantin_track *t, pantin_animator *a, uint64_t elapsed_ns, passage *p, uint64_t *left_ns) {
    int64_t frame_time = (int64_t)t->clip.frame_time_ns << 16, frames = t->clip.frames, target, to, over;
    pantin_result result = PANTIN_OK;
    p->from = frame_of(t);
    p->from_rest = t->rest != 0;
    p->forward = t->speed >= 0;
    p->laps = 0;
    *left_ns = 0;
    t->stands = t->ended;
    t->rest += (int64_t)elapsed_ns * t->speed;
    target = to = p->from + take_steps(t, frame_time);
    if (t->clip.looped) {
        int64_t laps = quotient(target, frames);
        to = target - laps * frames;
        p->laps = (int32_t)clamp(laps, -MOST_LAPS, MOST_LAPS);
    } else if (target >= frames - 1 || target < 0) {
        over = target < 0 ? -(target * frame_time + t->rest) : (target - (frames - 1)) * frame_time + t->rest;
        to = target < 0 ? 0 : frames - 1;
        t->rest = 0;
        if (over > 0) t->ended = 1;
        if (t->speed) *left_ns = wide_size(over) / size_of(t->speed);
    }
    if (p->laps != 0 && !t->seam.known && a) {
        result = go_to(t, 0xffffffffu);
        if (result == PANTIN_OK) result = lap(t, a);
    } else if (p->laps > 0 && !t->lapped) {
        result = lap(t, a);
    }
    if (result == PANTIN_OK) result = go_to(t, (uint32_t)to);
    if (result == PANTIN_OK && t->rest != 0) result = close_loop(t, a);
    p->to = (uint32_t)to;
    p->to_rest = t->rest != 0;
    return result;
}

/* Goes on by one frame of the clip, whatever its speed. */
static pantin_result step_track(pantin_track *t, pantin_animator *a, passage *p) {
    pantin_result result = PANTIN_OK;
    p->from = frame_of(t);
    p->from_rest = t->rest != 0;
    p->to_rest = 0;
    p->laps = 0;
    p->forward = 1;
    t->rest = 0;
    t->stands = t->ended;
    if (p->from + 1 < t->clip.frames) {
        result = go_to(t, p->from + 1);
    } else if (t->clip.looped) {
        result = lap(t, a);
        p->laps = 1;
    } else {
        t->ended = 1;
    }
    p->to = frame_of(t);
    return result;
}

/* ---- Events ---- */

static void push_event(pantin_animator *a, const pantin_event *event) {
    if (a->event_count == PANTIN_EVENTS) {
        if (a->lost < 0xffffffffu) a->lost++;
        return;
    }
    a->events[a->event_count].id = event->id;
    a->events[a->event_count++].frame = event->frame;
}

/* Adds the events of frames `from` to `to` - 1. */
static void events_forward(pantin_animator *a, uint32_t from, uint32_t to) {
    pantin_event event;
    pantin_first_event(&event, &a->track.clip);
    while (pantin_next_event(&event) && event.frame < to) {
        if (event.frame >= from) push_event(a, &event);
    }
}

/* Passes the events backwards, last first. A clip lists them forwards, so that each is searched for. */
static void events_backward(pantin_animator *a, uint32_t from, uint32_t to) {
    pantin_event event;
    uint32_t count = 0, room = (uint32_t)(PANTIN_EVENTS - a->event_count), back, at;
    pantin_first_event(&event, &a->track.clip);
    while (pantin_next_event(&event)) count += event.frame >= from && event.frame < to;
    for (back = 0; back < count && back < room; back++) {
        pantin_first_event(&event, &a->track.clip);
        for (at = count - back; at > 0 && pantin_next_event(&event);) at -= event.frame >= from && event.frame < to;
        push_event(a, &event);
    }
    if (count > room) a->lost = a->lost + (count - room) < a->lost ? 0xffffffffu : a->lost + (count - room);
}

static void events_between(pantin_animator *a, uint8_t forward, uint32_t from, uint32_t to) {
    if (forward) {
        events_forward(a, from, to);
    } else {
        events_backward(a, to, from);
    }
}

/* Adds the events that a stretch of play passes, each as often as it is passed. */
static void pass_events(pantin_animator *a, const passage *p) {
    uint32_t start = p->from + 1, end = p->to + 1, first = 0, last = a->track.clip.frames;
    int32_t laps = p->laps < 0 ? -p->laps : p->laps;
    if (!a->track.clip.event_count) return;
    if (!p->forward) {
        start = p->from + p->from_rest;
        end = p->to + p->to_rest;
        first = last;
        last = 0;
    }
    if (laps == 0) {
        events_between(a, p->forward, start, end);
        return;
    }
    events_between(a, p->forward, start, last);
    while (--laps > 0) events_between(a, p->forward, first, last);
    events_between(a, p->forward, first, end);
}

int pantin_animator_take(pantin_animator *a, pantin_fired *fired) {
    if (!a->event_count) return 0;
    *fired = a->events[0];
    a->event_count--;
    memmove(a->events, a->events + 1, a->event_count * sizeof *a->events);
    return 1;
}

/* ---- The root's way ---- */

static void new_travel(pantin_animator *a, const pantin_placement *from) {
    uint8_t i;
    for (i = 0; i < 2; i++) {
        a->anchor[i] = from->place[i];
        a->origin[i] = a->place[i];
        a->lap_place[i] = 0;
    }
    pantin_animator_heading(&a->heading, from->heading);
    pantin_animator_heading(&a->lap_heading, 0);
    a->laps = 0;
}

/* Passes the seam of a loop a number of times. A lap's way is turned by the laps before it, so that the same laps backwards take back the same numbers. */
static void pass_laps(pantin_animator *a, int32_t laps) {
    const pantin_seam *seam = &a->track.seam;
    int32_t count = laps < 0 ? -laps : laps;
    for (; count > 0; count--) {
        int64_t way[2];
        uint8_t i;
        if (laps < 0) a->laps = difference(a->laps, 1);
        if (seam->yaw) pantin_animator_heading(&a->lap_heading, times(seam->yaw, a->laps));
        rotate_wide(&a->lap_heading, seam->place[0], seam->place[1], way);
        for (i = 0; i < 2; i++) a->lap_place[i] = wide_sum(a->lap_place[i], laps < 0 ? -way[i] : way[i]);
        if (laps < 0) continue;
        a->laps = sum(a->laps, 1);
        if (seam->yaw) pantin_animator_heading(&a->lap_heading, times(seam->yaw, a->laps));
    }
}

void pantin_animator_locate(const pantin_animator *a, const int32_t *place, pantin_placement *to) {
    int64_t way[2], first[2] = {0, 0};
    uint8_t i;
    /* About the place where the loop begins, which is where a lap's turn happens. */
    for (i = 0; i < 2 && a->track.seam.known; i++) first[i] = a->track.seam.first[i];
    rotate_wide(&a->lap_heading, place[0] - first[0], place[1] - first[1], way);
    for (i = 0; i < 2; i++) way[i] = wide_sum(wide_sum(wide_sum(way[i], first[i]), a->lap_place[i]), (int64_t)(0u - (uint64_t)a->origin[i]));
    rotate_wide(&a->heading, way[0], way[1], way);
    for (i = 0; i < 2; i++) to->place[i] = wide_sum(a->anchor[i], way[i]);
    to->heading = sum(a->heading.angle, a->lap_heading.angle);
}

/* Finds where the figure is. */
static void locate(pantin_animator *a) { pantin_animator_locate(a, a->place, &a->placement); }

/* ---- Transitions ---- */

/* A fraction below 1, times a number: `over` is at most 12, `under` below 2^25. */
static int32_t fraction_of(int32_t x, uint32_t over, uint32_t under) {
    uint8_t shift = 29;
    while (shift < 58 && ((uint64_t)over << shift) < (uint64_t)under << 29) shift++;
    return (int32_t)(((int64_t)x * (int32_t)(((uint64_t)over << shift) / under)) >> shift);
}

/* Sets accelerations and slopes so that differences and velocities come to zero in a number of frames. It is solved again with 128, 32 and 2
   frames left, so that the end is exactly zero. */
void pantin_animator_solve(uint8_t frames, pantin_offset *o) {
    uint32_t n = frames;
    if (frames == 0 || !(o->d | o->v)) {
        memset(o, 0, sizeof *o);
    } else if (frames == 1) {
        o->v = difference(0, o->d);
        o->w = o->d;
        o->k = 0;
    } else if (frames == 2) {
        o->w = difference(difference(0, o->d), times(o->v, 2));
        o->k = sum(times(o->d, 2), times(o->v, 3));
    } else {
        int32_t k = sum(fraction_of(o->d, 12, n * (n * n - 1)), fraction_of(o->v, 6, n * (n - 1)));
        o->w = (int32_t)(uint32_t)(uint64_t)(-(int64_t)fraction_of(o->v, 1, n) - (((int64_t)k * (int64_t)(n - 1)) >> 1));
        o->k = k;
    }
}

static void solve_all(pantin_animator *a, uint8_t frames) {
    uint16_t c;
    for (c = 0; c < a->channels; c++) pantin_animator_solve(frames, &a->memory->offsets[c]);
}

/* Whether the cubics are solved again with this number of frames left: not before velocities that die out in fewer frames have done so. */
static int solves_at(const pantin_animator *a, uint8_t left) {
    if (left == a->left_then) return left > 0;
    return (left == 2 || left == 32 || left == 128) && (left < a->left_then || !a->left_then);
}

static void solve_again(pantin_animator *a) {
    if (solves_at(a, a->left)) solve_all(a, a->left);
}

static void step_offset(pantin_offset *o) {
    o->d = sum(o->d, o->v);
    o->v = sum(o->v, o->w);
    o->w = sum(o->w, o->k);
}

static void step_transition(pantin_animator *a) {
    uint16_t c;
    a->left--;
    a->stepped = 1;
    for (c = 0; c < a->channels; c++) {
        pantin_offset *o = &a->memory->offsets[c];
        if (o->d | o->v) step_offset(o);
    }
    solve_again(a);
}

static void run_transition(pantin_animator *a, uint64_t elapsed_ns) {
    uint64_t rest = a->rest_ns + elapsed_ns;
    uint32_t frame_time = a->track.clip.frame_time_ns;
    for (; rest >= frame_time && a->left > 0; rest -= frame_time) step_transition(a);
    a->rest_ns = a->left > 0 ? (uint32_t)rest : 0;
}

/* A difference a number of frames on: as many steps. */
static pantin_offset after(const pantin_offset *o, uint8_t frames) {
    pantin_offset to = *o;
    int32_t n = frames, pairs = n * (n - 1) / 2, triples = pairs * (n - 2) / 3;
    to.d = sum(sum(sum(o->d, times(n, o->v)), times(pairs, o->w)), times(triples, o->k));
    to.v = sum(sum(o->v, times(n, o->w)), times(pairs, o->k));
    to.w = sum(o->w, times(n, o->k));
    return to;
}

/* While differences are carried, they are what they were when that began: brings them to this frame. */
void pantin_animator_leave_carried(pantin_animator *a) {
    uint16_t c;
    if (a->carried) a->stepped = 1;
    for (c = 0; c < a->channels && a->carried; c++) a->memory->offsets[c] = after(&a->memory->offsets[c], a->carried_frames);
    a->carried = 0;
}

/* Adds carried differences to the pose. Between frames a moving channel goes a part of the sum of the clip's velocity and the difference's, which is rounded
   once. */
static void add_carried(pantin_animator *a) {
    const pantin_player *p = &a->track.player;
    uint16_t c, m = 0, part = pantin_animator_part(&a->track) >> 1;
    for (c = 0; c < a->channels; c++) {
        const pantin_offset *base = &a->memory->offsets[c];
        pantin_offset o = after(base, a->carried_frames);
        int32_t v = o.v;
        if (m < p->moving_count && p->moving[m].channel == c) {
            v = sum(v, (int32_t)p->moving[m++].v);
        } else if (!(base->d | base->v)) {
            continue;
        }
        a->pose[c] = sum(a->pose[c], sum(o.d, weighted(v, part)));
    }
}

/* Begins to carry differences. Returns 0 for a clip whose channels follow others, or which has keys. */
static int carry(pantin_animator *a) {
    const pantin_player *p = &a->track.player;
    uint16_t m;
    if (a->carried) return 1;
    if (moving_count(p) != p->moving_count) return 0;
    for (m = 0; m < p->moving_count; m++) {
        if (p->moving[m].leader) return 0;
    }
    for (m = 0; m < p->moving_count; m++) {
        pantin_offset *o = &a->memory->offsets[p->moving[m].channel];
        if (!(o->d | o->v)) memset(o, 0, sizeof *o);
    }
    a->carried = 1;
    a->carried_frames = 0;
    return 1;
}

/* Whether this number of frames ends before the clip's last frame, and does not pass a frame where the cubics are solved. */
static int may_carry(const pantin_animator *a, uint8_t frames) {
    uint8_t i;
    if (a->left <= 2 || a->left < frames) return 0;
    for (i = 1; i < frames; i++) {
        if (solves_at(a, (uint8_t)(a->left - i))) return 0;
    }
    return frame_of(&a->track) + frames + 1 < a->track.clip.frames;
}

/* Goes on by frames that clip and transition share, to a time after them. Returns 0, and no differences are carried, if they part. */
static int run_carried(pantin_animator *a, int together, uint8_t frames, uint32_t rest_ns, passage *p, pantin_result *result) {
    uint8_t i;
    if (!together || !may_carry(a, frames) || !carry(a)) {
        pantin_animator_leave_carried(a);
        return 0;
    }
    p->from = frame_of(&a->track);
    p->from_rest = a->track.rest != 0;
    for (i = 0; i < frames && *result == PANTIN_OK; i++) *result = pantin_step(&a->track.player);
    if (*result != PANTIN_OK) return 1;
    a->carried_frames = (uint8_t)(a->carried_frames + frames);
    a->left = (uint8_t)(a->left - frames);
    a->rest_ns = rest_ns;
    a->track.rest = (int64_t)rest_ns << 16;
    if (frames > 0 && solves_at(a, a->left)) {
        pantin_animator_leave_carried(a);
        solve_again(a);
    }
    p->to = frame_of(&a->track);
    p->to_rest = rest_ns != 0;
    p->laps = 0;
    p->forward = 1;
    return 1;
}

/* Goes on by a time with carried differences: at speed 1, at most 8 frames. */
static int play_carried(pantin_animator *a, uint64_t elapsed_ns, passage *p, pantin_result *result) {
    uint64_t rest = a->rest_ns + elapsed_ns;
    uint8_t frames = 0;
    int together = a->left > 0 && a->track.speed == PANTIN_SPEED && a->track.rest == (int64_t)a->rest_ns << 16;
    for (; together && rest >= a->track.clip.frame_time_ns; rest -= a->track.clip.frame_time_ns) together = ++frames <= 8;
    return run_carried(a, together, frames, (uint32_t)rest, p, result);
}

/* Adds what the channels move after the frame, and takes the root's place out of the pose. */
static void finish(pantin_animator *a) {
    uint8_t i;
    if (!a->carried) add_part(&a->track, 1u << 15, a->pose);
    for (i = 0; i < 2; i++) {
        uint16_t channel = a->place_channels[i];
        if (channel == NO_CHANNEL) continue;
        a->place[i] = a->pose[channel];
        a->pose[channel] = 0;
    }
}

/* Writes the pose of this instant. */
static void compose(pantin_animator *a) {
    uint16_t c, part = 0;
    memcpy(a->pose, a->track.player.pose, a->channels * sizeof *a->pose);
    if (a->carried) {
        add_carried(a);
    } else if (a->left > 0) {
        if (a->rest_ns) part = (uint16_t)((uint16_t)(((uint64_t)a->rest_ns << 16) / a->track.clip.frame_time_ns) >> 1);
        for (c = 0; c < a->channels; c++) {
            const pantin_offset *o = &a->memory->offsets[c];
            if (o->d | o->v) a->pose[c] = sum(sum(a->pose[c], o->d), part ? weighted(o->v, part) : 0);
        }
    }
    finish(a);
}

/* ---- The animator ---- */

/* Finds the root's channels in the form of the clip that plays. */
static pantin_result find_root(pantin_animator *a) {
    const pantin_rig *rig = &a->track.clip.rig;
    pantin_joint joint;
    pantin_result result;
    uint16_t i;
    uint8_t c, turning = NO_CHANNEL & 255;
    pantin_first_joint(&joint, rig);
    do {
        if (!pantin_next_joint(&joint)) return rig->source->error != PANTIN_OK ? rig->source->error : PANTIN_NOT_FOUND;
    } while (joint.index != a->carrier);
    result = pantin_refer(&a->track.clip, &joint, &a->root);
    if (result != PANTIN_OK) return result;
    a->axis = (uint8_t)((rig->up & 3) > 2 ? 2 : rig->up & 3);
    a->place_channels[0] = a->place_channels[1] = NO_CHANNEL;
    memset(&a->turns, 0, sizeof a->turns);
    for (c = joint.channels; c-- > 0;) {
        uint8_t kind = kind_at(&a->root, c);
        if (kind >= PANTIN_EULER_X) turning = c;
        for (i = 0; i < 2; i++) {
            if (kind == (a->axis + 1 + i) % 3) a->place_channels[i] = (uint16_t)(joint.first_channel + c);
        }
    }
    for (i = 0; i < a->group_count && turning != 255; i++) {
        const pantin_group *group = &a->memory->groups[i];
        if (group->bit == a->carrier && group->first == joint.first_channel + turning) {
            a->turns = *group;
            break;
        }
    }
    return PANTIN_OK;
}

static int has_positions(const pantin_joint *joint) {
    uint8_t c;
    for (c = 0; c < joint->channels; c++) {
        if (pantin_joint_kind(joint, c) < PANTIN_EULER_X) return 1;
    }
    return 0;
}

/* The first joint that has positions. */
static uint16_t first_with_positions(const pantin_rig *rig) {
    pantin_joint joint;
    pantin_first_joint(&joint, rig);
    while (pantin_next_joint(&joint)) {
        if (has_positions(&joint)) return joint.index;
    }
    return 0;
}

static pantin_result open_carried(pantin_animator *a, const pantin_clip *clip, const pantin_animator_memory *memory, uint16_t carrier) {
    static const pantin_placement nowhere = {{0, 0}, 0};
    pantin_result result;
    memset(a, 0, sizeof *a);
    a->memory = memory;
    a->pose = memory->pose;
    a->carrier = carrier;
    a->channels = clip->rig.channels;
    if (memory->channel_room < a->channels) return PANTIN_NO_ROOM;
    a->track.clip = *clip;
    a->track.speed = PANTIN_SPEED;
    result = find_groups(a, clip);
    if (result == PANTIN_OK) result = find_root(a);
    if (result == PANTIN_OK) result = start_player(&a->track, memory->moving, memory->moving_room, memory->values, memory->channel_room);
    if (result != PANTIN_OK) return result;
    memset(memory->offsets, 0, a->channels * sizeof *memory->offsets);
    keep_start(&a->track, a);
    events_forward(a, 0, 1);
    compose(a);
    new_travel(a, &nowhere);
    return PANTIN_OK;
}

/* ---- Reads that fail ---- */

/* Functions of the decoder that return no result, or begin with a source without errors, hide that bytes before them could not be read. The source knows. */
static void begin_reads(const pantin_clip *clip) { clip->source->failed = clip->rig.source->failed = PANTIN_OK; }

static pantin_result reads_of(const pantin_clip *clip, pantin_result result) {
    if (clip->source->failed != PANTIN_OK) return clip->source->failed;
    return clip->rig.source->failed != PANTIN_OK ? clip->rig.source->failed : result;
}

/* Starts the player of a track again at its frame. */
static pantin_result start_again(pantin_track *t, pantin_animator *a, uint16_t channels) {
    uint32_t frame = frame_of(t);
    uint8_t closed = t->closed;
    pantin_result result = start_player(t, t->player.moving, t->player.moving_room, t->player.pose, channels);
    if (result == PANTIN_OK) result = go_to(t, frame);
    t->closed = 0;
    if (result == PANTIN_OK && closed) result = close_loop(t, a);
    result = reads_of(&t->clip, result);
    if (result == PANTIN_OK) return PANTIN_OK;
    /* It cannot play, but its frame is still the one to go to. */
    t->player.frame = frame;
    t->player.started = 0;
    t->closed = closed;
    return result;
}

/* Makes an animator one again whose player, groups and root were read in part. */
static pantin_result recover(pantin_animator *a) {
    pantin_result result;
    if (!a->track.stale) return PANTIN_OK;
    begin_reads(&a->track.clip);
    result = find_groups(a, &a->track.clip);
    if (result == PANTIN_OK) result = find_root(a);
    result = reads_of(&a->track.clip, result);
    if (result == PANTIN_OK) result = start_again(&a->track, a, a->channels);
    if (result != PANTIN_OK) return result;
    compose(a);
    /* The figure stays where it is without what the transition added to its way. */
    if (a->track.stale == STALE_AND_ENDED) new_travel(a, &a->placement);
    a->track.stale = 0;
    return PANTIN_OK;
}

/* Takes everything back but a transition whose differences have changed: that one ends. */
static void take_back(pantin_animator *a, const pantin_animator *before, uint8_t stepped) {
    *a = *before;
    a->track.stale = STALE;
    if (!stepped || a->left == 0) return;
    a->track.stale = STALE_AND_ENDED;
    a->left = a->carried = 0;
    a->rest_ns = 0;
}

/* Begins a call that a failed read can end: `before` keeps what is taken back then. */
static pantin_result begin_call(pantin_animator *a, pantin_animator *before) {
    pantin_result result = a->memory ? recover(a) : PANTIN_ERROR_HEAD;
    if (result != PANTIN_OK) return result;
    begin_reads(&a->track.clip);
    a->stepped = 0;
    *before = *a;
    return PANTIN_OK;
}

static pantin_result end_call(pantin_animator *a, const pantin_animator *before, pantin_result result) {
    pantin_result read = reads_of(&before->track.clip, PANTIN_OK);
    if (read == PANTIN_OK) return result;
    take_back(a, before, a->stepped);
    (void)recover(a);
    return read;
}

/* ---- Opening, and time ---- */

static pantin_result open_read(pantin_animator *a, const pantin_clip *clip, const pantin_animator_memory *memory, uint16_t carrier) {
    pantin_result result = reads_of(clip, open_carried(a, clip, memory, carrier));
    if (result != PANTIN_OK) memset(a, 0, sizeof *a);
    return result;
}

pantin_result pantin_animator_open_carried(pantin_animator *a, const pantin_clip *clip, const pantin_animator_memory *memory, uint16_t carrier) {
    begin_reads(clip);
    return open_read(a, clip, memory, carrier);
}

pantin_result pantin_animator_open(pantin_animator *a, const pantin_clip *clip, const pantin_animator_memory *memory) {
    begin_reads(clip);
    return open_read(a, clip, memory, first_with_positions(&clip->rig));
}

void pantin_animator_speed(pantin_animator *a, int32_t speed) { set_speed(&a->track, speed); }

void pantin_animator_stand(pantin_animator *a, const pantin_placement *placement) {
    new_travel(a, placement);
    locate(a);
}

static void pass(pantin_animator *a, const passage *p) {
    if (p->laps != 0 && a->track.seam.known) pass_laps(a, p->laps);
    pass_events(a, p);
}

/* Lets time pass up to the end of a clip that is no loop. */
static pantin_result play(pantin_animator *a, uint64_t elapsed_ns, uint64_t *left_ns) {
    passage p;
    pantin_result result = PANTIN_OK;
    uint8_t carried = (uint8_t)play_carried(a, elapsed_ns, &p, &result);
    if (carried) {
        *left_ns = 0;
    } else {
        result = advance(&a->track, a, elapsed_ns, &p, left_ns);
    }
    if (result != PANTIN_OK) return result;
    pass(a, &p);
    if (!carried) run_transition(a, elapsed_ns > *left_ns ? elapsed_ns - *left_ns : 0);
    compose(a);
    locate(a);
    return PANTIN_OK;
}

/* Lets time pass after the end of the clip: a transition still runs. */
static void hold(pantin_animator *a, uint64_t elapsed_ns) {
    if (a->left == 0 || elapsed_ns == 0) return;
    pantin_animator_leave_carried(a);
    run_transition(a, elapsed_ns);
    compose(a);
    locate(a);
}

pantin_result pantin_animator_update(pantin_animator *a, uint32_t elapsed_us) {
    pantin_animator before;
    uint64_t left_ns;
    pantin_result result = begin_call(a, &before);
    if (result != PANTIN_OK) return result;
    result = play(a, (uint64_t)elapsed_us * 1000, &left_ns);
    if (result == PANTIN_OK) hold(a, left_ns);
    return end_call(a, &before, result);
}

pantin_result pantin_animator_step(pantin_animator *a) {
    pantin_animator before;
    passage p;
    pantin_result result = begin_call(a, &before);
    if (result != PANTIN_OK) return result;
    if (!run_carried(a, a->left > 0, 1, 0, &p, &result)) {
        result = step_track(&a->track, a, &p);
        a->rest_ns = 0;
        if (a->left > 0) step_transition(a);
    }
    if (result == PANTIN_OK) {
        pass(a, &p);
        compose(a);
        locate(a);
    }
    return end_call(a, &before, result);
}

pantin_result pantin_animator_seek(pantin_animator *a, uint32_t frame) {
    pantin_animator before;
    pantin_result result = begin_call(a, &before);
    if (result != PANTIN_OK) return result;
    pantin_animator_leave_carried(a);
    result = seek_track(&a->track, frame);
    if (result == PANTIN_OK) {
        compose(a);
        locate(a);
    }
    return end_call(a, &before, result);
}

/* ---- Going over to another clip ---- */

/* How many channels move. A clip that comes to its end moves on in this instant, so that a transition takes its motion over; then nothing moves. */
static uint16_t moving_of(const pantin_track *t) { return t->stands ? 0 : moving_count(&t->player); }

/* How much of a frame of one clip passes in one of another, in 2^-16. */
static int64_t ratio_of(const pantin_clip *of, const pantin_clip *clip) {
    return clamp((int64_t)(((uint64_t)clip->frame_time_ns << 16) / of->frame_time_ns), 0, 1L << 30);
}

/* Adds a weight of what the channels of a track move in a frame of the new clip. */
static void add_motion(pantin_animator *a, const pantin_track *t, uint16_t weight, const pantin_clip *clip) {
    int64_t speed = (t->speed * ratio_of(&t->clip, clip)) >> 16;
    uint16_t c, count = moving_of(t);
    for (c = 0; c < count; c++) {
        const pantin_channel *m = &t->player.moving[c];
        pantin_offset *o = &a->memory->offsets[m->channel];
        o->v = sum(o->v, scaled(weighted((int32_t)m->v, weight), speed));
    }
}

/* Keeps the pose of this instant and of a frame of the new clip later, in difference and velocity of each offset. A weight of a second track may be mixed in. */
static void take_motion(pantin_animator *a, const pantin_clip *clip, const pantin_track *second, uint16_t weight) {
    int64_t ratio = ratio_of(&a->track.clip, clip);
    uint16_t c;
    a->stepped = 1;
    for (c = 0; c < a->channels; c++) {
        pantin_offset *o = &a->memory->offsets[c];
        int32_t own = a->left > 0 ? scaled(o->v, ratio) : 0;
        o->d = a->pose[c];
        o->v = sum(o->d, own);
    }
    add_motion(a, &a->track, (uint16_t)((1u << 15) - weight), clip);
    if (second) add_motion(a, second, weight, clip);
}

/* The kept poses of up to 4 channels, of this instant and of a frame later. */
static uint8_t kept(const pantin_animator *a, const pantin_group *group, int32_t *here, int32_t *next) {
    uint8_t i, count = (uint8_t)(group->length < 4 ? group->length : 4);
    for (i = 0; i < count; i++) {
        here[i] = a->memory->offsets[group->first + i].d;
        next[i] = a->memory->offsets[group->first + i].v;
    }
    return count;
}

static void keep(const pantin_animator *a, const pantin_group *group, const int32_t *here, const int32_t *next) {
    uint8_t i;
    for (i = 0; i < group->length && i < 4; i++) {
        a->memory->offsets[group->first + i].d = here[i];
        a->memory->offsets[group->first + i].v = next[i];
    }
}

/* Turns the root in the kept poses, and its horizontal velocity. */
static void turn_motion(pantin_animator *a, int32_t by) {
    int32_t here[4], next[4];
    uint8_t i, count = kept(a, &a->turns, here, next);
    pantin_heading heading;
    pantin_offset *o[2];
    int64_t velocity[2];
    turn_root(a, by, here, count);
    turn_root(a, by, next, count);
    keep(a, &a->turns, here, next);
    if (a->place_channels[0] == NO_CHANNEL || a->place_channels[1] == NO_CHANNEL) return;
    for (i = 0; i < 2; i++) o[i] = &a->memory->offsets[a->place_channels[i]];
    pantin_animator_heading(&heading, by);
    pantin_animator_rotate(&heading, difference(o[0]->v, o[0]->d), difference(o[1]->v, o[1]->d), velocity);
    for (i = 0; i < 2; i++) o[i]->v = sum(o[i]->d, (int32_t)(uint32_t)(uint64_t)velocity[i]);
}

/* Makes the kept poses the difference to the new clip's pose, and its velocity. */
static void take_difference(pantin_animator *a, uint8_t still) {
    const int32_t *values = a->track.player.pose;
    int32_t here[4], next[4];
    uint16_t c, count;
    for (c = 0; c < a->group_count; c++) {
        const pantin_group *group = &a->memory->groups[c];
        uint8_t own;
        if (group->shape == PANTIN_FREE) continue;
        own = kept(a, group, here, next);
        pantin_animator_nearest(group->shape, here, values + group->first, own);
        pantin_animator_nearest(group->shape, next, here, own);
        keep(a, group, here, next);
    }
    for (c = 0; c < a->channels; c++) {
        pantin_offset *o = &a->memory->offsets[c];
        o->v = still ? 0 : difference(o->v, o->d);
        o->d = difference(o->d, values[c]);
    }
    count = still ? 0 : moving_of(&a->track);
    for (c = 0; c < count; c++) {
        const pantin_channel *m = &a->track.player.moving[c];
        pantin_offset *o = &a->memory->offsets[m->channel];
        o->v = difference(o->v, scaled((int32_t)m->v, a->track.speed));
    }
}

/* The time in ns in which a difference of velocities dies out, at most. */
#define SWING_NS 250000000u

/* Lets differences die out in a number of frames, and their velocities in a quarter of a second at most, so that limbs do not swing past both motions. */
static void start_transition(pantin_animator *a, uint8_t frames) {
    uint32_t frame_time = a->track.clip.frame_time_ns, few = SWING_NS / frame_time + (SWING_NS % frame_time != 0);
    uint16_t c;
    uint8_t i;
    if (few < 2) few = 2;
    a->left = frames;
    a->left_then = few + 2 < frames ? (uint8_t)(frames - few) : 0;
    a->rest_ns = 0;
    for (c = 0; c < a->channels; c++) {
        pantin_offset *o = &a->memory->offsets[c], fast;
        if (!a->left_then) {
            pantin_animator_solve(frames, o);
            continue;
        }
        /* The sum of two cubics is one. */
        fast = *o;
        fast.d = o->v = 0;
        pantin_animator_solve(frames, o);
        o->v = fast.v;
        pantin_animator_solve((uint8_t)few, &fast);
        o->w = sum(o->w, fast.w);
        o->k = sum(o->k, fast.k);
    }
    /* The figure keeps its place: only the root's velocity dies out, and where it carries the root is added to the way. */
    for (i = 0; i < 2; i++) {
        if (a->place_channels[i] != NO_CHANNEL) {
            pantin_offset *o = &a->memory->offsets[a->place_channels[i]];
            o->d = (int32_t)(uint32_t)(uint64_t)-((int64_t)o->v * frames / 3);
            pantin_animator_solve(frames, o);
        }
    }
}

/* A length in another unit: times 2^shift, rounded down; cut off at the range of a channel. */
static int32_t in_unit(int32_t x, int16_t shift) {
    int64_t wide = shift >= 0 ? (int64_t)x * ((int64_t)1 << (shift < 31 ? shift : 31)) : (int64_t)x >> (shift > -31 ? -shift : 31);
    return (int32_t)clamp(wide, LEAST_VALUE, 0x7fffffffL);
}

static int64_t wide_in_unit(int64_t x, int16_t shift) {
    if (shift >= 0) return (int64_t)((uint64_t)x << (shift < 63 ? shift : 63));
    return x >> (shift > -63 ? -shift : 63);
}

/* Brings the kept poses from the old clip's form to that of the one that plays now. */
static pantin_result convert(pantin_animator *a, const pantin_clip *old) {
    const pantin_clip *clip = &a->track.clip;
    int16_t shift = (int16_t)(old->exponent - clip->exponent);
    pantin_joint joint;
    pantin_result result = find_groups(a, clip);
    if (result != PANTIN_OK) return result;
    pantin_first_joint(&joint, &clip->rig);
    while (pantin_next_joint(&joint)) {
        pantin_joint_ref ref;
        uint8_t c, rotates = 0, was;
        uint16_t g;
        for (c = 0; c < joint.channels; c++) {
            uint8_t kind = pantin_joint_kind(&joint, c);
            pantin_offset *o = &a->memory->offsets[joint.first_channel + c];
            if (kind < PANTIN_EULER_X) {
                o->d = in_unit(o->d, shift);
                o->v = in_unit(o->v, shift);
            }
            if (family_of(kind) == 1) rotates = 1;
        }
        for (g = 0; rotates && g < a->group_count; g++) {
            const pantin_group *group = &a->memory->groups[g];
            int32_t here[4], next[4], q[4];
            if (group->bit != joint.index || (group->shape != PANTIN_EULER && group->shape != PANTIN_MAP)) continue;
            was = pantin_joint_is_exponential(old, &joint) ? PANTIN_MAP : PANTIN_EULER;
            if (was != group->shape) {
                uint8_t count = kept(a, group, here, next);
                result = pantin_refer(clip, &joint, &ref);
                if (result != PANTIN_OK) return result;
                if (unit_of(was, &ref, here, count, q)) write_turn(group->shape, &ref, q, here, count);
                if (unit_of(was, &ref, next, count, q)) write_turn(group->shape, &ref, q, next, count);
                keep(a, group, here, next);
            }
            break;
        }
    }
    return find_root(a);
}

/* How a transition is made. */
typedef struct {
    uint32_t frame;
    int32_t speed;
    pantin_transition kind;
    uint8_t frames;
    const pantin_track *second; /* a weight of it is mixed in; or NULL */
    uint16_t weight;
} change;

static pantin_result go_over(pantin_animator *a, const pantin_clip *clip, const change *how) {
    uint8_t frames = how->kind == PANTIN_CUT ? 0 : how->frames;
    pantin_clip old = a->track.clip;
    pantin_placement now = a->placement;
    int32_t yaw, turned;
    uint8_t i;
    pantin_result result;
    if (old.rig.id != clip->rig.id) return PANTIN_ERROR_OTHER_RIG;
    pantin_animator_leave_carried(a);
    yaw = yaw_of(a, a->pose);
    take_motion(a, clip, how->second, how->weight);
    result = start_track(&a->track, clip, a->channels, how->frame, how->speed);
    if (result != PANTIN_OK) {
        a->left = 0;
        compose(a);
        return result;
    }
    if (old.exponent != clip->exponent || old.coding != clip->coding) {
        result = convert(a, &old);
        if (result != PANTIN_OK) return result;
        for (i = 0; i < 2; i++) now.place[i] = wide_in_unit(now.place[i], (int16_t)(old.exponent - clip->exponent));
    }
    /* The new clip's heading stands where the old one's stood. */
    turned = difference(yaw, yaw_of(a, a->track.player.pose));
    turn_motion(a, difference(0, turned));
    take_difference(a, how->kind == PANTIN_FADED);
    start_transition(a, frames);
    events_forward(a, frame_of(&a->track), frame_of(&a->track) + 1);
    compose(a);
    now.heading = sum(now.heading, turned);
    new_travel(a, &now);
    locate(a);
    return PANTIN_OK;
}

pantin_result pantin_animator_switch(pantin_animator *a, const pantin_clip *clip, uint32_t frame, int32_t speed, pantin_transition kind, uint8_t frames) {
    pantin_animator before;
    change how;
    pantin_result result = begin_call(a, &before);
    if (result != PANTIN_OK) return result;
    memset(&how, 0, sizeof how);
    how.frame = frame;
    how.speed = speed;
    how.kind = kind;
    how.frames = frames;
    begin_reads(clip);
    result = go_over(a, clip, &how);
    if (reads_of(clip, PANTIN_OK) == PANTIN_OK) return end_call(a, &before, result);
    result = reads_of(clip, PANTIN_OK);
    take_back(a, &before, a->stepped);
    (void)recover(a);
    return result;
}

/* ---- Phases of a gait ---- */

/* A cursor over the footsteps of a clip. */
typedef struct {
    pantin_event event;
    uint32_t left, right;
} footsteps;

static int first_step(footsteps *f, const pantin_clip *clip) {
    pantin_first_event(&f->event, clip);
    return pantin_find_event(clip, "left_foot_down", &f->left) == PANTIN_OK && pantin_find_event(clip, "right_foot_down", &f->right) == PANTIN_OK;
}

static int next_step(footsteps *f) {
    while (pantin_next_event(&f->event)) {
        if (f->event.id == f->left || f->event.id == f->right) return 1;
    }
    return 0;
}

static uint8_t is_right(const footsteps *f) { return f->event.id == f->right; }

/* Frames of a stride: from one footstep of the left foot to the next, on average; 0 without footsteps. */
static uint32_t stride_of(const pantin_clip *clip) {
    uint32_t strides = 0;
    footsteps f;
    if (!first_step(&f, clip)) return 0;
    while (next_step(&f)) strides += !is_right(&f);
    return strides ? clip->frames / strides : 0;
}

/* Where a gait is: the foot that came down last, and how far it is on the way to the next footstep in 2^-16. Returns 0 without footsteps. */
static int phase_of(const pantin_track *t, uint8_t *right, uint32_t *part) {
    int64_t frames = t->clip.frames, first = -1, last = -1, next = -1, end = 0, from, to;
    uint8_t last_right = 0, end_right = 0;
    footsteps f;
    if (!first_step(&f, &t->clip)) return 0;
    while (next_step(&f)) {
        if (first < 0) first = f.event.frame;
        end = f.event.frame;
        end_right = is_right(&f);
        if (f.event.frame <= frame_of(t)) {
            last = end;
            last_right = end_right;
        } else if (next < 0) {
            next = end;
        }
    }
    if (first < 0) return 0;
    /* Over the seam of the loop. */
    from = last < 0 ? end - frames : last;
    to = next < 0 ? first + frames : next;
    *right = last < 0 ? end_right : last_right;
    *part = to == from ? 0 : (uint32_t)clamp(((frame_of(t) - from) * 65536 + pantin_animator_part(t)) / (to - from), 0, 0xffff);
    return 1;
}

/* The instant of a clip, in 2^-16 frames, that is in step with another: of several strides the one that is nearest to `near`. Less than 0 without
   footsteps. */
static int64_t in_step(const pantin_track *other, const pantin_clip *clip, uint32_t near) {
    int64_t frames = clip->frames, before = -1, first = -1, best = -1, least = 0;
    uint8_t right, was_right = 0, more = 1;
    uint32_t part;
    footsteps f;
    if (!phase_of(other, &right, &part) || !first_step(&f, clip)) return -1;
    while (more) {
        int64_t to;
        more = (uint8_t)next_step(&f);
        if (!more && first < 0) break;
        to = more ? (int64_t)f.event.frame : first + frames;
        if (first < 0) first = to;
        if (before >= 0 && was_right == right) {
            int64_t at = before * 65536 + (to - before) * part, away;
            at -= quotient(at, frames * 65536) * frames * 65536;
            away = (int64_t)wide_size(at - (int64_t)near * 65536);
            if (frames * 65536 - away < away) away = frames * 65536 - away;
            if (best < 0 || away < least) {
                least = away;
                best = at;
            }
        }
        before = to;
        was_right = is_right(&f);
    }
    return best;
}

/* ---- The table of a state machine ---- */

enum { MACHINE_SECTION = 4, TABLE_VERSION = 1 };
enum { VERSION_BYTE = 0, STATES, TRANSITIONS, PARAMETERS, INPUTS, FIRST_STATE, ANY, LAYERS };
enum { HEADER_BYTES = 8, STATE_BYTES = 8, TRANSITION_BYTES = 8, PARAMETER_BYTES = 6, LAYER_BYTES = 12 };
/* The unit of times in rows, in microseconds. */
#define UNIT_US 15625u
enum { ON_END = 0, ON_INPUT, ON_RELEASE, ON_EVENT, ON_ABOVE, ON_BELOW };
#define IN_STEP 255u

static uint8_t table_byte(const pantin_character *c, uint32_t at) { return pantin_byte(c->bank.source, c->table + at); }

static int16_t table_number(const pantin_character *c, uint32_t at) {
    return (int16_t)(uint16_t)(table_byte(c, at) | (uint16_t)table_byte(c, at + 1) << 8);
}

static uint32_t state_at(uint8_t state) { return HEADER_BYTES + STATE_BYTES * (uint32_t)state; }
static uint32_t transition_at(const pantin_character *c, uint32_t index) { return state_at(c->counts[STATES]) + TRANSITION_BYTES * index; }
static uint32_t parameter_at(const pantin_character *c, uint32_t index) { return transition_at(c, c->counts[TRANSITIONS]) + PARAMETER_BYTES * index; }
static uint32_t layer_at(const pantin_character *c, uint32_t index) { return parameter_at(c, c->counts[PARAMETERS]) + LAYER_BYTES * index; }

void pantin_animator_read_state(const pantin_character *c, uint8_t state, pantin_state_row *row) {
    uint32_t at = state_at(state);
    row->clip = table_byte(c, at);
    row->other = table_byte(c, at + 1);
    row->parameter = table_byte(c, at + 2);
    row->follow = table_byte(c, at + 3);
    row->speed = (int32_t)table_number(c, at + 4) * 256;
    row->first = table_byte(c, at + 6);
    row->count = table_byte(c, at + 7);
}

/* Finds the name of an index among all names. Returns 0 if it cannot be read. */
static int name_at(const pantin_character *c, uint32_t index, pantin_name *name) {
    uint32_t at = c->table + layer_at(c, c->counts[LAYERS]);
    name->source = c->bank.source;
    name->source->failed = PANTIN_OK;
    for (; at < c->table_end; index--) {
        name->length = pantin_byte(name->source, at);
        name->start = at + 1;
        if (index == 0) return name->source->failed == PANTIN_OK;
        at += 1 + name->length;
    }
    return 0;
}

/* The index of a name among `count` that stand behind `before` others. */
static uint8_t find_name(const pantin_character *c, uint32_t before, uint8_t count, const char *name) {
    uint8_t index;
    pantin_name own;
    if (!name) return PANTIN_NO_INPUT;
    for (index = 0; index < count && name_at(c, before + index, &own); index++) {
        if (pantin_name_is(&own, name) && own.source->failed == PANTIN_OK) return index;
    }
    return PANTIN_NO_INPUT;
}

/* Whether two transitions have one cause. */
static int same_cause(const pantin_character *c, uint32_t one, uint32_t other) {
    uint32_t a = transition_at(c, one), b = transition_at(c, other);
    uint8_t cause = table_byte(c, a);
    if (cause != table_byte(c, b)) return 0;
    if (cause != ON_END && table_byte(c, a + 1) != table_byte(c, b + 1)) return 0;
    return cause < ON_ABOVE || table_number(c, a + 2) == table_number(c, b + 2);
}

static int check_transitions(const pantin_character *c, uint32_t first, uint32_t count) {
    uint32_t index, before, end = first + count;
    if (end > c->counts[TRANSITIONS]) return 0;
    for (index = first; index < end; index++) {
        uint32_t at = transition_at(c, index);
        uint8_t cause = table_byte(c, at), argument = table_byte(c, at + 1);
        if (cause > ON_BELOW || table_byte(c, at + 5) > PANTIN_FADED || table_byte(c, at + 4) >= c->counts[STATES]) return 0;
        if ((cause == ON_INPUT || cause == ON_RELEASE) && argument >= c->counts[INPUTS]) return 0;
        if (cause >= ON_ABOVE && argument >= c->counts[PARAMETERS]) return 0;
        for (before = first; before < index; before++) {
            if (same_cause(c, before, index)) return 0;
        }
    }
    return 1;
}

static uint64_t led_to(const pantin_character *c, uint32_t first, uint32_t count) {
    uint64_t states = 0;
    for (; count > 0; count--, first++) states |= (uint64_t)1 << (table_byte(c, transition_at(c, first) + 4) & 63);
    return states;
}

/* Whether transitions lead from the first state to every other. */
static int check_reach(const pantin_character *c) {
    uint64_t reached = (uint64_t)1 << c->counts[FIRST_STATE] | led_to(c, 0, c->counts[ANY]), before = 0;
    uint8_t state;
    pantin_state_row row;
    while (reached != before) {
        before = reached;
        for (state = 0; state < c->counts[STATES]; state++) {
            if (!(before >> state & 1)) continue;
            pantin_animator_read_state(c, state, &row);
            reached |= led_to(c, row.first, row.count);
        }
    }
    for (state = 0; state < c->counts[STATES]; state++) {
        if (!(reached >> state & 1)) return 0;
    }
    return 1;
}

static int check_states(const pantin_character *c) {
    uint8_t state;
    pantin_state_row row;
    if (!check_transitions(c, 0, c->counts[ANY])) return 0;
    for (state = 0; state < c->counts[STATES]; state++) {
        pantin_animator_read_state(c, state, &row);
        if ((row.other == PANTIN_NO_CLIP && row.follow) || row.speed < -4 * PANTIN_SPEED || row.speed > 4 * PANTIN_SPEED) return 0;
        if (row.clip >= c->bank.clips || !check_transitions(c, row.first, row.count)) return 0;
        if (row.other != PANTIN_NO_CLIP && (row.other >= c->bank.clips || row.parameter >= c->counts[PARAMETERS])) return 0;
    }
    return check_reach(c);
}

/* Whether bytes are UTF-8. */
static int is_text(pantin_source *source, uint32_t at, uint32_t end) {
    while (at < end) {
        uint8_t lead = pantin_byte(source, at++), more = (uint8_t)(lead < 0x80 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3), low = 0x80, high = 0xbf;
        if ((lead >= 0x80 && lead < 0xc2) || lead > 0xf4) return 0;
        if (lead == 0xe0) low = 0xa0;
        if (lead == 0xed) high = 0x9f;
        if (lead == 0xf0) low = 0x90;
        if (lead == 0xf4) high = 0x8f;
        for (; more > 0; more--, low = 0x80, high = 0xbf) {
            uint8_t byte = at < end ? pantin_byte(source, at) : 0;
            at++;
            if (byte < low || byte > high) return 0;
        }
    }
    return 1;
}

/* Checks that the names end where the table does, and that the joints of layers are text. */
static int check_names(const pantin_character *c) {
    uint32_t at = c->table + layer_at(c, c->counts[LAYERS]);
    uint16_t names = (uint16_t)(c->counts[STATES] + c->counts[PARAMETERS] + c->counts[INPUTS] + c->counts[LAYERS]);
    for (; names > 0 && at < c->table_end; names--) {
        uint32_t next = at + 1 + pantin_byte(c->bank.source, at);
        if (next > c->table_end || (names <= c->counts[LAYERS] && !is_text(c->bank.source, at + 1, next))) return 0;
        at = next;
    }
    return names == 0 && at == c->table_end;
}

/* Checks the table once: afterwards every row that another names is there. */
static int check_table(pantin_character *c) {
    uint8_t i;
    if (c->table_end - c->table < HEADER_BYTES) return 0;
    for (i = 0; i < 8; i++) c->counts[i] = table_byte(c, i);
    if (c->counts[VERSION_BYTE] != TABLE_VERSION || c->counts[STATES] > 64 || c->counts[PARAMETERS] > 8 || c->counts[INPUTS] > 32 ||
        c->counts[LAYERS] > 4 || c->counts[FIRST_STATE] >= c->counts[STATES] || !check_names(c)) {
        return 0;
    }
    for (i = 0; i < c->counts[PARAMETERS]; i++) {
        uint32_t at = parameter_at(c, i);
        int16_t low = table_number(c, at), high = table_number(c, at + 2);
        c->parameters[i] = table_number(c, at + 4);
        if (low >= high || c->parameters[i] < low || c->parameters[i] > high) return 0;
    }
    for (i = 0; i < c->counts[LAYERS]; i++) {
        uint32_t at = layer_at(c, i);
        if (table_byte(c, at) >= c->bank.clips || table_byte(c, at + 1) >= c->counts[INPUTS] || table_byte(c, at + 3)) return 0;
    }
    return check_states(c);
}

/* ---- Characters ---- */

static pantin_result open_clip(const pantin_character *c, uint8_t index, pantin_clip *clip) {
    pantin_entry entry;
    pantin_first_entry(&entry, &c->bank);
    do {
        if (!pantin_next_entry(&entry)) return c->bank.source->error != PANTIN_OK ? c->bank.source->error : PANTIN_NOT_FOUND;
    } while (index-- > 0);
    return pantin_open_entry(clip, &entry);
}

/* Whether channels of a joint move in a clip, or turn the joint. */
static int joint_moves(const pantin_player *p, const pantin_joint *joint) {
    uint16_t m;
    for (m = 0; m < moving_count(p); m++) {
        uint16_t at = (uint16_t)(p->moving[m].channel - joint->first_channel);
        if (at < joint->channels) return 1;
    }
    return 0;
}

static int joint_is_turned(const pantin_player *p, const pantin_joint *joint) {
    uint8_t c;
    for (c = 0; c < joint->channels; c++) {
        uint8_t kind = pantin_joint_kind(joint, c);
        if (kind >= PANTIN_EULER_X && (family_of(kind) != 1 || p->pose[joint->first_channel + c] != 0)) return 1;
    }
    return 0;
}

/* The carrier of a figure that plays several clips: the first joint with positions that moves in one of them. Captures often hang on a joint that stands
   still at the origin; where one above the carrier is turned, it stays the carrier. */
static pantin_result find_carrier(pantin_character *c, const pantin_animator_memory *memory, uint16_t *found) {
    pantin_track *t = &c->animator.track;
    uint16_t carrier = 0xffff, upright = 0xffff;
    uint8_t state, done = 0;
    for (state = 0; state < c->counts[STATES]; state++) {
        pantin_joint joint;
        pantin_state_row row;
        pantin_result result;
        pantin_animator_read_state(c, state, &row);
        result = open_clip(c, row.clip, &t->clip);
        if (result != PANTIN_OK) return result;
        /* Then a player would neither change the carrier nor lack memory. */
        if (done && c->bank.rig.channels <= memory->moving_room && c->bank.rig.channels <= memory->channel_room) continue;
        result = start_player(t, memory->moving, memory->moving_room, memory->values, memory->channel_room);
        if (result != PANTIN_OK) return result;
        pantin_first_joint(&joint, &t->clip.rig);
        while (pantin_next_joint(&joint) && joint.index < carrier) {
            if (has_positions(&joint) && joint_moves(&t->player, &joint)) {
                carrier = joint.index;
                /* No joint before it has channels. */
                done = joint.first_channel == 0;
                break;
            }
            if (joint_is_turned(&t->player, &joint) && joint.index < upright) upright = joint.index;
        }
    }
    *found = carrier == 0xffff || upright < carrier ? first_with_positions(&c->bank.rig) : carrier;
    return PANTIN_OK;
}

/* The frame at which a state's clip begins: one that plays backwards and is no loop begins at its last frame, instead of frame 0, where it would be over. */
static uint32_t begun(uint32_t frame, const pantin_clip *clip, int32_t speed) { return frame == 0 && speed < 0 && !clip->looped ? clip->frames - 1 : frame; }

/* Finds out whether the bank has feet that were not declared absent. */
static pantin_result look_for_feet(pantin_character *c) {
    uint32_t start, end;
    pantin_result feet = c->without & PANTIN_WITHOUT_FEET ? PANTIN_NOT_FOUND : pantin_find_section(&c->bank, PANTIN_FEET_SECTION, &start, &end);
    c->needs_feet = feet == PANTIN_OK;
    return feet == PANTIN_NOT_FOUND ? PANTIN_OK : feet;
}

static pantin_result open_character(pantin_character *c, pantin_source *source, const pantin_animator_memory *memory, uint8_t without) {
    static const pantin_placement nowhere = {{0, 0}, 0};
    pantin_clip first;
    uint16_t carrier = 0;
    pantin_state_row row;
    uint32_t frame;
    pantin_result result;
    memset(c, 0, sizeof *c);
    c->without = without;
    c->waiting = PANTIN_NO_TRANSITION;
    result = pantin_open_bank(&c->bank, source);
    if (result == PANTIN_OK) result = pantin_find_section(&c->bank, MACHINE_SECTION, &c->table, &c->table_end);
    if (result != PANTIN_OK) return result;
    if (!check_table(c)) return source->error != PANTIN_OK ? source->error : PANTIN_ERROR_MACHINE;
    result = look_for_feet(c);
    if (result == PANTIN_OK) result = find_carrier(c, memory, &carrier);
    if (result != PANTIN_OK) return result;
    c->state = c->counts[FIRST_STATE];
    pantin_animator_read_state(c, c->state, &row);
    result = open_clip(c, row.clip, &first);
    if (result == PANTIN_OK) result = open_carried(&c->animator, &first, memory, carrier);
    if (result != PANTIN_OK) return result;
    set_speed(&c->animator.track, row.speed);
    frame = begun(0, &first, row.speed);
    if (frame == 0) return PANTIN_OK;
    result = seek_track(&c->animator.track, frame);
    compose(&c->animator);
    pantin_animator_stand(&c->animator, &nowhere);
    return result;
}

pantin_result pantin_character_open(pantin_character *c, pantin_source *source, const pantin_animator_memory *memory, uint8_t without) {
    pantin_result result;
    source->failed = PANTIN_OK;
    result = open_character(c, source, memory, without);
    if (source->failed != PANTIN_OK) result = source->failed;
    if (result != PANTIN_OK) memset(c, 0, sizeof *c);
    return result;
}

pantin_result pantin_character_second(pantin_character *c, pantin_track *track, pantin_channel *moving, size_t moving_room, int32_t *values,
                                      size_t value_room) {
    pantin_state_row row;
    pantin_result result;
    if (!c->bank.source) return PANTIN_ERROR_HEAD;
    memset(track, 0, sizeof *track);
    track->speed = PANTIN_SPEED;
    c->bank.source->failed = PANTIN_OK;
    pantin_animator_read_state(c, c->state, &row);
    result = open_clip(c, row.clip, &track->clip);
    if (result == PANTIN_OK) result = start_player(track, moving, moving_room, values, value_room);
    if (c->bank.source->failed != PANTIN_OK) result = c->bank.source->failed;
    if (result == PANTIN_OK) c->second = track;
    return result;
}

uint8_t pantin_character_state(const pantin_character *c, const char *name) { return find_name(c, 0, c->counts[STATES], name); }

int pantin_character_state_name(const pantin_character *c, uint8_t state, pantin_name *name) {
    return state < c->counts[STATES] && name_at(c, state, name);
}

uint8_t pantin_character_parameter(const pantin_character *c, const char *name) { return find_name(c, c->counts[STATES], c->counts[PARAMETERS], name); }

uint8_t pantin_character_input(const pantin_character *c, const char *name) {
    return find_name(c, (uint32_t)c->counts[STATES] + c->counts[PARAMETERS], c->counts[INPUTS], name);
}

static uint32_t bit_of(uint8_t input) { return input < 32 ? (uint32_t)1 << input : 0; }

void pantin_character_fire(pantin_character *c, uint8_t input) { c->fired |= bit_of(input); }

void pantin_character_hold(pantin_character *c, uint8_t input, int down) {
    c->held = down ? c->held | bit_of(input) : c->held & ~bit_of(input);
}

void pantin_character_set(pantin_character *c, uint8_t parameter, int16_t value) {
    int16_t low, high;
    if (parameter >= c->counts[PARAMETERS]) return;
    c->bank.source->failed = PANTIN_OK;
    low = table_number(c, parameter_at(c, parameter));
    high = table_number(c, parameter_at(c, parameter) + 2);
    if (c->bank.source->failed == PANTIN_OK) c->parameters[parameter] = (int16_t)clamp(value, low, high);
}

/* ---- Blends ---- */

/* Mixes the channels of a group: a weight of the way to another pose, the shortest one. */
static void mix_group(uint8_t shape, int32_t *own, const int32_t *to, uint8_t count, uint16_t weight) {
    uint8_t i, far = shape == PANTIN_UNIT;
    if (shape != PANTIN_FREE && weight != 1u << 15) {
        /* Farther than a quarter turn either way. */
        for (i = 0; i < count; i++) far |= (uint32_t)difference(to[i], own[i]) + 0x40000000u > 0x80000000u;
        if (far) pantin_animator_nearest(shape, own, to, count);
    }
    for (i = 0; i < count; i++) own[i] = sum(own[i], weighted(difference(to[i], own[i]), weight));
}

/* Mixes another clip into the pose of this instant: all joints, but not the root's horizontal place. */
static pantin_result mix(pantin_animator *a, const pantin_track *other, uint16_t weight) {
    const pantin_clip *own = &a->track.clip, *its = &other->clip;
    uint16_t g;
    uint8_t i;
    if (own->rig.id != its->rig.id || own->exponent != its->exponent || own->coding != its->coding) return PANTIN_ERROR_OTHER_RIG;
    for (g = 0; g < a->group_count; g++) {
        const pantin_group *group = &a->memory->groups[g];
        mix_group(group->shape, a->pose + group->first, other->player.pose + group->first, group->length, weight);
    }
    add_part(other, weight, a->pose);
    for (i = 0; i < 2; i++) {
        if (a->place_channels[i] != NO_CHANNEL) a->pose[a->place_channels[i]] = 0;
    }
    return PANTIN_OK;
}

/* How much of the second clip a parameter mixes in. */
static uint16_t weight_of(const pantin_character *c, uint8_t parameter) {
    int32_t low = table_number(c, parameter_at(c, parameter)), high = table_number(c, parameter_at(c, parameter) + 2);
    /* So that bytes that cannot be read divide nothing by 0. */
    if (high <= low) return 0;
    return (uint16_t)clamp((int64_t)(c->parameters[parameter] - low) * 32768 / (high - low), 0, 1 << 15);
}

/* Lets a blend follow its parameter. */
static void follow(pantin_character *c, uint32_t elapsed_us) {
    pantin_state_row row;
    uint64_t step;
    uint16_t to;
    if (!c->blending) return;
    pantin_animator_read_state(c, c->state, &row);
    to = weight_of(c, row.parameter);
    if (row.follow) {
        uint32_t whole_us = row.follow * UNIT_US;
        step = (((uint64_t)elapsed_us << 15) + whole_us - 1) / whole_us;
        to = (uint16_t)clamp(to, c->mixed - (int64_t)step, c->mixed + (int64_t)step);
    }
    c->mixed = to;
}

/* Where the root is in a clip. */
static void root_place(const pantin_animator *a, const pantin_track *t, int32_t *place) {
    uint16_t m, part = pantin_animator_part(t) >> 1;
    uint8_t i;
    for (i = 0; i < 2; i++) {
        uint16_t channel = a->place_channels[i];
        place[i] = channel == NO_CHANNEL ? 0 : t->player.pose[channel];
        for (m = 0; t->rest && m < moving_count(&t->player); m++) {
            const pantin_channel *own = &t->player.moving[m];
            if (own->channel == channel) place[i] = sum(place[i], weighted((int32_t)own->v, part));
        }
    }
}

/* The way between two instants of a loop, less than a lap, in the clip's axes. Returns 0 over a seam that turns the figure. */
static int way_between(const pantin_clip_instant *before, const pantin_clip_instant *now, const pantin_seam *seam, int forward, int32_t *way) {
    int lap = forward ? now->frame < before->frame || (now->frame == before->frame && now->part < before->part)
                      : now->frame > before->frame || (now->frame == before->frame && now->part > before->part);
    uint8_t i;
    if (lap && (!seam->known || seam->yaw)) return 0;
    for (i = 0; i < 2; i++) {
        int32_t over = (int32_t)(uint32_t)(uint64_t)seam->place[i];
        way[i] = difference(now->place[i], before->place[i]);
        if (lap) way[i] = forward ? sum(way[i], over) : difference(way[i], over);
    }
    return 1;
}

/* Lets the second clip lead the figure too: by a weight of its way since the update before. */
static void lead(pantin_character *c, uint16_t weight) {
    pantin_animator *a = &c->animator;
    const pantin_track *tracks[2];
    pantin_clip_instant now[2];
    int32_t ways[2][2];
    int64_t way[2];
    int forward = a->track.speed >= 0;
    uint8_t i;
    tracks[0] = &a->track;
    tracks[1] = c->second;
    for (i = 0; i < 2; i++) {
        now[i].frame = frame_of(tracks[i]);
        now[i].part = pantin_animator_part(tracks[i]);
    }
    memcpy(now[0].place, a->place, sizeof now[0].place);
    root_place(a, c->second, now[1].place);
    if (c->led && way_between(&c->instants[0], &now[0], &a->track.seam, forward, ways[0]) &&
        way_between(&c->instants[1], &now[1], &c->second->seam, forward, ways[1])) {
        pantin_animator_rotate(&a->lap_heading, weighted(difference(ways[1][0], ways[0][0]), weight), weighted(difference(ways[1][1], ways[0][1]), weight), way);
        for (i = 0; i < 2; i++) a->origin[i] = wide_sum(a->origin[i], (int64_t)(0u - (uint64_t)way[i]));
        locate(a);
    }
    memcpy(c->instants, now, sizeof now);
    c->led = 1;
}

/* Brings the second clip in step with the first by the footsteps of both, and lets the first play at a speed between the two. */
static pantin_result keep_step(pantin_character *c, const pantin_state_row *row, uint16_t weight) {
    pantin_track *own = &c->animator.track, *second = c->second;
    uint32_t stride = stride_of(&own->clip), other = stride_of(&second->clip);
    int64_t time, its, mixed, at;
    pantin_result result;
    if (!stride || !other) return seek_track(second, frame_of(own));
    /* The stride takes a time between those of the two clips, whatever their frame rates. */
    time = (int64_t)stride * own->clip.frame_time_ns;
    its = (int64_t)other * second->clip.frame_time_ns;
    mixed = time + (((its - time) * weight) >> 15);
    set_speed(own, (int32_t)(mixed ? clamp(time * row->speed / mixed, -4 * PANTIN_SPEED, 4 * PANTIN_SPEED) : 0));
    set_speed(second, (int32_t)(mixed ? clamp(its * row->speed / mixed, -4 * PANTIN_SPEED, 4 * PANTIN_SPEED) : 0));
    at = in_step(own, &second->clip, frame_of(second));
    if (at < 0) return PANTIN_NOT_FOUND;
    result = seek_track(second, (uint32_t)(at >> 16));
    second->rest = (at & 0xffff) * second->clip.frame_time_ns;
    if (result == PANTIN_OK && second->rest) result = close_loop(second, NULL);
    if (result == PANTIN_OK && own->clip.looped && second->clip.looped) lead(c, weight);
    return result;
}

/* Mixes the second clip of a state that blends in. */
static pantin_result blend(pantin_character *c) {
    pantin_state_row row;
    pantin_result result;
    pantin_animator_read_state(c, c->state, &row);
    if (row.other == PANTIN_NO_CLIP) return PANTIN_OK;
    if (!c->second) return c->without & PANTIN_WITHOUT_BLENDS ? PANTIN_OK : PANTIN_UNSUPPORTED;
    if (!c->blending) {
        pantin_clip clip;
        result = open_clip(c, row.other, &clip);
        if (result == PANTIN_OK) result = start_track(c->second, &clip, c->animator.channels, 0, row.speed);
        if (result == PANTIN_OK && clip.looped) {
            /* Where a lap takes the root. */
            result = go_to(c->second, 0xffffffffu);
            if (result == PANTIN_OK) result = lap(c->second, &c->animator);
        }
        if (result != PANTIN_OK) return result;
        c->blending = 1;
        c->led = 0;
        c->mixed = row.follow ? 0 : weight_of(c, row.parameter);
    }
    result = keep_step(c, &row, c->mixed);
    return result == PANTIN_OK ? mix(&c->animator, c->second, c->mixed) : result;
}

/* ---- Transitions of the machine ---- */

/* How often the state changes in one instant, and at how many instants in the middle of an update, at most. */
#define CHANGES 4

/* Inputs that a transition looks at, and the first event that counts. */
typedef struct {
    uint32_t down, up;
    uint8_t heard;
} seen_inputs;

static int happens(const pantin_character *c, uint32_t at, const seen_inputs *inputs) {
    const pantin_animator *a = &c->animator;
    uint8_t argument = table_byte(c, at + 1), i;
    int16_t threshold = table_number(c, at + 2);
    switch (table_byte(c, at)) {
    case ON_END: return a->track.ended;
    case ON_INPUT: return (inputs->down & bit_of(argument)) != 0;
    case ON_RELEASE: return (inputs->up & bit_of(argument)) != 0;
    case ON_ABOVE: return c->parameters[argument & 7] > threshold;
    case ON_BELOW: return c->parameters[argument & 7] < threshold;
    default:
        for (i = inputs->heard; i < a->event_count; i++) {
            if (a->events[i].id == argument) return 1;
        }
        return 0;
    }
}

/* In place of a frame: the one that the transition's row names. */
#define ROW_FRAME 0xffffffffu

/* Makes a transition, to a frame of the new clip. */
static pantin_result make(pantin_character *c, uint32_t transition, uint32_t frame) {
    pantin_animator *a = &c->animator;
    uint32_t at = transition_at(c, transition);
    uint8_t to = table_byte(c, at + 4), first = table_byte(c, at + 7);
    pantin_clip clip;
    pantin_state_row row;
    pantin_result result;
    change how;
    pantin_animator_read_state(c, to, &row);
    result = open_clip(c, row.clip, &clip);
    /* Until here the pose has the first clip's part alone. */
    if (result == PANTIN_OK && c->blending) result = blend(c);
    if (result != PANTIN_OK) return result;
    if (frame == ROW_FRAME) {
        /* Without footsteps it begins at its first frame. */
        int64_t instant = first == IN_STEP ? in_step(&a->track, &clip, 0) : (int64_t)first << 16;
        frame = instant < 0 ? 0 : (uint32_t)(instant >> 16);
    }
    how.frame = begun(frame, &clip, row.speed);
    how.speed = row.speed;
    how.kind = (pantin_transition)table_byte(c, at + 5);
    how.frames = table_byte(c, at + 6);
    how.second = c->blending ? c->second : NULL;
    how.weight = how.second ? c->mixed : 0;
    result = go_over(a, &clip, &how);
    if (result != PANTIN_OK) return result;
    c->state = to;
    c->waiting = PANTIN_NO_TRANSITION;
    c->blending = c->led = 0;
    c->entered = 1;
    return PANTIN_OK;
}

/* More than the index of any transition. */
#define NONE_HAPPENS 256u

/* Takes the first transition that may be taken now. Once there is more than one state in `been`, a transition that leads to one of them is left out. `made`
 * is 1 if there was one. */
static pantin_result enter(pantin_character *c, const seen_inputs *inputs, uint64_t been, uint8_t *made) {
    uint64_t own = (uint64_t)1 << c->state, ns;
    uint32_t index, any = c->counts[ANY], wanted = NONE_HAPPENS, frame;
    uint8_t ended = c->waiting != PANTIN_NO_TRANSITION && c->animator.track.ended;
    pantin_state_row row;
    pantin_animator_read_state(c, c->state, &row);
    for (index = 0; index < any + row.count && wanted == NONE_HAPPENS; index++) {
        uint32_t transition = index < any ? index : row.first + (index - any), at = transition_at(c, transition);
        uint8_t to = table_byte(c, at + 4);
        if (index < any && to == c->state) continue;
        /* In its first state, a machine may start the same state again. */
        if ((been == own || !(been >> to & 1)) && happens(c, at, inputs)) wanted = transition;
    }
    /* One that waits is made unless one before it happens, and at the end of its clip. */
    if (wanted >= c->waiting) wanted = ended ? c->waiting : NONE_HAPPENS;
    if (wanted == NONE_HAPPENS) return PANTIN_OK;
    if (!ended && c->feet && c->feet_calls->next(c, (uint8_t)wanted, &frame, &ns)) {
        c->waiting = (uint8_t)wanted;
        return PANTIN_OK;
    }
    *made = 1;
    return make(c, wanted, ROW_FRAME);
}

/* Makes a transition, then those of the states that are entered: all in one instant, so that the display rate does not matter. Inputs are `first` for the
   first one and `then` for the others, of which none leads back. */
static pantin_result enter_all(pantin_character *c, const seen_inputs *first, const seen_inputs *then, uint8_t *made) {
    seen_inputs inputs = *first;
    uint64_t been = 0;
    uint8_t i, entered = 1;
    pantin_result result = PANTIN_OK;
    *made = 0;
    for (i = 0; i < CHANGES && entered && result == PANTIN_OK; i++) {
        been |= (uint64_t)1 << c->state;
        entered = 0;
        result = enter(c, &inputs, been, &entered);
        inputs = *then;
        inputs.heard = c->animator.event_count;
        *made |= entered;
    }
    return result;
}

static pantin_result run(pantin_character *c, uint64_t left_ns) {
    pantin_animator *a = &c->animator;
    seen_inputs before, now, held;
    uint8_t i, made = 0;
    pantin_result result;
    before.down = c->held & c->held_before;
    before.up = ~(c->held | c->held_before);
    before.heard = 0;
    for (i = 0; i < CHANGES; i++) {
        uint64_t whole_ns, rest_ns;
        uint32_t frame;
        /* One that waits begins in the middle of the time. */
        uint8_t waited = c->waiting != PANTIN_NO_TRANSITION && c->feet && c->feet_calls->next(c, c->waiting, &frame, &whole_ns) && whole_ns < left_ns;
        if (!waited) whole_ns = left_ns;
        before.heard = a->event_count;
        result = play(a, whole_ns, &rest_ns);
        if (result != PANTIN_OK) return result;
        left_ns = left_ns - whole_ns + rest_ns;
        if (left_ns == 0) break;
        made = 1;
        result = waited ? make(c, c->waiting, frame) : enter_all(c, &before, &before, &made);
        if (result != PANTIN_OK) return result;
        if (!made) break;
        result = blend(c);
        if (result != PANTIN_OK) return result;
    }
    hold(a, left_ns);
    now.down = c->fired | c->held;
    now.up = held.up = ~c->held;
    held.down = c->held;
    now.heard = held.heard = before.heard;
    result = enter_all(c, &now, &held, &made);
    return result == PANTIN_OK ? blend(c) : result;
}

/* ---- Layers ---- */

enum { RESTS = 0, PLAYS, FADES };

/* Whether a name matches a pattern of `length` bytes at `start`, in which * stands for any characters and ? for one. */
static int matches(pantin_source *source, uint32_t start, uint32_t length, const pantin_name *name) {
    uint32_t at = 0, from = 0, behind = 0, taken = 0;
    uint8_t star = 0;
    while (at < name->length) {
        uint8_t byte = from < length ? pantin_byte(source, start + from) : 0;
        if (from < length && byte == '*') {
            star = 1;
            behind = ++from;
            taken = at;
        } else if (from < length && (byte == '?' || byte == pantin_name_byte(name, at))) {
            at++;
            from++;
        } else if (star) {
            from = behind;
            at = ++taken;
        } else {
            return 0;
        }
    }
    while (from < length && pantin_byte(source, start + from) == '*') from++;
    return from == length;
}

/* Adds the joints and scalars that match a pattern, which " +" follows if joints below those are meant too. */
static pantin_result add_matching(const pantin_rig *rig, pantin_source *source, uint32_t start, uint32_t end, uint32_t *words) {
    uint8_t hanging[PANTIN_MAX_JOINTS / 8 + 1], below = 0, found = 0;
    pantin_joint joint;
    pantin_scalar scalar;
    memset(hanging, 0, sizeof hanging);
    if (end - start >= 2 && pantin_byte(source, end - 2) == ' ' && pantin_byte(source, end - 1) == '+') {
        below = 1;
        end -= 2;
    }
    pantin_first_joint(&joint, rig);
    while (pantin_next_joint(&joint)) {
        uint8_t own = !joint.end_site && matches(source, start, end - start, &joint.name);
        /* A parent comes before its children. */
        if (!own && !(below && joint.parent != PANTIN_NO_PARENT && hanging[joint.parent >> 3] >> (joint.parent & 7) & 1)) continue;
        hanging[joint.index >> 3] = (uint8_t)(hanging[joint.index >> 3] | 1u << (joint.index & 7));
        words[joint.index >> 5] |= (uint32_t)1 << (joint.index & 31);
        found |= own;
    }
    pantin_first_scalar(&scalar, rig);
    while (pantin_next_scalar(&scalar)) {
        uint16_t bit = (uint16_t)(rig->joints + scalar.index);
        if (!matches(source, start, end - start, &scalar.name)) continue;
        words[bit >> 5] |= (uint32_t)1 << (bit & 31);
        found = 1;
    }
    if (rig->source->error != PANTIN_OK) return rig->source->error;
    return found ? PANTIN_OK : PANTIN_NOT_FOUND;
}

/* The mask of a layer, by the patterns of its name: one a line. */
static pantin_result find_mask(const pantin_character *c, uint8_t layer, uint32_t *words) {
    uint32_t at = c->table + layer_at(c, c->counts[LAYERS]), end, line;
    uint16_t before = (uint16_t)(c->counts[STATES] + c->counts[PARAMETERS] + c->counts[INPUTS] + layer);
    pantin_source *source = c->bank.source;
    pantin_result result = PANTIN_OK;
    for (; before > 0; before--) at += 1u + pantin_byte(source, at);
    end = at + 1 + pantin_byte(source, at);
    for (at++, line = at; result == PANTIN_OK && line <= end; line++) {
        if (line < end && pantin_byte(source, line) != '\n') continue;
        result = add_matching(&c->bank.rig, source, at, line, words);
        at = line + 1;
    }
    return result;
}

pantin_result pantin_character_layer(pantin_character *c, pantin_layer *layer, pantin_channel *moving, size_t moving_room, int32_t *values,
                                     int32_t *sampled, size_t channel_room, uint32_t *words, size_t word_room) {
    uint8_t index = c->layer_count, i;
    uint32_t at = layer_at(c, index), needed = ((uint32_t)c->bank.rig.joints + c->bank.rig.scalars + 31) / 32;
    pantin_result result;
    if (index >= c->counts[LAYERS]) return PANTIN_NOT_FOUND;
    c->bank.source->failed = PANTIN_OK;
    memset(layer, 0, sizeof *layer);
    layer->clip = table_byte(c, at);
    layer->input = table_byte(c, at + 1);
    layer->fade_us = table_byte(c, at + 2) * UNIT_US;
    for (i = 0; i < 8; i++) layer->states |= (uint64_t)table_byte(c, at + 4 + i) << (8 * i);
    layer->sampled = sampled;
    layer->words = words;
    layer->track.speed = PANTIN_SPEED;
    if (channel_room < c->bank.rig.channels || word_room < needed) return PANTIN_NO_ROOM;
    memset(words, 0, needed * sizeof *words);
    result = open_clip(c, layer->clip, &layer->track.clip);
    if (result == PANTIN_OK) result = find_mask(c, index, words);
    if (result == PANTIN_OK) result = start_player(&layer->track, moving, moving_room, values, channel_room);
    if (c->bank.source->failed != PANTIN_OK) result = c->bank.source->failed;
    if (result == PANTIN_OK) c->layers[c->layer_count++] = layer;
    return result;
}

/* Lets a weight go to another one in the time of the layer, at once if that is 0. */
static void fade_to(pantin_layer *l, uint16_t weight) {
    l->to = weight;
    l->left_us = l->fade_us;
    if (l->fade_us == 0) l->weight = weight;
}

static void fade(pantin_layer *l, uint32_t elapsed_us) {
    if (elapsed_us >= l->left_us) {
        l->weight = l->to;
        l->left_us = 0;
    } else {
        l->weight = (uint16_t)(l->weight + ((int64_t)l->to - l->weight) * elapsed_us / l->left_us);
        l->left_us -= elapsed_us;
    }
}

/* Whether a layer is to go: a loop when its input is let go, another clip when what is left of it is the time that it takes to go. */
static int is_over(const pantin_character *c, const pantin_layer *l) {
    const pantin_clip *clip = &l->track.clip;
    uint32_t next = frame_of(&l->track) + 1;
    if (clip->looped) return !(c->held & bit_of(l->input));
    return l->track.ended || (uint64_t)(clip->frames > next ? clip->frames - next : 0) * clip->frame_time_ns <= (uint64_t)l->fade_us * 1000;
}

/* Puts a layer over the pose of this instant, but not over the root's horizontal place. */
static pantin_result put_over(pantin_animator *a, const pantin_layer *l) {
    const pantin_clip *own = &a->track.clip, *its = &l->track.clip;
    uint16_t g;
    uint8_t i;
    memcpy(l->sampled, l->track.player.pose, a->channels * sizeof *l->sampled);
    add_part(&l->track, 1u << 15, l->sampled);
    if (own->exponent != its->exponent || own->coding != its->coding) return PANTIN_ERROR_OTHER_RIG;
    for (g = 0; g < a->group_count && l->weight; g++) {
        const pantin_group *group = &a->memory->groups[g];
        if (!(l->words[group->bit >> 5] >> (group->bit & 31) & 1)) continue;
        mix_group(group->shape, a->pose + group->first, l->sampled + group->first, group->length, l->weight);
    }
    for (i = 0; i < 2; i++) {
        if (a->place_channels[i] != NO_CHANNEL) a->pose[a->place_channels[i]] = 0;
    }
    return PANTIN_OK;
}

static pantin_result update_layer(pantin_character *c, pantin_layer *l, uint32_t elapsed_us) {
    uint8_t allowed = l->states >> (c->state & 63) & 1;
    pantin_result result;
    passage p;
    uint64_t left_ns;
    if (l->doing == RESTS) {
        pantin_clip clip;
        if (!allowed || !(c->seen & bit_of(l->input))) return PANTIN_OK;
        result = open_clip(c, l->clip, &clip);
        if (result == PANTIN_OK) result = start_track(&l->track, &clip, c->animator.channels, 0, PANTIN_SPEED);
        if (result != PANTIN_OK) return result;
        fade_to(l, 1u << 15);
        l->doing = PLAYS;
    } else {
        result = advance(&l->track, NULL, (uint64_t)elapsed_us * 1000, &p, &left_ns);
        if (result != PANTIN_OK) return result;
        fade(l, elapsed_us);
    }
    if (l->doing == PLAYS && (!allowed || is_over(c, l))) {
        fade_to(l, 0);
        l->doing = FADES;
    }
    if (l->doing == FADES && l->weight == 0) {
        l->doing = RESTS;
        return PANTIN_OK;
    }
    return put_over(&c->animator, l);
}

/* ---- An update ---- */

/* What an update changes in a layer. */
typedef struct {
    int64_t rest;
    uint32_t frame, left_us;
    uint16_t weight, to;
    uint8_t doing, ended, closed;
} kept_layer;

static void keep_layer(const pantin_layer *l, kept_layer *to) {
    to->rest = l->track.rest;
    to->frame = frame_of(&l->track);
    to->left_us = l->left_us;
    to->weight = l->weight;
    to->to = l->to;
    to->doing = l->doing;
    to->ended = l->track.ended;
    to->closed = l->track.closed;
}

static void take_layer_back(pantin_layer *l, const kept_layer *from) {
    l->track.rest = from->rest;
    l->track.player.frame = from->frame;
    l->left_us = from->left_us;
    l->weight = from->weight;
    l->to = from->to;
    l->doing = from->doing;
    l->track.ended = from->ended;
    l->track.closed = from->closed;
}

/* Starts the second clip again, at its frame. */
static pantin_result start_second_again(pantin_character *c) {
    pantin_track *own = &c->animator.track;
    int32_t speed = own->speed;
    uint8_t ended = own->ended;
    uint32_t frame = frame_of(c->second);
    pantin_seam seam = c->second->seam;
    pantin_clip clip;
    pantin_state_row row;
    pantin_result result;
    pantin_animator_read_state(c, c->state, &row);
    result = open_clip(c, row.other, &clip);
    if (result == PANTIN_OK) result = start_track(c->second, &clip, c->animator.channels, frame, row.speed);
    c->second->seam = seam;
    if (result == PANTIN_OK) result = blend(c);
    /* Both are those of the update before until this one ends. */
    own->speed = speed;
    own->ended = ended;
    if (c->bank.source->failed != PANTIN_OK) result = c->bank.source->failed;
    if (result != PANTIN_OK) c->second->player.frame = frame;
    return result;
}

/* Makes a character one again whose players were read in part. */
static pantin_result recover_all(pantin_character *c) {
    pantin_result result = recover(&c->animator);
    uint8_t i;
    if (result == PANTIN_OK && c->blending) result = start_second_again(c);
    for (i = 0; result == PANTIN_OK && i < c->layer_count; i++) {
        pantin_layer *l = c->layers[i];
        if (l->doing == RESTS) continue;
        result = start_again(&l->track, NULL, c->animator.channels);
        if (result == PANTIN_OK) result = put_over(&c->animator, l);
    }
    if (result == PANTIN_OK && c->feet) result = c->feet_calls->again(c);
    if (result != PANTIN_OK && !c->animator.track.stale) c->animator.track.stale = STALE;
    return result;
}

/* Takes an update back: a transition of clips whose differences have changed ends. */
static void take_back_all(pantin_character *c, const pantin_character *before, const kept_layer *layers, uint32_t frame) {
    uint8_t stepped = c->animator.stepped, i;
    *c = *before;
    take_back(&c->animator, &before->animator, stepped);
    for (i = 0; i < c->layer_count; i++) take_layer_back(c->layers[i], &layers[i]);
    if (c->second) c->second->player.frame = frame;
    (void)recover_all(c);
}

pantin_result pantin_character_update(pantin_character *c, uint32_t elapsed_us) {
    pantin_character before;
    kept_layer layers[4];
    pantin_result result = PANTIN_OK, read;
    uint32_t frame;
    uint8_t i;
    if (!c->bank.source) return PANTIN_ERROR_HEAD;
    if (c->layer_count < c->counts[LAYERS] && !(c->without & PANTIN_WITHOUT_LAYERS)) return PANTIN_UNSUPPORTED;
    if (c->needs_feet && !c->feet) return PANTIN_UNSUPPORTED;
    c->bank.source->failed = PANTIN_OK;
    if (c->animator.track.stale) result = recover_all(c);
    if (result != PANTIN_OK) return result;
    c->animator.stepped = 0;
    before = *c;
    frame = c->second ? frame_of(c->second) : 0;
    for (i = 0; i < c->layer_count; i++) keep_layer(c->layers[i], &layers[i]);
    c->animator.event_count = 0;
    c->animator.lost = 0;
    c->entered = 0;
    follow(c, elapsed_us);
    result = run(c, (uint64_t)elapsed_us * 1000);
    c->seen = c->fired | c->held;
    c->fired = 0;
    c->held_before = c->held;
    for (i = 0; result == PANTIN_OK && i < c->layer_count; i++) result = update_layer(c, c->layers[i], elapsed_us);
    if (result == PANTIN_OK && c->feet) result = c->feet_calls->hold(c, elapsed_us);
    read = c->bank.source->failed;
    if (read == PANTIN_OK) return result;
    take_back_all(c, &before, layers, frame);
    return read;
}
