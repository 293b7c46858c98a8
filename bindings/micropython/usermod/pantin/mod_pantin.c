/* The module `pantin` in C for MicroPython: clips, banks and rotations, with the calls of the decoder in Python (pantin.py and pantin_turns.py).
 * mod_figure.c has figures, mod_face.c faces. */
#include "mod_pantin.h"
#include "pantin_turn.h"

#if !MICROPY_PY_BUILTINS_FLOAT
#error "pantin needs a build of MicroPython with floating point"
#endif

/* ---- What the files share ------------------------------------------------------------------------------------------------------------ */

void mod_check(pantin_result result) {
    static const char *const reasons[] = {
        [PANTIN_NEED_MORE] = "length", [PANTIN_NOT_FOUND] = "out of range", [PANTIN_ERROR_READ] = "read", [PANTIN_ERROR_MAGIC] = "magic",
        [PANTIN_ERROR_VERSION] = "version", [PANTIN_ERROR_FLAGS] = "flags", [PANTIN_ERROR_LENGTH] = "length", [PANTIN_ERROR_CRC] = "crc",
        [PANTIN_ERROR_RIG] = "rig", [PANTIN_ERROR_NO_RIG] = "no rig", [PANTIN_ERROR_OTHER_RIG] = "other rig", [PANTIN_ERROR_HEAD] = "head",
        [PANTIN_ERROR_BANK] = "bank", [PANTIN_ERROR_MACHINE] = "machine", [PANTIN_UNSUPPORTED] = "unsupported",
    };
    if (result == PANTIN_OK || result == PANTIN_END) return;
    if (result == PANTIN_NO_ROOM) mp_raise_msg(&mp_type_MemoryError, NULL);
    mp_raise_msg_varg(&mp_type_ValueError, MP_ERROR_TEXT("%s"), reasons[result]);
}

mp_buffer_info_t mod_bytes(mp_obj_t object) {
    mp_buffer_info_t buffer;
    mp_get_buffer_raise(object, &buffer, MP_BUFFER_READ);
    return buffer;
}

void mod_missing(const char *what, mp_obj_t name) {
    mp_raise_msg_varg(&mp_type_KeyError, MP_ERROR_TEXT("no %s %s"), what, mp_obj_str_get_str(name));
}

const char *mod_name(mp_obj_t text) {
    size_t length;
    const char *name = mp_obj_str_get_data(text, &length);
    if (strlen(name) != length) mod_missing("such name", text);
    return name;
}

int32_t mod_q15(mp_obj_t number) {
    mp_float_t x = mp_obj_get_float(number) * (mp_float_t)32768.0;
    /* Also refuses what is no number. */
    if (!(x >= (mp_float_t)-65536.0 && x <= (mp_float_t)65536.0)) mp_raise_ValueError(MP_ERROR_TEXT("a weight is -2 to 2"));
    return (int32_t)(x + (x < 0 ? (mp_float_t)-0.5 : (mp_float_t)0.5));
}

mod_rows mod_rows_of(const mp_arg_val_t *arguments, uint16_t width, uint16_t height) {
    mod_rows rows;
    mp_buffer_info_t buffer;
    mp_int_t format = arguments[1].u_int, y0 = arguments[2].u_int, y1 = arguments[3].u_int, stride = arguments[4].u_int;
    mp_int_t row = format < PANTIN_L8 ? (width + 7) / 8 : format == PANTIN_L8 ? width : 2 * width; /* bytes */
    mp_get_buffer_raise(arguments[0].u_obj, &buffer, MP_BUFFER_WRITE);
    if (format < PANTIN_I1 || format > PANTIN_RGB565_SWAPPED) mp_raise_ValueError(MP_ERROR_TEXT("no such format"));
    if (y1 < 0) y1 = height;
    if (stride < 0) stride = row;
    if (y0 < 0 || y0 > y1 || y1 > height) mp_raise_ValueError(MP_ERROR_TEXT("rows"));
    if (stride < row || stride > 0xffff || (size_t)stride * (size_t)(y1 - y0) > buffer.len) mp_raise_ValueError(MP_ERROR_TEXT("the rows do not fit the buffer"));
    if (format >= PANTIN_RGB565 && (((uintptr_t)buffer.buf | (uintptr_t)stride) & 1)) {
        mp_raise_ValueError(MP_ERROR_TEXT("16-bit rows begin at even addresses"));
    }
    rows.format = (pantin_format)format;
    rows.bytes = buffer.buf;
    rows.stride = (size_t)stride;
    rows.y0 = (uint16_t)y0;
    rows.y1 = (uint16_t)y1;
    return rows;
}

