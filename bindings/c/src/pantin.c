/* Decoder of Pantin clips: see pantin.h. Numbers in parentheses are sections of FORMAT.md.
 *
 * All arithmetic of the format is done on uint32_t, which wraps. Every byte is read through a source's window, so that one code serves
 * memory, pages and streams. A failed read yields 0 and sets the source's `error`; functions that change state check it before they commit. */
#include "pantin_parts.h"
#include "pantin_tables.h"
#ifdef PANTIN_KEYS
#include "pantin_keys.h"
#define IS_KEYS(clip) (((clip)->flags & PANTIN_KEY_CLIP) != 0)
#define MAX_MOVING PANTIN_MAX_STATES
#else
#define MAX_MOVING PANTIN_MAX_CHANNELS
#define IS_KEYS(clip) 0
#endif

enum { HAS_RIG = 1, LOOPED = 2, HAS_EXPONENTIALS = 4, HAS_EVENTS = 8, HAS_INDEX = 16, HAS_EVENT_NAMES = 32, HAS_SECTIONS = 64, KNOWN_FLAGS = 127 };
enum { RESTS = 0, CONSTANT = 1, MOVES = 2, FOLLOWS = 3 };
#define BLOCK 256u
#define CRC_BYTES 2u
#define CRC_START 0xffffu
#define LOW 0x10000u /* the smallest state between symbols */
#define KEY_VERSION 2u
#define NO_LEADER 255u
#define CARRY 3u

/* ---- Sources ---- */

static void fail(pantin_source *s, pantin_result error) {
    if (s->error == PANTIN_OK) s->error = error;
}

static uint8_t byte_at(pantin_source *s, uint32_t position) {
    uint32_t i = position - s->window_start;
    if (i >= s->window_length) {
        pantin_result result = PANTIN_ERROR_READ;
        if (s->load) {
            result = s->load(s, position);
            if (s->failed == PANTIN_OK) s->failed = result;
        }
        i = position - s->window_start;
        if (result != PANTIN_OK || i >= s->window_length) {
            fail(s, result != PANTIN_OK ? result : PANTIN_ERROR_READ);
            return 0;
        }
    }
    return s->window[i];
}

void pantin_memory(pantin_source *source, const uint8_t *bytes, uint32_t length) {
    memset(source, 0, sizeof *source);
    source->window = bytes;
    source->window_length = length;
    source->length = length;
}

static pantin_result load_page(pantin_source *source, uint32_t position) {
    pantin_pages *pages = (pantin_pages *)(void *)source;
    uint32_t count;
    if (position >= source->length) return PANTIN_ERROR_LENGTH;
    count = source->length - position;
    if (count > pages->page_size) count = pages->page_size;
    source->window_start = position;
    source->window_length = 0;
    if (pages->read(pages->context, position, pages->page, (uint16_t)count) != 0) return PANTIN_ERROR_READ;
    source->window_length = count;
    return PANTIN_OK;
}

void pantin_paged(pantin_pages *pages, uint32_t length, pantin_read read, void *context, uint8_t *page, uint16_t page_size) {
    pantin_memory(&pages->source, page, length);
    pages->source.window_length = 0;
    pages->source.load = load_page;
    pages->read = read;
    pages->context = context;
    pages->page = page;
    pages->page_size = page_size;
}

#if defined(__AVR__) || defined(ESP8266)
int pantin_read_progmem(void *context, uint32_t position, uint8_t *into, uint16_t count) {
    memcpy_P(into, (const uint8_t *)context + (uintptr_t)position, count);
    return 0;
}
#endif

static uint16_t crc_of(pantin_source *s, uint32_t position, uint32_t end, uint16_t crc) {
    for (; position < end && s->error == PANTIN_OK; position++) {
        uint8_t x = (uint8_t)((crc >> 8) ^ byte_at(s, position));
        x = (uint8_t)(x ^ (x >> 4));
        crc = (uint16_t)((uint16_t)(crc << 8) ^ (uint16_t)((uint16_t)x << 12) ^ (uint16_t)((uint16_t)x << 5) ^ x);
    }
    return crc;
}

static uint16_t crc_of_bytes(const uint8_t *bytes, uint32_t count, uint16_t crc) {
    pantin_source memory;
    pantin_memory(&memory, bytes, count);
    return crc_of(&memory, 0, count, crc);
}

/* Compares the CRC of the bytes from `position` with the one that is stored at `end`. */
static uint16_t check_crc(pantin_source *s, uint32_t position, uint32_t end, uint16_t crc) {
    crc = crc_of(s, position, end, crc);
    if (byte_at(s, end) != (crc & 0xff) || byte_at(s, end + 1) != crc >> 8) fail(s, PANTIN_ERROR_CRC);
    return crc;
}

/* ---- Fields of files and rigs (1, 2): none may extend past the end ---- */

typedef struct {
    pantin_source *source;
    uint32_t position, end;
} fields;

static fields fields_of(pantin_source *source, uint32_t position, uint32_t end) {
    fields f;
    f.source = source;
    f.position = position;
    f.end = end;
    return f;
}

static uint8_t field(fields *f) {
    if (f->position >= f->end) {
        fail(f->source, PANTIN_ERROR_LENGTH);
        return 0;
    }
    return byte_at(f->source, f->position++);
}

static uint32_t field_varint(fields *f) {
    uint32_t value = 0;
    uint8_t shift = 0, byte;
    do {
        byte = field(f);
        if (shift == 28 && byte > 0x0f) {
            fail(f->source, PANTIN_ERROR_LENGTH);
            byte = 0;
        }
        value |= (uint32_t)(byte & 0x7f) << shift;
        shift = (uint8_t)(shift + 7);
    } while (byte & 0x80);
    return value;
}

static uint32_t unzigzag(uint32_t n) { return (n >> 1) ^ (0u - (n & 1)); }

/* Passes over `count` bytes and returns where they begin. */
static uint32_t skip(fields *f, uint32_t count) {
    uint32_t start = f->position;
    if (count > f->end - f->position) {
        fail(f->source, PANTIN_ERROR_LENGTH);
        count = f->end - f->position;
    }
    f->position += count;
    return start;
}

static void field_name(fields *f, pantin_name *name) {
    uint32_t length = field_varint(f);
    name->source = f->source;
    name->start = skip(f, length);
    name->length = f->position - name->start;
}

/* ---- Names ---- */

uint8_t pantin_name_byte(const pantin_name *name, uint32_t i) {
    if (i >= name->length) return 0;
    return name->source ? byte_at(name->source, name->start + i) : PANTIN_U8(pantin_live_link + name->start + i);
}

