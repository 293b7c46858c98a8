/* What the animator uses of the decoder: not for programs. See pantin.h. */
#ifndef PANTIN_PARTS_H
#define PANTIN_PARTS_H

#include "pantin.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A byte of a source; 0 if it cannot be read, and the source has an error then. */
uint8_t pantin_byte(pantin_source *source, uint32_t position);

/* Puts the value of each moving channel at frame 0 into its acceleration, and 0 into its slope. The pose and the velocities stay. */
pantin_result pantin_keep_starts(const pantin_player *player);

#ifdef __cplusplus
}
#endif

#endif
