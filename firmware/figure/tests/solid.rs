//! The solid figure: the same pixels on every surface, lines that stay what they are, and a head that looks somewhere.

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{BinaryColor, Gray4, PixelColor, Rgb565, Rgb888, RgbColor};
use pantin::{Clip, Form, Player, Pose, Room};
use pantin_figure::ink::Ink;
use pantin_figure::solid::{Build, Look, Material, SolidFigure, draw_together, look_text};
use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout, MonoPages, Rgb565Rows};
use pantin_figure::{CameraTarget, Canvas, DrawStyle, FigureRenderer, Stand, View};

const CLIPS: [&[u8]; 2] = [include_bytes!("../../../motions/walk.ptn"), include_bytes!("../../../motions/run.ptn")];
const JOINTS: usize = 36;

/// A display of any size.
#[derive(Clone, Debug, PartialEq)]
struct Target<C> {
    width: usize,
    pixels: Vec<C>,
}

impl<C: Ink> Target<C> {
    fn new([width, height]: [usize; 2]) -> Self {
        Target { width, pixels: vec![C::DARK; width * height] }
    }
}

impl<C> OriginDimensions for Target<C> {
    fn size(&self) -> Size {
        Size::new(self.width as u32, (self.pixels.len() / self.width) as u32)
    }
}

impl<C: PixelColor> DrawTarget for Target<C> {
    type Color = C;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(place, colour) in pixels {
            let index = place.y as usize * self.width + place.x as usize;
            // Nothing is drawn outside: the index would be too great, or in another row.
            assert!((0..self.width as i32).contains(&place.x), "{place:?}");
            self.pixels[index] = colour;
        }
        Ok(())
    }
}

fn with_player(clip: &'static [u8], test: impl FnOnce(&mut Player)) {
    let mut room = Room::<144, 144>::new();
    test(&mut room.player(Clip::new_checked(clip).unwrap()).unwrap());
}

fn figure(player: &mut Player, size: [usize; 2], orbit: i16) -> SolidFigure<JOINTS> {
    figure_of(player, size, orbit, Look::DEFAULT)
}

fn figure_of(player: &mut Player, [width, height]: [usize; 2], orbit: i16, look: Look) -> SolidFigure<JOINTS> {
    let canvas = Canvas { width: width as u16, height: height as u16 };
    let view = View { orbit, ..View::default() };
    SolidFigure::of_clip(player, canvas, view, look).unwrap()
}

fn look(text: &str) -> Look {
    Look::new(look_text::compile(text).unwrap().to_vec().leak()).unwrap()
}

/// The default character and all that are shipped.
fn looks() -> [Look; 4] {
    let shipped = ["dancer", "ranger", "cat"].map(|name| {
        let path = format!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/looks/{}.look"), name);
        look(&std::fs::read_to_string(path).unwrap())
    });
    [Look::DEFAULT, shipped[0], shipped[1], shipped[2]]
}

/// Draws every 16th frame of every character on a framebuffer of a layout and on a target, and compares them.
fn same_on_both<L: Layout<Ink: PartialEq + core::fmt::Debug>>(player: &mut Player) {
    looks().into_iter().for_each(|look| same_of_a_look::<L>(player, look));
}

fn same_of_a_look<L: Layout<Ink: PartialEq + core::fmt::Debug>>(player: &mut Player, look: Look) {
    let size = [L::WIDTH, L::HEIGHT];
    let (mut one, mut other) = (figure_of(player, size, -50, look), figure_of(player, size, -50, look));
    assert_eq!(one.build(), Build::Person);
    let mut framebuffer = Framebuffer::<L>::new();
    for frame in (0..player.clip().frames()).step_by(16) {
        player.seek(frame);
        framebuffer.clear();
        one.set_pose(player.pose()).unwrap();
        one.draw_on(&mut framebuffer, true);
        let mut target = Target::<L::Ink>::new(size);
        other.draw(player.pose(), &mut target).unwrap();
        let bright = target.pixels.iter().filter(|pixel| **pixel != L::Ink::DARK).count();
        assert!(bright * 100 > target.pixels.len() * 3, "{bright} pixels of frame {frame}");
        for (index, pixel) in target.pixels.iter().enumerate() {
            assert_eq!(framebuffer.pixel(index % size[0], index / size[0]), *pixel, "pixel {index} of frame {frame}");
        }
    }
}

