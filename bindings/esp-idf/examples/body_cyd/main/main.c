/* A body that walks on the display of a CYD, the yellow board ESP32-2432S028: 240 by 320 pixels. */
#include "driver/gpio.h"
#include "driver/spi_master.h"
#include "esp_check.h"
#include "esp_lcd_panel_io.h"
#include "esp_lcd_panel_ops.h"
#include "esp_log.h"
#include "freertos/FreeRTOS.h"
#include "freertos/task.h"
#include "sdkconfig.h"
#ifdef CONFIG_CYD_ST7789
#include "esp_lcd_panel_vendor.h"
#else
#include "esp_lcd_ili9341.h"
#endif

#include "pantin_panel.h"
#include "pantin_solid.h"
#include "walk.h" /* cargo pantin expand walk.ptn -o walk.h */

enum { WIDTH = 240, HEIGHT = 320, SCLK = 14, MOSI = 13, MISO = 12, CS = 15, DC = 2, BACKLIGHT = 21 };

static const char TAG[] = "body";

static int32_t pose[CLIP_WALK_CHANNELS];
static pantin_channel moving[CLIP_WALK_MOVING];
static pantin_bone bones[CLIP_WALK_FIGURE_JOINTS];
static pantin_drive drives[CLIP_WALK_CHANNELS];
static pantin_slot slots[PANTIN_FIGURE_SLOTS];
static pantin_joint_info scratch[CLIP_WALK_WORKSPACE];
static pantin_source source;
static pantin_clip clip;
static pantin_player player;
static pantin_solid body;
static pantin_panel panel;

static esp_lcd_panel_handle_t display(void) {
    esp_lcd_panel_io_handle_t io = NULL;
    esp_lcd_panel_handle_t handle = NULL;
    const spi_bus_config_t bus = {
        .sclk_io_num = SCLK,
        .mosi_io_num = MOSI,
        .miso_io_num = MISO,
        .quadwp_io_num = -1,
        .quadhd_io_num = -1,
        .max_transfer_sz = WIDTH * CONFIG_PANTIN_ROWS * 2,
    };
    const esp_lcd_panel_io_spi_config_t wires = {
        .cs_gpio_num = CS,
        .dc_gpio_num = DC,
        .spi_mode = 0,
        .pclk_hz = 40 * 1000 * 1000,
        .trans_queue_depth = 2,
        .lcd_cmd_bits = 8,
        .lcd_param_bits = 8,
    };
    const esp_lcd_panel_dev_config_t device = {
        .reset_gpio_num = -1, /* it is connected to the board's */
#ifdef CONFIG_CYD_ST7789
        .rgb_ele_order = LCD_RGB_ELEMENT_ORDER_RGB,
#else
        .rgb_ele_order = LCD_RGB_ELEMENT_ORDER_BGR,
#endif
        .bits_per_pixel = 16,
    };
    ESP_ERROR_CHECK(gpio_set_direction((gpio_num_t)BACKLIGHT, GPIO_MODE_OUTPUT));
    ESP_ERROR_CHECK(gpio_set_level((gpio_num_t)BACKLIGHT, 1));
    ESP_ERROR_CHECK(spi_bus_initialize(SPI2_HOST, &bus, SPI_DMA_CH_AUTO));
    ESP_ERROR_CHECK(esp_lcd_new_panel_io_spi((esp_lcd_spi_bus_handle_t)SPI2_HOST, &wires, &io));
#ifdef CONFIG_CYD_ST7789
    ESP_ERROR_CHECK(esp_lcd_new_panel_st7789(io, &device, &handle));
#else
    ESP_ERROR_CHECK(esp_lcd_new_panel_ili9341(io, &device, &handle));
#endif
    ESP_ERROR_CHECK(esp_lcd_panel_reset(handle));
    ESP_ERROR_CHECK(esp_lcd_panel_init(handle));
    ESP_ERROR_CHECK(esp_lcd_panel_disp_on_off(handle, true));
    return handle;
}

static int opened(void) {
    pantin_memory(&source, CLIP_WALK, CLIP_WALK_LEN);
    pantin_figure_memory(&body.figure, bones, CLIP_WALK_FIGURE_JOINTS, drives, CLIP_WALK_CHANNELS, slots, PANTIN_FIGURE_SLOTS);
    return pantin_open(&clip, &source, NULL) == PANTIN_OK &&
           pantin_start(&player, &clip, pose, CLIP_WALK_CHANNELS, moving, CLIP_WALK_MOVING) == PANTIN_OK &&
           pantin_solid_set_up(&body, &player, WIDTH, HEIGHT, scratch, CLIP_WALK_WORKSPACE) == PANTIN_OK &&
           pantin_solid_aim(&body, &player, &pantin_default_view) == PANTIN_OK;
}

void app_main(void) {
    TickType_t due;
    uint32_t frame, ms;
    if (!opened()) {
        ESP_LOGE(TAG, "the clip is damaged, or the memory too small");
        return;
    }
    ESP_ERROR_CHECK(pantin_panel_open(&panel, display(), 0, 0, WIDTH, HEIGHT));
    /* The walk has 120 frames a second, and every fourth is shown. */
    ms = clip.frame_time_ns / (1000000 / 4);
    due = xTaskGetTickCount();
    for (frame = 0;; frame = (frame + 4) % clip.frames) {
        pantin_seek(&player, frame);
        pantin_solid_pose(&body, player.pose);
        ESP_ERROR_CHECK(pantin_panel_body(&panel, &body, 1));
        xTaskDelayUntil(&due, pdMS_TO_TICKS(ms));
    }
}
