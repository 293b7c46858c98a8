//! The first clip moves a puppet: joints' angles become pulses for four servos on GP6 to GP9.
#![no_std]
#![no_main]

use board_common::Capacity;
use board_common::cortex_m::SysTick;
use board_parts::servo::{Law, Servo, channel, slew};
use embedded_hal::pwm::SetDutyCycle;
use pantin::{Clip, Kind, Player};
use pantin_app::Capacity as _;
use rp2040_hal::fugit::ExtU32;
use rp2040_hal::pac::Peripherals;
use rp2040_hal::pwm::{FreeRunning, Slice, SliceId, Slices};
use rp2040_hal::{Sio, Watchdog};

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// The joints whose rotation about x moves the servos, in the order of the pins.
const JOINTS: [&str; 4] = ["left-thigh", "right-thigh", "left-upper-arm", "right-upper-arm"];
/// Microseconds of a pulse a second: a small servo goes 60 degrees in 0.12 s.
const SPEED: u32 = 5500;
/// Microseconds from pulse to pulse.
const PERIOD: u16 = 20_000;

#[rp2040_hal::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes them") };
    let mut resets = parts.RESETS;
    let mut watchdog = Watchdog::new(parts.WATCHDOG);
    pico::start(parts.XOSC, parts.CLOCKS, (parts.PLL_SYS, parts.PLL_USB), &mut resets, &mut watchdog);
    let pins = rp2040_hal::gpio::Pins::new(parts.IO_BANK0, parts.PADS_BANK0, Sio::new(parts.SIO).gpio_bank0, &mut resets);
    let slices = Slices::new(parts.PWM, &mut resets);
    let (mut legs, mut arms) = (every_period(slices.pwm3), every_period(slices.pwm4));
    legs.channel_a.output_to(pins.gpio6);
    legs.channel_b.output_to(pins.gpio7);
    arms.channel_a.output_to(pins.gpio8);
    arms.channel_b.output_to(pins.gpio9);
    watchdog.pause_on_debug(true);
    watchdog.start(8.secs());
    perform(|pulses| {
        watchdog.feed();
        // A width is less than the period: none fails.
        let _ = legs.channel_a.set_duty_cycle(pulses[0]);
        let _ = legs.channel_b.set_duty_cycle(pulses[1]);
        let _ = arms.channel_a.set_duty_cycle(pulses[2]);
        let _ = arms.channel_b.set_duty_cycle(pulses[3]);
    })
}

/// A pair of outputs whose counter counts microseconds, from pulse to pulse.
fn every_period<S: SliceId>(mut slice: Slice<S, FreeRunning>) -> Slice<S, FreeRunning> {
    slice.default_config();
    slice.set_div_int((pico::RATE / 1_000_000) as u8);
    slice.set_top(PERIOD - 1);
    slice.enable();
    slice
}

/// Plays the clip for ever, and hands on the servos' pulses with each frame.
fn perform(mut set: impl FnMut([u16; 4])) -> ! {
    let clip = CLIPS.first().map(|entry| Clip::new_checked(entry.bytes));
    let Some(Ok(clip)) = clip else { panic!("there is no clip, or it cannot be opened") };
    let (mut states, mut pose) = (Capacity::states(), Capacity::pose());
    let Ok(mut player) = Player::new(clip, &mut states, &mut pose) else { panic!("the clip is too big for this board") };
    let law = Law { centre: 1500, turn: 4000, limits: [1000, 2000], slew: slew(SPEED, clip.frame_time_ns()) };
    // The right side's servos are mounted the other way round.
    let mut servos = [1, -1, 1, -1].map(|side| Servo::new(Law { turn: side * law.turn, ..law }));
    let channels = JOINTS.map(|joint| channel(&clip, joint, Kind::Xrotation));
    let mut ticks = SysTick::<{ pico::RATE / 1000 }>::new();
    ticks.start(clip.frame_time_ns());
    loop {
        let mut pulses = [0; 4];
        for ((pulse, servo), channel) in pulses.iter_mut().zip(&mut servos).zip(channels) {
            // A joint that the clip lacks stays where it is.
            let angle = channel.and_then(|channel| player.pose().values.get(channel));
            *pulse = angle.map_or(servo.pulse(), |angle| servo.follow(*angle));
        }
        set(pulses);
        for _ in 0..ticks.wait(|| {}) {
            player.step();
        }
    }
}
