//! `pantin_figure_tables.h`: the tables of the crate pantin-figure for the figure in C, by the same series.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::PathBuf;

use serde_json::{Value, json};

use super::c_header::table;
use crate::paths;

const START: &str = "/* Tables of figures: sines, rotations, the camera. `cargo xtask vectors` writes this file. */
#ifndef PANTIN_FIGURE_TABLES_H
#define PANTIN_FIGURE_TABLES_H

#include \"pantin_flash.h\"
";

/// The committed file.
pub fn path() -> PathBuf {
    paths::root().join("bindings/c/src/pantin_figure_tables.h")
}

/// The file's text.
pub fn text() -> String {
    let mut text = START.to_owned();
    // Sine and cosine of the first quarter, in Q22.
    let circle = (0..32).flat_map(|index| {
        let angle = f64::from(index) * TAU / 128.0;
        [json!(q22(angle * series(angle * angle, 1.0))), json!(q22(series(angle * angle, 0.0)))]
    });
    table(&mut text, "int32_t", "circle", &circle.collect());
    // By distance: the camera's magnification in Q14, and the step to the next, modulo 2^16.
    let magnification = (64..192).flat_map(|distance: i32| {
        let from = ((1 << 21) + distance / 2) / distance;
        let to = ((1 << 21) + distance / 2) / (distance + 1);
        [json!(from), json!((to - from) as u16)]
    });
    table(&mut text, "uint16_t", "magnification", &magnification.collect());
    text += "\n#ifndef PANTIN_EULER_ONLY";
    // By the square of an angle: cosine of its half, and pi/4 times the sine over it.
    let half_angle = (0..194).flat_map(|index| {
        let square = f64::from(index) / 64.0 * FRAC_PI_2 * FRAC_PI_2;
        [json!(q22(series(square, 0.0))), json!(q22(FRAC_PI_2 * series(square, 1.0) / 2.0))]
    });
    table(&mut text, "int32_t", "half_angle", &half_angle.collect());
    let inverse_root: Value = (0..386).map(|index| json!(q22(1.0 / (1.0 + f64::from(index) / 128.0).sqrt()))).collect();
    table(&mut text, "int32_t", "inverse_root", &inverse_root);
    // By the smaller component of a unit vector in 1/128: the nearest angle of the circle.
    let nearest: Value = (0..93)
        .map(|index| {
            let sine = f64::from(2 * index + 1) / 256.0;
            json!((0..16).take_while(|angle| ((f64::from(*angle) + 0.5) * TAU / 128.0).sin() <= sine).count())
        })
        .collect();
    table(&mut text, "uint8_t", "nearest", &nearest);
    text + "#endif\n\n#endif\n"
}

fn q22(x: f64) -> i32 {
    (x * f64::from(1 << 22)).round() as i32
}

/// The series of the cosine of the root of `u`, or with `first` 1 of its sine over the root.
fn series(u: f64, first: f64) -> f64 {
    let (mut sum, mut term, mut n) = (0.0, 1.0, first);
    while n < first + 50.0 {
        sum += term;
        term *= -u / ((n + 1.0) * (n + 2.0));
        n += 2.0;
    }
    sum
}
