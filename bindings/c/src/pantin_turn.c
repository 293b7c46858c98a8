/* Rotations of joints: see pantin_turn.h. The steps are those that turn.rs and trig.rs of the Rust decoder state, with the same names. */
#include "pantin_turn_parts.h"
#include "pantin_tables.h"

#define ONE 0x40000000L

/* ---- Integers ---- */

/* The upper half of a product. */
#if defined(__AVR__) && defined(__AVR_HAVE_MUL__)
/* Column by column of the bytes' products, each added to three bytes. The registers are those of the arguments and such as a function need not keep: 97
 * cycles with the call, a third of what the compiler's own product takes. */
#define PANTIN_PRODUCT(a, b, low, middle, top) "mul " a ", " b "\n\tadd " low ", r0\n\tadc " middle ", r1\n\tadc " top ", r31\n\t"
static uint32_t high(uint32_t a, uint32_t b) __attribute__((noinline));
static uint32_t high(uint32_t a, uint32_t b) {
    register uint32_t x __asm__("r22") = a;
    register uint32_t y __asm__("r18") = b;
    __asm__(
        "clr r31\n\tmul r22, r18\n\tmov r26, r1\n\tclr r27\n\tclr r30\n\t"
        PANTIN_PRODUCT("r22", "r19", "r26", "r27", "r30")
        PANTIN_PRODUCT("r23", "r18", "r26", "r27", "r30")
        "clr r26\n\t"
        PANTIN_PRODUCT("r22", "r20", "r27", "r30", "r26")
        PANTIN_PRODUCT("r23", "r19", "r27", "r30", "r26")
        PANTIN_PRODUCT("r24", "r18", "r27", "r30", "r26")
        "clr r27\n\t"
        PANTIN_PRODUCT("r22", "r21", "r30", "r26", "r27")
        PANTIN_PRODUCT("r23", "r20", "r30", "r26", "r27")
        PANTIN_PRODUCT("r24", "r19", "r30", "r26", "r27")
        PANTIN_PRODUCT("r25", "r18", "r30", "r26", "r27")
        /* The result begins here; r22 and r18 are used up. */
        "clr r30\n\t"
        PANTIN_PRODUCT("r23", "r21", "r26", "r27", "r30")
        PANTIN_PRODUCT("r24", "r20", "r26", "r27", "r30")
        PANTIN_PRODUCT("r25", "r19", "r26", "r27", "r30")
        "mov r22, r26\n\tclr r26\n\t"
        PANTIN_PRODUCT("r24", "r21", "r27", "r30", "r26")
        PANTIN_PRODUCT("r25", "r20", "r27", "r30", "r26")
        "mul r25, r21\n\tadd r30, r0\n\tadc r26, r1\n\t"
        "mov r23, r27\n\tmov r24, r30\n\tmov r25, r26\n\tclr r1"
        : "+r"(x), "+r"(y)
        :
        : "r0", "r26", "r27", "r30", "r31");
    return x;
}
#undef PANTIN_PRODUCT
#else
static uint32_t high(uint32_t a, uint32_t b) { return (uint32_t)(((uint64_t)a * b) >> 32); }
#endif

static uint32_t magnitude(int32_t x) { return x < 0 ? 0u - (uint32_t)x : (uint32_t)x; }

static int32_t negated(uint32_t x, int negative) { return (int32_t)(negative ? 0u - x : x); }

/* x is not 0. */
static uint8_t leading_zeros(uint32_t x) {
    uint8_t count = 0;
    while (!(x & 0xff000000UL)) {
        x <<= 8;
        count = (uint8_t)(count + 8);
    }
    while (!(x & 0x80000000UL)) {
        x <<= 1;
        count++;
    }
    return count;
}

/* Shifts by whole bytes first: an 8-bit processor shifts by one place at a time. */
static uint32_t shifted(uint32_t x, uint8_t up) {
    for (; up >= 8; up = (uint8_t)(up - 8)) x <<= 8;
    for (; up > 0; up--) x <<= 1;
    return x;
}

