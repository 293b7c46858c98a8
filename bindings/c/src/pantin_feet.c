/* Feet that stay where they are put: see pantin_feet.h.
 *
 * The steps and the rounding are those of the module `feet` of the crate pantin-animator, and of its chains and limbs. Sums that wrap there are taken on
 * unsigned numbers. The right shift of a negative number is taken to round down, as in pantin_figure.c. */
#include "pantin_feet.h"
#include "pantin_animator_parts.h"
#include "pantin_figure_parts.h"
#include "pantin_parts.h"
#include "pantin_turn_parts.h"

#ifndef PANTIN_EULER_ONLY

#define ONE ((int32_t)32768)
#define NO_POINT 255u
/* The time in which a foot that is let go comes back to its clip. */
#define RELEASE_US ((uint32_t)200000)
/* A figure goes down and comes up by a fraction of its way in each update, nearly two thirds of it in this time: nearly straight legs bend by the root of the
 * way. */
#define DROP_US ((int64_t)50000)
/* The longest step. */
#define LONGEST_US ((uint32_t)4000000)
/* The least bend of a knee, 1 degree, and the greatest, 150 degrees, in 2^-32 turns. */
#define LEAST_BEND 11930465L
#define GREATEST_BEND 1789569707L

enum { FREE = 0, LOCKED, RELEASED };
enum { HEADER_BYTES = 8, FOOT_BYTES = 12, END_BYTES = 2, CONTACT_BYTES = 6, ENTRY_BYTES = 6, TABLE_VERSION = 1 };

/* ---- Numbers ---- */

static int32_t sum(int32_t a, int32_t b) { return (int32_t)((uint32_t)a + (uint32_t)b); }
static int32_t difference(int32_t a, int32_t b) { return (int32_t)((uint32_t)a - (uint32_t)b); }
static int64_t wide_sum(int64_t a, int64_t b) { return (int64_t)((uint64_t)a + (uint64_t)b); }
static int64_t wide_difference(int64_t a, int64_t b) { return (int64_t)((uint64_t)a - (uint64_t)b); }
static int64_t wide_size(int64_t x) { return x < 0 ? wide_difference(0, x) : x; }
static int64_t wide_square(int64_t x) { return (int64_t)((uint64_t)x * (uint64_t)x); }
static int64_t least(int64_t a, int64_t b) { return a < b ? a : b; }
static int64_t most(int64_t a, int64_t b) { return a > b ? a : b; }
static int32_t narrow(int64_t x) {
    int32_t low = (int32_t)(uint32_t)(uint64_t)x;
    return low == x && low >= -0x7fffffffL ? low : x < 0 ? -0x7fffffffL : 0x7fffffffL;
}

/* value / 2^shift, cut off at the range. */
static int32_t shifted(int32_t value, int32_t shift) {
    if (shift >= 0) return value >> (shift < 31 ? shift : 31);
    return narrow((int64_t)value * ((int64_t)1 << (shift > -31 ? -shift : 31)));
}

static int64_t wide_shifted(int64_t x, int32_t shift) {
    if (shift >= 0) return (int64_t)((uint64_t)x << (shift < 63 ? shift : 63));
    return x >> (shift > -63 ? -shift : 63);
}

static void subtract(const int32_t *a, const int32_t *b, int32_t *to) {
    uint8_t i;
    for (i = 0; i < 3; i++) to[i] = difference(a[i], b[i]);
}

static void wide_add(int64_t *to, const int64_t *a, const int64_t *b) {
    uint8_t i;
    for (i = 0; i < 3; i++) to[i] = wide_sum(a[i], b[i]);
}

static void wide_subtract(int64_t *to, const int64_t *a, const int64_t *b) {
    uint8_t i;
    for (i = 0; i < 3; i++) to[i] = wide_difference(a[i], b[i]);
}

/* ---- Distances that die out ---- */

/* The part of a release that has passed, in 2^-15. */
static int32_t part_of(uint32_t since_us, uint32_t whole_us) { return (int32_t)(((uint64_t)since_us << 15) / whole_us); }

/* The distance at a part of the way: the cubic that begins with the distance and the velocity, and ends at zero with neither. */
static int32_t ease_at(const pantin_ease *own, int32_t t) {
    int32_t left = ONE - t, squared = (left * left) >> 15, d = (int32_t)(((uint32_t)squared * (uint32_t)(ONE + 2 * t)) >> 15);
    return narrow((((int64_t)own->d * d) >> 15) + (((int64_t)own->v * ((squared * t) >> 15)) >> 15));
}

/* Takes another distance, a time after the last one, and the velocity of this change. */
static void ease_hold(pantin_ease *own, int32_t d, uint32_t elapsed_us) {
    int64_t moved = (int64_t)difference(d, own->d) * (int64_t)RELEASE_US;
    own->v = elapsed_us ? narrow(moved / (int64_t)elapsed_us) : 0;
    own->d = d;
}

static void ease_in_unit(pantin_ease *own, int32_t shift) {
    own->d = shifted(own->d, -shift);
    own->v = shifted(own->v, -shift);
}

/* ---- Rotations ---- */

/* Where a joint is, and how what hangs on it is turned: three columns in Q15. */
typedef struct {
    int32_t place[3], rotation[3][3];
} located;

/* The rotation `a`, then `b`; `to` may be `b`. */
static void then(int32_t (*a)[3], int32_t (*b)[3], int32_t (*to)[3]) {
    uint8_t i;
    for (i = 0; i < 3; i++) pantin_figure_apply(a, b[i], to[i]);
}

static void transpose(int32_t (*r)[3]) {
    uint8_t i, j;
    for (i = 0; i < 3; i++) {
        for (j = 0; j < i; j++) {
            int32_t swap = r[i][j];
            r[i][j] = r[j][i];
            r[j][i] = swap;
        }
    }
}

/* Turns a rotation by values that are one drive of a figure. */
static void turn_by(int32_t (*r)[3], uint16_t what, const int32_t *values) {
    pantin_bone bone;
    pantin_drive drive;
    memset(&bone, 0, sizeof bone);
    bone.drives = 1;
    drive.first = 0;
    drive.what = what;
    pantin_figure_rotate(r, &bone, &drive, values);
}

/* In Q15, by a turn of no rotation. */
static void sin_cos(int32_t angle, int32_t *sine, int32_t *cosine) {
    int32_t r[3][3];
    pantin_figure_world(r);
    turn_by(r, 0, &angle);
    *sine = r[1][2];
    *cosine = r[1][1];
}

/* The angles of three turns about axes, one after the other, that make the rotation. */
static void angles_of(int32_t (*r)[3], const uint8_t *axes, int32_t *angles) {
    uint8_t i = axes[0], j = axes[1], k = axes[2], n;
    int32_t sign = (i + 1) % 3 == j ? 1 : -1, v[3], sine, cosine, length, images[2];
    v[0] = r[i][i];
    v[1] = -sign * r[j][i];
    v[2] = 0;
    angles[2] = pantin_figure_aim_along(v, &length) ? pantin_figure_angle(v[1], v[0]) : 0;
    sin_cos(angles[2], &sine, &cosine);
    angles[1] = pantin_figure_angle(sign * r[k][i], (r[i][i] * cosine - sign * r[j][i] * sine) >> 15);
    for (n = 0; n < 2; n++) {
        uint8_t row = n ? j : k;
        images[n] = (sign * r[i][row] * sine + r[j][row] * cosine) >> 15;
    }
    angles[0] = pantin_figure_angle(sign * images[0], images[1]);
}

