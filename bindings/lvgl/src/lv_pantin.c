/* Faces and bodies for LVGL 9: see lv_pantin.h. */
#include "lv_pantin.h"

#include <string.h>

#include "lv_pantin_body.h"
#include "pantin_face_data.h"
/* A class that extends another needs the size of its structure. */
#include "src/core/lv_obj_class_private.h"
#include "src/misc/cache/instance/lv_image_cache.h"
#include "src/widgets/canvas/lv_canvas_private.h"

typedef struct {
    lv_canvas_t canvas;
    pantin_face face;
    pantin_talk talk;
    uint32_t *memory;       /* lent to the face; NULL while a body is shown */
#if LV_PANTIN_BODY
    lv_pantin_body_t *body;
    lv_pantin_settings settings;
#endif
    lv_draw_buf_t *picture;
    lv_draw_buf_t *rows;    /* LV_PANTIN_ROWS rows, as they are now */
    lv_timer_t *timer;
    uint32_t shown;         /* the tick of the last picture */
} lv_pantin_t;

static void constructor(const lv_obj_class_t *class_p, lv_obj_t *obj);
static void destructor(const lv_obj_class_t *class_p, lv_obj_t *obj);
static void event(const lv_obj_class_t *class_p, lv_event_t *e);
static void pass(lv_timer_t *timer);

const lv_obj_class_t lv_pantin_class = {
    .base_class = &lv_canvas_class,
    .constructor_cb = constructor,
    .destructor_cb = destructor,
    .event_cb = event,
    .width_def = 128,
    .height_def = 128,
    .instance_size = sizeof(lv_pantin_t),
    .name = "lv_pantin",
};

lv_obj_t *lv_pantin_create(lv_obj_t *parent) {
    lv_obj_t *obj = lv_obj_class_create_obj(&lv_pantin_class, parent);
    if (!obj) return NULL;
    lv_obj_class_init_obj(obj);
    if (!((lv_pantin_t *)obj)->memory || !((lv_pantin_t *)obj)->timer) {
        lv_obj_delete(obj);
        return NULL;
    }
    return obj;
}

/* ---- The picture ---- */

/* The longest side of a picture. */
#define MOST_PIXELS 2047

static pantin_face_format format_of(const lv_draw_buf_t *picture) {
    return picture->header.cf == LV_COLOR_FORMAT_L8 ? PANTIN_L8 : PANTIN_RGB565;
}

static void release(lv_pantin_t *p) {
    if (p->picture) {
        lv_image_cache_drop(p->picture);
        lv_draw_buf_destroy(p->picture);
    }
    if (p->rows) lv_draw_buf_destroy(p->rows);
    p->picture = p->rows = NULL;
}

#if LV_PANTIN_BODY
static bool shows(const lv_pantin_t *p) { return p->memory || p->body; }

static pantin_result set_size(lv_pantin_t *p, uint16_t width, uint16_t height) {
    if (!p->body) return pantin_face_size(&p->face, width, height);
    return lv_pantin_body_has_size(p->body, width, height) ? PANTIN_OK : lv_pantin_body_size(p->body, &p->settings, width, height);
}

static pantin_result draw_rows(lv_pantin_t *p, uint16_t y0, uint16_t y1) {
    const lv_draw_buf_t *rows = p->rows;
    if (p->body && y0 == 0) lv_pantin_body_pose(p->body, &p->settings);
    return p->body ? lv_pantin_body_draw(p->body, &p->settings, format_of(rows), rows->data, rows->header.stride, y0, y1)
                   : pantin_face_draw(&p->face, format_of(rows), rows->data, rows->header.stride, y0, y1);
}
#else
static bool shows(const lv_pantin_t *p) { return p->memory != NULL; }

static pantin_result set_size(lv_pantin_t *p, uint16_t width, uint16_t height) { return pantin_face_size(&p->face, width, height); }

static pantin_result draw_rows(lv_pantin_t *p, uint16_t y0, uint16_t y1) {
    return pantin_face_draw(&p->face, format_of(p->rows), p->rows->data, p->rows->header.stride, y0, y1);
}
#endif