/* Adds the product of `a` and `*b` to a number of 64 bits, given as its halves. */
#if defined(__AVR__) && defined(__AVR_HAVE_MUL__)
/* Row by row, 115 cycles: each byte of b by the four of a, which are two numbers of 32 bits, the second a byte higher. The factors count as numbers without
 * signs; then a negative one takes the other off the upper half. */
#define PANTIN_EVEN "ld %[byte], %a[b]+\n\tmul %A[a], %[byte]\n\tmovw %A[t], r0\n\tmul %C[a], %[byte]\n\tmovw %C[t], r0\n\t"
#define PANTIN_ODD "mul %B[a], %[byte]\n\tmovw %A[t], r0\n\tmul %D[a], %[byte]\n\tmovw %C[t], r0\n\t"
#define PANTIN_ADD(p, q, r, s) "add " p ", %A[t]\n\tadc " q ", %B[t]\n\tadc " r ", %C[t]\n\tadc " s ", %D[t]\n\t"
#define PANTIN_CARRY(p) "adc " p ", %[z]\n\t"
#define PANTIN_TAKE(p, q, r, s) "sub %A[u], " p "\n\tsbc %B[u], " q "\n\tsbc %C[u], " r "\n\tsbc %D[u], " s "\n"
#define PANTIN_ADD_PRODUCT(upper, lower, a_, b_) \
    do { \
        uint32_t pantin_t; \
        uint8_t pantin_byte, pantin_z; \
        __asm__( \
            "clr %[z]\n\t" \
            PANTIN_EVEN PANTIN_ADD("%A[l]", "%B[l]", "%C[l]", "%D[l]") PANTIN_CARRY("%A[u]") PANTIN_CARRY("%B[u]") PANTIN_CARRY("%C[u]") PANTIN_CARRY("%D[u]") \
            PANTIN_ODD PANTIN_ADD("%B[l]", "%C[l]", "%D[l]", "%A[u]") PANTIN_CARRY("%B[u]") PANTIN_CARRY("%C[u]") PANTIN_CARRY("%D[u]") \
            PANTIN_EVEN PANTIN_ADD("%B[l]", "%C[l]", "%D[l]", "%A[u]") PANTIN_CARRY("%B[u]") PANTIN_CARRY("%C[u]") PANTIN_CARRY("%D[u]") \
            PANTIN_ODD PANTIN_ADD("%C[l]", "%D[l]", "%A[u]", "%B[u]") PANTIN_CARRY("%C[u]") PANTIN_CARRY("%D[u]") \
            PANTIN_EVEN PANTIN_ADD("%C[l]", "%D[l]", "%A[u]", "%B[u]") PANTIN_CARRY("%C[u]") PANTIN_CARRY("%D[u]") \
            PANTIN_ODD PANTIN_ADD("%D[l]", "%A[u]", "%B[u]", "%C[u]") PANTIN_CARRY("%D[u]") \
            PANTIN_EVEN PANTIN_ADD("%D[l]", "%A[u]", "%B[u]", "%C[u]") PANTIN_CARRY("%D[u]") \
            PANTIN_ODD PANTIN_ADD("%A[u]", "%B[u]", "%C[u]", "%D[u]") \
            "clr r1\n\tsbrs %[byte], 7\n\trjmp 1f\n\t" \
            PANTIN_TAKE("%A[a]", "%B[a]", "%C[a]", "%D[a]") \
            "1:\tsbrs %D[a], 7\n\trjmp 2f\n\t" \
            "ld %D[t], -%a[b]\n\tld %C[t], -%a[b]\n\tld %B[t], -%a[b]\n\tld %A[t], -%a[b]\n\tadiw %A[b], 4\n\t" \
            PANTIN_TAKE("%A[t]", "%B[t]", "%C[t]", "%D[t]") \
            "2:" \
            : [u] "+r"(upper), [l] "+r"(lower), [b] "+e"(b_), [t] "=&r"(pantin_t), [byte] "=&r"(pantin_byte), [z] "=&r"(pantin_z) \
            : [a] "r"(a_), "m"(*(b_)) \
            : "r0"); \
    } while (0)

