/* Variables whose sizes are the RAM of a face that plays our emotes. */
#include "pantin_face.h"

pantin_face face;
uint32_t cartoon[PANTIN_FACE_WORDS(97, 7)], wireframe[PANTIN_FACE_WORDS(239, 7)];