/* A name of the list (2): empty beyond its end. */
static void listed_name(pantin_name *name, uint16_t index) {
    const char *list = pantin_live_link;
    uint32_t start = 0, length = 0;
    for (; index > 0 && PANTIN_U8(list + start) != 0; index--) {
        while (PANTIN_U8(list + start) != ' ') start++;
        start++;
    }
    if (PANTIN_U8(list + start) != 0) {
        while (PANTIN_U8(list + start + length) != ' ') length++;
    }
    name->source = NULL;
    name->start = start;
    name->length = length;
}

uint32_t pantin_copy_name(const pantin_name *name, char *into, size_t room) {
    uint32_t i;
    if (room > 0) {
        for (i = 0; i < name->length && i + 1 < room; i++) into[i] = (char)pantin_name_byte(name, i);
        into[i] = 0;
    }
    return name->length;
}

int pantin_name_is(const pantin_name *name, const char *text) {
    uint32_t i;
    if (!text) return 0;
    for (i = 0; i < name->length; i++) {
        if (text[i] == 0 || (uint8_t)text[i] != pantin_name_byte(name, i)) return 0;
    }
    return text[i] == 0;
}

/* ---- Rig (2) ---- */

void pantin_first_joint(pantin_joint *joint, const pantin_rig *rig) {
    memset(joint, 0, sizeof *joint);
    joint->rig = rig;
    joint->next = rig->start;
    joint->index = 0xffff;
}

static int next_joint(pantin_joint *joint) {
    const pantin_rig *rig = joint->rig;
    fields f = fields_of(rig->source, joint->next, rig->end);
    pantin_joint next = *joint;
    uint32_t parent;
    uint8_t head, i;
    next.index = (uint16_t)(joint->index + 1u);
    if (next.index >= rig->joints) return 0;
    head = field(&f);
    parent = field_varint(&f);
    next.first_channel = (uint16_t)(joint->first_channel + joint->channels);
    next.channels = head & 15;
    next.end_site = (head >> 4) & 1;
    next.helper = (head >> 5) & 1;
    next.parent = (uint16_t)(parent - 1);
    if (head > 63 || (next.end_site && next.channels) || parent > next.index || (parent == 0) != (next.index == 0)) {
        fail(rig->source, PANTIN_ERROR_RIG);
    }
    next.kinds = skip(&f, (next.channels + 1u) / 2);
    for (i = 0; i < 3; i++) next.offset[i] = (int32_t)unzigzag(field_varint(&f));
    memset(&next.name, 0, sizeof next.name);
    if (!next.end_site) field_name(&f, &next.name);
    next.next = f.position;
    if (rig->source->error != PANTIN_OK) return 0;
    *joint = next;
    return 1;
}

int pantin_next_joint(pantin_joint *joint) {
    joint->rig->source->error = PANTIN_OK;
    return next_joint(joint);
}

int pantin_find_joint(const pantin_rig *rig, const char *name, pantin_joint *joint) {
    rig->source->error = PANTIN_OK;
    pantin_first_joint(joint, rig);
    while (next_joint(joint)) {
        if (!joint->end_site && pantin_name_is(&joint->name, name)) return 1;
    }
    return 0;
}

uint8_t pantin_joint_kind(const pantin_joint *joint, uint8_t channel) {
    uint8_t pair = byte_at(joint->rig->source, joint->kinds + channel / 2u);
    return channel & 1 ? (uint8_t)(pair >> 4) : (uint8_t)(pair & 15);
}

void pantin_first_scalar(pantin_scalar *scalar, const pantin_rig *rig) {
    memset(scalar, 0, sizeof *scalar);
    scalar->rig = rig;
    scalar->next = rig->scalars_start;
    scalar->index = 0xffff;
    scalar->channel = (uint16_t)(rig->channels - rig->scalars - 1u);
}

static int next_scalar(pantin_scalar *scalar) {
    const pantin_rig *rig = scalar->rig;
    pantin_scalar next = *scalar;
    next.index = (uint16_t)(scalar->index + 1u);
    if (next.index >= rig->scalars) return 0;
    next.channel = (uint16_t)(scalar->channel + 1u);
    if (scalar->listed & 0xff) {
        /* The low byte counts names that follow, the high byte is the index of this one. */
        next.listed = (uint16_t)(scalar->listed + 0x100u - 1u);
        /* An index above 255 has no name either. */
        if (next.listed < 0x100) next.listed = (uint16_t)(next.listed | 0xff00u);
        listed_name(&next.name, next.listed >> 8);
    } else {
        fields f = fields_of(rig->source, scalar->next, rig->end);
        next.exponent = (int8_t)field(&f);
        next.listed = 0;
        if (next.exponent == PANTIN_LISTED) {
            uint8_t first = field(&f), more = field(&f);
            next.listed = (uint16_t)((uint16_t)first << 8 | more);
            next.exponent = (int8_t)field(&f);
            listed_name(&next.name, first);
        } else {
            field_name(&f, &next.name);
        }
        next.next = f.position;
    }
    if (rig->source->error != PANTIN_OK) return 0;
    *scalar = next;
    return 1;
}

int pantin_next_scalar(pantin_scalar *scalar) {
    scalar->rig->source->error = PANTIN_OK;
    return next_scalar(scalar);
}

int pantin_find_scalar(const pantin_rig *rig, const char *name, pantin_scalar *scalar) {
    rig->source->error = PANTIN_OK;
    pantin_first_scalar(scalar, rig);
    while (next_scalar(scalar)) {
        if (pantin_name_is(&scalar->name, name)) return 1;
    }
    return 0;
}