/* The sum of `count` products, exact, from Q60 to Q30 with `up` (2), or to twice that (3). */
static int32_t dot(const int32_t *a, const int32_t *b, uint8_t count, uint8_t up) {
    uint32_t upper = 0, lower = up == 2 ? 0x20000000UL : 0x10000000UL;
    for (; count > 0; count--, a++) {
        uint32_t x = (uint32_t)*a;
        if (x == 0) {
            b++;
        } else {
            PANTIN_ADD_PRODUCT(upper, lower, x, b);
        }
    }
    return (int32_t)(up == 2 ? upper << 2 | (uint8_t)(lower >> 24) >> 6 : upper << 3 | (uint8_t)(lower >> 24) >> 5);
}
#else
static int32_t dot(const int32_t *a, const int32_t *b, uint8_t count, uint8_t up) {
    uint64_t sum = up == 2 ? 0x20000000UL : 0x10000000UL;
    for (; count > 0; count--, a++, b++) sum += (uint64_t)((int64_t)*a * *b);
    return (int32_t)(uint32_t)(sum >> (32 - up));
}
#endif

static int32_t scaled(int32_t a, int32_t q30) { return dot(&a, &q30, 1, 2); }

/* ---- Sine, cosine, arctangent, inverse square root ---- */

static const uint32_t pantin_turn_sine[4] PANTIN_FLASH = {1686629708UL, 693598003UL, 85555982UL, 4941520UL};
static const uint32_t pantin_turn_cosine[4] PANTIN_FLASH = {1324675878UL, 272375455UL, 22399895UL, 973605UL};
static const uint32_t pantin_turn_arctangent[6] PANTIN_FLASH = {683565272UL, 227854097UL, 136665923UL, 96821929UL, 69146217UL, 34631066UL};

/* The polynomial with alternating signs at `u`. */
static uint32_t alternating(const uint32_t *coefficients, uint8_t count, uint32_t u) {
    uint32_t sum = PANTIN_U32(coefficients + count - 1);
    for (count = (uint8_t)(count - 1); count > 0; count--) sum = PANTIN_U32(coefficients + count - 1) - high(u, sum);
    return sum;
}

static void sin_cos(int32_t angle, int32_t *sine, int32_t *cosine) {
    uint8_t quarter = (uint8_t)((uint8_t)(((uint32_t)angle + 0x20000000UL) >> 24) >> 6);
    uint32_t rest = (uint32_t)angle - ((uint32_t)(uint8_t)(quarter << 6) << 24);
    uint32_t t = ((rest & 0x80000000UL) ? 0u - rest : rest) << 2, u = high(t, t);
    int32_t sin = negated(high(t, alternating(pantin_turn_sine, 4, u)), (rest & 0x80000000UL) != 0);
    int32_t cos = ONE - (int32_t)high(u, alternating(pantin_turn_cosine, 4, u));
    *sine = quarter & 1 ? cos : sin;
    *cosine = quarter & 1 ? -sin : cos;
    if (quarter & 2) {
        *sine = -*sine;
        *cosine = -*cosine;
    }
}

static uint32_t reciprocal(uint32_t d) {
    uint32_t r = 0xb4b4b4b5UL - high(d, 0x78787878UL);
    uint8_t i;
    for (i = 0; i < 3; i++) r = high(r, 0x80000000UL - high(d, r)) << 2;
    return r;
}

