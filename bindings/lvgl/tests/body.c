/* Bodies of the widget on LVGL's test display: the pixels of pantin_solid.h in the poses of pantin_animator.h, memory that does not grow, and what is
 * refused.
 *
 *     body CLIP BANK MACHINE FEET ONCE : a clip, a bank of clips called walk and run, two banks with state machines, the second with feet, and a clip that
 *     is no loop */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../c/tests/file.h"
#include "lv_pantin.h"
#include "pantin_face_data.h"
#include "pantin_feet.h"
#include "pantin_solid.h"

enum { SIZE = 240, CHANNELS = 160, JOINTS = 96, LAYERS = 4 };

#define NEED(held) need(held, #held, __LINE__)

static void need(int held, const char *what, int line) {
    if (held) return;
    printf("line %d failed: %s\n", line, what);
    exit(1);
}

static unsigned warnings;

static void say(lv_log_level_t level, const char *text) {
    LV_UNUSED(level);
    LV_UNUSED(text);
    warnings++;
}

static size_t used(void) {
    lv_mem_monitor_t monitor;
    lv_mem_monitor(&monitor);
    return monitor.total_size - monitor.free_size;
}

typedef struct {
    uint8_t *bytes;
    uint32_t length;
} content;

static content clip_file, bank_file, machine_file, feet_file, once_file;

/* ---- A body beside the widget's ---- */

typedef struct {
    pantin_channel moving[CHANNELS];
    int32_t values[CHANNELS], pose[CHANNELS];
} playing;

static playing own, second, layers_own[LAYERS], camera;
static pantin_offset offsets[CHANNELS];
static pantin_group groups[CHANNELS];
static const pantin_animator_memory memory = {own.moving, CHANNELS, own.values, own.pose, offsets, CHANNELS, groups, CHANNELS};
static pantin_source source;
static pantin_bank bank;
static pantin_clip clip;
static pantin_track second_track;
static pantin_layer layers[LAYERS];
static uint32_t words[LAYERS][16];
static pantin_feet feet;
static pantin_character character;
static pantin_bone bones[JOINTS];
static pantin_drive drives[CHANNELS];
static pantin_slot slots[PANTIN_FIGURE_SLOTS];
static pantin_joint_info scratch[JOINTS];
static pantin_solid solid;
static uint16_t rows[SIZE * SIZE];
static int machine;

static void aim(const pantin_view *view) {
    pantin_player player;
    memset(&solid, 0, sizeof solid);
    NEED(pantin_start(&player, &clip, camera.pose, CHANNELS, camera.moving, CHANNELS) == PANTIN_OK);
    pantin_figure_memory(&solid.figure, bones, JOINTS, drives, CHANNELS, slots, PANTIN_FIGURE_SLOTS);
    NEED(pantin_solid_set_up(&solid, &player, SIZE, SIZE, scratch, JOINTS) == PANTIN_OK);
    NEED(pantin_solid_aim(&solid, &player, view) == PANTIN_OK);
}

static void reference_open(const content *of) {
    pantin_entry entry;
    uint8_t i;
    pantin_result held;
    pantin_memory(&source, of->bytes, of->length);
    machine = pantin_character_open(&character, &source, &memory, 0) == PANTIN_OK;
    if (machine) {
        NEED(pantin_character_second(&character, &second_track, second.moving, CHANNELS, second.values, CHANNELS) == PANTIN_OK);
        for (i = 0; i < character.counts[7]; i++) {
            playing *lent = &layers_own[i];
            NEED(pantin_character_layer(&character, &layers[i], lent->moving, CHANNELS, lent->values, lent->pose, CHANNELS, words[i], 16) == PANTIN_OK);
        }
        held = pantin_character_feet(&character, &feet);
        NEED(held == PANTIN_OK || held == PANTIN_NOT_FOUND);
        clip = character.animator.track.clip;
    } else {
        if (pantin_open_bank(&bank, &source) == PANTIN_OK) {
            pantin_first_entry(&entry, &bank);
            NEED(pantin_next_entry(&entry) && pantin_open_entry(&clip, &entry) == PANTIN_OK);
        } else {
            NEED(pantin_open(&clip, &source, NULL) == PANTIN_OK);
        }
        NEED(pantin_animator_open(&character.animator, &clip, &memory) == PANTIN_OK);
    }
    aim(&pantin_default_view);
    /* The order of parts can depend on the poses before: the widget draws frame 0 at once. */
    pantin_solid_pose_at(&solid, character.animator.pose, &character.animator.placement);
}

