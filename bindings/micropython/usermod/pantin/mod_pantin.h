/* What the files of the module share. */
#ifndef MOD_PANTIN_H
#define MOD_PANTIN_H

#include "py/obj.h"
#include "py/objarray.h"
#include "py/runtime.h"

#include "pantin.h"
#include "pantin_format.h"

/* A clip that plays. MicroPython's collector moves nothing, so structures may refer to each other; `data` and `owner` keep what they refer to. */
typedef struct mod_clip {
    mp_obj_base_t base;
    mp_obj_t data;  /* the bytes */
    mp_obj_t owner; /* the bank or the rig that it came with, or None */
    mp_obj_t drawn; /* the figure of the last call of draw(), or None */
    mp_obj_t shot;  /* the arguments that it was made with */
    pantin_source source;
    pantin_clip clip;
    pantin_player player;
    int32_t *pose;
    pantin_channel *moving;
    uint32_t version; /* counts changes of the pose */
} mod_clip;

extern const mp_obj_type_t mod_clip_type, mod_figure_type, mod_face_type;

/* Raises what a result means, unless it is PANTIN_OK. */
void mod_check(pantin_result result);

/* The bytes of any object with a buffer. */
mp_buffer_info_t mod_bytes(mp_obj_t object);

/* A name as a string of C. Raises KeyError for a string with a 0 in it, which is no name. */
const char *mod_name(mp_obj_t text);

/* Raises KeyError: no `what` has this name. */
void mod_missing(const char *what, mp_obj_t name);

/* A number in Q15, of one that is at most 2 either way. */
int32_t mod_q15(mp_obj_t number);

/* Where rows are drawn to, of draw(buffer, format, y0, y1, stride). */
typedef struct mod_rows {
    pantin_format format;
    void *bytes;
    size_t stride;
    uint16_t y0, y1;
} mod_rows;

/* Reads the arguments; raises ValueError for a buffer that the rows do not fit in. */
mod_rows mod_rows_of(const mp_arg_val_t *arguments, uint16_t width, uint16_t height);

/* The first arguments of a function that draws rows. */
#define MOD_ROWS \
    {MP_QSTR_buffer, MP_ARG_REQUIRED | MP_ARG_OBJ, {.u_rom_obj = MP_ROM_NONE}}, \
    {MP_QSTR_format, MP_ARG_INT, {.u_int = PANTIN_RGB565}}, \
    {MP_QSTR_y0, MP_ARG_INT, {.u_int = 0}}, \
    {MP_QSTR_y1, MP_ARG_INT, {.u_int = -1}}, \
    {MP_QSTR_stride, MP_ARG_INT, {.u_int = -1}}
enum { MOD_ROWS_COUNT = 5 };

/* The lines of a clip's figure through a display's own `line`, of Clip.draw. */
void mod_draw_lines(mod_clip *clip, size_t count, const mp_obj_t *arguments, mp_map_t *named);

#endif