/* Draws the picture into `rows`, a part at a time, and copies what differs. */
static void draw(lv_pantin_t *p) {
    lv_obj_t *obj = (lv_obj_t *)p;
    lv_area_t changed;
    uint32_t height = p->picture->header.h, stride = p->picture->header.stride;
    uint32_t bytes = format_of(p->picture) == PANTIN_L8 ? 1 : 2;
    uint32_t length = p->picture->header.w * bytes;
    uint32_t first = length, last = 0, top = height, bottom = 0, y, row;
    for (y = 0; y < height; y += LV_PANTIN_ROWS) {
        uint32_t end = LV_MIN(y + LV_PANTIN_ROWS, height);
        if (draw_rows(p, (uint16_t)y, (uint16_t)end) != PANTIN_OK) return;
        for (row = y; row < end; row++) {
            const uint8_t *now = p->rows->data + (row - y) * stride;
            uint8_t *before = p->picture->data + row * stride;
            uint32_t from = 0, to = length;
            if (memcmp(now, before, length) == 0) continue;
            while (now[from] == before[from]) from++;
            while (now[to - 1] == before[to - 1]) to--;
            memcpy(before + from, now + from, to - from);
            first = LV_MIN(first, from);
            last = LV_MAX(last, to);
            top = LV_MIN(top, row);
            bottom = row;
        }
    }
    if (top == height) return;
    lv_draw_buf_flush_cache(p->picture, NULL);
    lv_image_cache_drop(p->picture);
    lv_obj_get_content_coords(obj, &changed);
    changed.x2 = changed.x1 + (int32_t)((last - 1) / bytes);
    changed.x1 += (int32_t)(first / bytes);
    changed.y2 = changed.y1 + (int32_t)bottom;
    changed.y1 += (int32_t)top;
    lv_obj_invalidate_area(obj, &changed);
}

/* Shows nothing. */
static void take_away(lv_pantin_t *p) {
    release(p);
    p->canvas.draw_buf = NULL;
    lv_image_set_src((lv_obj_t *)p, NULL);
}

/* Makes a picture of the size that the object's content has. */
static void resize(lv_pantin_t *p) {
    lv_obj_t *obj = (lv_obj_t *)p;
    int32_t width = LV_MIN(lv_obj_get_content_width(obj), MOST_PIXELS), height = LV_MIN(lv_obj_get_content_height(obj), MOST_PIXELS);
    lv_color_format_t display = lv_display_get_color_format(lv_obj_get_display(obj));
    lv_color_format_t format = display == LV_COLOR_FORMAT_L8 || display == LV_COLOR_FORMAT_I1 ? LV_COLOR_FORMAT_L8 : LV_COLOR_FORMAT_RGB565;
    if (!shows(p)) return;
    if (width < 1 || height < 1) {
        if (p->picture) take_away(p);
        return;
    }
    if (p->picture && p->picture->header.w == width && p->picture->header.h == height && p->picture->header.cf == format) return;
    release(p);
    if (set_size(p, (uint16_t)width, (uint16_t)height) == PANTIN_OK) {
        p->picture = lv_draw_buf_create((uint32_t)width, (uint32_t)height, format, LV_STRIDE_AUTO);
        p->rows = lv_draw_buf_create((uint32_t)width, LV_PANTIN_ROWS, format, LV_STRIDE_AUTO);
    }
    if (!p->picture || !p->rows) {
        LV_LOG_ERROR("lv_pantin: no memory for a picture of %d by %d", (int)width, (int)height);
        take_away(p);
        return;
    }
    lv_draw_buf_clear(p->picture, NULL);
    lv_canvas_set_draw_buf(obj, p->picture);
    draw(p);
}

/* Shows another source in the picture that is there: a heap in parts may have no room for a second one. */
static void show(lv_pantin_t *p) {
    if (p->picture && set_size(p, p->picture->header.w, p->picture->header.h) == PANTIN_OK) {
        draw(p);
    } else {
        release(p);
    }
    resize(p);
}

/* ---- The object ---- */

/* Opens a model in memory of its own: NULL if it is damaged or there is no memory. */
static uint32_t *open_model(pantin_face *face, const uint8_t *model, uint32_t length) {
    uint32_t size;
    uint32_t *memory;
    if (pantin_face_open(face, model, length, NULL, 0) != PANTIN_NO_ROOM) return NULL;
    size = face->needed + LV_PANTIN_CHANNELS * 36;
    memory = (uint32_t *)lv_malloc(size);
    if (memory && pantin_face_open(face, model, length, memory, size) != PANTIN_OK) {
        lv_free(memory);
        return NULL;
    }
    return memory;
}

