/* Faces and bodies for LVGL 9: a widget that shows emotes by name, blinks and glances by itself, and speaks, or plays clips and state machines of a body.
 *
 *     lv_obj_t *face = lv_pantin_create(lv_screen_active());
 *     lv_obj_set_size(face, 240, 240);
 *     lv_pantin_set_emote(face, "happy");
 *     lv_pantin_push_pcm(face, samples, count);       // as it is played
 *
 *     lv_obj_t *body = lv_pantin_create(lv_screen_active());       // with LV_PANTIN_BODY 1
 *     lv_pantin_set_src(body, character, sizeof character);        // a .ptn or .ptb file
 *     lv_pantin_hold(body, "go", true);                            // an input of its state machine
 *
 * It takes one picture from LVGL's memory (2 bytes a pixel, 1 on displays of L8 and I1), 16 rows beside it, and about 2.4 KB for the face; a body takes
 * memory for its clips' channels instead. Frames allocate nothing; only the part of the picture that changed is drawn again.
 *
 * As everywhere in LVGL, call these functions with LVGL's lock held, or from its own thread.
 */
#ifndef LV_PANTIN_H
#define LV_PANTIN_H

#include "lvgl.h"
#include "pantin_face.h"
#include "pantin_talk.h"

/* Milliseconds from picture to picture. */
#ifndef LV_PANTIN_PERIOD
#define LV_PANTIN_PERIOD 33
#endif

/* Rows that are drawn at a time. */
#ifndef LV_PANTIN_ROWS
#define LV_PANTIN_ROWS 16
#endif

/* 1: the widget shows bodies, too. Then compile lv_pantin_body.c, and pantin_turn.c, pantin_figure.c, pantin_solid.c, pantin_animator.c and pantin_feet.c.
 * Define it in lv_conf.h or for the whole build. */
#ifndef LV_PANTIN_BODY
#define LV_PANTIN_BODY 0
#endif

/* Channels for which there is memory in a clip of an emote. Ours have at most 7. */
#ifndef LV_PANTIN_CHANNELS
#define LV_PANTIN_CHANNELS 12
#endif

#if LV_PANTIN_BODY
#include "pantin_animator.h"
#endif

#ifdef __cplusplus
extern "C" {
#endif

extern const lv_obj_class_t lv_pantin_class;

/* Makes a face of 128 by 128 pixels; lv_obj_set_size takes up to 2047 each way. A size for which there is no memory shows nothing, and LVGL's log says so:
 * LVGL's default LV_MEM_SIZE, 64 KB, is too small for 240 by 240 pixels of RGB565.
 * The face is the cartoon with our 23 emotes, at rest, which blinks, on a background of its own: black. NULL if LVGL's memory is used up. */
lv_obj_t *lv_pantin_create(lv_obj_t *parent);

/* Shows another face, a model that `pantin face model` writes, NULL for the cartoon, or, with LV_PANTIN_BODY, a body: a clip (.ptn), a bank (.ptb),
 * whose first clip plays, or a bank with a state machine. The bytes are not copied. LV_RESULT_INVALID if they are damaged or memory is used up: the
 * widget stays as it is. Functions for faces do nothing while a body is shown, and those for bodies nothing while a face is; they return
 * LV_RESULT_INVALID. */
lv_result_t lv_pantin_set_src(lv_obj_t *obj, const uint8_t *bytes, uint32_t length);

/* Lends other emotes, which are not copied. */
lv_result_t lv_pantin_set_emotes(lv_obj_t *obj, const pantin_emote *emotes, uint16_t count);

/* Goes over to an emote. LV_RESULT_INVALID for a name that the list does not have: the face stays as it is, and a warning in LVGL's log lists the names. */
lv_result_t lv_pantin_set_emote(lv_obj_t *obj, const char *name);

/* Sets the rate of the sound that follows, 8,000 to 48,000 Hz: 16,000 without a call. LV_RESULT_INVALID for another. */
lv_result_t lv_pantin_set_rate(lv_obj_t *obj, uint32_t rate);

/* Moves the lips by sound: samples of one channel as they are played, at least every LV_PANTIN_PERIOD. With a rate that is not the sound's own they move
 * wrongly. */
void lv_pantin_push_pcm(lv_obj_t *obj, const int16_t *samples, size_t count);

/* Shows a viseme of MPEG-4, 1 to 14, or none, 0, `ms` milliseconds from now, until the next one's time; visemes win over sound. LV_RESULT_INVALID for
 * another number, for a time before that of one that waits, and if PANTIN_TALK_WAITING wait already. */
lv_result_t lv_pantin_set_viseme(lv_obj_t *obj, uint8_t viseme, uint32_t ms);

/* The face and its lips, for all else that pantin_face.h does: pantin_face_look, pantin_face_weight, pantin_face_palette. */
pantin_face *lv_pantin_get_face(lv_obj_t *obj);
pantin_talk *lv_pantin_get_talk(lv_obj_t *obj);

#if LV_PANTIN_BODY

/* ---- Bodies. The widget sends LV_EVENT_VALUE_CHANGED when the state machine enters a state, and LV_EVENT_READY at the end of a clip that is no loop. ---- */

/* Fires an input of the state machine, which its next step alone sees; holds it down or lets it go; sets a parameter, within its range.
 * LV_RESULT_INVALID for a name that the machine does not have. */
lv_result_t lv_pantin_fire(lv_obj_t *obj, const char *input);
lv_result_t lv_pantin_hold(lv_obj_t *obj, const char *input, bool down);
lv_result_t lv_pantin_set_parameter(lv_obj_t *obj, const char *parameter, int16_t value);

/* Goes over to a clip of a bank that has no state machine; NULL starts the clip again. LV_RESULT_INVALID for a name that the bank does not have, and
 * while a state machine plays. */
lv_result_t lv_pantin_play(lv_obj_t *obj, const char *clip);

/* Draws bodies as lines, or as bodies with volume (false, without a call); with ground or floor and shadow (true, without a call). */
void lv_pantin_set_lines(lv_obj_t *obj, bool lines);
void lv_pantin_set_floor(lv_obj_t *obj, bool floor);

/* Looks from another side: degrees about the vertical (0 looks the figure in the face) and above the horizon. `fixed`: the camera does not follow the
 * hips. These and the next one hold for the bodies that follow, too. LV_RESULT_INVALID if memory is used up. */
lv_result_t lv_pantin_set_view(lv_obj_t *obj, int16_t orbit, int16_t tilt, bool fixed);

/* Changes colours, radii and attachments: a character that `pantin expand FILE.look` writes, which is not copied; NULL is the default one.
 * LV_RESULT_INVALID for bytes that are none. */
lv_result_t lv_pantin_set_look(lv_obj_t *obj, const uint8_t *look, uint32_t length);

/* The state machine, for all else that pantin_animator.h does: NULL for a face. Without a state machine its animator plays alone. */
pantin_character *lv_pantin_get_character(lv_obj_t *obj);

#endif

#ifdef __cplusplus
}
#endif

#endif
