/* Rotations of joints by name: as Euler angles in any order, a quaternion or a matrix, however the clip codes the joint.
 *
 * A joint is found once; the reference is then read frame by frame. All numbers are those of the Rust decoder, bit for bit.
 *
 *     pantin_joint_ref knee;
 *     pantin_order order;
 *     int32_t angles[3];
 *
 *     if (pantin_find(&clip, "left-shin", &knee) != PANTIN_OK) return missing("left-shin");
 *     order = knee.order == PANTIN_NO_ORDER ? PANTIN_ZXY : (pantin_order)knee.order;
 *     ...
 *     if (pantin_euler(&player, &knee, order, angles) == PANTIN_OK) turn_servo(pantin_centidegrees(angles[0]));
 *
 * Read Euler angles in the joint's own order: if the clip codes the joint as Euler angles, they are the clip's own. Otherwise the second angle is within
 * 90 degrees of zero, so that the first and the third can jump by 180 degrees from one frame to the next; and where the second is near 90 or -90 degrees,
 * only the first plus or minus the third is determined.
 */
#ifndef PANTIN_TURN_H
#define PANTIN_TURN_H

#include "pantin.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The order of three Euler angles: each turns about the axis as rotated by those before it, as a BVH file lists them. PANTIN_ZYX is the rotation
 * matrix Rz Ry Rx; its angles are stored z, y, x. */
typedef enum pantin_order { PANTIN_XYZ = 0, PANTIN_XZY, PANTIN_YXZ, PANTIN_YZX, PANTIN_ZXY, PANTIN_ZYX } pantin_order;

/* How a clip codes a joint's rotation. */
enum {
    PANTIN_FORM_EULER = 0,   /* up to three angles about different axes; also a joint without rotation channels */
    PANTIN_FORM_EXPONENTIAL, /* an exponential map */
    PANTIN_FORM_QUATERNION,
    PANTIN_FORM_CHAIN        /* a product of several of these */
};

/* A joint of a clip, found once. It stays valid for other clips of the same rig (of a bank): the first call after such a change reads how the
 * clip codes the joint. A reference of zeros refers to no joint. */
typedef struct pantin_joint_ref {
    uint32_t rig_id;
    uint32_t coding;        /* pantin_clip.coding of the clip that `form` and `exponential` describe */
    uint16_t index;         /* of the joint in the rig */
    uint16_t first_channel; /* index of its first value in a pose */
    uint8_t channels;       /* 0 to 15 */
    uint8_t found;          /* 1, or 0 if the rig has no such joint */
    uint8_t form;           /* PANTIN_FORM_EULER and so on */
    uint8_t exponential;    /* 1 if its Euler channels hold an exponential map in this clip */
    uint8_t order;          /* the order of its Euler angles in the rig; PANTIN_NO_ORDER if the rig does not have it as Euler angles */
    uint8_t kinds[8];       /* kinds of its channels in the rig, two to a byte, low half first */
} pantin_joint_ref;

#define PANTIN_NO_ORDER 255

/* Finds a joint by name. Returns PANTIN_NOT_FOUND if the rig has none; `joint->found` is 0 then. */
pantin_result pantin_find(const pantin_clip *clip, const char *name, pantin_joint_ref *joint);

/* Makes a reference to a joint of the clip's rig that a cursor is at. */
pantin_result pantin_refer(const pantin_clip *clip, const pantin_joint *at, pantin_joint_ref *joint);

/* The functions below read the joint at the player's frame. They return PANTIN_OK, or without a change of the result PANTIN_NOT_FOUND if the reference
 * is to no joint, PANTIN_ERROR_OTHER_RIG if it is to a joint of another rig, and PANTIN_NEED_MORE if the player has not started. */

/* Gives the three Euler angles in 2^-32 turns; angles[0] is about the first axis of `order`, one of the six. Any other number is
 * the joint's own order, or XYZ if it has none. What the angles are in its own order and in others stands at the top of this file. */
pantin_result pantin_euler(const pantin_player *player, pantin_joint_ref *joint, pantin_order order, int32_t *angles);

/* Gives the unit quaternion w, x, y, z in 2^-30. Of the two that are the same rotation it may be either. */
pantin_result pantin_quaternion(const pantin_player *player, pantin_joint_ref *joint, int32_t *wxyz);

/* Gives the nine elements of the rotation matrix in 2^-30, row by row. */
pantin_result pantin_matrix(const pantin_player *player, pantin_joint_ref *joint, int32_t *rows);

/* Gives the whole angle by which the joint is turned, about whatever axis, in 2^-32 turns: 0 to half a turn, which is -2^31. */
pantin_result pantin_angle(const pantin_player *player, pantin_joint_ref *joint, int32_t *angle);

/* Gives the raw value of one of the joint's channels, 0 to `joint->channels` - 1, as the clip codes it: of an exponential map that is no angle.
 * Returns PANTIN_NOT_FOUND also if the joint has no such channel. */
pantin_result pantin_raw_value(const pantin_player *player, const pantin_joint_ref *joint, uint8_t channel, int32_t *value);

#ifdef __cplusplus
}
#endif

#endif
