/* What pantin.c and pantin_keys.c share. Programs include pantin.h alone. */
#ifndef PANTIN_KEYS_H
#define PANTIN_KEYS_H

#include "pantin.h"

/* In `pantin_clip.flags` alone: the clip is a key clip. */
#define PANTIN_KEY_CLIP 0x80u
#define PANTIN_MAX_KEY_FRAMES 8191u
#define PANTIN_MAX_STATES 14130u

/* The next channel of a pose, as pantin.c finds it. */
typedef struct pantin_key_channel {
    uint8_t kind;
    int32_t offset; /* of a position: the rig's offset along its axis */
    int32_t rest;   /* the value of a channel that rests */
} pantin_key_channel;

/* In pantin.c: the next byte of a motion, 0 past its end; and the channel of index `player->resume`. */
uint8_t pantin_keys_byte(pantin_reader *reader);
pantin_result pantin_keys_channel(pantin_player *player, pantin_key_channel *channel);

/* In pantin_keys.c: what the functions of pantin.h do with a key clip. */
pantin_result pantin_keys_start(pantin_player *player);
void pantin_keys_step(pantin_player *player);
void pantin_keys_seek(pantin_player *player, uint32_t frame);

/* Puts the value of each channel at frame 0 into its acceleration, and 0 into its slope. */
void pantin_keys_starts(const pantin_player *player);

#endif
