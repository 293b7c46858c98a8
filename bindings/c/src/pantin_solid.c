/* Solid figures: see pantin_solid.h.
 *
 * The steps and the rounding are those of the module `solid` of the crate pantin-figure, so that both draw the same pixels. Every row of a part is
 * computed from the part alone, so that a picture can be drawn in bands of any height. Sums and products that poses of damaged clips can make overflow
 * are taken on uint32_t. The right shift of a negative number is taken to round down, as in pantin_figure.c. */
#include "pantin_figure_parts.h"
#include "pantin_solid.h"

#ifndef PANTIN_EULER_ONLY

#define NONE 255u
#define FULL 256
/* Of the vectors in the head's axes. */
#define AXIS 8192L
#define SAMPLES 48u
#define PASSING 12
#define SMALL (80L * 16)
/* Thousandths of the height: from the head's joint to the skull's middle, from the wrist to the hand's end without its radius, and by how much the head
   and attachments count as nearer than they are. */
#define HEAD_MIDDLE 62
#define HAND_REACH 44
#define HEAD_OVER 30
#define OVER 4
#define PERSON_PARTS 16u

enum { HIP = 0, KNEE, ANKLE, SHOULDER, ELBOW, WRIST, HAND, HEEL, TOE, CHEST_RADIUS, WAIST_RADIUS, PELVIS_RADIUS, NECK_RADIUS, SKULL, RADII };
enum { SHIRT = 0, TROUSERS, SKIN, HAIR, FACE, NOSE, EYE, LEFT, RIGHT, RIGHT_END, EDGE, STAGE, FLOOR, SHADOW, MATERIALS };
enum { PELVIS = 0, CHEST, NECK, HEAD, LIMBS, SIDE = 6 };
enum { ON_HEAD = 0, ON_CHEST, ON_HIPS, ON_THIGHS, ANCHORS };
/* Places of a character's bytes. */
enum { RADII_AT = 2, TINTS_AT = RADII_AT + 2 * RADII, REACH_AT = TINTS_AT + 4 * MATERIALS, COUNT_AT = REACH_AT + 3, FIXED = COUNT_AT + 1 };

static const uint8_t default_look[FIXED] = {
    1, 110,
    56, 36, 25, 40, 29, 21, 26, 26, 19, 50, 70, 58, 28, 78,
    58, 39, 29, 43, 33, 26, 31, 28, 23, 51, 70, 59, 29, 88,
    235, 235, 225, 0xa1, 70, 92, 150, 0xa1, 240, 190, 150, 0xa1, 96, 60, 44, 0x50,
    255, 214, 176, 0xf1, 255, 200, 160, 0xf1, 20, 16, 20, 0x00, 255, 160, 60, 0xf1,
    80, 190, 255, 0x52, 80, 190, 255, 0xa2, 6, 8, 14, 0x00, 36, 44, 64, 0x00,
    56, 68, 92, 0x51, 14, 18, 28, 0x52, 0, 0, 0, 0,
};

/* ---- Numbers ---- */

