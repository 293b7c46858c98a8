/* LVGL as the tests build it: a display of 16 bits, LVGL's own memory, so that it can be watched, and nothing that the tests do not use. */
#ifndef LV_CONF_H
#define LV_CONF_H

#define LV_COLOR_DEPTH 16
#define LV_USE_STDLIB_MALLOC LV_STDLIB_BUILTIN
#define LV_MEM_SIZE (2 * 1024 * 1024U)
#define LV_USE_OS LV_OS_NONE
#define LV_USE_LOG 1
#define LV_LOG_LEVEL LV_LOG_LEVEL_WARN
#define LV_LOG_PRINTF 0
#define LV_USE_ASSERT_NULL 1
#define LV_USE_ASSERT_MALLOC 1
#define LV_USE_ASSERT_STYLE 1
#define LV_USE_ASSERT_MEM_INTEGRITY 1
#define LV_USE_ASSERT_OBJ 1
#define LV_USE_CANVAS 1
#define LV_USE_IMAGE 1
#define LV_USE_GIF 1
#define LV_USE_TEST 1
#define LV_USE_TEST_SCREENSHOT_COMPARE 0
#ifndef LV_PANTIN_WITHOUT_BODY
#define LV_PANTIN_BODY 1
#endif
#define LV_BUILD_EXAMPLES 0
#define LV_BUILD_DEMOS 0

#endif
