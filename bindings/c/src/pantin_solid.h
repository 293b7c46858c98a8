/* Solid figures: from a pose of a clip to a body with volume, drawn as pixels into rows that the caller lends.
 *
 * Like the decoder it allocates nothing, uses no floating point and needs only stdint.h, stddef.h and string.h. The pixels are those of the type
 * SolidFigure of the crate pantin-figure, bit for bit. A rig that is no person's is drawn as capsules, one with more than 48 bones as lines.
 *
 *     static pantin_bone bones[32];
 *     static pantin_drive drives[64];
 *     static pantin_slot slots[PANTIN_FIGURE_SLOTS];
 *     static pantin_joint_info scratch[40];
 *     static uint16_t rows[16 * 240];
 *     static pantin_solid solid;
 *
 *     pantin_figure_memory(&solid.figure, bones, 32, drives, 64, slots, PANTIN_FIGURE_SLOTS);
 *     if (pantin_solid_set_up(&solid, &player, 240, 240, scratch, 40) == PANTIN_OK &&
 *         pantin_solid_aim(&solid, &player, &pantin_default_view) == PANTIN_OK) {
 *         do {
 *             pantin_solid_pose(&solid, player.pose);
 *             for (y = 0; y < 240; y += 16) {
 *                 pantin_solid_draw(&solid, PANTIN_RGB565, rows, 480, y, y + 16, 1);
 *                 send(rows, y, y + 16);
 *             }
 *         } while (pantin_step(&player) == PANTIN_OK);
 *     }
 *
 * Colours, radii and attachments are those of a character, which LOOKS.md of the project describes: `pantin expand FILE.look -o look.h` compiles one.
 *
 * Solid figures are for 32-bit processors. Nothing of this is compiled where PANTIN_EULER_ONLY is defined.
 */
#ifndef PANTIN_SOLID_H
#define PANTIN_SOLID_H

#include "pantin_figure.h"
#include "pantin_format.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The most parts of a solid figure. */
#define PANTIN_SOLID_PARTS 48

/* The most bytes of a character. */
#define PANTIN_LOOK_BYTES 200

/* What a rig is drawn as: lines, a capsule for each bone, a person of 16 parts. */
enum { PANTIN_LINES = 0, PANTIN_CAPSULES, PANTIN_PERSON };

/* The joints of a person, as indices of bones; 255 for a waist, fingers or toes that are not there. Sides: left, right. */
typedef struct pantin_person {
    uint8_t hips, waist, neck, head;
    uint8_t arms[2][3]; /* shoulder, elbow, wrist */
    uint8_t legs[2][3]; /* hip, knee, ankle */
    uint8_t fingers[2], toes[2];
} pantin_person;

/* A solid figure. Fields may be read; only the functions change them. */
typedef struct pantin_solid {
    pantin_figure figure;  /* its camera and its joints */
    const uint8_t *look;   /* NULL: the default character */
    pantin_person person;
    uint8_t build;         /* PANTIN_PERSON and so on */
    uint8_t sorted;        /* 1 once a pose was taken since the camera was set up */
    uint8_t tight;         /* 1: the camera makes no room for head, hands and attachments */
    uint8_t outline;       /* pixels */
    uint8_t small;         /* 1: the character's radii of smaller figures */
    uint8_t part_count;
    uint8_t order[PANTIN_SOLID_PARTS]; /* parts, the farthest first */
    int32_t height;        /* of a person, of other rigs their size: in figure units, in sixteenths of a pixel, in units of depth */
    int32_t pixels, depth;
    int16_t radii[14];     /* sixteenths of a pixel */
    int16_t hands[2], neck_start, toe_parts[2], heels[2][2]; /* parts of ways, in 256ths */
    int16_t head_axes[3][3]; /* up, ahead and left in the head's own axes, 2^13 long */
    int32_t skull_offset[2]; /* the skull's middle above and before the head's joint, in 256ths of its radius */
    int32_t skull[3], up[3], face[3], left[3]; /* the head on the display */
    int32_t places[13][3]; /* of the person's joints, in the camera's axes */
} pantin_solid;