static mp_obj_t text_of(const pantin_name *name) {
    mp_obj_t text;
    size_t length = name->length;
    char *copy = m_new(char, length + 1);
    pantin_copy_name(name, copy, length + 1);
    text = mp_obj_new_str(copy, length);
    m_del(char, copy, length + 1);
    return text;
}

/* A tuple of numbers in 2^-30 or 2^-32 turns. */
static mp_obj_t numbers(const int32_t *values, size_t count) {
    size_t i;
    mp_obj_tuple_t *tuple = MP_OBJ_TO_PTR(mp_obj_new_tuple(count, NULL));
    for (i = 0; i < count; i++) tuple->items[i] = mp_obj_new_int(values[i]);
    return MP_OBJ_FROM_PTR(tuple);
}

/* Looks up what is no attribute of an object's own among its methods. */
static void else_method(mp_obj_t *dest) { dest[1] = MP_OBJ_SENTINEL; }

/* ---- Rig ----------------------------------------------------------------------------------------------------------------------------- */

/* A figure's joints and scalars; `owner` keeps the bytes. */
typedef struct mod_rig {
    mp_obj_base_t base;
    mp_obj_t owner;
    pantin_source source; /* of a file of its own */
    pantin_rig rig;
} mod_rig;

static const mp_obj_type_t mod_rig_type;

static mp_obj_t rig_make(const mp_obj_type_t *type, size_t count, size_t named, const mp_obj_t *arguments) {
    mp_buffer_info_t bytes;
    mod_rig *self;
    mp_arg_check_num(count, named, 1, 1, false);
    bytes = mod_bytes(arguments[0]);
    self = mp_obj_malloc(mod_rig, type);
    self->owner = arguments[0];
    pantin_memory(&self->source, bytes.buf, (uint32_t)bytes.len);
    mod_check(pantin_open_rig(&self->rig, &self->source, 0, (uint32_t)bytes.len));
    return MP_OBJ_FROM_PTR(self);
}

/* The rig of a clip or a bank. */
static mp_obj_t rig_of(mp_obj_t owner, const pantin_rig *rig) {
    mod_rig *self = mp_obj_malloc(mod_rig, &mod_rig_type);
    self->owner = owner;
    self->rig = *rig;
    return MP_OBJ_FROM_PTR(self);
}

static mp_obj_t kinds_of(const pantin_joint *joint, bool exponential) {
    uint8_t i, kinds[15], map = PANTIN_EXPONENTIAL_X;
    for (i = 0; i < joint->channels; i++) {
        kinds[i] = pantin_joint_kind(joint, i);
        if (exponential && kinds[i] >= PANTIN_EULER_X && kinds[i] <= PANTIN_EULER_Z) kinds[i] = map++;
    }
    return mp_obj_new_bytes(kinds, joint->channels);
}

static mp_obj_t joint_tuple(const pantin_joint *joint) {
    static const qstr fields[] = {MP_QSTR_name, MP_QSTR_parent, MP_QSTR_offset, MP_QSTR_first, MP_QSTR_kinds, MP_QSTR_end_site, MP_QSTR_helper};
    mp_obj_t items[7];
    items[0] = text_of(&joint->name);
    items[1] = joint->parent == PANTIN_NO_PARENT ? mp_const_none : MP_OBJ_NEW_SMALL_INT(joint->parent);
    items[2] = numbers(joint->offset, 3);
    items[3] = MP_OBJ_NEW_SMALL_INT(joint->first_channel);
    items[4] = kinds_of(joint, false);
    items[5] = mp_obj_new_bool(joint->end_site);
    items[6] = mp_obj_new_bool(joint->helper);
    return mp_obj_new_attrtuple(fields, 7, items);
}

