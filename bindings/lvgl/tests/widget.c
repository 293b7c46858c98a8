/* The widget on LVGL's test display: the pixels of pantin_face.h, memory that does not grow, areas that are small, and what is refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lv_pantin.h"
#include "pantin_face_data.h"

#define SIZE 240
#define NEED(held) need(held, #held, __LINE__)

static void need(int held, const char *what, int line) {
    if (held) return;
    printf("line %d failed: %s\n", line, what);
    exit(1);
}

static void say(lv_log_level_t level, const char *text) {
    LV_UNUSED(level);
    fputs(text, stderr);
}

static size_t used(void) {
    lv_mem_monitor_t monitor;
    lv_mem_monitor(&monitor);
    return monitor.total_size - monitor.free_size;
}

static uint64_t drawn; /* pixels of areas that were to be drawn again */

static void invalidated(lv_event_t *e) { drawn += lv_area_get_size((const lv_area_t *)lv_event_get_param(e)); }

/* A face beside the widget's, of the same size, emotes and seed. */
static uint32_t memory[PANTIN_FACE_WORDS(97, 12)];
static pantin_face reference;
static uint16_t rows[SIZE * SIZE];

static void reference_open(pantin_face *of) {
    NEED(pantin_face_open(&reference, pantin_cartoon, sizeof pantin_cartoon, memory, sizeof memory) == PANTIN_OK);
    NEED(pantin_face_size(&reference, SIZE, SIZE) == PANTIN_OK);
    NEED(pantin_face_emotes(&reference, pantin_emotes, PANTIN_EMOTES) == PANTIN_OK);
    NEED(pantin_face_live(&reference, 7) == PANTIN_OK && pantin_face_live(of, 7) == PANTIN_OK);
}

/* Whether the display shows the reference's pixels; colours of the display have 16 bits, or 8 of brightness. */
static int shows_reference(lv_display_t *display, pantin_face_format format) {
    lv_draw_buf_t *buffer = lv_display_get_buf_active(display);
    uint32_t bytes = format == PANTIN_L8 ? 1 : 2, y;
    NEED(pantin_face_draw(&reference, format, rows, SIZE * bytes, 0, SIZE) == PANTIN_OK);
    for (y = 0; y < SIZE; y++) {
        if (memcmp(buffer->data + y * buffer->header.stride, (uint8_t *)rows + y * SIZE * bytes, SIZE * bytes) != 0) return 0;
    }
    return 1;
}

static void pixels(lv_display_t *display, lv_color_format_t colours, pantin_face_format format) {
    lv_obj_t *face;
    uint32_t emote, frame, pictures = 0;
    lv_display_set_color_format(display, colours);
    face = lv_pantin_create(lv_screen_active());
    NEED(face != NULL);
    lv_obj_set_size(face, SIZE, SIZE);
    reference_open(lv_pantin_get_face(face));
    lv_test_wait(1);
    /* Both begin at a picture of the widget: time until the next blink passes with each. */
    while (lv_pantin_get_face(face)->next_blink_ms == reference.next_blink_ms) lv_test_wait(1);
    reference_open(lv_pantin_get_face(face));
    for (emote = 0; emote < PANTIN_EMOTES; emote++) {
        NEED(lv_pantin_set_emote(face, pantin_emotes[emote].name) == LV_RESULT_OK);
        NEED(pantin_face_emote(&reference, pantin_emotes[emote].name) == PANTIN_OK);
        for (frame = 0; frame < 40; frame++, pictures++) {
            lv_test_wait(LV_PANTIN_PERIOD);
            NEED(pantin_face_step(&reference, LV_PANTIN_PERIOD) == PANTIN_OK);
            if (!shows_reference(display, format)) {
                printf("%s, picture %u, is not the reference's\n", pantin_emotes[emote].name, (unsigned)frame);
                exit(1);
            }
        }
    }
    printf("%u pictures in colours of format %d\n", (unsigned)pictures, (int)colours);
    lv_obj_delete(face);
}

static void switches(void) {
    lv_obj_t *face = lv_pantin_create(lv_screen_active());
    size_t before, i;
    uint64_t all;
    lv_obj_set_size(face, SIZE, SIZE);
    lv_test_wait(200);
    before = used();
    for (i = 0; i < 10000; i++) {
        NEED(lv_pantin_set_emote(face, pantin_emotes[i * 7 % PANTIN_EMOTES].name) == LV_RESULT_OK);
        lv_test_fast_forward(i % 5 == 0 ? 700 : LV_PANTIN_PERIOD);
        if (i == 30) before = used();
    }
    NEED(used() <= before);
    /* A face at rest, then one that blinks, is drawn in part. */
    NEED(pantin_face_live(lv_pantin_get_face(face), 0) == PANTIN_OK);
    NEED(lv_pantin_set_emote(face, "neutral") == LV_RESULT_OK);
    lv_test_wait(2000);
    drawn = 0;
    lv_test_wait(3000);
    all = (uint64_t)SIZE * SIZE * (3000 / LV_PANTIN_PERIOD);
    printf("10,000 emotes, %u bytes before and after; at rest %.2f %%", (unsigned)before, 100.0 * (double)drawn / (double)all);
    NEED(drawn < all / 2);
    drawn = 0;
    NEED(pantin_face_live(lv_pantin_get_face(face), 3) == PANTIN_OK);
    lv_test_wait(30000);
    printf(", blinking %.2f %% of the picture is drawn\n", 10.0 * (double)drawn / (double)all);
    NEED(drawn > 0 && drawn < 10 * all / 2);
    lv_obj_delete(face);
}

