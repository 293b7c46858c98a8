/* Prints the processor cycles of reading joints on an ATmega328P (Arduino Uno), the most of all joints, orders and frames of a clip, over the serial port:
 *
 *     own ...     Euler angles in the order in which the clip stores them: what a reference costs, besides the angles
 *     euler ...   angles in another order, of a joint with Euler angles
 *     map ...     of one with an exponential map
 *     quaternion ...
 *     chain ...   of one with channels of several kinds
 *     step ...    a step to the next frame, which reads segments
 *     restart ... going back to frame 0, as a clip that plays again and again does
 *
 * Then it prints the CRC of all angles, and ends. clip.h defines `clip_bytes`, an array in program memory. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>

#include "clip.h"
#include "pantin_turn.h"

enum { CHANNELS = 44, MOVING = 42, PAGE = 64 };

static int32_t pose[CHANNELS];
static pantin_channel moving[MOVING];
static uint8_t page[PAGE];
static pantin_pages pages;
static pantin_clip clip;
static pantin_player player;
static uint16_t crc = 0xffff;

static void put(char c) {
    while (!(UCSR0A & 1 << UDRE0)) {}
    UDR0 = (uint8_t)c;
}

static void print(const char *text) {
    while (pgm_read_byte(text)) put((char)pgm_read_byte(text++));
}

static void print_hex(uint32_t value) {
    int8_t shift;
    for (shift = 28; shift >= 0; shift = (int8_t)(shift - 4)) put("0123456789abcdef"[value >> shift & 15]);
    put('\n');
}

static void note(const int32_t *angles) {
    const uint8_t *bytes = (const uint8_t *)angles;
    uint8_t i, bit;
    for (i = 0; i < 12; i++) {
        crc = (uint16_t)(crc ^ (uint16_t)((uint16_t)bytes[i] << 8));
        for (bit = 0; bit < 8; bit++) crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
    }
}

static volatile uint16_t overflows;

ISR(TIMER1_OVF_vect) { overflows++; }

static void begin(void) {
    TCNT1 = 0;
    overflows = 0;
}

static uint32_t end(void) {
    uint16_t low = TCNT1;
    return (uint32_t)overflows << 16 | low;
}

int main(void) {
    uint32_t most[7] = {0, 0, 0, 0, 0, 0, 0}, cycles;
    pantin_joint_ref ref;
    pantin_joint at;
    uint8_t i, order;
    UCSR0B = 1 << TXEN0;
    TCCR1B = 1 << CS10;
    TIMSK1 = 1 << TOIE1;
    sei();
    pantin_paged(&pages, sizeof clip_bytes, pantin_read_progmem, (void *)clip_bytes, page, PAGE);
    if (pantin_open(&clip, &pages.source, NULL) == PANTIN_OK &&
        pantin_start(&player, &clip, pose, CHANNELS, moving, MOVING) == PANTIN_OK) {
        do {
            pantin_first_joint(&at, &clip.rig);
            while (pantin_next_joint(&at)) {
                if (at.end_site || pantin_refer(&clip, &at, &ref) != PANTIN_OK) continue;
                for (order = PANTIN_XYZ; order <= PANTIN_ZYX; order++) {
                    int32_t angles[3];
                    uint8_t kind = (uint8_t)(ref.form + 1);
                    begin();
                    if (pantin_euler(&player, &ref, (pantin_order)order, angles) != PANTIN_OK) print(PSTR("failed\n"));
                    cycles = end();
                    note(angles);
                    if (ref.form == PANTIN_FORM_EULER && ((ref.order == PANTIN_NO_ORDER ? PANTIN_XYZ : ref.order) == order)) kind = 0;
                    if (cycles > most[kind]) most[kind] = cycles;
                }
            }
            begin();
            i = pantin_step(&player) == PANTIN_OK;
            cycles = end();
            if (cycles > most[5]) most[5] = cycles;
        } while (i);
        begin();
        (void)pantin_restart(&player);
        most[6] = end();
    }
    for (i = 0; i < 7; i++) {
        static const char names[7][12] PROGMEM = {"own ", "euler ", "map ", "quaternion ", "chain ", "step ", "restart "};
        print(names[i]);
        print_hex(most[i]);
    }
    print(PSTR("crc "));
    print_hex(crc);
    cli();
    sleep_enable();
    sleep_cpu();
    return 0;
}
