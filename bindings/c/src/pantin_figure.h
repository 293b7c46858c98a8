/* Figures: from a pose of a clip to the lines and the head of a wireframe figure on a display.
 *
 * Like the decoder it allocates nothing, uses no floating point and needs only stdint.h, stddef.h and string.h. The lines are those of the crate
 * pantin-figure, number for number. The caller lends all memory; a figure of a person needs about 25 bones, as many drives as its clip has
 * channels, and 4 slots.
 *
 *     static pantin_bone bones[32];
 *     static pantin_drive drives[64];
 *     static pantin_slot slots[PANTIN_FIGURE_SLOTS];
 *     static pantin_joint_info scratch[40];
 *     pantin_figure figure;
 *     pantin_line line;
 *     uint8_t i;
 *
 *     pantin_figure_memory(&figure, bones, 32, drives, 64, slots, PANTIN_FIGURE_SLOTS);
 *     if (pantin_figure_set_up(&figure, &player, 128, 64, scratch, 40) == PANTIN_OK &&
 *         pantin_figure_aim(&figure, &player, &pantin_default_view) == PANTIN_OK) {
 *         pantin_figure_pose(&figure, player.pose);
 *         for (i = 0; pantin_figure_line(&figure, i, &line); i++) {
 *             draw_line(line.from[0] >> 4, line.from[1] >> 4, line.to[0] >> 4, line.to[1] >> 4);
 *         }
 *     }
 *
 * Compile with PANTIN_EULER_ONLY defined to leave out quaternions and exponential maps: 3 KB of tables. Rigs with such channels are refused then.
 */
#ifndef PANTIN_FIGURE_H
#define PANTIN_FIGURE_H

#include "pantin.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The most slots that any figure needs. */
#define PANTIN_FIGURE_SLOTS 9

/* The most bones of a figure. */
#define PANTIN_MAX_BONES 254

/* One channel, or group of channels, that drives a joint: 4 bytes. */
typedef struct pantin_drive {
    uint16_t first; /* the group's first channel in a pose */
    uint16_t what;  /* what it does (3 bits), and for a group how far behind the first each member is (3 bits each, 7: absent) */
} pantin_drive;

/* A joint of the figure: 20 bytes. */
typedef struct pantin_bone {
    int16_t offset[3]; /* position in its parent, figure units */
    int16_t place[2];  /* position on the display in this pose: sixteenths of a pixel from the left and the top edge */
    int16_t depth;     /* behind the camera's target, 2^-15 of the camera's distance */
    uint8_t parent;    /* index of the parent's bone, or 255 */
    uint8_t joint;     /* index in the rig */
    uint8_t drives;    /* number of its drives, which follow those of the bone before */
    uint8_t slot, parent_slot; /* where its rotation and its parent's are kept, or 255 */
    uint8_t order;     /* of the bones that are lines, sorted from far to near: the bone that is drawn at this place */
    uint8_t kind : 2;  /* PANTIN_BONE and so on */
    uint8_t part : 2;  /* PANTIN_MIDDLE and so on */
    uint8_t moves : 1; /* 1 if it has position channels */
} pantin_bone;

/* Kinds of bones: a line from the parent, no line, the top of the head. */
enum { PANTIN_BONE = 0, PANTIN_HIDDEN, PANTIN_CROWN };

/* Of which part of the figure a line is. */
enum { PANTIN_GROUND = 0, PANTIN_MIDDLE, PANTIN_LEFT, PANTIN_RIGHT };

/* The rotation (three columns in Q15) and position of a joint on which others hang: 48 bytes, used while a pose is placed. */
typedef struct pantin_slot {
    int32_t rotation[3][3];
    int32_t position[3];
} pantin_slot;

/* Memory for a joint of the rig while a figure is set up: 16 bytes. */
typedef struct pantin_joint_info {
    int16_t bone[3];
    uint16_t length, reach, finger;
    uint8_t parent, weight, link, flags;
} pantin_joint_info;

/* From where the figure is seen. */
typedef struct pantin_view {
    int16_t orbit; /* degrees about the vertical: 0 looks the figure in the face, 90 sees it walk to the left, -90 to the right */
    int16_t tilt;  /* degrees above the horizon */
    uint8_t fixed; /* 0: the camera follows the hips; 1: it shows all that the clip covers */
    uint8_t up;    /* the vertical axis as in pantin_rig, or PANTIN_RIG_UP */
} pantin_view;

#define PANTIN_RIG_UP 255u

/* Three quarters from the front, 12 degrees above the horizon, following the hips. */
extern const pantin_view pantin_default_view;

