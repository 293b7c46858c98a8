/* Faces of the module `pantin`: emotes by name, eyes, and lips that follow sound or visemes. */
#include "mod_pantin.h"
#include "pantin_face.h"
#include "pantin_face_data.h"
#include "pantin_face_themes.h"
#include "pantin_talk.h"

typedef struct mod_face {
    mp_obj_base_t base;
    mp_obj_t model, clip; /* keep the bytes */
    uint32_t *memory;
    uint16_t palette[16];
    bool speaks; /* once sound or a viseme came: its weights are then those of the lips */
    pantin_face face;
    pantin_talk talk;
} mod_face;

static mod_face *of(mp_obj_t self) { return MP_OBJ_TO_PTR(self); }

/* The bytes of a model: one of ours by its name, or any in a buffer. */
static mp_buffer_info_t model_of(mp_obj_t model) {
    mp_buffer_info_t bytes;
    if (!mp_obj_is_str(model)) return mod_bytes(model);
    memset(&bytes, 0, sizeof bytes);
    switch (mp_obj_str_get_qstr(model)) {
        case MP_QSTR_cartoon:
            bytes.buf = (void *)(uintptr_t)pantin_cartoon;
            bytes.len = sizeof pantin_cartoon;
            break;
        case MP_QSTR_eyes:
            bytes.buf = (void *)(uintptr_t)pantin_eyes;
            bytes.len = sizeof pantin_eyes;
            break;
        case MP_QSTR_minimal:
            bytes.buf = (void *)(uintptr_t)pantin_minimal;
            bytes.len = sizeof pantin_minimal;
            break;
        default: mod_missing("model", model);
    }
    return bytes;
}

static mp_obj_t face_make(const mp_obj_type_t *type, size_t count, size_t named, const mp_obj_t *all) {
    static const mp_arg_t allowed[] = {
        {MP_QSTR_width, MP_ARG_REQUIRED | MP_ARG_INT, {.u_int = 0}},
        {MP_QSTR_height, MP_ARG_REQUIRED | MP_ARG_INT, {.u_int = 0}},
        {MP_QSTR_model, MP_ARG_OBJ, {.u_rom_obj = MP_ROM_QSTR(MP_QSTR_cartoon)}},
        {MP_QSTR_channels, MP_ARG_KW_ONLY | MP_ARG_INT, {.u_int = 12}},
    };
    mp_arg_val_t arguments[MP_ARRAY_SIZE(allowed)];
    mod_face *self;
    mp_buffer_info_t bytes;
    uint32_t size;
    mp_arg_parse_all_kw_array(count, named, all, MP_ARRAY_SIZE(allowed), allowed, arguments);
    if ((arguments[0].u_int | arguments[1].u_int) >> 11) mp_raise_ValueError(MP_ERROR_TEXT("a face has 1 to 2047 pixels each way"));
    if (arguments[3].u_int < 0 || arguments[3].u_int > PANTIN_MAX_CHANNELS) mp_raise_ValueError(MP_ERROR_TEXT("channels"));
    bytes = model_of(arguments[2].u_obj);
    self = mp_obj_malloc(mod_face, type);
    memset((char *)self + sizeof self->base, 0, sizeof *self - sizeof self->base);
    self->model = arguments[2].u_obj;
    self->clip = mp_const_none;
    if (pantin_face_open(&self->face, bytes.buf, (uint32_t)bytes.len, &size, 0) == PANTIN_NO_ROOM) {
        /* As PANTIN_FACE_WORDS: 36 bytes for each channel of a clip, and what the alignment takes; a face keeps pointers, which may have 8 bytes. */
        size = self->face.needed / 4 + ((uint32_t)arguments[3].u_int * 36 + 3) / 4 + 4;
        self->memory = m_new0(uint32_t, size);
        mod_check(pantin_face_open(&self->face, bytes.buf, (uint32_t)bytes.len, self->memory, size * sizeof *self->memory));
    } else {
        mod_check(pantin_face_open(&self->face, bytes.buf, (uint32_t)bytes.len, &size, 0));
    }
    mod_check(pantin_face_size(&self->face, (uint16_t)arguments[0].u_int, (uint16_t)arguments[1].u_int));
    mod_check(pantin_face_emotes(&self->face, pantin_emotes, PANTIN_EMOTES));
    return MP_OBJ_FROM_PTR(self);
}

