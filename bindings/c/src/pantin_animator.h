/* The animator: transitions between clips, root motion, events, and the state machine of a bank.
 *
 * Like the decoder it allocates nothing, uses no floating point and needs only stdint.h, stddef.h and string.h. Poses and placements are those of the
 * crate pantin-animator, bit for bit, at every frame. MACHINE.md of that crate describes state machines and `pantin machine`, which makes them.
 *
 *     static pantin_channel moving[80];
 *     static int32_t values[100], pose[100];
 *     static pantin_offset offsets[100];
 *     static pantin_group groups[100];
 *     static const pantin_animator_memory memory = {moving, 80, values, pose, offsets, 100, groups, 100};
 *     static pantin_character character;
 *
 *     pantin_memory(&source, moves, sizeof moves);
 *     if (pantin_character_open(&character, &source, &memory, PANTIN_WITHOUT_LAYERS | PANTIN_WITHOUT_BLENDS | PANTIN_WITHOUT_FEET) == PANTIN_OK) {
 *         go = pantin_character_input(&character, "go");
 *         for (;;) {
 *             pantin_character_hold(&character, go, pressed);
 *             pantin_character_update(&character, 33333);
 *             pantin_figure_pose(&figure, character.animator.pose);
 *         }
 *     }
 *
 * Feet that stay where they are put are in pantin_feet.h. With PANTIN_KEYS defined, key clips play too. A function that is called for an animator or a
 * character of zeroes, also after it could not be opened, returns PANTIN_ERROR_HEAD.
 */
#ifndef PANTIN_ANIMATOR_H
#define PANTIN_ANIMATOR_H

#include "pantin_turn.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Events that wait to be taken, at most. */
#define PANTIN_EVENTS 16

/* Speed 1: the clip's own. */
#define PANTIN_SPEED 65536L

/* A difference that a transition takes away: 16 bytes. */
typedef struct pantin_offset {
    int32_t d, v, w, k;
} pantin_offset;

/* Channels that belong together: 6 bytes. One is needed for each joint with channels, another for a joint that also has positions, and one for each
 * scalar. */
typedef struct pantin_group {
    uint16_t first, bit;
    uint8_t length, shape;
} pantin_group;

/* Memory for an animator: as many moving channels as the clip that has most, and as many values, poses and offsets as the rig has channels. */
typedef struct pantin_animator_memory {
    pantin_channel *moving;
    size_t moving_room;
    int32_t *values, *pose;
    pantin_offset *offsets;
    size_t channel_room; /* elements of each of the three */
    pantin_group *groups;
    size_t group_room;
} pantin_animator_memory;

/* An event marker that was passed: its id in its clip and its frame. */
typedef struct pantin_fired {
    uint32_t id, frame;
} pantin_fired;

/* How one clip follows another: at once; the difference of poses and velocities dies out; that of the poses alone does. */
typedef enum pantin_transition { PANTIN_CUT = 0, PANTIN_INERTIALIZED, PANTIN_FADED } pantin_transition;

/* Between the last frame of a loop and its first: where a lap takes the root. */
typedef struct pantin_seam {
    int64_t place[2];
    int32_t yaw, first[2];
    uint8_t known;
} pantin_seam;

/* One clip at play: a player, the time after its frame, and a speed. */
typedef struct pantin_track {
    pantin_clip clip;
    pantin_player player;
    int64_t rest;  /* time after the frame, in 2^-16 ns */
    int32_t speed; /* PANTIN_SPEED is 1: -4 to 4 */
    pantin_seam seam;
    uint8_t ended;  /* 1 once a clip that is no loop was played past its end */
    uint8_t stands; /* 1 if it had ended before the time that passed last: then nothing moves */
    uint8_t closed; /* 1: the velocities lead from the last frame of a loop to frame 0 */
    uint8_t lapped; /* 1 once a loop has begun while no transition ran */
    uint8_t stale;  /* 1 after a failed read: the next call starts the player again at its frame */
} pantin_track;

/* An angle with its sine and cosine in Q30. */
typedef struct pantin_heading {
    int32_t angle, sine, cosine;
} pantin_heading;

