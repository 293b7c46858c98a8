//! Characters by text: compiles a `.look` file to the bytes of a [`Look`].
//!
//! A file has one statement a line; what follows `#` is a comment. A character is [`Look::DEFAULT`] with the changes that the file states.
//!
//! ```text
//! radius skull 86            # thousandths of the height; small figures get as much more as the default ones do
//! radius hip 60 62           # of figures of 80 pixels and more, and of smaller ones
//! outline 100                # outlines are a 100th of the height, at least a pixel
//! colour shirt b02838        # red, green, blue
//! colour hair f0d060 12 bright   # and grey from 0 to 15, and the pattern on displays of two colours: dark, bright or checkered
//! attach head 806040 7 dark 0 70 0 60 0 100 0 40
//! attach head hair -10 20 -80 30
//! ```
//!
//! `attach` has an anchor ([`Anchor`]: head, chest, hips or thighs), a material's name or a colour with grey and pattern, and one to four circles,
//! each left, up, ahead and radius in thousandths of the height. Their convex hull is drawn. Places are from -254 to 254, radii from 2 to 250; both
//! are stored in steps of 2.

use super::hull::root;
use super::look::{
    Anchor, Look, MATERIALS, MOST_ATTACHMENTS, MOST_BYTES, MOST_CIRCLES, RADII, REACH_STEP, REACHES, STEP, VERSION,
};
use super::tint::{Pattern, Tint};
use heapless::Vec;

/// Names of [`Radius`](super::Radius), in its order.
const RADIUS_NAMES: [&str; RADII] =
    ["hip", "knee", "ankle", "shoulder", "elbow", "wrist", "hand", "heel", "toe", "chest", "waist", "pelvis", "neck", "skull"];
/// Names of [`Material`](super::Material), in its order.
const MATERIAL_NAMES: [&str; MATERIALS] = [
    "shirt",
    "trousers",
    "skin",
    "hair",
    "face",
    "nose",
    "eye",
    "left",
    "right",
    "right-end",
    "edge",
    "stage",
    "floor",
    "shadow",
];
/// Names of [`Anchor`], in its order.
const ANCHOR_NAMES: [&str; Anchor::ALL.len()] = ["head", "chest", "hips", "thighs"];
/// Names of [`Pattern`], in its order.
const PATTERN_NAMES: [&str; 3] = ["dark", "bright", "checkered"];

/// Greatest radius of a part, in thousandths of the height.
const MOST_RADIUS: i32 = 200;

/// What is wrong with a text, and in which line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextError {
    /// The line, from 1 on.
    pub line: usize,
    /// What is wrong with it.
    pub kind: TextErrorKind,
}

/// What is wrong with a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TextErrorKind {
    /// It begins with none of `radius`, `outline`, `colour` and `attach`.
    Statement,
    /// The word after `radius` is no part's name.
    Radius,
    /// A material's name was expected, or six hexadecimal digits where a colour may be.
    Material,
    /// Six hexadecimal digits were expected.
    Colour,
    /// A grey from 0 to 15 was expected.
    Grey,
    /// `dark`, `bright` or `checkered` was expected.
    Pattern,
    /// `head`, `chest`, `hips` or `thighs` was expected.
    Anchor,
    /// A whole number between these was expected.
    Number(i32, i32),
    /// An attachment has one to four circles of four numbers.
    Circles,
    /// There are words after the statement.
    Rest,
    /// The character has more than 200 bytes, or more than 12 attachments, with this line.
    Full,
}

impl core::fmt::Display for TextError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "line {}: ", self.line)?;
        let one_of = |f: &mut core::fmt::Formatter<'_>, names: &[&str]| {
            write!(f, "expected one of")?;
            names.iter().enumerate().try_for_each(|(index, name)| write!(f, "{} {name}", if index == 0 { "" } else { "," }))
        };
        match self.kind {
            TextErrorKind::Statement => one_of(f, &["radius", "outline", "colour", "attach"]),
            TextErrorKind::Radius => one_of(f, &RADIUS_NAMES),
            TextErrorKind::Material => one_of(f, &MATERIAL_NAMES),
            TextErrorKind::Anchor => one_of(f, &ANCHOR_NAMES),
            TextErrorKind::Pattern => one_of(f, &PATTERN_NAMES),
            TextErrorKind::Colour => write!(f, "expected a colour of six hexadecimal digits, RRGGBB"),
            TextErrorKind::Grey => write!(f, "expected a grey from 0 to 15"),
            TextErrorKind::Number(from, to) => write!(f, "expected a whole number from {from} to {to}"),
            TextErrorKind::Circles => {
                write!(f, "an attachment has one to {MOST_CIRCLES} circles, each of four numbers: left, up, ahead, radius")
            }
            TextErrorKind::Rest => write!(f, "there are more words than the statement has"),
            TextErrorKind::Full => {
                write!(f, "the character has more than {MOST_ATTACHMENTS} attachments or {MOST_BYTES} bytes with this line")
            }
        }
    }
}