/* The unit quaternion of a rotation, by its largest component. */
static void quaternion_of(int32_t (*r)[3], int32_t *q) {
    int32_t size[4];
    uint8_t i, best = 0;
    size[0] = ONE + r[0][0] + r[1][1] + r[2][2];
    for (i = 0; i < 3; i++) size[i + 1] = ONE + 2 * r[i][i] - r[0][0] - r[1][1] - r[2][2];
    for (i = 1; i < 4; i++) {
        if (size[i] > size[best]) best = i;
    }
    q[best] = size[best];
    for (i = 0; i < 3; i++) {
        uint8_t j = (uint8_t)((i + 1) % 3), k = (uint8_t)((i + 2) % 3);
        if (best == 0) {
            q[i + 1] = r[j][k] - r[k][j];
        } else if (best == i + 1) {
            q[0] = r[j][k] - r[k][j];
            q[j + 1] = r[i][j] + r[j][i];
            q[k + 1] = r[i][k] + r[k][i];
        }
    }
    for (i = 0; i < 4; i++) q[i] *= 4096;
    pantin_turn_normalize(q);
}

/* ---- Joints of a leg ---- */

static uint8_t component(const pantin_leg_bone *b, uint8_t channel) { return (uint8_t)(b->parts[channel >> 1] >> (channel & 1 ? 4 : 0) & 15); }

/* Turns a rotation by a joint's channels. */
static void turn_joint(const pantin_leg_bone *b, int32_t (*r)[3], const int32_t *pose) {
    const int32_t *own = pose + b->first;
    int32_t parts[4] = {0, 0, 0, 0};
    uint8_t i;
    if (b->shape < PANTIN_MAP) {
        for (i = 0; i < b->length && i < 3; i++) turn_by(r, b->axes[i], own + i);
        return;
    }
    for (i = 0; i < b->length; i++) {
        if (component(b, i) < 4) parts[component(b, i)] = own[i];
    }
    turn_by(r, b->shape == PANTIN_MAP ? PANTIN_DRIVE_WHOLE_MAP : PANTIN_DRIVE_WHOLE_UNIT, parts);
}

/* The joint that hangs on another, which may be `to`. */
static void follow(const pantin_leg_bone *b, located *parent, const int32_t *pose, int16_t shift, located *to) {
    int32_t offset[3];
    uint8_t i;
    for (i = 0; i < 3; i++) offset[i] = b->places[i] == PANTIN_NO_JOINT ? b->offset[i] : shifted(pose[b->places[i]], shift);
    pantin_figure_apply_any(parent->rotation, offset, offset);
    for (i = 0; i < 3; i++) to->place[i] = sum(parent->place[i], offset[i]);
    if (to != parent) memcpy(to->rotation, parent->rotation, sizeof to->rotation);
    turn_joint(b, to->rotation, pose);
}

/* Writes the rotation `world` of a joint, whose parent is turned by `parent`, into its channels. A joint with fewer than three angles takes those that it
 * has. */
static void write_joint(const pantin_leg_bone *b, int32_t (*parent)[3], int32_t (*world)[3], int32_t *pose) {
    int32_t back[3][3], local[3][3], values[4] = {0, 0, 0, 0}, q[4], *own = pose + b->first;
    uint8_t axes[3], i;
    memcpy(back, parent, sizeof back);
    transpose(back);
    then(back, world, local);
    if (b->shape >= PANTIN_MAP) {
        quaternion_of(local, q);
        if (b->shape == PANTIN_MAP) {
            pantin_animator_map(q, values);
        } else {
            memcpy(values, q, sizeof values);
        }
        for (i = 0; i < b->length; i++) own[i] = component(b, i) < 4 ? values[component(b, i)] : 0;
        return;
    }
    if (b->length == 0) return;
    memcpy(axes, b->axes, sizeof axes);
    if (b->length == 1) axes[1] = (uint8_t)((axes[0] + 1) % 3);
    if (b->length < 3) axes[2] = (uint8_t)(b->length == 1 ? (axes[0] + 2) % 3 : (6 - axes[0] - axes[1]) % 3);
    angles_of(local, axes, values);
    if (b->shape == PANTIN_EULER) pantin_animator_nearest(PANTIN_EULER, values, own, 3);
    for (i = 0; i < b->length && i < 3; i++) own[i] = values[i];
}

/* The joint above a leg, and hip, knee and ankle in a pose. */
static void places_of(const pantin_foot *f, const int32_t *pose, int16_t shift, located *at) {
    uint8_t above = (uint8_t)(f->bone_count - 3), i;
    memset(at[0].place, 0, sizeof at[0].place);
    pantin_figure_world(at[0].rotation);
    for (i = 0; i < above; i++) follow(&f->bones[i], &at[0], pose, shift, &at[0]);
    for (i = 0; i < 3; i++) follow(&f->bones[above + i], &at[i], pose, shift, &at[i + 1]);
}

/* Where a point of a foot is in a pose, in the unit of position channels. */
static void point_of(const pantin_foot *f, const int32_t *pose, int16_t shift, const located *ankle, uint8_t point, int32_t *place) {
    located at = *ankle;
    uint8_t way[PANTIN_FOOT_POINTS], count = 0, i;
    /* Parents have smaller numbers. */
    for (; point > 0 && count < PANTIN_FOOT_POINTS; point = f->parents[point - 1]) way[count++] = (uint8_t)(point - 1);
    while (count-- > 0) follow(&f->points[way[count]], &at, pose, shift, &at);
    for (i = 0; i < 3; i++) place[i] = shifted(at.place[i], -shift);
}

/* ---- Inverse kinematics of a leg ---- */

/* Makes the way along a bone of a known length its direction. */
static void along_bone(int32_t *v, const int32_t *known) {
    uint8_t i;
    for (i = 0; i < 3; i++) v[i] = ((v[i] < -known[0] ? -known[0] : v[i] > known[0] ? known[0] : v[i]) * known[1]) >> 14;
}

/* A vector of length 1 at most, times a length below 2^16. */
static int32_t times(int32_t x, int32_t by) {
    by = by < -0xffff ? -0xffff : by > 0xffff ? 0xffff : by;
    return ((x < -ONE ? -ONE : x > ONE ? ONE : x) * (by >> 1)) >> 14;
}

/* Three columns: two unit vectors at a right angle, and their product. */
static void columns(const int32_t *a, const int32_t *b, int32_t (*r)[3]) {
    memcpy(r[0], a, 3 * sizeof *a);
    memcpy(r[1], b, 3 * sizeof *b);
    pantin_figure_cross(a, b, r[2]);
}

/* Makes a rotation what it is after the turn that takes one pair of vectors to another. */
static void turn_between(const int32_t *from_a, const int32_t *from_b, const int32_t *to_a, const int32_t *to_b, int32_t (*r)[3]) {
    int32_t from[3][3], to[3][3];
    columns(from_a, from_b, from);
    transpose(from);
    columns(to_a, to_b, to);
    then(to, from, from);
    then(from, r, r);
}

/* Directions of thigh and shin. */
static void bones_of(const pantin_foot *f, const located *at, int32_t *thigh, int32_t *shin) {
    subtract(at[2].place, at[1].place, thigh);
    along_bone(thigh, f->upper);
    subtract(at[3].place, at[2].place, shin);
    along_bone(shin, f->lower);
}

/* The sine of the least bend that shows its axis, 2 degrees. */
enum { LEAST_SINE = ONE / 28 };

/* Remembers how a leg bends in a pose in which it bends as it should: not in one of a transition. At least 2 degrees tell it, and half of what was seen:
   nearly straight legs bend to any side. */
