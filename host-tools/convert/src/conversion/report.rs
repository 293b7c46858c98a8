//! How far a clip is from its source: numbers for programs, and the same in words and as JSON.

use crate::error_text;
use crate::fit::chain::Constraint;
use crate::motion::Motion;
use crate::{channel_error, verify};
use serde_json::{Map, Value, json};

/// The errors of a clip, against what bounds them.
#[derive(Clone, Debug)]
pub enum Errors {
    /// Distances of joints and errors of scalars.
    Joints(verify::Report),
    /// Errors of channels.
    Channels(channel_error::Report, Constraint),
}

/// What a conversion gave.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Report {
    /// The errors.
    pub errors: Errors,
    /// Number of frames.
    pub frames: usize,
    /// Number of channels.
    pub channels: usize,
    /// Nanoseconds a frame.
    pub frame_time_ns: u32,
    /// Positions of the clip are multiples of 2^length_exponent units.
    pub length_exponent: i8,
    /// What closing the seam of a loop moved: part of the errors, which are those against the source.
    pub seam: Option<SeamReport>,
}

/// What closing the seam of a loop moved.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SeamReport {
    /// The greatest distance in cm of a joint in the last frame from where it is in the first, before the seam was closed.
    pub seam_cm: f64,
    /// The joint that has it.
    pub seam_joint: String,
    /// The greatest distance in cm by which a joint was moved.
    pub moved_cm: f64,
    /// The joint that was moved so far.
    pub moved_joint: String,
    /// The greatest angle in degrees by which a joint was turned in the world.
    pub turned_deg: f64,
}

impl Report {
    /// The fields of a report, for a clip of `motion`.
    pub fn to_json(&self, motion: &Motion) -> Map<String, Value> {
        let mut fields = match &self.errors {
            Errors::Joints(report) => error_text::to_json(report, motion),
            Errors::Channels(report, _) => channels_to_json(report, motion),
        };
        if let Some(cm) = motion.origin.retarget_max_cm {
            fields.insert("retarget_max_cm".into(), json!(cm));
        }
        if let Some(seam) = &self.seam {
            fields.insert("seam_cm".into(), json!(seam.seam_cm));
            fields.insert("seam_joint".into(), json!(seam.seam_joint));
            fields.insert("seam_moved_cm".into(), json!(seam.moved_cm));
            fields.insert("seam_moved_joint".into(), json!(seam.moved_joint));
            fields.insert("seam_turned_deg".into(), json!(seam.turned_deg));
        }
        fields.insert("frames".into(), json!(self.frames));
        fields
    }

    /// The errors for a person, a line for each kind.
    pub fn to_text(&self, motion: &Motion) -> String {
        match &self.errors {
            Errors::Joints(report) => error_text::to_text(report, motion),
            Errors::Channels(report, Constraint::Positions) => format!("error max {}", report.by_unit(motion)),
            Errors::Channels(report, Constraint::Accelerations) => {
                let (worst, drift) = (report.worst.sentence(motion), report.drift_sentence(motion));
                format!("error max {worst}, a frame^2\ndrift, worst first: {drift}")
            }
        }
    }

    /// The errors in short, for a table's column.
    pub fn to_cell(&self, motion: &Motion) -> String {
        match &self.errors {
            Errors::Joints(report) => error_text::to_cell(report, motion),
            Errors::Channels(report, _) => report.worst.sentence(motion),
        }
    }
}