static void reference_step(uint32_t ms) {
    NEED((machine ? pantin_character_update(&character, ms * 1000) : pantin_animator_update(&character.animator, ms * 1000)) == PANTIN_OK);
}

/* Whether the display shows the reference's pixels. */
static int shows_reference(lv_display_t *display, pantin_format format, int lines) {
    lv_draw_buf_t *buffer = lv_display_get_buf_active(display);
    uint32_t bytes = format == PANTIN_L8 ? 1 : 2, y;
    const pantin_animator *animator = &character.animator;
    if (lines) {
        pantin_figure_pose_at(&solid.figure, animator->pose, &animator->placement);
        NEED(pantin_figure_draw(&solid.figure, format, rows, SIZE * bytes, 0, SIZE, 1) == PANTIN_OK);
    } else {
        pantin_solid_pose_at(&solid, animator->pose, &animator->placement);
        NEED(pantin_solid_draw(&solid, format, rows, SIZE * bytes, 0, SIZE, 1) == PANTIN_OK);
    }
    for (y = 0; y < SIZE; y++) {
        if (memcmp(buffer->data + y * buffer->header.stride, (uint8_t *)rows + y * SIZE * bytes, SIZE * bytes) != 0) return 0;
    }
    return 1;
}

/* ---- The tests ---- */

/* A widget whose timer has just run. */
static lv_obj_t *made(void) {
    lv_obj_t *obj = lv_pantin_create(lv_screen_active());
    uint16_t before;
    NEED(obj != NULL);
    lv_obj_set_size(obj, SIZE, SIZE);
    lv_test_wait(1);
    before = lv_pantin_get_face(obj)->next_blink_ms;
    while (lv_pantin_get_face(obj)->next_blink_ms == before) lv_test_wait(1);
    return obj;
}

static unsigned states, ends;

static void happened(lv_event_t *e) {
    if (lv_event_get_code(e) == LV_EVENT_VALUE_CHANGED) states++;
    if (lv_event_get_code(e) == LV_EVENT_READY) ends++;
}

/* Presses of the two machines: at a frame, whether an input is held, let go (-1) or fired (0). */
static const struct {
    uint16_t frame;
    int8_t down;
    const char *input;
} presses[] = {{10, 1, "go"}, {70, 0, "wave"}, {100, 1, "fast"}, {150, 0, "jump"}, {160, -1, "fast"}, {190, -1, "go"}, {240, 0, "bow"}};

static void press(lv_obj_t *obj, uint16_t frame) {
    size_t i;
    for (i = 0; i < sizeof presses / sizeof *presses; i++) {
        uint8_t input = machine ? pantin_character_input(&character, presses[i].input) : PANTIN_NO_INPUT;
        lv_result_t wanted = input == PANTIN_NO_INPUT ? LV_RESULT_INVALID : LV_RESULT_OK, given;
        if (presses[i].frame != frame) continue;
        given = presses[i].down ? lv_pantin_hold(obj, presses[i].input, presses[i].down > 0) : lv_pantin_fire(obj, presses[i].input);
        NEED(given == wanted);
        if (presses[i].down) {
            pantin_character_hold(&character, input, presses[i].down > 0);
        } else {
            pantin_character_fire(&character, input);
        }
    }
}

static uint32_t pixels(lv_display_t *display, const content *of, lv_color_format_t colours, int lines) {
    static const pantin_view side = {-90, 5, 0, PANTIN_RIG_UP};
    pantin_format format = colours == LV_COLOR_FORMAT_L8 ? PANTIN_L8 : PANTIN_RGB565;
    lv_obj_t *obj;
    uint16_t frame;
    lv_display_set_color_format(display, colours);
    obj = made();
    lv_pantin_set_lines(obj, lines);
    lv_obj_add_event_cb(obj, happened, LV_EVENT_ALL, NULL);
    if (lv_pantin_set_src(obj, of->bytes, of->length) != LV_RESULT_OK) {
        printf("%u bytes are refused\n", (unsigned)of->length);
        exit(1);
    }
    reference_open(of);
    for (frame = 0; frame < 300; frame++) {
        if (machine) press(obj, frame);
        if (of == &bank_file && frame == 60) {
            NEED(lv_pantin_play(obj, "run") == LV_RESULT_OK && pantin_open_named(&clip, &bank, "run") == PANTIN_OK);
            NEED(pantin_animator_switch(&character.animator, &clip, 0, PANTIN_SPEED, PANTIN_INERTIALIZED, 8) == PANTIN_OK);
        }
        if (of == &once_file && frame == 150) {
            NEED(lv_pantin_play(obj, NULL) == LV_RESULT_OK && lv_pantin_play(obj, "walk") == LV_RESULT_INVALID);
            NEED(pantin_animator_switch(&character.animator, &clip, 0, PANTIN_SPEED, PANTIN_INERTIALIZED, 8) == PANTIN_OK);
        }
        if (frame == 200) {
            NEED(lv_pantin_set_view(obj, side.orbit, side.tilt, side.fixed) == LV_RESULT_OK);
            if (of == &bank_file) NEED(pantin_open_named(&clip, &bank, "walk") == PANTIN_OK);
            aim(&side);
        }
        lv_test_wait(LV_PANTIN_PERIOD);
        reference_step(LV_PANTIN_PERIOD);
        if (!shows_reference(display, format, lines)) {
            printf("picture %u of %u bytes is not the reference's\n", (unsigned)frame, (unsigned)of->length);
            exit(1);
        }
    }
    lv_obj_delete(obj);
    return frame;
}