static void constructor(const lv_obj_class_t *class_p, lv_obj_t *obj) {
    lv_pantin_t *p = (lv_pantin_t *)obj;
    LV_UNUSED(class_p);
#if LV_PANTIN_BODY
    p->settings.view = pantin_default_view;
    p->settings.floor = 1;
#endif
    p->memory = open_model(&p->face, pantin_cartoon, sizeof pantin_cartoon);
    p->shown = lv_tick_get();
    p->timer = lv_timer_create(pass, LV_PANTIN_PERIOD, obj);
    if (!p->memory) return;
    pantin_talk_open(&p->talk, 16000);
    pantin_face_emotes(&p->face, pantin_emotes, PANTIN_EMOTES);
    /* Each face blinks at other times. */
    pantin_face_live(&p->face, (uint32_t)(uintptr_t)obj | 1);
}

static void destructor(const lv_obj_class_t *class_p, lv_obj_t *obj) {
    lv_pantin_t *p = (lv_pantin_t *)obj;
    LV_UNUSED(class_p);
    if (p->timer) lv_timer_delete(p->timer);
    release(p);
    p->canvas.draw_buf = NULL;
    lv_free(p->memory);
#if LV_PANTIN_BODY
    lv_pantin_body_close(p->body);
#endif
}

static void event(const lv_obj_class_t *class_p, lv_event_t *e) {
    LV_UNUSED(class_p);
    if (lv_obj_event_base(&lv_pantin_class, e) != LV_RESULT_OK) return;
    if (lv_event_get_code(e) == LV_EVENT_SIZE_CHANGED || lv_event_get_code(e) == LV_EVENT_STYLE_CHANGED) {
        resize((lv_pantin_t *)lv_event_get_current_target(e));
    }
}

/* Lets time pass for lips and face. */
static void step_face(lv_pantin_t *p, uint16_t ms) {
    uint8_t viseme;
    pantin_talk_step(&p->talk, ms);
    for (viseme = 1; viseme <= PANTIN_TALK_VISEMES; viseme++) {
        pantin_face_viseme(&p->face, viseme, p->talk.weights[viseme - 1]);
    }
    pantin_face_speaking(&p->face, p->talk.speaking);
    pantin_face_step(&p->face, ms);
}

#if LV_PANTIN_BODY
/* Lets time pass for what is shown. False if an event that this sends deleted the object. */
static bool step(lv_pantin_t *p, uint16_t ms) {
    lv_obj_t *obj = (lv_obj_t *)p;
    bool entered, ended;
    if (!p->body) {
        step_face(p, ms);
        return true;
    }
    lv_pantin_body_step(p->body, ms);
    entered = p->body->entered;
    ended = p->body->ended;
    if (entered && lv_obj_send_event(obj, LV_EVENT_VALUE_CHANGED, NULL) == LV_RESULT_INVALID) return false;
    return !ended || lv_obj_send_event(obj, LV_EVENT_READY, NULL) != LV_RESULT_INVALID;
}
#else
static bool step(lv_pantin_t *p, uint16_t ms) {
    step_face(p, ms);
    return true;
}
#endif

/* The next picture. Time passes while the object is not seen, but nothing is drawn. */
static void pass(lv_timer_t *timer) {
    lv_obj_t *obj = (lv_obj_t *)lv_timer_get_user_data(timer);
    lv_pantin_t *p = (lv_pantin_t *)obj;
    uint32_t elapsed = lv_tick_elaps(p->shown);
    p->shown += elapsed;
    if (step(p, (uint16_t)LV_MIN(elapsed, 65535u)) && p->picture && lv_obj_is_visible(obj)) draw(p);
}

/* Shows the face that was opened, with the emotes of the face before. */
static void set_face(lv_pantin_t *p, pantin_face *face, uint32_t *memory) {
    const pantin_emote *emotes = p->face.emotes;
    pantin_face_emotes(face, emotes ? emotes : pantin_emotes, emotes ? p->face.emote_count : PANTIN_EMOTES);
    pantin_face_live(face, (uint32_t)(uintptr_t)p | 1);
    lv_free(p->memory);
    p->memory = memory;
    p->face = *face;
}