#[test]
fn a_framebuffer_shows_what_a_target_shows() {
    for clip in CLIPS {
        with_player(clip, same_on_both::<MonoPages<128, 64, 1024>>);
        with_player(clip, same_on_both::<Gray4Rows<128, 64, 1024>>);
        with_player(clip, same_on_both::<Rgb565Rows<176, 220, { 176 * 110 }>>);
    }
}

#[test]
fn lines_are_those_of_the_figure_without_volume() {
    for clip in CLIPS {
        with_player(clip, |player| {
            let mut solid = figure(player, [128, 64], -50);
            solid.make_room(false);
            solid.aim(player, View::default());
            let canvas = Canvas { width: 128, height: 64 };
            let mut lines = FigureRenderer::<JOINTS>::of_clip(player, canvas, View::default()).unwrap();
            for frame in (0..player.clip().frames()).step_by(10) {
                player.seek(frame);
                let mut pictures = [(); 2].map(|()| Framebuffer::<Gray4Rows<128, 64, 1024>>::new());
                solid.set_pose(player.pose()).unwrap();
                solid.draw_on(&mut pictures[0], true);
                pictures[0].clear();
                solid.lines().draw_on(&mut pictures[0], DrawStyle::default());
                lines.set_pose(player.pose()).unwrap();
                lines.draw_on(&mut pictures[1], DrawStyle::default());
                assert_eq!(pictures[0].cells(), pictures[1].cells(), "frame {frame}");
            }
        });
    }
}

#[test]
fn the_face_is_seen_from_the_front_alone() {
    let face = Rgb565::tint(&Look::DEFAULT.tint(Material::Face), 256);
    for clip in CLIPS {
        with_player(clip, |player| {
            let seen = [0, 90, -90, 180].map(|orbit| {
                let mut figure = figure(player, [176, 220], orbit);
                player.seek(7);
                let mut target = Target::<Rgb565>::new([176, 220]);
                figure.draw(player.pose(), &mut target).unwrap();
                target.pixels.iter().filter(|pixel| **pixel == face).count()
            });
            assert!(seen[0] > 200 && seen[3] == 0, "{seen:?}");
            assert!(seen[1] * 4 > seen[0] && seen[2] * 4 > seen[0] && seen[1].max(seen[2]) < seen[0], "{seen:?}");
        });
    }
}

#[test]
fn the_whole_figure_is_on_the_display_with_all_that_is_attached() {
    let tall = look("attach head ff0000 15 bright 0 60 0 40 0 250 0 30\nattach hips ff0000 15 bright 0 0 0 40 0 0 -250 30");
    for (clip, look) in CLIPS.into_iter().flat_map(|clip| looks().into_iter().chain([tall]).map(move |look| (clip, look))) {
        with_player(clip, |player| {
            for orbit in [0, -50, -90, 140] {
                let mut figure = figure_of(player, [176, 220], orbit, look);
                for frame in (0..player.clip().frames()).step_by(4) {
                    player.seek(frame);
                    let mut target = Target::<BinaryColor>::new([176, 220]);
                    figure.set_pose(player.pose()).unwrap();
                    figure.draw_on(&mut pantin_figure::surface::OnTarget::new(&mut target), false);
                    let (top, bottom) = (&target.pixels[..176 * 2], &target.pixels[176 * 218..]);
                    let sides = (0..220).flat_map(|row| [row * 176, row * 176 + 175].map(|index| &target.pixels[index]));
                    let border = top.iter().chain(bottom).chain(sides);
                    assert!({ border }.all(|pixel| pixel.is_off()), "frame {frame} from {orbit} degrees");
                }
            }
        });
    }
}

#[test]
fn shipped_characters_have_at_most_200_bytes_and_attachments() {
    for look in &looks()[1..] {
        assert!(look.bytes().len() <= 200 && look.attachments().count() >= 3, "{}", look.bytes().len());
    }
}