impl core::error::Error for TextError {}

type Words<'a> = core::str::SplitWhitespace<'a>;

/// A character while its text is read.
struct Draft {
    radii: [[u8; RADII]; 2],
    outline: u8,
    tints: [Tint; MATERIALS],
    /// As in the compiled character.
    reaches: [u8; REACHES],
    count: u8,
    /// As in the compiled character.
    attachments: Vec<u8, MOST_BYTES>,
}

/// Compiles a text to the bytes of a [`Look`].
///
/// # Errors
/// The first line that is wrong.
pub fn compile(text: &str) -> Result<Vec<u8, MOST_BYTES>, TextError> {
    let mut draft = Draft {
        radii: Look::DEFAULT_RADII,
        outline: Look::DEFAULT.outline(),
        tints: Look::DEFAULT_TINTS,
        reaches: [0; REACHES],
        count: 0,
        attachments: Vec::new(),
    };
    for (line, number) in text.lines().zip(1..) {
        let line = line.split_once('#').map_or(line, |(statement, _)| statement);
        draft.take(line).map_err(|kind| TextError { line: number, kind })?;
    }
    // The last statement left room for all of them.
    Ok(draft.bytes().unwrap_or_default())
}

impl Draft {
    /// Takes in a line.
    fn take(&mut self, line: &str) -> Result<(), TextErrorKind> {
        let mut words = line.split_whitespace();
        match words.next() {
            None => return Ok(()),
            Some("radius") => {
                let part = index(&RADIUS_NAMES, words.next()).ok_or(TextErrorKind::Radius)?;
                let large = number(words.next(), 1, MOST_RADIUS)?;
                let [own, small] = Look::DEFAULT_RADII.map(|radii| i32::from(radii[part]));
                let small = match words.next() {
                    None => (large + small - own).clamp(1, MOST_RADIUS),
                    word => number(word, 1, MOST_RADIUS)?,
                };
                (self.radii[0][part], self.radii[1][part]) = (large as u8, small as u8);
            }
            Some("outline") => self.outline = number(words.next(), 20, 255)? as u8,
            Some("colour") => {
                let material = index(&MATERIAL_NAMES, words.next()).ok_or(TextErrorKind::Material)?;
                let tint = &mut self.tints[material];
                tint.rgb = colour(words.next()).ok_or(TextErrorKind::Colour)?;
                if let Some(word) = words.next() {
                    tint.grey = grey(Some(word))?;
                }
                if let Some(word) = words.next() {
                    tint.pattern = pattern(Some(word))?;
                }
            }
            Some("attach") => self.attach(&mut words)?,
            Some(_) => return Err(TextErrorKind::Statement),
        }
        if words.next().is_some() { Err(TextErrorKind::Rest) } else { Ok(()) }
    }

    fn attach(&mut self, words: &mut Words) -> Result<(), TextErrorKind> {
        let anchor = index(&ANCHOR_NAMES, words.next()).ok_or(TextErrorKind::Anchor)?;
        let word = words.next();
        let tint = match index(&MATERIAL_NAMES, word) {
            Some(material) => self.tints[material],
            None => {
                let rgb = colour(word).ok_or(TextErrorKind::Material)?;
                Tint { rgb, grey: grey(words.next())?, pattern: pattern(words.next())? }
            }
        };
        let mut circles = Vec::<u8, { 4 * MOST_CIRCLES }>::new();
        while let Some(word) = words.next() {
            let place = |word| number(word, -127 * STEP, 127 * STEP).map(|place| (place / STEP) as u8);
            let mut circle = [place(Some(word))?, 0, 0, 0];
            for place_of in &mut circle[1..3] {
                *place_of = place(Some(words.next().ok_or(TextErrorKind::Circles)?))?;
            }
            circle[3] = (number(Some(words.next().ok_or(TextErrorKind::Circles)?), STEP, 125 * STEP)? / STEP) as u8;
            circles.extend_from_slice(&circle).map_err(|_| TextErrorKind::Circles)?;
            let reach = &mut self.reaches[anchor.min(REACHES - 1)];
            *reach = (*reach).max(reach_of(&circle));
        }
        let count = circles.len() / 4;
        if count == 0 {
            return Err(TextErrorKind::Circles);
        }
        let add = |bytes: &[u8], to: &mut Vec<u8, MOST_BYTES>| to.extend_from_slice(bytes).map_err(|_| TextErrorKind::Full);
        add(&[(anchor << 4 | (count - 1)) as u8], &mut self.attachments)?;
        add(&packed(&tint), &mut self.attachments)?;
        add(&circles, &mut self.attachments)?;
        self.count += 1;
        if usize::from(self.count) > MOST_ATTACHMENTS {
            Err(TextErrorKind::Full)
        } else {
            self.bytes().map(|_| ()).ok_or(TextErrorKind::Full)
        }
    }