#if LV_PANTIN_BODY
/* Sets the figure of a body up for the size of the widget. */
static bool set_up(lv_pantin_t *p, lv_pantin_body_t *body) {
    int32_t width = lv_obj_get_content_width((lv_obj_t *)p), height = lv_obj_get_content_height((lv_obj_t *)p);
    return lv_pantin_body_size(body, &p->settings, (uint16_t)LV_CLAMP(1, width, 2047), (uint16_t)LV_CLAMP(1, height, 2047)) == PANTIN_OK;
}
#endif

lv_result_t lv_pantin_set_src(lv_obj_t *obj, const uint8_t *bytes, uint32_t length) {
    lv_pantin_t *p = (lv_pantin_t *)obj;
    pantin_face face;
    uint32_t *memory = bytes ? open_model(&face, bytes, length) : open_model(&face, pantin_cartoon, sizeof pantin_cartoon);
#if LV_PANTIN_BODY
    lv_pantin_body_t *body = memory ? NULL : lv_pantin_body_open(bytes, length);
    if (body && !set_up(p, body)) {
        lv_pantin_body_close(body);
        body = NULL;
    }
    if (body) {
        lv_free(p->memory);
        p->memory = NULL;
        lv_memzero(&p->face, sizeof p->face);
    }
    if (memory || body) {
        lv_pantin_body_close(p->body);
        p->body = body;
    }
    if (body) {
        show(p);
        return LV_RESULT_OK;
    }
#endif
    if (!memory) {
        LV_LOG_WARN("lv_pantin: this is damaged or nothing that the widget shows, or there is no memory for it");
        return LV_RESULT_INVALID;
    }
    set_face(p, &face, memory);
    show(p);
    return LV_RESULT_OK;
}

lv_result_t lv_pantin_set_emotes(lv_obj_t *obj, const pantin_emote *emotes, uint16_t count) {
    return pantin_face_emotes(&((lv_pantin_t *)obj)->face, emotes, count) == PANTIN_OK ? LV_RESULT_OK : LV_RESULT_INVALID;
}

lv_result_t lv_pantin_set_emote(lv_obj_t *obj, const char *name) {
    pantin_face *face = &((lv_pantin_t *)obj)->face;
    pantin_result result = pantin_face_emote(face, name);
    uint16_t i;
    if (result == PANTIN_OK) return LV_RESULT_OK;
    if (result == PANTIN_ERROR_HEAD) {
        LV_LOG_WARN("lv_pantin: a body has no emotes");
        return LV_RESULT_INVALID;
    }
    if (result != PANTIN_NOT_FOUND) {
        LV_LOG_WARN("lv_pantin: the emote %s is damaged, or has more than LV_PANTIN_CHANNELS channels", name);
        return LV_RESULT_INVALID;
    }
    LV_LOG_WARN("lv_pantin: there is no emote %s; there are:", name ? name : "NULL");
    for (i = 0; i < face->emote_count; i++) LV_LOG_WARN("  %s", face->emotes[i].name);
    return LV_RESULT_INVALID;
}

lv_result_t lv_pantin_set_rate(lv_obj_t *obj, uint32_t rate) {
    lv_pantin_t *p = (lv_pantin_t *)obj;
    pantin_talk talk;
    if (pantin_talk_open(&talk, rate) != PANTIN_OK) {
        LV_LOG_WARN("lv_pantin: sound has 8,000 to 48,000 Hz, not %u", (unsigned)rate);
        return LV_RESULT_INVALID;
    }
    p->talk = talk;
    return LV_RESULT_OK;
}

void lv_pantin_push_pcm(lv_obj_t *obj, const int16_t *samples, size_t count) {
    pantin_talk_push(&((lv_pantin_t *)obj)->talk, samples, count);
}

lv_result_t lv_pantin_set_viseme(lv_obj_t *obj, uint8_t viseme, uint32_t ms) {
    pantin_talk *talk = &((lv_pantin_t *)obj)->talk;
    if (!((lv_pantin_t *)obj)->memory) return LV_RESULT_INVALID;
    return pantin_talk_viseme(talk, viseme, talk->now + ms) == PANTIN_OK ? LV_RESULT_OK : LV_RESULT_INVALID;
}

