/* A face for LVGL 9: a widget that shows emotes by name, blinks and glances by itself, and speaks.
 *
 *     lv_obj_t *face = lv_pantin_create(lv_screen_active());
 *     lv_obj_set_size(face, 240, 240);
 *     lv_pantin_set_emote(face, "happy");
 *     lv_pantin_push_pcm(face, samples, count);       // what is played now, at most 30 ms of it at a time
 *
 * It takes one picture from LVGL's memory (2 bytes a pixel, 1 on displays of L8 and I1), 16 rows beside it, and about 2.4 KB for the face. Frames
 * allocate nothing; only the part of the picture that changed is drawn again.
 *
 * As everywhere in LVGL, call these functions with LVGL's lock held, or from its own thread.
 */
#ifndef LV_PANTIN_H
#define LV_PANTIN_H

#include "lvgl.h"
#include "pantin_face.h"
#include "pantin_talk.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Milliseconds from picture to picture. */
#ifndef LV_PANTIN_PERIOD
#define LV_PANTIN_PERIOD 33
#endif

/* Rows that are drawn at a time. */
#ifndef LV_PANTIN_ROWS
#define LV_PANTIN_ROWS 16
#endif

/* Channels for which there is memory in a clip of an emote. Ours have at most 7. */
#ifndef LV_PANTIN_CHANNELS
#define LV_PANTIN_CHANNELS 12
#endif

extern const lv_obj_class_t lv_pantin_class;

/* Makes a face of 128 by 128 pixels; lv_obj_set_size takes up to 2047 each way. A size for which there is no memory shows nothing, and LVGL's log says so.
 * The face is the cartoon with our 23 emotes, at rest, which blinks, on a background of its own: black. NULL if LVGL's memory is used up. */
lv_obj_t *lv_pantin_create(lv_obj_t *parent);

/* Shows another model, which `pantin face model` writes. The bytes are not copied. LV_RESULT_INVALID if it is damaged or memory is used up: the face
 * stays as it is. */
lv_result_t lv_pantin_set_src(lv_obj_t *obj, const uint8_t *model, uint32_t length);

/* Lends other emotes, which are not copied. */
lv_result_t lv_pantin_set_emotes(lv_obj_t *obj, const pantin_emote *emotes, uint16_t count);

/* Goes over to an emote. LV_RESULT_INVALID for a name that the list does not have: the face stays as it is, and a warning in LVGL's log lists the names. */
lv_result_t lv_pantin_set_emote(lv_obj_t *obj, const char *name);

/* Sets the rate of the sound that follows, 8,000 to 48,000 Hz: 16,000 without a call. LV_RESULT_INVALID for another. */
lv_result_t lv_pantin_set_rate(lv_obj_t *obj, uint32_t rate);

/* Moves the lips by sound: samples of one channel as they are played. Push at most 30 ms at a time: longer parts make the lips jump. */
void lv_pantin_push_pcm(lv_obj_t *obj, const int16_t *samples, size_t count);

/* Shows a viseme of MPEG-4, 1 to 14, or none, 0, `ms` milliseconds from now, until the next one's time; visemes win over sound. LV_RESULT_INVALID for
 * another number, for a time before that of one that waits, and if PANTIN_TALK_WAITING wait already. */
lv_result_t lv_pantin_set_viseme(lv_obj_t *obj, uint8_t viseme, uint32_t ms);

/* The face and its lips, for all else that pantin_face.h does: pantin_face_look, pantin_face_weight, pantin_face_palette. */
pantin_face *lv_pantin_get_face(lv_obj_t *obj);
pantin_talk *lv_pantin_get_talk(lv_obj_t *obj);

#ifdef __cplusplus
}
#endif

#endif