static int32_t atan2_of(int32_t y, int32_t x) {
    uint32_t across = magnitude(y), along = magnitude(x), small, large, z, angle;
    uint8_t up, far;
    small = across > along ? along : across;
    large = across > along ? across : along;
    if (large == 0) return 0;
    up = leading_zeros(large);
    small = shifted(small, up) >> 1;
    large = shifted(large, up) >> 1;
    far = small > large >> 1;
    if (far) {
        uint32_t sum = large + small;
        small = large - small;
        large = sum;
    }
    if (!(large & 0x80000000UL)) {
        small <<= 1;
        large <<= 1;
    }
    z = high(small, reciprocal(large)) << 2;
    angle = high(z, alternating(pantin_turn_arctangent, 6, high(z, z)));
    if (far) angle = 0x20000000UL - angle;
    if (across > along) angle = 0x40000000UL - angle;
    if (x < 0) angle = 0x80000000UL - angle;
    return negated(angle, y < 0);
}

static uint32_t inverse_root(uint32_t n) {
    uint32_t y = 0x887d9c55UL - high(n, 0x4dfea27aUL);
    uint8_t i;
    for (i = 0; i < 4; i++) y = high(y, 0xc0000000UL - high(high(n, y) << 2, y)) << 1;
    return y + 2;
}

/* ---- Unit quaternions w, x, y, z in Q30 ---- */

/* Makes the length of `q` 1, and returns the length it had; no rotation for 0. */
static uint32_t direction(int32_t *q) {
    uint32_t raised[4], largest = 0, square = 0, inverse, root;
    uint8_t i, up, down;
    for (i = 0; i < 4; i++) {
        raised[i] = magnitude(q[i]);
        largest |= raised[i];
    }
    if (largest == 0) {
        q[0] = ONE;
        return 0;
    }
    down = up = leading_zeros(largest);
    for (i = 0; i < 4; i++) {
        raised[i] = shifted(raised[i], up) >> 1;
        square += high(raised[i], raised[i]);
    }
    if (square < 0x40000000UL) {
        for (i = 0; i < 4; i++) raised[i] <<= 1;
        square <<= 2;
        down++;
    }
    inverse = inverse_root(square);
    for (i = 0; i < 4; i++) q[i] = negated(high(raised[i], inverse), q[i] < 0);
    root = high(square, inverse);
    return down < 3 ? root << (3 - down) : root >> (down - 3);
}

static int is_no_rotation(const int32_t *q) { return q[0] == ONE && !(q[1] | q[2] | q[3]); }

/* a becomes the rotation by a, then by b about the axes that a has turned. */
static void multiply(int32_t *a, const int32_t *b) {
    int32_t column[4], product[4];
    uint8_t i, j;
    /* Products with 1 are exact. */
    if (is_no_rotation(b)) return;
    if (is_no_rotation(a)) {
        memcpy(a, b, sizeof product);
        return;
    }
    for (i = 0; i < 4; i++) {
        /* Row i of b: the component i ^ j, whose sign is that of the product of two units. */
        for (j = 0; j < 4; j++) {
            int32_t part = b[i ^ j];
            /* Bit 4 i + j: w -x -y -z; x w z -y; y -z w x; z y -x w. */
            column[j] = (0x428eu >> (4 * i + j)) & 1 ? -part : part;
        }
        product[i] = dot(a, column, 4, 2);
    }
    memcpy(a, product, sizeof product);
}

