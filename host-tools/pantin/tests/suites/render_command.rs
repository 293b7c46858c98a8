//! `pantin render`: what is in the files that it writes, and what it refuses.

use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use pantin_figure::{View, surface};
use pantin_pictures::render::figure::PlayerBuffers;
use pantin_pictures::render::screen;
use pantin_tools::cmd::Files;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

struct Folder(PathBuf);

impl Folder {
    /// A folder with our walk as a clip: 160 frames, 120 a second.
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("pantin-render-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        let folder = Folder(path);
        let walk = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.keys");
        let converted = folder.pantin(&["convert", walk.to_str().unwrap(), "-o", "walk.ptn"]);
        assert!(converted.status.success(), "{}", text(&converted.stderr));
        folder
    }

    fn pantin(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).current_dir(&self.0).output().unwrap()
    }

    /// Renders the walk, and gives the file's bytes.
    fn render(&self, out: &str, more: &[&str]) -> Vec<u8> {
        let output = self.pantin(&[&["render", "walk.ptn", "-o", out], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        std::fs::read(self.0.join(out)).unwrap()
    }

    fn refusal(&self, out: &str, more: &[&str]) -> String {
        let output = self.pantin(&[&["render", "walk.ptn", "-o", out], more].concat());
        assert!(!output.status.success(), "{out} {more:?}");
        assert!(!self.0.join(out).exists(), "{out} is half written");
        text(&output.stderr)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Size and RGB pixels of a PNG (of an animated one, its first picture).
fn png(bytes: &[u8]) -> ([u32; 2], Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    ([info.width, info.height], pixels.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect())
}

/// Size, delays and whole pictures (RGB) of a GIF.
fn gif(bytes: &[u8]) -> ([u16; 2], Vec<u16>, Vec<Vec<[u8; 3]>>) {
    let mut reader = gif::DecodeOptions::new().read_info(bytes).unwrap();
    let size = [reader.width(), reader.height()];
    let palette: Vec<u8> = reader.global_palette().unwrap().to_vec();
    let mut screen = vec![[0; 3]; usize::from(size[0]) * usize::from(size[1])];
    let (mut delays, mut pictures) = (vec![], vec![]);
    while let Some(frame) = reader.read_next_frame().unwrap() {
        for (row, line) in frame.buffer.chunks(frame.width.into()).enumerate() {
            let start = (usize::from(frame.top) + row) * usize::from(size[0]) + usize::from(frame.left);
            for (column, index) in line.iter().enumerate() {
                screen[start + column] = palette[usize::from(*index) * 3..][..3].try_into().unwrap();
            }
        }
        delays.push(frame.delay);
        pictures.push(screen.clone());
    }
    (size, delays, pictures)
}

/// What the reference display shows of the walk's frame, each pixel enlarged.
fn display(folder: &Folder, frame: u32, scale: usize) -> Vec<[u8; 3]> {
    let files = Files::read(&folder.0.join("walk.ptn"), None).unwrap();
    let pictures = screen::pictures(&files.open().unwrap(), View::default(), [frame]).unwrap();
    pictures[0].enlarged(scale).into_iter().map(|grey| [grey; 3]).collect()
}

#[test]
fn a_gif_shows_the_reference_displays_pixels_at_the_clips_rate() {
    let folder = Folder::new("gif");
    let (size, delays, pictures) = gif(&folder.render("walk.gif", &[]));
    assert_eq!((size, delays.len()), ([512, 256], 54));
    // Every third frame, as viewers show no more than 50 a second: 162/120 s in hundredths.
    assert_eq!(delays.iter().sum::<u16>(), 135);
    assert!(delays.iter().all(|delay| (2..=3).contains(delay)));
    for picture in [0, 1, 40, 53] {
        assert!(pictures[picture] == display(&folder, 3 * picture as u32, 4), "picture {picture}");
    }
    let (_, delays, pictures) = gif(&folder.render("slow.gif", &["--fps", "10", "--from", "60", "--to", "119"]));
    assert_eq!((delays, pictures.len()), (vec![10; 5], 5));
    assert!(pictures[1] == display(&folder, 72, 4));
}

#[test]
fn an_animated_png_has_the_smooth_pictures_and_exact_times() {
    let folder = Folder::new("apng");
    let bytes = folder.render("walk.apng", &["--size", "240x240", "--palette", "dusk", "--to", "0.5s", "-q"]);
    assert_eq!(bytes, folder.render("walk.png", &["--size", "240x240", "--palette", "dusk", "--to", "0.5s", "--animate"]));
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (31, 0));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let mut ticks = 0;
    for _ in 0..31 {
        reader.next_frame(&mut pixels).unwrap();
        let frame = reader.info().frame_control().unwrap();
        ticks += u32::from(frame.delay_num);
        assert_eq!(frame.delay_den, 10_000);
    }
    // 31/60 s.
    assert_eq!(ticks, 5167);
    assert!(png(&bytes) == png(&folder.render("first.png", &["--size", "240x240", "--palette", "dusk", "--frame", "0"])));
    // A GIF of the same has nearly the same colours.
    let (_, _, pictures) = gif(&folder.render("walk.gif", &["--size", "240x240", "--palette", "dusk", "--to", "0.5s"]));
    let apart = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap();
    assert!(pictures[0].iter().zip(&png(&bytes).1).map(apart).max().unwrap() <= 24);
}

#[test]
fn views_are_rows_and_a_strip_is_one_row() {
    let folder = Folder::new("rows");
    let label = 12;
    let (size, _) = png(&folder.render("sheet.png", &[]));
    assert_eq!(size, [6 + 3 * 262, 6 + 4 * (128 + 6 + label)]);
    let (size, _) = png(&folder.render("views.png", &["--view", "front,-90,quarter", "--scale", "1"]));
    assert_eq!(size, [6 + 6 * 134, 6 + 3 * (64 + 6 + label)]);
    let strip = ["--strip", "5", "--size", "60x80", "--scale", "2", "--from", "20", "--to", "60"];
    let (size, pixels) = png(&folder.render("strip.png", &strip));
    assert_eq!(size, [2 + 5 * 122, 2 + 160 + 2 + label]);
    // Each picture has ground and figure, and its number below.
    for picture in 0..5 {
        let column = |x: usize| (2..162).map(move |y| y * size[0] as usize + x);
        let inside = || (0..120).flat_map(|x| column(2 + picture * 122 + x)).map(|place| pixels[place][0]);
        assert!(inside().any(|grey| grey > 150), "picture {picture}");
        // The ground's dots, beside the feet.
        let beside = |x: usize| (120..162).map(move |y| y * size[0] as usize + x);
        let mut ground = (0..36).flat_map(|x| beside(2 + picture * 122 + x)).map(|place| pixels[place][0]);
        assert!(ground.any(|grey| (17..150).contains(&grey)), "picture {picture}");
        let below = (0..120).map(|x| (162..174).any(|y| pixels[y * size[0] as usize + 2 + picture * 122 + x][0] > 150));
        assert!(below.filter(|&letter| letter).count() > 20, "picture {picture}");
    }
}

#[test]
fn an_svg_has_a_line_a_bone_thicker_and_brighter_the_nearer() {
    let folder = Folder::new("svg");
    let bytes = folder.render("walk.svg", &["--frame", "30", "--size", "300x400", "--view", "side"]);
    let svg = text(&bytes);
    let document = roxmltree::Document::parse(&svg).unwrap();
    assert_eq!(document.root_element().attribute("viewBox"), Some("0 0 300 400"));
    let group = |class| document.descendants().find(|node| node.attribute("class") == Some(class)).unwrap();
    let number = |node: &roxmltree::Node, name| node.attribute(name).unwrap().parse::<f32>().unwrap();
    assert_eq!(group("ground").children().filter(|node| node.is_element()).count(), 10);
    let bones: Vec<(f32, &str)> = group("figure")
        .children()
        .filter(|node| node.is_element() && node.attribute("stroke") != Some("#000000"))
        .map(|node| (number(&node, "stroke-width"), node.attribute("stroke").unwrap()))
        .collect();
    let files = Files::read(&folder.0.join("walk.ptn"), None).unwrap();
    let drawn = drawn_bones(&files.open().unwrap());
    assert_eq!(bones.len(), drawn);
    // From far to near, by width and by brightness.
    assert!(bones.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 <= pair[1].1), "{bones:?}");
    assert!(bones[drawn - 1].0 > 1.1 * bones[0].0);
    let sheet = text(&folder.render("strip.svg", &["--strip", "3", "--size", "100x150", "--from", "0", "--to", "10"]));
    let labels: Vec<String> = roxmltree::Document::parse(&sheet)
        .unwrap()
        .descendants()
        .filter(|node| node.has_tag_name("text"))
        .map(|node| node.text().unwrap().to_string())
        .collect();
    assert_eq!(labels, ["frame 0", "frame 5", "frame 10"]);
}

fn drawn_bones(clip: &pantin::Clip) -> usize {
    let mut memory = PlayerBuffers::of(clip);
    let mut player = memory.player(*clip).unwrap();
    let canvas = pantin_figure::Canvas { width: 300, height: 400 };
    let mut renderer = pantin_figure::FigureRenderer::<192>::of_clip(&mut player, canvas, View::default()).unwrap();
    renderer.lines(player.pose()).unwrap().bones.len()
}

#[test]
fn palettes_colour_the_paper_and_the_ink() {
    let folder = Folder::new("palette");
    let (_, pixels) = png(&folder.render("own.png", &["--frame", "0", "--palette", "102030,f0e0d0"]));
    assert_eq!(pixels[0], [0x10, 0x20, 0x30]);
    let (_, pixels) = png(&folder.render("mono.png", &["--frame", "0", "--palette", "mono", "--size", "320x240"]));
    assert!(pixels.iter().all(|rgb| [[0; 3], [255; 3]].contains(rgb)));
    assert!(pixels.iter().filter(|rgb| rgb[0] == 255).count() > 100);
}

#[test]
fn the_phones_picture_is_the_firmwares_own() {
    type Phone = surface::Framebuffer<surface::Rgb565Rows<176, 220, { 176 * 220 / 2 }>>;
    let folder = Folder::new("phone");
    let (size, pixels) =
        png(&folder.render("a.png", &["--frame", "30", "--size", "176x220", "--palette", "phone", "--scale", "1"]));
    assert_eq!(size, [176, 220]);
    let files = Files::read(&folder.0.join("walk.ptn"), None).unwrap();
    let clip = files.open().unwrap();
    let mut memory = PlayerBuffers::of(&clip);
    let mut player = memory.player(clip).unwrap();
    let canvas = pantin_figure::Canvas { width: 176, height: 220 };
    let mut renderer = pantin_figure::FigureRenderer::<192>::of_clip(&mut player, canvas, View::default()).unwrap();
    let mut frame = Phone::new();
    player.seek(30);
    renderer.set_pose(player.pose()).unwrap();
    renderer.draw_on(&mut frame, pantin_figure::DrawStyle::default());
    let shown = |index: usize| Rgb888::from(frame.pixel(index % 176, index / 176));
    assert!((0..176 * 220).all(|index| pixels[index] == [shown(index).r(), shown(index).g(), shown(index).b()]));
    // The figure's sides have hues of their own.
    let orange = pixels.iter().filter(|rgb| rgb[0] > 100 && rgb[2] < rgb[0] / 2).count();
    let blue = pixels.iter().filter(|rgb| rgb[2] > 100 && rgb[0] < rgb[2] / 2).count();
    assert!(orange > 50 && blue > 50, "{orange} {blue}");
}

#[test]
fn a_clip_with_a_body_and_a_face_shows_both() {
    let folder = Folder::new("both");
    let greet = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/greet.ptn");
    let lit = |more: &[&str]| {
        let output = folder
            .pantin(&[&["render", greet.to_str().unwrap(), "-o", "both.png", "--frame", "60", "--scale", "1"], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let ([width, _], pixels) = png(&std::fs::read(folder.0.join("both.png")).unwrap());
        let row = |row: &[[u8; 3]]| row.iter().map(|pixel| *pixel != [0; 3]).collect::<Vec<bool>>();
        pixels.chunks(width as usize).map(row).collect::<Vec<_>>()
    };
    let count = |rows: &[Vec<bool>], columns: std::ops::Range<usize>| {
        rows.iter().flat_map(|row| &row[columns.clone()]).filter(|lit| **lit).count()
    };
    let rows = lit(&[]);
    // The body beside the face's square of 64 pixels, as on a display of 128x64.
    assert!(count(&rows, 0..64) > 100 && count(&rows, 64..128) > 300);
    // Seen straight ahead, a face is nearly the same on both sides; from the side it is not.
    let uneven = |rows: &[Vec<bool>]| count(rows, 64..96).abs_diff(count(rows, 96..128));
    assert!(uneven(&rows) < 40, "{}", uneven(&rows));
    assert!(uneven(&lit(&["--view", "side"])) > 40);
    // A display that is not wide has the face in its corner.
    let tall = lit(&["--size", "100x160"]);
    assert!(count(&tall[..40], 60..100) > 100 && count(&tall[100..], 0..100) > 20);
}

#[test]
fn equal_input_gives_equal_bytes() {
    let folder = Folder::new("equal");
    for (name, size) in [("a.gif", "480x480"), ("a.apng", "64x48"), ("a.png", "480x480"), ("a.svg", "240x240")] {
        let more = ["--size", size, "--to", "20", "--palette", "oled"];
        assert!(folder.render(name, &more) == folder.render(name, &more), "{name}");
    }
}

#[test]
fn a_character_of_a_text_file_is_drawn_and_a_wrong_one_is_refused_with_its_line() {
    let folder = Folder::new("look");
    let looks = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/looks");
    let of = ["--frame", "9", "--size", "100x120", "--palette", "phone", "--style", "solid"];
    let plain = folder.render("plain.png", &of);
    for name in ["dancer", "ranger", "cat"] {
        let look = looks.join(name).with_extension("look");
        let own = folder.render(&format!("{name}.png"), &[&of[..], &["--look", look.to_str().unwrap()]].concat());
        assert!(png(&own).1 != png(&plain).1, "{name}");
    }
    std::fs::write(folder.0.join("empty.look"), "# nothing\n").unwrap();
    assert!(folder.render("same.png", &[&of[..], &["--look", "empty.look"]].concat()) == plain);
    std::fs::write(folder.0.join("bad.look"), "radius hip 50\ncolour shirt red\n").unwrap();
    std::fs::write(folder.0.join("binary.look"), [0xff, 0xfe, 0]).unwrap();
    for (look, expected) in [
        ("bad.look", "bad.look: line 2: expected a colour of six hexadecimal digits, RRGGBB"),
        ("binary.look", "binary.look: the file is no text"),
        ("absent.look", "absent.look"),
    ] {
        let said = folder.refusal("no.png", &[&of[..], &["--look", look]].concat());
        assert!(said.contains(expected), "{said}");
        let played = folder.pantin(&["play", "walk.ptn", "--plain", "--once", "--look", look]);
        assert!(!played.status.success() && text(&played.stderr).contains(expected), "{}", text(&played.stderr));
    }
    assert!(folder.refusal("no.png", &["--look", "empty.look"]).contains("--look is for --style solid"));
}

#[test]
fn what_cannot_be_done_is_refused_in_one_clear_line() {
    let folder = Folder::new("refusals");
    let cases: [(&str, &[&str], &[&str]); 14] = [
        ("walk.mp4", &[], &["walk.mp4", ".gif, .apng, .png or .svg"]),
        ("walk", &[], &["expected a name that ends in"]),
        ("no/such/folder.png", &[], &["no/such/folder.png: there is no folder no/such"]),
        ("a.png", &["--size", "9000x9000"], &["each side must be 8 to 4096"]),
        ("a.png", &["--size", "big"], &["as in 240x240"]),
        ("a.png", &["--size", "4000x4000"], &["more than is sensible", "smaller --size"]),
        ("a.png", &["--size", "2000x10", "--pixels"], &["at most 1024 a side"]),
        ("a.gif", &["--from", "200"], &["frame 200 is not in the clip", "0 to 159"]),
        ("a.gif", &["--from", "9", "--to", "8"], &["--from is frame 9, behind --to"]),
        ("a.gif", &["--fps", "0"], &["--fps 0", "above 0"]),
        ("a.png", &["--fps", "10"], &["--fps is for animations"]),
        ("a.gif", &["--strip", "4"], &["--strip and --frame make a .png or .svg"]),
        ("a.png", &["--palette", "sepia"], &["blueprint", "RRGGBB,RRGGBB"]),
        ("a.svg", &["--scale", "2"], &["--size says how big"]),
    ];
    for (out, more, words) in cases {
        let error = folder.refusal(out, more);
        assert!(words.iter().all(|word| error.contains(word)), "{out} {more:?}: {error}");
        assert!(!error.contains("panicked"), "{error}");
    }
}
