/* Decoder of Pantin clips (.ptn) and banks (.ptb): character motion for small machines.
 *
 * The decoder allocates nothing, uses no floating point and needs only stdint.h, stddef.h and string.h. The caller lends all memory.
 * Bytes may come from anywhere: malformed bytes give a result other than PANTIN_OK, never a crash and never an endless loop.
 * The format is described in FORMAT.md of the project; section numbers in these comments refer to it.
 *
 *     pantin_source source;
 *     pantin_clip clip;
 *     pantin_player player;
 *     pantin_channel moving[21];
 *     int32_t pose[22];
 *
 *     pantin_memory(&source, walk, sizeof walk);
 *     if (pantin_open(&clip, &source, NULL) == PANTIN_OK &&
 *         pantin_start(&player, &clip, pose, 22, moving, 21) == PANTIN_OK) {
 *         do { show(pose); } while (pantin_step(&player) == PANTIN_OK);
 *     }
 *
 * With PANTIN_KEYS defined for all files (compile pantin_keys.c too), it plays key clips as well: version 2 of the format. Without it they are
 * PANTIN_ERROR_VERSION.
 *
 * A structure that is lent must not be moved or changed while another one refers to it: a clip refers to its source, a player to its clip,
 * pose and moving channels. Fields of structures may be read; only the functions change them.
 *
 * Pointers must not be NULL unless a comment says that they may be, and a structure must have been opened before another function takes it. A
 * name that is NULL is the name of nothing: functions that look for it do not find it.
 */
#ifndef PANTIN_H
#define PANTIN_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a function returns. */
typedef enum pantin_result {
    PANTIN_OK = 0,
    PANTIN_END,            /* there is no further frame: the player is at the last one */
    PANTIN_NEED_MORE,      /* of a stream: bytes that have not arrived are needed; push them and call again */
    PANTIN_NO_ROOM,        /* memory that the caller lends is too small */
    PANTIN_NOT_FOUND,      /* no such name, or the index of a clip or the number of a frame is out of range */
    PANTIN_ERROR_READ,     /* the caller's read function failed, or a stream no longer holds the bytes; the call may be repeated */
    PANTIN_ERROR_MAGIC,    /* this is not a clip (or not a bank) */
    PANTIN_ERROR_VERSION,  /* another version of the format */
    PANTIN_ERROR_FLAGS,    /* unknown flags */
    PANTIN_ERROR_LENGTH,   /* a field extends past the end, a number exceeds 32 bits, or bytes are left over */
    PANTIN_ERROR_CRC,      /* damaged bytes */
    PANTIN_ERROR_RIG,      /* a value of the rig is out of its bounds */
    PANTIN_ERROR_NO_RIG,   /* the clip has no rig and none was supplied */
    PANTIN_ERROR_OTHER_RIG, /* the clip is of another rig than the one supplied */
    PANTIN_ERROR_HEAD,     /* a value of the motion's head is out of its bounds; or what was passed has not been opened or set up */
    PANTIN_ERROR_BANK,     /* the sections of a bank contradict each other */
    PANTIN_ERROR_MACHINE,  /* the table of a state machine contradicts itself or the bank */
    PANTIN_UNSUPPORTED     /* the bank has what this function cannot play: pantin_animator.h lists it */
} pantin_result;

/* Kinds of channels (section 2). */
enum {
    PANTIN_POSITION_X = 0, PANTIN_POSITION_Y, PANTIN_POSITION_Z,
    PANTIN_EULER_X = 3, PANTIN_EULER_Y, PANTIN_EULER_Z,
    PANTIN_QUATERNION_W = 6, PANTIN_QUATERNION_X, PANTIN_QUATERNION_Y, PANTIN_QUATERNION_Z,
    PANTIN_EXPONENTIAL_X = 10, PANTIN_EXPONENTIAL_Y, PANTIN_EXPONENTIAL_Z,
    PANTIN_SCALAR = 13
};

#define PANTIN_MAX_CHANNELS 1023
#define PANTIN_MAX_JOINTS 1023