static void speech(void) {
    static int16_t samples[1600];
    lv_obj_t *face = lv_pantin_create(lv_screen_active());
    uint32_t i;
    /* Half a second of a sound that has what e has, at 700 and 2100 Hz. */
    for (i = 0; i < 1600; i++) samples[i] = (int16_t)((i * 700 % 16000 < 8000 ? 6000 : -6000));
    for (i = 0; i < 5; i++) {
        lv_pantin_push_pcm(face, samples, 1600);
        lv_test_wait(100);
    }
    NEED(lv_pantin_get_face(face)->visemes[10] > 8192);
    lv_test_wait(400);
    NEED(lv_pantin_get_face(face)->visemes[10] == 0);
    NEED(lv_pantin_set_viseme(face, 1, 100) == LV_RESULT_OK && lv_pantin_set_viseme(face, 0, 300) == LV_RESULT_OK);
    lv_test_wait(200);
    NEED(lv_pantin_get_face(face)->visemes[0] > 16000 && lv_pantin_get_face(face)->speaking > 16000);
    lv_test_wait(3000);
    NEED(lv_pantin_get_face(face)->speaking == 0);
    NEED(lv_pantin_set_viseme(face, 15, 0) == LV_RESULT_INVALID);
    NEED(lv_pantin_set_rate(face, 7000) == LV_RESULT_INVALID && lv_pantin_set_rate(face, 48000) == LV_RESULT_OK);
    lv_obj_delete(face);
}

/* A size of 0 gives the picture's memory back; a larger one than pictures have shows what they can. */
static void sizes(void) {
    lv_obj_t *face = lv_pantin_create(lv_screen_active());
    size_t without, with;
    lv_obj_set_size(face, 0, 0);
    lv_test_wait(100);
    without = used();
    lv_obj_set_size(face, SIZE, SIZE);
    lv_test_wait(100);
    with = used();
    NEED(with > without + SIZE * SIZE);
    lv_obj_set_size(face, 0, 0);
    lv_test_wait(100);
    NEED(used() < with - SIZE * SIZE);
    lv_obj_set_size(face, 3000, 4);
    lv_test_wait(100);
    NEED(lv_pantin_get_face(face)->width == 2047);
    lv_obj_delete(face);
}

static void refused(lv_display_t *display) {
    static uint8_t damaged[sizeof pantin_cartoon];
    lv_draw_buf_t *picture;
    lv_obj_t *face = lv_pantin_create(lv_screen_active());
    lv_obj_set_size(face, SIZE, SIZE);
    lv_test_wait(100);
    memcpy(damaged, pantin_cartoon, sizeof damaged);
    damaged[2] ^= 0x55;
    NEED(lv_pantin_set_src(face, damaged, sizeof damaged) == LV_RESULT_INVALID);
    NEED(lv_pantin_set_src(face, pantin_cartoon, 100) == LV_RESULT_INVALID);
    NEED(lv_pantin_set_emote(face, "nobody") == LV_RESULT_INVALID && lv_pantin_set_emote(face, NULL) == LV_RESULT_INVALID);
    /* Another face is shown in the picture that is there: there may be no memory for a second one. */
    picture = lv_canvas_get_draw_buf(face);
    NEED(lv_pantin_set_src(face, pantin_cartoon, sizeof pantin_cartoon) == LV_RESULT_OK);
    NEED(lv_pantin_set_src(face, NULL, 0) == LV_RESULT_OK);
    NEED(picture && lv_canvas_get_draw_buf(face) == picture);
    NEED(lv_pantin_set_emote(face, "happy") == LV_RESULT_OK);
    /* Sizes without a picture, and a size for which there is no memory. */
    lv_obj_set_size(face, 0, 0);
    lv_test_wait(100);
    lv_obj_set_size(face, 1, 1);
    lv_test_wait(100);
    lv_obj_set_size(face, 2000, 2000);
    lv_test_wait(100);
    lv_obj_set_size(face, SIZE, SIZE);
    lv_test_wait(100);
    NEED(lv_canvas_get_draw_buf(face) != NULL);
    lv_display_set_color_format(display, LV_COLOR_FORMAT_I1);
    lv_obj_set_size(face, 128, 64);
    lv_test_wait(100);
    lv_display_set_color_format(display, LV_COLOR_FORMAT_RGB565);
    lv_obj_delete(face);
}

int main(void) {
    lv_display_t *display;
    size_t before;
    lv_init();
    lv_log_register_print_cb(say);
    display = lv_test_display_create(SIZE, SIZE);
    lv_display_add_event_cb(display, invalidated, LV_EVENT_INVALIDATE_AREA, NULL);
    lv_obj_set_style_bg_opa(lv_screen_active(), LV_OPA_COVER, 0);
    /* The screen keeps lists once it has had an object. */
    lv_obj_delete(lv_pantin_create(lv_screen_active()));
    lv_test_wait(100);
    speech();
    before = used();
    pixels(display, LV_COLOR_FORMAT_RGB565, PANTIN_RGB565);
    pixels(display, LV_COLOR_FORMAT_L8, PANTIN_L8);
    lv_display_set_color_format(display, LV_COLOR_FORMAT_RGB565);
    switches();
    speech();
    sizes();
    refused(display);
    lv_test_wait(100);
    printf("%u bytes of LVGL's memory before the faces, %u after\n", (unsigned)before, (unsigned)used());
    NEED(used() <= before);
    return 0;
}