/// Pixels of a colour in frame 7 of a clip, and the mean of their rows and columns.
fn seen(player: &mut Player, look: Look, orbit: i16, rgb: [u8; 3]) -> [usize; 3] {
    let mut figure = figure_of(player, [176, 220], orbit, look);
    player.seek(7);
    let mut target = Target::<Rgb888>::new([176, 220]);
    figure.draw(player.pose(), &mut target).unwrap();
    // Lit or shaded: the hue stays.
    let is_own =
        |pixel: &Rgb888| (pixel.r() > 60) == (rgb[0] > 0) && (pixel.g() > 60) == (rgb[1] > 0) && (pixel.b() > 60) == (rgb[2] > 0);
    let places: Vec<usize> = (0..target.pixels.len()).filter(|index| is_own(&target.pixels[*index])).collect();
    let mean = |of: fn(usize) -> usize| places.iter().map(|place| of(*place)).sum::<usize>() / places.len().max(1);
    [places.len(), mean(|place| place / 176), mean(|place| place % 176)]
}

#[test]
fn attachments_are_where_their_anchors_say() {
    const MAGENTA: [u8; 3] = [255, 0, 255];
    let attached = |place: &str| look(&format!("colour left 808080\ncolour right 808080\nattach {place}"));
    with_player(CLIPS[0], |player| {
        let mut at = |place: &str, orbit| seen(player, attached(place), orbit, MAGENTA);
        // Rows: hat, bag, belt, hem.
        let places = ["head ff00ff 15 bright 0 80 0 50", "chest ff00ff 15 bright 0 0 -90 40", "hips ff00ff 15 bright 0 0 -90 40"];
        let [hat, bag, tail] = places.map(|place| at(place, 180));
        let hem = at("thighs ff00ff 15 bright 0 -150 0 60 -2 -150 0 60", 180);
        assert!([hat, bag, tail, hem].iter().all(|seen| seen[0] > 100), "{hat:?} {bag:?} {tail:?} {hem:?}");
        assert!(hat[1] < bag[1] && bag[1] < tail[1] && tail[1] < hem[1], "{hat:?} {bag:?} {tail:?} {hem:?}");
        // What is on the back is hidden from the front.
        assert!(at(places[1], 0)[0] * 4 < bag[0]);
        // The left side is on the left from behind, and on the right from the front.
        for anchor in ["head", "chest", "hips", "thighs"] {
            let [left, right] = [120, -120].map(|left| format!("{anchor} ff00ff 15 bright {left} 0 0 40"));
            assert!(at(&left, 180)[2] + 10 < at(&right, 180)[2], "{anchor}");
            assert!(at(&left, 0)[2] > at(&right, 0)[2] + 10, "{anchor}");
        }
    });
}

#[test]
fn both_sides_are_told_apart_in_two_colours() {
    // From behind, what is left of the figure's middle is the left side.
    with_player(CLIPS[0], |player| {
        let mut figure = figure(player, [128, 64], 180);
        player.seek(0);
        let mut target = Target::<BinaryColor>::new([128, 64]);
        figure.set_pose(player.pose()).unwrap();
        figure.draw_on(&mut pantin_figure::surface::OnTarget::new(&mut target), false);
        // Rows of the legs: bright pixels without a bright neighbour to the left are many where they are checkered.
        let alone = |columns: core::ops::Range<usize>| {
            let lit = |row: usize, column: usize| target.pixels[row * 128 + column].is_on();
            let places = (36..54).flat_map(|row| columns.clone().map(move |column| (row, column)));
            let (alone, all) = places.fold((0, 0), |(alone, all), (row, column)| {
                let on = lit(row, column);
                (alone + usize::from(on && !lit(row, column - 1) && !lit(row, column + 1)), all + usize::from(on))
            });
            (alone, all)
        };
        let ((left_alone, left), (right_alone, right)) = (alone(40..64), alone(64..90));
        assert!(left > 20 && left_alone * 8 < left, "left: {left_alone} of {left}");
        assert!(right > 20 && right_alone * 4 > right * 3, "right: {right_alone} of {right}");
    });
}

