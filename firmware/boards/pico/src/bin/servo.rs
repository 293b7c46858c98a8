//! The first clip moves a puppet: the angles of joints become pulses for four servos on GP6 to GP9, within each servo's limits. For servos convert with
//! `--max-channel-error 1`, which bounds each Euler angle. If the clip lacks a joint, no servo gets pulses, and the display and the serial
//! line say which joints are missing.
#![no_std]
#![no_main]

use board_common::cortex_m::SysTick;
use board_common::{Capacity, TickSource};
use board_drivers::servo::{JointAngle, Law, Servo, SoftStart, slew};
use core::fmt::{self, Display, Formatter};
use embedded_hal::pwm::SetDutyCycle;
use pantin::{Axis, ChannelState, Clip, Player};
use pantin_app::Capacity as _;
use pico::clocks::{self, CPU_HZ};
use rp2040_hal::fugit::ExtU32;
use rp2040_hal::pac::Peripherals;
use rp2040_hal::pwm::{FreeRunning, Slice, SliceId, Slices};
use rp2040_hal::{Sio, Watchdog};

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// The joints whose rotation about x moves the servos, in the order of the pins.
const JOINTS: [&str; 4] = ["left-thigh", "right-thigh", "left-upper-arm", "right-upper-arm"];
/// The fastest change of a pulse width, in microseconds a second: less than half of what a small servo can do, which turns by 60 degrees in
/// 0.12 s (5500).
const SLEW_US_PER_S: u32 = 2500;
/// The time from pulse to pulse.
const PULSE_PERIOD_US: u16 = 20_000;

#[rp2040_hal::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    let mut resets = parts.RESETS;
    let mut watchdog = Watchdog::new(parts.WATCHDOG);
    clocks::start(parts.XOSC, parts.CLOCKS, (parts.PLL_SYS, parts.PLL_USB), &mut resets, &mut watchdog);
    let mut states = Capacity::states();
    let mut pose = Capacity::pose();
    let player = open(&mut states, &mut pose).unwrap_or_else(|why| pico::refuse(why));
    let angles = match angles(player.clip()) {
        Ok(angles) => angles,
        Err(missing) => pico::refuse(missing),
    };
    let pins = rp2040_hal::gpio::Pins::new(parts.IO_BANK0, parts.PADS_BANK0, Sio::new(parts.SIO).gpio_bank0, &mut resets);
    let slices = Slices::new(parts.PWM, &mut resets);
    let (mut legs, mut arms) = (pulses(slices.pwm3), pulses(slices.pwm4));
    legs.channel_a.output_to(pins.gpio6);
    legs.channel_b.output_to(pins.gpio7);
    arms.channel_a.output_to(pins.gpio8);
    arms.channel_b.output_to(pins.gpio9);
    watchdog.pause_on_debug(true);
    watchdog.start(8.secs());
    play(player, angles, |widths| {
        watchdog.feed();
        // A width is less than the period: no call fails.
        let _ = legs.channel_a.set_duty_cycle(widths[0]);
        let _ = legs.channel_b.set_duty_cycle(widths[1]);
        let _ = arms.channel_a.set_duty_cycle(widths[2]);
        let _ = arms.channel_b.set_duty_cycle(widths[3]);
    })
}

/// Sets up a pair of outputs whose counter counts microseconds from pulse to pulse.
fn pulses<S: SliceId>(mut slice: Slice<S, FreeRunning>) -> Slice<S, FreeRunning> {
    slice.default_config();
    slice.set_div_int((CPU_HZ / 1_000_000) as u8);
    slice.set_top(PULSE_PERIOD_US - 1);
    slice.enable();
    slice
}

/// Opens the program's first clip.
fn open<'m>(states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Player<'static, 'm>, &'static str> {
    let entry = CLIPS.first().ok_or("there is no clip")?;
    let clip = Clip::with_rig(entry.bytes, entry.rig).map_err(|_| "the clip cannot be opened")?;
    Player::new(clip, states, pose).map_err(|_| "the clip is too big for this board")
}

/// Finds the joints that move the servos.
fn angles<'a>(clip: &Clip<'a>) -> Result<[JointAngle<'a>; 4], Missing> {
    let found = JOINTS.map(|joint| JointAngle::find(clip, joint, Axis::X));
    match found {
        [Some(a), Some(b), Some(c), Some(d)] => Ok([a, b, c, d]),
        _ => Err(Missing(found.map(|angle| angle.is_none()))),
    }
}

/// The joints that a clip lacks.
struct Missing([bool; 4]);

impl Display for Missing {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("the clip lacks joints:")?;
        let missing = JOINTS.iter().zip(self.0).filter(|(_, missing)| *missing);
        missing.into_iter().try_for_each(|(joint, _)| write!(f, "\n{joint}"))
    }
}

/// Plays the clip forever, and passes the servos' pulse widths to `set` with each frame. [`Law::limits`] bound each width, whatever the angle.
fn play(mut player: Player, angles: [JointAngle; 4], mut set: impl FnMut([u16; 4])) -> ! {
    let clip = *player.clip();
    let law = Law { centre: 1500, turn: 4000, limits: [1000, 2000], slew: slew(SLEW_US_PER_S, clip.frame_time_ns()) };
    // The servos of the right side are mounted mirrored.
    let mut servos = [1, -1, 1, -1].map(|side| Servo::new(Law { turn: side * law.turn, ..law }));
    let mut timer = SysTick::<CPU_HZ>::new();
    timer.start(clip.frame_time_ns());
    let mut start = SoftStart::new(JOINTS.len() as u32);
    let mut follow = |player: &Player, start: &SoftStart| {
        let mut widths = [0; 4];
        for (((number, width), servo), angle) in (0..).zip(&mut widths).zip(&mut servos).zip(&angles) {
            let followed = servo.follow(start.ease(angle.at(player)));
            // A width of 0 is no pulse.
            *width = if start.is_on(number) { followed } else { 0 };
        }
        widths
    };
    // The clip stays at its first frame while the servos start.
    let step = |player: &mut Player, start: &mut SoftStart| {
        if start.advance(clip.frame_time_ns() / 1000) {
            player.step();
        }
    };
    let mut widths = follow(&player, &start);
    loop {
        set(widths);
        // Worked out before its tick: how long that takes, which depends on the angles, does not delay the pulses.
        step(&mut player, &mut start);
        widths = follow(&player, &start);
        for _ in 1..timer.wait(|| {}) {
            step(&mut player, &mut start);
            widths = follow(&player, &start);
        }
    }
}