/* Checks a rig whose bytes end at `end`, with the CRC. Errors are left in the source. */
static void check_rig(pantin_rig *rig, pantin_source *source, uint32_t start, uint32_t length) {
    fields f;
    pantin_joint joint;
    pantin_scalar scalar;
    uint32_t joints, scalars, channels, i;
    memset(rig, 0, sizeof *rig);
    rig->source = source;
    if (length < CRC_BYTES) {
        fail(source, PANTIN_ERROR_LENGTH);
        return;
    }
    rig->end = start + length - CRC_BYTES;
    check_crc(source, start, rig->end, CRC_START);
    rig->id = 0x811c9dc5u;
    for (i = start; i < rig->end && source->error == PANTIN_OK; i++) rig->id = (rig->id ^ byte_at(source, i)) * 0x01000193u;
    f = fields_of(source, start, rig->end);
    rig->unit_micro_cm = field_varint(&f);
    rig->offset_exponent = (int8_t)field(&f);
    rig->up = field(&f);
    joints = field_varint(&f);
    scalars = field_varint(&f);
    if (rig->unit_micro_cm == 0 || rig->offset_exponent < -31 || rig->offset_exponent > 31 || rig->up > 6 || (rig->up & 3) == 3 ||
        joints > PANTIN_MAX_JOINTS || scalars > PANTIN_MAX_CHANNELS) {
        fail(source, PANTIN_ERROR_RIG);
    }
    if (source->error != PANTIN_OK) return;
    rig->start = f.position;
    rig->joints = (uint16_t)joints;
    rig->scalars = (uint16_t)scalars;
    channels = scalars;
    pantin_first_joint(&joint, rig);
    while (next_joint(&joint)) {
        uint8_t c;
        for (c = 0; c < joint.channels; c++) {
            if (pantin_joint_kind(&joint, c) >= PANTIN_SCALAR) fail(source, PANTIN_ERROR_RIG);
        }
        channels += joint.channels;
    }
    if (channels > PANTIN_MAX_CHANNELS) fail(source, PANTIN_ERROR_RIG);
    rig->channels = (uint16_t)channels;
    rig->scalars_start = joint.next;
    if (source->error != PANTIN_OK) return;
    pantin_first_scalar(&scalar, rig);
    while (next_scalar(&scalar)) {}
    if (scalar.next != rig->end) fail(source, PANTIN_ERROR_LENGTH);
}

pantin_result pantin_open_rig(pantin_rig *rig, pantin_source *source, uint32_t start, uint32_t length) {
    source->error = PANTIN_OK;
    if (start > source->length || length > source->length - start) return PANTIN_ERROR_LENGTH;
    check_rig(rig, source, start, length);
    return source->error;
}

/* ---- Payload (3) ---- */

static void reader_of(pantin_reader *r, pantin_source *source, uint32_t start, uint32_t end, uint32_t position) {
    r->source = source;
    r->start = start;
    r->end = end - CRC_BYTES;
    r->position = position;
    r->x = 0;
}

static int ended(pantin_reader *r) {
    if (((r->position - r->start) & (BLOCK - 1)) == BLOCK - CRC_BYTES) r->position += CRC_BYTES;
    return r->position >= r->end;
}

/* The next byte, or 0 past the end; then the position is greater than the end. */
static uint8_t next_byte(pantin_reader *r) {
    if (ended(r)) {
        r->position = r->end + 1;
        return 0;
    }
    return byte_at(r->source, r->position++);
}

static uint32_t next_u32(pantin_reader *r) {
    uint32_t value = next_byte(r);
    value |= (uint32_t)next_byte(r) << 8;
    value |= (uint32_t)next_byte(r) << 16;
    return value | (uint32_t)next_byte(r) << 24;
}

static uint32_t next_varint(pantin_reader *r) {
    uint32_t value = 0;
    uint8_t shift = 0, byte;
    do {
        byte = next_byte(r);
        value |= (uint32_t)(byte & 0x7f) << shift;
        shift = (uint8_t)(shift + 7);
    } while ((byte & 0x80) && shift < 35);
    return value;
}

/* Checks the CRCs of blocks from `start` to `end`. */
static uint16_t check_blocks(pantin_source *s, uint32_t start, uint32_t end, uint16_t crc) {
    if (start == end) fail(s, PANTIN_ERROR_LENGTH);
    while (start < end && s->error == PANTIN_OK) {
        uint32_t length = end - start;
        if (length > BLOCK) length = BLOCK;
        if (length < CRC_BYTES) {
            fail(s, PANTIN_ERROR_LENGTH);
        } else {
            crc = check_crc(s, start, start + length - CRC_BYTES, crc);
        }
        start += length;
        if (start < end) crc = CRC_START;
    }
    return crc;
}

/* ---- Clip ---- */

/* Reads what precedes the motion (1). `end` is the end of the clip. */
/* Whether this decoder plays clips of a version (12). */
static int is_known(uint8_t version) {
#ifdef PANTIN_KEYS
    if (version == KEY_VERSION) return 1;
#endif
    return version == PANTIN_VERSION;
}

static void open_front(pantin_clip *clip, pantin_source *source, uint32_t start, uint32_t end, const pantin_rig *rig) {
    fields f = fields_of(source, start, end);
    uint32_t length;
    uint8_t version;
    memset(clip, 0, sizeof *clip);
    clip->source = source;
    if (field(&f) != PANTIN_MAGIC_0 || field(&f) != PANTIN_MAGIC_1) fail(source, PANTIN_ERROR_MAGIC);
    version = field(&f);
    if (!is_known(version)) fail(source, PANTIN_ERROR_VERSION);
    clip->flags = field(&f);
    if (clip->flags & ~KNOWN_FLAGS) fail(source, PANTIN_ERROR_FLAGS);
#ifdef PANTIN_KEYS
    if (version == KEY_VERSION) {
        if (clip->flags & (HAS_EXPONENTIALS | HAS_INDEX)) fail(source, PANTIN_ERROR_FLAGS);
        clip->flags |= PANTIN_KEY_CLIP;
    }
#endif
    if (source->error != PANTIN_OK) return;
    clip->looped = (clip->flags & LOOPED) != 0;
    if (clip->flags & HAS_RIG) {
        length = field_varint(&f);
        start = skip(&f, length);
        if (source->error != PANTIN_OK) return;
        check_rig(&clip->rig, source, start, length);
    } else if (rig) {
        clip->rig = *rig;
    } else {
        fail(source, PANTIN_ERROR_NO_RIG);
    }
    length = field_varint(&f);
    clip->start = f.position;
    clip->end = f.position + length;
    if (length > end - f.position) fail(source, PANTIN_ERROR_LENGTH);
}

/* The CRC of what the first block's CRC covers before the block (3). */
static uint16_t motion_crc(const pantin_clip *clip) {
    uint8_t bytes[8];
    uint32_t length = clip->end - clip->start;
    uint8_t i;
    bytes[0] = PANTIN_MAGIC_0;
    bytes[1] = PANTIN_MAGIC_1;
    bytes[2] = IS_KEYS(clip) ? KEY_VERSION : PANTIN_VERSION;
    bytes[3] = clip->flags & KNOWN_FLAGS;
    for (i = 0; i < 4; i++) bytes[4 + i] = (uint8_t)(length >> (8 * i));
    return crc_of_bytes(bytes, 8, CRC_START);
}

