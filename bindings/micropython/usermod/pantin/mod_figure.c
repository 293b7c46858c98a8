/* Figures of the module `pantin`: a body with volume or lines, drawn into the rows of a buffer. */
#include "mod_pantin.h"
#include "pantin_solid.h"

enum { NOTHING = 0, BODY, LINES };

typedef struct mod_figure {
    mp_obj_base_t base;
    mod_clip *clip;
    mp_obj_t look; /* keeps the character's bytes */
    pantin_bone *bones;
    pantin_drive *drives;
    pantin_slot *slots;
    uint32_t version; /* of the clip's pose that is placed */
    uint8_t placed;   /* as what: NOTHING, BODY or LINES */
    pantin_solid solid;
} mod_figure;

/* Sets the figure up, and leaves the clip at its frame. */
static void set_up(mod_figure *self, uint16_t width, uint16_t height, const pantin_view *view) {
    mod_clip *clip = self->clip;
    size_t joints = clip->clip.rig.joints, bones = joints + 1 < PANTIN_MAX_BONES ? joints + 1 : PANTIN_MAX_BONES;
    size_t drives = (size_t)clip->clip.rig.channels + 1;
    uint32_t frame = clip->player.frame;
    pantin_joint_info *scratch = m_new0(pantin_joint_info, joints + 1);
    pantin_result result;
    self->bones = m_new0(pantin_bone, bones);
    self->drives = m_new0(pantin_drive, drives);
    self->slots = m_new0(pantin_slot, PANTIN_FIGURE_SLOTS);
    pantin_figure_memory(&self->solid.figure, self->bones, bones, self->drives, drives, self->slots, PANTIN_FIGURE_SLOTS);
    result = pantin_solid_set_up(&self->solid, &clip->player, width, height, scratch, joints);
    if (result == PANTIN_OK) result = pantin_solid_aim(&self->solid, &clip->player, view);
    m_del(pantin_joint_info, scratch, joints + 1);
    mod_check(pantin_seek(&clip->player, frame));
    if (result == PANTIN_NO_ROOM) mp_raise_ValueError(MP_ERROR_TEXT("the rig has too many joints for a figure"));
    mod_check(result);
}

static mod_figure *new_figure(mod_clip *clip) {
    mod_figure *self = mp_obj_malloc(mod_figure, &mod_figure_type);
    memset((char *)self + sizeof self->base, 0, sizeof *self - sizeof self->base);
    self->clip = clip;
    self->look = mp_const_none;
    return self;
}

static mp_obj_t figure_make(const mp_obj_type_t *type, size_t count, size_t named, const mp_obj_t *all) {
    static const mp_arg_t allowed[] = {
        {MP_QSTR_clip, MP_ARG_REQUIRED | MP_ARG_OBJ, {.u_obj = MP_OBJ_NULL}},
        {MP_QSTR_width, MP_ARG_REQUIRED | MP_ARG_INT, {.u_int = 0}},
        {MP_QSTR_height, MP_ARG_REQUIRED | MP_ARG_INT, {.u_int = 0}},
        {MP_QSTR_orbit, MP_ARG_KW_ONLY | MP_ARG_INT, {.u_int = -50}},
        {MP_QSTR_tilt, MP_ARG_KW_ONLY | MP_ARG_INT, {.u_int = 12}},
        {MP_QSTR_fixed, MP_ARG_KW_ONLY | MP_ARG_BOOL, {.u_bool = false}},
        {MP_QSTR_look, MP_ARG_KW_ONLY | MP_ARG_OBJ, {.u_rom_obj = MP_ROM_NONE}},
        {MP_QSTR_up, MP_ARG_KW_ONLY | MP_ARG_INT, {.u_int = PANTIN_RIG_UP}},
    };
    mp_arg_val_t arguments[MP_ARRAY_SIZE(allowed)];
    mod_figure *self;
    pantin_view view;
    (void)type;
    mp_arg_parse_all_kw_array(count, named, all, MP_ARRAY_SIZE(allowed), allowed, arguments);
    if (!mp_obj_is_type(arguments[0].u_obj, &mod_clip_type)) mp_raise_TypeError(MP_ERROR_TEXT("clip"));
    self = new_figure(MP_OBJ_TO_PTR(arguments[0].u_obj));
    self->look = arguments[6].u_obj;
    if (self->look != mp_const_none) {
        mp_buffer_info_t bytes = mod_bytes(self->look);
        mod_check(pantin_solid_look(&self->solid, bytes.buf, bytes.len));
    }
    if ((arguments[1].u_int | arguments[2].u_int) >> 11) mp_raise_ValueError(MP_ERROR_TEXT("a figure has 1 to 2047 pixels each way"));
    view.orbit = (int16_t)(arguments[3].u_int % 360);
    view.tilt = (int16_t)(arguments[4].u_int % 360);
    view.fixed = arguments[5].u_bool;
    view.up = (uint8_t)arguments[7].u_int;
    set_up(self, (uint16_t)arguments[1].u_int, (uint16_t)arguments[2].u_int, &view);
    return MP_OBJ_FROM_PTR(self);
}