/* Inputs, clips, bodies and faces, lines and volume, in turn. */
static void changes(void) {
    static const char *const inputs[] = {"go", "wave", "fast", "jump", "bow", "sit", "stand", "trip", "left", "dance"};
    const content *sources[4];
    lv_obj_t *obj = lv_pantin_create(lv_screen_active());
    size_t most = 0;
    uint32_t i, x = 1, fired = 0;
    sources[0] = &machine_file;
    sources[1] = &feet_file;
    sources[2] = &bank_file;
    sources[3] = &clip_file;
    lv_obj_set_size(obj, 96, 96);
    for (i = 0; i < 10000; i++) {
        x = x * 1664525u + 1013904223u;
        if (i % 50 == 0) {
            NEED(lv_pantin_set_src(obj, sources[i / 50 % 4]->bytes, sources[i / 50 % 4]->length) == LV_RESULT_OK);
        } else if (i % 200 == 49) {
            NEED(lv_pantin_set_src(obj, pantin_cartoon, sizeof pantin_cartoon) == LV_RESULT_OK && lv_pantin_set_emote(obj, "happy") == LV_RESULT_OK);
        } else {
            switch (x >> 29) {
            case 0: lv_pantin_set_lines(obj, x >> 28 & 1); break;
            case 1: NEED(lv_pantin_set_view(obj, (int16_t)((x >> 20 & 255) - 128), 10, 0) == LV_RESULT_OK); break;
            case 2: lv_pantin_play(obj, x >> 28 & 1 ? "run" : "walk"); break;
            case 3: lv_pantin_hold(obj, inputs[(x >> 20) % 10], x >> 28 & 1); break;
            default: fired += lv_pantin_fire(obj, inputs[(x >> 20) % 10]) == LV_RESULT_OK;
            }
        }
        lv_test_fast_forward(LV_PANTIN_PERIOD);
        /* The bank with most layers, the first of a round, takes most. */
        if (i < 200) most = LV_MAX(most, used());
        NEED(used() <= most);
    }
    printf("10,000 changes, %u inputs, at most %u bytes of LVGL's memory\n", (unsigned)fired, (unsigned)most);
    NEED(fired > 1000);
    lv_obj_delete(obj);
}

/* What a body takes of LVGL's memory besides its picture. */
static unsigned costs(const content *of) {
    lv_obj_t *obj = lv_pantin_create(lv_screen_active());
    size_t before, picture = 2 * (96 * 96 + 96 * LV_PANTIN_ROWS);
    lv_test_wait(100);
    lv_obj_delete(obj);
    before = used();
    obj = lv_pantin_create(lv_screen_active());
    lv_obj_set_size(obj, 96, 96);
    NEED(lv_pantin_set_src(obj, of->bytes, of->length) == LV_RESULT_OK);
    lv_test_wait(100);
    before = used() - before - picture;
    lv_obj_delete(obj);
    return (unsigned)before;
}

