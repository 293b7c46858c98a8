/* What solid figures and feet use of figures: not for programs. See pantin_figure.h, pantin_solid.h and pantin_feet.h. */
#ifndef PANTIN_FIGURE_PARTS_H
#define PANTIN_FIGURE_PARTS_H

#include "pantin_figure.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a drive does, in the low 3 bits of its `what`: it turns about x, y or z, places the joint, or turns it by a map or a quaternion. The members of a
 * group follow, 3 bits each: PANTIN_DRIVE_WHOLE_MAP and PANTIN_DRIVE_WHOLE_UNIT are groups without gaps. */
enum { PANTIN_DRIVE_TURN = 0, PANTIN_DRIVE_PLACE = 3, PANTIN_DRIVE_MAP = 4, PANTIN_DRIVE_UNIT = 5 };
enum { PANTIN_DRIVE_WHOLE_MAP = PANTIN_DRIVE_MAP | 1 << 6 | 2 << 9, PANTIN_DRIVE_WHOLE_UNIT = PANTIN_DRIVE_UNIT | 1 << 6 | 2 << 9 | 3 << 12 };

/* What a clip covers of the display, in sixteenths of a pixel from the target. */
typedef struct pantin_extent {
    int32_t top, bottom, side;
} pantin_extent;

/* Takes what a pose covers besides the bones' lines into `extent`. */
typedef void (*pantin_figure_cover)(const void *context, const pantin_figure *figure, pantin_extent *extent);

/* What is done with each joint's position. */
typedef void (*pantin_figure_visit)(void *context, uint8_t index, const int32_t *position);

/* pantin_figure_aim for what `cover` says. */
pantin_result pantin_figure_aim_for(pantin_figure *figure, pantin_player *player, const pantin_view *view, pantin_figure_cover cover,
                                    const void *context);

/* The cover of a figure of lines: its head. */
void pantin_figure_cover_head(const void *context, const pantin_figure *figure, pantin_extent *extent);

/* Takes in a circle. */
void pantin_figure_widen(pantin_extent *extent, const int16_t *place, int16_t radius);

/* Places a pose before the camera; `each` is called with every joint's position in the camera's axes. pantin_figure_see, with the figure as its
 * context, projects it. */
void pantin_figure_values(pantin_figure *figure, const int32_t *pose, pantin_figure_visit each, void *context);
void pantin_figure_see(void *context, uint8_t index, const int32_t *position);

/* The hips of a pose in the world; then lets the camera follow a target, along the axes that it follows. */
void pantin_figure_hips(const pantin_figure *figure, const int32_t *pose, int32_t *hips);
void pantin_figure_follow(pantin_figure *figure);

/* Sorts the lines from far to near. */
void pantin_figure_sort(pantin_figure *figure);

/* Places the first `count` joints about `origin`, turned by `view`. */
void pantin_figure_place(const pantin_figure *figure, const int32_t *pose, int32_t (*view)[3], const int32_t *origin, uint16_t count,
                         pantin_figure_visit each, void *context);

/* The rotation of the world itself. */
void pantin_figure_world(int32_t (*view)[3]);

/* Turns a rotation by all that turns a joint; `drives` are the joint's own. */
void pantin_figure_rotate(int32_t (*rotation)[3], const pantin_bone *bone, const pantin_drive *drives, const int32_t *pose);

/* The image of a vector whose components are within 2^15 and whose length is below 2^16, and of a vector of any length: cut off at 2^29. */
void pantin_figure_apply(int32_t (*rotation)[3], const int32_t *v, int32_t *to);
void pantin_figure_apply_any(int32_t (*rotation)[3], const int32_t *v, int32_t *to);

/* Length of a vector, rounded down to a few units. */
int32_t pantin_figure_length(const int32_t *v);

/* Sixteenths of a pixel of a length in figure units at the target's distance. */
int32_t pantin_figure_seen(const pantin_figure *figure, int32_t length);

/* Camera's distance over that of a point at `depth`, in Q14. */
int32_t pantin_figure_magnification(int32_t depth);

/* The place on the display of one in the camera's axes, in sixteenths of a pixel. Returns its depth. */
int32_t pantin_figure_project(const pantin_figure *figure, const int32_t *place, int32_t *to);

/* Makes a vector its direction in Q15. Returns 0 for a vector of no length. */
int pantin_figure_direction(int32_t *v);

/* pantin_figure_direction more exactly: the functions of the module `vector` of the crate pantin-math, for vectors of length 1 at most in Q15. A length past
 * 2^30 is cut off. */
int pantin_figure_aim_along(int32_t *v, int32_t *length);
int32_t pantin_figure_dot(const int32_t *a, const int32_t *b);
void pantin_figure_cross(const int32_t *a, const int32_t *b, int32_t *to);

/* The angle of a unit vector in Q15 from the x axis, in 2^-32 turns. */
int32_t pantin_figure_angle(int32_t y, int32_t x);

/* The inverse of a length in Q22 by its square, 2^30 (a length of 1) to 2^32 - 1. */
int32_t pantin_figure_inverse_length(uint32_t square);

/* Returns 1 if a name contains a word, in any case. `words` are in small letters, with a | between them. */
uint8_t pantin_figure_names(const pantin_name *name, const char *words);

/* Moves a cursor to a joint of the rig. Returns 0 if it cannot be read. */
int pantin_figure_go_to(pantin_joint *joint, const pantin_rig *rig, uint8_t index);

#ifdef __cplusplus
}
#endif

#endif
