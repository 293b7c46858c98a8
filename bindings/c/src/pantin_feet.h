/* Feet of a character that stay where they are put: in states, and through transitions, which wait for a matching foot.
 *
 * It plays the table of feet of a bank (`[feet]` and `sync = "feet"` of a state machine, see MACHINE.md of the crate pantin-animator): poses and placements
 * are those of the crate, bit for bit. Programs that do not call pantin_character_feet have none of this code. It computes with the rotations of
 * pantin_figure.c, and is for 32-bit processors.
 *
 *     static pantin_feet feet;
 *
 *     if (pantin_character_open(&character, &source, &memory, 0) != PANTIN_OK || pantin_character_feet(&character, &feet) != PANTIN_OK) return 0;
 */
#ifndef PANTIN_FEET_H
#define PANTIN_FEET_H

#include "pantin_animator.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Feet of a table, points of a foot beside its ankle, and joints from the root to an ankle, at most. */
#define PANTIN_FEET 2
#define PANTIN_FOOT_POINTS 4
#define PANTIN_LEG_JOINTS 12

/* What pantin_character_held gives for a foot that the clip moves. */
#define PANTIN_NO_JOINT 0xffffu

/* A joint of a leg: 28 bytes. */
typedef struct pantin_leg_bone {
    int16_t offset[3];  /* in its parent, in figure units: the largest part of the rig's bones is below 2^14 of them */
    uint16_t places[3]; /* channels of its place, or PANTIN_NO_JOINT */
    uint16_t first;     /* the first channel that turns it */
    uint8_t length, shape, axes[3];
    uint8_t parts[8];   /* of a map or a quaternion the component of each channel, two to a byte */
} pantin_leg_bone;

/* A distance that dies out, and the one that it would go in the whole time at the velocity at which it was let go. */
typedef struct pantin_ease {
    int32_t d, v;
} pantin_ease;

/* What a foot remembers from update to update. */
typedef struct pantin_foot_state {
    int64_t at[3];     /* where the point that was on the ground was in the world */
    int64_t anchor[3]; /* where the held point stays */
    int64_t lowest;    /* the least height over the ground at which the pose had it */
    pantin_ease flat[2], rise;
    uint32_t since_us[2]; /* since the foot was let go, and since its height was */
    uint32_t step_us;     /* the time in which it comes to its clip's place */
    int32_t lift;         /* how high it is lifted on its way back */
    int32_t hinge[3];     /* the axis about which the knee bends, in its own axes, and the sine of the greatest bend that it was seen at */
    int32_t most;
    uint8_t doing, point; /* whether it is held, and at which point: 0 is the ankle */
    uint8_t before;       /* the point that was on the ground at the last update, or 255 */
    uint8_t level;        /* 1 while the height stays too */
    uint8_t steps;        /* 1: it was too far away, and is not held before it has come to its clip's place */
    uint8_t bent;         /* 1 once the hinge is known */
} pantin_foot_state;

/* A foot and its leg. */
typedef struct pantin_foot {
    uint16_t ankle, joints[PANTIN_FOOT_POINTS]; /* indices in the rig: the ankle, and its points */
    uint8_t point_count, bone_count;
    uint8_t upside_down; /* 1: the ground is above, in raw units */
    uint8_t parents[PANTIN_FOOT_POINTS]; /* the point on which a point hangs */
    pantin_leg_bone bones[PANTIN_LEG_JOINTS], points[PANTIN_FOOT_POINTS];
    int32_t upper[2], lower[2]; /* lengths of thigh and shin in figure units, and 2^29 over each */
    int32_t nearest, farthest;  /* distances between hip and ankle that the knee allows */
    pantin_foot_state state;
} pantin_foot;

/* The feet of a character: about 1.4 KB. Fields may be read; only the functions change them. */
typedef struct pantin_feet {
    uint32_t table;             /* position of the table in the bank */
    uint16_t contacts, entries; /* of the table */
    uint8_t clips, count;       /* feet that are held */
    uint8_t stale;              /* 1 after a failed read: the legs have to be found again */
    int8_t exponent;            /* of the unit of what feet remember */
    uint32_t coding;            /* of the clip in whose form the legs are */
    int16_t shift;              /* from position channels to figure units */
    int32_t most_drop;          /* how far the hips may go down: 2 cm */
    int32_t sunk;               /* how far they went down in the last update, in figure units */
    pantin_foot feet[PANTIN_FEET];
} pantin_feet;

/* Holds the feet of a character, for which `feet` lends memory: call it right after pantin_character_open. Returns PANTIN_NOT_FOUND if the bank has no
 * table of feet, PANTIN_ERROR_MACHINE for a table that contradicts itself or the rig, PANTIN_NO_ROOM for a leg of more than PANTIN_LEG_JOINTS joints, or
 * what reading returned. */
pantin_result pantin_character_feet(pantin_character *character, pantin_feet *feet);

/* The joint at which a foot of the table is held, by its index in the rig; PANTIN_NO_JOINT while the clip moves the foot. */
uint16_t pantin_character_held(const pantin_character *character, uint8_t foot);

#ifdef __cplusplus
}
#endif

#endif