/* A figure before its camera. Fields may be read; only the functions change them. */
typedef struct pantin_figure {
    pantin_bone *bones;
    pantin_drive *drives;
    pantin_slot *slots;
    uint16_t bone_room, drive_room, slot_room;
    uint16_t bone_count, drive_count, slot_count; /* those in use */
    uint16_t line_count;      /* bones that are lines */
    uint16_t width, height;   /* of the display, pixels */
    int16_t offset[2];        /* by pantin_figure_shift: pixels to the right and down */
    uint16_t hips;            /* index of the bone that the camera follows */
    uint8_t up;               /* of the rig */
    uint8_t sides[2];         /* a bone of the left side and its counterpart, or 255 */
    uint8_t crown;            /* index of the crown, or 255 */
    int16_t exponent;         /* one figure unit is 2^exponent units of the source */
    int16_t position_shift;   /* from position channels to figure units */
    int32_t size;             /* rough height of the figure in figure units */
    int32_t head_radius;
    int32_t places[2][3];     /* positions of the joints that only place the figure */
    int32_t target[3];        /* where the camera looks in this pose; the fields from here on are of the camera and the ground */
    int32_t view[3][3];       /* the camera's rotation times its factor, as columns */
    int32_t fixed[3];         /* coordinates of the target along axes that the camera does not follow */
    uint8_t fixed_axes;       /* bit i: axis i is fixed */
    uint8_t dotted;           /* 1: the ground is dots, 0: it is lines */
    uint8_t ground_axis;      /* the vertical axis */
    uint8_t ground_spacing;   /* 2^ground_spacing figure units between lines or dots */
    int32_t ground_height;
    uint8_t shift, spare, depth_shift;
    int32_t depth_factor;
    int32_t centre[2];        /* where the target is on the display, sixteenths of a pixel */
    int32_t scale, camera_size;
} pantin_figure;

/* Lends memory to a figure. */
void pantin_figure_memory(pantin_figure *figure, pantin_bone *bones, size_t bone_room, pantin_drive *drives, size_t drive_room, pantin_slot *slots,
                          size_t slot_room);

/* Sets the figure up for a player's clip and a display of `width` times `height` pixels, each at most 2047. `scratch` lends an element for each
 * joint of the rig, at most 255, and is free again afterwards; it may be the player's memory for moving channels. Leaves the player at frame 0.
 * Returns PANTIN_NOT_FOUND for a width or height of 0 or above 2047, PANTIN_NO_ROOM if the memory is too small, PANTIN_ERROR_RIG if a joint's channels cannot be drawn, or what reading the rig returned. */
pantin_result pantin_figure_set_up(pantin_figure *figure, pantin_player *player, uint16_t width, uint16_t height, pantin_joint_info *scratch,
                                   size_t scratch_room);

/* Chooses the camera so that the figure fills the display over the clip: it plays about 48 frames of it twice. Leaves the player at its frame.
 * Returns PANTIN_OK or what the player returned. */
pantin_result pantin_figure_aim(pantin_figure *figure, pantin_player *player, const pantin_view *view);

/* Places the figure in a pose of the clip's rig, and sorts its lines from far to near. */
void pantin_figure_pose(pantin_figure *figure, const int32_t *pose);

/* A line. Its pixels are its places divided by 16, rounded down (>> 4). */
typedef struct pantin_line {
    int16_t from[2], to[2]; /* x, y in sixteenths of a pixel */
    int16_t depth;
    uint8_t shade; /* brightness, 255 is nearest */
    uint8_t part;  /* PANTIN_MIDDLE and so on */
    uint8_t width; /* pixels */
} pantin_line;

/* Gives line `index` of the figure, 0 the farthest. Returns 1, or 0 if there is none. */
int pantin_figure_line(const pantin_figure *figure, uint8_t index, pantin_line *line);

/* The head: a filled circle, in sixteenths of a pixel. */
typedef struct pantin_head {
    int16_t centre[2], radius;
    uint8_t shade;
} pantin_head;

/* Gives the head. Returns 1, or 0 if the rig names none. */
int pantin_figure_head(const pantin_figure *figure, pantin_head *head);

/* The place on the ground from which to go on. */
typedef struct pantin_ground {
    const pantin_figure *figure;
    int32_t corner[3], place[3], steps[2][3];
    uint8_t row, column;
} pantin_ground;

/* Places a cursor before the first line or dot of the ground below the last pose. */
void pantin_first_ground(pantin_ground *ground, const pantin_figure *figure);

/* Moves to the next dot, of a figure with `dotted` 1: only line->from and line->shade are set. To the next line otherwise. Returns 1, or 0 if
 * there is none. */
int pantin_next_ground(pantin_ground *ground, pantin_line *line);

/* Moves the picture by whole pixels to the right and down. Cameras that are set up later keep it there, until pantin_figure_set_up. */
void pantin_figure_shift(pantin_figure *figure, int16_t x, int16_t y);

#ifdef __cplusplus
}
#endif

#endif