    /// The compiled character; none if there are too many bytes.
    fn bytes(&self) -> Option<Vec<u8, MOST_BYTES>> {
        let mut bytes = Vec::new();
        let mut add = |part: &[u8]| bytes.extend_from_slice(part).ok();
        add(&[VERSION, self.outline])?;
        self.radii.iter().try_for_each(|radii| add(radii))?;
        self.tints.iter().try_for_each(|tint| add(&packed(tint)))?;
        add(&self.reaches)?;
        add(&[self.count])?;
        add(&self.attachments)?;
        Some(bytes)
    }
}

/// How far a circle reaches from its anchor, rounded up.
fn reach_of(&[left, up, ahead, radius]: &[u8; 4]) -> u8 {
    let square: i32 = [left, up, ahead].map(|place| (i32::from(place as i8) * STEP).pow(2)).iter().sum();
    let reach = root(square as u32) as i32 + 1 + i32::from(radius) * STEP;
    // At most 691.
    ((reach + REACH_STEP - 1) / REACH_STEP) as u8
}

fn packed(Tint { rgb: [red, green, blue], grey, pattern }: &Tint) -> [u8; 4] {
    [*red, *green, *blue, grey << 4 | *pattern as u8]
}

fn index(names: &[&str], word: Option<&str>) -> Option<usize> {
    names.iter().position(|name| Some(*name) == word)
}

fn number(word: Option<&str>, from: i32, to: i32) -> Result<i32, TextErrorKind> {
    let number = word.and_then(|word| word.parse().ok()).filter(|number| (from..=to).contains(number));
    number.ok_or(TextErrorKind::Number(from, to))
}

fn grey(word: Option<&str>) -> Result<u8, TextErrorKind> {
    number(word, 0, 15).map(|grey| grey as u8).map_err(|_| TextErrorKind::Grey)
}

fn pattern(word: Option<&str>) -> Result<Pattern, TextErrorKind> {
    index(&PATTERN_NAMES, word).map(|index| Pattern::of(index as u8)).ok_or(TextErrorKind::Pattern)
}

fn colour(word: Option<&str>) -> Option<[u8; 3]> {
    let word = word.filter(|word| word.len() == 6 && word.bytes().all(|byte| byte.is_ascii_hexdigit()))?;
    let number = u32::from_str_radix(word, 16).ok()?;
    Some([(number >> 16) as u8, (number >> 8) as u8, number as u8])
}

#[cfg(test)]
mod tests {
    use super::super::look::{Material, Radius};
    use super::*;

    fn look(text: &str) -> Look {
        Look::new(compile(text).unwrap().to_vec().leak()).unwrap()
    }

    #[test]
    fn a_text_without_statements_is_the_default_character() {
        assert_eq!(look("# nothing\n\n   \n").bytes(), Look::DEFAULT.bytes());
    }

    #[test]
    fn every_statement_changes_what_it_names_alone() {
        for (part, name) in RADIUS_NAMES.iter().enumerate() {
            let text = std::format!("radius {name} 99 101 # thick");
            let radii = [false, true].map(|small| look(&text).radii(small).to_vec());
            let mut expected = Look::DEFAULT_RADII;
            (expected[0][part], expected[1][part]) = (99, 101);
            assert_eq!(radii, expected.map(|radii| radii.to_vec()));
        }
        for (material, name) in MATERIAL_NAMES.iter().enumerate() {
            let mut expected = Look::DEFAULT_TINTS;
            expected[material].rgb = [0x12, 0xab, 0xff];
            assert!(look(&std::format!("colour {name} 12abFF")).tints().eq(expected));
            (expected[material].grey, expected[material].pattern) = (3, Pattern::Checkered);
            assert!(look(&std::format!("colour {name} 12abFF 3 checkered")).tints().eq(expected));
        }
        assert_eq!(look("outline 77").outline(), 77);
        let slim = look("radius skull 60");
        assert_eq!([false, true].map(|small| slim.radius(Radius::Skull, small)), [60, 70]);
    }

