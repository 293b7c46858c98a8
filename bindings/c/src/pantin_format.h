/* Formats of rows of pixels that faces and solid figures are drawn into. */
#ifndef PANTIN_FORMAT_H
#define PANTIN_FORMAT_H

/* A row begins at a byte; of 16-bit formats at an even address. */
typedef enum pantin_format {
    PANTIN_I1 = 0,         /* a bit a pixel, the left one in the highest bit: LVGL, drawBitmap of Adafruit_GFX */
    PANTIN_I1_LSB,         /* a bit a pixel, the left one in the lowest bit: XBM, U8g2 */
    PANTIN_L8,             /* a byte a pixel: brightness */
    PANTIN_RGB565,         /* 16 bits a pixel, red in the highest five, in the processor's byte order */
    PANTIN_RGB565_SWAPPED  /* the same with both bytes exchanged: what many displays take by SPI */
} pantin_format;

#endif
