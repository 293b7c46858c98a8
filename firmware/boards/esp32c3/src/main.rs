//! Pantin on the ESP32-C3 and the ESP32-C6: plays the clips that it was built with.
#![no_std]
#![no_main]

include!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/pins.rs"));

mod board;
mod panic;
#[cfg(not(feature = "usb"))]
mod uart;
#[cfg(all(feature = "buffered", not(feature = "usb")))]
mod uart_rx;
#[cfg(feature = "usb")]
mod usb;

use esp_hal::clock::CpuClock;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

// Read by the second stage of the boot. It has no time and date of the build: the same sources make the same image.
esp_bootloader_esp_idf::esp_app_desc!(
    env!("CARGO_PKG_VERSION"),
    "pantin",
    "-",
    "-",
    esp_bootloader_esp_idf::ESP_IDF_COMPATIBLE_VERSION,
    esp_bootloader_esp_idf::MMU_PAGE_SIZE,
    0,
    u16::MAX,
    esp_bootloader_esp_idf::SECURE_VERSION
);

#[esp_hal::main]
fn main() -> ! {
    let parts = esp_hal::init(esp_hal::Config::default().with_cpu_clock(CpuClock::max()));
    board_common::run_forever::<Flash, _>(CLIPS, board::new(parts))
}
