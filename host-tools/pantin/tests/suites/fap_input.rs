//! MPEG-4 FAP text: small faces are read as they say, and mistakes are named with their line.

use crate::told::load;
use anyhow::Result;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;

fn read_as(name: &str, text: impl AsRef<[u8]>) -> Result<(Motion, Vec<String>)> {
    let path = std::env::temp_dir().join(format!("pantin-fap-{name}-{}.fap", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let read = load(&path, &ImportOptions::new());
    std::fs::remove_file(&path).unwrap();
    read.map(|imported| (imported.motion, imported.warnings))
}

/// Facial animation parameters.
const PARAMETERS: usize = 68;

fn mask(set: &[usize]) -> String {
    (1..=PARAMETERS).map(|parameter| if set.contains(&parameter) { "1 " } else { "0 " }).collect()
}

fn error(name: &str, text: &str) -> String {
    format!("{:#}", read_as(name, text).unwrap_err())
}

fn column<'a>(motion: &'a Motion, name: &str) -> &'a [f64] {
    &motion.values[motion.rig.scalars.iter().position(|scalar| scalar.name == name).unwrap()]
}

#[test]
fn parameters_keep_their_values_until_they_get_others() {
    let text = format!(
        "2.1 C:\\my faces\\joy 25 6\n{}\n0 100 -3000\n{}\n1 200\n{}\n4 -400 50\n",
        mask(&[3, 48]),
        mask(&[3]),
        mask(&[3, 4])
    );
    let (motion, warnings) = read_as("keep", text).unwrap();
    assert_eq!((motion.frames, motion.frame_time), (6, 0.04));
    assert_eq!(column(&motion, "open_jaw"), [100.0, 200.0, 200.0, 200.0, -400.0, -400.0]);
    assert_eq!(column(&motion, "head_pitch"), [-3000.0; 6]);
    assert_eq!(column(&motion, "lower_t_midlip"), [0.0, 0.0, 0.0, 0.0, 50.0, 50.0]);
    // Full scale is of a unit, not of a channel.
    let scales: Vec<f64> = motion.rig.scalars.iter().map(|scalar| scalar.full_scale).collect();
    assert_eq!(scales, [400.0, 400.0, 3000.0]);
    assert_eq!(warnings.len(), 2, "{warnings:?}");
}

#[test]
fn visemes_and_expressions_have_several_values() {
    for (viseme, expression) in
        [("3 4 32", "1 63 2 10"), ("3 4 32 1", "1 63 2 10"), ("3 4 32", "1 63 2 10 0 1"), ("3 4 32 1", "1 63 2 10 0 1")]
    {
        let text = format!("2.1 x 30 1\n{}\n0 {viseme} {expression} 77\n", mask(&[1, 2, 68]));
        let (motion, _) = read_as("high", text).unwrap();
        assert_eq!(column(&motion, "viseme_blend"), [32.0]);
        assert_eq!(column(&motion, "expression_intensity1"), [63.0]);
        assert_eq!(column(&motion, "pull_r_ear"), [77.0]);
        assert_eq!(motion.rig.scalars.len(), 1 + viseme.split(' ').count() + expression.split(' ').count());
        assert_eq!(motion.rig.scalars[0].full_scale, 14.0);
    }
}

#[test]
fn frames_may_count_from_any_number() {
    let text = format!("2.1 x 25 2\r\n{0}\r\n7 1\r\n{0}\r\n8 2\r\n", mask(&[3]));
    assert_eq!(read_as("seven", text).unwrap().0.values, [[1.0, 2.0]]);
    let text = format!("2.1 x 25 1\n{0}\n0 1\n{0}\n1 2\n", mask(&[3]));
    let (motion, warnings) = read_as("more", text).unwrap();
    assert!(motion.frames == 1 && warnings[0].contains("from line 4"), "{warnings:?}");
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let jaw = mask(&[3]);
    assert!(error("header", "2.0 x 25 1\n").contains(".fap:1: expected `2.1 NAME"));
    for (name, header, wrong) in [
        ("version", "2.0 x 25 1", "word 1, the version, is `2.0`"),
        ("rate", "2.1 my face x 1", "word 4, the frames a second, is `x`"),
        ("still", "2.1 x 0 1", "word 3, the frames a second, is `0`"),
        ("fast", "2.1 x inf 1", "word 3, the frames a second, is `inf`"),
        ("many", "2.1 x 25 1.5", "word 4, the number of frames, is `1.5`"),
        ("none", "2.1 x 25 0", "word 4, the number of frames, is `0`"),
        ("few", "2.1 25", "the line has 2 of at least 3 words"),
    ] {
        // Lines without words count too.
        let said = error(name, &format!("\n\n{header}\n"));
        assert!(said.contains(".fap:3: expected `2.1 NAME FRAMES-A-SECOND FRAMES`; ") && said.contains(wrong), "{said}");
    }
    assert!(error("only", "2.1 x 25 1\n").contains(".fap:1: no mask sets a parameter"));
    assert!(error("short", "2.1 x 25 1\n0 1 1\n0 5 5\n").contains(".fap:2: a mask of 3; expected 68"));
    assert!(
        error("bit", &format!("2.1 x 25 1\n{}2\n0 5\n", &jaw[..134]))
            .contains(".fap:2: expected a mask of 68 times 0 or 1, found `2`")
    );
    assert!(error("cut", &format!("2.1 x 25 1\n{jaw}\n")).contains(".fap:2: expected values after this mask"));
    assert!(error("count", &format!("2.1 x 25 1\n{jaw}\n0 5 6\n")).contains(".fap:3: 2 values; the mask sets 1"));
    assert!(error("nan", &format!("2.1 x 25 1\n{jaw}\n0 nan\n")).contains(".fap:3: value 1: expected a finite number"));
    assert!(error("huge", &format!("2.1 x 25 1\n{jaw}\n0 1e99\n")).contains(".fap:3: value 1: expected a finite number"));
    assert!(error("back", &format!("2.1 x 25 9\n{jaw}\n5 1\n{jaw}\n3 1\n")).contains(".fap:5: frame 3 stands after"));
    assert!(error("far", &format!("2.1 x 25 2\n{jaw}\n0 1\n{jaw}\n9 1\n")).contains(".fap:5: frame 9, but the header says 2"));
    assert!(error("many", "2.1 x 25 99999999999\n").contains(".fap:1: 99999999999 frames"));
    let strange = format!("{:#}", read_as("strange", b"2.1 \xff 25 1\n\xff\n").unwrap_err());
    assert!(strange.contains(".fap:2: "), "{strange}");
}
