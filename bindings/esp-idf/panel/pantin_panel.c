#include "pantin_panel.h"

#include "esp_heap_caps.h"

#if defined(CONFIG_PANTIN_FORMAT_L8)
#define FORMAT PANTIN_L8
#define PIXEL 1u
#elif defined(CONFIG_PANTIN_FORMAT_RGB565)
#define FORMAT PANTIN_RGB565
#define PIXEL 2u
#else
#define FORMAT PANTIN_RGB565_SWAPPED
#define PIXEL 2u
#endif

/* Draws rows y0 to y1 - 1 of a face or a body. */
typedef pantin_result (*draw_rows)(void *drawn, void *rows, size_t stride, uint16_t y0, uint16_t y1, int floor);

void pantin_panel_close(pantin_panel *panel) {
    heap_caps_free(panel->rows[0]);
    heap_caps_free(panel->rows[1]);
    panel->rows[0] = panel->rows[1] = NULL;
}

esp_err_t pantin_panel_open(pantin_panel *panel, esp_lcd_panel_handle_t handle, uint16_t x, uint16_t y, uint16_t width, uint16_t height) {
    size_t bytes = (size_t)CONFIG_PANTIN_ROWS * width * PIXEL;
    if (width == 0 || width > 2047 || height == 0 || height > 2047) return ESP_ERR_INVALID_ARG;
    panel->handle = handle;
    panel->x = x;
    panel->y = y;
    panel->width = width;
    panel->height = height;
    panel->next = 0;
    panel->rows[0] = heap_caps_malloc(bytes, MALLOC_CAP_DMA);
    panel->rows[1] = heap_caps_malloc(bytes, MALLOC_CAP_DMA);
    if (panel->rows[0] && panel->rows[1]) return ESP_OK;
    pantin_panel_close(panel);
    return ESP_ERR_NO_MEM;
}

static esp_err_t send(pantin_panel *panel, draw_rows draw, void *drawn, int floor) {
    uint16_t y, end;
    if (!panel->rows[0]) return ESP_ERR_INVALID_STATE;
    for (y = 0; y < panel->height; y = end) {
        void *rows = panel->rows[panel->next];
        esp_err_t sent;
        end = (uint16_t)(panel->height - y > CONFIG_PANTIN_ROWS ? y + CONFIG_PANTIN_ROWS : panel->height);
        if (draw(drawn, rows, panel->width * PIXEL, y, end, floor) != PANTIN_OK) return ESP_ERR_INVALID_STATE;
        sent = esp_lcd_panel_draw_bitmap(panel->handle, panel->x, panel->y + y, panel->x + panel->width, panel->y + end, rows);
        if (sent != ESP_OK) return sent;
        panel->next ^= 1;
    }
    return ESP_OK;
}

#ifdef CONFIG_PANTIN_FACES
static pantin_result draw_face(void *drawn, void *rows, size_t stride, uint16_t y0, uint16_t y1, int floor) {
    (void)floor;
    return pantin_face_draw((pantin_face *)drawn, FORMAT, rows, stride, y0, y1);
}

esp_err_t pantin_panel_face(pantin_panel *panel, pantin_face *face) {
    if (face->width != panel->width || face->height != panel->height) return ESP_ERR_INVALID_SIZE;
    return send(panel, draw_face, face, 0);
}
#endif

#ifdef CONFIG_PANTIN_BODIES
static pantin_result draw_body(void *drawn, void *rows, size_t stride, uint16_t y0, uint16_t y1, int floor) {
    return pantin_solid_draw((const pantin_solid *)drawn, FORMAT, rows, stride, y0, y1, floor);
}

esp_err_t pantin_panel_body(pantin_panel *panel, const pantin_solid *body, int floor) {
    if (body->figure.width != panel->width || body->figure.height != panel->height) return ESP_ERR_INVALID_SIZE;
    /* It is only read. */
    return send(panel, draw_body, (void *)(uintptr_t)body, floor);
}
#endif
