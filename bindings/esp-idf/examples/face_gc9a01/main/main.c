/* A face on a round GC9A01 display of 240 by 240 pixels: it blinks, looks about, and shows another emote every four seconds. */
#include "driver/spi_master.h"
#include "esp_check.h"
#include "esp_lcd_gc9a01.h"
#include "esp_lcd_panel_io.h"
#include "esp_lcd_panel_ops.h"
#include "esp_log.h"
#include "esp_timer.h"
#include "freertos/FreeRTOS.h"
#include "freertos/task.h"
#include "sdkconfig.h"

#include "pantin_face.h"
#include "pantin_face_data.h"
#include "pantin_panel.h"

enum { SIDE = 240, FRAME_MS = 33, EMOTE_MS = 4000 };

static const char TAG[] = "face";

static uint32_t memory[PANTIN_FACE_WORDS(97, 7)]; /* the cartoon's vertices, the channels of the longest emote */
static pantin_face face;
static pantin_panel panel;

static esp_lcd_panel_handle_t display(void) {
    esp_lcd_panel_io_handle_t io = NULL;
    esp_lcd_panel_handle_t handle = NULL;
    const spi_bus_config_t bus = {
        .sclk_io_num = CONFIG_LCD_SCLK,
        .mosi_io_num = CONFIG_LCD_MOSI,
        .miso_io_num = -1,
        .quadwp_io_num = -1,
        .quadhd_io_num = -1,
        .max_transfer_sz = SIDE * CONFIG_PANTIN_ROWS * 2,
    };
    const esp_lcd_panel_io_spi_config_t wires = {
        .cs_gpio_num = CONFIG_LCD_CS,
        .dc_gpio_num = CONFIG_LCD_DC,
        .spi_mode = 0,
        .pclk_hz = 40 * 1000 * 1000,
        .trans_queue_depth = 2,
        .lcd_cmd_bits = 8,
        .lcd_param_bits = 8,
    };
    const esp_lcd_panel_dev_config_t device = {
        .reset_gpio_num = CONFIG_LCD_RST,
        .rgb_ele_order = LCD_RGB_ELEMENT_ORDER_BGR,
        .bits_per_pixel = 16,
    };
    ESP_ERROR_CHECK(spi_bus_initialize(SPI2_HOST, &bus, SPI_DMA_CH_AUTO));
    ESP_ERROR_CHECK(esp_lcd_new_panel_io_spi((esp_lcd_spi_bus_handle_t)SPI2_HOST, &wires, &io));
    ESP_ERROR_CHECK(esp_lcd_new_panel_gc9a01(io, &device, &handle));
    ESP_ERROR_CHECK(esp_lcd_panel_reset(handle));
    ESP_ERROR_CHECK(esp_lcd_panel_init(handle));
    /* The panels that are sold show inverted colours otherwise. */
    ESP_ERROR_CHECK(esp_lcd_panel_invert_color(handle, true));
    ESP_ERROR_CHECK(esp_lcd_panel_mirror(handle, true, false));
    ESP_ERROR_CHECK(esp_lcd_panel_disp_on_off(handle, true));
    return handle;
}

void app_main(void) {
    int64_t before, changed;
    uint16_t emote = 0;
    if (pantin_face_open(&face, pantin_cartoon, sizeof pantin_cartoon, memory, sizeof memory) != PANTIN_OK) {
        ESP_LOGE(TAG, "the face needs %u bytes", (unsigned)face.needed);
        return;
    }
    pantin_face_size(&face, SIDE, SIDE);
    pantin_face_emotes(&face, pantin_emotes, PANTIN_EMOTES);
    pantin_face_live(&face, 1);
    pantin_face_emote(&face, "neutral");
    ESP_ERROR_CHECK(pantin_panel_open(&panel, display(), 0, 0, SIDE, SIDE));
    before = changed = esp_timer_get_time();
    for (;;) {
        int64_t now = esp_timer_get_time();
        if (now - changed >= EMOTE_MS * 1000) {
            changed = now;
            pantin_face_emote(&face, pantin_emotes[emote].name);
            ESP_LOGI(TAG, "%s", pantin_emotes[emote].name);
            emote = (uint16_t)((emote + 1) % PANTIN_EMOTES);
        }
        pantin_face_step(&face, (uint16_t)((now - before) / 1000));
        /* What is less than a millisecond is left for the next frame. */
        before += (now - before) / 1000 * 1000;
        ESP_ERROR_CHECK(pantin_panel_face(&panel, &face));
        vTaskDelay(pdMS_TO_TICKS(FRAME_MS));
    }
}
