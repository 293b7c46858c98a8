/* Prints what the decoder makes of clips, for comparison with the records of the test vectors: one line of JSON for each file.
 *
 *     frames CLIP.ptn [RIG.rig]     frames BANK.ptb
 *
 * For emulated boards, which may have no arguments, CLIP_FILE names the file when it is compiled. */
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "pantin.h"
#include "room.h"

static uint16_t crc_byte(uint16_t crc, uint8_t byte) {
    int i;
    crc = (uint16_t)(crc ^ (uint16_t)(byte << 8));
    for (i = 0; i < 8; i++) crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
    return crc;
}

static uint16_t pose_crc(const int32_t *pose, unsigned channels) {
    uint16_t crc = 0xffff;
    unsigned i, b;
    for (i = 0; i < channels; i++) {
        for (b = 0; b < 4; b++) crc = crc_byte(crc, (uint8_t)((uint32_t)pose[i] >> (8 * b)));
    }
    return crc;
}

static void check(int held, const char *what) {
    if (!held) {
        printf("failed: %s\n", what);
        exit(1);
    }
}


static void print_name(const pantin_name *name) {
    char text[1024];
    pantin_copy_name(name, text, sizeof text);
    printf("\"%s\"", text);
}

/* CRCs of all frames, then that other ways to the same frames agree. */
static void play(const pantin_clip *clip, int whole) {
    pantin_player player;
    uint16_t *crcs = (uint16_t *)malloc(clip->frames * sizeof *crcs);
    uint32_t f, x = 12345;
    pantin_result result;
    check(pantin_start(&player, clip, pose, 1023, moving, ROOM) == PANTIN_OK, "start");
    printf("\"moving\": %u, \"crcs\": [", player.moving_count);
    f = 0;
    do {
        check(player.frame == f, "frame");
        crcs[f] = pose_crc(pose, clip->rig.channels);
        printf(f ? ", \"%04x\"" : "\"%04x\"", crcs[f]);
        f++;
        result = pantin_step(&player);
    } while (result == PANTIN_OK);
    check(result == PANTIN_END && f == clip->frames, "end");
    printf("]");
    while (pantin_step_back(&player) == PANTIN_OK) {
        check(pose_crc(pose, clip->rig.channels) == crcs[player.frame], "step back");
    }
    check(player.frame == 0, "back at the start");
    for (f = 0; f < 200; f++) {
        x = x * 1664525u + 1013904223u;
        check(pantin_seek(&player, (x >> 8) % clip->frames) == PANTIN_OK, "seek");
        check(pose_crc(pose, clip->rig.channels) == crcs[player.frame], "seek to the same pose");
    }
    check(pantin_seek(&player, clip->frames) == PANTIN_NOT_FOUND, "seek past the end");
    if (player.moving_count > 0) {
        check(pantin_start(&player, clip, pose, 1023, moving, player.moving_count - 1u) == PANTIN_NO_ROOM, "room");
    }
    if (whole) {
        printf(", \"poses\": {");
        check(pantin_start(&player, clip, pose, 1023, moving, ROOM) == PANTIN_OK, "start");
        do {
            printf("%s\"%u\": [", player.frame ? ", " : "", (unsigned)player.frame);
            for (f = 0; f < clip->rig.channels; f++) printf(f ? ", %ld" : "%ld", (long)pose[f]);
            printf("]");
        } while (pantin_step(&player) == PANTIN_OK);
        printf("}");
    }
    free(crcs);
}

static int read_bytes(void *context, uint32_t position, uint8_t *into, uint16_t count) {
    memcpy(into, (const uint8_t *)context + position, count);
    return 0;
}

/* The frames through pages of some sizes, and as a stream in pieces of some sizes. */
static void other_sources(const pantin_clip *clip, uint8_t *bytes, uint32_t length, const pantin_rig *rig) {
    static const uint16_t sizes[] = {1, 7, 128, 1000};
    static const uint32_t spare[] = {0, 1, 224, 5000};
    pantin_player player, other;
    static int32_t other_pose[1023];
    static pantin_channel other_moving[ROOM];
    unsigned i;
    size_t pose_bytes = clip->rig.channels * sizeof *pose;
    for (i = 0; i < 4; i++) {
        pantin_pages pages;
        pantin_clip paged;
        uint8_t page[1000];
        pantin_paged(&pages, length, read_bytes, bytes, page, sizes[i]);
        check(pantin_open(&paged, &pages.source, rig) == PANTIN_OK, "paged open");
        check(pantin_start(&player, clip, pose, 1023, moving, ROOM) == PANTIN_OK, "start");
        check(pantin_start(&other, &paged, other_pose, 1023, other_moving, ROOM) == PANTIN_OK, "paged start");
        do {
            check(memcmp(pose, other_pose, pose_bytes) == 0, "paged frame");
            check(pantin_step(&other) == pantin_step(&player), "paged step");
        } while (player.frame + 1 < clip->frames);
    }
    for (i = 0; i < 4; i++) {
        pantin_stream stream;
        uint32_t size = clip->symbols + 256 + PANTIN_STREAM_BYTES + spare[i], sent = 0;
        uint8_t *memory;
        pantin_result result = PANTIN_NEED_MORE;
        /* A key clip is read as a whole before it plays. */
        if (bytes[2] == 2) size += length;
        memory = (uint8_t *)malloc(size);
        pantin_open_stream(&stream, memory, size, rig);
        other.frame = 0xffffffffu;
        check(pantin_start(&player, clip, pose, 1023, moving, ROOM) == PANTIN_OK, "start");
        for (;;) {
            uint32_t piece = length - sent < sizes[i] ? length - sent : sizes[i];
            uint32_t taken = pantin_push(&stream, bytes + sent, piece);
            check(stream.result == PANTIN_OK, "stream");
            check(taken > 0 || result == PANTIN_OK || piece == 0, "stream goes on");
            sent += taken;
            if (!stream.opened) continue;
            if (other.frame == 0xffffffffu) {
                result = pantin_start(&other, &stream.clip, other_pose, 1023, other_moving, ROOM);
            } else if (!other.started) {
                result = pantin_continue(&other);
            } else {
                result = pantin_step(&other);
                if (result == PANTIN_OK) check(pantin_step(&player) == PANTIN_OK, "step");
            }
            if (result == PANTIN_END) break;
            check(result == PANTIN_OK || result == PANTIN_NEED_MORE, "stream's result");
            if (other.started) check(memcmp(pose, other_pose, pose_bytes) == 0, "streamed frame");
        }
        check(player.frame + 1 == clip->frames, "streamed to the end");
        free(memory);
    }
}

