/* Prints what the decoder reads of many damaged clips, one line each, as tests/hostile/src/mutants.rs of the repository does:
 *
 *     mutants RIG MUTANTS VALUES FRAMES EVENTS [banks]
 *
 * MUTANTS holds for each clip, or bank, its length as a u32 and its bytes. The numbers limit what is compared of a clip. */
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "pantin.h"
#include "room.h"

static uint32_t values, most, events;

static uint32_t hash(uint32_t channels) {
    uint32_t hash = 0x811c9dc5u, i;
    for (i = 0; i < channels; i++) hash = (hash ^ (uint32_t)pose[i]) * 0x01000193u;
    return hash;
}

/* Prints what is read of a clip, without the end of the line. Returns 0 if it does not play. */
static int describe(pantin_clip *clip) {
    uint32_t frames, channels, f;
    pantin_player player;
    pantin_event event;
    if (pantin_start(&player, clip, pose, 1023, moving, ROOM) != PANTIN_OK) return 0;
    channels = clip->rig.channels;
    printf("%u frames of %u ns, exponent %d, looped %s, %u joints, %u channels, %u moving, %u events", (unsigned)clip->frames,
           (unsigned)clip->frame_time_ns, clip->exponent, clip->looped ? "true" : "false", clip->rig.joints, (unsigned)channels,
           player.moving_count, (unsigned)clip->event_count);
    pantin_first_event(&event, clip);
    for (f = 0; f < events && pantin_next_event(&event); f++) printf(" %u:%u", (unsigned)event.frame, (unsigned)event.id);
    printf(", poses");
    frames = 1 + values / (channels ? channels : 1);
    if (frames > clip->frames) frames = clip->frames;
    if (frames > most) frames = most;
    for (f = 0; f < frames; f++) {
        if (f > 0 && pantin_step(&player) != PANTIN_OK) return 0;
        printf(" %08x", (unsigned)hash(channels));
    }
    /* Every way through a clip ends, whatever its index says. */
    for (f = 0; f < 4; f++) {
        uint32_t to = clip->frames < 2000 ? (clip->frames - 1) * f / 3 : f * 500;
        if (pantin_seek(&player, to) != PANTIN_OK) return 0;
    }
    return 1;
}

/* Prints the checksums of all clips of a bank. */
static int describe_bank(pantin_source *source) {
    pantin_bank bank;
    pantin_entry entry;
    pantin_clip clip;
    uint32_t clips = 0;
    if (pantin_open_bank(&bank, source) != PANTIN_OK) {
        printf("refused");
        return 1;
    }
    printf("%u joints", bank.rig.joints);
    pantin_first_entry(&entry, &bank);
    while (pantin_next_entry(&entry)) {
        clips++;
        printf("; %u bytes: ", (unsigned)entry.length);
        if (pantin_open_entry(&clip, &entry) != PANTIN_OK) {
            printf("refused");
        } else if (!describe(&clip)) {
            return 0;
        }
    }
    return clips == bank.clips;
}

int main(int argc, char **argv) {
    uint32_t length, rig_length, at = 0;
    pantin_source rig_source;
    pantin_rig rig;
    uint8_t *bytes, *rig_bytes;
    if (argc < 6) return 2;
    rig_bytes = file(argv[1], &rig_length);
    bytes = file(argv[2], &length);
    values = (uint32_t)atol(argv[3]);
    most = (uint32_t)atol(argv[4]);
    events = (uint32_t)atol(argv[5]);
    pantin_memory(&rig_source, rig_bytes, rig_length);
    if (pantin_open_rig(&rig, &rig_source, 0, rig_length) != PANTIN_OK) return 2;
    while (at < length) {
        uint32_t size = bytes[at] | (uint32_t)bytes[at + 1] << 8 | (uint32_t)bytes[at + 2] << 16 | (uint32_t)bytes[at + 3] << 24;
        /* A copy, so that a sanitizer notices what is read past its end. */
        uint8_t *copy = (uint8_t *)malloc(size ? size : 1);
        pantin_source source;
        pantin_clip clip;
        if (!copy) return 2;
        memcpy(copy, bytes + at + 4, size);
        at += 4 + size;
        pantin_memory(&source, copy, size);
        if (argc > 6) {
            if (!describe_bank(&source)) return 3;
        } else if (pantin_open(&clip, &source, &rig) != PANTIN_OK) {
            printf("refused");
        } else if (!describe(&clip)) {
            return 3;
        }
        puts("");
        free(copy);
    }
    free(bytes);
    free(rig_bytes);
    return 0;
}