/* q becomes the rotation by q, then by the angle about the axis that q has turned: `multiply` without the products with 0. */
static void turn_about(int32_t *q, uint8_t axis, int32_t angle) {
    uint8_t second = (uint8_t)(axis == 2 ? 1 : axis + 2), third = (uint8_t)(axis == 0 ? 3 : axis);
    int32_t a[2], factors[2], sin, product[4];
    /* No rotation: the products are exact. */
    if (angle == 0) return;
    sin_cos((int32_t)(((uint32_t)angle >> 1) | ((uint32_t)angle & 0x80000000UL)), &sin, &factors[0]);
    factors[1] = -sin;
    axis = (uint8_t)(axis + 1);
    if (is_no_rotation(q)) {
        q[0] = factors[0];
        q[axis] = sin;
        return;
    }
    a[0] = q[0];
    a[1] = q[axis];
    product[0] = dot(a, factors, 2, 2);
    a[0] = q[third];
    a[1] = q[second];
    product[third] = dot(a, factors, 2, 2);
    factors[1] = sin;
    a[0] = q[second];
    a[1] = q[third];
    product[second] = dot(a, factors, 2, 2);
    a[0] = q[axis];
    a[1] = q[0];
    product[axis] = dot(a, factors, 2, 2);
    memcpy(q, product, sizeof product);
}

static void no_rotation(int32_t *q) {
    memset(q, 0, 4 * sizeof *q);
    q[0] = ONE;
}

/* q[1] to q[3] hold an exponential map. */
static void of_exponential(int32_t *q) {
    int32_t sin;
    uint32_t angle;
    uint8_t i;
    q[0] = 0;
    angle = direction(q);
    /* No rotation: the products are exact. */
    if (angle == 0) return;
    sin_cos((int32_t)(angle >> 1), &sin, &q[0]);
    for (i = 1; i < 4; i++) q[i] = scaled(q[i], sin);
}

static void axes_of(uint8_t order, uint8_t *axes) {
    uint8_t first = (uint8_t)(order >> 1), low = first == 0, high_axis = (uint8_t)(first == 2 ? 1 : 2);
    axes[0] = first;
    axes[1] = order & 1 ? high_axis : low;
    axes[2] = order & 1 ? low : high_axis;
}

/* The order that begins with the first `count` axes; PANTIN_NO_ORDER if they are not different or more than three. */
static uint8_t order_of(uint8_t *axes, uint8_t count) {
    if (count > 3) return PANTIN_NO_ORDER;
    if (count == 0) axes[0] = 0;
    if (count < 2) axes[1] = (uint8_t)(axes[0] == 2 ? 0 : axes[0] + 1);
    if (count < 3) axes[2] = (uint8_t)(3 - axes[0] - axes[1]);
    if (((1u << axes[0]) | (1u << axes[1]) | (1u << axes[2])) != 7) return PANTIN_NO_ORDER;
    return (uint8_t)(2 * axes[0] + (axes[1] > axes[2]));
}

/* ---- Joints ---- */

static uint8_t kind_of(const pantin_joint_ref *joint, uint8_t channel) {
    uint8_t pair = joint->kinds[channel >> 1];
    return channel & 1 ? (uint8_t)(pair >> 4) : (uint8_t)(pair & 15);
}

/* What the form of the joint is in a clip. */
static void choose_form(pantin_joint_ref *joint) {
    uint8_t axes[3] = {0, 0, 0}, angles = 0, maps = 0, quaternions = 0, c, order;
    for (c = 0; c < joint->channels; c++) {
        uint8_t kind = kind_of(joint, c);
        if (kind >= PANTIN_EXPONENTIAL_X) {
            maps = 1;
        } else if (kind >= PANTIN_QUATERNION_W) {
            quaternions = 1;
        } else if (kind >= PANTIN_EULER_X) {
            if (angles < 3) axes[angles] = (uint8_t)(kind - PANTIN_EULER_X);
            angles++;
        }
    }
    order = order_of(axes, angles);
    joint->order = angles && !maps && !quaternions ? order : PANTIN_NO_ORDER;
    joint->form = PANTIN_FORM_CHAIN;
    if (!maps && !quaternions) {
        if (angles && joint->exponential) {
            joint->form = PANTIN_FORM_EXPONENTIAL;
        } else if (order != PANTIN_NO_ORDER) {
            joint->form = PANTIN_FORM_EULER;
        }
    } else if (!angles && maps != quaternions) {
        joint->form = maps ? PANTIN_FORM_EXPONENTIAL : PANTIN_FORM_QUATERNION;
    }
}