/* Reads the motion's head (4). */
static void open_head(pantin_clip *clip) {
    pantin_source *s = clip->source;
    pantin_reader r;
    pantin_joint joint;
    uint32_t i;
    uint8_t rate;
    reader_of(&r, s, clip->start, clip->end, clip->start);
    rate = next_byte(&r);
    if (rate > 9) {
        fail(s, PANTIN_ERROR_HEAD);
    } else if (rate == 0) {
        clip->frame_time_ns = next_u32(&r);
    } else {
        uint8_t hz = PANTIN_U8(pantin_frame_rates + rate);
        clip->frame_time_ns = (1000000000u + hz / 2u) / hz;
    }
    clip->frames = next_varint(&r);
    clip->exponent = (int8_t)next_byte(&r);
    if (clip->frame_time_ns == 0 || clip->frames == 0 || clip->frames > 0x1000000u || clip->exponent < -63 || clip->exponent > 31) {
        fail(s, PANTIN_ERROR_HEAD);
    }
    if (!(clip->flags & HAS_RIG) && next_u32(&r) != clip->rig.id) fail(s, PANTIN_ERROR_OTHER_RIG);
#ifdef PANTIN_KEYS
    if (IS_KEYS(clip)) {
        uint32_t states = next_varint(&r);
        if (states > PANTIN_MAX_STATES || clip->frames > PANTIN_MAX_KEY_FRAMES) fail(s, PANTIN_ERROR_HEAD);
        clip->states = (uint16_t)states;
    }
#endif
    clip->exponentials = r.position;
    if (clip->flags & HAS_EXPONENTIALS) {
        uint32_t bits = 0;
        pantin_first_joint(&joint, &clip->rig);
        while (next_joint(&joint)) {
            uint8_t c, eulers = 0;
            for (c = 0; c < joint.channels; c++) {
                uint8_t kind = pantin_joint_kind(&joint, c);
                eulers = (uint8_t)(eulers + (kind >= PANTIN_EULER_X && kind <= PANTIN_EULER_Z));
            }
            bits += eulers == 3;
        }
        /* Another number than that of a clip without exponential maps. */
        clip->coding = 0x811c9dc5u;
        for (i = 0; i < bits; i += 8) clip->coding = (clip->coding ^ next_byte(&r)) * 0x01000193u;
    }
    if (clip->flags & HAS_EVENTS) clip->event_count = next_varint(&r);
    clip->events = r.position;
    for (i = 0; i < clip->event_count && s->error == PANTIN_OK; i++) {
        (void)next_varint(&r);
        (void)next_varint(&r);
        if (r.position > r.end) fail(s, PANTIN_ERROR_HEAD);
    }
    clip->symbols = r.position;
    if (clip->rig.source->error != PANTIN_OK) fail(s, clip->rig.source->error);
}

pantin_result pantin_open_at(pantin_clip *clip, pantin_source *source, uint32_t start, uint32_t length, const pantin_rig *rig) {
    uint32_t end = start + length;
    fields f;
    pantin_name name;
    source->error = PANTIN_OK;
    if (rig) rig->source->error = PANTIN_OK;
    if (start > source->length || length > source->length - start) return PANTIN_ERROR_LENGTH;
    open_front(clip, source, start, end, rig);
    if (source->error != PANTIN_OK) return source->error;
    clip->crc = check_blocks(source, clip->start, clip->end, motion_crc(clip));
    if (source->error != PANTIN_OK) return source->error;
    open_head(clip);
    f = fields_of(source, clip->end, end);
    if (clip->flags & HAS_INDEX) {
        uint8_t bytes[4], i;
        length = field_varint(&f);
        for (i = 0; i < 4; i++) bytes[i] = (uint8_t)(length >> (8 * i));
        clip->index = skip(&f, length);
        clip->index_end = f.position;
        if (source->error != PANTIN_OK) return source->error;
        check_blocks(source, clip->index, clip->index_end, crc_of_bytes(bytes, 4, clip->crc));
    }
    if (clip->flags & HAS_EVENT_NAMES) {
        length = field_varint(&f);
        if (length < CRC_BYTES) fail(source, PANTIN_ERROR_LENGTH);
        clip->names = skip(&f, length);
        clip->names_end = f.position - CRC_BYTES;
        if (source->error != PANTIN_OK) return source->error;
        check_crc(source, clip->names, clip->names_end, CRC_START);
    }
    if (f.position != end && !(clip->flags & HAS_SECTIONS)) fail(source, PANTIN_ERROR_LENGTH);
    f = fields_of(source, clip->names, clip->names_end);
    while (f.position < f.end && source->error == PANTIN_OK) field_name(&f, &name);
    return source->error;
}

pantin_result pantin_open(pantin_clip *clip, pantin_source *source, const pantin_rig *rig) {
    return pantin_open_at(clip, source, 0, source->length, rig);
}

int pantin_joint_is_exponential(const pantin_clip *clip, const pantin_joint *joint) {
    pantin_joint other;
    pantin_reader r;
    uint8_t bits = 0, n = 0, is = 0;
    if (!(clip->flags & HAS_EXPONENTIALS)) return 0;
    clip->source->error = clip->rig.source->error = PANTIN_OK;
    reader_of(&r, clip->source, clip->start, clip->end, clip->exponentials);
    pantin_first_joint(&other, &clip->rig);
    while (other.index != joint->index && next_joint(&other)) {
        uint8_t c, eulers = 0;
        for (c = 0; c < other.channels; c++) {
            uint8_t kind = pantin_joint_kind(&other, c);
            eulers = (uint8_t)(eulers + (kind >= PANTIN_EULER_X && kind <= PANTIN_EULER_Z));
        }
        is = 0;
        if (eulers == 3) {
            if ((n++ & 7) == 0) bits = next_byte(&r);
            is = bits & 1;
            bits = (uint8_t)(bits >> 1);
        }
    }
    return is;
}

void pantin_first_event(pantin_event *event, const pantin_clip *clip) {
    memset(event, 0, sizeof *event);
    event->clip = clip;
    event->next = clip->events;
    event->left = clip->event_count;
}

int pantin_next_event(pantin_event *event) {
    const pantin_clip *clip = event->clip;
    pantin_reader r;
    uint32_t frames, id;
    if (event->left == 0) return 0;
    clip->source->error = PANTIN_OK;
    reader_of(&r, clip->source, clip->start, clip->end, event->next);
    frames = next_varint(&r);
    id = next_varint(&r);
    if (clip->source->error != PANTIN_OK) return 0;
    event->frame += frames;
    event->id = id;
    event->next = r.position;
    event->left--;
    return 1;
}