static mp_obj_t rig_joints(const pantin_rig *rig) {
    pantin_joint joint;
    mp_obj_t list = mp_obj_new_list(0, NULL);
    pantin_first_joint(&joint, rig);
    while (pantin_next_joint(&joint)) mp_obj_list_append(list, joint_tuple(&joint));
    return list;
}

static mp_obj_t rig_scalars(const pantin_rig *rig) {
    pantin_scalar scalar;
    mp_obj_t list = mp_obj_new_list(0, NULL);
    pantin_first_scalar(&scalar, rig);
    while (pantin_next_scalar(&scalar)) {
        mp_obj_t items[3];
        items[0] = MP_OBJ_NEW_SMALL_INT(scalar.channel);
        items[1] = MP_OBJ_NEW_SMALL_INT(scalar.exponent);
        items[2] = text_of(&scalar.name);
        mp_obj_list_append(list, mp_obj_new_tuple(3, items));
    }
    return list;
}

static void find_joint(const pantin_rig *rig, mp_obj_t name, pantin_joint *joint) {
    if (!pantin_find_joint(rig, mod_name(name), joint)) mod_missing("joint", name);
}

static mp_obj_t rig_joint(mp_obj_t self, mp_obj_t name) {
    pantin_joint joint;
    find_joint(&((mod_rig *)MP_OBJ_TO_PTR(self))->rig, name, &joint);
    return joint_tuple(&joint);
}
static MP_DEFINE_CONST_FUN_OBJ_2(rig_joint_object, rig_joint);

static mp_obj_t rig_index(mp_obj_t self, mp_obj_t name) {
    pantin_joint joint;
    find_joint(&((mod_rig *)MP_OBJ_TO_PTR(self))->rig, name, &joint);
    return MP_OBJ_NEW_SMALL_INT(joint.index);
}
static MP_DEFINE_CONST_FUN_OBJ_2(rig_index_object, rig_index);

static void rig_attribute(mp_obj_t self, qstr attribute, mp_obj_t *dest) {
    const pantin_rig *rig = &((mod_rig *)MP_OBJ_TO_PTR(self))->rig;
    if (dest[0] != MP_OBJ_NULL) return;
    switch (attribute) {
        case MP_QSTR_joints: dest[0] = rig_joints(rig); break;
        case MP_QSTR_scalars: dest[0] = rig_scalars(rig); break;
        case MP_QSTR_channels: dest[0] = MP_OBJ_NEW_SMALL_INT(rig->channels); break;
        case MP_QSTR_up: dest[0] = MP_OBJ_NEW_SMALL_INT(rig->up); break;
        case MP_QSTR_offset_exponent: dest[0] = MP_OBJ_NEW_SMALL_INT(rig->offset_exponent); break;
        case MP_QSTR_unit_micro_cm: dest[0] = mp_obj_new_int_from_uint(rig->unit_micro_cm); break;
        default: else_method(dest);
    }
}

static const mp_rom_map_elem_t rig_table[] = {
    {MP_ROM_QSTR(MP_QSTR_joint), MP_ROM_PTR(&rig_joint_object)},
    {MP_ROM_QSTR(MP_QSTR_index), MP_ROM_PTR(&rig_index_object)},
};
static MP_DEFINE_CONST_DICT(rig_dictionary, rig_table);
static MP_DEFINE_CONST_OBJ_TYPE(mod_rig_type, MP_QSTR_Rig, MP_TYPE_FLAG_NONE, make_new, rig_make, attr, rig_attribute, locals_dict,
                                &rig_dictionary);

/* ---- Joints of a clip ---------------------------------------------------------------------------------------------------------------- */