/* Changes the character; `look` is not copied, NULL is the default one. Set the camera up after it. Returns PANTIN_ERROR_LENGTH, PANTIN_ERROR_VERSION
 * or PANTIN_ERROR_HEAD for bytes that are no character: nothing changes then. */
pantin_result pantin_solid_look(pantin_solid *solid, const uint8_t *look, size_t length);

/* Sets the figure up for a player's clip: pantin_figure_set_up on solid->figure, to which memory was lent, then finds a person's joints. It plays
 * about 48 frames of the clip. Leaves the player at frame 0. Returns PANTIN_NOT_FOUND for a width or height of 0 or above 2047, and what
 * pantin_figure_set_up does; after a read that failed (PANTIN_ERROR_READ) it may be called again. */
pantin_result pantin_solid_set_up(pantin_solid *solid, pantin_player *player, uint16_t width, uint16_t height, pantin_joint_info *scratch,
                                  size_t scratch_room);

/* Chooses the camera: see pantin_figure_aim. It makes room for head, hands and attachments unless solid->tight was set to 1. PANTIN_ERROR_HEAD for a
 * figure of zeroes, which was not set up. After a read that failed (PANTIN_ERROR_READ), call it again before the figure is drawn. */
pantin_result pantin_solid_aim(pantin_solid *solid, pantin_player *player, const pantin_view *view);

/* Places the figure in a pose of the clip's rig and sorts its parts. Parts change places only if their depths differ clearly, so the order can depend
 * on the poses before. */
void pantin_solid_pose(pantin_solid *solid, const int32_t *pose);

/* Sets the pose of a figure that stands somewhere in the world, as `placement` of an animator says in the unit of the clip for which the figure was set
 * up: the ground, and a camera that is fixed, stay where they are. The second function is for a figure of lines. */
void pantin_solid_pose_at(pantin_solid *solid, const int32_t *pose, const pantin_placement *placement);
void pantin_figure_pose_at(pantin_figure *figure, const int32_t *pose, const pantin_placement *placement);

/* Draws rows y0 to y1 - 1 of the picture: `rows` takes them from its start, `stride` bytes each. They are cleared before. With `floor` 1 the figure
 * stands on a floor and has a shadow. Returns PANTIN_NOT_FOUND if y1 is beyond the display or the format is unknown, PANTIN_NO_ROOM if `stride` is
 * too small for a row, PANTIN_ERROR_HEAD for a figure that was not set up. */
pantin_result pantin_solid_draw(const pantin_solid *solid, pantin_format format, void *rows, size_t stride, uint16_t y0, uint16_t y1, int floor);

/* The most figures of one picture. */
#define PANTIN_SOLID_TOGETHER 8

/* Takes over camera and ground of another figure of the same rig, so that both stand in one world; take a pose after it. Nothing happens if one of them was
 * not set up. */
void pantin_solid_share_camera(pantin_solid *solid, const pantin_solid *other);

/* Draws figures in the poses that they took last, as pantin_solid_draw does one: the floor of the first, the shadows of all, and then the parts of all
 * figures from far to near, so that they can reach around each other. Figures of lines are drawn before the others. The pixels are those of the crate's
 * draw_together. Returns PANTIN_NO_ROOM for more than PANTIN_SOLID_TOGETHER figures, PANTIN_ERROR_HEAD if there is none, PANTIN_NOT_FOUND if they were set up
 * for displays of different sizes, or some were not set up, and what pantin_solid_draw does. It takes 1.7 KB of stack more. */
pantin_result pantin_solid_draw_together(const pantin_solid *const *figures, size_t count, pantin_format format, void *rows, size_t stride, uint16_t y0,
                                         uint16_t y1, int floor);

/* Draws a figure of lines, in the pose of pantin_figure_pose or pantin_figure_pose_at: the pixels of the crate's FigureRenderer. With `ground` 1 it has a ground. */
pantin_result pantin_figure_draw(const pantin_figure *figure, pantin_format format, void *rows, size_t stride, uint16_t y0, uint16_t y1, int ground);

#ifdef __cplusplus
}
#endif

#endif
