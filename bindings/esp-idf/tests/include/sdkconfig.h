/* The defaults of Kconfig; the tests define what differs. */
#pragma once
#ifndef CONFIG_PANTIN_ROWS
#define CONFIG_PANTIN_ROWS 16
#endif
#define CONFIG_PANTIN_FACES 1
#define CONFIG_PANTIN_BODIES 1
#define CONFIG_PANTIN_CHARACTERS 1
#define CONFIG_PANTIN_PANEL 1
#define CONFIG_LCD_SCLK 6
#define CONFIG_LCD_MOSI 7
#define CONFIG_LCD_CS 10
#define CONFIG_LCD_DC 2
#define CONFIG_LCD_RST 3