pantin_result pantin_refer(const pantin_clip *clip, const pantin_joint *at, pantin_joint_ref *joint) {
    pantin_source *rig = clip->rig.source;
    uint8_t c;
    memset(joint, 0, sizeof *joint);
    rig->error = clip->source->error = PANTIN_OK;
    for (c = 0; c < at->channels; c++) joint->kinds[c >> 1] |= (uint8_t)(pantin_joint_kind(at, c) << (c & 1 ? 4 : 0));
    if (rig->error != PANTIN_OK) return rig->error;
    joint->exponential = (uint8_t)pantin_joint_is_exponential(clip, at);
    if (rig->error != PANTIN_OK || clip->source->error != PANTIN_OK) {
        return rig->error != PANTIN_OK ? rig->error : clip->source->error;
    }
    joint->rig_id = clip->rig.id;
    joint->coding = clip->coding;
    joint->index = at->index;
    joint->first_channel = at->first_channel;
    joint->channels = at->channels;
    joint->found = 1;
    choose_form(joint);
    return PANTIN_OK;
}

pantin_result pantin_find(const pantin_clip *clip, const char *name, pantin_joint_ref *joint) {
    pantin_joint at;
    memset(joint, 0, sizeof *joint);
    if (!pantin_find_joint(&clip->rig, name, &at)) {
        return clip->rig.source->error != PANTIN_OK ? clip->rig.source->error : PANTIN_NOT_FOUND;
    }
    return pantin_refer(clip, &at, joint);
}

/* Whether a joint can be read, which may be coded otherwise than in the clip before. */
static pantin_result check(const pantin_player *player, pantin_joint_ref *joint) {
    const pantin_clip *clip = player->clip;
    if (!joint->found) return PANTIN_NOT_FOUND;
    if (joint->rig_id != clip->rig.id) return PANTIN_ERROR_OTHER_RIG;
    if (!player->started) return PANTIN_NEED_MORE;
    if (joint->coding != clip->coding) {
        pantin_joint at;
        pantin_joint_ref again;
        pantin_result result;
        clip->rig.source->error = PANTIN_OK;
        pantin_first_joint(&at, &clip->rig);
        while (at.index != joint->index) {
            if (!pantin_next_joint(&at)) return clip->rig.source->error != PANTIN_OK ? clip->rig.source->error : PANTIN_NOT_FOUND;
        }
        result = pantin_refer(clip, &at, &again);
        if (result != PANTIN_OK) return result;
        *joint = again;
    }
    return PANTIN_OK;
}

/* The order of a joint's angles in the clip. */
static uint8_t own_order(const pantin_joint_ref *joint) {
    if (joint->order == PANTIN_NO_ORDER) return PANTIN_XYZ;
    return joint->order;
}

/* The values of a joint of one form: Euler angles in the joint's order, x, y, z of a map, or w, x, y, z of a quaternion. */
static void own_values(const int32_t *pose, const pantin_joint_ref *joint, int32_t *own) {
    const int32_t *value = pose + joint->first_channel;
    uint8_t c, count = 0;
    memset(own, 0, 4 * sizeof *own);
    for (c = 0; c < joint->channels; c++, value++) {
        uint8_t kind = kind_of(joint, c), place;
        if (kind < PANTIN_EULER_X) continue;
        if (kind < PANTIN_QUATERNION_W) {
            place = count++;
        } else {
            place = (uint8_t)(kind < PANTIN_EXPONENTIAL_X ? kind - PANTIN_QUATERNION_W : kind - PANTIN_EXPONENTIAL_X);
        }
        if (place < 4) own[place] = *value;
    }
}