/* ---- Sources: where bytes come from ------------------------------------------------------------------------------------------------- */

/* A file of `length` bytes that is read through a window. `load` moves the window so that it contains `position`. */
typedef struct pantin_source pantin_source;
struct pantin_source {
    const uint8_t *window;
    uint32_t window_start;  /* position of window[0] in the file */
    uint32_t window_length; /* bytes */
    uint32_t length;        /* bytes of the file */
    pantin_result (*load)(pantin_source *source, uint32_t position);
    uint32_t done;          /* a player no longer needs the bytes of the motion before this position */
    pantin_result error;    /* the first error since the last call began */
    pantin_result failed;   /* the first result of `load` that was not PANTIN_OK since somebody cleared this */
};

/* A source whose `length` bytes are all in memory (on AVR and ESP8266: in RAM). */
void pantin_memory(pantin_source *source, const uint8_t *bytes, uint32_t length);

/* Reads `count` bytes from `position` of a file into `into`. Returns 0 if it succeeded. `count` is at least 1, and all bytes are within the
 * file. */
typedef int (*pantin_read)(void *context, uint32_t position, uint8_t *into, uint16_t count);

/* A source that is read in pages, from flash that has no addresses, an EEPROM, a card. */
typedef struct pantin_pages {
    pantin_source source; /* pass a pointer to this member to the functions that take a source */
    pantin_read read;
    void *context;
    uint8_t *page;
    uint16_t page_size;
} pantin_pages;

/* A source of `length` bytes that `read` supplies. `page` lends `page_size` bytes, at least 1; 128 suit well. */
void pantin_paged(pantin_pages *pages, uint32_t length, pantin_read read, void *context, uint8_t *page, uint16_t page_size);

#if defined(__AVR__) || defined(ESP8266)
/* A `pantin_read` for program memory: `context` is the address of the first byte there (an array declared with PROGMEM). */
int pantin_read_progmem(void *context, uint32_t position, uint8_t *into, uint16_t count);
#endif

/* ---- Names -------------------------------------------------------------------------------------------------------------------------- */

/* A name in a file: UTF-8, not terminated, not checked. */
typedef struct pantin_name {
    pantin_source *source; /* NULL: a name of the list that the decoder contains, or the empty name */
    uint32_t start;
    uint32_t length; /* bytes */
} pantin_name;

/* Copies a name into `into`, which has `room` bytes, and appends a 0. A longer name is cut. Returns the name's whole length in bytes. */
uint32_t pantin_copy_name(const pantin_name *name, char *into, size_t room);

/* Returns byte `i` of a name, or 0 after its end. */
uint8_t pantin_name_byte(const pantin_name *name, uint32_t i);

/* Returns 1 if the name equals `text`, otherwise 0. */
int pantin_name_is(const pantin_name *name, const char *text);

/* ---- Rig ---------------------------------------------------------------------------------------------------------------------------- */

/* A figure: joints, their channels, scalars (section 2). */
typedef struct pantin_rig {
    pantin_source *source;
    uint32_t unit_micro_cm; /* length of the source's unit of length in 10^-6 cm, at least 1 */
    uint32_t id;
    uint32_t start, end;    /* positions of the joints' first byte and of the CRC */
    uint32_t scalars_start; /* position of the scalars' first byte */
    uint16_t joints;        /* with End Sites */
    uint16_t scalars;
    uint16_t channels;      /* of joints and scalars: values of a pose */
    int8_t offset_exponent; /* offsets are in 2^offset_exponent units */
    uint8_t up;             /* bits 0 and 1: the vertical axis, 0 to 2 for x, y, z; bit 2: up is its negative direction */
} pantin_rig;

/* Opens the rig of `length` bytes at `start` of `source`, and checks it. For a rig in a file of its own, `start` is 0 and `length` the
 * length of the file. */
pantin_result pantin_open_rig(pantin_rig *rig, pantin_source *source, uint32_t start, uint32_t length);

#define PANTIN_NO_PARENT 0xffffu