static int32_t least(int32_t a, int32_t b) { return a < b ? a : b; }
static int32_t most(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t clamp(int32_t x, int32_t low, int32_t high) { return least(most(x, low), high); }
static int32_t size_of(int32_t x) { return x < 0 ? -x : x; }
static int32_t product(int32_t a, int32_t b) { return (int32_t)((uint32_t)a * (uint32_t)b); }
static int32_t sum(int32_t a, int32_t b) { return (int32_t)((uint32_t)a + (uint32_t)b); }
static int32_t difference(int32_t a, int32_t b) { return (int32_t)((uint32_t)a - (uint32_t)b); }

static uint8_t zeros_before(uint32_t x) {
    uint8_t zeros = 32;
    for (; x; x >>= 1) zeros--;
    return zeros;
}

static int aim_along(int32_t *v) {
    int32_t length;
    return pantin_figure_aim_along(v, &length);
}

/* ---- The character ---- */

static const uint8_t *look_of(const pantin_solid *s) { return s->look ? s->look : default_look; }
static uint8_t radius_in(const uint8_t *look, int radius) { return look[RADII_AT + radius]; }
static const uint8_t *tint_of(const pantin_solid *s, uint8_t material) { return look_of(s) + TINTS_AT + 4 * material; }
static int32_t thousandths_of(const pantin_solid *s, uint8_t radius) { return look_of(s)[RADII_AT + (s->small ? RADII : 0) + radius]; }
static uint8_t attachments(const pantin_solid *s) { return look_of(s)[COUNT_AT]; }

/* An attachment: a byte of anchor and circles, a tint, and the circles. */
static const uint8_t *attachment(const pantin_solid *s, uint8_t index) {
    const uint8_t *at = look_of(s) + FIXED;
    while (index-- > 0) at += 5 + 4 * ((*at & 15) + 1);
    return at;
}

static pantin_result check_look(const uint8_t *look, size_t length) {
    size_t at;
    uint8_t left;
    if (length < FIXED || length > PANTIN_LOOK_BYTES) return PANTIN_ERROR_LENGTH;
    if (look[0] != 1) return PANTIN_ERROR_VERSION;
    for (at = 1; at < TINTS_AT; at++) {
        if (!look[at]) return PANTIN_ERROR_HEAD;
    }
    for (; at < REACH_AT; at += 4) {
        if ((look[at + 3] & 15) > 2) return PANTIN_ERROR_HEAD;
    }
    left = look[COUNT_AT];
    if (left > 12) return PANTIN_ERROR_HEAD;
    for (at = FIXED; left > 0; left--) {
        if (length < at + 5) return PANTIN_ERROR_LENGTH;
        if (look[at] >> 4 >= ANCHORS || (look[at] & 15) > 3 || (look[at + 4] & 15) > 2) return PANTIN_ERROR_HEAD;
        at += 5u + 4u * ((look[at] & 15u) + 1u);
    }
    return at == length ? PANTIN_OK : PANTIN_ERROR_LENGTH;
}

/* ---- A person's joints ---- */

/* What the joints of arms and legs are called. A joint with a word of the first list is taken for the first one if there is none with the others; one with
   a word of the second is the limb's next joint. */
static const char *const LIMB_WORDS[2][5] = {
    {"shoulder|shldr", "arm", "upperarm|upper_arm|upper-arm|uparm|humerus|oberarm", "forearm|lowerarm|lower_arm|loarm|elbow|radius|unterarm",
     "hand|wrist"},
    {"hip", "leg", "upleg|upperleg|upper_leg|thigh|femur|oberschenkel", "lowerleg|lower_leg|loleg|shin|calf|knee|tibia|unterschenkel",
     "foot|ankle|fuss|fu_"},
};

static uint8_t parent_of(const pantin_figure *f, uint8_t joint) { return joint < f->bone_count ? f->bones[joint].parent : (uint8_t)NONE; }

static int hangs_on(const pantin_figure *f, uint8_t joint, uint8_t above) {
    while ((joint = parent_of(f, joint)) != NONE) {
        if (joint == above) return 1;
    }
    return 0;
}

/* The three joints of a side's limb. Parents come before children, so the first joint with a word is the one nearest to the trunk. */
static int find_limb(const pantin_figure *f, const pantin_rig *rig, const char *const *words, uint8_t side, uint8_t *limb) {
    pantin_joint joint;
    uint8_t index, role, weak = NONE;
    limb[0] = limb[1] = limb[2] = NONE;
    pantin_first_joint(&joint, rig);
    for (index = 0; index < f->bone_count; index++) {
        if (f->bones[index].part != side) continue;
        if (!pantin_figure_go_to(&joint, rig, f->bones[index].joint)) return 0;
        if (joint.end_site) continue;
        for (role = 0; role < 3 && !pantin_figure_names(&joint.name, words[2 + role]); role++) {}
        if (role == 3) {
            if (pantin_figure_names(&joint.name, words[1])) {
                for (role = 0; role < 3 && limb[role] != NONE; role++) {}
            } else if (weak == NONE && pantin_figure_names(&joint.name, words[0])) {
                weak = index;
            }
        }
        if (role < 3 && limb[role] == NONE) limb[role] = index;
    }
    if (limb[0] == NONE) limb[0] = weak;
    return limb[0] != NONE && limb[1] != NONE && limb[2] != NONE && hangs_on(f, limb[1], limb[0]) && hangs_on(f, limb[2], limb[1]);
}

static int32_t bone_length(const pantin_bone *bone) {
    int32_t wide[3];
    uint8_t i;
    for (i = 0; i < 3; i++) wide[i] = bone->offset[i];
    return pantin_figure_length(wide);
}

static uint8_t middle_child(const pantin_figure *f, uint8_t joint) {
    uint8_t index;
    for (index = 0; index < f->bone_count; index++) {
        if (f->bones[index].parent == joint && f->bones[index].part == PANTIN_MIDDLE) return index;
    }
    return NONE;
}

/* In a rig that names no head: the last joint but the end of what rises from the chest between the arms. */
static uint8_t last_of_neck(const pantin_figure *f, uint8_t chest) {
    uint8_t head = middle_child(f, chest), next;
    if (head != NONE) head = middle_child(f, head);
    while (head != NONE && (next = middle_child(f, head)) != NONE && middle_child(f, next) != NONE) head = next;
    return head;
}

/* The joint of the spine that is nearest to 2/5 of the way from the hips to the neck; NONE if none is between 1/5 and 3/5. */
static uint8_t find_waist(const pantin_figure *f, uint8_t hips, uint8_t neck) {
    int32_t total = 0, above = 0, nearest;
    uint8_t joint, waist = NONE;
    for (joint = neck; joint != NONE && joint != hips; joint = parent_of(f, joint)) total += bone_length(&f->bones[joint]);
    nearest = total / 5;
    for (joint = neck; joint != NONE && joint != hips; joint = parent_of(f, joint)) {
        int32_t apart = size_of(total - above - total * 2 / 5);
        if (apart < nearest) {
            nearest = apart;
            waist = joint;
        }
        above += bone_length(&f->bones[joint]);
    }
    return waist;
}

/* The joint below one that is farthest down its longest branch without thumbs, if it is at least `shortest` away. */
static uint8_t far_end(const pantin_figure *f, const pantin_rig *rig, uint8_t joint, int32_t shortest) {
    int32_t reach[16];
    uint8_t index, end = NONE, first = (uint8_t)(joint + 1);
    pantin_joint named;
    pantin_first_joint(&named, rig);
    /* What hangs on a joint follows it without a gap. */
    for (index = first; index < f->bone_count && index - first < 16; index++) {
        uint8_t above = f->bones[index].parent;
        int32_t own;
        if (above == NONE || above < joint || !pantin_figure_go_to(&named, rig, f->bones[index].joint)) break;
        own = above == joint ? 0 : reach[above - first];
        if (pantin_figure_names(&named.name, "thumb") && !pantin_figure_names(&named.name, "foot")) {
            own = -0x40000000L;
        } else {
            own += bone_length(&f->bones[index]);
        }
        reach[index - first] = own;
        if (own > shortest) {
            shortest = own;
            end = index;
        }
    }
    return end;
}

static int32_t straight(const pantin_figure *f, uint8_t from, uint8_t to) {
    int32_t way[3] = {0, 0, 0};
    uint8_t i;
    for (; to != NONE && to > from; to = parent_of(f, to)) {
        for (i = 0; i < 3; i++) way[i] += f->bones[to].offset[i];
    }
    return pantin_figure_length(way);
}

/* The end of a foot, or the joint before it if the end leads back towards the ankle: some exporters turn End Sites with other axes than the joints'. */
static uint8_t unfolded(const pantin_figure *f, uint8_t ankle, uint8_t end) {
    uint8_t before = parent_of(f, end);
    return before != NONE && before > ankle && straight(f, ankle, end) < straight(f, ankle, before) ? before : end;
}

/* Finds a person's joints. Returns 0 if a limb, the head or the place where the arms branch off is missing, and for a rig with a tail or wings. */
static int find_person(pantin_person *p, const pantin_figure *f, const pantin_rig *rig) {
    pantin_joint joint;
    uint8_t side, chest, head;
    pantin_first_joint(&joint, rig);
    while (pantin_next_joint(&joint)) {
        if (pantin_figure_names(&joint.name, "tail|wing")) return 0;
    }
    for (side = 0; side < 2; side++) {
        uint8_t part = side ? PANTIN_RIGHT : PANTIN_LEFT;
        if (!find_limb(f, rig, LIMB_WORDS[0], part, p->arms[side]) || !find_limb(f, rig, LIMB_WORDS[1], part, p->legs[side])) return 0;
    }
    chest = p->arms[0][0];
    do chest = parent_of(f, chest);
    while (chest != NONE && !hangs_on(f, p->arms[1][0], chest));
    if (chest == NONE) return 0;
    head = f->crown != NONE ? f->bones[f->crown].parent : last_of_neck(f, chest);
    if (head == NONE) return 0;
    p->head = p->neck = head;
    while (p->neck != NONE && parent_of(f, p->neck) != chest) p->neck = parent_of(f, p->neck);
    if (p->neck == NONE) return 0;
    /* The arms hang on the neck. */
    if (p->neck == head) p->neck = chest;
    p->hips = (uint8_t)f->hips;
    p->waist = find_waist(f, p->hips, p->neck);
    for (side = 0; side < 2; side++) {
        uint8_t ankle = p->legs[side][2];
        p->fingers[side] = far_end(f, rig, p->arms[side][2], f->size / 50);
        p->toes[side] = unfolded(f, ankle, far_end(f, rig, ankle, f->size / 30));
    }
    return 1;
}

/* ---- Places ---- */

/* The joints whose places are kept: those by which directions and what lies on the floor are found. */
static uint8_t kept_joint(const pantin_solid *s, uint8_t index) {
    const pantin_person *p = &s->person;
    uint8_t side = index & 1;
    switch (index >> 1) {
        case 0: return side ? p->neck : p->hips;
        case 1: return p->arms[side][0];
        case 2: case 3: case 4: return p->legs[side][(index >> 1) - 2];
        case 5: return p->toes[side];
        default: return p->head;
    }
}

#define KEPT 13u

static void keep(void *context, uint8_t index, const int32_t *position) {
    pantin_solid *s = (pantin_solid *)context;
    uint8_t i;
    for (i = 0; i < KEPT; i++) {
        if (kept_joint(s, i) == index) memcpy(s->places[i], position, sizeof s->places[i]);
    }
}

static void keep_and_see(void *context, uint8_t index, const int32_t *position) {
    pantin_solid *s = (pantin_solid *)context;
    pantin_figure_see(&s->figure, index, position);
    keep(context, index, position);
}

static const int32_t *kept(const pantin_solid *s, uint8_t joint) {
    uint8_t i = 0;
    while (i < KEPT - 1 && kept_joint(s, i) != joint) i++;
    return s->places[i];
}

/* The direction from a joint to another one, 2^15 long; nothing if they are in one place. */
static void way(const pantin_solid *s, uint8_t from, uint8_t to, int32_t *v) {
    const int32_t *a = kept(s, from), *b = kept(s, to);
    uint8_t i;
    for (i = 0; i < 3; i++) v[i] = difference(b[i], a[i]);
    if (!aim_along(v)) memset(v, 0, 3 * sizeof *v);
}

/* A place on the display: sixteenths of a pixel right and down, and depth. */
static void place_of(const pantin_solid *s, uint8_t joint, int32_t *place) {
    const pantin_bone *bone = &s->figure.bones[joint];
    place[0] = bone->place[0];
    place[1] = bone->place[1];
    place[2] = bone->depth;
}

static int32_t depth_at(const pantin_solid *s, uint8_t joint) { return s->figure.bones[joint].depth; }

/* Between two places: `part` of 256 from the first to the second, or beyond. */
static void between(const int32_t *a, const int32_t *b, int32_t part, int32_t *to) {
    uint8_t i;
    for (i = 0; i < 3; i++) to[i] = a[i] + (((b[i] - a[i]) * part) >> 8);
}

/* How a joint is turned before the camera, by all joints above it, at most 40. */
static void turned(const pantin_figure *f, const int32_t *pose, uint8_t joint, int32_t (*rotation)[3]) {
    const pantin_drive *drives = f->drives;
    uint8_t above[32], index, count;
    memset(above, 0, sizeof above);
    for (count = 0; joint != NONE && count < 40; count++) {
        above[joint >> 3] = (uint8_t)(above[joint >> 3] | 1u << (joint & 7));
        joint = parent_of(f, joint);
    }
    for (index = 0; index < f->bone_count; index++) {
        if (above[index >> 3] >> (index & 7) & 1) pantin_figure_rotate(rotation, &f->bones[index], drives, pose);
        drives += f->bones[index].drives;
    }
}

/* ---- Set-up ---- */

/* Up along y for a vector of no length. */
static void up_of(int32_t *v) {
    if (aim_along(v)) return;
    v[0] = v[2] = 0;
    v[1] = 32768;
}

/* Finds out what is ahead of the head in its own axes: the mean over poses of the clip of where the shoulders face. */
static pantin_result learn_head(pantin_solid *s, pantin_player *player) {
    const pantin_person *p = &s->person;
    int32_t up[3] = {0, 0, 0}, ahead[3] = {0, 0, 0}, origin[3] = {0, 0, 0}, left[3], view[3][3], a[3], b[3], facing[3];
    uint32_t frames = player->clip->frames, stride = (frames + SAMPLES - 1) / SAMPLES, frame;
    uint8_t i;
    for (frame = 0; frame < frames; frame += stride) {
        pantin_result result = pantin_seek(player, frame);
        if (result != PANTIN_OK) return result;
        pantin_figure_world(view);
        pantin_figure_place(&s->figure, player->pose, view, origin, PANTIN_MAX_BONES + 1, keep, s);
        pantin_figure_world(view);
        turned(&s->figure, player->pose, p->head, view);
        way(s, p->arms[1][0], p->arms[0][0], a);
        way(s, p->hips, p->neck, b);
        pantin_figure_cross(a, b, facing);
        way(s, p->neck, p->head, b);
        for (i = 0; i < 3; i++) {
            ahead[i] += pantin_figure_dot(view[i], facing) >> 2;
            up[i] += pantin_figure_dot(view[i], b) >> 2;
        }
    }
    if (!aim_along(ahead)) {
        ahead[0] = ahead[1] = 0;
        ahead[2] = 32768;
    }
    up_of(up);
    a[0] = pantin_figure_dot(up, ahead);
    for (i = 0; i < 3; i++) up[i] -= (ahead[i] * a[0]) >> 15;
    up_of(up);
    pantin_figure_cross(up, ahead, left);
    for (i = 0; i < 3; i++) {
        s->head_axes[0][i] = (int16_t)clamp(up[i] >> 2, -AXIS, AXIS);
        s->head_axes[1][i] = (int16_t)clamp(ahead[i] >> 2, -AXIS, AXIS);
        s->head_axes[2][i] = (int16_t)clamp(left[i] >> 2, -AXIS, AXIS);
    }
    return pantin_seek(player, 0);
}

/* Lists the parts. */
static void list(pantin_solid *s) {
    const pantin_figure *f = &s->figure;
    uint8_t index, fits = 1;
    s->part_count = 0;
    if (s->build == PANTIN_PERSON) {
        for (index = 0; index < PERSON_PARTS + attachments(s); index++) s->order[s->part_count++] = index;
        return;
    }
    for (index = 0; index < f->bone_count; index++) {
        if (f->bones[index].parent == NONE || f->bones[index].kind == PANTIN_HIDDEN) continue;
        fits = s->part_count < PANTIN_SOLID_PARTS;
        if (!fits) break;
        s->order[s->part_count++] = index;
    }
    if (!fits || !s->part_count) s->build = PANTIN_LINES;
}

pantin_result pantin_solid_look(pantin_solid *s, const uint8_t *look, size_t length) {
    pantin_result result = look ? check_look(look, length) : PANTIN_OK;
    if (result != PANTIN_OK) return result;
    s->look = look;
    if (s->build != PANTIN_LINES) list(s);
    return PANTIN_OK;
}

static pantin_result set_up_parts(pantin_solid *s, pantin_player *player, uint16_t width, uint16_t height, pantin_joint_info *scratch,
                                  size_t scratch_room) {
    pantin_result result = pantin_figure_set_up(&s->figure, player, width, height, scratch, scratch_room);
    if (result != PANTIN_OK) return result;
    s->build = PANTIN_PERSON;
    if (find_person(&s->person, &s->figure, &player->clip->rig)) {
        result = learn_head(s, player);
    } else {
        s->build = PANTIN_CAPSULES;
        memset(&s->person, NONE, sizeof s->person);
        s->person.hips = (uint8_t)s->figure.hips;
    }
    list(s);
    return result;
}

pantin_result pantin_solid_set_up(pantin_solid *s, pantin_player *player, uint16_t width, uint16_t height, pantin_joint_info *scratch,
                                  size_t scratch_room) {
    /* Functions that return no result hide that bytes could not be read. The sources know. */
    pantin_source *source = player->clip->source, *rig = player->clip->rig.source;
    pantin_result result;
    source->failed = rig->failed = PANTIN_OK;
    result = set_up_parts(s, player, width, height, scratch, scratch_room);
    if (source->failed != PANTIN_OK) result = source->failed;
    if (rig->failed != PANTIN_OK) result = rig->failed;
    if (result == PANTIN_OK) return PANTIN_OK;
    s->build = PANTIN_LINES;
    s->part_count = 0;
    s->figure.width = s->figure.bone_count = s->figure.line_count = 0;
    return result;
}

/* The length of the bones from a joint down to another one. */
static int32_t way_down(const pantin_figure *f, uint8_t from, uint8_t to) {
    int32_t total = 0;
    for (; to != from && to != NONE; to = parent_of(f, to)) total += bone_length(&f->bones[to]);
    return total;
}

/* The height of a person in figure units: 2.04 times the mean of thigh and shin of both sides. */
static int32_t height_of(const pantin_solid *s) {
    int32_t legs = 0;
    uint8_t side, i;
    for (side = 0; side < 2; side++) {
        for (i = 0; i < 2; i++) legs += way_down(&s->figure, s->person.legs[side][i], s->person.legs[side][i + 1]);
    }
    return most((legs * 261) >> 8, 1);
}

/* Takes in circles about head, hands, neck and hips. */
static void cover(const void *context, const pantin_figure *f, pantin_extent *e) {
    const pantin_solid *s = (const pantin_solid *)context;
    const pantin_person *p = &s->person;
    const uint8_t *look = look_of(s);
    uint8_t joints[5], i;
    int32_t reaches[5], eighth;
    if (s->build != PANTIN_PERSON || s->tight) {
        pantin_figure_cover_head(NULL, f, e);
        return;
    }
    eighth = height_of(s) >> 3;
    joints[0] = p->head;
    reaches[0] = HEAD_MIDDLE + most(radius_in(look, SKULL), look[REACH_AT] * 4);
    joints[1] = p->arms[0][2];
    joints[2] = p->arms[1][2];
    reaches[1] = reaches[2] = HAND_REACH + radius_in(look, HAND);
    joints[3] = p->neck;
    reaches[3] = look[REACH_AT + 1] * 4;
    joints[4] = p->hips;
    reaches[4] = look[REACH_AT + 2] * 4;
    for (i = 0; i < 5; i++) {
        const pantin_bone *bone = &f->bones[joints[i]];
        int32_t reach = eighth * reaches[i] / 125;
        if (reach > 0) {
            pantin_figure_widen(e, bone->place, (int16_t)least((pantin_figure_seen(f, reach) * pantin_figure_magnification(bone->depth)) >> 14, 32767));
        }
    }
}

/* Thousandths of 16 heights as a part of a length. */
static int16_t ratio(int32_t height, int32_t thousandths, int32_t of) {
    return (int16_t)clamp(height * thousandths / 1000 * 256 / most(of >> 4, 1), 0, 2000);
}

static void measure_extremities(pantin_solid *s) {
    const pantin_person *p = &s->person;
    const pantin_figure *f = &s->figure;
    int32_t height = s->height >> 4, eighth = s->height >> 3;
    uint8_t side;
    s->neck_start = (int16_t)most(256 - ratio(height, 75, way_down(f, p->neck, p->head)), 0);
    for (side = 0; side < 2; side++) {
        uint8_t wrist = p->arms[side][2], ankle = p->legs[side][2], fingers = p->fingers[side], toes = p->toes[side];
        int32_t foot = way_down(f, ankle, toes);
        s->hands[side] = ratio(height, 55, fingers == NONE ? way_down(f, p->arms[side][1], wrist) : way_down(f, wrist, fingers));
        /* At least 0.095 of the height, at most 0.135. */
        s->toe_parts[side] = (int16_t)(256 * 95 / 78);
        if (toes != NONE) s->toe_parts[side] = ratio(height, clamp(foot, eighth * 95 / 125, eighth * 135 / 125) / most(s->height / 1000, 1), foot);
        s->heels[side][0] = ratio(height, 18, way_down(f, p->legs[side][1], ankle));
        s->heels[side][1] = toes == NONE ? 40 : ratio(height, 12, foot);
    }
}

/* Works out sizes for the camera. */
static void measure(pantin_solid *s) {
    const pantin_figure *f = &s->figure;
    int32_t skull;
    uint8_t i;
    s->height = f->size;
    if (s->build == PANTIN_PERSON) {
        s->height = height_of(s);
        measure_extremities(s);
    }
    s->pixels = most(pantin_figure_seen(f, s->height), 1);
    /* A size is 2^13 units of depth; a height has at most 19 bits. */
    s->depth = most((s->height >> 3) * 1024 / most(f->camera_size >> 6, 1), 1);
    s->small = s->pixels < SMALL;
    for (i = 0; i < RADII; i++) s->radii[i] = (int16_t)clamp(s->pixels * thousandths_of(s, i) / 1000, 1, 2048);
    skull = most(thousandths_of(s, SKULL), 1);
    s->skull_offset[0] = 62 * 256 / skull;
    s->skull_offset[1] = 12 * 256 / skull;
    /* A figure that reaches beyond the display has no thicker outline than one that fills it. */
    s->outline = (uint8_t)clamp((least(s->pixels, (int32_t)f->height * 16) + 8) / (most(look_of(s)[1], 1) * 16), 1, 8);
    s->sorted = 0;
}

pantin_result pantin_solid_aim(pantin_solid *s, pantin_player *player, const pantin_view *view) {
    pantin_result result;
    if (!s->figure.width) return PANTIN_ERROR_HEAD;
    result = pantin_figure_aim_for(&s->figure, player, view, cover, s);
    measure(s);
    return result;
}

/* ---- A pose ---- */

/* A vector in the camera's axes as it is seen at the target's distance, in sixteenths of a pixel. */
static int32_t seen_part(const pantin_figure *f, int32_t part) {
    part = clamp(part >> f->shift, -32768, 32767);
    return f->spare >= 14 ? part >> (f->spare - 14) : part * (1 << (14 - f->spare));
}

/* ---- Where the figure stands ---- */

static const pantin_placement origin = {{0, 0}, 0};

/* Turns a rotation about the vertical axis. */
static void turn_level(const pantin_figure *f, int32_t (*r)[3], int32_t angle) {
    pantin_bone bone;
    pantin_drive drive;
    memset(&bone, 0, sizeof bone);
    bone.drives = 1;
    drive.first = 0;
    drive.what = (f->up & 3) % 3;
    pantin_figure_rotate(r, &bone, &drive, &angle);
}

/* The camera's axes as they are to a figure that is not turned. */
static void view_of(const pantin_figure *f, const pantin_placement *at, int32_t (*view)[3]) {
    memcpy(view, f->view, sizeof f->view);
    turn_level(f, view, at->heading);
}

/* A place in figure units. */
static void place_in_units(const pantin_figure *f, const pantin_placement *at, int32_t *place) {
    const int64_t far = (int64_t)1 << 30;
    int16_t shift = f->position_shift;
    uint8_t axis = (f->up & 3) % 3, i;
    place[axis] = 0;
    for (i = 0; i < 2; i++) {
        int64_t raw = at->place[i];
        raw = shift >= 0 ? raw >> (shift < 63 ? shift : 63) : (int64_t)((uint64_t)raw << (-shift & 63));
        place[(axis + 1 + i) % 3] = (int32_t)(raw < -far ? -far : raw > far ? far : raw);
    }
}

/* Places a pose before the camera, somewhere in the world. */
static void values_at(pantin_figure *f, const int32_t *pose, const pantin_placement *at, pantin_figure_visit each, void *context) {
    int32_t view[3][3], place[3], from[3];
    uint8_t i;
    place_in_units(f, at, place);
    pantin_figure_hips(f, pose, from);
    pantin_figure_world(view);
    turn_level(f, view, at->heading);
    pantin_figure_apply_any(view, from, from);
    for (i = 0; i < 3; i++) f->target[i] = sum(from[i], place[i]);
    pantin_figure_follow(f);
    /* The target as the figure sees it. */
    for (i = 0; i < 3; i++) from[i] = difference(f->target[i], place[i]);
    pantin_figure_world(view);
    turn_level(f, view, difference(0, at->heading));
    pantin_figure_apply_any(view, from, from);
    view_of(f, at, view);
    pantin_figure_place(f, pose, view, from, PANTIN_MAX_BONES + 1, each, context);
}

void pantin_figure_pose_at(pantin_figure *f, const int32_t *pose, const pantin_placement *at) {
    values_at(f, pose, at, pantin_figure_see, f);
    pantin_figure_sort(f);
}

/* Where the head looks. */
static void turn_head(pantin_solid *s, const int32_t *pose, const pantin_placement *at) {
    const pantin_figure *f = &s->figure;
    const pantin_bone *bone = &f->bones[s->person.head];
    int32_t view[3][3], v[3], radius, unit = most(pantin_figure_seen(f, AXIS), 1);
    int32_t *axes[3];
    uint8_t i, j;
    axes[0] = s->up;
    axes[1] = s->face;
    axes[2] = s->left;
    view_of(f, at, view);
    turned(f, pose, s->person.head, view);
    radius = (s->radii[SKULL] * pantin_figure_magnification(bone->depth)) >> 14;
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 3; j++) v[j] = s->head_axes[i][j];
        pantin_figure_apply(view, v, v);
        for (j = 0; j < 3; j++) axes[i][j] = seen_part(f, v[j]) * radius / unit;
    }
    for (i = 0; i < 2; i++) s->skull[i] = bone->place[i] + ((s->up[i] * s->skull_offset[0] + s->face[i] * s->skull_offset[1]) >> 8);
    s->skull[2] = radius;
}

