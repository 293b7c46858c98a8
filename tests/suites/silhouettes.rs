//! The element's solid figure covers what the firmware's does, at the size of the picture: default characters, our others, and a rig that is no person's.

use std::collections::HashMap;
use std::convert::Infallible;
use std::path::PathBuf;
use std::process::Command;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::Rgb565;
use harness::web::browser::skipped;
use harness::{paths, setup};
use pantin::Clip;
use pantin_figure::solid::{Look, SolidFigure, look_text};
use pantin_figure::surface::OnTarget;
use pantin_figure::{Canvas, RIG_JOINTS, View};
use pantin_pictures::render::figure::PlayerBuffers;
use serde_json::json;

use crate::web::{self, own};

const SIZES: [[usize; 2]; 2] = [[480, 240], [200, 300]];
const VIEWS: [[i16; 2]; 3] = [[-50, 12], [0, 0], [140, 40]];
/// Pixels of one silhouette may be this far from the other one. Firmware rounds circles and outlines to whole rows and pixels.
const MOST_APART: i32 = 2;
/// The part of the figure's area that only one of both may cover.
const MOST_DIFFERENT: f64 = 0.04;

/// A display that knows which of its pixels were drawn.
struct Mask {
    size: [usize; 2],
    drawn: Vec<bool>,
}

impl OriginDimensions for Mask {
    fn size(&self) -> Size {
        Size::new(self.size[0] as u32, self.size[1] as u32)
    }
}

impl DrawTarget for Mask {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, _) in pixels {
            let [x, y] = [at.x, at.y].map(|place| usize::try_from(place).unwrap_or(usize::MAX));
            if x < self.size[0] && y < self.size[1] {
                self.drawn[y * self.size[0] + x] = true;
            }
        }
        Ok(())
    }
}

/// The firmware's silhouettes of some frames.
fn expected(clip: &[u8], look: Look, [orbit, tilt]: [i16; 2], size: [usize; 2], frames: &[u32]) -> Vec<Mask> {
    let clip = Clip::new_checked(clip).unwrap();
    let mut buffers = PlayerBuffers::of(&clip);
    let mut player = buffers.player(clip).unwrap();
    let [width, height] = size.map(|pixels| pixels as u16);
    let view = View { orbit, tilt, ..View::default() };
    let mut solid = SolidFigure::<RIG_JOINTS>::of_clip(&mut player, Canvas { width, height }, view, look).unwrap();
    let mut draw = |frame: &u32| {
        player.seek(*frame);
        solid.set_pose(player.pose()).unwrap();
        let mut mask = Mask { size, drawn: vec![false; size[0] * size[1]] };
        solid.draw_on(&mut OnTarget::new(&mut mask), false);
        mask
    };
    frames.iter().map(&mut draw).collect()
}

impl Mask {
    /// A bit for each pixel.
    fn unpacked(size: [usize; 2], bits: &str) -> Mask {
        let bits = STANDARD.decode(bits).unwrap();
        Mask { size, drawn: (0..size[0] * size[1]).map(|at| bits[at >> 3] >> (at & 7) & 1 == 1).collect() }
    }

    fn at(&self, x: i32, y: i32) -> bool {
        let [width, height] = self.size.map(|pixels| pixels as i32);
        (0..width).contains(&x) && (0..height).contains(&y) && self.drawn[(y * width + x) as usize]
    }

    /// How far its pixels are from the other one at most, up to a distance that no test allows, and how many of them the other one lacks.
    fn beyond(&self, other: &Mask) -> (i32, usize) {
        let (mut farthest, mut count) = (0, 0);
        for at in (0..self.drawn.len()).filter(|at| self.drawn[*at] && !other.drawn[*at]) {
            let [x, y] = [at % self.size[0], at / self.size[0]].map(|place| place as i32);
            let reaches = |radius: i32| (-radius..=radius).any(|up| (-radius..=radius).any(|right| other.at(x + right, y + up)));
            farthest = farthest.max((1..=8).find(|radius| reaches(*radius)).unwrap_or(9));
            count += 1;
        }
        (farthest, count)
    }
}

/// What is compared: a clip as the site serves it and its bytes, and a character.
struct Case {
    url: String,
    bytes: Vec<u8>,
    look: Option<&'static str>,
}

fn looks() -> HashMap<&'static str, Look> {
    let compiled = |name: &'static str| {
        let text = std::fs::read_to_string(own("looks").join(name).with_extension("look")).unwrap();
        (name, Look::new(look_text::compile(&text).unwrap().to_vec().leak()).unwrap())
    };
    ["cat", "dancer", "ranger"].map(compiled).into()
}

