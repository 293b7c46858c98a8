// Time of the test's own, in place of ESPHome's hal.cpp and of the wait in its loop: it passes when the program waits, and hardly while it works, so that the test
// runs alike on a machine that is busy.

#include <cstdint>
#include <cstdlib>

#include "esphome/core/hal.h"

namespace {

uint64_t now_us = 1000000;

}  // namespace

namespace esphome {

uint64_t millis_64() { return ++now_us / 1000; }
uint32_t millis() { return static_cast<uint32_t>(millis_64()); }
uint32_t micros() { return static_cast<uint32_t>(++now_us); }
void delay(uint32_t ms) { now_us += ms * 1000ULL; }
void delayMicroseconds(uint32_t us) { now_us += us; }
void arch_restart() { exit(1); }
uint32_t arch_get_cpu_cycle_count() { return micros() * 1000; }

}  // namespace esphome

// esphome::internal::wakeable_delay(uint32_t), which the linker replaces by this.
extern "C" void __wrap__ZN7esphome8internal14wakeable_delayEj(uint32_t ms) { esphome::delay(ms); }
