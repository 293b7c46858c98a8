/* Faces and bodies on a display of ESP-IDF's esp_lcd.
 *
 *     static pantin_panel panel;
 *
 *     pantin_panel_open(&panel, handle, 0, 0, 240, 240); // the handle of esp_lcd_new_panel_...
 *     for (;;) {
 *         pantin_face_step(&face, 33);
 *         pantin_panel_face(&panel, &face);
 *         vTaskDelay(pdMS_TO_TICKS(33));
 *     }
 *
 * CONFIG_PANTIN_ROWS rows are drawn at a time, in one of two buffers, while the other one is sent. That is right for panels by SPI and I2C, whose
 * esp_lcd_panel_draw_bitmap waits until what it sent before has left, and for RGB and DSI panels, where it copies. A driver that does neither needs
 * a callback of its own. */
#ifndef PANTIN_PANEL_H
#define PANTIN_PANEL_H

#include "esp_err.h"
#include "esp_lcd_panel_ops.h"
#include "sdkconfig.h"

#include "pantin_format.h"
#ifdef CONFIG_PANTIN_FACES
#include "pantin_face.h"
#endif
#ifdef CONFIG_PANTIN_BODIES
#include "pantin_solid.h"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* A place on a display. Fields may be read; only the functions change them. */
typedef struct pantin_panel {
    esp_lcd_panel_handle_t handle;
    uint16_t x, y, width, height; /* pixels */
    void *rows[2];
    uint8_t next; /* the buffer that is drawn into */
} pantin_panel;

/* Takes memory for rows of a picture of `width` by `height` pixels with its left upper corner at x, y. ESP_ERR_NO_MEM if there is not enough that DMA
 * can read, ESP_ERR_INVALID_ARG for a size of 0 or above 2047. */
esp_err_t pantin_panel_open(pantin_panel *panel, esp_lcd_panel_handle_t handle, uint16_t x, uint16_t y, uint16_t width, uint16_t height);

/* Gives the memory back. */
void pantin_panel_close(pantin_panel *panel);

#ifdef CONFIG_PANTIN_FACES
/* Sends the picture of a face, whose size is the panel's. ESP_ERR_INVALID_SIZE for a face of another size, or what esp_lcd returns. */
esp_err_t pantin_panel_face(pantin_panel *panel, pantin_face *face);
#endif

#ifdef CONFIG_PANTIN_BODIES
/* Sends the picture of a body, likewise. With `floor` 1 it stands on a floor and has a shadow. */
esp_err_t pantin_panel_body(pantin_panel *panel, const pantin_solid *body, int floor);
#endif

#ifdef __cplusplus
}
#endif

#endif