/* A figure that plays one clip after another. Fields may be read; only the functions change them. */
typedef struct pantin_animator {
    pantin_track track;
    const pantin_animator_memory *memory;
    int32_t *pose;              /* of this instant; the root's horizontal positions are 0 */
    pantin_placement placement; /* where the figure is */
    uint32_t rest_ns;           /* of the transition's frame */
    uint32_t lost;              /* events that found the queue full */
    uint16_t group_count, channels;
    uint16_t carrier;           /* index of the joint that carries the figure */
    uint8_t left;               /* frames of the transition that are left, and when velocities have died out, if that is before its end */
    uint8_t left_then;
    uint8_t carried;            /* 1 while a transition advances by whole frames together with the clip, and by how many it has */
    uint8_t carried_frames;
    uint8_t event_count;
    uint8_t stepped;            /* 1 once a call has changed the differences of a transition */
    pantin_fired events[PANTIN_EVENTS]; /* the oldest first */
    pantin_joint_ref root;
    pantin_group turns;         /* the channels that turn the root */
    uint16_t place_channels[2];
    uint8_t axis;               /* the vertical one */
    int32_t place[2];           /* the root's horizontal place in the clip, with what the transition adds */
    int64_t anchor[2], origin[2], lap_place[2];
    pantin_heading heading, lap_heading;
    int32_t laps;
} pantin_animator;

/* Starts a clip at frame 0, at the world's origin. The figure is carried by the rig's first joint with positions. `memory` is not copied. Returns
 * PANTIN_NO_ROOM if it is too small, PANTIN_NOT_FOUND for a rig without joints, or what reading returned. */
pantin_result pantin_animator_open(pantin_animator *animator, const pantin_clip *clip, const pantin_animator_memory *memory);

/* Opens an animator for a figure that is carried by the joint of an index. */
pantin_result pantin_animator_open_carried(pantin_animator *animator, const pantin_clip *clip, const pantin_animator_memory *memory, uint16_t carrier);

/* Goes over to a clip of the same rig from a frame (from the last one if there are fewer) at a speed, in `frames` frames of the new clip. On an error the
 * old clip plays on, and a transition that ran has ended: a read that fails ends it only if it had gone on in the call. */
pantin_result pantin_animator_switch(pantin_animator *animator, const pantin_clip *clip, uint32_t frame, int32_t speed, pantin_transition kind,
                                     uint8_t frames);

/* Lets time pass, up to 71 minutes. A read that fails (PANTIN_ERROR_READ) takes this and the functions below back, and the call may be repeated; a
 * transition that had gone on in it ends. If the frame before cannot be read again either, the pose is only valid after the next call that succeeds. */
pantin_result pantin_animator_update(pantin_animator *animator, uint32_t elapsed_us);

/* Goes on by exactly one frame of the clip, forwards and whatever its speed. */
pantin_result pantin_animator_step(pantin_animator *animator);

/* Goes to a frame of the clip, or to the last one, without events. The transition stays where it is. */
pantin_result pantin_animator_seek(pantin_animator *animator, uint32_t frame);

/* Plays at a speed from here on. The velocity of the pose jumps. */
void pantin_animator_speed(pantin_animator *animator, int32_t speed);

/* Puts the figure to a place in the world. */
void pantin_animator_stand(pantin_animator *animator, const pantin_placement *placement);

/* Takes the oldest event. Returns 1, or 0 if there is none. */
int pantin_animator_take(pantin_animator *animator, pantin_fired *fired);

/* ---- State machines ----------------------------------------------------------------------------------------------------------------- */

/* What a character does without although the bank has it. Layers for which no memory was lent never play; feet that were not lent can slide, and
 * transitions do not wait for them; states that blend play their first clip alone if no memory was lent for the second. An update of a bank with such a
 * part is PANTIN_UNSUPPORTED unless the program says so. */
enum { PANTIN_WITHOUT_LAYERS = 1, PANTIN_WITHOUT_FEET = 2, PANTIN_WITHOUT_BLENDS = 4 };

/* An input or a parameter that a table lacks. */
#define PANTIN_NO_INPUT 255u

/* A layer of a state machine: a clip that an input plays over some joints. */
typedef struct pantin_layer {
    pantin_track track;
    int32_t *sampled;
    uint32_t *words;  /* a bit for each joint and scalar that it moves */
    uint64_t states;  /* those in which it may play */
    uint32_t fade_us, left_us; /* the time in which it comes and goes, and what is left of it */
    uint16_t weight, to;       /* in 2^-15 */
    uint8_t clip, input, doing;
} pantin_layer;