static void learn(pantin_foot *f, const located *at) {
    pantin_foot_state *s = &f->state;
    int32_t thigh[3], shin[3], axis[3], own[3], back[3][3], sine, seen = s->bent ? s->most : 0;
    bones_of(f, at, thigh, shin);
    pantin_figure_cross(thigh, shin, axis);
    if (!pantin_figure_aim_along(axis, &sine) || sine <= most(seen / 2, LEAST_SINE)) return;
    memcpy(back, at[2].rotation, sizeof back);
    transpose(back);
    pantin_figure_apply(back, axis, own);
    if (s->bent && sine <= seen && pantin_figure_dot(own, s->hinge) < 0) return;
    memcpy(s->hinge, own, sizeof own);
    s->most = (int32_t)most(seen, sine);
    s->bent = 1;
}

/* Directions of thigh and shin, and the axis of the knee. */
typedef struct {
    int32_t thigh[3], shin[3], axis[3];
} leg_plane;

/* The axis about which a knee bends to a sine of `wanted`. The bend of the pose stays, and what is added is about the axis that was seen, as nearly straight
 * legs bend to any side; a bend the other way does not stay. One that was never bent bends across the way to its target. Returns 1 if the axis is square
 * to both bones. */
static int knee_axis(const pantin_foot_state *s, located *knee, const leg_plane *old, const int32_t *way, int32_t wanted, int32_t *axis) {
    static const int32_t aside[3] = {32768, 0, 0};
    int32_t known[3], stays[3], sine = 0, back = 0, added;
    uint8_t i;
    pantin_figure_cross(old->thigh, old->shin, stays);
    memcpy(axis, stays, sizeof stays);
    if (!pantin_figure_aim_along(axis, &sine)) sine = 0;
    if (!s->bent) {
        if (sine > LEAST_SINE) return 1;
        pantin_figure_cross(way, aside, axis);
        if (!pantin_figure_aim_along(axis, &sine)) {
            axis[0] = axis[1] = 0;
            axis[2] = ONE;
        }
        return 0;
    }
    pantin_figure_apply(knee->rotation, s->hinge, known);
    if (sine > 0) back = (int32_t)((least(sine, 2 * ONE) >> 1) * least(pantin_figure_dot(axis, known), 0)) >> 14;
    if (back < 0) {
        for (i = 0; i < 3; i++) stays[i] = difference(stays[i], times(known[i], back));
        memcpy(axis, stays, sizeof stays);
        if (!pantin_figure_aim_along(axis, &sine)) sine = 0;
    }
    added = (int32_t)most(wanted, LEAST_SINE) - sine;
    if (sine > 0 && added <= 0) return back == 0;
    for (i = 0; i < 3; i++) axis[i] = sum(stays[i], times(known[i], added));
    if (!pantin_figure_aim_along(axis, &sine)) memcpy(axis, known, sizeof known);
    return 0;
}

/* Makes an axis square to a bone. Returns 0 if it is along it. */
static int square_to(const int32_t *bone, const int32_t *axis, int32_t *to) {
    int32_t aside[3], length;
    pantin_figure_cross(bone, axis, aside);
    pantin_figure_cross(aside, bone, to);
    return pantin_figure_aim_along(to, &length);
}

/* How a thigh and its shin reach as far as the knee allows. */
typedef struct {
    int32_t reached, cosine, sine; /* of the angle at the hip */
} leg_reach;

static leg_reach reach_of(const pantin_foot *f, int32_t distance) {
    leg_reach r;
    /* Lengths below 2^16 as 2^14: squares stay below 2^28. */
    int32_t a = f->upper[0] >> 2, b = f->lower[0] >> 2, d;
    r.reached = (int32_t)least(most(distance, f->nearest), f->farthest);
    d = r.reached >> 2;
    r.cosine = (int32_t)least(most(((a * a + d * d - b * b) * 2) / most((a * d) >> 13, 1), -ONE), ONE);
    r.sine = (int32_t)pantin_animator_root((uint64_t)(ONE * ONE - r.cosine * r.cosine));
    return r;
}

/* The sine of the knee's bend in a leg that reaches so far. */
static int32_t bend_of(const pantin_foot *f, const leg_reach *r) {
    int32_t b = f->lower[0] >> 2;
    return b ? r->sine * (r->reached >> 2) / b : 0;
}

/* The leg that reaches from the hip along `way`, in the plane of that way and the bend. Returns 0 if there is none. */
static int reach(const pantin_foot *f, const int32_t *way, const leg_reach *r, const int32_t *axis, leg_plane *to) {
    int32_t across[3], length;
    uint8_t i;
    pantin_figure_cross(way, axis, across);
    if (!pantin_figure_aim_along(across, &length)) return 0;
    for (i = 0; i < 3; i++) {
        to->thigh[i] = ((way[i] * r->cosine) >> 15) + ((across[i] * r->sine) >> 15);
        to->shin[i] = difference(times(way[i], r->reached), times(to->thigh[i], f->upper[0]));
    }
    along_bone(to->shin, f->lower);
    pantin_figure_cross(across, way, to->axis);
    return 1;
}

/* Turns hip and knee so that the ankle comes to a target, or as near as the knee allows. The ankle keeps its rotation in the world. */
static void solve(pantin_foot *f, located *at, int32_t *pose, const int32_t *target) {
    const pantin_leg_bone *bones = f->bones + f->bone_count - 3;
    int32_t way[3], distance, axis[3], squares[2][3], hip[3][3], shin[3][3];
    leg_plane old, next;
    leg_reach r;
    uint8_t i, near = 1, is_square;
    for (i = 0; i < 3; i++) {
        int32_t apart = difference(target[i], at[3].place[i]);
        if (apart < -2 || apart > 2) near = 0;
    }
    subtract(target, at[1].place, way);
    if (near || !pantin_figure_aim_along(way, &distance)) return;
    bones_of(f, at, old.thigh, old.shin);
    r = reach_of(f, distance);
    is_square = (uint8_t)knee_axis(&f->state, &at[2], &old, way, bend_of(f, &r), axis);
    if (!reach(f, way, &r, axis, &next)) return;
    memcpy(squares[0], axis, sizeof axis);
    memcpy(squares[1], axis, sizeof axis);
    if (!is_square && (!square_to(old.thigh, axis, squares[0]) || !square_to(old.shin, axis, squares[1]))) return;
    memcpy(hip, at[1].rotation, sizeof hip);
    turn_between(old.thigh, squares[0], next.thigh, next.axis, hip);
    memcpy(shin, at[2].rotation, sizeof shin);
    turn_between(old.shin, squares[1], next.shin, next.axis, shin);
    write_joint(&bones[0], at[0].rotation, hip, pose);
    write_joint(&bones[1], hip, shin, pose);
    write_joint(&bones[2], shin, at[3].rotation, pose);
}

/* ---- Between the axes of a pose and those of the world ---- */

/* How a figure stands. A point of the world is its two horizontal coordinates and its height. */
typedef struct {
    int64_t place[2];
    pantin_heading there, back;
    uint8_t up;
} standing;

static void stand(standing *s, const pantin_placement *at, uint8_t up) {
    memcpy(s->place, at->place, sizeof s->place);
    pantin_animator_heading(&s->there, at->heading);
    s->back = s->there;
    s->back.angle = difference(0, s->there.angle);
    s->back.sine = -s->there.sine;
    s->up = up;
}

static void to_world(const standing *s, const int32_t *point, int64_t *to) {
    uint8_t i;
    pantin_animator_rotate(&s->there, point[(s->up + 1) % 3], point[(s->up + 2) % 3], to);
    for (i = 0; i < 2; i++) to[i] = wide_sum(s->place[i], to[i]);
    to[2] = point[s->up];
}

/* A way in the world, in the axes of the pose. */
static void to_pose(const standing *s, const int32_t *way, int32_t *to) {
    int64_t flat[2];
    uint8_t i;
    pantin_animator_rotate(&s->back, way[0], way[1], flat);
    for (i = 0; i < 2; i++) to[(s->up + 1 + i) % 3] = (int32_t)(uint32_t)(uint64_t)flat[i];
    to[s->up] = way[2];
}

