//! A face in a display of the user's own, from weights by name.

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{Gray8, GrayColor};
use pantin_face::{CARTOON, FaceRenderer, FaceView, MODEL, Model, Morph, NAMES, Target, UnknownName, VERTICES, Weight, Weights};
use pantin_figure::Canvas;
use pantin_figure::draw::stroke;
use pantin_figure::surface::OnTarget;

const WIDTH: usize = 128;
const HEIGHT: usize = 64;
const CANVAS: Canvas = Canvas { width: WIDTH as u16, height: HEIGHT as u16 };

struct Display([[u8; WIDTH]; HEIGHT]);

impl OriginDimensions for Display {
    fn size(&self) -> Size {
        Size::new(WIDTH as u32, HEIGHT as u32)
    }
}

impl DrawTarget for Display {
    type Color = Gray8;
    type Error = &'static str;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray8>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(point, color) in pixels {
            let row = self.0.get_mut(point.y as usize).ok_or("a row outside")?;
            *row.get_mut(point.x as usize).ok_or("a column outside")? = color.luma();
        }
        Ok(())
    }
}

/// Draws the face with these weights, by name.
fn drawn(named: &[(&str, &str)]) -> [[u8; WIDTH]; HEIGHT] {
    drawn_of(MODEL, named)
}

/// Draws a model.
fn drawn_of(model: &[u8], named: &[(&str, &str)]) -> [[u8; WIDTH]; HEIGHT] {
    let model = Model::new_checked(model).unwrap();
    let mut weights = Weights::new();
    for (name, weight) in named {
        weights.set(&model, name, weight.parse().unwrap()).unwrap();
    }
    let mut morph = Morph::<VERTICES>::new(&model).unwrap();
    let mut renderer = FaceRenderer::<VERTICES>::new(&model, CANVAS, FaceView::default());
    morph.apply(&model, &weights);
    renderer.project(&model, &morph);
    let mut display = Display([[255; WIDTH]; HEIGHT]);
    renderer.draw(&model, &mut display).unwrap();
    let mut by_lines = Display([[0; WIDTH]; HEIGHT]);
    let mut surface = OnTarget::new(&mut by_lines);
    renderer.each_line(&model, |line| stroke(&line, &mut surface, false));
    surface.outcome().unwrap();
    assert_eq!(display.0, by_lines.0, "the lines differ from the picture");
    let before = display.0;
    renderer.draw_over(&model, &mut display).unwrap();
    assert_eq!(display.0, before, "drawing over the same picture changes it");
    let mut full = Display([[7; WIDTH]; HEIGHT]);
    renderer.draw_over(&model, &mut full).unwrap();
    // Filled shapes may be dark.
    if model.curves().any(|curve| curve.filled) {
        return before;
    }
    assert!(
        full.0.iter().flatten().zip(before.iter().flatten()).all(|(over, alone)| over == if *alone == 0 { &7 } else { alone })
    );
    before
}

/// Rows in which two pictures differ.
fn changed(a: &[[u8; WIDTH]; HEIGHT], b: &[[u8; WIDTH]; HEIGHT]) -> Vec<usize> {
    (0..HEIGHT).filter(|&row| a[row] != b[row]).collect()
}

#[test]
fn weights_by_name_move_what_they_name() {
    let neutral = drawn(&[]);
    assert!(neutral.iter().flatten().filter(|&&pixel| pixel > 0).count() > 200, "hardly a face");
    let jaw = drawn(&[("jawOpen", "0.5")]);
    let rows = changed(&neutral, &jaw);
    assert!(rows.len() > 5 && rows.iter().all(|&row| row > HEIGHT / 2), "a jaw changes the lower half only: {rows:?}");
    let blink = drawn(&[("blink", "1")]);
    let rows = changed(&neutral, &blink);
    assert!(!rows.is_empty() && rows.iter().all(|&row| row < 2 * HEIGHT / 3), "lids change the upper half only: {rows:?}");
    let wink = drawn(&[("blink_left", "1")]);
    let columns: Vec<usize> = (0..WIDTH).filter(|&x| (0..HEIGHT).any(|y| wink[y][x] != neutral[y][x])).collect();
    assert!(!columns.is_empty() && columns.iter().all(|&x| x >= WIDTH / 2), "the face's left eye is on the right: {columns:?}");
}