fn channels_to_json(report: &channel_error::Report, motion: &Motion) -> Map<String, Value> {
    let worst = &report.worst;
    let drift = |worst: &channel_error::Worst| {
        let (error, unit) = worst.in_unit(motion);
        json!({"channel": motion.rig.channel_name(worst.channel), "frame": worst.frame, "error": error, "unit": unit})
    };
    let fields = json!({
        "max_error": worst.error,
        "part_of_bound": worst.part,
        "worst_channel": motion.rig.channel_name(worst.channel),
        "worst_frame": worst.frame,
        "drift": report.drift.iter().map(drift).collect::<Vec<_>>(),
    });
    fields.as_object().cloned().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::fit::rotation_coding::Rotations;
    use crate::import::units::figure_height_cm;
    use crate::import::{ImportOptions, InMemory, import};
    use crate::options::ChannelBound;
    use crate::pose_bound::default_shell_cm;
    use crate::{Length, Options, convert};

    /// A leg of 30 cm whose last frame is turned by 4 degrees against its first one: closing the seam turns frame 0 by half of that.
    const LEG: &str = "HIERARCHY ROOT hips { OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation End Site { OFFSET 0 30 0 } } \
        MOTION Frames: 4 Frame Time: 0.04  20 0 0  22 0 0  23 0 0  24 0 0";

    #[test]
    fn the_height_of_a_loop_is_that_of_its_source() {
        let files = InMemory::new().with("leg.bvh", LEG.as_bytes());
        let leg = import(&files, "leg.bvh".as_ref(), &ImportOptions::new().cm_per_unit(1.0)).unwrap().motion;
        let height = figure_height_cm(&leg).unwrap();
        let looped = convert(&leg, &Options::new().max_error(Length::cm(3.0)).looped(true), &mut |_| ()).unwrap();
        let told = looped.report.to_json(&looped.motion);
        assert_eq!(told["figure_height_cm"], height, "{told:?}");
        assert_eq!(told["shell_radius_cm"], default_shell_cm(Some(height)), "{told:?}");
        assert_ne!(figure_height_cm(&looped.motion), Some(height), "closing the seam changes nothing");
    }

    /// A root that moves along and turns about all three axes.
    fn figure() -> crate::motion::Motion {
        let row = |frame: usize| -> String {
            let wave = |channel: usize| 40.0 * (frame as f64 * (0.1 + 0.07 * channel as f64)).sin();
            (0..6).map(|channel| format!("{:.4} ", wave(channel))).collect()
        };
        let text = "HIERARCHY ROOT hips { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation End Site { OFFSET 0 30 0 } } \
            MOTION Frames: 60 Frame Time: 0.04 "
            .to_owned();
        let text = text + &(0..60).map(row).collect::<String>();
        let files = InMemory::new().with("figure.bvh", text.as_bytes());
        import(&files, "figure.bvh".as_ref(), &ImportOptions::new().cm_per_unit(1.0)).unwrap().motion
    }

    #[test]
    fn the_worst_channel_of_each_unit_is_named() {
        let figure = figure();
        let made = convert(&figure, &Options::new().channels(ChannelBound::Error(1.0)), &mut |_| ()).unwrap();
        let text = made.report.to_text(&made.motion);
        assert!(
            text.starts_with("error max ") && text.matches(" cm (").count() == 1 && text.matches(" degrees (").count() == 1,
            "{text}"
        );
        assert!(text.contains("position at frame") && text.contains("rotation at frame"), "{text}");
        // The worst of all comes first, as in the JSON.
        let json = made.report.to_json(&made.motion);
        let first = json["worst_channel"].as_str().unwrap();
        assert!(text.split(" at frame").next().unwrap().ends_with(first), "{text}: {first}");
    }

    #[test]
    fn angles_with_bounds_of_their_own_stay_angles_whatever_coding_is_asked_for() {
        let figure = figure();
        for bound in [ChannelBound::Error(1.0), ChannelBound::Acceleration(0.02)] {
            let options = Options::new().channels(bound);
            let plain = convert(&figure, &options, &mut |_| ()).unwrap();
            for rotations in [Rotations::Exponential, Rotations::Quaternion] {
                let made = convert(&figure, &options.clone().rotations(rotations), &mut |_| ()).unwrap();
                assert!(made.clip == plain.clip, "{bound:?}, {rotations:?}");
                let said = made.notes.iter().any(|note| note.to_string().contains("no effect"));
                assert!(said, "{bound:?}, {rotations:?}: {:?}", made.notes);
            }
        }
        // Without bounds of channels, and for exact clips, quaternions are made where they are asked for.
        let asked = Options::new().rotations(Rotations::Quaternion);
        assert_eq!(convert(&figure, &asked, &mut |_| ()).unwrap().motion.rig.channels(), 7);
        assert!(asked.channels(ChannelBound::Exact).makes_quaternions());
    }
}