pantin_result pantin_find_event(const pantin_clip *clip, const char *name, uint32_t *id) {
    fields f = fields_of(clip->source, clip->names, clip->names_end);
    clip->source->error = PANTIN_OK;
    for (*id = 0; f.position < f.end && clip->source->error == PANTIN_OK; ++*id) {
        pantin_name own;
        field_name(&f, &own);
        if (own.length && pantin_name_is(&own, name)) return PANTIN_OK;
    }
    return clip->source->error != PANTIN_OK ? clip->source->error : PANTIN_NOT_FOUND;
}

int pantin_event_name(const pantin_clip *clip, uint32_t id, pantin_name *name) {
    fields f = fields_of(clip->source, clip->names, clip->names_end);
    clip->source->error = PANTIN_OK;
    while (f.position < f.end && clip->source->error == PANTIN_OK) {
        field_name(&f, name);
        if (id-- == 0) return name->length != 0;
    }
    return 0;
}

/* ---- Symbols (5) ---- */

static void refill(pantin_reader *r) {
    while (r->x < LOW) r->x = r->x << 8 | next_byte(r);
}

static uint8_t symbol(pantin_reader *r, const uint16_t *sizes) {
    unsigned low = (unsigned)(r->x & 4095), size;
    uint8_t s = 0;
    while (low >= (size = PANTIN_U16(sizes + s))) {
        low -= size;
        s++;
    }
    r->x = size * (r->x >> 8 >> 4) + low;
    refill(r);
    return s;
}

static uint32_t bits(pantin_reader *r, uint8_t n) {
    uint32_t value = 0;
    uint8_t shift = 0;
    while (n > 0) {
        uint8_t part = n > 8 ? 8 : n;
        value |= (r->x & ((1u << part) - 1)) << shift;
        r->x >>= part;
        refill(r);
        shift = (uint8_t)(shift + 8);
        n = (uint8_t)(n - part);
    }
    return value;
}

static uint32_t magnitude(pantin_reader *r, const uint16_t *sizes) {
    uint8_t b = symbol(r, sizes);
    uint32_t value;
    if (b == 0) return 0;
    value = ((uint32_t)1 << (b - 1)) + bits(r, (uint8_t)(b - 1));
    return bits(r, 1) ? 0u - value : value;
}

/* x from three bytes, the most significant first, or the smallest state. */
static void first_state(pantin_reader *r) {
    uint8_t i;
    r->x = 0;
    for (i = 0; i < 3; i++) r->x = r->x << 8 | next_byte(r);
    if (r->x < LOW) r->x = LOW;
}

/* ---- Channel starts (7, 8) ---- */

static uint32_t mantissa(uint8_t step) { return step & 1 ? 3 : 2; }

static uint32_t channel_step(uint8_t step, uint8_t shift) {
    uint32_t s = ((mantissa(step) << (step >> 1)) >> 1) >> shift;
    return s ? s : 1;
}

/* W or K of a step index (7), from a quotient of STEPS. */
static uint32_t segment_unit(uint8_t step, uint8_t quotient) {
    return (mantissa(step) * PANTIN_U32(pantin_steps + quotient)) >> (30 - (step >> 1)) | 1;
}

/* An offset axis in the clip's units (8). */
static int32_t rest_value(const pantin_clip *clip, int32_t offset) {
    int8_t d = (int8_t)(clip->rig.offset_exponent - clip->exponent);
    if (d >= 0) return (int32_t)((uint32_t)offset << (d & 31));
    d = (int8_t)-d;
    if (d > 31) d = 31;
    return offset < 0 ? ~(~offset >> d) : offset >> d;
}

static void start_channel(pantin_player *p, uint8_t kind, int32_t rest) {
    pantin_reader *r = &p->reader;
    uint8_t class_ = kind < PANTIN_EULER_X;
    uint8_t status = symbol(
        r, pantin_status[PANTIN_U8(pantin_status_in + 16 * class_ + 4 * p->last_status + p->last_of_kind[kind])]);
    uint8_t step = p->last_step[class_], leader = 0;
    uint32_t position = (uint32_t)rest, velocity = 0;
    uint16_t m = p->moving_count;
    if (status == FOLLOWS) {
        leader = (uint8_t)(bits(r, 5) + 1);
        if (leader > m) {
            leader = NO_LEADER;
        } else if (m < p->moving_room) {
            const pantin_channel *of = &p->moving[m - leader];
            position = p->starts_alone ? of->w : (uint32_t)p->pose[of->channel];
            velocity = of->v;
        }
    } else if (status != RESTS) {
        uint8_t c = symbol(r, pantin_step_change);
        step = (uint8_t)(c < 24 ? step + (uint8_t)unzigzag(c) : bits(r, 6));
        if (step > 59) step = 59;
        position = magnitude(r, pantin_position) * channel_step(step, 1);
        if (status == MOVES) velocity = magnitude(r, pantin_velocity) * channel_step(step, 2);
    }
    if (r->source->error != PANTIN_OK) return;
    if (!p->starts_alone) p->pose[p->resume] = (int32_t)position;
    if (status >= MOVES) {
        if (m < p->moving_room && p->starts_alone) {
            p->moving[m].w = position;
            p->moving[m].k = 0;
        } else if (m < p->moving_room) {
            pantin_channel *c = &p->moving[m];
            memset(c, 0, sizeof *c);
            c->v = velocity;
            c->channel = p->resume;
            c->leader = leader;
            c->step = step;
            c->mode = PANTIN_START_MODE;
        }
        p->moving_count++;
    }
    p->last_step[class_] = step;
    p->last_status = status;
    p->last_of_kind[kind] = status;
    p->resume++;
}

/* Kind and offset of the channel to go on with; the offset is 0 unless it is a position. */
static pantin_result channel_at(pantin_player *p, uint8_t *kind, int32_t *offset) {
    const pantin_rig *rig = &p->clip->rig;
    *kind = PANTIN_SCALAR;
    *offset = 0;
    if (p->resume < rig->channels - rig->scalars) {
        while (p->resume >= p->joint.first_channel + p->joint.channels) {
            if (!next_joint(&p->joint)) return PANTIN_ERROR_READ;
        }
        *kind = pantin_joint_kind(&p->joint, (uint8_t)(p->resume - p->joint.first_channel));
        if (rig->source->error != PANTIN_OK) return rig->source->error;
        /* The file may have changed since it was checked. */
        if (*kind >= PANTIN_SCALAR) return PANTIN_ERROR_RIG;
        if (*kind < PANTIN_EULER_X) *offset = p->joint.offset[*kind];
    }
    return PANTIN_OK;
}

