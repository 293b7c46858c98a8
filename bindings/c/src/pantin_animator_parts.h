/* What feet use of the animator: not for programs. See pantin_animator.h and pantin_feet.h. */
#ifndef PANTIN_ANIMATOR_PARTS_H
#define PANTIN_ANIMATOR_PARTS_H

#include "pantin_animator.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Shapes of groups. */
enum { PANTIN_FREE = 0, PANTIN_EULER, PANTIN_MAP, PANTIN_UNIT };

/* The section of a bank that holds the table of feet. */
enum { PANTIN_FEET_SECTION = 5 };

/* No transition waits. */
#define PANTIN_NO_TRANSITION 255u

/* A row of the table's states: speed is in 2^-16, the time in which a blend follows its parameter in 1/64 s. */
typedef struct pantin_state_row {
    uint8_t clip, other, parameter, follow, first, count;
    int32_t speed;
} pantin_state_row;

/* In place of a row's second clip. */
#define PANTIN_NO_CLIP 255u

/* What a character calls of its feet: by these, programs without feet have none of their code. */
typedef struct pantin_feet_calls {
    /* The frame of the new clip at which a transition that waits begins, and the time until then. Returns 0 if none comes. */
    int (*next)(const pantin_character *character, uint8_t transition, uint32_t *frame, uint64_t *ns);
    /* Corrects the pose of an update. After a read that failed, the feet are what they were before. */
    pantin_result (*hold)(pantin_character *character, uint32_t elapsed_us);
    /* Corrects a pose that was composed again, as it was. */
    pantin_result (*again)(pantin_character *character);
} pantin_feet_calls;

void pantin_animator_read_state(const pantin_character *character, uint8_t state, pantin_state_row *row);

/* How far a track is on the way from its frame to the next, in 2^-16. */
uint16_t pantin_animator_part(const pantin_track *track);

/* The root of a square, rounded down. */
uint64_t pantin_animator_root(uint64_t square);

/* Which component each channel of a map (`count` 3) or a quaternion (4) holds: 15 bytes; one of 4 and more stands for none. */
void pantin_animator_places(const pantin_joint_ref *joint, uint8_t count, uint8_t *places);

/* The exponential map of a unit quaternion. */
void pantin_animator_map(const int32_t *q, int32_t *map);

/* Writes to `from` what is the same rotation and nearest to `to`, a channel. */
void pantin_animator_nearest(uint8_t shape, int32_t *from, const int32_t *to, uint8_t count);

/* An angle with its sine and cosine, and a horizontal vector that is turned by it. */
void pantin_animator_heading(pantin_heading *heading, int32_t angle);
void pantin_animator_rotate(const pantin_heading *heading, int32_t a, int32_t b, int64_t *to);

/* Where the figure is when its root is at a place of the clip. */
void pantin_animator_locate(const pantin_animator *animator, const int32_t *place, pantin_placement *to);

/* Brings carried differences to this frame, and solves one for a number of frames. */
void pantin_animator_leave_carried(pantin_animator *animator);
void pantin_animator_solve(uint8_t frames, pantin_offset *offset);

#ifdef __cplusplus
}
#endif

#endif