int main(int argc, char **argv) {
    uint32_t length, rig_length;
    pantin_source source, rig_source;
    pantin_clip clip;
    pantin_rig rig, *used = NULL;
    pantin_joint joint;
    pantin_event event;
    pantin_name name;
    uint8_t *bytes, *rig_bytes = NULL;
    uint32_t i, id;
    int first;
#ifdef CLIP_FILE
    (void)argv;
    argc = 0;
    bytes = file(CLIP_FILE, &length);
#else
    if (argc < 2) return 2;
    bytes = file(argv[1], &length);
#endif
    pantin_memory(&source, bytes, length);
    if (length > 1 && bytes[1] == 'b') {
        pantin_bank bank;
        pantin_entry entry;
        check(pantin_open_bank(&bank, &source) == PANTIN_OK, "bank");
        printf("{\"joints\": %u, \"clips\": [", bank.rig.joints);
        pantin_first_entry(&entry, &bank);
        first = 1;
        while (pantin_next_entry(&entry)) {
            char text[1024];
            pantin_clip named;
            check(pantin_open_entry(&clip, &entry) == PANTIN_OK, "entry");
            pantin_copy_name(&entry.name, text, sizeof text);
            check(pantin_open_named(&named, &bank, text) == PANTIN_OK && named.start == clip.start, "named");
            printf("%s{\"name\": \"%s\", \"bytes\": %u, \"frames\": %u, \"looped\": %s, ", first ? "" : ", ", text, (unsigned)entry.length,
                   (unsigned)clip.frames, clip.looped ? "true" : "false");
            play(&clip, 0);
            printf("}");
            first = 0;
        }
        check(pantin_open_named(&clip, &bank, "no such clip") == PANTIN_NOT_FOUND, "not found");
        printf("]}\n");
        free(bytes);
        return 0;
    }
    if (argc > 2) {
        rig_bytes = file(argv[2], &rig_length);
        pantin_memory(&rig_source, rig_bytes, rig_length);
        check(pantin_open_rig(&rig, &rig_source, 0, rig_length) == PANTIN_OK, "rig");
        used = &rig;
    }
    i = (uint32_t)pantin_open(&clip, &source, used);
    if (i != PANTIN_OK) printf("open: %u\n", (unsigned)i);
    check(i == PANTIN_OK, "open");
    printf("{\"frames\": %u, \"frame_time_ns\": %u, \"looped\": %s, \"length_exponent\": %d, \"joints\": %u, \"channels\": %u, \"up\": %u, ",
           (unsigned)clip.frames, (unsigned)clip.frame_time_ns, clip.looped ? "true" : "false", clip.exponent, clip.rig.joints,
           clip.rig.channels, clip.rig.up);
    printf("\"exponential_joints\": [");
    first = 1;
    pantin_first_joint(&joint, &clip.rig);
    while (pantin_next_joint(&joint)) {
        if (pantin_joint_is_exponential(&clip, &joint)) {
            printf(first ? "%u" : ", %u", joint.index);
            first = 0;
        }
        if (joint.name.length > 0) {
            pantin_joint found;
            char text[1024];
            pantin_copy_name(&joint.name, text, sizeof text);
            check(pantin_find_joint(&clip.rig, text, &found), "joint by name");
        }
    }
    printf("], \"helpers\": [");
    first = 1;
    pantin_first_joint(&joint, &clip.rig);
    while (pantin_next_joint(&joint)) {
        if (joint.helper) {
            printf(first ? "%u" : ", %u", joint.index);
            first = 0;
        }
    }
    printf("], \"events\": [");
    first = 1;
    pantin_first_event(&event, &clip);
    while (pantin_next_event(&event)) {
        printf("%s[%u, %u]", first ? "" : ", ", (unsigned)event.frame, (unsigned)event.id);
        first = 0;
    }
    printf("], \"event_names\": [");
    id = 0;
    name.length = 0;
    {
        /* The names up to the last one that is not empty. */
        uint32_t last = 0;
        for (id = 0; id < 1000; id++) {
            if (pantin_event_name(&clip, id, &name)) last = id + 1;
        }
        for (id = 0; id < last; id++) {
            if (!pantin_event_name(&clip, id, &name)) name.length = 0;
            if (id) printf(", ");
            print_name(&name);
        }
    }
    printf("], \"scalars\": [");
    {
        pantin_scalar scalar;
        pantin_first_scalar(&scalar, &clip.rig);
        first = 1;
        while (pantin_next_scalar(&scalar)) {
            if (!first) printf(", ");
            first = 0;
            printf("[%u, %d, ", scalar.channel, scalar.exponent);
            print_name(&scalar.name);
            printf("]");
        }
    }
    printf("], ");
    play(&clip, 1);
    other_sources(&clip, bytes, length, used);
    printf("}\n");
    free(bytes);
    free(rig_bytes);
    return 0;
}