pantin_face *lv_pantin_get_face(lv_obj_t *obj) { return &((lv_pantin_t *)obj)->face; }

pantin_talk *lv_pantin_get_talk(lv_obj_t *obj) { return &((lv_pantin_t *)obj)->talk; }

/* ---- Bodies ---- */

#if LV_PANTIN_BODY

/* What a machine's index of a name is for a body that has one; a warning otherwise. */
static pantin_character *machine_with(lv_obj_t *obj, const char *name, uint8_t (*find)(const pantin_character *, const char *), uint8_t *index) {
    lv_pantin_body_t *body = ((lv_pantin_t *)obj)->body;
    *index = body && body->machine ? find(&body->character, name) : PANTIN_NO_INPUT;
    if (*index != PANTIN_NO_INPUT) return &body->character;
    LV_LOG_WARN("lv_pantin: the state machine has no %s, or there is none", name ? name : "NULL");
    return NULL;
}

lv_result_t lv_pantin_fire(lv_obj_t *obj, const char *input) {
    uint8_t index;
    pantin_character *character = machine_with(obj, input, pantin_character_input, &index);
    if (character) pantin_character_fire(character, index);
    return character ? LV_RESULT_OK : LV_RESULT_INVALID;
}

lv_result_t lv_pantin_hold(lv_obj_t *obj, const char *input, bool down) {
    uint8_t index;
    pantin_character *character = machine_with(obj, input, pantin_character_input, &index);
    if (character) pantin_character_hold(character, index, down);
    return character ? LV_RESULT_OK : LV_RESULT_INVALID;
}

lv_result_t lv_pantin_set_parameter(lv_obj_t *obj, const char *parameter, int16_t value) {
    uint8_t index;
    pantin_character *character = machine_with(obj, parameter, pantin_character_parameter, &index);
    if (character) pantin_character_set(character, index, value);
    return character ? LV_RESULT_OK : LV_RESULT_INVALID;
}

lv_result_t lv_pantin_play(lv_obj_t *obj, const char *clip) {
    lv_pantin_t *p = (lv_pantin_t *)obj;
    if (p->body && lv_pantin_body_play(p->body, &p->settings, clip) == PANTIN_OK) return LV_RESULT_OK;
    LV_LOG_WARN("lv_pantin: there is no clip %s to play, or a state machine plays", clip ? clip : "NULL");
    return LV_RESULT_INVALID;
}

void lv_pantin_set_lines(lv_obj_t *obj, bool lines) { ((lv_pantin_t *)obj)->settings.lines = lines; }

void lv_pantin_set_floor(lv_obj_t *obj, bool floor) { ((lv_pantin_t *)obj)->settings.floor = floor; }

/* Sets the camera up again with other settings, or keeps those of before. */
static lv_result_t change(lv_pantin_t *p, const lv_pantin_settings *settings) {
    lv_pantin_settings before = p->settings;
    p->settings = *settings;
    if (!p->body || set_up(p, p->body)) return LV_RESULT_OK;
    p->settings = before;
    return LV_RESULT_INVALID;
}

lv_result_t lv_pantin_set_view(lv_obj_t *obj, int16_t orbit, int16_t tilt, bool fixed) {
    lv_pantin_settings settings = ((lv_pantin_t *)obj)->settings;
    settings.view.orbit = orbit;
    settings.view.tilt = tilt;
    settings.view.fixed = fixed;
    return change((lv_pantin_t *)obj, &settings);
}

lv_result_t lv_pantin_set_look(lv_obj_t *obj, const uint8_t *look, uint32_t length) {
    lv_pantin_settings settings = ((lv_pantin_t *)obj)->settings;
    pantin_solid solid;
    lv_memzero(&solid, sizeof solid);
    if (pantin_solid_look(&solid, look, length) != PANTIN_OK) {
        LV_LOG_WARN("lv_pantin: these bytes are no character");
        return LV_RESULT_INVALID;
    }
    settings.look = look;
    settings.look_length = length;
    return change((lv_pantin_t *)obj, &settings);
}

pantin_character *lv_pantin_get_character(lv_obj_t *obj) {
    lv_pantin_body_t *body = ((lv_pantin_t *)obj)->body;
    return body ? &body->character : NULL;
}

#endif