/* Takes over the clip's pose, once for each: which part covers which depends on the poses before. */
static void place(mod_figure *self, uint8_t as) {
    if (self->placed == as && self->version == self->clip->version) return;
    if (as == BODY) {
        pantin_solid_pose(&self->solid, self->clip->pose);
    } else {
        pantin_figure_pose(&self->solid.figure, self->clip->pose);
    }
    self->placed = as;
    self->version = self->clip->version;
}

static mp_obj_t figure_draw(size_t count, const mp_obj_t *all, mp_map_t *named) {
    static const mp_arg_t allowed[] = {
        MOD_ROWS,
        {MP_QSTR_lines, MP_ARG_KW_ONLY | MP_ARG_BOOL, {.u_bool = false}},
        {MP_QSTR_floor, MP_ARG_KW_ONLY | MP_ARG_BOOL, {.u_bool = true}},
    };
    mp_arg_val_t arguments[MP_ARRAY_SIZE(allowed)];
    mod_figure *self = MP_OBJ_TO_PTR(all[0]);
    const pantin_figure *figure = &self->solid.figure;
    bool lines, floor;
    mod_rows rows;
    mp_arg_parse_all(count - 1, all + 1, named, MP_ARRAY_SIZE(allowed), allowed, arguments);
    lines = arguments[MOD_ROWS_COUNT].u_bool;
    floor = arguments[MOD_ROWS_COUNT + 1].u_bool;
    rows = mod_rows_of(arguments, figure->width, figure->height);
    place(self, lines ? LINES : BODY);
    mod_check(lines ? pantin_figure_draw(figure, rows.format, rows.bytes, rows.stride, rows.y0, rows.y1, floor)
                    : pantin_solid_draw(&self->solid, rows.format, rows.bytes, rows.stride, rows.y0, rows.y1, floor));
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_KW(figure_draw_object, 2, figure_draw);

/* The lines of the pose, the farthest first: x0, y0, x1, y1 in sixteenths of a pixel, depth, shade, part, width. */
static mp_obj_t figure_lines(mp_obj_t self_in) {
    mod_figure *self = MP_OBJ_TO_PTR(self_in);
    mp_obj_t list = mp_obj_new_list(0, NULL);
    pantin_line line;
    uint8_t i;
    place(self, LINES);
    for (i = 0; pantin_figure_line(&self->solid.figure, i, &line); i++) {
        const int16_t values[8] = {line.from[0], line.from[1], line.to[0], line.to[1], line.depth, line.shade, line.part, line.width};
        mp_obj_t items[8];
        int n;
        for (n = 0; n < 8; n++) items[n] = MP_OBJ_NEW_SMALL_INT(values[n]);
        mp_obj_list_append(list, mp_obj_new_tuple(8, items));
    }
    return list;
}
static MP_DEFINE_CONST_FUN_OBJ_1(figure_lines_object, figure_lines);

/* The head: x, y and radius in sixteenths of a pixel, shade. None if the rig has none. */
static mp_obj_t figure_head(mp_obj_t self_in) {
    mod_figure *self = MP_OBJ_TO_PTR(self_in);
    pantin_head head;
    mp_obj_t items[4];
    place(self, LINES);
    if (!pantin_figure_head(&self->solid.figure, &head)) return mp_const_none;
    items[0] = MP_OBJ_NEW_SMALL_INT(head.centre[0]);
    items[1] = MP_OBJ_NEW_SMALL_INT(head.centre[1]);
    items[2] = MP_OBJ_NEW_SMALL_INT(head.radius);
    items[3] = MP_OBJ_NEW_SMALL_INT(head.shade);
    return mp_obj_new_tuple(4, items);
}
static MP_DEFINE_CONST_FUN_OBJ_1(figure_head_object, figure_head);

static void figure_attribute(mp_obj_t self_in, qstr attribute, mp_obj_t *dest) {
    mod_figure *self = MP_OBJ_TO_PTR(self_in);
    if (dest[0] != MP_OBJ_NULL) return;
    switch (attribute) {
        case MP_QSTR_width: dest[0] = MP_OBJ_NEW_SMALL_INT(self->solid.figure.width); break;
        case MP_QSTR_height: dest[0] = MP_OBJ_NEW_SMALL_INT(self->solid.figure.height); break;
        case MP_QSTR_build: dest[0] = MP_OBJ_NEW_SMALL_INT(self->solid.build); break;
        case MP_QSTR_clip: dest[0] = MP_OBJ_FROM_PTR(self->clip); break;
        default: dest[1] = MP_OBJ_SENTINEL;
    }
}

static const mp_rom_map_elem_t figure_table[] = {
    {MP_ROM_QSTR(MP_QSTR_draw), MP_ROM_PTR(&figure_draw_object)},
    {MP_ROM_QSTR(MP_QSTR_lines), MP_ROM_PTR(&figure_lines_object)},
    {MP_ROM_QSTR(MP_QSTR_head), MP_ROM_PTR(&figure_head_object)},
};
static MP_DEFINE_CONST_DICT(figure_dictionary, figure_table);
MP_DEFINE_CONST_OBJ_TYPE(mod_figure_type, MP_QSTR_Figure, MP_TYPE_FLAG_NONE, make_new, figure_make, attr, figure_attribute, locals_dict,
                         &figure_dictionary);

/* Clip.draw(fb, width, height, color=1, orbit=-50): the figure is made by the first call, and again for another size or side. */
void mod_draw_lines(mod_clip *clip, size_t count, const mp_obj_t *all, mp_map_t *named) {
    static const mp_arg_t allowed[] = {
        {MP_QSTR_fb, MP_ARG_REQUIRED | MP_ARG_OBJ, {.u_obj = MP_OBJ_NULL}},
        {MP_QSTR_width, MP_ARG_REQUIRED | MP_ARG_INT, {.u_int = 0}},
        {MP_QSTR_height, MP_ARG_REQUIRED | MP_ARG_INT, {.u_int = 0}},
        {MP_QSTR_color, MP_ARG_INT, {.u_int = 1}},
        {MP_QSTR_orbit, MP_ARG_INT, {.u_int = -50}},
    };
    mp_arg_val_t arguments[MP_ARRAY_SIZE(allowed)];
    mp_obj_t call[7], shot[3];
    pantin_line line;
    mod_figure *figure;
    uint8_t i;
    int n;
    mp_arg_parse_all(count, all, named, MP_ARRAY_SIZE(allowed), allowed, arguments);
    for (n = 0; n < 3; n++) shot[n] = mp_obj_new_int(arguments[n < 2 ? n + 1 : 4].u_int);
    if (clip->shot == mp_const_none || !mp_obj_equal(clip->shot, mp_obj_new_tuple(3, shot))) {
        mp_obj_t made[5];
        made[0] = MP_OBJ_FROM_PTR(clip);
        made[1] = shot[0];
        made[2] = shot[1];
        made[3] = MP_OBJ_NEW_QSTR(MP_QSTR_orbit);
        made[4] = shot[2];
        clip->drawn = figure_make(&mod_figure_type, 3, 1, made);
        clip->shot = mp_obj_new_tuple(3, shot);
    }
    figure = MP_OBJ_TO_PTR(clip->drawn);
    place(figure, LINES);
    for (i = 0; pantin_figure_line(&figure->solid.figure, i, &line); i++) {
        const int16_t values[4] = {line.from[0], line.from[1], line.to[0], line.to[1]};
        mp_load_method(arguments[0].u_obj, MP_QSTR_line, call);
        for (n = 0; n < 4; n++) call[2 + n] = MP_OBJ_NEW_SMALL_INT(values[n] >> 4);
        call[6] = mp_obj_new_int(arguments[3].u_int);
        mp_call_method_n_kw(5, 0, call);
    }
}
