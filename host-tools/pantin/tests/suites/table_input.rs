//! Tables: columns of any name are read, and mistakes are named with their place.

use crate::told::load;
use anyhow::Result;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;

fn read_with(name: &str, text: impl AsRef<[u8]>, fps: Option<f64>) -> Result<(Motion, Vec<String>)> {
    let path = std::env::temp_dir().join(format!("pantin-table-{name}-{}.csv", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let read = load(&path, &ImportOptions::new().fps(fps));
    std::fs::remove_file(&path).unwrap();
    read.map(|imported| (imported.motion, imported.warnings))
}

fn error(name: &str, text: &str, fps: Option<f64>) -> String {
    format!("{:#}", read_with(name, text, fps).unwrap_err())
}

#[test]
fn columns_of_any_name_are_channels() {
    let (motion, _) = read_with("servos", "\"pan, left\";tilt\n-90;0\n45.5;1\n", Some(50.0)).unwrap();
    assert_eq!([motion.rig.channel_name(0), motion.rig.channel_name(1)], ["pan, left", "tilt"]);
    assert_eq!(motion.values, [[-90.0, 45.5], [0.0, 1.0]]);
    assert_eq!((motion.rig.scalars[0].full_scale, motion.frame_time), (90.0, 0.02));
}

#[test]
fn times_of_few_digits_give_the_rate_and_missing_rows_are_filled() {
    let (motion, warnings) =
        read_with("times", "time\tlamp\n0.00\t0\n0.03\t1\n0.07\t2\n0.10\t3\n0.20\t6\n0.23\t7\n\n", None).unwrap();
    assert_eq!((motion.frames, motion.frame_time), (8, 1.0 / 30.0));
    assert_eq!(motion.values[0], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    assert!(warnings[0].starts_with("2 of 8 frames have no row (first before line 6)"), "{warnings:?}");
    let (motion, _) = read_with("ms", "frame,time_ms,lamp\n1,0,0\n2,8.333,1\n3,16.667,2\n", None).unwrap();
    assert_eq!((motion.rig.scalars.len(), motion.frame_time), (1, 1.0 / 120.0));
}

/// Times with three digits are rounded: the rows stand where they were before that.
#[test]
fn a_given_rate_takes_rounded_times_for_even_ones() {
    let table = |count: usize, rate: f64, digits: usize| -> String {
        let row = |index: usize| format!("{:.digits$},{}\n", index as f64 / rate, (index as f64 * 2.0).sin());
        std::iter::once("time,a\n".to_string()).chain((0..count).map(row)).collect()
    };
    for (count, rate, digits) in [(60, 60.0, 3), (90, 30.0, 2), (60, 29.97, 3), (50, 50.0, 2)] {
        let text = table(count, rate, digits);
        let (given, _) = read_with("same", &text, Some(rate)).unwrap();
        let (own, _) = read_with("own", &text, None).unwrap();
        assert_eq!(given.frames, count, "{rate}");
        let far = given.values[0].iter().zip(&own.values[0]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far < 1e-4, "{rate}: {far}");
        let (twice, _) = read_with("twice", &text, Some(2.0 * rate)).unwrap();
        assert_eq!(twice.frames, 2 * count - 1, "{rate}");
        assert!(twice.values[0].iter().step_by(2).zip(&own.values[0]).all(|(a, b)| (a - b).abs() < 1e-4));
    }
}

#[test]
fn even_times_are_what_they_say_whatever_rate_is_asked_for() {
    for (step, rows, fps) in [
        (1.0, 6, 10.0),
        (1.0, 4, 8.0),
        (1.0, 4, 5.0),
        (0.1, 6, 24.0),
        (0.1, 6, 25.0),
        (0.1, 6, 50.0),
        (0.1, 4, 30.0),
        (0.2, 5, 60.0),
    ] {
        let text: String = (0..rows).map(|row| format!("{:.1},{row}\n", f64::from(row) * step)).collect();
        let (motion, _) = read_with("even", format!("time,a\n{text}"), Some(fps)).unwrap();
        assert_eq!(motion.frames, (f64::from(rows - 1) * step * fps + 1e-6) as usize + 1, "{step} {fps}");
        for (frame, value) in motion.values[0].iter().enumerate() {
            assert!((value - frame as f64 / fps / step).abs() < 1e-9, "{step} {fps} {frame}: {value}");
        }
    }
}

/// A few rows with few digits may be even times that were rounded, at any of several rates: they stand where they say.
#[test]
fn a_few_uneven_rows_stand_where_they_say() {
    let (motion, _) = read_with("few", "time,a\n0,0\n0.02,2\n0.04,4\n0.07,7\n", Some(100.0)).unwrap();
    assert_eq!(motion.frames, 8);
    assert!(motion.values[0].iter().enumerate().all(|(frame, value)| (value - frame as f64).abs() < 1e-9), "{:?}", motion.values);
}

#[test]
fn times_are_known_by_their_names_and_one_in_a_later_column_is_said() {
    for name in [
        "Time(s)",
        "time [sec]",
        "TIME",
        "Seconds",
        "Time (s)",
        "Timestamp (s)",
        "t(s)",
        "Time (sec.)",
        "time in seconds",
        "t",
        "timestamp",
    ] {
        let (motion, warnings) = read_with("names", format!("{name},a\n0,1\n0.1,2\n0.2,3\n"), None).unwrap();
        assert_eq!((motion.frames, motion.rig.scalars.len(), warnings.len()), (3, 1, 0), "{name}");
    }
    for (name, unit) in [("t_ms", 1e-3), ("Timestamp [ms]", 1e-3), ("time_us", 1e-6), ("timestamp_ns", 1e-9)] {
        let rows: String = (0..3).map(|row| format!("{},{row}\n", (f64::from(row) * 0.1 / unit).round())).collect();
        let (motion, warnings) = read_with("units", format!("{name},a\n{rows}"), None).unwrap();
        assert_eq!((motion.frames, motion.rig.scalars.len(), warnings.len()), (3, 1, 0), "{name}");
        assert!((motion.frame_time - 0.1).abs() < 1e-9, "{name}: {}", motion.frame_time);
    }
    for name in ["time of day", "Time (fortnights)"] {
        let (_, warnings) = read_with("other", format!("{name},a\n0,1\n1,2\n"), Some(30.0)).unwrap();
        assert!(warnings.iter().any(|warning| warning.contains("becomes a channel")), "{name}: {warnings:?}");
    }
    let (_, warnings) = read_with("later", "a,b,time\n0,1,0\n0.1,2,.1\n0.2,3,.2\n", Some(30.0)).unwrap();
    assert!(warnings.iter().any(|warning| warning.starts_with("column `time` becomes a channel")), "{warnings:?}");
}

#[test]
fn two_whole_seconds_are_one_frame_a_second() {
    for times in ["0,0\n1,1\n", "5.000,0\n6.000,1\n"] {
        let (motion, warnings) = read_with("second", format!("time,lamp\n{times}"), None).unwrap();
        assert_eq!((motion.frames, motion.frame_time, warnings.len()), (2, 1.0, 0));
    }
}

#[test]
fn a_channel_below_the_least_full_scale_is_named() {
    let table = |value: &str| format!("time,tiny,lamp\n0,0,1\n0.1,{value},0\n");
    let (motion, warnings) = read_with("tiny", table("-2e-9"), None).unwrap();
    assert!(warnings.len() == 1 && warnings[0].contains("tiny") && warnings[0].contains("2e-9"), "{warnings:?}");
    assert_eq!(motion.rig.scalars[0].full_scale, 1e-6);
    let (motion, warnings) = read_with("small", table("2e-6"), None).unwrap();
    assert_eq!((motion.rig.scalars[0].full_scale, warnings.len()), (2e-6, 0));
}

#[test]
fn a_given_rate_resamples_times_and_counts_frames() {
    let (motion, _) = read_with("rate", "t,lamp\n0,0\n0.5,5\n0.6,5\n1,9\n", Some(10.0)).unwrap();
    let expected = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 5.0, 6.0, 7.0, 8.0, 9.0];
    assert!(
        motion.values[0].iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-9),
        "{:?}",
        motion.values
    );
    let (motion, _) = read_with("frames", "frame,lamp\n5,0\n6,1\n9,4\n", Some(30.0)).unwrap();
    assert_eq!(motion.values[0], [0.0, 1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let fps = Some(30.0);
    assert!(error("rateless", "a,b\n1,2\n", None).contains("--fps gives"));
    assert!(error("header", "a,b\n", fps).contains(".csv:1: no row of values"));
    assert!(error("blank", "\n\n", fps).contains(".csv:1: expected a row of column names"));
    assert!(error("empty", "", fps).contains("the file is empty"));
    assert!(error("clock", "time,frame\n0,0\n", fps).contains(".csv:1: no channels"));
    assert!(error("columns", "a,b\n1,2\n1,2,3\n", fps).contains(".csv:3: 3 cells; expected 2"));
    assert!(error("missing", "a,b\n1,\n", fps).contains(".csv:2: column 2 (b): expected a number, found nothing"));
    assert!(error("nan", "a,b\n1,2\nNaN,3\n", fps).contains(".csv:3: column 1 (a): expected a finite number"));
    assert!(error("huge", "a,b\n1,-1e10\n", fps).contains(".csv:2: column 2 (b): expected a finite number"));
    assert!(error("twice", "a,b,a\n1,2,3\n", fps).contains(".csv:1: column 3: the name `a` stands in column 1 already"));
    assert!(error("unnamed", "a,,b\n1,2,3\n", fps).contains(".csv:1: column 2 (): expected a name"));
    assert!(error("back", "time,a\n1,0\n0.5,0\n", None).contains(".csv:3: column 1 (time): expected more"));
    assert!(
        error("uneven", "time,a\n0,0\n1,0\n2,0\n2.5,0\n3,0\n4,0\n", None)
            .contains(".csv:4: column 1 (time): this time is between")
    );
    assert!(error("part", "frame,a\n0.5,0\n", fps).contains(".csv:2: column 1 (frame): expected a whole frame's number"));
    assert!(error("far", "time,a\n0,0\n0.01,0\n1e9,0\n", None).contains("--max-memory"));
    let strange = format!("{:#}", read_with("strange", b"a,\xff\xfe\n1,2\n", fps).unwrap_err());
    assert!(strange.contains(".csv:1: column 2: ") && strange.contains("is not UTF-8"), "{strange}");
    let strange = format!("{:#}", read_with("strange-value", b"a,b\n1,\xff\n", fps).unwrap_err());
    assert!(strange.contains(".csv:2: column 2 (b): expected a number"), "{strange}");
}

#[test]
fn a_rate_that_few_digits_do_not_tell_is_an_assumption_and_close_times_are_refused() {
    // Written with two digits, 30 frames a second.
    let (motion, warnings) = read_with("assumed", "time,a\n0,0\n0.03,1\n", None).unwrap();
    assert_eq!(motion.frame_time, 1.0 / 30.0);
    assert!(warnings.iter().any(|warning| warning.contains("30 frames a second are assumed")), "{warnings:?}");
    let (_, warnings) = read_with("told", "time,a\n0,0\n0.033,1\n0.067,2\n0.1,3\n", None).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    for times in ["0,0\n0.00001,1\n0.00002,2\n", "0,0\n1e-7,1\n", "5,0\n5.0004,1\n5.0008,2\n"] {
        let error = error("close", &format!("time,a\n{times}"), None);
        assert!(error.contains("frames a second; --fps"), "{error}");
    }
}