/* A joint, and the place in the rig from which to go on to the next one. */
typedef struct pantin_joint {
    const pantin_rig *rig;
    uint32_t next, kinds;   /* positions in the rig's source */
    pantin_name name;       /* empty for an End Site */
    int32_t offset[3];      /* position in its parent, in 2^offset_exponent units */
    uint16_t index;
    uint16_t parent;        /* index, or PANTIN_NO_PARENT */
    uint16_t first_channel; /* index of its first value in a pose */
    uint8_t channels;       /* 0 to 15 */
    uint8_t end_site;       /* 1 if it only marks the end of a bone */
    uint8_t helper;         /* 1 if neither it nor what hangs on it is drawn */
} pantin_joint;

/* Places a cursor before the first joint. */
void pantin_first_joint(pantin_joint *joint, const pantin_rig *rig);

/* Moves to the next joint (after pantin_first_joint: to joint 0). Returns 1, or 0 if there is none or it cannot be read. */
int pantin_next_joint(pantin_joint *joint);

/* Finds a joint by name. Returns 1, or 0 if there is none. */
int pantin_find_joint(const pantin_rig *rig, const char *name, pantin_joint *joint);

/* Returns the kind of a joint's channel: PANTIN_POSITION_X and so on. `channel` counts from 0 within the joint. */
uint8_t pantin_joint_kind(const pantin_joint *joint, uint8_t channel);

/* A scalar (a channel that moves no joint), and the place in the rig from which to go on to the next one. */
typedef struct pantin_scalar {
    const pantin_rig *rig;
    uint32_t next;
    pantin_name name;
    uint16_t index;
    uint16_t channel; /* index of its value in a pose */
    uint16_t listed;  /* names of the list that follow */
    int8_t exponent;  /* raw value 1 is 2^(exponent - 31) */
} pantin_scalar;

/* Places a cursor before the first scalar. */
void pantin_first_scalar(pantin_scalar *scalar, const pantin_rig *rig);

/* Moves to the next scalar (after pantin_first_scalar: to scalar 0). Returns 1, or 0 if there is none or it cannot be read. */
int pantin_next_scalar(pantin_scalar *scalar);

/* Finds a scalar by name. Returns 1, or 0 if there is none. */
int pantin_find_scalar(const pantin_rig *rig, const char *name, pantin_scalar *scalar);

/* Where a figure stands beyond what its pose says, as an animator finds it. `place` is in 2^clip.exponent units of the source, which are
 * clip.rig.unit_micro_cm * 10^-6 cm each, along the two horizontal axes: z and x for y up, x and y for z up, y and z for x up. `heading` is the turn about
 * the vertical axis, in 2^-32 turns. */
typedef struct pantin_placement {
    int64_t place[2];
    int32_t heading;
} pantin_placement;

/* ---- Clip --------------------------------------------------------------------------------------------------------------------------- */

/* One motion of one figure. */
typedef struct pantin_clip {
    pantin_source *source;
    pantin_rig rig;
    uint32_t start, end;         /* positions of the motion's first byte and after its last one */
    uint32_t index, index_end;   /* the same of the index, both 0 if there is none */
    uint32_t names, names_end;   /* the same of the event names, without their CRC */
    uint32_t exponentials, events, symbols; /* positions of these parts of the motion */
    uint32_t frames;             /* 1 to 2^24 */
    uint32_t frame_time_ns;      /* at least 1 */
    uint32_t event_count;
    uint32_t coding;             /* a hash of which joints are coded as exponential maps: 0 if none is */
    uint16_t crc;                /* of the motion's last block */
    int8_t exponent;             /* positions are in 2^exponent units of the source */
    uint8_t flags;
    uint8_t looped;              /* 1: frame 0 follows the last frame */
#ifdef PANTIN_KEYS
    uint16_t states;             /* of a key clip: channels that a player needs, 0 to 14130 */
#endif
} pantin_clip;

/* Opens a clip that fills a source, and checks it: lengths, CRCs, bounds. `rig` is used if the clip contains none, and may be NULL. */
pantin_result pantin_open(pantin_clip *clip, pantin_source *source, const pantin_rig *rig);

