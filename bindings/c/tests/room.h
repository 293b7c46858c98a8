/* Memory of the tests for any clip: key clips take states beside the channels. */
#ifndef PANTIN_TEST_ROOM_H
#define PANTIN_TEST_ROOM_H

#include "pantin.h"

#ifdef PANTIN_KEYS
#define ROOM 14130u
#else
#define ROOM 1023u
#endif

static int32_t pose[1023];
static pantin_channel moving[ROOM];

#endif
