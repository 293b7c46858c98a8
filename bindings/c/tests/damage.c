/* Opens, plays and streams a file after every cut and every flipped bit, with the CRCs as they are: built with sanitizers, it fails if the
 * decoder reads past the end or computes what C does not define.
 *
 *     damage FILE [RIG] */
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "pantin.h"
#include "room.h"

static uint32_t opened;

static void play(const pantin_clip *clip) {
    pantin_player player;
    unsigned i;
    if (pantin_start(&player, clip, pose, 1023, moving, ROOM) != PANTIN_OK) return;
    for (i = 0; i < 100 && pantin_step(&player) == PANTIN_OK; i++) {}
    pantin_seek(&player, clip->frames < 1000 ? clip->frames - 1 : 999);
}

static void try_it(const uint8_t *bytes, uint32_t length, const pantin_rig *rig) {
    static uint8_t memory[4096];
    pantin_source source;
    pantin_stream stream;
    pantin_clip clip;
    pantin_bank bank;
    pantin_entry entry;
    pantin_memory(&source, bytes, length);
    if (pantin_open(&clip, &source, rig) == PANTIN_OK) {
        opened++;
        play(&clip);
    }
    if (pantin_open_bank(&bank, &source) == PANTIN_OK) {
        pantin_first_entry(&entry, &bank);
        while (pantin_next_entry(&entry)) {
            if (pantin_open_entry(&clip, &entry) == PANTIN_OK) play(&clip);
        }
    }
    pantin_open_stream(&stream, memory, sizeof memory, rig);
    pantin_push(&stream, bytes, length);
    if (stream.opened) play(&stream.clip);
}

int main(int argc, char **argv) {
    uint32_t length, rig_length, i, bit, known;
    uint8_t *bytes, *rig_bytes = NULL;
    pantin_source source, rig_source;
    pantin_clip clip;
    pantin_rig rig, *used = NULL;
    if (argc < 2) return 2;
    bytes = file(argv[1], &length);
    if (argc > 2) {
        rig_bytes = file(argv[2], &rig_length);
        pantin_memory(&rig_source, rig_bytes, rig_length);
        if (pantin_open_rig(&rig, &rig_source, 0, rig_length) != PANTIN_OK) return 2;
        used = &rig;
    }
    /* The end of the parts that are checked: sections may follow that no decoder reads. */
    known = length;
    pantin_memory(&source, bytes, length);
    if (pantin_open(&clip, &source, used) == PANTIN_OK && clip.flags & 64) {
        known = clip.names ? clip.names_end + 2 : clip.index ? clip.index_end : clip.end;
    }
    for (i = 0; i < length; i++) {
        uint8_t *cut = (uint8_t *)malloc(i ? i : 1);
        memcpy(cut, bytes, i);
        try_it(cut, i, used);
        free(cut);
        if (opened != (i >= known)) {
            printf("cut to %u bytes\n", (unsigned)i);
            return 1;
        }
        opened = 0;
    }
    for (i = 0; i < length; i++) {
        for (bit = 0; bit < 8; bit++) {
            bytes[i] = (uint8_t)(bytes[i] ^ 1u << bit);
            try_it(bytes, length, used);
            bytes[i] = (uint8_t)(bytes[i] ^ 1u << bit);
            if (bytes[1] != 'b' && opened != (i >= known)) {
                printf("byte %u, bit %u\n", (unsigned)i, (unsigned)bit);
                return 1;
            }
            opened = 0;
        }
    }
    free(bytes);
    free(rig_bytes);
    return 0;
}
