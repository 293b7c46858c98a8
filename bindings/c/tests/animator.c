/* Prints what the animator makes of scripts, for comparison with the crate pantin-animator (xtask/commands/src/bindings/animator):
 *
 *     animator play SCRIPT CLIP...      : an animator that begins with the first clip
 *     animator steer SCRIPT BANKS LENT  : the state machines of banks, each behind its length as a u32; LENT is the sum of 1, with which states blend and
 *                                         layers play, and 2, with which feet are held
 *     animator parts BANKS              : whether a bank opens if 0 to 7 of its parts may be left out */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "pantin_feet.h"

enum { CHANNELS = 512, STATES = 4096, CLIPS = 64 };

static pantin_channel moving[STATES], second_moving[STATES];
static int32_t values[CHANNELS], second_values[CHANNELS], pose[CHANNELS];
static pantin_offset offsets[CHANNELS];
static pantin_group groups[CHANNELS];
static const pantin_animator_memory memory = {moving, STATES, values, pose, offsets, CHANNELS, groups, CHANNELS};
static pantin_source sources[CLIPS];
static pantin_clip clips[CLIPS];
static pantin_animator animator;
static pantin_character character;
static pantin_track second;
static pantin_layer layers[4];
static pantin_feet feet;
static pantin_channel layer_moving[4][STATES];
static int32_t layer_values[4][CHANNELS], sampled[4][CHANNELS];
static uint32_t words[4][16];

static void print(const pantin_animator *a) {
    uint32_t hash = 0x811c9dc5u;
    uint16_t c;
    uint8_t i;
    for (c = 0; c < a->channels; c++) hash = (hash ^ (uint32_t)a->pose[c]) * 0x01000193u;
    printf("%u %u %d %u %u %lld %lld %d %08x", (unsigned)a->track.player.frame, (unsigned)(uint16_t)(a->track.rest / a->track.clip.frame_time_ns),
           (int)a->track.speed, a->track.ended, a->left, (long long)a->placement.place[0], (long long)a->placement.place[1], (int)a->placement.heading,
           (unsigned)hash);
    for (i = 0; i < a->event_count; i++) printf(" %u:%u", (unsigned)a->events[i].id, (unsigned)a->events[i].frame);
    printf(" %u\n", (unsigned)a->lost);
}

/* Reads a line of a script: its first letter and its numbers. Returns the place after it, or NULL at the end. */
static const char *next_line(const char *at, char *word, long long *numbers, int *count) {
    char *end;
    if (!*at) return NULL;
    *word = *at++;
    for (*count = 0; *at && *at != '\n';) {
        numbers[(*count)++] = strtoll(at, &end, 10);
        at = end;
    }
    return *at ? at + 1 : at;
}

static void play(const char *script) {
    long long n[8];
    int count;
    char word;
    pantin_fired fired;
    if (pantin_animator_update(&animator, 1) != PANTIN_ERROR_HEAD || pantin_animator_step(&animator) != PANTIN_ERROR_HEAD ||
        pantin_character_update(&character, 1) != PANTIN_ERROR_HEAD || pantin_character_input(&character, "go") != PANTIN_NO_INPUT) {
        puts("calls before it was opened");
    }
    if (pantin_animator_open(&animator, &clips[0], &memory) != PANTIN_OK) {
        puts("refused");
        return;
    }
    print(&animator);
    while ((script = next_line(script, &word, n, &count)) != NULL) {
        pantin_result result = PANTIN_OK;
        pantin_placement placement;
        switch (word) {
        case 'w':
            result = pantin_animator_switch(&animator, &clips[n[0]], (uint32_t)n[1], (int32_t)n[2], (pantin_transition)n[3], (uint8_t)n[4]);
            break;
        case 'k': result = pantin_animator_seek(&animator, (uint32_t)n[0]); break;
        case 'v': pantin_animator_speed(&animator, (int32_t)n[0]); break;
        case 's':
            placement.place[0] = n[0];
            placement.place[1] = n[1];
            placement.heading = (int32_t)n[2];
            pantin_animator_stand(&animator, &placement);
            break;
        case 'p': result = pantin_animator_step(&animator); break;
        default: result = pantin_animator_update(&animator, (uint32_t)n[0]);
        }
        if (result != PANTIN_OK) printf("refused ");
        print(&animator);
        if (count == 1) {
            pantin_animator_take(&animator, &fired);
        } else {
            while (pantin_animator_take(&animator, &fired)) {}
            animator.lost = 0;
        }
    }
}

static void print_state(void) {
    printf("%u %u %u ", character.state, pantin_character_held(&character, 0), pantin_character_held(&character, 1));
    print(&character.animator);
}

