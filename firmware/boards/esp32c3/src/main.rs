//! Pantin on the ESP32-C3: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
#[cfg(feature = "update")]
mod flash;
mod panic;
#[cfg(feature = "update")]
mod received;

use board::Esp32C3;
use board_parts::ssd1306::Pages;
use esp_hal::clock::CpuClock;
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

// For the second stage of the boot. It says no time and date of the build: the same sources make the same image.
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
    let mut frame = Framebuffer::<Pages>::new();
    let mut board = Esp32C3::new(parts);
    #[cfg(feature = "update")]
    flash::map();
    #[cfg(feature = "update")]
    if let Some(mut store) = board_common::store::<flash::Rom>() {
        board_common::perform_stored(&mut store, CLIPS, &mut frame, &mut board)
    }
    board_common::perform(CLIPS, &mut frame, &mut board)
}
