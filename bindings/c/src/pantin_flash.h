/* Tables in program memory. On AVR and on the ESP8266 constants are in RAM unless they are declared otherwise, and program memory is read by other
 * instructions: of 32 bits on the ESP8266. */
#ifndef PANTIN_FLASH_H
#define PANTIN_FLASH_H

#if defined(__AVR__) || defined(ESP8266)
#if defined(__AVR__)
#include <avr/pgmspace.h>
#else
#include <pgmspace.h>
#endif
#define PANTIN_FLASH PROGMEM
#define PANTIN_U8(address) pgm_read_byte(address)
#define PANTIN_U16(address) pgm_read_word(address)
#define PANTIN_U32(address) pgm_read_dword(address)
#define PANTIN_I32(address) ((int32_t)pgm_read_dword(address))
#else
#define PANTIN_FLASH
#define PANTIN_U8(address) ((uint8_t)*(address))
#define PANTIN_U16(address) (*(address))
#define PANTIN_U32(address) (*(address))
#define PANTIN_I32(address) (*(address))
#endif

#endif