/* The product of everything that turns a joint of several parts. */
static void chain(const int32_t *pose, const pantin_joint_ref *joint, int32_t *q) {
    const int32_t *value = pose + joint->first_channel;
    int32_t coded[4] = {0, 0, 0, 0}, quaternion[4] = {0, 0, 0, 0}, map[4] = {0, 0, 0, 0};
    uint8_t c, count = 0;
    no_rotation(q);
    for (c = 0; c < joint->channels; c++, value++) {
        uint8_t kind = kind_of(joint, c);
        if (kind >= PANTIN_EXPONENTIAL_X) {
            map[kind - PANTIN_EXPONENTIAL_X + 1] = *value;
        } else if (kind >= PANTIN_QUATERNION_W) {
            quaternion[kind - PANTIN_QUATERNION_W] = *value;
        } else if (kind >= PANTIN_EULER_X && joint->exponential) {
            if (count < 3) coded[++count] = *value;
        } else if (kind >= PANTIN_EULER_X) {
            turn_about(q, (uint8_t)(kind - PANTIN_EULER_X), *value);
        }
    }
    of_exponential(coded);
    multiply(q, coded);
    (void)direction(quaternion);
    multiply(q, quaternion);
    of_exponential(map);
    multiply(q, map);
    (void)direction(q);
}

static void unit(const int32_t *pose, const pantin_joint_ref *joint, int32_t *q) {
    int32_t own[4];
    uint8_t axes[3], i;
    if (joint->form == PANTIN_FORM_CHAIN) {
        chain(pose, joint, q);
        return;
    }
    own_values(pose, joint, own);
    switch (joint->form) {
    case PANTIN_FORM_EXPONENTIAL:
        memcpy(q + 1, own, 3 * sizeof *own);
        of_exponential(q);
        break;
    case PANTIN_FORM_QUATERNION:
        memcpy(q, own, sizeof own);
        (void)direction(q);
        break;
    default:
        axes_of(own_order(joint), axes);
        no_rotation(q);
        for (i = 0; i < 3; i++) turn_about(q, axes[i], own[i]);
    }
}

/* The angle of a vector shorter than 2^31; its length is returned. */
static int32_t polar(int32_t y, int32_t x, int32_t *angle) {
    int32_t sin, cos;
    *angle = atan2_of(y, x);
    sin_cos(*angle, &sin, &cos);
    return scaled(x, cos) + scaled(y, sin);
}

static void angles_of(const int32_t *q, uint8_t order, int32_t *angles) {
    int32_t own, other, third, sum, difference, longer, shorter;
    uint8_t axes[3], odd;
    axes_of(order, axes);
    odd = axes[1] != (axes[0] == 2 ? 0 : axes[0] + 1);
    own = q[axes[0] + 1];
    other = q[axes[1] + 1];
    third = q[axes[2] + 1];
    if (odd) third = -third;
    longer = polar(own + third, q[0] + other, &sum);
    shorter = polar(own - third, q[0] - other, &difference);
    angles[0] = (int32_t)((uint32_t)sum + (uint32_t)difference);
    angles[1] = (int32_t)(0x40000000UL - 2 * (uint32_t)atan2_of(shorter, longer));
    angles[2] = negated((uint32_t)sum - (uint32_t)difference, odd);
}

pantin_result pantin_euler(const pantin_player *player, pantin_joint_ref *joint, pantin_order order, int32_t *angles) {
    pantin_result result = check(player, joint);
    int32_t q[4];
    uint8_t wanted = (unsigned)order > PANTIN_ZYX ? own_order(joint) : (uint8_t)order;
    if (result != PANTIN_OK) return result;
    if (joint->form == PANTIN_FORM_EULER && own_order(joint) == wanted) {
        own_values(player->pose, joint, q);
        memcpy(angles, q, 3 * sizeof *q);
    } else {
        unit(player->pose, joint, q);
        angles_of(q, wanted, angles);
    }
    return PANTIN_OK;
}