#ifdef PANTIN_KEYS
uint8_t pantin_keys_byte(pantin_reader *reader) { return next_byte(reader); }

pantin_result pantin_keys_channel(pantin_player *player, pantin_key_channel *channel) {
    pantin_result result = channel_at(player, &channel->kind, &channel->offset);
    channel->rest = rest_value(player->clip, channel->offset);
    return result;
}
#endif

pantin_result pantin_continue(pantin_player *p) {
    const pantin_clip *clip = p->clip;
    const pantin_rig *rig = &clip->rig;
    pantin_source *s = clip->source;
    if (!p->pose) return PANTIN_NO_ROOM;
    s->error = rig->source->error = PANTIN_OK;
#ifdef PANTIN_KEYS
    if (IS_KEYS(clip)) return pantin_keys_start(p);
#endif
    if (p->reader.x == 0) {
        pantin_reader before = p->reader;
        first_state(&p->reader);
        if (s->error != PANTIN_OK) p->reader = before;
    }
    while (s->error == PANTIN_OK && p->resume < rig->channels) {
        pantin_reader before = p->reader;
        uint8_t kind;
        int32_t offset;
        pantin_result result = channel_at(p, &kind, &offset);
        if (result != PANTIN_OK) return result;
        start_channel(p, kind, rest_value(clip, offset));
        if (s->error != PANTIN_OK) p->reader = before;
        s->done = p->reader.position;
    }
    if (s->error != PANTIN_OK) return s->error;
    p->resume = 0;
    p->started = 1;
    return p->moving_count > p->moving_room ? PANTIN_NO_ROOM : PANTIN_OK;
}

pantin_result pantin_restart(pantin_player *p) {
    const pantin_clip *clip = p->clip;
    p->frame = 0;
    p->moving_count = 0;
    p->resume = 0;
    p->started = 0;
    p->last_status = 0;
    p->last_step[0] = p->last_step[1] = PANTIN_FIRST_STEP;
    memset(p->last_of_kind, 0, sizeof p->last_of_kind);
    reader_of(&p->reader, clip->source, clip->start, clip->end, clip->symbols);
    pantin_first_joint(&p->joint, &clip->rig);
    return pantin_continue(p);
}

pantin_result pantin_keep_starts(const pantin_player *player) {
    pantin_player starts = *player;
#ifdef PANTIN_KEYS
    if (IS_KEYS(player->clip)) {
        pantin_keys_starts(player);
        return PANTIN_OK;
    }
#endif
    starts.starts_alone = 1;
    return pantin_restart(&starts);
}

pantin_result pantin_start(pantin_player *player, const pantin_clip *clip, int32_t *pose, size_t pose_room, pantin_channel *moving,
                           size_t moving_room) {
    memset(player, 0, sizeof *player);
    player->clip = clip;
    if (pose_room < clip->rig.channels) return PANTIN_NO_ROOM;
    player->pose = pose;
    player->moving = moving;
    player->moving_room = (uint16_t)(moving_room > MAX_MOVING ? MAX_MOVING : moving_room);
    return pantin_restart(player);
}

/* ---- Segments (9) ---- */

/* A number in the context of (slope, now, prev_sign, unit), times unit. Leaves the observed sign in prev_sign. */
static uint32_t number(pantin_reader *r, uint8_t slope, uint32_t now, int8_t *prev_sign, uint32_t unit, uint8_t length_class) {
    uint8_t negative_now = now >> 31 != 0;
    uint32_t size = negative_now ? 0u - now : now;
    uint8_t a = size < (unit + 1) >> 1 ? 0 : size < 2 * unit ? 1 : size >> 1 < 3 * unit ? 2 : 3;
    uint8_t flipped = a == 0 ? *prev_sign < 0 : negative_now;
    int8_t g = (int8_t)(flipped ? -*prev_sign : *prev_sign);
    uint8_t context = (uint8_t)(((4 * slope + length_class) * 4 + a) * 3 + g + 1);
    uint8_t s = symbol(r, pantin_number[PANTIN_U8(pantin_number_in + context)]);
    uint8_t index = (uint8_t)((s + 1) / 2);
    uint32_t value = index;
    *prev_sign = (int8_t)(a == 0 ? 0 : negative_now ? -1 : 1);
    if (index == 13) {
        uint8_t n = symbol(r, pantin_far);
        value = 132 + ((uint32_t)1 << n) + bits(r, n);
    } else if (index > 6) {
        uint8_t n = (uint8_t)(index - 6);
        value = 5 + ((uint32_t)1 << n) + bits(r, n);
    }
    value *= unit;
    return (s & 1) != flipped ? 0u - value : value;
}

static void read_segment(pantin_player *p, pantin_channel *c) {
    pantin_reader *r = &p->reader;
    uint8_t length, length_class, type;
    uint8_t mode = symbol(r, pantin_mode[PANTIN_U8(pantin_mode_after + c->mode)]);
    if (mode == 32) {
        mode = (uint8_t)(32 + symbol(r, pantin_mode[PANTIN_U8(pantin_mode_after + 64)]));
        if (mode > 62) mode = 62;
    }
    c->mode = mode;
    type = mode >> 4;
    length = mode & 15;
    length_class = (uint8_t)(length < 3 ? (length + 1) / 2 : length < 7 ? 2 : 3);
    c->left = PANTIN_U8(pantin_lengths + length);
    if (type == 0 || type == 2) c->w = number(r, 0, c->w, &c->prev_sign, segment_unit(c->step, length), length_class);
    if (type == 0) {
        c->k = 0;
    } else if (type != CARRY) {
        int8_t none = 0;
        c->k = number(r, 1, c->k, &none, segment_unit(c->step, (uint8_t)(16 + length)), length_class);
    }
}

/* Copies what the leader has just read. A channel whose leader does not exist never moves. */
static void follow(pantin_channel *c) {
    if (c->leader != NO_LEADER) {
        const pantin_channel *leader = c - c->leader;
        c->w = leader->w;
        c->k = leader->k;
        c->mode = leader->mode;
        c->left = leader->left;
    }
}