/* The depth of the skull's middle. */
static int32_t head_depth(const pantin_solid *s) {
    /* The skull's radius is a known part of the height, and as long as the vectors. */
    return depth_at(s, s->person.head) +
           s->up[2] * s->skull_offset[0] / 256 * s->depth / 1000 * thousandths_of(s, SKULL) / most(s->skull[2], 1);
}

static void waist_of(const pantin_solid *s, int32_t *place) {
    int32_t hips[3], neck[3];
    if (s->person.waist != NONE) {
        place_of(s, s->person.waist, place);
        return;
    }
    place_of(s, s->person.hips, hips);
    place_of(s, s->person.neck, neck);
    between(hips, neck, 102, place);
}

/* The end of a hand. */
static void hand_of(const pantin_solid *s, uint8_t side, int32_t *place) {
    const uint8_t *arm = s->person.arms[side];
    int32_t a[3], b[3];
    place_of(s, arm[2], b);
    if (s->person.fingers[side] == NONE) {
        place_of(s, arm[1], a);
        between(a, b, 256 + s->hands[side], place);
    } else {
        place_of(s, s->person.fingers[side], a);
        between(b, a, s->hands[side], place);
    }
}

/* Heel and toes. */
static void foot_of(const pantin_solid *s, uint8_t side, int32_t *heel, int32_t *toes) {
    const uint8_t *leg = s->person.legs[side];
    int32_t knee[3], ankle[3], far[3], behind[3];
    uint8_t i;
    place_of(s, leg[1], knee);
    place_of(s, leg[2], ankle);
    if (s->person.toes[side] == NONE) {
        far[0] = ankle[0] + s->face[0];
        far[1] = ankle[1] + s->face[1];
        far[2] = ankle[2];
    } else {
        place_of(s, s->person.toes[side], far);
    }
    between(knee, ankle, 256 + s->heels[side][0], heel);
    between(ankle, far, -s->heels[side][1], behind);
    for (i = 0; i < 3; i++) heel[i] += behind[i] - ankle[i];
    between(ankle, far, s->toe_parts[side], toes);
}

/* ---- Attachments ---- */

