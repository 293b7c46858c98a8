/* The body of lv_pantin: a clip, or a bank with or without a state machine, and what draws it. Programs use lv_pantin.h. */
#ifndef LV_PANTIN_BODY_H
#define LV_PANTIN_BODY_H

#include "lv_pantin.h"

#if LV_PANTIN_BODY

#include "pantin_feet.h"
#include "pantin_solid.h"

/* What a program sets, for the body that is shown and those that follow. */
typedef struct {
    const uint8_t *look;
    uint32_t look_length;
    pantin_view view;
    uint8_t lines, floor;
} lv_pantin_settings;

typedef struct {
    pantin_source source;
    pantin_bank bank;               /* of one without a state machine; source is NULL for a single clip */
    pantin_clip clip;               /* that for which the camera is set up */
    pantin_character character;     /* without a state machine: its animator alone */
    pantin_animator_memory memory;
    pantin_solid solid;
    uint8_t *parts;                 /* memory for second clips, layers and feet of a state machine, or NULL */
    uint8_t machine;                /* 1: a state machine plays */
    uint8_t entered, ended;         /* 1 if the last step entered a state, or reached the end of a clip that is no loop */
} lv_pantin_body_t;

/* Opens a clip or a bank: NULL if it is damaged or memory is used up. The bytes are not copied. */
lv_pantin_body_t *lv_pantin_body_open(const uint8_t *bytes, uint32_t length);
void lv_pantin_body_close(lv_pantin_body_t *body);

/* Sets the figure up for a size, the view and the look. */
pantin_result lv_pantin_body_size(lv_pantin_body_t *body, const lv_pantin_settings *settings, uint16_t width, uint16_t height);

bool lv_pantin_body_has_size(const lv_pantin_body_t *body, uint16_t width, uint16_t height);

/* Plays a clip of a bank without a state machine; NULL plays the clip again. */
pantin_result lv_pantin_body_play(lv_pantin_body_t *body, const lv_pantin_settings *settings, const char *name);

pantin_result lv_pantin_body_step(lv_pantin_body_t *body, uint16_t ms);

/* Takes the pose that is due, for the rows that follow. */
void lv_pantin_body_pose(lv_pantin_body_t *body, const lv_pantin_settings *settings);
pantin_result lv_pantin_body_draw(const lv_pantin_body_t *body, const lv_pantin_settings *settings, pantin_format format, void *rows, uint32_t stride,
                                  uint16_t y0, uint16_t y1);

#endif

#endif