    #[test]
    fn attachments_come_in_their_order_with_all_their_circles() {
        let look = look(
            "colour hair 010203 4 dark\nattach head hair 1 -254 254 250\nattach thighs 998877 12 bright 10 0 0 20 -10 0 0 20 3 4 5 6 2 2 2 2",
        );
        let found: std::vec::Vec<_> =
            look.attachments().map(|own| (own.anchor, own.tint.rgb, own.circles().collect::<std::vec::Vec<_>>())).collect();
        assert_eq!(found[0], (Anchor::Head, [1, 2, 3], std::vec![[0, -254, 254, 250]]));
        assert_eq!(found[1].0, Anchor::Thighs);
        assert_eq!(found[1].2, [[10, 0, 0, 20], [-10, 0, 0, 20], [2, 4, 4, 6], [2, 2, 2, 2]]);
        assert_eq!(look.tint(Material::Hair).grey, 4);
        // sqrt(2 * 254^2) + 250; 10 + 20.
        assert_eq!(look.reaches(), [612, 0, 32]);
    }

    #[test]
    fn what_is_wrong_is_reported_with_its_line() {
        use TextErrorKind::*;
        for (line, kind) in [
            ("radios hip 3", Statement),
            ("radius", Radius),
            ("radius nose 3", Radius),
            ("radius hip", Number(1, 200)),
            ("radius hip 0", Number(1, 200)),
            ("radius hip 5 201", Number(1, 200)),
            ("radius hip 5 6 7", Rest),
            ("outline 19", Number(20, 255)),
            ("outline 256", Number(20, 255)),
            ("colour", Material),
            ("colour shoes 000000", Material),
            ("colour shirt", Colour),
            ("colour shirt 00000", Colour),
            ("colour shirt +00000", Colour),
            ("colour shirt 000000 16", Grey),
            ("colour shirt 000000 1 striped", Pattern),
            ("colour shirt 000000 1 dark 1", Rest),
            ("attach", Anchor),
            ("attach foot hair 0 0 0 9", Anchor),
            ("attach head", Material),
            ("attach head wool 0 0 0 9", Material),
            ("attach head 112233 0 0 0 9", Pattern),
            ("attach head hair", Circles),
            ("attach head hair 0 0 0", Circles),
            ("attach head hair 0 0 0 0", Number(2, 250)),
            ("attach head hair 0 255 0 9", Number(-254, 254)),
            ("attach head hair 1 1 1 2 1 1 1 2 1 1 1 2 1 1 1 2 1 1 1 2", Circles),
        ] {
            let text = std::format!("# a comment\n\nradius hip 50\n{line}\nradius hip bad");
            assert_eq!(compile(&text), Err(TextError { line: 4, kind }), "{line}");
            assert!(std::format!("{}", TextError { line: 4, kind }).starts_with("line 4: "));
        }
        let many = "attach head hair 0 0 0 9\n".repeat(13);
        assert_eq!(compile(&many), Err(TextError { line: 13, kind: Full }));
        let large = "attach head hair 0 0 0 9 0 0 0 9 0 0 0 9 0 0 0 9\n".repeat(6);
        assert_eq!(compile(&large), Err(TextError { line: 6, kind: Full }));
    }

    #[test]
    fn random_texts_compile_to_characters_or_are_refused() {
        let mut random = fastrand::Rng::with_seed(3);
        let words = [
            "radius",
            "outline",
            "colour",
            "attach",
            "head",
            "hips",
            "hair",
            "hip",
            "9",
            "-4",
            "250",
            "ffee11",
            "dark",
            "\n",
            "#",
            "é",
            "99999999999",
        ];
        let mut compiled = 0;
        for _ in 0..20_000 {
            let text: std::vec::Vec<&str> = (0..random.usize(..12)).map(|_| words[random.usize(..words.len())]).collect();
            if let Ok(bytes) = compile(&text.join(" ")) {
                compiled += 1;
                assert!(Look::new(bytes.to_vec().leak()).is_ok());
            }
        }
        assert!(compiled > 1000, "{compiled}");
    }
}
