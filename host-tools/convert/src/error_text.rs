//! How a conversion's errors are printed: in cm, in percent of the figure's height and in degrees, in words and as JSON.

use crate::motion::Motion;
use crate::number::Number;
use crate::verify::{Report, Worst};
use serde_json::{Map, Value, json};

/// The errors of what the motion has: joints, scalars or both.
pub fn to_json(report: &Report, motion: &Motion) -> Map<String, Value> {
    let mut fields = Map::new();
    if !motion.rig.joints.is_empty() {
        put(&mut fields, &report.place_cm, ["max_error_cm", "worst_joint", "worst_frame"]);
        fields.insert("mean_error_cm".into(), json!(report.mean_cm));
        fields.insert("mean_joint_error_cm".into(), json!(report.mean_joint_cm));
        fields.insert("shell_radius_cm".into(), json!(report.shell_radius_cm));
        put(&mut fields, &report.shell_cm, ["max_shell_cm", "worst_shell_joint", "worst_shell_frame"]);
        fields.insert("mean_shell_cm".into(), json!(report.mean_shell_cm));
        if let Some(height) = report.figure_height_cm {
            fields.insert("figure_height_cm".into(), json!(height));
            fields.insert("max_error_percent_of_height".into(), json!(100.0 * report.place_cm.error / height));
            fields.insert("mean_error_percent_of_height".into(), json!(100.0 * report.mean_cm / height));
            fields.insert("max_shell_percent_of_height".into(), json!(100.0 * report.shell_cm.error / height));
        }
        put(&mut fields, &report.rotation_deg, ["max_rotation_deg", "worst_rotation_joint", "worst_rotation_frame"]);
        put(
            &mut fields,
            &report.joint_deg,
            ["max_joint_rotation_deg", "worst_joint_rotation_joint", "worst_joint_rotation_frame"],
        );
    }
    if !motion.rig.scalars.is_empty() {
        fields.insert("max_scalar_error_percent".into(), json!(100.0 * report.max_scalar));
        fields.insert("worst_scalar".into(), json!(report.worst_scalar));
        fields.insert("worst_scalar_frame".into(), json!(report.worst_scalar_frame));
    }
    fields
}

/// An error, its joint and its frame under these names.
fn put(fields: &mut Map<String, Value>, worst: &Worst, [error, joint, frame]: [&str; 3]) {
    fields.insert(error.into(), json!(worst.error));
    fields.insert(joint.into(), json!(worst.joint));
    fields.insert(frame.into(), json!(worst.frame));
}

/// The errors as text. Places, the shell and rotations have a line each; scalars have one more.
pub fn to_text(report: &Report, motion: &Motion) -> String {
    let mut lines = Vec::new();
    if !motion.rig.joints.is_empty() {
        lines.extend(joint_lines(report));
    }
    if !motion.rig.scalars.is_empty() || motion.rig.joints.is_empty() {
        let (scalar, frame) = (&report.worst_scalar, report.worst_scalar_frame);
        let place = if scalar.is_empty() { String::new() } else { format!(" ({scalar} at frame {frame})") };
        lines.push(format!("scalars' error max {:.3} % of full scale{place}", 100.0 * report.max_scalar));
    }
    lines.join("\n  ")
}

fn joint_lines(report: &Report) -> [String; 3] {
    let height = report.figure_height_cm;
    let length = |cm: f64| match height {
        Some(height) => format!("{cm:.4} cm, {:.3} % of the figure's height", 100.0 * cm / height),
        None => format!("{cm:.4} cm"),
    };
    let Report { place_cm, shell_cm, rotation_deg, joint_deg, .. } = report;
    let mean = |cm: f64| format!("mean of the joints {cm:.4} cm");
    let radius = Number((1e4 * report.shell_radius_cm).round() / 1e4);
    [
        format!("error max {}{}, {}", length(place_cm.error), at(place_cm), mean(report.mean_joint_cm)),
        format!(
            "shell error max (points {radius} cm from each joint) {}{}, {}",
            length(shell_cm.error),
            at(shell_cm),
            mean(report.mean_shell_cm)
        ),
        format!(
            "rotation error max {:.3} degrees{}, against the parent {:.3} degrees{}",
            rotation_deg.error,
            at(rotation_deg),
            joint_deg.error,
            at(joint_deg)
        ),
    ]
}

/// ` (head at frame 12)`, or nothing where nothing is off.
fn at(Worst { joint, frame, .. }: &Worst) -> String {
    if joint.is_empty() { String::new() } else { format!(" ({joint} at frame {frame})") }
}

/// The same in a table's column: the greatest errors of the shell and of rotations.
pub fn to_cell(report: &Report, motion: &Motion) -> String {
    let mut parts = Vec::new();
    if !motion.rig.joints.is_empty() {
        let cm = report.shell_cm.error;
        let percent = report.figure_height_cm.map(|height| format!(" ({:.2} %)", 100.0 * cm / height));
        parts.push(format!("{cm:.3} cm{}, {:.1} degrees", percent.unwrap_or_default(), report.rotation_deg.error));
    }
    if !motion.rig.scalars.is_empty() {
        parts.push(format!("{:.2} % of scale", 100.0 * report.max_scalar));
    }
    parts.join(", ")
}