/* An anchor on the display. Axes are right, down and away; left, up and ahead are as long as `length`. */
typedef struct {
    int32_t origin[3], axes[3][3];
    int32_t length, thousandths; /* sixteenths of a pixel, and the same in thousandths of the figure's height */
} anchor;

static void find_anchor(const pantin_solid *s, uint8_t kind, int32_t left, anchor *a) {
    const pantin_person *p = &s->person;
    const uint8_t (*limbs)[3] = kind == ON_CHEST ? p->arms : p->legs;
    const uint8_t *leg = p->legs[left < 0];
    int32_t one[3], other[3];
    uint8_t i, j;
    if (kind == ON_HEAD) {
        a->origin[0] = s->skull[0];
        a->origin[1] = s->skull[1];
        a->origin[2] = head_depth(s);
        memcpy(a->axes[0], s->left, sizeof s->left);
        memcpy(a->axes[1], s->up, sizeof s->up);
        memcpy(a->axes[2], s->face, sizeof s->face);
        a->length = most(s->skull[2], 1);
        a->thousandths = most(thousandths_of(s, SKULL), 1);
        return;
    }
    way(s, limbs[1][0], limbs[0][0], a->axes[0]);
    if (kind == ON_THIGHS) {
        place_of(s, leg[0], a->origin);
        way(s, leg[1], leg[0], a->axes[1]);
    } else {
        place_of(s, limbs[0][0], one);
        place_of(s, limbs[1][0], other);
        between(one, other, 128, a->origin);
        way(s, p->hips, p->neck, a->axes[1]);
    }
    /* Below 2^15, so that products stay within 32 bits. */
    a->length = clamp((least(s->pixels, 1 << 14) * pantin_figure_magnification(a->origin[2])) >> 14, 1, 32767);
    pantin_figure_cross(a->axes[0], a->axes[1], a->axes[2]);
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 3; j++) a->axes[i][j] = (a->axes[i][j] * a->length) >> 15;
    }
    a->thousandths = 1000;
}

/* A circle's place along an axis of the display, times the anchor's length. */
static int32_t along(const anchor *a, const uint8_t *circle, uint8_t axis) {
    int32_t total = 0;
    uint8_t i;
    for (i = 0; i < 3; i++) total += a->axes[i][axis] * ((int8_t)circle[i] * 2);
    return total;
}

/* How far away an attachment counts as: a skirt as much as the nearer thigh. */
static int32_t attached_key(const pantin_solid *s, const uint8_t *attached, const int32_t *thighs) {
    uint8_t kind = attached[0] >> 4, circles = (uint8_t)((attached[0] & 15) + 1), i;
    int32_t away = 0;
    anchor a;
    if (kind == ON_THIGHS) return least(thighs[0], thighs[1]) - s->depth * OVER / 1000;
    find_anchor(s, kind, 0, &a);
    for (i = 0; i < circles; i++) away += along(&a, attached + 5 + 4 * i, 2) / most(a.length, 1);
    return a.origin[2] + s->depth * (away / circles - (kind == ON_HEAD ? HEAD_OVER : 0) - OVER) / 1000;
}

/* ---- Order ---- */

static int32_t mix(int32_t a, int32_t b, int32_t part) { return a + (((b - a) * part) >> 8); }

/* How far away the parts of a person count as, in units of depth. Upper arm and thigh count as what is farther from the trunk, so that they lie over
   it or under it as a whole. */
static void person_keys(const pantin_solid *s, int32_t *keys) {
    const pantin_person *p = &s->person;
    int32_t height = s->depth, trunk, skull, pelvis, thighs[2], waist[3], a[3], b[3];
    uint8_t side, i;
    waist_of(s, waist);
    trunk = (depth_at(s, p->arms[0][0]) + depth_at(s, p->arms[1][0]) + depth_at(s, p->legs[0][0]) + depth_at(s, p->legs[1][0]) + 2 * waist[2]) / 6;
    skull = head_depth(s);
    for (side = 0; side < 2; side++) {
        const uint8_t *arm = p->arms[side], *leg = p->legs[side];
        int32_t *limb = keys + LIMBS + SIDE * side, elbow = depth_at(s, arm[1]), wrist = depth_at(s, arm[2]);
        int32_t knee = depth_at(s, leg[1]), ankle = depth_at(s, leg[2]);
        thighs[side] = mix(depth_at(s, leg[0]), knee, 179);
        limb[0] = mix(depth_at(s, arm[0]), elbow, 192);
        limb[1] = (elbow + wrist) / 2;
        hand_of(s, side, a);
        limb[2] = mix(wrist, a[2], 179);
        limb[3] = thighs[side];
        limb[4] = (knee + ankle) / 2;
        foot_of(s, side, a, b);
        limb[5] = mix(ankle, b[2], 154) - height / 200;
    }
    /* Under both thighs, so that trousers are one garment, but not behind an arm behind the back. */
    pelvis = least(most(most(thighs[0], thighs[1]), trunk), trunk + height * 8 / 100);
    keys[PELVIS] = pelvis + height / 200;
    keys[CHEST] = trunk;
    keys[NECK] = skull - height * 24 / 1000;
    keys[HEAD] = skull - height * HEAD_OVER / 1000;
    for (i = 0; i < attachments(s); i++) keys[PERSON_PARTS + i] = attached_key(s, attachment(s, i), thighs);
}

static int32_t bone_depth(const pantin_figure *f, uint8_t index) {
    const pantin_bone *bone = &f->bones[index];
    return ((int32_t)f->bones[bone->parent].depth + bone->depth) >> 1;
}

/* How far away the parts of a figure count as, in their order. */
static void keys_of(const pantin_solid *s, int32_t *to) {
    int32_t keys[PANTIN_SOLID_PARTS];
    uint8_t i, person = s->build == PANTIN_PERSON;
    if (person) person_keys(s, keys);
    for (i = 0; i < s->part_count; i++) to[i] = person ? keys[s->order[i]] : bone_depth(&s->figure, s->order[i]);
}

/* Puts the farthest part first. The first picture is sorted exactly, later ones from the order of the one before. */
static void sort(pantin_solid *s) {
    int32_t keys[PANTIN_SOLID_PARTS], passing = s->sorted ? s->depth * PASSING / 1000 : 0;
    uint8_t i, place;
    keys_of(s, keys);
    for (i = 1; i < s->part_count; i++) {
        uint8_t moving = s->order[i];
        int32_t own = keys[i];
        for (place = i; place > 0 && keys[place - 1] + passing < own; place--) {
            s->order[place] = s->order[place - 1];
            keys[place] = keys[place - 1];
        }
        s->order[place] = moving;
        keys[place] = own;
    }
    s->sorted = 1;
}

void pantin_solid_pose(pantin_solid *s, const int32_t *pose) {
    if (!s->figure.width) return;
    if (s->build == PANTIN_LINES) {
        pantin_figure_pose(&s->figure, pose);
        return;
    }
    pantin_figure_values(&s->figure, pose, keep_and_see, s);
    if (s->build == PANTIN_PERSON) turn_head(s, pose, &origin);
    sort(s);
}

void pantin_solid_pose_at(pantin_solid *s, const int32_t *pose, const pantin_placement *at) {
    if (!s->figure.width) return;
    if (s->build == PANTIN_LINES) {
        pantin_figure_pose_at(&s->figure, pose, at);
        return;
    }
    values_at(&s->figure, pose, at, keep_and_see, s);
    if (s->build == PANTIN_PERSON) turn_head(s, pose, at);
    sort(s);
}

/* ---- Pixels ---- */

/* What is drawn on: rows `top` to `bottom` - 1 of the picture. */
typedef struct {
    uint8_t *rows;
    size_t stride;
    pantin_format format;
    int32_t top, bottom, width;
} canvas;

/* A value of a pixel in the format of its rows. */
typedef uint16_t ink;

static ink of_rgb(const canvas *c, uint32_t red, uint32_t green, uint32_t blue) {
    uint32_t value = (red >> 3) << 11 | (green >> 2) << 5 | blue >> 3;
    return (ink)(c->format == PANTIN_RGB565 ? value : (value << 8 | value >> 8) & 0xffff);
}

/* The colour of a material: red, green, blue, and grey above the pattern on displays of two colours; light 256 is the material's own. */
static ink tinted(const canvas *c, const uint8_t *tint, uint32_t light) {
    uint32_t part[3];
    uint8_t i;
    if (c->format < PANTIN_L8) return (tint[3] & 15) != 0;
    if (c->format == PANTIN_L8) return (ink)least((int32_t)((tint[3] >> 4) * 17u * light >> 8), 255);
    for (i = 0; i < 3; i++) part[i] = (uint32_t)least((int32_t)(tint[i] * light >> 8), 255);
    return of_rgb(c, part[0], part[1], part[2]);
}

/* Sets every pixel from column `from` to column `to`, which belongs to them, or every second one. */
static void span_by(const canvas *c, int32_t y, int32_t from, int32_t to, ink with, uint8_t step) {
    uint8_t *row = c->rows + (size_t)(y - c->top) * c->stride;
    if (from > to) return;
    if (c->format == PANTIN_L8) {
        for (; from <= to; from += step) row[from] = (uint8_t)with;
    } else if (c->format > PANTIN_L8) {
        uint16_t *at = (uint16_t *)(void *)row;
        for (; from <= to; from += step) at[from] = with;
    } else {
        for (; from <= to; from += step) {
            uint8_t *byte = row + (from >> 3), bit = (uint8_t)(c->format == PANTIN_I1 ? 128u >> (from & 7) : 1u << (from & 7));
            if (step == 1 && (from & 7) == 0 && from + 7 <= to) {
                *byte = (uint8_t)(with ? 255 : 0);
                from += 7;
            } else {
                *byte = (uint8_t)(with ? *byte | bit : *byte & ~bit);
            }
        }
    }
}

static void span(const canvas *c, int32_t y, int32_t from, int32_t to, ink with) { span_by(c, y, from, to, with, 1); }

/* Sets a pixel that may lie outside. */
static void put(const canvas *c, int32_t x, int32_t y, ink with) {
    if (x >= 0 && x < c->width && y >= c->top && y < c->bottom) span(c, y, x, x, with);
}

/* ---- Hulls ---- */

/* Rows that are drawn at a time, and those above and below them that outlines and shaded sides look at. */
#define WINDOW 32
#define ABOVE 8
#define BELOW 14
#define ROWS (WINDOW + ABOVE + BELOW)
/* Circles farther apart, in sixteenths of a pixel, have no tangents: squares stay below 2^31. */
#define FARTHEST 32768L
/* Least length of a span that lights a pixel although it covers no pixel's middle, in sixteenths of a pixel. */
#define NARROW 10
/* Spans of at most this many pixels are drawn over what lies below them: two spans beside them would take longer. */
#define NARROW_ROW 8