/* ---- A foot ---- */

/* The length of a stretched leg, in the unit of position channels. */
static int32_t length_of(const pantin_foot *f, int16_t shift) { return shifted(f->upper[0] + f->lower[0], -shift); }

/* Lets go of a foot that is this far from where it goes, along one axis: it is lifted on its way by a quarter of this, and by an eighth of the leg at most. */
static void release(pantin_foot *f, int16_t shift, int64_t far) {
    pantin_foot_state *s = &f->state;
    int32_t lift = (int32_t)(least(far, length_of(f, shift) / 2) / 4);
    s->lift = f->upside_down ? -lift : lift;
    s->doing = RELEASED;
    s->steps = 0;
    s->step_us = RELEASE_US;
    s->since_us[0] = 0;
    if (s->level) s->since_us[1] = 0;
    s->level = 0;
}

static int32_t left_height(const pantin_foot_state *s) {
    int32_t t = part_of(s->since_us[0], s->step_us), up = s->doing == RELEASED ? (t * (ONE - t)) >> 15 : 0;
    /* The square of 4 t (1 - t), in 2^-13 of a lift: from rest to rest. */
    up = (up * up) >> 13;
    return sum(ease_at(&s->rise, part_of(s->since_us[1], RELEASE_US)), (int32_t)(uint32_t)(uint64_t)(((int64_t)s->lift * up) >> 13));
}

/* How far a foot is from where the clip has it, in the world. */
static void left_of(const pantin_foot_state *s, int32_t *left) {
    uint8_t i;
    for (i = 0; i < 2; i++) left[i] = ease_at(&s->flat[i], part_of(s->since_us[0], s->step_us));
    left[2] = left_height(s);
}

/* What is left of its way has no velocity from now on; its lift is a part of the height that is left. */
static void come_to_rest(pantin_foot_state *s) {
    int32_t left[3];
    uint8_t i;
    left_of(s, left);
    for (i = 0; i < 2; i++) {
        s->flat[i].d = left[i];
        s->flat[i].v = 0;
    }
    if (s->lift == 0) return;
    s->rise.d = left[2];
    s->rise.v = 0;
    s->since_us[1] = 0;
}

/* Enters a clip in which its place is far away along one axis, and steps there while a transition runs. If it is on the ground there, it is held when it
 * has come to rest. */
static void step(pantin_foot *f, int16_t shift, uint8_t contact, int64_t far, uint32_t left_us) {
    pantin_foot_state *s = &f->state;
    uint32_t least_us = RELEASE_US;
    uint8_t i;
    s->before = contact;
    if (s->doing != LOCKED) {
        /* What is near goes with its clips. */
        if (far <= length_of(f, shift) / 24 || left_us == 0) return;
        come_to_rest(s);
        /* A foot that was in the air has nothing to come back from. */
        if (s->flat[0].d == 0 && s->flat[1].d == 0) least_us = 1;
    }
    release(f, shift, far);
    s->steps = 1;
    s->step_us = left_us < least_us ? least_us : left_us < LONGEST_US ? left_us : LONGEST_US;
    for (i = 0; i < 2; i++) s->flat[i].v = narrow((int64_t)s->flat[i].v * (int64_t)s->step_us / (int64_t)RELEASE_US);
}

/* A point of a foot in the world, with what is left of its way. */
static void point_with_left(const pantin_foot_state *s, const int64_t *point, int64_t *to) {
    int32_t left[3];
    uint8_t i;
    left_of(s, left);
    for (i = 0; i < 3; i++) to[i] = wide_sum(point[i], left[i]);
}

/* Whether a foot that is not held is to be held from now on. */
static int lands(const pantin_foot *f, int16_t shift, uint8_t point, const int64_t *at, int calm, uint32_t elapsed_us) {
    const pantin_foot_state *s = &f->state;
    /* Half of the leg in a second. */
    int64_t slow = (int64_t)length_of(f, shift) * elapsed_us / 2000000;
    uint8_t i, rests = s->before == point;
    if (s->before == NO_POINT) return calm;
    for (i = 0; i < 3; i++) rests = (uint8_t)(rests && wide_size(wide_difference(at[i], s->at[i])) <= slow);
    return s->steps ? calm && s->since_us[0] >= s->step_us && rests : calm || rests;
}

/* Lets go of a foot that cannot be where it was held any longer: it steps back to its clip. */
static void let_go(pantin_foot *f, int16_t shift) {
    release(f, shift, length_of(f, shift) / 4);
    f->state.steps = 1;
}

/* Keeps a held foot at its anchor, which is a way from where the clip has it. */
static void keep(pantin_foot *f, int16_t shift, const int64_t *way, int calm, uint32_t elapsed_us) {
    pantin_foot_state *s = &f->state;
    int64_t far = length_of(f, shift) / 4;
    uint8_t i;
    s->since_us[0] = 0;
    for (i = 0; i < 2; i++) ease_hold(&s->flat[i], narrow(way[i]), elapsed_us);
    if (s->level) {
        ease_hold(&s->rise, narrow(way[2]), elapsed_us);
        s->since_us[1] = 0;
        s->level = (uint8_t)!calm;
    }
    if (wide_size(way[0]) > far || wide_size(way[1]) > far) let_go(f, shift);
}

/* A leg in a pose, where its ankle is to be, and the distance of `free_of`: in figure units. */
typedef struct {
    located at[4];
    int32_t target[3], free;
    uint8_t is_wanted;
} wanted_leg;

/* A foot of a pose: what its functions share. */
typedef struct {
    pantin_foot *foot;
    const int32_t *pose;
    const standing *stand;
    int16_t shift;
} posed_foot;

static void world_of(const posed_foot *p, const wanted_leg *leg, uint8_t point, int64_t *to) {
    int32_t place[3];
    point_of(p->foot, p->pose, p->shift, &leg->at[3], point, place);
    to_world(p->stand, place, to);
}

/* The distance of a place from the hip. */
static uint64_t from_hip(const wanted_leg *leg, const int32_t *place) {
    uint64_t square = 0;
    uint8_t i;
    for (i = 0; i < 3; i++) {
        uint64_t way = (uint64_t)wide_size(difference(place[i], leg->at[1].place[i]));
        square += way * way;
    }
    return pantin_animator_root(square);
}

/* The distance of the ankle from the hip past which it comes less and less far, so that the leg does not snap straight: where it bends by 25 degrees, or where
 * the pose has the ankle. A pose that bends by less than 14 degrees gives up these, when its ankle has to move by a 64th of the leg. */
static int32_t free_of(const pantin_foot *f, const wanted_leg *leg) {
    int32_t greatest = f->farthest, bent = greatest - 3 * greatest / 128, straight = greatest - greatest / 128, part = greatest / 64;
    int32_t own = (int32_t)least((int64_t)from_hip(leg, leg->at[3].place), greatest);
    int64_t way = 0;
    uint8_t i;
    for (i = 0; i < 3; i++) way = most(way, wide_size(difference(leg->target[i], leg->at[3].place[i])));
    if (part && own > straight) own -= (own - straight) * (int32_t)least(way, part) / part;
    return own > bent ? own : bent;
}

/* Where the ankle is to be by what is left of the foot's way: nothing is wanted if it stays where the clip has it. */
static void want(const posed_foot *p, wanted_leg *leg) {
    int32_t left[3], way[3];
    uint8_t i;
    left_of(&p->foot->state, left);
    to_pose(p->stand, left, way);
    leg->is_wanted = 0;
    for (i = 0; i < 3; i++) {
        way[i] = shifted(way[i], p->shift);
        if (way[i] != 0) leg->is_wanted = 1;
        leg->target[i] = sum(leg->at[3].place[i], way[i]);
    }
    if (leg->is_wanted) leg->free = free_of(p->foot, leg);
}