/* Where a clip is, and its root. */
typedef struct pantin_clip_instant {
    uint32_t frame;
    uint16_t part;
    int32_t place[2];
} pantin_clip_instant;

struct pantin_feet;
struct pantin_feet_calls;

/* A figure that a state machine moves. */
typedef struct pantin_character {
    pantin_bank bank;
    pantin_animator animator;
    pantin_track *second;       /* of states that blend; NULL without memory for it */
    pantin_layer *layers[4];    /* those for which memory was lent */
    uint32_t table, table_end;  /* positions, without the CRC */
    uint32_t fired, held, held_before, seen; /* sets of inputs */
    int16_t parameters[8];
    uint8_t counts[8];          /* the table's header */
    uint8_t state;
    uint8_t entered;            /* 1 if the last update entered a state */
    uint8_t blending, without, layer_count;
    uint8_t led;                /* 1 if `instants` are those of the update before */
    uint16_t mixed;             /* how much of the second clip is mixed in, in 2^-15 */
    pantin_clip_instant instants[2];
    uint8_t waiting;            /* a transition that waits for a matching foot, or 255 */
    uint8_t needs_feet;         /* 1 if the bank has feet that were not declared absent */
    struct pantin_feet *feet;   /* of pantin_feet.h; NULL before pantin_character_feet */
    const struct pantin_feet_calls *feet_calls;
} pantin_character;

/* Starts the state machine of a bank that fills a source. `without` says which of the bank's parts may be left out. Returns PANTIN_NOT_FOUND if it has no
 * state machine, PANTIN_ERROR_MACHINE for a table that contradicts itself, or the errors of pantin_animator_open. A bank with states that blend, layers or
 * feet also needs pantin_character_second, pantin_character_layer or pantin_character_feet (of pantin_feet.h). */
pantin_result pantin_character_open(pantin_character *character, pantin_source *source, const pantin_animator_memory *memory, uint8_t without);

/* Lends what the second clips of blends need: call it right after pantin_character_open. `values` has an element for each channel. */
pantin_result pantin_character_second(pantin_character *character, pantin_track *track, pantin_channel *moving, size_t moving_room, int32_t *values,
                                      size_t value_room);

/* Lends what the table's next layer needs; the first call is for the first layer. `values` and `sampled` have `channel_room` elements, at least one for
 * each channel, and `words` one for each 32 joints and scalars. Returns PANTIN_NOT_FOUND if the table has no further layer, or if one of the patterns that
 * say what it moves matches nothing. */
pantin_result pantin_character_layer(pantin_character *character, pantin_layer *layer, pantin_channel *moving, size_t moving_room, int32_t *values,
                                     int32_t *sampled, size_t channel_room, uint32_t *words, size_t word_room);

/* Indices of an input, a parameter and a state by name; PANTIN_NO_INPUT if there is none, or if the names cannot be read. */
uint8_t pantin_character_input(const pantin_character *character, const char *name);
uint8_t pantin_character_parameter(const pantin_character *character, const char *name);
uint8_t pantin_character_state(const pantin_character *character, const char *name);

/* The name of a state, such as that of `character->state`. Returns 1, or 0 if there is none or it cannot be read. */
int pantin_character_state_name(const pantin_character *character, uint8_t state, pantin_name *name);

/* Fires an input, which the next update alone sees; holds it down or lets it go. What the table lacks does nothing. */
void pantin_character_fire(pantin_character *character, uint8_t input);
void pantin_character_hold(pantin_character *character, uint8_t input, int down);

/* Sets a parameter, within its range. It stays as it was if that cannot be read. */
void pantin_character_set(pantin_character *character, uint8_t parameter, int16_t value);

/* Lets time pass, then takes the transition whose condition holds. Events that were not taken are dropped first. On an error of a clip that cannot be
 * opened, or for which there is too little memory, the old state goes on. A read that fails takes the whole update back, as in pantin_animator_update: state,
 * inputs and events are those of before, and the update may be repeated; the pose of a character with feet that had just entered a state can differ from the one
 * before in last bits. Returns PANTIN_UNSUPPORTED if a state blends, or if the bank has layers or feet, and
 * the memory was neither lent nor declared absent. */
pantin_result pantin_character_update(pantin_character *character, uint32_t elapsed_us);

#ifdef __cplusplus
}
#endif

#endif