/* Half the width of a circle of radius 255 at 64 heights: the middle of each. */
static const uint8_t half_widths[64] = {
    255, 255, 255, 255, 254, 254, 254, 253, 253, 252, 252, 251, 250, 249, 248, 247, 246, 245, 244, 243, 242, 240, 239, 237, 236, 234, 232, 230, 228, 226, 224, 222,
    220, 217, 215, 212, 209, 207, 204, 201, 197, 194, 191, 187, 183, 179, 175, 171, 166, 162, 157, 151, 146, 140, 134, 127, 120, 112, 103, 94, 83, 71, 55, 32,
};

/* A circle in sixteenths of a pixel: its middle and its radius. */
typedef int32_t circle[3];

/* The rows of a hull from `first` to `last`, as far as they are in rows `base` to `end` of the picture: first and last pixel. */
typedef struct {
    int16_t spans[ROWS][2];
    int32_t base, end, first, last;
} hull_rows;

static const int16_t nothing[2] = {32767, -32767 - 1};

static const int16_t *row_of(const hull_rows *h, int32_t row) { return row < h->first || row > h->last ? nothing : h->spans[row - h->base]; }

static void add_circle(hull_rows *h, const int32_t *c, int32_t pitch, uint8_t shift) {
    int32_t x = c[0], y = c[1], r = c[2], reciprocal, row, last, height;
    if (r <= 0) return;
    reciprocal = ((int32_t)64 << 16) / r;
    row = most((y - r + pitch / 2 - 1) >> shift, h->first);
    last = least((y + r - pitch / 2) >> shift, h->last);
    for (height = row * pitch + pitch / 2 - y; row <= last; row++, height += pitch) {
        int16_t *own = h->spans[row - h->base];
        int32_t index = product(size_of(height), reciprocal) >> 16, half;
        half = (r * (index < 64 ? half_widths[index] : 0) + 128) >> 8;
        own[0] = (int16_t)least(own[0], (int16_t)(x - half));
        own[1] = (int16_t)most(own[1], (int16_t)(x + half));
    }
}

/* 2^15 over the root of a square from 1 on: a number of 15 bits, and by how many bits more it is to be shifted up. */
static int32_t inverse_root(uint32_t square, uint8_t *up) {
    uint8_t zeros = zeros_before(square) & 30;
    *up = zeros / 2;
    return pantin_figure_inverse_length(square << zeros) >> 7;
}

/* The root of a number of at most 2^30, within 6. */
static int32_t root_of_fraction(uint32_t square) {
    uint8_t up;
    int32_t inverse;
    if (!square) return 0;
    inverse = inverse_root(square, &up);
    return ((int32_t)((square << (2 * up)) >> 17) * inverse) >> (13 + up);
}

/* Widens rows by a tangent between two points. */
static void add_edge(hull_rows *h, const int32_t *from, const int32_t *to, int left, int32_t pitch, uint8_t shift) {
    int32_t row = most((from[1] + pitch / 2 - 1) >> shift, h->first), last = least((to[1] - pitch / 2) >> shift, h->last), slope, x;
    if (row > last || to[1] <= from[1]) return;
    slope = (to[0] - from[0]) * 4096 / (to[1] - from[1]);
    x = sum(product(from[0], 4096), product(slope, row * pitch + pitch / 2 - from[1]));
    slope = product(slope, pitch);
    for (; row <= last; row++, x = sum(x, slope)) {
        int16_t *own = h->spans[row - h->base], place = (int16_t)(x >> 12);
        if (left) {
            if (place < own[0]) own[0] = place;
        } else if (place > own[1]) {
            own[1] = place;
        }
    }
}

/* The two outer tangents of two circles; none if one lies within the other. */
static void add_tangents(hull_rows *h, const int32_t *a, const int32_t *b, int32_t pitch, uint8_t shift) {
    int32_t d[3], sine, cosine, inverse;
    uint32_t square;
    uint8_t i, up, flip;
    for (i = 0; i < 3; i++) d[i] = b[i] - a[i];
    d[2] = -d[2];
    if (a[2] <= 0 || b[2] <= 0 || size_of(d[0]) >= FARTHEST || size_of(d[1]) >= FARTHEST) return;
    square = (uint32_t)(d[0] * d[0] + d[1] * d[1]);
    if (square <= (uint32_t)(d[2] * d[2])) return;
    /* Along the line through both middles: a vector 2^15 long, and what the tangents lean towards it, as a sine and a cosine. */
    inverse = inverse_root(square, &up);
    for (i = 0; i < 3; i++) d[i] = (d[i] * inverse) >> (15 - up);
    sine = d[2];
    cosine = root_of_fraction((uint32_t)((1L << 30) - sine * sine));
    for (flip = 0; flip < 2; flip++, cosine = -cosine) {
        int32_t normal[2], ends[2][2];
        uint8_t turned_over;
        normal[0] = (sine * d[0] - cosine * d[1]) >> 15;
        normal[1] = (sine * d[1] + cosine * d[0]) >> 15;
        for (i = 0; i < 2; i++) {
            ends[0][i] = a[i] + ((a[2] * normal[i]) >> 15);
            ends[1][i] = b[i] + ((b[2] * normal[i]) >> 15);
        }
        turned_over = ends[0][1] > ends[1][1];
        add_edge(h, ends[turned_over], ends[!turned_over], normal[0] < 0, pitch, shift);
    }
}

/* The pixels whose middles are between two places in sixteenths; a narrow span has the pixel in its middle. */
static void to_pixels(int16_t *own) {
    int32_t low = own[0], high = own[1], first = (low + 7) >> 4, last = (high - 8) >> 4;
    if (low > high || (first > last && high - low < NARROW)) {
        memcpy(own, nothing, sizeof nothing);
        return;
    }
    if (first > last) first = last = (low + high) >> 5;
    own[0] = (int16_t)first;
    own[1] = (int16_t)last;
}

/* Computes the rows of the hull of circles. With `flat`, heights are multiplied by 4: circles become ellipses, as discs on the floor are seen. */
static void compute(hull_rows *h, circle *circles, uint8_t count, int flat, int32_t base, int32_t end) {
    int32_t pitch = flat ? 64 : 16, low = 0x7fffffffL, high = -0x7fffffffL, row;
    uint8_t shift = flat ? 6 : 4, i, j;
    h->base = base;
    for (i = 0; i < count; i++) {
        if (circles[i][2] <= 0) continue;
        low = least(low, circles[i][1] - circles[i][2]);
        high = most(high, circles[i][1] + circles[i][2]);
    }
    h->first = 0;
    h->last = -1;
    if (low > high) return;
    h->first = most((low + pitch / 2 - 1) >> shift, base);
    h->last = least((high - pitch / 2) >> shift, end);
    if (h->first > h->last) {
        h->first = 0;
        h->last = -1;
        return;
    }
    for (row = h->first; row <= h->last; row++) memcpy(h->spans[row - base], nothing, sizeof nothing);
    for (i = 0; i < count; i++) {
        add_circle(h, circles[i], pitch, shift);
        for (j = (uint8_t)(i + 1); j < count; j++) add_tangents(h, circles[i], circles[j], pitch, shift);
    }
    for (row = h->first; row <= h->last; row++) to_pixels(h->spans[row - base]);
}

/* Cuts what lies outside another hull off. */
static void clip(hull_rows *h, const hull_rows *to) {
    int32_t row;
    for (row = h->first; row <= h->last; row++) {
        const int16_t *other = row_of(to, row);
        int16_t *own = h->spans[row - h->base];
        if (other[0] > other[1]) {
            memcpy(own, nothing, sizeof nothing);
        } else {
            own[0] = (int16_t)most(own[0], other[0]);
            own[1] = (int16_t)least(own[1], other[1]);
        }
    }
}

/* ---- Outlines and fills ---- */

enum { PLAIN = 0, CHECKERED, DOTTED, SHADED, RIMMED };

/* What a hull is filled with: one colour; every other pixel, or that of every other row, in the first one, the others in the second; the lit side and the
   other one, which is not covered by the hull moved by a way in pixels; a rim of a pixel and what is inside. */
typedef struct {
    uint8_t kind;
    ink inks[2];
    int32_t across, down;
} fill;

/* Half a plane that has no outline, where a neighbour that was drawn before goes on: columns before or after a place, with 12 more bits from row 0 on, which
   moves by a slope a row; or rows before or after a row. */
enum { NO_CUT = 0, FROM_LEFT, FROM_RIGHT, FROM_TOP, FROM_BOTTOM };
typedef struct {
    uint8_t kind;
    int32_t at, slope;
} cut;

typedef struct {
    ink with;
    int32_t width; /* pixels; 0 for none */
    cut cuts[2];
} outline;

static void bare(outline *o) { memset(o, 0, sizeof *o); }

/* Cuts an outline where a neighbour goes on at a circle: all that lies half a radius and more beyond its middle, as seen from the rest of the part. */
static void cut_at(cut *to, const int32_t *c, int32_t dx, int32_t dy) {
    int32_t longer = most(size_of(dx), size_of(dy)), shorter = least(size_of(dx), size_of(dy)), length, beyond = c[2] * 29 / 64, aside;
    if (longer <= c[2] / 4) return;
    /* The length of the way within 4 %. */
    length = (longer + shorter * 3 / 8) * 31 / 32;
    if (size_of(dx) * 16 < size_of(dy)) {
        to->kind = dy > 0 ? FROM_TOP : FROM_BOTTOM;
        to->at = (c[1] - (dy > 0 ? beyond : -beyond)) >> 4;
        return;
    }
    if (dx == 0) return;
    to->kind = dx > 0 ? FROM_LEFT : FROM_RIGHT;
    to->slope = -(dy * 4096) / dx;
    aside = -product(beyond, length) / dx;
    /* Pixels' middles are at 8. */
    to->at = sum((c[0] + aside - 8) * 256, product(to->slope, 8 - c[1]) >> 4);
}

/* Takes what is cut off from a row's outline. */
static void cut_row(const cut *by, int32_t row, int32_t *low, int32_t *high) {
    int32_t place = sum(by->at, product(by->slope, row)) >> 12;
    if (by->kind == FROM_LEFT) *low = most(*low, place);
    if (by->kind == FROM_RIGHT) *high = least(*high, place);
    if ((by->kind == FROM_TOP && row < by->at) || (by->kind == FROM_BOTTOM && row > by->at)) *high = -1;
}

static void fill_row(const canvas *c, const hull_rows *h, int32_t row, int32_t low, int32_t high, const fill *f) {
    int32_t lit[2], begin;
    const int16_t *own = row_of(h, row), *above, *below;
    ink around = f->inks[1], with = f->inks[0];
    uint8_t i;
    if (f->kind == PLAIN) {
        span(c, row, low, high, f->inks[0]);
        return;
    }
    if (f->kind < SHADED) {
        span(c, row, low, high, f->inks[1]);
        begin = low + ((low ^ row) & 1);
        if (f->kind == CHECKERED || !(row & 1)) span_by(c, row, begin, high, f->inks[0], 2);
        return;
    }
    if (f->kind == SHADED) {
        own = row_of(h, row + f->down);
        for (i = 0; i < 2; i++) lit[i] = own[i] - f->across;
    } else {
        above = row_of(h, row - 1);
        below = row_of(h, row + 1);
        lit[0] = most(own[0] + 1, most(above[0], below[0]));
        lit[1] = least(own[1] - 1, least(above[1], below[1]));
        around = f->inks[0];
        with = f->inks[1];
    }
    lit[0] = most(lit[0], low);
    lit[1] = least(lit[1], high);
    if (high - low < NARROW_ROW || lit[0] > lit[1]) {
        span(c, row, low, high, around);
    } else {
        span(c, row, low, lit[0] - 1, around);
        span(c, row, lit[1] + 1, high, around);
    }
    span(c, row, lit[0], lit[1], with);
}