pantin_result pantin_step(pantin_player *p) {
    pantin_source *s = p->clip->source;
    pantin_channel *c;
    uint16_t i;
    if (!p->started || p->moving_count > p->moving_room) return PANTIN_NO_ROOM;
    if (p->frame + 1 >= p->clip->frames) return PANTIN_END;
#ifdef PANTIN_KEYS
    if (IS_KEYS(p->clip)) {
        pantin_keys_step(p);
        return PANTIN_OK;
    }
#endif
    if (p->frame + 2 < p->clip->frames) {
        s->error = PANTIN_OK;
        for (; p->resume < p->moving_count; p->resume++) {
            c = &p->moving[p->resume];
            if (c->left != 0) continue;
            if (c->leader == 0) {
                pantin_reader reader = p->reader;
                pantin_channel before = *c;
                read_segment(p, c);
                if (s->error != PANTIN_OK) {
                    *c = before;
                    p->reader = reader;
                    return s->error;
                }
                s->done = p->reader.position;
            } else {
                follow(c);
            }
        }
        p->resume = 0;
    }
    for (i = 0; i < p->moving_count; i++) {
        c = &p->moving[i];
        p->pose[c->channel] = (int32_t)((uint32_t)p->pose[c->channel] + c->v);
        c->v += c->w;
        c->w += c->k;
        c->left--;
    }
    p->frame++;
    return PANTIN_OK;
}

/* ---- Seeking (10, 14) ---- */

/* Goes to the last snapshot at or before `frame`, if there is one. Returns 1 if it did. */
static int to_snapshot(pantin_player *p, uint32_t frame) {
    const pantin_clip *clip = p->clip;
    pantin_reader r;
    uint32_t spacing, count, at, j;
    uint16_t i;
    if (!clip->index || clip->frames < 3) return 0;
    reader_of(&r, clip->source, clip->index, clip->index_end, clip->index);
    spacing = next_varint(&r);
    count = next_varint(&r);
    if (spacing == 0) return 0;
    j = frame / spacing;
    if (j > count) j = count;
    if (j == 0 || (j * spacing <= p->frame && p->frame <= frame)) return 0;
    p->frame = j * spacing;
    at = clip->index;
    while (j-- > 0) at += next_varint(&r);
    if (at < clip->index || at > clip->index_end) at = clip->index_end;
    r.position = at;
    at = next_varint(&r);
    if (at > clip->end - clip->start) at = clip->end - clip->start;
    p->reader.position = clip->start + at;
    first_state(&r);
    p->reader.x = r.x;
    for (i = 0; i < p->moving_count; i++) {
        pantin_channel *c = &p->moving[i];
        uint8_t state = next_byte(&r);
        c->mode = state & 63;
        if (c->mode > 62 && c->leader != NO_LEADER) c->mode = 62;
        c->prev_sign = (int8_t)((state >> 6) - 1);
        if (c->prev_sign > 1) c->prev_sign = 1;
        c->left = next_byte(&r);
        p->pose[c->channel] = (int32_t)unzigzag(next_varint(&r));
        c->v = unzigzag(next_varint(&r));
        c->w = unzigzag(next_varint(&r));
        c->k = c->mode >> 4 ? unzigzag(next_varint(&r)) : 0;
    }
    p->resume = 0;
    return 1;
}

pantin_result pantin_seek(pantin_player *p, uint32_t frame) {
    pantin_result result = PANTIN_OK;
    pantin_source *s = p->clip->source;
    if (!p->started || p->moving_count > p->moving_room) return PANTIN_NO_ROOM;
    if (frame >= p->clip->frames) return PANTIN_NOT_FOUND;
    s->error = PANTIN_OK;
#ifdef PANTIN_KEYS
    if (IS_KEYS(p->clip)) {
        pantin_keys_seek(p, frame);
        return PANTIN_OK;
    }
#endif
    if (!to_snapshot(p, frame) && s->error == PANTIN_OK && frame < p->frame) result = pantin_restart(p);
    if (s->error != PANTIN_OK) {
        /* A snapshot that was read in part is of no use. */
        p->started = 0;
        return s->error;
    }
    while (result == PANTIN_OK && p->frame < frame) result = pantin_step(p);
    return result;
}

pantin_result pantin_step_back(pantin_player *p) { return p->frame == 0 ? PANTIN_END : pantin_seek(p, p->frame - 1); }

int16_t pantin_centidegrees(int32_t raw) {
    /* The upper half of raw, which may be negative, and the lower one, each times 36000. */
    int32_t sum = (raw < 0 ? ~(~raw >> 16) : raw >> 16) * 36000 + (int32_t)(((uint32_t)raw & 0xffffu) * 36000u >> 16) + 32768;
    return (int16_t)(sum < 0 ? ~(~sum >> 16) : sum >> 16);
}

/* ---- Bank (16) ---- */

static int next_entry(pantin_entry *entry);

pantin_result pantin_open_bank(pantin_bank *bank, pantin_source *source) {
    fields f = fields_of(source, 0, source->length);
    pantin_entry entry;
    uint32_t start[4], length[4], total = 0;
    uint8_t seen = 0;
    memset(bank, 0, sizeof *bank);
    bank->source = source;
    source->error = PANTIN_OK;
    if (field(&f) != 'P' || field(&f) != 'b') fail(source, PANTIN_ERROR_MAGIC);
    if (!is_known(field(&f))) fail(source, PANTIN_ERROR_VERSION);
    while (f.position < f.end && source->error == PANTIN_OK) {
        uint8_t type = field(&f);
        uint32_t bytes = field_varint(&f), at = skip(&f, bytes);
        if (type >= 1 && type <= 3) {
            if (seen & 1 << type) fail(source, PANTIN_ERROR_BANK);
            seen = (uint8_t)(seen | 1 << type);
            start[type] = at;
            length[type] = bytes;
        }
    }
    if (source->error != PANTIN_OK) return source->error;
    if (seen != 14 || length[2] < CRC_BYTES) return PANTIN_ERROR_BANK;
    check_rig(&bank->rig, source, start[1], length[1]);
    bank->contents = start[2];
    bank->contents_end = start[2] + length[2] - CRC_BYTES;
    bank->clips_start = start[3];
    check_crc(source, bank->contents, bank->contents_end, CRC_START);
    pantin_first_entry(&entry, bank);
    while (next_entry(&entry)) {
        if (entry.name.length == 0 || entry.length > length[3] - total) fail(source, PANTIN_ERROR_BANK);
        total += entry.length;
        bank->clips++;
    }
    if (bank->clips == 0 || total != length[3]) fail(source, PANTIN_ERROR_BANK);
    return source->error;
}