/* Damaged files and wrong calls: the widget stays as it is. */
static void refused(void) {
    lv_obj_t *obj = lv_pantin_create(lv_screen_active());
    uint8_t *damaged = (uint8_t *)malloc(feet_file.length);
    static const uint8_t nothing[4] = {0, 0, 0, 0};
    uint32_t i, opened = 0;
    size_t before;
    NEED(damaged != NULL);
    lv_obj_set_size(obj, 96, 96);
    lv_test_wait(100);
    NEED(lv_pantin_fire(obj, "go") == LV_RESULT_INVALID && lv_pantin_play(obj, NULL) == LV_RESULT_INVALID && !lv_pantin_get_character(obj));
    NEED(lv_pantin_set_src(obj, machine_file.bytes, machine_file.length) == LV_RESULT_OK && lv_pantin_get_character(obj));
    lv_test_wait(100);
    before = used();
    for (i = 0; i < feet_file.length; i++) {
        uint8_t *cut = (uint8_t *)malloc(i ? i : 1);
        NEED(cut != NULL);
        memcpy(cut, feet_file.bytes, i);
        /* A bank without its last sections is one, too. */
        if (lv_pantin_set_src(obj, cut, i) == LV_RESULT_OK) opened++;
        NEED(lv_pantin_set_src(obj, machine_file.bytes, machine_file.length) == LV_RESULT_OK);
        free(cut);
    }
    NEED(used() <= before && opened <= 3);
    opened = 0;
    for (i = 0; i < 2000; i++) {
        memcpy(damaged, feet_file.bytes, feet_file.length);
        damaged[i * 7919u % feet_file.length] ^= (uint8_t)(1u << (i % 8));
        /* A clip of the bank may be damaged that does not play yet. */
        if (lv_pantin_set_src(obj, damaged, feet_file.length) != LV_RESULT_OK) continue;
        opened++;
        lv_pantin_fire(obj, "wave");
        lv_pantin_hold(obj, "go", true);
        lv_test_fast_forward(200);
        NEED(lv_pantin_set_src(obj, machine_file.bytes, machine_file.length) == LV_RESULT_OK);
    }
    NEED(used() <= before && opened < 2000);
    NEED(lv_pantin_set_emote(obj, "happy") == LV_RESULT_INVALID && lv_pantin_set_viseme(obj, 1, 0) == LV_RESULT_INVALID);
    NEED(lv_pantin_fire(obj, "no such input") == LV_RESULT_INVALID && lv_pantin_fire(obj, NULL) == LV_RESULT_INVALID);
    NEED(lv_pantin_hold(obj, "no such input", true) == LV_RESULT_INVALID && lv_pantin_set_parameter(obj, "none", 1) == LV_RESULT_INVALID);
    NEED(lv_pantin_play(obj, "walk") == LV_RESULT_INVALID);
    NEED(lv_pantin_set_look(obj, nothing, sizeof nothing) == LV_RESULT_INVALID && lv_pantin_set_look(obj, NULL, 0) == LV_RESULT_OK);
    lv_obj_set_size(obj, 0, 0);
    lv_test_wait(100);
    lv_obj_set_size(obj, 2000, 2000);
    lv_test_wait(100);
    lv_obj_set_size(obj, 96, 96);
    lv_test_wait(100);
    NEED(lv_canvas_get_draw_buf(obj) != NULL);
    free(damaged);
    lv_obj_delete(obj);
}

static content read_file(const char *path) {
    content read;
    read.bytes = file(path, &read.length);
    return read;
}

int main(int argc, char **argv) {
    lv_display_t *display;
    size_t before;
    uint32_t pictures = 0;
    const content *all[] = {&clip_file, &bank_file, &machine_file, &feet_file, &once_file};
    uint8_t i;
    if (argc != 6) return 2;
    clip_file = read_file(argv[1]);
    bank_file = read_file(argv[2]);
    machine_file = read_file(argv[3]);
    feet_file = read_file(argv[4]);
    once_file = read_file(argv[5]);
    lv_init();
    lv_log_register_print_cb(say);
    display = lv_test_display_create(SIZE, SIZE);
    lv_obj_set_style_bg_opa(lv_screen_active(), LV_OPA_COVER, 0);
    lv_obj_delete(lv_pantin_create(lv_screen_active()));
    lv_test_wait(100);
    before = used();
    for (i = 0; i < 5; i++) {
        pictures += pixels(display, all[i], LV_COLOR_FORMAT_RGB565, 0);
        pictures += pixels(display, all[i], LV_COLOR_FORMAT_RGB565, 1);
        pictures += pixels(display, all[i], LV_COLOR_FORMAT_L8, 0);
    }
    printf("%u pictures of bodies, %u states entered, %u clips that ended\n", (unsigned)pictures, states, ends);
    /* Once in each of the three runs, and again after lv_pantin_play. */
    NEED(states > 20 && ends == 6);
    lv_display_set_color_format(display, LV_COLOR_FORMAT_RGB565);
    changes();
    refused();
    lv_test_wait(100);
    for (i = 0; i < 4; i++) printf("%s%u", i == 0 ? "a clip, a bank, two state machines without their pictures: " : ", ", costs(all[i]));
    printf(" bytes\n");
    NEED(used() <= before && warnings > 0);
    for (i = 0; i < 5; i++) free(all[i]->bytes);
    return 0;
}