/* How far an outline reaches to the side of a row that is `away` rows away. */
static int32_t reach_of(int32_t width, int32_t away) {
    int32_t reach = width;
    if (width < 2) return 0;
    while (reach > 0 && reach * reach + away * away > width * width + width / 2) reach--;
    return reach;
}

/* Draws the rows of a hull from `top` to `bottom`. */
static void paint(const canvas *c, const hull_rows *h, int32_t top, int32_t bottom, const outline *o, const fill *f) {
    int32_t wide = o->width, right = c->width - 1, row, away;
    if (h->first > h->last) return;
    bottom = least(bottom, h->last + wide);
    for (row = most(top, h->first - wide); row <= bottom; row++) {
        const int16_t *own = row_of(h, row);
        int32_t low = own[0] - wide, high = own[1] + wide, inner[2];
        uint8_t narrow;
        for (away = 1; away <= wide; away++) {
            const int16_t *above = row_of(h, row - away), *below = row_of(h, row + away);
            int32_t reach = reach_of(wide, away);
            low = least(low, least(above[0], below[0]) - reach);
            high = most(high, most(above[1], below[1]) + reach);
        }
        cut_row(&o->cuts[0], row, &low, &high);
        cut_row(&o->cuts[1], row, &low, &high);
        low = most(low, 0);
        high = least(high, right);
        inner[0] = most(own[0], 0);
        inner[1] = least(own[1], right);
        narrow = inner[1] - inner[0] < NARROW_ROW;
        if (wide && low <= high) {
            if (narrow) {
                span(c, row, low, high, o->with);
            } else {
                span(c, row, low, least(high, inner[0] - 1), o->with);
                span(c, row, most(low, inner[1] + 1), high, o->with);
            }
        }
        if (inner[0] <= inner[1]) fill_row(c, h, row, inner[0], inner[1], f);
    }
}

/* Draws the hull of circles, or what of the last circle lies within the hull of those before it. */
static void draw_hull(const canvas *c, circle *circles, uint8_t count, int flat, int within, const outline *o, const fill *f) {
    hull_rows own, hull;
    int32_t low = 0x7fffffffL, high = -0x7fffffffL, top, bottom;
    uint8_t i;
    for (i = (uint8_t)(within ? count - 1 : 0); i < count; i++) {
        low = least(low, circles[i][1] - circles[i][2]);
        high = most(high, circles[i][1] + circles[i][2]);
    }
    low = most((low >> (flat ? 6 : 4)) - o->width, c->top);
    high = least((high >> (flat ? 6 : 4)) + o->width, c->bottom - 1);
    for (top = low; top <= high; top += WINDOW) {
        bottom = least(top + WINDOW - 1, high);
        compute(&own, within ? circles + count - 1 : circles, (uint8_t)(within ? 1 : count), flat, top - ABOVE, bottom + BELOW);
        if (within) {
            compute(&hull, circles, (uint8_t)(count - 1), flat, top - ABOVE, bottom + BELOW);
            clip(&own, &hull);
        }
        paint(c, &own, top, bottom, o, f);
    }
}

static void plain(fill *f, ink with) {
    memset(f, 0, sizeof *f);
    f->inks[0] = with;
}

/* ---- The head ---- */

#define DETAILED (7 * 16)

/* A place in 256ths of the skull's radius along face, up and left, from its middle, with a radius. */
static void head_circle(const pantin_solid *s, int32_t face, int32_t up, int32_t left, int32_t radius, int32_t *to) {
    uint8_t i;
    for (i = 0; i < 2; i++) to[i] = s->skull[i] + ((s->face[i] * face + s->up[i] * up + s->left[i] * left) >> 8);
    to[2] = radius;
}

/* How far behind the skull's middle such a place is. */
static int32_t head_away(const pantin_solid *s, int32_t face, int32_t up, int32_t left) {
    return (s->face[2] * face + s->up[2] * up + s->left[2] * left) >> 8;
}

static void head_fill(const pantin_solid *s, const canvas *c, fill *f, uint8_t material, int32_t side) {
    plain(f, tinted(c, tint_of(s, material), FULL));
    if (c->format < PANTIN_L8 || s->skull[2] < DETAILED) return;
    f->kind = SHADED;
    f->inks[1] = tinted(c, tint_of(s, material), 159);
    f->across = side;
    f->down = side * 3 / 2;
}

static void draw_eyes(const pantin_solid *s, const canvas *c, int32_t toward) {
    int32_t r = s->skull[2], side, x;
    ink with = tinted(c, tint_of(s, EYE), FULL);
    outline o;
    circle eye[2];
    fill f;
    if (toward < -90) return;
    bare(&o);
    plain(&f, with);
    for (side = -1; side <= 1; side += 2) {
        if (r >= DETAILED) {
            if (-head_away(s, 236, 5, side * 99) * 8 <= r) continue;
            head_circle(s, 220, -20, side * 92, most(r / 10, 8), eye[0]);
            head_circle(s, 220, 20, side * 92, most(r / 10, 8), eye[1]);
            draw_hull(c, eye, 2, 0, 0, &o, &f);
        } else if (-head_away(s, 205, 0, side * 115) * 4 > r) {
            head_circle(s, 205, 0, side * 115, 0, eye[0]);
            x = eye[0][0] >> 4;
            put(c, x, (eye[0][1] + r / 10) >> 4, with);
        }
    }
}

static void draw_head(const pantin_solid *s, const canvas *c) {
    int32_t r = s->skull[2], toward = clamp(-s->face[2] * FULL / most(r, 1), -FULL, FULL), nose = most((r * 43) >> 8, 9), side = least(r >> 6, 9), size;
    uint8_t detailed = r >= DETAILED, tones = c->format >= PANTIN_L8;
    outline o, none;
    circle circles[3];
    fill f;
    bare(&none);
    o = none;
    o.with = tinted(c, tint_of(s, EDGE), FULL);
    o.width = s->outline;
    if (toward < 26) {
        head_circle(s, 271, -56, 0, nose, circles[0]);
        plain(&f, tinted(c, tint_of(s, NOSE), FULL));
        draw_hull(c, circles, 1, 0, 0, &o, &f);
    }
    memcpy(circles[0], s->skull, sizeof s->skull);
    head_circle(s, 36, -90, 0, (r * 210) >> 8, circles[1]);
    if (tones) {
        head_fill(s, c, &f, HAIR, most(side, 1));
    } else {
        plain(&f, tinted(c, tint_of(s, FACE), FULL));
        f.kind = RIMMED;
        f.inks[1] = tinted(c, tint_of(s, HAIR), FULL);
    }
    draw_hull(c, circles, 2, 0, 0, &o, &f);
    /* The face, which is a circle, as far as it lies within the head. */
    size = toward < 0 ? 205 + toward * 141 / 256 : 215;
    if (size > 38 && toward > -192) {
        head_circle(s, 133 + 192 * most(-toward, 0) / 256, -51, 0, (r * size) >> 8, circles[2]);
        head_fill(s, c, &f, FACE, most(side / 2, 1));
        draw_hull(c, circles, 3, 0, 1, &none, &f);
    }
    draw_eyes(s, c, toward);
    if (toward < 26 || (!detailed && toward >= 214)) return;
    plain(&f, tinted(c, tint_of(s, detailed ? FACE : NOSE), detailed ? 159 : FULL));
    head_circle(s, detailed ? 258 : 293, -56, 0, nose, circles[0]);
    draw_hull(c, circles, 1, 0, 0, &none, &f);
    if (!detailed) return;
    plain(&f, tinted(c, tint_of(s, NOSE), FULL));
    circles[0][0] -= r / 20;
    circles[0][1] -= r / 16;
    circles[0][2] = nose * 3 / 4;
    draw_hull(c, circles, 1, 0, 0, &none, &f);
}

/* ---- Parts ---- */

/* A part on the display: `ends` are circles at joints and the joints as bits, `covers` the joints that it covers. */
typedef struct {
    circle circles[4];
    uint8_t tint[4], count, end_circles[2], right;
    uint64_t ends[2], covers;
} part;

static void round_at(const int32_t *place, int32_t radius, int32_t *to) {
    to[0] = place[0];
    to[1] = place[1];
    to[2] = (radius * pantin_figure_magnification(place[2])) >> 14;
}

static void add(const pantin_solid *s, part *p, const int32_t *place, uint8_t radius) { round_at(place, s->radii[radius], p->circles[p->count++]); }

static uint64_t bit_of(uint8_t side, uint8_t index) { return (uint64_t)8 << (SIDE * side + index); }

#define WAIST_BIT 1u
#define NECK_BIT 2u
#define HEAD_BIT 4u

/* Chest, pelvis and neck. */
static void trunk_part(const pantin_solid *s, uint8_t number, part *p) {
    const pantin_person *q = &s->person;
    const uint8_t (*limbs)[3] = number == CHEST ? q->arms : q->legs;
    int32_t ends[2][3], middle[3], place[3];
    uint8_t i;
    if (number == NECK) {
        place_of(s, q->neck, ends[0]);
        place_of(s, q->head, ends[1]);
        between(ends[0], ends[1], s->neck_start, place);
        add(s, p, place, NECK_RADIUS);
        add(s, p, ends[1], NECK_RADIUS);
        p->end_circles[1] = 1;
        p->ends[0] = NECK_BIT;
        p->ends[1] = HEAD_BIT;
        return;
    }
    for (i = 0; i < 2; i++) place_of(s, limbs[i][0], ends[i]);
    between(ends[0], ends[1], 128, middle);
    for (i = 0; i < 2; i++) {
        between(ends[i], middle, number == CHEST ? 61 : 26, place);
        add(s, p, place, number == CHEST ? CHEST_RADIUS : PELVIS_RADIUS);
    }
    waist_of(s, place);
    add(s, p, place, WAIST_RADIUS);
    memcpy(p->tint, tint_of(s, number == CHEST ? SHIRT : TROUSERS), sizeof p->tint);
    p->end_circles[0] = 2;
    p->ends[0] = WAIST_BIT;
    p->covers = number == CHEST ? bit_of(0, 0) | bit_of(1, 0) | NECK_BIT : bit_of(0, 3) | bit_of(1, 3);
}