#[test]
fn no_pose_draws_outside_or_fails() {
    let mut random = fastrand::Rng::with_seed(42);
    with_player(CLIPS[0], |player| {
        let form: Form = player.pose().form.to_form();
        for round in 0..60 {
            let size = [[64, 32], [128, 64], [176, 220], [320, 240]][round % 4];
            let mut figure = figure_of(player, size, random.i16(-180..180), looks()[round / 4 % 4]);
            for _ in 0..4 {
                let most = 1 << random.u32(8..31);
                let values: Vec<i32> = (0..player.pose().values.len()).map(|_| random.i32(-most..most)).collect();
                let mut target = Target::<Gray4>::new(size);
                figure.draw(Pose { values: &values, form: (&form).into() }, &mut target).unwrap();
            }
        }
    });
}

#[test]
fn figures_of_one_world_are_sorted_among_each_other() {
    const GREEN: [u8; 3] = [0, 255, 0];
    const MAGENTA: [u8; 3] = [255, 0, 255];
    // All in one colour, and shaded: the hue stays.
    let coloured = |rgb: &str| {
        let materials = ["shirt", "trousers", "skin", "hair", "face", "nose", "left", "right", "right-end"];
        look(&materials.map(|material| format!("colour {material} {rgb}\n")).concat())
    };
    with_player(CLIPS[0], |player| {
        // One stands half a metre before the other, which is a little aside, as seen from the front.
        let exponent = i32::from(player.pose().form.length_exponent());
        let units = |cm: f64| (cm * 2f64.powi(-exponent)) as i64;
        let mut near = figure_of(player, [176, 220], 0, coloured("00ff00"));
        near.aim(player, View { orbit: 0, track: CameraTarget::Fixed, ..View::default() });
        let mut far = figure_of(player, [176, 220], 0, coloured("ff00ff"));
        far.share_camera(&near);
        let stand = |z: f64, x: f64| Stand { place: [units(z), units(x)], ..Stand::default() };
        player.seek(0);
        near.set_pose_at(player.pose(), stand(25.0, 0.0)).unwrap();
        far.set_pose_at(player.pose(), stand(-25.0, 12.0)).unwrap();
        let count = |target: &Target<Rgb888>, rgb: [u8; 3]| {
            let of_hue = |pixel: &&Rgb888| {
                (pixel.r() > 60) == (rgb[0] > 0) && (pixel.g() > 100) == (rgb[1] > 0) && (pixel.b() > 60) == (rgb[2] > 0)
            };
            target.pixels.iter().filter(of_hue).count()
        };
        let draw = |figures: &mut [&mut SolidFigure<JOINTS>]| {
            let mut target = Target::<Rgb888>::new([176, 220]);
            draw_together(figures, &mut pantin_figure::surface::OnTarget::new(&mut target), false);
            target
        };
        let alone = [draw(&mut [&mut near]), draw(&mut [&mut far])];
        let both = draw(&mut [&mut near, &mut far]);
        assert_eq!(both, draw(&mut [&mut far, &mut near]), "whatever the order of the figures");
        let [near_alone, far_alone] = [count(&alone[0], GREEN), count(&alone[1], MAGENTA)];
        assert!(near_alone > 1000 && far_alone > 1000, "{near_alone} {far_alone}");
        assert_eq!(count(&both, GREEN), near_alone, "nothing hides the nearer one");
        let seen = count(&both, MAGENTA);
        assert!(seen > 100 && seen * 10 < far_alone * 9, "{seen} of {far_alone}");
    });
}

#[test]
fn the_floor_does_not_cover_a_figure_of_lines() {
    let bytes = include_bytes!("../../../tests/vectors/channels-300.ptn");
    let mut memory = Room::<512, 512>::new();
    let mut player = memory.player(Clip::new_checked(bytes).unwrap()).unwrap();
    let canvas = Canvas { width: 176, height: 220 };
    let mut figure = SolidFigure::<254>::of_clip(&mut player, canvas, View::default(), Look::DEFAULT).unwrap();
    assert_eq!(figure.build(), Build::Lines);
    player.seek(0);
    figure.set_pose(player.pose()).unwrap();
    let (mut alone, mut together) = (Target::<Rgb888>::new([176, 220]), Target::<Rgb888>::new([176, 220]));
    figure.draw_on(&mut pantin_figure::surface::OnTarget::new(&mut alone), true);
    draw_together(&mut [&mut figure], &mut pantin_figure::surface::OnTarget::new(&mut together), true);
    assert!(alone == together, "the floor covers the lines");
}