typedef struct mod_joint {
    mp_obj_base_t base;
    mod_clip *clip;
    pantin_joint at;
    pantin_joint_ref joint;
} mod_joint;

/* The number of an order's name, such as "ZXY". */
static pantin_order order_of(mp_obj_t name) {
    static const char names[6][4] = {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
    const char *text = mp_obj_str_get_str(name);
    int i;
    for (i = 0; i < 6; i++) {
        if (strcmp(text, names[i]) == 0) return (pantin_order)i;
    }
    mp_raise_msg_varg(&mp_type_ValueError, MP_ERROR_TEXT("no order of Euler angles: %s"), text);
}

static void euler_of(mp_obj_t self_in, mp_obj_t order, int32_t *angles) {
    mod_joint *self = MP_OBJ_TO_PTR(self_in);
    /* Angles that the joint does not have in an order of its own are refused, as in Python. */
    if (order == mp_const_none) mp_raise_ValueError(MP_ERROR_TEXT("no order of Euler angles: None"));
    mod_check(pantin_euler(&self->clip->player, &self->joint, order_of(order), angles));
}

static mp_obj_t joint_euler(mp_obj_t self, mp_obj_t order) {
    int32_t angles[3];
    euler_of(self, order, angles);
    return numbers(angles, 3);
}
static MP_DEFINE_CONST_FUN_OBJ_2(joint_euler_object, joint_euler);

static mp_obj_t joint_degrees(mp_obj_t self, mp_obj_t order) {
    int32_t angles[3];
    mp_obj_t items[3];
    int i;
    euler_of(self, order, angles);
    for (i = 0; i < 3; i++) items[i] = mp_obj_new_float((mp_float_t)angles[i] * (mp_float_t)(360.0 / 4294967296.0));
    return mp_obj_new_tuple(3, items);
}
static MP_DEFINE_CONST_FUN_OBJ_2(joint_degrees_object, joint_degrees);

static mp_obj_t joint_quaternion(mp_obj_t self_in) {
    mod_joint *self = MP_OBJ_TO_PTR(self_in);
    int32_t wxyz[4];
    mod_check(pantin_quaternion(&self->clip->player, &self->joint, wxyz));
    return numbers(wxyz, 4);
}
static MP_DEFINE_CONST_FUN_OBJ_1(joint_quaternion_object, joint_quaternion);

static mp_obj_t joint_matrix(mp_obj_t self_in) {
    mod_joint *self = MP_OBJ_TO_PTR(self_in);
    int32_t values[9];
    mp_obj_t rows[3];
    int i;
    mod_check(pantin_matrix(&self->clip->player, &self->joint, values));
    for (i = 0; i < 3; i++) rows[i] = numbers(values + 3 * i, 3);
    return mp_obj_new_tuple(3, rows);
}
static MP_DEFINE_CONST_FUN_OBJ_1(joint_matrix_object, joint_matrix);

static mp_obj_t joint_angle(mp_obj_t self_in) {
    mod_joint *self = MP_OBJ_TO_PTR(self_in);
    int32_t angle;
    mod_check(pantin_angle(&self->clip->player, &self->joint, &angle));
    return mp_obj_new_int(angle);
}
static MP_DEFINE_CONST_FUN_OBJ_1(joint_angle_object, joint_angle);

static mp_obj_t joint_raw(mp_obj_t self_in) {
    mod_joint *self = MP_OBJ_TO_PTR(self_in);
    return numbers(self->clip->pose + self->joint.first_channel, self->joint.channels);
}
static MP_DEFINE_CONST_FUN_OBJ_1(joint_raw_object, joint_raw);

static void joint_attribute(mp_obj_t self_in, qstr attribute, mp_obj_t *dest) {
    static const qstr orders[6] = {MP_QSTR_XYZ, MP_QSTR_XZY, MP_QSTR_YXZ, MP_QSTR_YZX, MP_QSTR_ZXY, MP_QSTR_ZYX};
    mod_joint *self = MP_OBJ_TO_PTR(self_in);
    if (dest[0] != MP_OBJ_NULL) return;
    switch (attribute) {
        case MP_QSTR_name: dest[0] = text_of(&self->at.name); break;
        case MP_QSTR_index: dest[0] = MP_OBJ_NEW_SMALL_INT(self->joint.index); break;
        case MP_QSTR_first: dest[0] = MP_OBJ_NEW_SMALL_INT(self->joint.first_channel); break;
        case MP_QSTR_kinds: dest[0] = kinds_of(&self->at, self->joint.exponential); break;
        case MP_QSTR_order: dest[0] = self->joint.order < 6 ? MP_OBJ_NEW_QSTR(orders[self->joint.order]) : mp_const_none; break;
        default: else_method(dest);
    }
}

static const mp_rom_map_elem_t joint_table[] = {
    {MP_ROM_QSTR(MP_QSTR_euler), MP_ROM_PTR(&joint_euler_object)},
    {MP_ROM_QSTR(MP_QSTR_degrees), MP_ROM_PTR(&joint_degrees_object)},
    {MP_ROM_QSTR(MP_QSTR_quaternion), MP_ROM_PTR(&joint_quaternion_object)},
    {MP_ROM_QSTR(MP_QSTR_matrix), MP_ROM_PTR(&joint_matrix_object)},
    {MP_ROM_QSTR(MP_QSTR_angle), MP_ROM_PTR(&joint_angle_object)},
    {MP_ROM_QSTR(MP_QSTR_raw), MP_ROM_PTR(&joint_raw_object)},
};
static MP_DEFINE_CONST_DICT(joint_dictionary, joint_table);
static MP_DEFINE_CONST_OBJ_TYPE(mod_joint_type, MP_QSTR_JointRef, MP_TYPE_FLAG_NONE, attr, joint_attribute, locals_dict, &joint_dictionary);

/* ---- Clip ---------------------------------------------------------------------------------------------------------------------------- */

/* Lends the opened clip its memory and shows frame 0. */
static mp_obj_t started(mod_clip *self) {
    pantin_channel none;
    pantin_result result;
    size_t channels = self->clip.rig.channels;
    self->drawn = self->shot = mp_const_none;
    self->pose = m_new0(int32_t, channels + 1);
    result = pantin_start(&self->player, &self->clip, self->pose, channels, &none, 0);
    if (result == PANTIN_NO_ROOM && self->player.moving_count > 0) {
        size_t room = self->player.moving_count;
        self->moving = m_new0(pantin_channel, room);
        result = pantin_start(&self->player, &self->clip, self->pose, channels, self->moving, room);
    }
    mod_check(result);
    return MP_OBJ_FROM_PTR(self);
}

static mp_obj_t clip_make(const mp_obj_type_t *type, size_t count, size_t named, const mp_obj_t *arguments) {
    mp_buffer_info_t bytes;
    const pantin_rig *rig = NULL;
    mod_clip *self;
    mp_arg_check_num(count, named, 1, 2, false);
    bytes = mod_bytes(arguments[0]);
    self = mp_obj_malloc(mod_clip, type);
    self->data = arguments[0];
    self->owner = count > 1 ? arguments[1] : mp_const_none;
    self->version = 0;
    if (self->owner != mp_const_none) {
        if (!mp_obj_is_type(self->owner, &mod_rig_type)) mp_raise_TypeError(MP_ERROR_TEXT("rig"));
        rig = &((mod_rig *)MP_OBJ_TO_PTR(self->owner))->rig;
    }
    pantin_memory(&self->source, bytes.buf, (uint32_t)bytes.len);
    mod_check(pantin_open(&self->clip, &self->source, rig));
    return started(self);
}

static mp_obj_t clip_step(mp_obj_t self_in) {
    mod_clip *self = MP_OBJ_TO_PTR(self_in);
    pantin_result result = pantin_step(&self->player);
    mod_check(result);
    self->version++;
    return mp_obj_new_bool(result == PANTIN_OK);
}
static MP_DEFINE_CONST_FUN_OBJ_1(clip_step_object, clip_step);

static void seek(mod_clip *self, uint32_t frame) {
    self->version++;
    mod_check(pantin_seek(&self->player, frame < self->clip.frames ? frame : self->clip.frames - 1));
}

static mp_obj_t clip_seek(mp_obj_t self, mp_obj_t frame) {
    mp_int_t to = mp_obj_get_int(frame);
    seek(MP_OBJ_TO_PTR(self), to < 0 ? 0 : (uint32_t)to);
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_2(clip_seek_object, clip_seek);

static mp_obj_t clip_restart(mp_obj_t self) {
    seek(MP_OBJ_TO_PTR(self), 0);
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_1(clip_restart_object, clip_restart);

static mp_obj_t clip_update(mp_obj_t self_in, mp_obj_t ms) {
    mod_clip *self = MP_OBJ_TO_PTR(self_in);
    uint64_t ns = (uint64_t)(uint32_t)mp_obj_get_int_truncated(ms) * 1000000;
    uint32_t frame = (uint32_t)(ns / self->clip.frame_time_ns % self->clip.frames);
    if (frame == self->player.frame) return mp_const_false;
    seek(self, frame);
    return mp_const_true;
}
static MP_DEFINE_CONST_FUN_OBJ_2(clip_update_object, clip_update);

static mp_obj_t clip_find(mp_obj_t self_in, mp_obj_t name) {
    mod_clip *self = MP_OBJ_TO_PTR(self_in);
    mod_joint *joint = mp_obj_malloc(mod_joint, &mod_joint_type);
    joint->clip = self;
    find_joint(&self->clip.rig, name, &joint->at);
    mod_check(pantin_refer(&self->clip, &joint->at, &joint->joint));
    return MP_OBJ_FROM_PTR(joint);
}
static MP_DEFINE_CONST_FUN_OBJ_2(clip_find_object, clip_find);

static mp_obj_t clip_scalar(mp_obj_t self_in, mp_obj_t name) {
    mod_clip *self = MP_OBJ_TO_PTR(self_in);
    pantin_scalar scalar;
    mp_float_t value;
    int exponent;
    if (!pantin_find_scalar(&self->clip.rig, mod_name(name), &scalar)) mod_missing("scalar", name);
    value = (mp_float_t)self->pose[scalar.channel];
    for (exponent = scalar.exponent - 31; exponent < 0; exponent++) value /= 2;
    for (; exponent > 0; exponent--) value *= 2;
    return mp_obj_new_float(value);
}
static MP_DEFINE_CONST_FUN_OBJ_2(clip_scalar_object, clip_scalar);

static mp_obj_t clip_draw(size_t count, const mp_obj_t *arguments, mp_map_t *named) {
    mod_draw_lines(MP_OBJ_TO_PTR(arguments[0]), count - 1, arguments + 1, named);
    return mp_const_none;
}
static MP_DEFINE_CONST_FUN_OBJ_KW(clip_draw_object, 4, clip_draw);

static mp_obj_t clip_events(const pantin_clip *clip) {
    pantin_event event;
    mp_obj_t list = mp_obj_new_list(0, NULL);
    pantin_first_event(&event, clip);
    while (pantin_next_event(&event)) {
        mp_obj_t items[2];
        items[0] = mp_obj_new_int_from_uint(event.frame);
        items[1] = mp_obj_new_int_from_uint(event.id);
        mp_obj_list_append(list, mp_obj_new_tuple(2, items));
    }
    return list;
}

/* Names up to the last one that is not empty; those before may be. */
static mp_obj_t clip_event_names(const pantin_clip *clip) {
    pantin_name name;
    uint32_t id, most = clip->names_end - clip->names;
    mp_obj_t list = mp_obj_new_list(0, NULL);
    for (id = 0; id < most; id++) {
        bool named = pantin_event_name(clip, id, &name);
        mp_obj_list_append(list, named ? text_of(&name) : MP_OBJ_NEW_QSTR(MP_QSTR_));
        if (named && name.start + name.length >= clip->names_end) break;
    }
    return list;
}

static mp_obj_t clip_exponential(const pantin_clip *clip) {
    pantin_joint joint;
    mp_obj_t list = mp_obj_new_list(0, NULL);
    pantin_first_joint(&joint, &clip->rig);
    while (pantin_next_joint(&joint)) {
        if (pantin_joint_is_exponential(clip, &joint)) mp_obj_list_append(list, MP_OBJ_NEW_SMALL_INT(joint.index));
    }
    return list;
}

static void clip_attribute(mp_obj_t self_in, qstr attribute, mp_obj_t *dest) {
    mod_clip *self = MP_OBJ_TO_PTR(self_in);
    const pantin_clip *clip = &self->clip;
    if (dest[0] != MP_OBJ_NULL) return;
    switch (attribute) {
        case MP_QSTR_frame: dest[0] = mp_obj_new_int_from_uint(self->player.frame); break;
        case MP_QSTR_frames: dest[0] = mp_obj_new_int_from_uint(clip->frames); break;
        case MP_QSTR_frame_time_ns: dest[0] = mp_obj_new_int_from_uint(clip->frame_time_ns); break;
        case MP_QSTR_looped: dest[0] = mp_obj_new_bool(clip->looped); break;
        case MP_QSTR_exponent: dest[0] = MP_OBJ_NEW_SMALL_INT(clip->exponent); break;
        case MP_QSTR_moving: dest[0] = MP_OBJ_NEW_SMALL_INT(self->player.moving_count); break;
        case MP_QSTR_pose: dest[0] = mp_obj_new_memoryview('i', clip->rig.channels, self->pose); break;
        case MP_QSTR_rig: dest[0] = rig_of(self_in, &clip->rig); break;
        case MP_QSTR_events: dest[0] = clip_events(clip); break;
        case MP_QSTR_event_names: dest[0] = clip_event_names(clip); break;
        case MP_QSTR_exponential: dest[0] = clip_exponential(clip); break;
        default: else_method(dest);
    }
}

static const mp_rom_map_elem_t clip_table[] = {
    {MP_ROM_QSTR(MP_QSTR_step), MP_ROM_PTR(&clip_step_object)},
    {MP_ROM_QSTR(MP_QSTR_seek), MP_ROM_PTR(&clip_seek_object)},
    {MP_ROM_QSTR(MP_QSTR_restart), MP_ROM_PTR(&clip_restart_object)},
    {MP_ROM_QSTR(MP_QSTR_update), MP_ROM_PTR(&clip_update_object)},
    {MP_ROM_QSTR(MP_QSTR_find), MP_ROM_PTR(&clip_find_object)},
    {MP_ROM_QSTR(MP_QSTR_scalar), MP_ROM_PTR(&clip_scalar_object)},
    {MP_ROM_QSTR(MP_QSTR_draw), MP_ROM_PTR(&clip_draw_object)},
};
static MP_DEFINE_CONST_DICT(clip_dictionary, clip_table);
MP_DEFINE_CONST_OBJ_TYPE(mod_clip_type, MP_QSTR_Clip, MP_TYPE_FLAG_NONE, make_new, clip_make, attr, clip_attribute, locals_dict,
                         &clip_dictionary);

/* ---- Bank ---------------------------------------------------------------------------------------------------------------------------- */

typedef struct mod_bank {
    mp_obj_base_t base;
    mp_obj_t data;
    pantin_source source;
    pantin_bank bank;
} mod_bank;

static mp_obj_t bank_make(const mp_obj_type_t *type, size_t count, size_t named, const mp_obj_t *arguments) {
    mp_buffer_info_t bytes;
    mod_bank *self;
    mp_arg_check_num(count, named, 1, 1, false);
    bytes = mod_bytes(arguments[0]);
    self = mp_obj_malloc(mod_bank, type);
    self->data = arguments[0];
    pantin_memory(&self->source, bytes.buf, (uint32_t)bytes.len);
    mod_check(pantin_open_bank(&self->bank, &self->source));
    return MP_OBJ_FROM_PTR(self);
}

static mp_obj_t bank_clip(mp_obj_t self_in, mp_obj_t name) {
    mod_bank *self = MP_OBJ_TO_PTR(self_in);
    const char *text = mod_name(name);
    mod_clip *clip = mp_obj_malloc(mod_clip, &mod_clip_type);
    pantin_result result;
    clip->data = self->data;
    clip->owner = self_in;
    clip->version = 0;
    result = pantin_open_named(&clip->clip, &self->bank, text);
    if (result == PANTIN_NOT_FOUND) mod_missing("clip", name);
    mod_check(result);
    return started(clip);
}
static MP_DEFINE_CONST_FUN_OBJ_2(bank_clip_object, bank_clip);

static void bank_attribute(mp_obj_t self_in, qstr attribute, mp_obj_t *dest) {
    mod_bank *self = MP_OBJ_TO_PTR(self_in);
    if (dest[0] != MP_OBJ_NULL) return;
    if (attribute == MP_QSTR_names) {
        pantin_entry entry;
        dest[0] = mp_obj_new_list(0, NULL);
        pantin_first_entry(&entry, &self->bank);
        while (pantin_next_entry(&entry)) mp_obj_list_append(dest[0], text_of(&entry.name));
    } else if (attribute == MP_QSTR_rig) {
        dest[0] = rig_of(self_in, &self->bank.rig);
    } else {
        else_method(dest);
    }
}

static const mp_rom_map_elem_t bank_table[] = {
    {MP_ROM_QSTR(MP_QSTR_clip), MP_ROM_PTR(&bank_clip_object)},
};
static MP_DEFINE_CONST_DICT(bank_dictionary, bank_table);
static MP_DEFINE_CONST_OBJ_TYPE(mod_bank_type, MP_QSTR_Bank, MP_TYPE_FLAG_NONE, make_new, bank_make, attr, bank_attribute, locals_dict,
                                &bank_dictionary);

/* ---- Module -------------------------------------------------------------------------------------------------------------------------- */

static const mp_rom_map_elem_t module_table[] = {
    {MP_ROM_QSTR(MP_QSTR___name__), MP_ROM_QSTR(MP_QSTR_pantin)},
    {MP_ROM_QSTR(MP_QSTR_Clip), MP_ROM_PTR(&mod_clip_type)},
    {MP_ROM_QSTR(MP_QSTR_Bank), MP_ROM_PTR(&mod_bank_type)},
    {MP_ROM_QSTR(MP_QSTR_Rig), MP_ROM_PTR(&mod_rig_type)},
    {MP_ROM_QSTR(MP_QSTR_Figure), MP_ROM_PTR(&mod_figure_type)},
    {MP_ROM_QSTR(MP_QSTR_Face), MP_ROM_PTR(&mod_face_type)},
    {MP_ROM_QSTR(MP_QSTR_I1), MP_ROM_INT(PANTIN_I1)},
    {MP_ROM_QSTR(MP_QSTR_I1_LSB), MP_ROM_INT(PANTIN_I1_LSB)},
    {MP_ROM_QSTR(MP_QSTR_L8), MP_ROM_INT(PANTIN_L8)},
    {MP_ROM_QSTR(MP_QSTR_RGB565), MP_ROM_INT(PANTIN_RGB565)},
    {MP_ROM_QSTR(MP_QSTR_RGB565_SWAPPED), MP_ROM_INT(PANTIN_RGB565_SWAPPED)},
};
static MP_DEFINE_CONST_DICT(module_dictionary, module_table);

const mp_obj_module_t mod_pantin = {
    .base = {&mp_type_module},
    .globals = (mp_obj_dict_t *)&module_dictionary,
};

MP_REGISTER_MODULE(MP_QSTR_pantin, mod_pantin);