static mp_obj_t face_emote(mp_obj_t self, mp_obj_t name) {
    pantin_result result = pantin_face_emote(&of(self)->face, mod_name(name));
    if (result == PANTIN_NOT_FOUND) mod_missing("emote", name);
    mod_check(result);
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_emote_object, face_emote);

/* Plays a clip of one's own, whose bytes are kept. */
static mp_obj_t face_play(mp_obj_t self_in, mp_obj_t data) {
    mod_face *self = of(self_in);
    mp_buffer_info_t bytes = mod_bytes(data);
    pantin_result result = pantin_face_play(&self->face, bytes.buf, (uint32_t)bytes.len);
    if (result == PANTIN_NO_ROOM) mp_raise_ValueError(MP_ERROR_TEXT("the clip has more channels than Face(channels=) has room for"));
    if (result == PANTIN_NOT_FOUND) mp_raise_ValueError(MP_ERROR_TEXT("no scalar of the clip drives the face"));
    mod_check(result);
    self->clip = data;
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_play_object, face_play);

static mp_obj_t face_step(mp_obj_t self_in, mp_obj_t ms_in) {
    mod_face *self = of(self_in);
    mp_int_t ms = mp_obj_get_int(ms_in);
    /* A pause that was longer than a minute shows no more than one of a minute. */
    uint16_t passed = (uint16_t)(ms < 0 ? 0 : ms > 60000 ? 60000 : ms);
    if (self->speaks) {
        uint8_t viseme;
        pantin_talk_step(&self->talk, passed);
        for (viseme = 1; viseme <= PANTIN_TALK_VISEMES; viseme++) pantin_face_viseme(&self->face, viseme, self->talk.weights[viseme - 1]);
        pantin_face_speaking(&self->face, self->talk.speaking);
    }
    mod_check(pantin_face_step(&self->face, passed));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_step_object, face_step);

static void listen(mod_face *self, mp_int_t rate) {
    if (self->speaks && (!rate || self->talk.rate == (uint32_t)rate)) return;
    if (pantin_talk_open(&self->talk, rate ? (uint32_t)rate : 16000) != PANTIN_OK) {
        mp_raise_ValueError(MP_ERROR_TEXT("sound has 8000 to 48000 samples a second"));
    }
    self->speaks = true;
}