static void limb_part(const pantin_solid *s, uint8_t number, part *p) {
    /* Radii at both ends of a side's parts. */
    static const uint8_t SEGMENTS[SIDE][2] = {{SHOULDER, ELBOW}, {ELBOW, WRIST}, {WRIST, HAND}, {HIP, KNEE}, {KNEE, ANKLE}, {ANKLE, TOE}};
    uint8_t side = number >= LIMBS + SIDE, index = (uint8_t)((number - LIMBS) % SIDE), at = index % 3, is_end = at == 2;
    const uint8_t *limb = index < 3 ? s->person.arms[side] : s->person.legs[side];
    uint8_t own = side ? RIGHT : LEFT, end = side ? RIGHT_END : LEFT, material = is_end ? end : own;
    int32_t far[3], place[3];
    if (!is_end && index > 0) material = index == 1 ? SKIN : TROUSERS;
    place_of(s, limb[(at + 1) % 3], far);
    if (index == 2) {
        hand_of(s, side, far);
    } else if (is_end) {
        foot_of(s, side, place, far);
        add(s, p, place, HEEL);
    }
    place_of(s, limb[at], place);
    add(s, p, place, SEGMENTS[index][0]);
    add(s, p, far, SEGMENTS[index][1]);
    p->end_circles[0] = index == 5;
    p->ends[0] = bit_of(side, index);
    if (!is_end) {
        p->end_circles[1] = 1;
        p->ends[1] = bit_of(side, (uint8_t)(index + 1));
    }
    /* On displays of hues a limb is of its material, on others of its side. */
    memcpy(p->tint, tint_of(s, material), 3);
    p->tint[3] = tint_of(s, is_end ? end : own)[3];
    p->right = side;
}

static void attached_part(const pantin_solid *s, const uint8_t *attached, part *p) {
    uint8_t i, j, circles = (uint8_t)((attached[0] & 15) + 1);
    memcpy(p->tint, attached + 1, sizeof p->tint);
    for (i = 0; i < circles; i++) {
        const uint8_t *from = attached + 5 + 4 * i;
        anchor a;
        find_anchor(s, attached[0] >> 4, (int8_t)from[0], &a);
        for (j = 0; j < 2; j++) p->circles[i][j] = a.origin[j] + along(&a, from, j) / a.thousandths;
        p->circles[i][2] = from[3] * 2 * a.length / a.thousandths;
    }
    p->count = circles;
}

/* A bone of a rig that is no person's. */
static void bone_part(const pantin_solid *s, uint8_t index, part *p) {
    const pantin_bone *bone = &s->figure.bones[index];
    uint8_t material = bone->part == PANTIN_LEFT ? LEFT : bone->part == PANTIN_RIGHT ? RIGHT : SHIRT;
    /* Long bones are thicker, within what keeps a figure one. */
    int32_t units = least(most(bone_length(bone) / 6, s->height / 60), s->height / 22), radius = most(pantin_figure_seen(&s->figure, units), 8), place[3];
    place_of(s, bone->parent, place);
    round_at(place, radius, p->circles[0]);
    place_of(s, index, place);
    round_at(place, radius * 3 / 4, p->circles[1]);
    p->count = 2;
    memcpy(p->tint, tint_of(s, material), sizeof p->tint);
    p->end_circles[1] = 1;
    if (bone->parent < 64) p->ends[0] = (uint64_t)1 << bone->parent;
    if (index < 64) p->ends[1] = (uint64_t)1 << index;
    p->right = bone->part == PANTIN_RIGHT;
}

/* Depth of a part, as far as its light depends on it: of a limb that of the joint at its far end. */
static int32_t light_depth(const pantin_solid *s, uint8_t number) {
    uint8_t side = number >= LIMBS + SIDE, index = (uint8_t)((number - LIMBS) % SIDE);
    if (s->build != PANTIN_PERSON) return bone_depth(&s->figure, number);
    if (number < LIMBS || number >= PERSON_PARTS) return 0;
    return depth_at(s, (index < 3 ? s->person.arms : s->person.legs)[side][least(index % 3 + 1, 2)]);
}

static void part_fill(const pantin_solid *s, const canvas *c, const part *p, uint32_t light, fill *f) {
    int32_t total = 0;
    uint8_t i, pattern = p->tint[3] & 15;
    ink lit = tinted(c, p->tint, light);
    plain(f, lit);
    if (c->format < PANTIN_L8) {
        if (pattern == 2) {
            f->kind = CHECKERED;
            f->inks[1] = tinted(c, tint_of(s, EDGE), FULL);
        } else if (pattern == 0) {
            f->kind = RIMMED;
            f->inks[0] = tinted(c, tint_of(s, FACE), FULL);
            f->inks[1] = lit;
        }
    } else if (!s->small) {
        /* 0.42 of the mean radius towards the lower right. */
        for (i = 0; i < p->count; i++) total += p->circles[i][2];
        total /= most(p->count, 1);
        f->kind = SHADED;
        f->inks[1] = tinted(c, p->tint, (light * 159) >> 8);
        f->across = clamp((total * 62) >> 12, 1, BELOW);
        f->down = clamp((total * 87) >> 12, 1, BELOW);
    }
}

/* Cuts the outline at the ends of a part where a neighbour was drawn before. */
static void open_ends(const part *p, uint64_t drawn, outline *o) {
    int32_t others = most(p->count - 1, 1), middle[2];
    uint8_t end, i, j;
    for (end = 0; end < 2; end++) {
        const int32_t *own = p->circles[p->end_circles[end]];
        if (!(p->ends[end] & drawn)) continue;
        for (j = 0; j < 2; j++) {
            middle[j] = -own[j];
            for (i = 0; i < p->count; i++) middle[j] += p->circles[i][j];
            middle[j] = middle[j] / others - own[j];
        }
        cut_at(&o->cuts[end], own, middle[0], middle[1]);
    }
}

/* Draws a part. `drawn` has the joints of those that were drawn before. */
static void draw_part(const pantin_solid *s, const canvas *c, uint8_t number, uint64_t *drawn) {
    uint8_t person = s->build == PANTIN_PERSON;
    int32_t light;
    outline o;
    part p;
    fill f;
    if (person && number == HEAD) {
        draw_head(s, c);
        *drawn |= HEAD_BIT;
        return;
    }
    memset(&p, 0, sizeof p);
    memcpy(p.tint, tint_of(s, SKIN), sizeof p.tint);
    if (!person) {
        bone_part(s, number, &p);
    } else if (number >= PERSON_PARTS) {
        attached_part(s, attachment(s, (uint8_t)(number - PERSON_PARTS)), &p);
    } else if (number < LIMBS) {
        trunk_part(s, number, &p);
    } else {
        limb_part(s, number, &p);
    }
    /* 0.94 at the target's distance, more before it and less behind it, from 0.62 to 1; 0.9 of that on the right. */
    light = clamp(241 - light_depth(s, number) * 230 / most(s->depth, 1), 159, FULL);
    if (p.right) light = light * 9 / 10;
    part_fill(s, c, &p, (uint32_t)light, &f);
    bare(&o);
    o.with = tinted(c, tint_of(s, EDGE), FULL);
    o.width = s->outline;
    open_ends(&p, *drawn, &o);
    draw_hull(c, p.circles, p.count, 0, 0, &o, &f);
    *drawn |= p.covers | p.ends[0] | p.ends[1];
}

/* ---- Lines ---- */

/* Draws every `gap`-th pixel of a line between pixels, counted from the end with the lower coordinate along its longer way: Bresenham's. */
static void line(const canvas *c, int32_t x0, int32_t y0, int32_t x1, int32_t y1, ink with, int32_t gap) {
    int32_t from[2], to[2], step, rise, fall, rest, aside, last, waiting;
    uint8_t steep = size_of(y1 - y0) > size_of(x1 - x0), back;
    from[steep] = x0;
    from[!steep] = y0;
    to[steep] = x1;
    to[!steep] = y1;
    if (from[0] > to[0]) {
        from[0] = to[0];
        to[0] = steep ? y0 : x0;
        from[1] = to[1];
        to[1] = steep ? x0 : y0;
    }
    if (most(from[steep], to[steep]) < 0 || least(from[steep], to[steep]) >= c->width) return;
    back = to[1] < from[1];
    rise = 2 * size_of(to[1] - from[1]);
    fall = 2 * (to[0] - from[0]);
    step = most((steep ? c->top : 0) - from[0], 0);
    last = least(to[0], (steep ? c->bottom : c->width) - 1) - from[0];
    rest = rise * step + fall / 2;
    aside = fall ? rest / fall : 0;
    rest -= aside * fall;
    aside = back ? from[1] - aside : from[1] + aside;
    waiting = (gap - step % gap) % gap;
    for (; step <= last; step++, waiting--) {
        if (waiting == 0) {
            put(c, steep ? aside : from[0] + step, steep ? from[0] + step : aside, with);
            waiting = gap;
        }
        rest += rise;
        if (rest >= fall) {
            rest -= fall;
            aside += back ? -1 : 1;
        }
    }
}

/* The colour of a part of a figure of lines in a brightness. */
static ink shaded(const canvas *c, uint8_t body_part, uint32_t shade) {
    static const uint8_t HUES[4][3] = {{170, 255, 230}, {255, 236, 205}, {255, 160, 60}, {80, 190, 255}};
    const uint8_t *hue = HUES[body_part & 3];
    if (c->format < PANTIN_L8) return shade > 0;
    if (c->format == PANTIN_L8) return (ink)shade;
    return of_rgb(c, hue[0] * shade >> 8, hue[1] * shade >> 8, hue[2] * shade >> 8);
}

/* Draws a line in its width, across its longer way. */
static void stroke(const canvas *c, const pantin_line *l, int32_t gap) {
    int32_t x0 = l->from[0] >> 4, y0 = l->from[1] >> 4, x1 = l->to[0] >> 4, y1 = l->to[1] >> 4, aside = gap > 1 ? 0 : -(l->width / 2);
    int32_t end = gap > 1 ? 0 : aside + l->width - 1;
    uint8_t steep = size_of(y1 - y0) > size_of(x1 - x0);
    ink with = shaded(c, l->part, l->shade);
    for (; aside <= end; aside++) {
        if (steep) {
            line(c, x0 + aside, y0, x1 + aside, y1, with, gap);
        } else {
            line(c, x0, y0 + aside, x1, y1 + aside, with, gap);
        }
    }
}

/* Draws the ground, in its own brightness or, of a solid figure, in one colour. */
static void draw_ground(const pantin_figure *f, const canvas *c, const ink *with) {
    pantin_ground ground;
    pantin_line l;
    pantin_first_ground(&ground, f);
    while (pantin_next_ground(&ground, &l)) {
        if (f->dotted) {
            put(c, l.from[0] >> 4, l.from[1] >> 4, with ? *with : shaded(c, PANTIN_GROUND, l.shade));
        } else if (with) {
            line(c, l.from[0] >> 4, l.from[1] >> 4, l.to[0] >> 4, l.to[1] >> 4, *with, 1);
        } else {
            stroke(c, &l, c->format < PANTIN_L8 ? 5 : 1);
        }
    }
}

