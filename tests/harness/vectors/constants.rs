//! `tables.json`: the format's numbers and tables for decoders in other languages, from the Rust constants.
//!
//! A table lists the probabilities of its symbols in 1/4096. Contexts that share a table share its index.

use pantin::Kind;
use pantin::codec::segment::{CONTEXTS, DIRECT_MODES, MODE_CONTEXTS};
use pantin::codec::{entropy, layout};
use pantin_convert::encode::entropy::{Alphabet, sizes};
use serde_json::json;

use super::json;

fn list(alphabet: Alphabet) -> Vec<u32> {
    sizes(alphabet.table()).collect()
}

/// The tables of some contexts without repetition, and the index that each context has.
fn shared(contexts: impl Iterator<Item = Alphabet>) -> (Vec<Vec<u32>>, Vec<usize>) {
    let mut rows: Vec<Vec<u32>> = vec![];
    let index = |alphabet: Alphabet| {
        let row = list(alphabet);
        rows.iter().position(|other| *other == row).unwrap_or_else(|| {
            rows.push(row);
            rows.len() - 1
        })
    };
    let indices = contexts.map(index).collect();
    (rows, indices)
}

/// The file's name.
pub const NAME: &str = "tables.json";

/// The file's text.
pub fn text() -> String {
    let (mode, mode_after) = shared((0..MODE_CONTEXTS as u8).map(Alphabet::Mode));
    let (number, number_in) = shared((0..CONTEXTS as u8).map(Alphabet::Number));
    let (status, status_in) = shared((0..layout::STATUS_CONTEXTS as u8).map(Alphabet::Status));
    let kinds: Vec<String> = Kind::ALL.iter().map(|kind| format!("{kind:?}")).collect();
    json::text(&[
        ("magic", json!(layout::MAGIC)),
        ("version", json!(layout::VERSION)),
        ("has_rig", json!(layout::HAS_RIG)),
        ("looped", json!(layout::LOOPED)),
        ("has_exponentials", json!(layout::HAS_EXPONENTIALS)),
        ("has_events", json!(layout::HAS_EVENTS)),
        ("has_index", json!(layout::HAS_INDEX)),
        ("has_event_names", json!(layout::HAS_EVENT_NAMES)),
        ("has_sections", json!(layout::HAS_SECTIONS)),
        ("known_flags", json!(layout::KNOWN_FLAGS)),
        ("max_joints", json!(layout::MAX_JOINTS)),
        ("max_channels", json!(layout::MAX_CHANNELS)),
        ("max_frames", json!(layout::MAX_FRAMES)),
        ("block_bytes", json!(layout::BLOCK_BYTES)),
        ("crc_bytes", json!(layout::CRC_BYTES)),
        ("frame_rates", json!(layout::FRAME_RATES)),
        ("kinds", json!(kinds)),
        ("scale_bits", json!(entropy::SCALE_BITS)),
        ("low", json!(entropy::LOW)),
        ("state_bytes", json!(entropy::STATE_BYTES)),
        ("lengths", json!(layout::LENGTHS)),
        ("length_classes", json!(layout::LENGTH_CLASSES)),
        ("steps", json!(layout::STEPS)),
        ("steps_shift", json!(layout::STEPS_SHIFT)),
        ("type_w", json!(layout::segment_type::W)),
        ("type_k", json!(layout::segment_type::K)),
        ("type_wk", json!(layout::segment_type::WK)),
        ("type_carry", json!(layout::segment_type::CARRY)),
        ("start_mode", json!(layout::START_MODE)),
        ("direct_modes", json!(DIRECT_MODES)),
        ("direct", json!(layout::DIRECT)),
        ("groups", json!(layout::GROUPS)),
        ("far_number", json!(layout::FAR_NUMBER)),
        ("max_step", json!(layout::MAX_STEP)),
        ("first_step", json!(layout::FIRST_STEP)),
        ("step_changes", json!(layout::STEP_CHANGES)),
        ("step_bits", json!(layout::STEP_BITS)),
        ("statuses", json!(layout::STATUSES)),
        ("follow_bits", json!(layout::FOLLOW_BITS)),
        ("listed", json!(layout::LISTED)),
        ("live_link", json!(pantin::names::LIVE_LINK.split(' ').collect::<Vec<_>>())),
        ("mode_after", json!(mode_after)),
        ("mode", json!(mode)),
        ("number_in", json!(number_in)),
        ("number", json!(number)),
        ("status_in", json!(status_in)),
        ("status", json!(status)),
        ("step_change", json!(list(Alphabet::StepChange))),
        ("position", json!(list(Alphabet::Position))),
        ("velocity", json!(list(Alphabet::Velocity))),
        ("far", json!(list(Alphabet::Far))),
    ])
}