/* Whether a target stretches the leg too much: by more than three quarters of the way from where the pose has the ankle to where the leg is straight, and by
 * more than a 32nd of the leg. */
static int overreaches(const pantin_foot *f, const wanted_leg *leg) {
    int64_t own = (int64_t)from_hip(leg, leg->at[3].place), greatest = f->farthest;
    return (int64_t)from_hip(leg, leg->target) > own + most(most(greatest - own, 0) * 3 / 4, greatest / 32);
}

/* Brings a target that is past the free distance nearer. */
static void come_within(const pantin_foot *f, wanted_leg *leg) {
    int32_t way[3], distance, over, soft = f->farthest - f->farthest / 128 - leg->free;
    uint8_t i;
    if (soft < f->farthest / 256) soft = f->farthest / 256;
    subtract(leg->target, leg->at[1].place, way);
    if (!pantin_figure_aim_along(way, &distance) || distance <= leg->free) return;
    over = (int32_t)least((int64_t)distance - leg->free, 0xffff);
    if (over + soft) over = over * soft / (over + soft);
    for (i = 0; i < 3; i++) leg->target[i] = sum(leg->at[1].place[i], times(way[i], leg->free + over));
}

/* Lets time pass for a foot whose point `contact` is on the ground in the clip. */
static void update_foot(const posed_foot *p, uint8_t contact, int calm, uint32_t elapsed_us, wanted_leg *leg) {
    pantin_foot_state *s = &p->foot->state;
    int64_t at[3], other[3];
    uint8_t i;
    const uint32_t whole[2] = {s->step_us, RELEASE_US};
    for (i = 0; i < 2; i++) s->since_us[i] = elapsed_us >= whole[i] - s->since_us[i] ? whole[i] : s->since_us[i] + elapsed_us;
    leg->is_wanted = 0;
    if (contact == NO_POINT && s->doing == FREE) {
        s->before = NO_POINT;
        if (!calm || s->bent) return;
        places_of(p->foot, p->pose, p->shift, leg->at);
        learn(p->foot, leg->at);
        return;
    }
    places_of(p->foot, p->pose, p->shift, leg->at);
    if (s->doing == LOCKED && contact == NO_POINT) {
        release(p->foot, p->shift, most(wide_size(s->flat[0].d), wide_size(s->flat[1].d)));
    } else if (s->doing == LOCKED && s->point != contact) {
        world_of(p, leg, contact, at);
        world_of(p, leg, s->point, other);
        wide_subtract(at, at, other);
        wide_add(s->anchor, s->anchor, at);
        s->point = contact;
        s->lowest = INT64_MAX;
    } else if (s->doing != LOCKED && contact != NO_POINT) {
        world_of(p, leg, contact, at);
        point_with_left(s, at, at);
        if (lands(p->foot, p->shift, contact, at, calm, elapsed_us)) {
            come_to_rest(s);
            s->doing = LOCKED;
            s->point = contact;
            memcpy(s->anchor, at, sizeof at);
            s->level = 0;
            s->lowest = INT64_MAX;
        }
    }
    if (s->doing == LOCKED) {
        int64_t height;
        world_of(p, leg, s->point, at);
        height = p->foot->upside_down ? wide_difference(0, at[2]) : at[2];
        wide_subtract(at, s->anchor, at);
        keep(p->foot, p->shift, at, calm, elapsed_us);
        s->lowest = least(s->lowest, height);
        /* The other clip of a blend lifts it. */
        if (s->doing == LOCKED && wide_difference(height, s->lowest) > length_of(p->foot, p->shift) / 12) {
            release(p->foot, p->shift, 0);
            s->steps = 1;
        }
    } else if (s->since_us[0] == whole[0] && s->since_us[1] == RELEASE_US) {
        s->doing = FREE;
        s->lift = 0;
    }
    s->before = contact;
    if (contact != NO_POINT) {
        world_of(p, leg, contact, at);
        point_with_left(s, at, s->at);
    }
    want(p, leg);
    if (calm) learn(p->foot, leg->at);
    if (s->doing == LOCKED && leg->is_wanted && overreaches(p->foot, leg)) {
        come_to_rest(s);
        let_go(p->foot, p->shift);
    }
}

/* ---- Both feet ---- */

static uint8_t table_byte(const pantin_character *c, const pantin_feet *f, uint32_t at) { return pantin_byte(c->bank.source, f->table + at); }

static uint16_t table_number(const pantin_character *c, const pantin_feet *f, uint32_t at) {
    return (uint16_t)(table_byte(c, f, at) | (uint16_t)table_byte(c, f, at + 1) << 8);
}

static uint32_t ends_at(const pantin_feet *f) { return HEADER_BYTES + FOOT_BYTES * (uint32_t)f->count; }
static uint32_t contact_at(const pantin_feet *f, uint32_t index) { return ends_at(f) + END_BYTES * (uint32_t)f->clips + CONTACT_BYTES * index; }
static uint32_t entry_at(const pantin_feet *f, uint32_t index) { return contact_at(f, f->contacts) + ENTRY_BYTES * index; }

/* The number of contacts of the clips before one. */
static uint16_t contacts_before(const pantin_character *c, const pantin_feet *f, uint8_t clip) {
    return clip ? table_number(c, f, ends_at(f) + END_BYTES * (clip - 1u)) : 0;
}

/* The point of a foot that is on the ground at a frame of a clip, or NO_POINT. */
static uint8_t contact_of(const pantin_character *c, const pantin_feet *f, uint8_t clip, uint8_t foot, uint32_t frame) {
    uint32_t index = contacts_before(c, f, clip), end = contacts_before(c, f, (uint8_t)(clip + 1u));
    for (; index < end; index++) {
        uint32_t at = contact_at(f, index);
        uint8_t point = table_byte(c, f, at + 1);
        if (table_byte(c, f, at) != foot || frame < table_number(c, f, at + 2) || frame >= table_number(c, f, at + 4)) continue;
        return point <= f->feet[foot].point_count ? point : (uint8_t)NO_POINT;
    }
    return NO_POINT;
}

/* See pantin_feet_calls. */
static int next_entry(const pantin_character *c, uint8_t transition, uint32_t *frame, uint64_t *ns) {
    const pantin_feet *f = c->feet;
    const pantin_animator *a = &c->animator;
    const pantin_track *t = &a->track;
    uint16_t part = pantin_animator_part(t), entry;
    uint32_t behind, from, nearest = 0xffffffffu;
    uint64_t way;
    if (t->speed <= 0) return 0;
    /* Not before the transition that runs has ended, rounded up to its whole frames: in 2^-16 of a frame. */
    behind = (part + a->left * (uint32_t)t->speed + 0xffff) >> 16;
    from = t->player.frame + behind;
    if (t->clip.looped) from %= t->clip.frames;
    for (entry = 0; entry < f->entries; entry++) {
        uint32_t row = entry_at(f, entry), at, ahead;
        if (table_byte(c, f, row) != transition) continue;
        at = table_number(c, f, row + 2);
        if (at < from && !t->clip.looped) continue;
        ahead = at < from ? at + t->clip.frames - from : at - from;
        if (ahead >= nearest) continue;
        nearest = ahead;
        *frame = table_number(c, f, row + 4);
    }
    if (nearest == 0xffffffffu) return 0;
    way = ((uint64_t)(nearest + behind) << 16) - part;
    /* Rounded up, so that the frame is reached. */
    way = way > ~(uint64_t)0 / t->clip.frame_time_ns ? ~(uint64_t)0 : way * t->clip.frame_time_ns;
    *ns = way / (uint32_t)t->speed + (way % (uint32_t)t->speed != 0);
    return 1;
}