uint8_t pantin_byte(pantin_source *source, uint32_t position) { return byte_at(source, position); }

pantin_result pantin_find_section(const pantin_bank *bank, uint8_t type, uint32_t *start, uint32_t *end) {
    pantin_source *source = bank->source;
    fields f = fields_of(source, 3, source->length);
    uint8_t seen = 0;
    source->error = PANTIN_OK;
    while (f.position < f.end && source->error == PANTIN_OK) {
        uint8_t own = field(&f);
        uint32_t bytes = field_varint(&f), at = skip(&f, bytes);
        if (own != type) continue;
        if (seen) return PANTIN_ERROR_BANK;
        seen = 1;
        *start = at;
        *end = at + bytes;
    }
    if (source->error != PANTIN_OK) return source->error;
    if (!seen) return PANTIN_NOT_FOUND;
    if (*end - *start < CRC_BYTES) return PANTIN_ERROR_LENGTH;
    *end -= CRC_BYTES;
    check_crc(source, *start, *end, CRC_START);
    return source->error;
}

void pantin_first_entry(pantin_entry *entry, const pantin_bank *bank) {
    memset(entry, 0, sizeof *entry);
    entry->bank = bank;
    entry->next = bank->contents;
    entry->start = bank->clips_start;
}

static int next_entry(pantin_entry *entry) {
    const pantin_bank *bank = entry->bank;
    fields f = fields_of(bank->source, entry->next, bank->contents_end);
    if (f.position >= f.end || bank->source->error != PANTIN_OK) return 0;
    entry->start += entry->length;
    field_name(&f, &entry->name);
    entry->length = field_varint(&f);
    entry->next = f.position;
    return bank->source->error == PANTIN_OK;
}

int pantin_next_entry(pantin_entry *entry) {
    entry->bank->source->error = PANTIN_OK;
    return next_entry(entry);
}

pantin_result pantin_open_entry(pantin_clip *clip, const pantin_entry *entry) {
    const pantin_bank *bank = entry->bank;
    pantin_result result = pantin_open_at(clip, bank->source, entry->start, entry->length, &bank->rig);
    return result == PANTIN_OK && (clip->flags & HAS_RIG) ? PANTIN_ERROR_BANK : result;
}

pantin_result pantin_open_named(pantin_clip *clip, const pantin_bank *bank, const char *name) {
    pantin_entry entry;
    bank->source->error = PANTIN_OK;
    pantin_first_entry(&entry, bank);
    while (next_entry(&entry)) {
        if (pantin_name_is(&entry.name, name)) return pantin_open_entry(clip, &entry);
    }
    return bank->source->error != PANTIN_OK ? bank->source->error : PANTIN_NOT_FOUND;
}

/* ---- Stream ---- */

/* The window is the kept part of the file, or the checked bytes of the part that slides. */
static pantin_result load_stream(pantin_source *source, uint32_t position) {
    pantin_stream *s = (pantin_stream *)(void *)source;
    if (position < s->kept) {
        source->window = s->memory;
        source->window_start = 0;
        source->window_length = s->kept;
    } else if (position < s->slide) {
        return PANTIN_ERROR_READ;
    } else {
        source->window = s->memory + s->kept;
        source->window_start = s->slide;
        source->window_length = s->checked - s->slide;
    }
    return position < s->checked ? PANTIN_OK : PANTIN_NEED_MORE;
}

void pantin_open_stream(pantin_stream *s, uint8_t *memory, uint32_t size, const pantin_rig *rig) {
    memset(s, 0, sizeof *s);
    s->source.load = load_stream;
    s->source.length = 0xffffffffu;
    s->memory = memory;
    s->size = size;
    s->rig = rig;
}

/* Makes use of what has arrived. */
static void advance(pantin_stream *s) {
    pantin_source *source = &s->source;
    pantin_clip *clip = &s->clip;
    source->window_length = 0;
    if (s->rig) s->rig->source->error = PANTIN_OK;
    if (!s->motion) {
        s->checked = s->received;
        source->error = PANTIN_OK;
        open_front(clip, source, 0, source->length, s->rig);
        if (source->error == PANTIN_NEED_MORE) return;
        s->checked = s->motion = clip->start;
        if (source->error == PANTIN_OK && clip->end == clip->start) source->error = PANTIN_ERROR_LENGTH;
    }
    source->error = s->result = source->error == PANTIN_NEED_MORE ? PANTIN_OK : source->error;
    while (s->result == PANTIN_OK && s->checked < clip->end) {
        uint32_t block = clip->end - s->checked, start = s->checked;
        if (block > BLOCK) block = BLOCK;
        if (s->received - s->checked < block) break;
        s->checked += block;
        source->window_length = 0;
        source->error = PANTIN_OK;
        check_blocks(source, start, s->checked, start == s->motion ? motion_crc(clip) : CRC_START);
        if (source->error != PANTIN_OK) s->checked = start;
        s->result = source->error;
        source->window_length = 0;
        if (!s->opened && s->result == PANTIN_OK) {
            open_head(clip);
            if (source->error == PANTIN_OK) {
                s->opened = 1;
                source->done = s->kept = s->slide = s->checked;
                if (s->checked < clip->end && s->size - s->kept < PANTIN_STREAM_BYTES) s->result = PANTIN_NO_ROOM;
            } else if (source->error != PANTIN_NEED_MORE) {
                s->result = source->error;
            }
        }
    }
}

uint32_t pantin_push(pantin_stream *s, const uint8_t *bytes, uint32_t count) {
    uint32_t taken = 0;
    while (taken < count && s->result == PANTIN_OK) {
        uint32_t part = count - taken, used, room;
        if (s->motion && s->received >= s->clip.end) return count;
        if (s->opened && s->source.done > s->slide) {
            uint32_t past = s->source.done - s->slide;
            if (past > s->checked - s->slide) past = s->checked - s->slide;
            memmove(s->memory + s->kept, s->memory + s->kept + past, s->received - s->slide - past);
            s->slide += past;
            s->source.window_length = 0;
        }
        used = s->kept + (s->received - s->slide);
        room = s->size - used;
        if (part > room) part = room;
        if (s->motion && part > s->clip.end - s->received) part = s->clip.end - s->received;
        if (part == 0) {
            if (!s->opened) s->result = PANTIN_NO_ROOM;
            break;
        }
        memcpy(s->memory + used, bytes + taken, part);
        s->received += part;
        taken += part;
        advance(s);
    }
    return taken;
}
