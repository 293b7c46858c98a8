//! How a conversion's errors are printed: in cm and in percent of the figure's height, in words and as JSON.

use crate::import::units::figure_height_cm;
use crate::motion::Motion;
use crate::verify::Report;
use serde_json::{Map, Value, json};

/// The errors of what the motion has: joints, scalars or both.
pub fn to_json(report: &Report, motion: &Motion) -> Map<String, Value> {
    let mut fields = Map::new();
    if !motion.rig.joints.is_empty() {
        fields.insert("max_error_cm".into(), json!(report.max_cm));
        fields.insert("mean_error_cm".into(), json!(report.mean_cm));
        fields.insert("mean_joint_error_cm".into(), json!(report.mean_joint_cm));
        if let Some(height) = figure_height_cm(motion) {
            fields.insert("figure_height_cm".into(), json!(height));
            fields.insert("max_error_percent_of_height".into(), json!(100.0 * report.max_cm / height));
            fields.insert("mean_error_percent_of_height".into(), json!(100.0 * report.mean_cm / height));
        }
        fields.insert("worst_joint".into(), json!(report.worst_joint));
        fields.insert("worst_frame".into(), json!(report.worst_frame));
    }
    if report.max_unseen_degrees > 0.0 {
        fields.insert("max_rotation_error_degrees".into(), json!(report.max_unseen_degrees));
        fields.insert("worst_rotation_joint".into(), json!(report.unseen_joint));
        fields.insert("worst_rotation_frame".into(), json!(report.unseen_frame));
    }
    if !motion.rig.scalars.is_empty() {
        fields.insert("max_scalar_error_percent".into(), json!(100.0 * report.max_scalar));
        fields.insert("worst_scalar".into(), json!(report.worst_scalar));
        fields.insert("worst_scalar_frame".into(), json!(report.worst_scalar_frame));
    }
    fields
}

/// The same as a clause for a person.
pub fn to_text(report: &Report, motion: &Motion) -> String {
    let height = figure_height_cm(motion);
    let length = |cm: f64| match height {
        Some(height) => format!("{cm:.4} cm, {:.3} % of the figure's height", 100.0 * cm / height),
        None => format!("{cm:.4} cm"),
    };
    let (joint, frame) = (&report.worst_joint, report.worst_frame);
    let joints = format!(
        "error max {} ({joint} at frame {frame}), mean of the joints {}",
        length(report.max_cm),
        length(report.mean_joint_cm)
    );
    let (scalar, frame) = (&report.worst_scalar, report.worst_scalar_frame);
    let place = if scalar.is_empty() { String::new() } else { format!(" ({scalar} at frame {frame})") };
    let scalars = format!("scalars' error max {:.3} % of full scale{place}", 100.0 * report.max_scalar);
    match (motion.rig.joints.is_empty(), motion.rig.scalars.is_empty()) {
        (false, true) => joints,
        (true, _) => scalars,
        (false, false) => format!("{joints}; {scalars}"),
    }
}

/// The same in a table's column.
pub fn to_cell(report: &Report, motion: &Motion) -> String {
    let mut parts = Vec::new();
    if !motion.rig.joints.is_empty() {
        let percent = figure_height_cm(motion).map(|height| format!(" ({:.2} %)", 100.0 * report.max_cm / height));
        parts.push(format!("{:.3} cm{}", report.max_cm, percent.unwrap_or_default()));
    }
    if !motion.rig.scalars.is_empty() {
        parts.push(format!("{:.2} % of scale", 100.0 * report.max_scalar));
    }
    parts.join(", ")
}