/* Where the figure will be, by its clip alone, when the transition that runs has ended and the clip still stood where it does now. */
static void end_of_glide(const pantin_animator *a, pantin_placement *to) {
    int32_t place[2];
    int64_t by[2];
    pantin_heading heading;
    uint8_t i;
    for (i = 0; i < 2; i++) place[i] = a->place_channels[i] == PANTIN_NO_JOINT ? 0 : a->track.player.pose[a->place_channels[i]];
    pantin_animator_locate(a, place, to);
    /* The points of the clip's pose have its place in them. */
    pantin_animator_heading(&heading, to->heading);
    pantin_animator_rotate(&heading, place[0], place[1], by);
    for (i = 0; i < 2; i++) to->place[i] = wide_difference(to->place[i], by[i]);
}

/* Lets the figure go a way of the world beside its clip's while the transition lasts. Nothing moves in this instant. */
static void glide(pantin_animator *a, const int64_t *by) {
    pantin_heading heading;
    int64_t way[2];
    uint8_t i;
    if ((by[0] == 0 && by[1] == 0) || a->left == 0) return;
    a->stepped = 1;
    pantin_animator_heading(&heading, difference(0, a->heading.angle));
    pantin_animator_rotate(&heading, (int32_t)(uint32_t)(uint64_t)by[0], (int32_t)(uint32_t)(uint64_t)by[1], way);
    for (i = 0; i < 2; i++) {
        int32_t part = (int32_t)(uint32_t)(uint64_t)way[i];
        pantin_offset *o;
        if (a->place_channels[i] == PANTIN_NO_JOINT) continue;
        o = &a->memory->offsets[a->place_channels[i]];
        o->d = difference(o->d, part);
        a->place[i] = difference(a->place[i], part);
        a->origin[i] = wide_difference(a->origin[i], way[i]);
        pantin_animator_solve(a->left, o);
    }
}

static int64_t farther(const int64_t *a) { return most(wide_size(a[0]), wide_size(a[1])); }

/* The way that brings the feet to where they are held: of two the mean, or the shorter one if they are far apart. */
static void choose_glide(int64_t (*ways)[3], const uint8_t *has, int64_t length, int64_t *to) {
    int64_t apart[2];
    uint8_t i, both = has[0] && has[1], own = both ? farther(ways[0]) > farther(ways[1]) : !has[0];
    to[0] = to[1] = 0;
    if (!has[0] && !has[1]) return;
    for (i = 0; i < 2; i++) apart[i] = wide_difference(ways[0][i], ways[1][i]);
    both = both && farther(apart) <= length / 8;
    for (i = 0; i < 2; i++) to[i] = both ? wide_sum(ways[0][i], ways[1][i]) / 2 : ways[own][i];
    if (farther(to) > length / 2) to[0] = to[1] = 0;
}

/* Where a point of a foot is now, in the world: the height of a held foot is not its anchor's. */
static void place_of(const posed_foot *p, uint8_t point, int64_t *to) {
    const pantin_foot_state *s = &p->foot->state;
    wanted_leg leg;
    int64_t from[3], height;
    places_of(p->foot, p->pose, p->shift, leg.at);
    world_of(p, &leg, point, to);
    if (s->doing != LOCKED) {
        point_with_left(s, to, to);
        return;
    }
    height = wide_sum(to[2], left_height(s));
    world_of(p, &leg, s->point, from);
    wide_subtract(from, to, from);
    wide_add(to, s->anchor, from);
    to[2] = height;
}

/* Places the clip that was entered by the feet that are held and are on the ground in it, too. Others that are on the ground before or after step to
 * their places. */
static void enter(pantin_character *c, const standing *now, const uint8_t *contacts) {
    pantin_feet *f = c->feet;
    pantin_animator *a = &c->animator;
    int64_t ways[PANTIN_FEET][3], anchors[PANTIN_FEET][3], by[2], length = length_of(&f->feet[0], f->shift), rest[2];
    uint64_t left_us;
    uint8_t stays[PANTIN_FEET] = {0, 0}, points[PANTIN_FEET], i, j;
    pantin_placement end_place;
    standing end;
    /* Its own pose is asked for below. */
    pantin_animator_leave_carried(a);
    end_of_glide(a, &end_place);
    stand(&end, &end_place, now->up);
    memset(ways, 0, sizeof ways);
    for (i = 0; i < f->count; i++) {
        posed_foot p = {&f->feet[i], a->pose, now, f->shift};
        int locked = f->feet[i].state.doing == LOCKED;
        wanted_leg leg;
        points[i] = contacts[i] != NO_POINT ? contacts[i] : locked ? f->feet[i].state.point : (uint8_t)NO_POINT;
        stays[i] = (uint8_t)(contacts[i] != NO_POINT && locked);
        places_of(p.foot, a->track.player.pose, p.shift, leg.at);
        learn(p.foot, leg.at);
        if (points[i] == NO_POINT) continue;
        place_of(&p, points[i], anchors[i]);
        p.pose = a->track.player.pose;
        p.stand = &end;
        world_of(&p, &leg, points[i], ways[i]);
        wide_subtract(ways[i], anchors[i], ways[i]);
    }
    choose_glide(ways, stays, length, by);
    if (a->left < 2) by[0] = by[1] = 0;
    left_us = (uint64_t)a->left * a->track.clip.frame_time_ns / 1000;
    glide(a, by);
    for (i = 0; i < f->count; i++) {
        pantin_foot_state *s = &f->feet[i].state;
        if (points[i] == NO_POINT) continue;
        for (j = 0; j < 2; j++) rest[j] = wide_difference(ways[i][j], by[j]);
        if (!stays[i] || farther(rest) > length / 12) {
            step(&f->feet[i], f->shift, contacts[i], farther(rest), left_us < LONGEST_US ? (uint32_t)left_us : LONGEST_US);
            continue;
        }
        s->doing = LOCKED;
        s->point = s->before = contacts[i];
        memcpy(s->anchor, anchors[i], sizeof s->anchor);
        s->level = 1;
        s->lowest = INT64_MAX;
    }
}

/* How far the figure's carrier goes down so that the legs reach, in figure units. */
static int32_t drop_of(const pantin_feet *f, const wanted_leg *legs, uint8_t up, int negative) {
    int64_t drop = 0;
    uint8_t i, j;
    for (i = 0; i < f->count; i++) {
        const wanted_leg *leg = &legs[i];
        int32_t way[3];
        int64_t square = 0, height, bound;
        if (!leg->is_wanted) continue;
        subtract(leg->at[1].place, leg->target, way);
        for (j = 0; j < 3; j++) square = wide_sum(square, wide_square(way[j]));
        height = negative ? difference(0, way[up]) : way[up];
        bound = most(wide_difference(wide_square(leg->free), wide_difference(square, wide_square(height))), 0);
        drop = most(drop, height - (int64_t)pantin_animator_root((uint64_t)bound));
    }
    return (int32_t)least(drop, shifted(f->most_drop, f->shift));
}

/* The channel of the first joint above the legs that moves up and down, or PANTIN_NO_JOINT. */
static uint16_t height_channel(const pantin_foot *f, uint8_t up) {
    uint8_t i;
    for (i = 0; i + 3 < f->bone_count; i++) {
        if (f->bones[i].places[up] != PANTIN_NO_JOINT) return f->bones[i].places[up];
    }
    return PANTIN_NO_JOINT;
}