/// For each unit of the paper, the columns and the rows of a display of 128x64 pixels that it may change, and how many pixels it changes at least.
type Region = (&'static str, [usize; 2], [usize; 2], usize);
const REGIONS: [Region; 7] = [
    ("open_mouth", [46, 81], [40, 62], 120),
    ("smile", [54, 73], [38, 48], 45),
    ("wide_smile", [44, 83], [36, 48], 55),
    ("lower_corners", [54, 73], [40, 49], 25),
    ("brow_inner_lower", [48, 79], [15, 23], 16),
    ("brow_outer_raise", [48, 79], [15, 23], 18),
    ("puff_cheeks", [42, 85], [30, 54], 45),
];

#[test]
fn each_unit_of_the_paper_shows_where_it_acts_and_nowhere_else() {
    let neutral = drawn(&[]);
    for (unit, columns, rows, least) in REGIONS {
        let moved = drawn(&[(unit, "1")]);
        let mut changed = 0;
        for y in 0..HEIGHT {
            for x in (0..WIDTH).filter(|&x| moved[y][x] != neutral[y][x]) {
                assert!((columns[0]..=columns[1]).contains(&x) && (rows[0]..=rows[1]).contains(&y), "{unit} changes {x}, {y}");
                changed += 1;
            }
        }
        assert!(changed >= least, "{unit} changes {changed} pixels");
        // Both sides alike.
        for side in ["left", "right"].iter().filter(|_| unit != "open_mouth") {
            let one = drawn(&[(&format!("{unit}_{side}"), "1")]);
            assert!(one != neutral && one != moved, "{unit}_{side}");
        }
    }
}

#[test]
fn the_cartoon_fills_its_shapes_and_moves_them_by_the_same_names() {
    let lit = |picture: &[[u8; WIDTH]; HEIGHT], rows: std::ops::Range<usize>| {
        picture[rows].iter().flatten().filter(|&&pixel| pixel > 0).count()
    };
    let (eyes, mouth) = (10..32, 32..HEIGHT);
    let neutral = drawn_of(CARTOON, &[]);
    // Outlines alone would have less than half of that.
    assert!(lit(&neutral, eyes.clone()) > 200 && lit(&neutral, mouth.clone()) > 200, "shapes are filled");
    // Two tones and the tongue between.
    let closed = drawn_of(CARTOON, &[("blink", "1")]);
    assert!(lit(&closed, eyes.clone()) * 3 < lit(&neutral, eyes.clone()), "closed eyes are dark");
    assert_eq!(lit(&closed, mouth.clone()), lit(&neutral, mouth.clone()));
    let wink = drawn_of(CARTOON, &[("wink_left", "1")]);
    let half = |picture: &[[u8; WIDTH]; HEIGHT], left: bool| {
        let columns = if left { WIDTH / 2..WIDTH } else { 0..WIDTH / 2 };
        picture[eyes.clone()].iter().flat_map(|row| &row[columns.clone()]).filter(|&&pixel| pixel > 0).count()
    };
    assert!(half(&wink, true) * 2 < half(&wink, false), "the face's left eye is on the right");
    let open = drawn_of(CARTOON, &[("open_mouth", "0.6")]);
    let dark = |picture: &[[u8; WIDTH]; HEIGHT]| (WIDTH / 2 - 8..WIDTH / 2 + 8).filter(|&x| picture[46][x] == 0).count();
    assert!(dark(&open) >= 12 && lit(&open, mouth.clone()) > 100, "an open mouth is dark inside");
    for name in ["joy", "sadness", "surprise", "angry", "pucker", "tongue_out", "look_left", "viseme_aa"] {
        assert!(drawn_of(CARTOON, &[(name, "1")]) != neutral, "{name}");
    }
}

#[test]
fn closed_lips_of_the_cartoon_hide_its_tongue_however_the_head_nods() {
    let tongue = |named: &[(&str, &str)]| drawn_of(CARTOON, named).iter().flatten().filter(|&&shade| shade == 150).count();
    assert!(tongue(&[("open_mouth", "0.6")]) > 0);
    for nod in ["0", "0.3", "0.6", "-0.5"] {
        for lips in ["frown", "smile", "lip_press"] {
            assert_eq!(tongue(&[(lips, "1"), ("nod", nod)]), 0, "{lips} at a nod of {nod}");
        }
    }
}

#[test]
fn the_picture_keeps_room_for_an_open_jaw() {
    let model = Model::new_checked(MODEL).unwrap();
    for (width, height) in [(128, 64), (240, 240), (64, 64), (128, 160)] {
        for names in [&["open_mouth"][..], &["surprise"], &["surprise_printed"]] {
            let mut weights = Weights::new();
            names.iter().for_each(|name| weights.set(&model, name, Weight::ONE).unwrap());
            let mut morph = Morph::<VERTICES>::new(&model).unwrap();
            let mut renderer = FaceRenderer::<VERTICES>::new(&model, Canvas { width, height }, FaceView::default());
            morph.apply(&model, &weights);
            renderer.project(&model, &morph);
            let lowest = renderer.points().iter().map(|point| point[1]).max().unwrap();
            assert!(i32::from(lowest) < i32::from(height) * 16, "{names:?} reach {lowest} sixteenths of {width}x{height}");
        }
    }
}

#[test]
fn names_are_found_as_written_or_with_a_capital_letter() {
    let model = Model::new_checked(MODEL).unwrap();
    let mut weights = Weights::new();
    for name in NAMES.lines() {
        weights.set(&model, name, Weight::ONE).unwrap();
    }
    let weights_of = |name: &str| {
        let mut weights = Weights::new();
        weights.set(&model, name, Weight::lit("0.75")).map(|()| weights.pairs().collect::<Vec<_>>())
    };
    assert_eq!(weights_of("jawOpen"), weights_of("JawOpen"));
    for unknown in ["", "JAWOPEN", "no such name", "a name that is longer than any name that a model can have"] {
        assert_eq!(weights_of(unknown).unwrap_err(), UnknownName);
    }
}

#[test]
fn setting_replaces_and_adding_adds() {
    let model = Model::new_checked(MODEL).unwrap();
    let (mut set, mut added) = (Weights::new(), Weights::new());
    for weight in ["0.25", "0.5"] {
        set.set(&model, "smile", weight.parse().unwrap()).unwrap();
        added.add(&model, "smile", weight.parse().unwrap()).unwrap();
    }
    let largest = |weights: &Weights| weights.pairs().flatten().max();
    assert_eq!([largest(&set), largest(&added)], [Some(1 << 14), Some(3 << 13)]);
    set.set(&model, "smile_left", Weight::ZERO).unwrap();
    assert_eq!(set.pairs().filter(|pair| *pair == [0, 1 << 14]).count(), 1, "the right side stays");
    set.set(&model, "smile", Weight::MAX).unwrap();
    assert_eq!(largest(&set), Some(1 << 15), "weights saturate");
    let mut negative = Weights::new();
    negative.set(&model, "eye_out", -Weight::ONE).unwrap();
    let mut by_target = Weights::new();
    let entry = model.name_entries().find(|entry| entry.hash == pantin_face::model::hash(b"eye_out")).unwrap();
    by_target.add_to(Target::new(entry.target.shape() as u8, [true, true]), -(1 << 15));
    assert!(negative.pairs().eq(by_target.pairs()));
}
