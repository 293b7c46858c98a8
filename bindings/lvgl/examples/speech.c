/* Shows a face that speaks a recording, on LVGL's test display (LV_USE_TEST). On a display of your own, lv_timer_handler() stands in place of
 * lv_test_wait(): it runs in a loop, and LVGL has a tick (lv_tick_set_cb). Push sound where you play it.
 *
 *     speech SOUND RATE PICTURES : 16-bit samples of one channel; writes RGB565 pictures of 240 by 240, one every 40 ms, and prints, every 10 ms, how far the
 *     visemes open the jaw in thousandths */
#include <stdio.h>
#include <stdlib.h>

#include "lv_pantin.h"

enum { SIZE = 240, PART_MS = 10, PICTURE_MS = 40, TAIL_MS = 600 };

/* How far each viseme opens the jaw, as in talk_speech.py: aa, e, o, i, u, ss; in thousandths. */
static uint32_t jaw(const pantin_talk *talk) {
    static const uint16_t parts[PANTIN_TALK_VISEMES] = {0, 0, 0, 0, 0, 0, 150, 0, 0, 1000, 800, 300, 800, 300};
    uint64_t sum = 0;
    uint8_t i;
    for (i = 0; i < PANTIN_TALK_VISEMES; i++) sum += (uint64_t)talk->weights[i] * parts[i];
    return (uint32_t)(sum / PANTIN_TALK_FULL);
}

/* Reads samples of 16 bits in this machine's order of bytes. NULL if it cannot. */
static int16_t *read_sound(const char *path, uint32_t *count) {
    FILE *f = fopen(path, "rb");
    int16_t *samples = NULL;
    long bytes;
    if (!f) return NULL;
    if (fseek(f, 0, SEEK_END) == 0 && (bytes = ftell(f)) > 0 && fseek(f, 0, SEEK_SET) == 0) {
        *count = (uint32_t)bytes / 2;
        samples = (int16_t *)malloc((size_t)*count * 2);
        if (samples && fread(samples, 2, *count, f) != *count) *count = 0;
    }
    fclose(f);
    return samples;
}

int main(int argc, char **argv) {
    uint32_t rate, ms, count, y;
    int16_t *sound;
    FILE *pictures;
    lv_display_t *display;
    lv_obj_t *face;
    if (argc != 4) return 2;
    sound = read_sound(argv[1], &count);
    rate = (uint32_t)atol(argv[2]);
    pictures = fopen(argv[3], "wb");
    if (!sound || !pictures) return 2;
    lv_init();
    display = lv_test_display_create(SIZE, SIZE);
    lv_display_set_color_format(display, LV_COLOR_FORMAT_RGB565);
    lv_obj_set_style_bg_opa(lv_screen_active(), LV_OPA_COVER, 0);
    face = lv_pantin_create(lv_screen_active());
    if (!face || lv_pantin_set_rate(face, rate) != LV_RESULT_OK) return 3;
    lv_obj_set_size(face, SIZE, SIZE);
    lv_pantin_set_emote(face, "neutral");
    pantin_face_live(lv_pantin_get_face(face), 5);
    lv_test_wait(1000);
    for (ms = 0; ms < count * 1000ull / rate + TAIL_MS; ms += PART_MS) {
        uint32_t from = (uint32_t)((uint64_t)ms * rate / 1000), to = (uint32_t)((uint64_t)(ms + PART_MS) * rate / 1000);
        if (to > count) to = count;
        if (from < to) lv_pantin_push_pcm(face, sound + from, to - from);
        lv_test_wait(PART_MS);
        printf("%u\n", (unsigned)jaw(lv_pantin_get_talk(face)));
        if (ms % PICTURE_MS == PICTURE_MS - PART_MS) {
            lv_draw_buf_t *buffer = lv_display_get_buf_active(display);
            for (y = 0; y < SIZE; y++) fwrite(buffer->data + y * buffer->header.stride, 2, SIZE, pictures);
        }
    }
    fclose(pictures);
    free(sound);
    return 0;
}