/* Corrects the pose so that the legs reach. */
static void apply(pantin_character *c, wanted_leg *legs, uint32_t elapsed_us) {
    pantin_feet *f = c->feet;
    uint8_t up = c->animator.axis, negative = c->animator.track.clip.rig.up & 4, i, j;
    int32_t *pose = c->animator.pose, drop = drop_of(f, legs, up, negative), down, raw;
    uint16_t channel = height_channel(&f->feet[0], up);
    f->sunk = drop = drop + (int32_t)((int64_t)(f->sunk - drop) * DROP_US / (DROP_US + (int64_t)elapsed_us));
    if (channel == PANTIN_NO_JOINT) drop = 0;
    down = negative ? -drop : drop;
    raw = shifted(drop, -f->shift);
    if (drop > 0) pose[channel] = difference(pose[channel], negative ? -raw : raw);
    for (i = 0; i < f->count; i++) {
        wanted_leg *leg = &legs[i];
        if (!leg->is_wanted && drop <= 0) continue;
        if (leg->is_wanted) {
            for (j = 0; j < 4; j++) leg->at[j].place[up] = difference(leg->at[j].place[up], down);
        } else {
            /* A foot that is free stays where it is while the figure goes down. */
            places_of(&f->feet[i], pose, f->shift, leg->at);
            memcpy(leg->target, leg->at[3].place, sizeof leg->target);
            leg->free = free_of(&f->feet[i], leg);
            leg->target[up] = sum(leg->target[up], down);
        }
        come_within(&f->feet[i], leg);
        solve(&f->feet[i], leg->at, pose, leg->target);
    }
}

/* ---- Set-up ---- */

static int go_to(pantin_joint *joint, const pantin_rig *rig, uint16_t index) {
    pantin_first_joint(joint, rig);
    do {
        if (!pantin_next_joint(joint)) return 0;
    } while (joint->index != index);
    return 1;
}

/* The axis of a kind: 0 for the first component of a quaternion. */
static uint8_t axis_of(uint8_t kind) {
    if (kind < PANTIN_QUATERNION_W) return (uint8_t)(kind % 3);
    if (kind < PANTIN_EXPONENTIAL_X) return (uint8_t)(kind - (kind == PANTIN_QUATERNION_W ? PANTIN_QUATERNION_W : PANTIN_QUATERNION_X));
    return (uint8_t)(kind - PANTIN_EXPONENTIAL_X);
}

/* What a joint is to inverse kinematics; `down` is the offsets' shift to figure units. */
static pantin_result find_bone(pantin_leg_bone *b, const pantin_animator *a, const pantin_joint *joint, int32_t down) {
    pantin_joint_ref ref;
    uint8_t places[15], c, i;
    uint16_t g;
    pantin_result result = pantin_refer(&a->track.clip, joint, &ref);
    if (result != PANTIN_OK) return result;
    memset(b, 0, sizeof *b);
    for (i = 0; i < 3; i++) {
        b->offset[i] = (int16_t)shifted(joint->offset[i], down);
        b->places[i] = PANTIN_NO_JOINT;
    }
    for (c = 0; c < joint->channels; c++) {
        uint8_t kind = pantin_joint_kind(joint, c), axis = axis_of(kind);
        uint16_t channel = (uint16_t)(joint->first_channel + c);
        if (kind < PANTIN_EULER_X) {
            b->places[axis] = channel;
            continue;
        }
        if (b->length == 0) {
            b->first = channel;
            for (g = 0; g < a->group_count; g++) {
                const pantin_group *group = &a->memory->groups[g];
                if (group->bit != joint->index || group->first != channel) continue;
                b->shape = group->shape;
                break;
            }
        }
        if (b->length < 3) b->axes[b->length] = axis;
        b->length++;
    }
    pantin_animator_places(&ref, (uint8_t)(b->shape == PANTIN_UNIT ? 4 : 3), places);
    for (i = 0; i < 15; i++) b->parts[i >> 1] = (uint8_t)(b->parts[i >> 1] | (places[i] < 4 ? places[i] : 4u) << (i & 1 ? 4 : 0));
    return PANTIN_OK;
}

/* A bone's length, and 2^29 over it: one of a few units bends nothing that can be seen. Returns 0 for a bone without length. */
static int measure_bone(const pantin_leg_bone *b, int32_t *known) {
    int32_t v[3];
    uint8_t i;
    for (i = 0; i < 3; i++) v[i] = b->offset[i];
    if (!pantin_figure_aim_along(v, &known[0])) return 0;
    known[1] = (int32_t)(((int32_t)1 << 29) / most(known[0], 256));
    return 1;
}

/* The distance between hip and ankle where the knee is bent by an angle. */
static int32_t distance_at(const pantin_foot *f, int32_t bend) {
    int32_t sine, cosine;
    int64_t upper = f->upper[0], lower = f->lower[0], square;
    sin_cos(bend, &sine, &cosine);
    square = upper * upper + lower * lower + ((2 * upper * lower * cosine) >> 15);
    return (int32_t)pantin_animator_root((uint64_t)most(square, 0));
}

/* The joints from the root to an ankle, and what its points hang on. */
static pantin_result find_leg(pantin_foot *f, const pantin_animator *a, int32_t down) {
    const pantin_rig *rig = &a->track.clip.rig;
    pantin_joint joint;
    pantin_leg_bone swap;
    pantin_result result = PANTIN_OK;
    uint16_t index = f->ankle;
    uint8_t i, j;
    for (f->bone_count = 0; index != PANTIN_NO_PARENT; index = joint.parent) {
        if (!go_to(&joint, rig, index)) return PANTIN_ERROR_MACHINE;
        if (f->bone_count == PANTIN_LEG_JOINTS) return PANTIN_NO_ROOM;
        result = find_bone(&f->bones[f->bone_count++], a, &joint, down);
        if (result != PANTIN_OK) return result;
    }
    for (i = 0, j = f->bone_count; i + 1 < j; i++) {
        swap = f->bones[i];
        f->bones[i] = f->bones[--j];
        f->bones[j] = swap;
    }
    if (f->bone_count < 3) return PANTIN_ERROR_MACHINE;
    if (!measure_bone(&f->bones[f->bone_count - 2], f->upper) || !measure_bone(&f->bones[f->bone_count - 1], f->lower)) return PANTIN_ERROR_MACHINE;
    f->upside_down = (rig->up & 4) != 0;
    f->nearest = distance_at(f, GREATEST_BEND);
    f->farthest = distance_at(f, LEAST_BEND);
    for (i = 0; i < f->point_count; i++) {
        if (!go_to(&joint, rig, f->joints[i])) return PANTIN_ERROR_MACHINE;
        for (j = 0; j < i && joint.parent != f->joints[j]; j++) {}
        if (joint.parent != f->ankle && j == i) return PANTIN_ERROR_MACHINE;
        f->parents[i] = (uint8_t)(joint.parent == f->ankle ? 0 : j + 1);
        result = find_bone(&f->points[i], a, &joint, down);
        if (result != PANTIN_OK) return result;
    }
    return result;
}