fn cases() -> Vec<Case> {
    let of = |path: PathBuf, url: &str, look| Case { url: url.into(), bytes: std::fs::read(path).unwrap(), look };
    let clips = ["walk", "run", "kneebend"].map(|name| (own(name).with_extension("ptn"), format!("clips/{name}.ptn")));
    let mut cases: Vec<Case> = clips.iter().map(|(path, url)| of(path.clone(), url, None)).collect();
    for look in ["cat", "dancer", "ranger"] {
        let (path, url) = &clips[0];
        cases.push(of(path.clone(), url, Some(look)));
    }
    let vectors = paths::root().join("tests/key-vectors");
    cases.push(of(vectors.join("walk.ptn"), "extra/key-walk.ptn", Some("cat")));
    // A rig whose names are no person's: each bone is a capsule.
    cases.push(of(paths::root().join("tests/vectors/turn-orders.ptn"), "extra/turn-orders.ptn", None));
    cases
}

#[test]
fn the_elements_solid_figure_covers_what_the_firmwares_does() {
    if skipped("the element's solid figure") {
        return;
    }
    let (looks, cases) = (looks(), cases());
    let frames_of = |case: &Case| {
        let frames = Clip::new_checked(&case.bytes).unwrap().frames();
        [0, frames / 5, frames / 2, frames - 1].to_vec()
    };
    let (mut worst_apart, mut worst_part, mut count) = (0, 0.0f64, 0);
    for size in SIZES {
        let parts: Vec<_> = cases.iter().flat_map(|case| VIEWS.map(|view| (case, view))).collect();
        let asked: Vec<_> = parts
            .iter()
            .map(|(case, [orbit, tilt])| {
                let look = case.look.map(|name| format!("clips/{name}.look"));
                json!({ "clip": case.url, "look": look, "frames": frames_of(case), "orbit": orbit, "tilt": tilt })
            })
            .collect();
        let shown = web::drive("silhouettes", json!({ "parts": asked, "size": size }));
        for ((case, view), shown) in parts.iter().zip(shown.as_array().unwrap()) {
            let look = case.look.map_or(Look::DEFAULT, |name| looks[name]);
            let frames = frames_of(case);
            let expected = expected(&case.bytes, look, *view, size, &frames);
            for ((frame, theirs), own) in frames.iter().zip(&expected).zip(shown.as_array().unwrap()) {
                let own = Mask::unpacked(size, own.as_str().unwrap());
                let area = theirs.drawn.iter().filter(|drawn| **drawn).count();
                let [(more, surplus), (less, lack)] = [own.beyond(theirs), theirs.beyond(&own)];
                let part = (surplus + lack) as f64 / area.max(1) as f64;
                let what = format!("{} as {:?}, frame {frame}, {size:?} from {view:?}", case.url, case.look);
                assert!(area > 200, "{what}: {area} pixels");
                assert!(
                    more.max(less) <= MOST_APART && part <= MOST_DIFFERENT,
                    "{what}: {more} pixels beyond, {less} missing, {:.1} % of {area} differ",
                    100.0 * part
                );
                worst_apart = worst_apart.max(more).max(less);
                worst_part = worst_part.max(part);
                count += 1;
            }
        }
    }
    assert!(count > 150);
    println!("{count} silhouettes: at most {worst_apart} pixels apart, {:.2} % of the area differs", 100.0 * worst_part);
}

/// Our characters and random texts, in the element's module and in the library.
#[test]
fn the_element_reads_characters_as_the_library_does() {
    if skipped("texts of characters") {
        return;
    }
    let words = "radius outline colour attach head chest hips thighs hair left hip skull 9 -4 +30 250 ffee11 FFA03C dark 3 # é 99999999999 1.5 0x10";
    let words: Vec<&str> = words.split(' ').chain(["\n", "\n"]).collect();
    let lines = [
        "radius neck 30",
        "colour left ffa03c",
        "colour edge 102030 4 dark",
        "attach hips shirt 1 -3 5 20",
        "attach head 112233 4 dark 8 8 8 8 -9 9 9 9",
        "outline 40",
    ];
    let mut state = 7u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut texts: Vec<String> = ["cat", "dancer", "ranger"]
        .map(|name| std::fs::read_to_string(own("looks").join(name).with_extension("look")).unwrap())
        .into();
    for round in 0..1500 {
        let count = 1 + random(9);
        let of = |list: &[&str], index: usize| list[index % list.len()].to_owned();
        let parts: Vec<String> =
            (0..count).map(|_| if round % 2 == 0 { of(&lines, random(64)) } else { of(&words, random(1 << 20)) }).collect();
        texts.push(parts.join(if round % 2 == 0 { "\n" } else { " " }));
    }
    let list: Vec<_> = texts
        .iter()
        .map(|text| match look_text::compile(text) {
            Ok(bytes) => json!({ "text": text, "bytes": bytes.to_vec() }),
            Err(error) => json!({ "text": text, "error": error.to_string() }),
        })
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("looks.json");
    std::fs::write(&file, json!(list).to_string()).unwrap();
    let mut node = Command::new(setup::emulator("node").unwrap());
    let output = node.arg(paths::root().join("tests/web/looks.mjs")).arg(&file).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}

/// A character as text and compiled is the same one to the element, and what is none is reported.
#[test]
fn the_element_wears_characters() {
    if skipped("characters of the solid figure") {
        return;
    }
    web::drive("looks", json!({ "compiled": "extra/cat.look" }));
}
