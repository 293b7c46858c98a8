/* What a widget costs on an emulated Cortex-M4: SHOWN is the function below that makes it. Prints bytes of LVGL's memory and of the heap, bytes of stack,
 * instructions of each picture, in the mean and at most, and the number of pictures in 3 s. QEMU's clock goes on by a nanosecond an instruction (-icount shift=0), and SysTick counts 40 of them. */
#include <malloc.h>
#include <stdio.h>
#include <string.h>

#include "lvgl.h"

enum { SIZE = 240, FRAMES = 90, PERIOD = 33, STACK = 256 * 1024 };

#define SYSTICK ((volatile uint32_t *)0xe000e010u)
#define CPACR (*(volatile uint32_t *)0xe000ed88u)
#define TICK 40u

/* The floating-point unit is off at reset. */
__attribute__((constructor(101))) static void start(void) {
    CPACR |= 0xfu << 20;
    __asm volatile("dsb\nisb");
}

static uint32_t now;
static uint32_t get_tick(void) { return now; }

static uint8_t rows[SIZE * 24 * 2] __attribute__((aligned(4)));
static uint32_t sent;

static void flush(lv_display_t *display, const lv_area_t *area, uint8_t *pixels) {
    LV_UNUSED(pixels);
    sent += lv_area_get_size(area);
    lv_display_flush_ready(display);
}

/* ---- What is shown ---- */

void make_nothing(void) { lv_image_create(lv_screen_active()); }

#if defined(WITH_PANTIN)
#include "lv_pantin.h"
extern const uint8_t bank[], bank_end[];

void make_face(void) {
    lv_obj_t *face = lv_pantin_create(lv_screen_active());
    lv_obj_set_size(face, SIZE, SIZE);
    lv_pantin_set_emote(face, "laughing");
}

#if LV_PANTIN_BODY
static void make_body(bool lines) {
    lv_obj_t *body = lv_pantin_create(lv_screen_active());
    lv_obj_set_size(body, SIZE, SIZE);
    lv_pantin_set_lines(body, lines);
    if (lv_pantin_set_src(body, bank, (uint32_t)(bank_end - bank)) != LV_RESULT_OK) puts("refused");
    lv_pantin_hold(body, "go", true);
}

void make_solid(void) { make_body(false); }
void make_lines(void) { make_body(true); }
#endif
#endif

#if defined(WITH_GIF)
extern const uint8_t gif[], gif_end[];

void make_gif(void) {
    static lv_image_dsc_t image;
    lv_obj_t *obj = lv_gif_create(lv_screen_active());
    image.header.magic = LV_IMAGE_HEADER_MAGIC;
    image.header.cf = LV_COLOR_FORMAT_RAW;
    image.data = gif;
    image.data_size = (uint32_t)(gif_end - gif);
    lv_gif_set_color_format(obj, LV_COLOR_FORMAT_RGB565);
    lv_gif_set_src(obj, &image);
    if (!lv_gif_is_loaded(obj)) puts("refused");
}
#endif

#if defined(WITH_LOTTIE)
extern const uint8_t lottie[], lottie_end[];

void make_lottie(void) {
    lv_obj_t *obj = lv_lottie_create(lv_screen_active());
    lv_draw_buf_t *picture = lv_draw_buf_create(SIZE, SIZE, LV_COLOR_FORMAT_ARGB8888_PREMULTIPLIED, LV_STRIDE_AUTO);
    lv_lottie_set_draw_buf(obj, picture);
    lv_lottie_set_src_data(obj, lottie, (size_t)(lottie_end - lottie));
}
#endif

void SHOWN(void);

/* ---- The measurement ---- */

static uint32_t lowest;

static uint32_t stack_pointer(void) {
    uint32_t at;
    __asm volatile("mov %0, sp" : "=r"(at));
    return at;
}

static void paint(void) {
    uint32_t to = stack_pointer() - 64, at;
    lowest = to - STACK;
    for (at = lowest; at < to; at += 4) *(volatile uint32_t *)at = 0xa5a5a5a5u;
}

static uint32_t touched(void) {
    uint32_t at = lowest;
    while (*(volatile uint32_t *)at == 0xa5a5a5a5u) at += 4;
    return stack_pointer() - at;
}

/* Instructions of one frame, in steps of 40. */
static uint32_t frame(void) {
    uint32_t from;
    SYSTICK[1] = 0xffffff;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5;
    from = SYSTICK[2];
    lv_timer_handler();
    return ((from - SYSTICK[2]) & 0xffffff) * TICK;
}

int main(void) {
    lv_mem_monitor_t monitor;
    lv_display_t *display;
    uint64_t sum = 0;
    uint32_t i, most = 0, pictures = 0, before, used, count;
    paint();
    lv_init();
    lv_tick_set_cb(get_tick);
    display = lv_display_create(SIZE, SIZE);
    lv_display_set_color_format(display, LV_COLOR_FORMAT_RGB565);
    lv_display_set_buffers(display, rows, NULL, sizeof rows, LV_DISPLAY_RENDER_MODE_PARTIAL);
    lv_display_set_flush_cb(display, flush);
    lv_timer_handler();
    lv_mem_monitor(&monitor);
    before = (uint32_t)(monitor.total_size - monitor.free_size);
    SHOWN();
    for (i = 0; i < 10; i++) {
        now += PERIOD;
        lv_timer_handler();
    }
    for (i = 0; i < FRAMES; i++) {
        now += PERIOD;
        sent = 0;
        count = frame();
        /* Between two pictures of a GIF nothing is drawn. */
        if (!sent) continue;
        pictures++;
        sum += count;
        most = LV_MAX(most, count);
    }
    lv_mem_monitor(&monitor);
    used = (uint32_t)monitor.max_used - before;
    printf("%u %u %u %u %u %u\n", (unsigned)used, (unsigned)mallinfo().uordblks, (unsigned)touched(), (unsigned)(sum / LV_MAX(pictures, 1)),
           (unsigned)most, (unsigned)pictures);
    return 0;
}
