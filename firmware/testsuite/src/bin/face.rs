//! Plays a clip that drives the face, with markers around a frame's weights and vertices, their projection, its lines, and
//! clearing and drawing a display of greys and one of dots.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player};
use pantin_face::{Binding, Look, Model, Morph, VERTICES, View, Weights};
use pantin_figure::Canvas;
use pantin_figure::surface::{Frame, Gray4Rows, Layout, MonoPages};
use testsuite::{clip, markers};

/// Most channels of a clip that drives a face.
const CHANNELS: usize = 80;
/// Frames that are measured.
const FRAMES: u32 = 240;

static MODEL: &[u8] = include_bytes!("../../../../motions/face.model");

type Greys = Frame<Gray4Rows<128, 64, 1024>>;
type Dots = Frame<MonoPages<128, 64, 1024>>;

#[cortex_m_rt::entry]
fn main() -> ! {
    let bytes = clip::bytes();
    let mut states = [ChannelState::default(); CHANNELS];
    let mut pose = [0; CHANNELS];
    let Ok(clip) = Clip::new_checked(bytes) else { panic!() };
    let Ok(mut player) = Player::new(clip, &mut states, &mut pose) else { panic!() };
    let Ok(model) = Model::new_checked(MODEL) else { panic!() };
    let binding = Binding::of(&clip.rig(), &model);
    assert!(binding.is_face());
    let Ok(mut morph) = Morph::<VERTICES>::new(&model) else { panic!() };
    let mut look = Look::<VERTICES>::new(&model, Canvas { width: 128, height: 64 }, View::default());
    let mut weights = Weights::new();
    let mut greys = Greys::new();
    let mut dots = Dots::new();
    for _ in 1..clip.frames().min(FRAMES) {
        player.step();
        place(&model, &binding, player.pose(), &mut weights, &mut morph);
        project(&model, &morph, &mut look);
        black_box(lines(&model, &look));
        draw(&model, &look, &mut greys);
        draw(&model, &look, &mut dots);
    }
    semihosting::process::exit(0)
}

#[inline(never)]
fn place(model: &Model, binding: &Binding, pose: &[i32], weights: &mut Weights, morph: &mut Morph<VERTICES>) {
    markers::start();
    binding.weigh(pose, weights);
    morph.place(model, weights);
    markers::stop();
}

#[inline(never)]
fn project(model: &Model, morph: &Morph<VERTICES>, look: &mut Look<VERTICES>) {
    markers::start();
    look.project(model, morph);
    markers::stop();
}

#[inline(never)]
fn lines(model: &Model, look: &Look<VERTICES>) -> u32 {
    let mut sum = 0;
    markers::start();
    look.lines(model, |line| sum ^= line.from[0] as u32 ^ line.to[1] as u32);
    markers::stop();
    sum
}

#[inline(never)]
fn draw<L: Layout>(model: &Model, look: &Look<VERTICES>, frame: &mut Frame<L>) {
    markers::start();
    frame.clear();
    look.draw_on(model, frame);
    markers::stop();
}