/* The part of a row that is on the display. */
static void stretch(const canvas *c, int32_t y, int32_t from, int32_t to, ink with) {
    if (y >= c->top && y < c->bottom) span(c, y, most(from, 0), least(to, c->width - 1), with);
}

/* Draws a dark disc with an edge. */
static void disc(const canvas *c, const pantin_head *head) {
    int32_t x = head->centre[0] >> 4, y = head->centre[1] >> 4, radius = clamp(least(head->radius + 8, 32767) >> 4, 1, 128);
    int32_t square = radius * radius + radius, width = 0, below = -1, row, inside;
    uint8_t side;
    ink with = shaded(c, PANTIN_MIDDLE, head->shade);
    if (x + radius < 0 || x - radius >= c->width) return;
    /* From the outermost row inwards rows widen. */
    for (row = radius; row >= 0; row--) {
        while ((width + 1) * (width + 1) + row * row <= square) width++;
        inside = least(width - 1, below);
        for (side = 0; side < 2; side++) {
            int32_t at = side ? y + row : y - row;
            stretch(c, at, x - width, x - inside - 1, with);
            stretch(c, at, x - inside, x + inside, 0);
            stretch(c, at, x + inside + 1, x + width, with);
        }
        below = width;
    }
}

static void draw_lines(const pantin_figure *f, const canvas *c, int ground) {
    pantin_line l;
    pantin_head head;
    uint8_t i;
    if (ground) draw_ground(f, c, NULL);
    for (i = 0; pantin_figure_line(f, i, &l); i++) stroke(c, &l, 1);
    if (pantin_figure_head(f, &head)) disc(c, &head);
}

/* ---- The floor ---- */

/* The floor in the camera's axes: up, 2^14 long, and its height along it. */
typedef struct {
    int32_t upright[3], height;
} level;

static int32_t height_in(const level *l, const int32_t *place) {
    int32_t total = 0;
    uint8_t i;
    for (i = 0; i < 3; i++) total += (place[i] * l->upright[i]) >> 2;
    return total >> 12;
}

/* A place without the bits that have no room in products. */
static void cut_place(const pantin_figure *f, const int32_t *place, int32_t *to) {
    uint8_t i;
    for (i = 0; i < 3; i++) to[i] = clamp(place[i] >> f->shift, -32768, 32767);
}

static void find_level(const pantin_figure *f, level *l) {
    int32_t view[3][3], place[3] = {0, 0, 0};
    uint8_t i;
    memcpy(view, f->view, sizeof view);
    l->upright[0] = l->upright[1] = l->upright[2] = 0;
    l->upright[f->ground_axis] = 8192;
    place[f->ground_axis] = difference(f->ground_height, f->target[f->ground_axis]);
    pantin_figure_apply(view, l->upright, l->upright);
    pantin_figure_apply_any(view, place, place);
    if (!pantin_figure_direction(l->upright)) memset(l->upright, 0, sizeof l->upright);
    for (i = 0; i < 3; i++) l->upright[i] >>= 1;
    cut_place(f, place, place);
    l->height = height_in(l, place);
}

/* The place on the floor below a joint. */
static void below(const pantin_solid *s, const level *l, uint8_t joint, int32_t *to) {
    const pantin_figure *f = &s->figure;
    int32_t place[3], by;
    uint8_t i;
    cut_place(f, kept(s, joint), place);
    by = l->height - height_in(l, place);
    for (i = 0; i < 3; i++) place[i] = (int32_t)((uint32_t)(place[i] + (product(l->upright[i], by) >> 14)) << f->shift);
    to[2] = pantin_figure_project(f, place, to);
}

/* A disc on the floor, in the hull's heights of 4. */
static void floor_disc(const pantin_solid *s, const int32_t *place, int32_t thousandths, int32_t *to) {
    to[0] = place[0];
    to[1] = place[1] * 4;
    to[2] = product(s->pixels * thousandths / 1000, pantin_figure_magnification(place[2])) >> 14;
}

/* Discs below hips, chest and feet, which shrink as the lower foot leaves the floor. */
static void draw_shadow(const pantin_solid *s, const canvas *c, const level *l, const fill *f) {
    const pantin_person *p = &s->person;
    int32_t height = 0x7fffffffL, scale, a[3], b[3];
    uint8_t side, i, from, to;
    outline o;
    circle circles[2];
    bare(&o);
    for (side = 0; side < 2; side++) {
        below(s, l, p->legs[side][2], a);
        height = least(height, a[1] - s->figure.bones[p->legs[side][2]].place[1]);
    }
    /* From 1 on the floor to 0.45. */
    scale = clamp(256 - product(most(height, 0), 154) / most(s->pixels, 1), 115, 256);
    below(s, l, p->hips, a);
    floor_disc(s, a, 105 * scale / 256, circles[0]);
    for (i = 0; i < 3; i++) {
        from = i ? p->legs[i - 1][2] : p->arms[0][0];
        to = i ? p->toes[i - 1] : p->arms[1][0];
        below(s, l, from, a);
        below(s, l, to == NONE ? from : to, b);
        between(a, b, 128, a);
        floor_disc(s, a, (i ? 70 : 84) * scale / 256, circles[1]);
        draw_hull(c, circles, 2, 1, 0, &o, f);
    }
}

/* Draws a disc and the floor's lines or dots, if the whole floor is wanted, and the shadow of a person. */
static void draw_floor(const pantin_solid *s, const canvas *c, int whole) {
    const pantin_figure *f = &s->figure;
    ink lines = tinted(c, tint_of(s, FLOOR), FULL);
    int32_t place[3];
    outline o;
    circle stage[1];
    fill filled;
    level l;
    bare(&o);
    find_level(f, &l);
    if (whole && c->format > PANTIN_L8) {
        below(s, &l, s->person.hips, place);
        floor_disc(s, place, 620, stage[0]);
        plain(&filled, tinted(c, tint_of(s, STAGE), FULL));
        draw_hull(c, stage, 1, 1, 0, &o, &filled);
    }
    if (whole) draw_ground(f, c, &lines);
    if (s->build != PANTIN_PERSON) return;
    plain(&filled, tinted(c, tint_of(s, SHADOW), FULL));
    if (c->format < PANTIN_L8) {
        filled.kind = DOTTED;
        filled.inks[1] = tinted(c, tint_of(s, EDGE), FULL);
    }
    draw_shadow(s, c, &l, &filled);
}

/* ---- Functions for the program ---- */

/* Checks what is drawn on, and clears it. */
static pantin_result begin(canvas *c, const pantin_figure *f, pantin_format format, void *rows, size_t stride, uint16_t y0, uint16_t y1) {
    size_t bytes_of_row = format < PANTIN_L8 ? (f->width + 7u) / 8 : format == PANTIN_L8 ? f->width : f->width * 2u;
    uint16_t y;
    if (!f->width) return PANTIN_ERROR_HEAD;
    if ((unsigned)format > PANTIN_RGB565_SWAPPED || y0 > y1 || y1 > f->height) return PANTIN_NOT_FOUND;
    if (stride < bytes_of_row) return PANTIN_NO_ROOM;
    c->rows = (uint8_t *)rows;
    c->stride = stride;
    c->format = format;
    c->top = y0;
    c->bottom = y1;
    c->width = f->width;
    for (y = 0; y < y1 - y0; y++) memset(c->rows + y * stride, 0, bytes_of_row);
    return PANTIN_OK;
}

pantin_result pantin_figure_draw(const pantin_figure *f, pantin_format format, void *rows, size_t stride, uint16_t y0, uint16_t y1, int ground) {
    canvas c;
    pantin_result result = begin(&c, f, format, rows, stride, y0, y1);
    if (result == PANTIN_OK) draw_lines(f, &c, ground);
    return result;
}

pantin_result pantin_solid_draw(const pantin_solid *s, pantin_format format, void *rows, size_t stride, uint16_t y0, uint16_t y1, int floor) {
    canvas c;
    uint64_t drawn = 0;
    uint8_t i;
    pantin_result result = begin(&c, &s->figure, format, rows, stride, y0, y1);
    if (result != PANTIN_OK) return result;
    if (s->build == PANTIN_LINES) {
        draw_lines(&s->figure, &c, floor);
        return PANTIN_OK;
    }
    if (floor) draw_floor(s, &c, 1);
    for (i = 0; i < s->part_count; i++) draw_part(s, &c, s->order[i], &drawn);
    return PANTIN_OK;
}

void pantin_solid_share_camera(pantin_solid *s, const pantin_solid *other) {
    pantin_figure *own = &s->figure;
    const pantin_figure *from = &other->figure;
    /* All fields from the target on are of the camera and the ground. */
    size_t at = offsetof(pantin_figure, target);
    if (!own->width || !from->width) return;
    own->width = from->width;
    own->height = from->height;
    memcpy((uint8_t *)own + at, (const uint8_t *)from + at, sizeof *own - at);
    measure(s);
}

pantin_result pantin_solid_draw_together(const pantin_solid *const *figures, size_t count, pantin_format format, void *rows, size_t stride, uint16_t y0,
                                         uint16_t y1, int floor) {
    int32_t keys[PANTIN_SOLID_TOGETHER][PANTIN_SOLID_PARTS], best = 0, key;
    uint64_t drawn[PANTIN_SOLID_TOGETHER];
    uint8_t next[PANTIN_SOLID_TOGETHER], i, farthest;
    canvas c;
    pantin_result result;
    if (count > PANTIN_SOLID_TOGETHER) return PANTIN_NO_ROOM;
    for (i = 0; i < count; i++) {
        if (figures[i]->figure.width != figures[0]->figure.width || figures[i]->figure.height != figures[0]->figure.height) return PANTIN_NOT_FOUND;
    }
    if (count == 0) return PANTIN_ERROR_HEAD;
    result = begin(&c, &figures[0]->figure, format, rows, stride, y0, y1);
    if (result != PANTIN_OK) return result;
    for (i = 0; i < count; i++) {
        /* Figures of lines are drawn whole, and have no parts to come. */
        next[i] = figures[i]->build == PANTIN_LINES ? PANTIN_SOLID_PARTS : 0;
        drawn[i] = 0;
        if (next[i]) {
            draw_lines(&figures[i]->figure, &c, floor && i == 0);
        } else {
            keys_of(figures[i], keys[i]);
        }
    }
    for (i = 0; i < count && floor; i++) {
        if (!next[i]) draw_floor(figures[i], &c, i == 0);
    }
    do {
        farthest = NONE;
        for (i = 0; i < count; i++) {
            if (next[i] >= figures[i]->part_count) continue;
            key = clamp(keys[i][next[i]], -32768L, 32767L);
            /* Of equally far parts that of the first figure comes first. */
            if (farthest != NONE && key <= best) continue;
            farthest = i;
            best = key;
        }
        if (farthest != NONE) draw_part(figures[farthest], &c, figures[farthest]->order[next[farthest]++], &drawn[farthest]);
    } while (farthest != NONE);
    return PANTIN_OK;
}

#endif
