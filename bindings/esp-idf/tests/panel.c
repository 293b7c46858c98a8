/* Runs an example of the component with a display in memory: esp_lcd as a panel by SPI, which sends after draw_bitmap has returned, and waits with the next
 * call until that was sent.
 *
 *     panel WIDTH HEIGHT FRAMES PICTURE : writes the last picture, and prints what was checked */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "driver/gpio.h"
#include "driver/spi_master.h"
#include "esp_heap_caps.h"
#include "esp_lcd_gc9a01.h"
#include "esp_lcd_ili9341.h"
#include "esp_lcd_panel_io.h"
#include "esp_log.h"
#include "esp_timer.h"
#include "freertos/task.h"
#include "pantin_panel.h"

void app_main(void);

struct esp_lcd_panel_t {
    int on;
};
struct esp_lcd_panel_io_t {
    int bus;
};
static struct esp_lcd_panel_t panel;
static struct esp_lcd_panel_io_t io;

static unsigned width, height, frames, frames_left, rows_sent, pictures, differing;
static uint8_t *shown, *before;
static jmp_buf enough;
static int64_t now_us;
static size_t allocated, limit = SIZE_MAX;

/* What is still to be sent. */
static struct {
    const uint8_t *rows;
    size_t count;
    uint8_t *copy;
    unsigned y;
} sending;

static void need(int held, const char *what) {
    if (held) return;
    printf("failed: %s\n", what);
    exit(1);
}

void test_failed(const char *what) { need(0, what); }

void test_log(const char *tag, const char *format, ...) {
    va_list list;
    va_start(list, format);
    fprintf(stderr, "%s: ", tag);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
}

void *heap_caps_malloc(size_t size, uint32_t caps) {
    need(caps == MALLOC_CAP_DMA, "rows are in memory for DMA");
    if (allocated + size > limit) return NULL;
    allocated += size;
    return malloc(size);
}

void heap_caps_free(void *memory) { free(memory); }
int64_t esp_timer_get_time(void) { return now_us; }
TickType_t xTaskGetTickCount(void) { return (TickType_t)(now_us / 1000); }

static void finish_sending(void) {
    if (!sending.rows) return;
    need(memcmp(sending.rows, sending.copy, sending.count) == 0, "rows that are being sent are not drawn into");
    memcpy(shown + sending.y * width * 2, sending.copy, sending.count);
    free(sending.copy);
    sending.rows = NULL;
}

/* A frame has ended. */
static void pause_for(TickType_t ticks) {
    need(ticks > 0 && ticks <= 50, "a frame takes 50 ms at most");
    now_us += ticks * 1000 + 400;
    finish_sending();
    need(rows_sent == height, "every row is sent once a frame");
    rows_sent = 0;
    pictures++;
    if (memcmp(shown, before, width * height * 2) != 0) differing++;
    memcpy(before, shown, width * height * 2);
    if (--frames_left == 0) longjmp(enough, 1);
}

void vTaskDelay(TickType_t ticks) { pause_for(ticks); }

int xTaskDelayUntil(TickType_t *previous, TickType_t ticks) {
    *previous += ticks;
    pause_for(ticks);
    return 1;
}

esp_err_t spi_bus_initialize(spi_host_device_t host, const spi_bus_config_t *config, spi_dma_chan_t dma) {
    (void)host;
    need(dma == SPI_DMA_CH_AUTO && config->max_transfer_sz >= (int)(width * 2 * CONFIG_PANTIN_ROWS), "the bus takes rows");
    need(config->sclk_io_num >= 0 && config->mosi_io_num >= 0, "the bus has pins");
    return ESP_OK;
}

esp_err_t esp_lcd_new_panel_io_spi(esp_lcd_spi_bus_handle_t bus, const esp_lcd_panel_io_spi_config_t *config, esp_lcd_panel_io_handle_t *made) {
    need(config->trans_queue_depth > 0 && config->lcd_cmd_bits == 8 && config->lcd_param_bits == 8 && config->pclk_hz > 0, "wires");
    io.bus = bus;
    *made = &io;
    return ESP_OK;
}

static esp_err_t make(const esp_lcd_panel_io_handle_t with, const esp_lcd_panel_dev_config_t *config, esp_lcd_panel_handle_t *made) {
    need(with == &io && config->bits_per_pixel == 16, "a panel of 16 bits");
    *made = &panel;
    return ESP_OK;
}