static void steer(const char *script, pantin_source *source, int lent) {
    long long n[8];
    int count, blends = lent & 1;
    char word;
    uint8_t without = (uint8_t)((blends ? 0 : PANTIN_WITHOUT_LAYERS | PANTIN_WITHOUT_BLENDS) | (lent & 2 ? 0 : PANTIN_WITHOUT_FEET)), i;
    pantin_result opened = pantin_character_open(&character, source, &memory, without), held;
    if (opened == PANTIN_OK && blends) opened = pantin_character_second(&character, &second, second_moving, STATES, second_values, CHANNELS);
    for (i = 0; opened == PANTIN_OK && blends && i < character.counts[7]; i++) {
        opened = pantin_character_layer(&character, &layers[i], layer_moving[i], STATES, layer_values[i], sampled[i], CHANNELS, words[i], 16);
    }
    if (opened == PANTIN_OK && lent & 2) {
        held = pantin_character_feet(&character, &feet);
        if (held != PANTIN_NOT_FOUND) opened = held;
    }
    if (opened != PANTIN_OK) {
        memset(&character, 0, sizeof character);
        if (pantin_character_feet(&character, &feet) == PANTIN_OK) puts("feet before it was opened");
        if (pantin_character_update(&character, 1) == PANTIN_OK) puts("an update before it was opened");
        puts("refused");
        return;
    }
    print_state();
    while ((script = next_line(script, &word, n, &count)) != NULL) {
        pantin_result result;
        switch (word) {
        case 'f': pantin_character_fire(&character, (uint8_t)n[0]); break;
        case 'h': pantin_character_hold(&character, (uint8_t)n[0], 1); break;
        case 'r': pantin_character_hold(&character, (uint8_t)n[0], 0); break;
        case 's': pantin_character_set(&character, (uint8_t)n[0], (int16_t)n[1]); break;
        default:
            result = pantin_character_update(&character, (uint32_t)n[0]);
            if (result != PANTIN_OK) {
                printf("refused");
            } else {
                printf("%u", character.entered);
            }
            putchar(' ');
            print_state();
        }
    }
}

/* Takes the next of the banks, as memory of its own, so that a sanitizer notices what is read past its end. */
static uint8_t *next_bank(const uint8_t *banks, uint32_t length, uint32_t *at, pantin_source *source) {
    uint32_t size;
    uint8_t *bank;
    if (*at + 4 > length) return NULL;
    size = banks[*at] | (uint32_t)banks[*at + 1] << 8 | (uint32_t)banks[*at + 2] << 16 | (uint32_t)banks[*at + 3] << 24;
    bank = (uint8_t *)malloc(size ? size : 1);
    if (!bank) exit(2);
    memcpy(bank, banks + *at + 4, size);
    pantin_memory(source, bank, size);
    *at += 4 + size;
    return bank;
}

static void parts(const char *path) {
    uint32_t length, at = 0;
    uint8_t *banks = file(path, &length), *bank, without;
    while ((bank = next_bank(banks, length, &at, &sources[0])) != NULL) {
        for (without = 0; without < 8; without++) {
            pantin_result result = pantin_character_open(&character, &sources[0], &memory, without);
            printf("%d ", result == PANTIN_OK ? pantin_character_update(&character, 1000) : result);
        }
        puts("");
        free(bank);
    }
    free(banks);
}

int main(int argc, char **argv) {
    uint32_t length, at = 0;
    uint8_t *bytes[CLIPS], *bank;
    char *script;
    int i;
    if (argc == 3 && strcmp(argv[1], "parts") == 0) {
        parts(argv[2]);
        return 0;
    }
    if (argc < 4 || argc - 3 > CLIPS) return 2;
    script = (char *)file(argv[2], &length);
    script = (char *)realloc(script, length + 1);
    if (!script) return 2;
    script[length] = 0;
    if (strcmp(argv[1], "steer") == 0) {
        bytes[0] = file(argv[3], &length);
        while ((bank = next_bank(bytes[0], length, &at, &sources[0])) != NULL) {
            steer(script, &sources[0], argc > 4 ? atoi(argv[4]) : 0);
            free(bank);
        }
        free(bytes[0]);
    } else {
        for (i = 0; i < argc - 3; i++) {
            bytes[i] = file(argv[3 + i], &length);
            pantin_memory(&sources[i], bytes[i], length);
            if (pantin_open(&clips[i], &sources[i], NULL) != PANTIN_OK) return 3;
        }
        play(script);
        for (i = 0; i < argc - 3; i++) free(bytes[i]);
    }
    free(script);
    return 0;
}