pantin_result pantin_quaternion(const pantin_player *player, pantin_joint_ref *joint, int32_t *wxyz) {
    pantin_result result = check(player, joint);
    if (result == PANTIN_OK) unit(player->pose, joint, wxyz);
    return result;
}

static void matrix_of(const int32_t *q, int32_t *rows) {
    int32_t a[2], b[2];
    uint8_t i;
    for (i = 0; i < 3; i++) {
        uint8_t j = (uint8_t)(i == 2 ? 0 : i + 1), k = (uint8_t)(3 - i - j);
        a[0] = q[j + 1];
        a[1] = q[k + 1];
        b[0] = -a[0];
        b[1] = -a[1];
        rows[4 * i] = (int32_t)((uint32_t)ONE + (uint32_t)dot(a, b, 2, 3));
        /* Element (j, k) is 2 (q[j] q[k] - w q[i]), (k, j) with plus. */
        a[1] = q[0];
        b[0] = q[k + 1];
        b[1] = -q[i + 1];
        rows[3 * j + k] = dot(a, b, 2, 3);
        b[1] = q[i + 1];
        rows[3 * k + j] = dot(a, b, 2, 3);
    }
}

pantin_result pantin_matrix(const pantin_player *player, pantin_joint_ref *joint, int32_t *rows) {
    pantin_result result = check(player, joint);
    int32_t q[4];
    if (result != PANTIN_OK) return result;
    unit(player->pose, joint, q);
    matrix_of(q, rows);
    return PANTIN_OK;
}

static int32_t whole_angle(int32_t *q) {
    uint32_t w = magnitude(q[0]);
    q[0] = 0;
    return (int32_t)(2 * (uint32_t)atan2_of((int32_t)direction(q), (int32_t)w));
}

pantin_result pantin_angle(const pantin_player *player, pantin_joint_ref *joint, int32_t *angle) {
    pantin_result result = check(player, joint);
    int32_t q[4];
    if (result != PANTIN_OK) return result;
    unit(player->pose, joint, q);
    *angle = whole_angle(q);
    return PANTIN_OK;
}

pantin_result pantin_raw_value(const pantin_player *player, const pantin_joint_ref *joint, uint8_t channel, int32_t *value) {
    if (!joint->found || channel >= joint->channels) return PANTIN_NOT_FOUND;
    if (joint->rig_id != player->clip->rig.id) return PANTIN_ERROR_OTHER_RIG;
    if (!player->started) return PANTIN_NEED_MORE;
    *value = player->pose[joint->first_channel + channel];
    return PANTIN_OK;
}

/* ---- For the animator: see pantin_turn_parts.h ---- */

void pantin_turn_sin_cos(int32_t angle, int32_t *sine, int32_t *cosine) { sin_cos(angle, sine, cosine); }
int32_t pantin_turn_atan2(int32_t y, int32_t x) { return atan2_of(y, x); }
void pantin_turn_unit(const int32_t *pose, const pantin_joint_ref *joint, int32_t *q) { unit(pose, joint, q); }
void pantin_turn_matrix(const int32_t *q, int32_t *rows) { matrix_of(q, rows); }
void pantin_turn_about(int32_t *q, uint8_t axis, int32_t angle) { turn_about(q, axis, angle); }
void pantin_turn_multiply(int32_t *a, const int32_t *b) { multiply(a, b); }
void pantin_turn_exponential(int32_t *q) { of_exponential(q); }
void pantin_turn_normalize(int32_t *q) { (void)direction(q); }
int32_t pantin_turn_angle(int32_t *q) { return whole_angle(q); }
void pantin_turn_angles(const int32_t *q, uint8_t order, int32_t *angles) { angles_of(q, order, angles); }
void pantin_turn_axes(uint8_t order, uint8_t *axes) { axes_of(order, axes); }
int32_t pantin_turn_dot(const int32_t *a, const int32_t *b) { return dot(a, b, 2, 2); }
