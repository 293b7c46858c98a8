/* Plays a clip from flash on an ATmega328P (Arduino Uno: 2 KB of RAM), through a page buffer of 128 bytes. It prints the CRC of each frame's pose over
 * the serial port, then the bytes of RAM that were used, stack included, and ends.
 *
 * clip.h defines `clip_bytes`, an array in program memory. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>

#include "clip.h"
#include "pantin.h"

enum { CHANNELS = 22, MOVING = 20, PAGE = 128 };
#define UNUSED 0xa5

extern uint8_t _end;
extern uint8_t __stack;

/* Fills the memory above the variables before main, so that the depth of the stack can be seen. */
void paint(void) __attribute__((naked, used, section(".init3")));
void paint(void) {
    uint8_t *p;
    for (p = &_end; p < &__stack; p++) *p = UNUSED;
}

static int32_t pose[CHANNELS];
static pantin_channel moving[MOVING];
static uint8_t page[PAGE];
static pantin_pages pages;
static pantin_clip clip;
static pantin_player player;

static void put(char c) {
    while (!(UCSR0A & 1 << UDRE0)) {}
    UDR0 = (uint8_t)c;
}

static void print_hex(uint16_t value) {
    int8_t shift;
    for (shift = 12; shift >= 0; shift = (int8_t)(shift - 4)) put("0123456789abcdef"[value >> shift & 15]);
    put('\n');
}

static uint16_t crc_of_pose(void) {
    uint16_t crc = 0xffff;
    const uint8_t *bytes = (const uint8_t *)pose;
    uint8_t i, bit;
    for (i = 0; i < sizeof pose; i++) {
        crc = (uint16_t)(crc ^ (uint16_t)((uint16_t)bytes[i] << 8));
        for (bit = 0; bit < 8; bit++) crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
    }
    return crc;
}

int main(void) {
    const uint8_t *p = &_end;
    UCSR0B = 1 << TXEN0;
    pantin_paged(&pages, sizeof clip_bytes, pantin_read_progmem, (void *)clip_bytes, page, PAGE);
    if (pantin_open(&clip, &pages.source, NULL) == PANTIN_OK &&
        pantin_start(&player, &clip, pose, CHANNELS, moving, MOVING) == PANTIN_OK) {
        do print_hex(crc_of_pose());
        while (pantin_step(&player) == PANTIN_OK);
    }
    while (p < &__stack && *p == UNUSED) p++;
    put('=');
    print_hex((uint16_t)(RAMEND + 1 - RAMSTART - (p - &_end)));
    cli();
    sleep_enable();
    sleep_cpu();
    return 0;
}