esp_err_t esp_lcd_new_panel_gc9a01(const esp_lcd_panel_io_handle_t with, const esp_lcd_panel_dev_config_t *config, esp_lcd_panel_handle_t *made) {
    return make(with, config, made);
}
esp_err_t esp_lcd_new_panel_ili9341(const esp_lcd_panel_io_handle_t with, const esp_lcd_panel_dev_config_t *config, esp_lcd_panel_handle_t *made) {
    return make(with, config, made);
}
esp_err_t esp_lcd_new_panel_st7789(const esp_lcd_panel_io_handle_t with, const esp_lcd_panel_dev_config_t *config, esp_lcd_panel_handle_t *made) {
    return make(with, config, made);
}

esp_err_t gpio_set_direction(gpio_num_t pin, gpio_mode_t mode) { return pin >= 0 && mode == GPIO_MODE_OUTPUT ? ESP_OK : ESP_ERR_INVALID_ARG; }
esp_err_t gpio_set_level(gpio_num_t pin, uint32_t level) { return pin >= 0 && level <= 1 ? ESP_OK : ESP_ERR_INVALID_ARG; }
esp_err_t esp_lcd_panel_reset(esp_lcd_panel_handle_t p) { return p == &panel ? ESP_OK : ESP_ERR_INVALID_ARG; }
esp_err_t esp_lcd_panel_init(esp_lcd_panel_handle_t p) { return p == &panel ? ESP_OK : ESP_ERR_INVALID_ARG; }
esp_err_t esp_lcd_panel_invert_color(esp_lcd_panel_handle_t p, bool on) {
    (void)on;
    return p == &panel ? ESP_OK : ESP_ERR_INVALID_ARG;
}
esp_err_t esp_lcd_panel_mirror(esp_lcd_panel_handle_t p, bool x, bool y) {
    (void)x;
    (void)y;
    return p == &panel ? ESP_OK : ESP_ERR_INVALID_ARG;
}
esp_err_t esp_lcd_panel_disp_on_off(esp_lcd_panel_handle_t p, bool on) {
    p->on = on;
    return ESP_OK;
}

esp_err_t esp_lcd_panel_draw_bitmap(esp_lcd_panel_handle_t p, int x0, int y0, int x1, int y1, const void *rows) {
    need(p->on, "the panel is on");
    need(x0 == 0 && x1 == (int)width && y0 == (int)rows_sent && y1 > y0 && y1 <= (int)height, "rows of the picture, from top to bottom");
    finish_sending();
    sending.rows = (const uint8_t *)rows;
    sending.count = (size_t)(y1 - y0) * width * 2;
    sending.copy = (uint8_t *)malloc(sending.count);
    sending.y = (unsigned)y0;
    need(sending.copy != NULL, "memory");
    memcpy(sending.copy, rows, sending.count);
    rows_sent = (unsigned)y1;
    return ESP_OK;
}

/* What is refused. */
static void errors(void) {
    pantin_panel own;
    pantin_face face;
    pantin_solid body;
    memset(&face, 0, sizeof face);
    memset(&body, 0, sizeof body);
    need(pantin_panel_open(&own, &panel, 0, 0, 0, 10) == ESP_ERR_INVALID_ARG, "no width");
    need(pantin_panel_open(&own, &panel, 0, 0, 10, 2048) == ESP_ERR_INVALID_ARG, "a height above 2047");
    limit = CONFIG_PANTIN_ROWS * 10 * 2;
    need(pantin_panel_open(&own, &panel, 0, 0, 10, 10) == ESP_ERR_NO_MEM, "memory for one buffer");
    need(pantin_panel_face(&own, &face) == ESP_ERR_INVALID_SIZE && pantin_panel_body(&own, &body, 1) == ESP_ERR_INVALID_SIZE, "other sizes");
    face.width = face.height = 10;
    need(pantin_panel_face(&own, &face) == ESP_ERR_INVALID_STATE, "a panel without memory");
    limit = SIZE_MAX;
    allocated = 0;
}

int main(int argc, char **argv) {
    FILE *file;
    if (argc != 5) return 2;
    width = (unsigned)atoi(argv[1]);
    height = (unsigned)atoi(argv[2]);
    frames = frames_left = (unsigned)atoi(argv[3]);
    shown = (uint8_t *)calloc(width * height, 2);
    before = (uint8_t *)calloc(width * height, 2);
    need(shown && before, "memory");
    errors();
    if (setjmp(enough) == 0) {
        app_main();
        need(0, "the example goes on");
    }
    need(pictures == frames && differing > frames / 3, "the picture moves");
    printf("%u pictures, %u of them new, %u bytes of rows\n", pictures, differing, (unsigned)allocated);
    file = fopen(argv[4], "wb");
    need(file && fwrite(shown, width * height * 2, 1, file) == 1 && fclose(file) == 0, "the picture is written");
    free(shown);
    free(before);
    return 0;
}