/* The same for a clip that takes `length` bytes at `start` of a source. */
pantin_result pantin_open_at(pantin_clip *clip, pantin_source *source, uint32_t start, uint32_t length, const pantin_rig *rig);

/* Returns 1 if the Euler channels of this joint hold an exponential map in this clip (section 4), otherwise 0. */
int pantin_joint_is_exponential(const pantin_clip *clip, const pantin_joint *joint);

/* An event, and the place in the clip from which to go on to the next one. */
typedef struct pantin_event {
    const pantin_clip *clip;
    uint32_t next, left;
    uint32_t frame; /* an event after the last frame never occurs */
    uint32_t id;
} pantin_event;

/* Places a cursor before the first event. */
void pantin_first_event(pantin_event *event, const pantin_clip *clip);

/* Moves to the next event; they are in the order of their frames. Returns 1, or 0 if there is none or it cannot be read. */
int pantin_next_event(pantin_event *event);

/* Finds the name of an event's id. Returns 1, or 0 if the id has no name. */
int pantin_event_name(const pantin_clip *clip, uint32_t id, pantin_name *name);

/* Finds the id of an event's name. Returns PANTIN_NOT_FOUND if no id has it. */
pantin_result pantin_find_event(const pantin_clip *clip, const char *name, uint32_t *id);

/* ---- Player ------------------------------------------------------------------------------------------------------------------------- */

/* The state of a moving channel: 20 bytes. Its value is in the pose. */
typedef struct pantin_channel {
    uint32_t v, w, k;  /* velocity, acceleration and slope per frame, raw */
    uint16_t channel;  /* index in the pose */
    uint8_t leader;    /* 0, or how many moving channels before it its leader is */
    uint8_t step;      /* step index */
    uint8_t mode;
    uint8_t left;      /* frames to the segment's end */
    int8_t prev_sign;
#ifdef PANTIN_KEYS
    uint8_t more;      /* of a key clip */
#endif
} pantin_channel;

/* The reader of symbols. */
typedef struct pantin_reader {
    pantin_source *source;
    uint32_t start, end;
    uint32_t position;
    uint32_t x;
} pantin_reader;

/* A player: it holds the pose of one frame. */
typedef struct pantin_player {
    const pantin_clip *clip;
    int32_t *pose;          /* the raw values of all channels at this frame: section 11 defines their units */
    pantin_channel *moving;
    uint32_t frame;         /* 0 to frames - 1 */
    uint16_t moving_count;  /* moving channels, of a key clip its states: what `moving` must have room for */
    uint16_t moving_room;
    uint16_t resume;        /* the channel to go on with if bytes were missing; of a key clip: channels with keys */
    uint8_t started;        /* 1 once all channels have their start values */
    uint8_t starts_alone;   /* 1 in a copy that reads the values at frame 0 */
    uint8_t last_status, last_step[2];
    uint8_t last_of_kind[14];
    pantin_reader reader;
    pantin_joint joint;
} pantin_player;

/* Prepares a player and shows frame 0. `pose` lends `pose_room` values, at least as many as the rig has channels. `moving` lends
 * `moving_room` channels. If it returns PANTIN_NO_ROOM, player->moving_count is what `moving` needs (0 if `pose` was too small). After
 * PANTIN_NEED_MORE or PANTIN_ERROR_READ, continue with pantin_continue. */
pantin_result pantin_start(pantin_player *player, const pantin_clip *clip, int32_t *pose, size_t pose_room, pantin_channel *moving,
                           size_t moving_room);

/* Continues a start that lacked bytes. */
pantin_result pantin_continue(pantin_player *player);

/* Shows frame 0 again. */
pantin_result pantin_restart(pantin_player *player);

/* Advances by one frame. Returns PANTIN_END at the last frame, also of a clip with a loop (call pantin_restart). After PANTIN_NEED_MORE
 * or PANTIN_ERROR_READ the pose is unchanged; call it again. */
pantin_result pantin_step(pantin_player *player);