/* Finds the legs in the form of the clip that plays, and brings what the feet remember to it. */
static pantin_result find_legs(pantin_feet *f, const pantin_animator *a) {
    const pantin_clip *clip = &a->track.clip;
    pantin_joint joint;
    uint32_t largest = 0, units;
    int32_t down = -14, shift = f->exponent - clip->exponent;
    pantin_result result = PANTIN_OK;
    uint8_t i, j;
    pantin_first_joint(&joint, &clip->rig);
    while (pantin_next_joint(&joint)) {
        for (i = 0; i < 3; i++) largest |= joint.offset[i] < 0 ? 0u - (uint32_t)joint.offset[i] : (uint32_t)joint.offset[i];
    }
    for (; largest; largest >>= 1) down++;
    f->shift = (int16_t)(clip->rig.offset_exponent + down - clip->exponent);
    for (i = 0; i < f->count && result == PANTIN_OK; i++) {
        pantin_foot_state *s = &f->feet[i].state;
        result = find_leg(&f->feet[i], a, down);
        for (j = 0; j < 3; j++) {
            s->at[j] = wide_shifted(s->at[j], shift);
            s->anchor[j] = wide_shifted(s->anchor[j], shift);
        }
        s->lift = shifted(s->lift, -shift);
        for (j = 0; j < 2; j++) ease_in_unit(&s->flat[j], shift);
        ease_in_unit(&s->rise, shift);
    }
    f->exponent = clip->exponent;
    f->coding = clip->coding;
    /* In 2^-8 of the source's unit. */
    units = ((uint32_t)2000000 << 8) / clip->rig.unit_micro_cm;
    f->most_drop = shifted((int32_t)least(units, (int32_t)1 << 30), clip->exponent + 8);
    return clip->rig.source->error != PANTIN_OK ? clip->rig.source->error : result;
}

/* Checks the table once: afterwards every contact is of a foot and a point that are there. */
static int check_table(const pantin_character *c, pantin_feet *f, uint32_t end) {
    uint32_t length = end - f->table, index;
    uint16_t before = 0;
    uint8_t i;
    if (length < HEADER_BYTES || table_byte(c, f, 0) != TABLE_VERSION) return 0;
    f->count = table_byte(c, f, 1);
    f->clips = table_byte(c, f, 2);
    f->contacts = table_number(c, f, 4);
    f->entries = table_number(c, f, 6);
    if (f->count < 1 || f->count > PANTIN_FEET || f->clips != c->bank.clips || length != entry_at(f, f->entries)) return 0;
    for (i = 0; i < f->count; i++) {
        uint32_t at = HEADER_BYTES + FOOT_BYTES * (uint32_t)i;
        pantin_foot *foot = &f->feet[i];
        uint8_t point;
        foot->ankle = table_number(c, f, at);
        foot->point_count = table_byte(c, f, at + 2);
        if (foot->point_count > PANTIN_FOOT_POINTS || table_byte(c, f, at + 3)) return 0;
        for (point = 0; point < PANTIN_FOOT_POINTS; point++) foot->joints[point] = table_number(c, f, at + 4 + 2u * point);
    }
    for (i = 0; i < f->clips; i++) {
        uint16_t own = table_number(c, f, ends_at(f) + END_BYTES * (uint32_t)i);
        if (own < before) return 0;
        before = own;
    }
    if (before != f->contacts) return 0;
    for (index = 0; index < f->contacts; index++) {
        uint32_t at = contact_at(f, index);
        uint8_t foot = table_byte(c, f, at);
        if (foot >= f->count || table_byte(c, f, at + 1) > f->feet[foot].point_count) return 0;
        if (table_number(c, f, at + 2) >= table_number(c, f, at + 4)) return 0;
    }
    return 1;
}

/* ---- Updates ---- */

/* Lets time pass for the feet, and corrects the pose. */
static pantin_result correct(pantin_character *c, uint32_t elapsed_us) {
    pantin_feet *f = c->feet;
    pantin_animator *a = &c->animator;
    wanted_leg legs[PANTIN_FEET];
    standing now;
    pantin_state_row row;
    pantin_result result = PANTIN_OK;
    uint32_t frame = a->track.player.frame;
    uint8_t contacts[PANTIN_FEET], blends, i;
    if (f->stale || (c->entered && (f->exponent != a->track.clip.exponent || f->coding != a->track.clip.coding))) result = find_legs(f, a);
    if (result != PANTIN_OK) return result;
    f->stale = 0;
    /* Of two clips that are blended the figure has the feet of the one that there is more of. */
    pantin_animator_read_state(c, c->state, &row);
    blends = c->second && c->blending && row.other != PANTIN_NO_CLIP;
    if (blends && c->mixed > 1u << 14) {
        row.clip = row.other;
        frame = c->second->player.frame;
    }
    /* Whether there is some of both. */
    blends = blends && c->mixed > 0 && c->mixed < 1u << 15;
    for (i = 0; i < f->count; i++) contacts[i] = contact_of(c, f, row.clip, i, frame);
    stand(&now, &a->placement, a->axis);
    if (c->entered) enter(c, &now, contacts);
    for (i = 0; i < f->count; i++) {
        posed_foot p = {&f->feet[i], a->pose, &now, f->shift};
        update_foot(&p, contacts[i], a->left == 0 && !blends, elapsed_us, &legs[i]);
    }
    apply(c, legs, elapsed_us);
    return PANTIN_OK;
}

/* See pantin_feet_calls. */
static pantin_result hold(pantin_character *c, uint32_t elapsed_us) {
    pantin_feet *f = c->feet;
    pantin_foot_state kept[PANTIN_FEET];
    int8_t exponent = f->exponent;
    int32_t sunk = f->sunk;
    pantin_result result;
    uint8_t i;
    for (i = 0; i < f->count; i++) kept[i] = f->feet[i].state;
    result = correct(c, elapsed_us);
    if (c->bank.source->failed == PANTIN_OK) return result;
    for (i = 0; i < f->count; i++) f->feet[i].state = kept[i];
    f->exponent = exponent;
    f->sunk = sunk;
    f->stale = 1;
    return result;
}

static pantin_result again(pantin_character *c) {
    pantin_feet *f = c->feet;
    wanted_leg legs[PANTIN_FEET];
    standing now;
    uint8_t i;
    if (f->stale) {
        pantin_result result = find_legs(f, &c->animator);
        if (result != PANTIN_OK) return result;
        f->stale = 0;
    }
    stand(&now, &c->animator.placement, c->animator.axis);
    for (i = 0; i < f->count; i++) {
        posed_foot p = {&f->feet[i], c->animator.pose, &now, f->shift};
        places_of(p.foot, p.pose, p.shift, legs[i].at);
        want(&p, &legs[i]);
    }
    apply(c, legs, 0);
    return PANTIN_OK;
}

pantin_result pantin_character_feet(pantin_character *c, pantin_feet *feet) {
    static const pantin_feet_calls calls = {next_entry, hold, again};
    uint32_t end;
    pantin_result result;
    uint8_t i, j;
    if (!c->bank.source) return PANTIN_ERROR_HEAD;
    c->bank.source->failed = PANTIN_OK;
    memset(feet, 0, sizeof *feet);
    for (i = 0; i < PANTIN_FEET; i++) {
        feet->feet[i].state.before = NO_POINT;
        for (j = 0; j < 2; j++) feet->feet[i].state.since_us[j] = RELEASE_US;
        feet->feet[i].state.step_us = RELEASE_US;
    }
    result = pantin_find_section(&c->bank, PANTIN_FEET_SECTION, &feet->table, &end);
    if (result == PANTIN_OK && !check_table(c, feet, end)) result = PANTIN_ERROR_MACHINE;
    if (result == PANTIN_OK) result = find_legs(feet, &c->animator);
    if (c->bank.source->failed != PANTIN_OK) result = c->bank.source->failed;
    if (result != PANTIN_OK) return result;
    c->feet = feet;
    c->feet_calls = &calls;
    return PANTIN_OK;
}

uint16_t pantin_character_held(const pantin_character *c, uint8_t foot) {
    const pantin_foot *f;
    if (!c->feet || foot >= c->feet->count) return PANTIN_NO_JOINT;
    f = &c->feet->feet[foot];
    if (f->state.doing != LOCKED) return PANTIN_NO_JOINT;
    return f->state.point ? f->joints[f->state.point - 1] : f->ankle;
}

#endif