/* Moves the lips by samples of 16 bits: before each step, all that were played or recorded since the last one. */
static mp_obj_t face_sound(size_t count, const mp_obj_t *arguments) {
    mod_face *self = of(arguments[0]);
    mp_buffer_info_t samples = mod_bytes(arguments[1]);
    if ((uintptr_t)samples.buf & 1) mp_raise_ValueError(MP_ERROR_TEXT("samples begin at even addresses"));
    listen(self, count > 2 ? mp_obj_get_int(arguments[2]) : 16000);
    pantin_talk_push(&self->talk, samples.buf, samples.len / 2);
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_VAR_BETWEEN(face_sound_object, 2, 3, face_sound);

/* Shows one of MPEG-4's visemes, or none, from some milliseconds on. */
static mp_obj_t face_viseme(size_t count, const mp_obj_t *arguments) {
    mod_face *self = of(arguments[0]);
    mp_int_t viseme = mp_obj_get_int(arguments[1]), ms = count > 2 ? mp_obj_get_int(arguments[2]) : 0;
    pantin_result result;
    listen(self, 0);
    if (viseme < 0 || viseme > PANTIN_TALK_VISEMES || ms < 0 || ms > 0xffffff) mp_raise_ValueError(MP_ERROR_TEXT("viseme"));
    result = pantin_talk_viseme(&self->talk, (uint8_t)viseme, self->talk.now + (uint32_t)ms);
    if (result == PANTIN_NO_ROOM) mp_raise_ValueError(MP_ERROR_TEXT("16 visemes wait already"));
    if (result == PANTIN_NOT_FOUND) mp_raise_ValueError(MP_ERROR_TEXT("a viseme that waits is later"));
    mod_check(result);
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_VAR_BETWEEN(face_viseme_object, 2, 3, face_viseme);

/* The weight of a viseme; the next step after sound or viseme() sets it again. */
static mp_obj_t face_viseme_weight(mp_obj_t self, mp_obj_t number, mp_obj_t weight) {
    mp_int_t viseme = mp_obj_get_int(number);
    if (viseme < 0 || viseme > PANTIN_TALK_VISEMES) mp_raise_ValueError(MP_ERROR_TEXT("viseme"));
    mod_check(pantin_face_viseme(&of(self)->face, (uint8_t)viseme, mod_q15(weight)));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_3(face_viseme_weight_object, face_viseme_weight);

static mp_obj_t face_speaking(mp_obj_t self, mp_obj_t weight) {
    mod_check(pantin_face_speaking(&of(self)->face, mod_q15(weight)));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_speaking_object, face_speaking);

static mp_obj_t face_weight(mp_obj_t self, mp_obj_t name, mp_obj_t weight) {
    pantin_result result = pantin_face_weight(&of(self)->face, mod_name(name), mod_q15(weight));
    if (result == PANTIN_NOT_FOUND) mod_missing("unit", name);
    mod_check(result);
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_3(face_weight_object, face_weight);

static mp_obj_t face_look(mp_obj_t self, mp_obj_t x, mp_obj_t y) {
    mod_check(pantin_face_look(&of(self)->face, mod_q15(x), mod_q15(y)));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_3(face_look_object, face_look);

static mp_obj_t face_mouth(mp_obj_t self, mp_obj_t level) {
    mod_check(pantin_face_mouth(&of(self)->face, mod_q15(level)));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_mouth_object, face_mouth);

static mp_obj_t face_live(mp_obj_t self, mp_obj_t seed) {
    mod_check(pantin_face_live(&of(self)->face, (uint32_t)mp_obj_get_int_truncated(seed)));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_live_object, face_live);

static mp_obj_t face_transition(mp_obj_t self, mp_obj_t ms_in) {
    mp_int_t ms = mp_obj_get_int(ms_in);
    if (ms < 0 || ms > 0xffff) mp_raise_ValueError(MP_ERROR_TEXT("transition"));
    mod_check(pantin_face_transition(&of(self)->face, (uint16_t)ms));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_transition_object, face_transition);

static mp_obj_t face_aim(mp_obj_t self, mp_obj_t orbit, mp_obj_t tilt) {
    mod_check(pantin_face_aim(&of(self)->face, (int16_t)(mp_obj_get_int(orbit) % 360), (int16_t)(mp_obj_get_int(tilt) % 360)));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_3(face_aim_object, face_aim);

/* Sixteen colours in RGB565, the background first, or None for our own. */
static mp_obj_t face_palette(mp_obj_t self_in, mp_obj_t colors) {
    mod_face *self = of(self_in);
    mp_obj_t *items;
    int i;
    if (colors == mp_const_none) {
        mod_check(pantin_face_palette(&self->face, NULL));
        return mp_const_none;
    }
    mp_obj_get_array_fixed_n(colors, 16, &items);
    for (i = 0; i < 16; i++) self->palette[i] = (uint16_t)mp_obj_get_int(items[i]);
    mod_check(pantin_face_palette(&self->face, self->palette));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(face_palette_object, face_palette);

static mp_obj_t face_draw(size_t count, const mp_obj_t *all, mp_map_t *named) {
    static const mp_arg_t allowed[] = {MOD_ROWS};
    mp_arg_val_t arguments[MOD_ROWS_COUNT];
    mod_face *self = of(all[0]);
    mod_rows rows;
    mp_arg_parse_all(count - 1, all + 1, named, MOD_ROWS_COUNT, allowed, arguments);
    rows = mod_rows_of(arguments, self->face.width, self->face.height);
    mod_check(pantin_face_draw(&self->face, rows.format, rows.bytes, rows.stride, rows.y0, rows.y1));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_KW(face_draw_object, 2, face_draw);

static mp_obj_t emote_names(const pantin_face *face) {
    mp_obj_tuple_t *names = MP_OBJ_TO_PTR(mp_obj_new_tuple(PANTIN_EMOTES, NULL));
    int i;
    (void)face;
    for (i = 0; i < PANTIN_EMOTES; i++) names->items[i] = mp_obj_new_str(pantin_emotes[i].name, strlen(pantin_emotes[i].name));
    return MP_OBJ_FROM_PTR(names);
}

static void face_attribute(mp_obj_t self, qstr attribute, mp_obj_t *dest) {
    const pantin_face *face = &of(self)->face;
    if (dest[0] != MP_OBJ_NULL) return;
    switch (attribute) {
        case MP_QSTR_width: dest[0] = MP_OBJ_NEW_SMALL_INT(face->width); break;
        case MP_QSTR_height: dest[0] = MP_OBJ_NEW_SMALL_INT(face->height); break;
        case MP_QSTR_emotes: dest[0] = emote_names(face); break;
        case MP_QSTR_frame: dest[0] = mp_obj_new_int_from_uint(face->playing ? face->player.frame : 0); break;
        case MP_QSTR_frames: dest[0] = mp_obj_new_int_from_uint(face->playing ? face->clip.frames : 0); break;
        case MP_QSTR_finished: dest[0] = mp_obj_new_bool(face->finished); break;
        default: dest[1] = MP_OBJ_SENTINEL;
    }
}

static const mp_rom_map_elem_t face_table[] = {
    {MP_ROM_QSTR(MP_QSTR_emote), MP_ROM_PTR(&face_emote_object)},
    {MP_ROM_QSTR(MP_QSTR_play), MP_ROM_PTR(&face_play_object)},
    {MP_ROM_QSTR(MP_QSTR_step), MP_ROM_PTR(&face_step_object)},
    {MP_ROM_QSTR(MP_QSTR_sound), MP_ROM_PTR(&face_sound_object)},
    {MP_ROM_QSTR(MP_QSTR_viseme), MP_ROM_PTR(&face_viseme_object)},
    {MP_ROM_QSTR(MP_QSTR_viseme_weight), MP_ROM_PTR(&face_viseme_weight_object)},
    {MP_ROM_QSTR(MP_QSTR_speaking), MP_ROM_PTR(&face_speaking_object)},
    {MP_ROM_QSTR(MP_QSTR_weight), MP_ROM_PTR(&face_weight_object)},
    {MP_ROM_QSTR(MP_QSTR_look), MP_ROM_PTR(&face_look_object)},
    {MP_ROM_QSTR(MP_QSTR_mouth), MP_ROM_PTR(&face_mouth_object)},
    {MP_ROM_QSTR(MP_QSTR_live), MP_ROM_PTR(&face_live_object)},
    {MP_ROM_QSTR(MP_QSTR_transition), MP_ROM_PTR(&face_transition_object)},
    {MP_ROM_QSTR(MP_QSTR_aim), MP_ROM_PTR(&face_aim_object)},
    {MP_ROM_QSTR(MP_QSTR_palette), MP_ROM_PTR(&face_palette_object)},
    {MP_ROM_QSTR(MP_QSTR_draw), MP_ROM_PTR(&face_draw_object)},
};
static MP_DEFINE_CONST_DICT(face_dictionary, face_table);
MP_DEFINE_CONST_OBJ_TYPE(mod_face_type, MP_QSTR_Face, MP_TYPE_FLAG_NONE, make_new, face_make, attr, face_attribute, locals_dict,
                         &face_dictionary);