/* Shows `frame`, 0 to frames - 1. A clip with an index is read from the nearest snapshot, another one from frame 0 if `frame` lies back. */
pantin_result pantin_seek(pantin_player *player, uint32_t frame);

/* Shows the frame before this one. Returns PANTIN_END at frame 0. */
pantin_result pantin_step_back(pantin_player *player);

/* Converts an angle in 2^-32 turns to hundredths of a degree, -18000 to 18000, rounded to the nearest. */
int16_t pantin_centidegrees(int32_t raw);

/* ---- Bank --------------------------------------------------------------------------------------------------------------------------- */

/* Clips of one rig in one file, by name (section 16). */
typedef struct pantin_bank {
    pantin_source *source;
    pantin_rig rig;
    uint32_t contents, contents_end; /* positions, without the CRC */
    uint32_t clips_start;
    uint32_t clips; /* number of clips, at least 1 */
} pantin_bank;

/* Opens a bank that fills a source, and checks all of it but its clips. */
pantin_result pantin_open_bank(pantin_bank *bank, pantin_source *source);

/* A clip's entry in a bank, and the place from which to go on to the next one. */
typedef struct pantin_entry {
    const pantin_bank *bank;
    uint32_t next;
    pantin_name name;
    uint32_t start, length; /* the clip's bytes in the source */
} pantin_entry;

/* Places a cursor before the first clip. */
void pantin_first_entry(pantin_entry *entry, const pantin_bank *bank);

/* Moves to the next clip. Returns 1, or 0 if there is none or it cannot be read. */
int pantin_next_entry(pantin_entry *entry);

/* Opens the clip of an entry. */
pantin_result pantin_open_entry(pantin_clip *clip, const pantin_entry *entry);

/* Opens a clip by name. Returns PANTIN_NOT_FOUND if there is none. */
pantin_result pantin_open_named(pantin_clip *clip, const pantin_bank *bank, const char *name);

/* Finds the section of an application's type in a bank: the positions of its first byte and of the CRC that ends it, which is checked. Returns
 * PANTIN_NOT_FOUND if there is none, PANTIN_ERROR_BANK if there are several. */
pantin_result pantin_find_section(const pantin_bank *bank, uint8_t type, uint32_t *start, uint32_t *end);

/* ---- Stream ------------------------------------------------------------------------------------------------------------------------- */

/* The smallest memory that a stream needs beyond the part of the file that it keeps. */
#define PANTIN_STREAM_BYTES 288u

/* A clip that arrives in pieces. It is played while it arrives: a block is played once its CRC has been checked. The stream keeps the start of
 * the file (rig, events) and a window of the motion. It ignores what follows the motion (index and event names). */
typedef struct pantin_stream {
    pantin_source source;
    pantin_clip clip;       /* valid once `opened` is 1 */
    const pantin_rig *rig;
    uint8_t *memory;
    uint32_t size;          /* bytes lent */
    uint32_t received;      /* bytes of the file that have arrived */
    uint32_t checked;       /* position up to which bytes may be played */
    uint32_t kept;          /* bytes of the file's start that are kept */
    uint32_t slide;         /* position of the first byte after the kept ones that is still in memory */
    uint32_t motion;        /* position of the motion, 0 while it is not known */
    pantin_result result;   /* PANTIN_OK, or the error that ended it */
    uint8_t opened;
} pantin_stream;

/* Prepares a stream. `memory` lends `size` bytes: those before the motion's symbols, rounded up to the end of their block, and
 * PANTIN_STREAM_BYTES more; further bytes let it receive ahead. A key clip needs room for all its bytes: it is read as a whole. `rig` is used if the clip contains none, and may be NULL. */
void pantin_open_stream(pantin_stream *stream, uint8_t *memory, uint32_t size, const pantin_rig *rig);

/* Takes bytes that have arrived, at most `count`. Returns how many it took: the others must be pushed again after further steps. Once
 * stream->result is not PANTIN_OK, it takes no bytes. When stream->opened is 1, start a player with &stream->clip. */
uint32_t pantin_push(pantin_stream *stream, const uint8_t *bytes, uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
