/* What the animator uses of rotations: not for programs. See pantin_turn.h; turn.rs and trig.rs of the Rust decoder state the steps. */
#ifndef PANTIN_TURN_PARTS_H
#define PANTIN_TURN_PARTS_H

#include "pantin_turn.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sine and cosine in Q30, and the angle of a vector, in 2^-32 turns. */
void pantin_turn_sin_cos(int32_t angle, int32_t *sine, int32_t *cosine);
int32_t pantin_turn_atan2(int32_t y, int32_t x);

/* The unit quaternion w, x, y, z of a joint in a pose. The reference has to be to the clip whose pose it is. */
void pantin_turn_unit(const int32_t *pose, const pantin_joint_ref *joint, int32_t *q);

/* The matrix of a unit quaternion, row by row. */
void pantin_turn_matrix(const int32_t *q, int32_t *rows);

/* Turns q about an axis that q has turned; makes `a` the rotation by a, then by b; makes a map in q[1] to q[3] a quaternion; makes the length 1. */
void pantin_turn_about(int32_t *q, uint8_t axis, int32_t angle);
void pantin_turn_multiply(int32_t *a, const int32_t *b);
void pantin_turn_exponential(int32_t *q);
void pantin_turn_normalize(int32_t *q);

/* The whole angle of a unit quaternion, which is overwritten. */
int32_t pantin_turn_angle(int32_t *q);

/* The Euler angles of a unit quaternion in an order, and the axes of an order. */
void pantin_turn_angles(const int32_t *q, uint8_t order, int32_t *angles);
void pantin_turn_axes(uint8_t order, uint8_t *axes);

/* The sum of two products of numbers in Q30, rounded once. */
int32_t pantin_turn_dot(const int32_t *a, const int32_t *b);

#ifdef __cplusplus
}
#endif

#endif
