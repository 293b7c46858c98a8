//! Event markers: names to the ids of a clip and back, and what edits do with them.

use crate::motion::{Event, Motion};
use anyhow::{Result, ensure};
use std::collections::{HashMap, HashSet};

/// Most bytes of an event's name.
pub const MOST_NAME_BYTES: usize = 255;

/// Checks a name that a user or a file gave.
pub fn check_name(name: &str) -> Result<()> {
    ensure!(!name.is_empty(), "an event without a name");
    ensure!(name.len() <= MOST_NAME_BYTES, "an event's name of {} bytes; at most {MOST_NAME_BYTES}", name.len());
    ensure!(!name.chars().any(char::is_control), "an event's name has a control character: {}", name.escape_debug());
    ensure!(!name.contains('|'), "an event's name has a `|`, which is between names in tables: {name}");
    Ok(())
}

/// The id that a name stands for which is a number as programs write it: `007` is a name.
fn number(name: &str) -> Option<u32> {
    name.parse().ok().filter(|id: &u32| id.to_string() == name)
}

/// The events as a clip holds them, in the order of frames, and the names of their ids. Names take the lowest ids that no event has as its number, in
/// the order in which they first occur.
pub fn to_clip(events: &[Event]) -> (Vec<pantin::Event>, Vec<String>) {
    let mut events: Vec<&Event> = events.iter().collect();
    events.sort_by_key(|event| event.frame);
    let numbers: HashSet<u32> = events.iter().filter_map(|event| number(&event.name)).collect();
    let mut names: Vec<String> = Vec::new();
    let mut ids: HashMap<String, u32> = HashMap::new();
    let mut id_of = |name: &str| {
        if let Some(id) = number(name) {
            return id;
        }
        *ids.entry(name.into()).or_insert_with(|| {
            while numbers.contains(&(names.len() as u32)) {
                names.push(String::new());
            }
            names.push(name.into());
            names.len() as u32 - 1
        })
    };
    let mut coded: Vec<pantin::Event> =
        events.iter().map(|event| pantin::Event { frame: event.frame as u32, id: id_of(&event.name) }).collect();
    coded.dedup();
    (coded, names)
}

/// The events of a clip.
pub fn of_clip(clip: &pantin::Clip) -> Vec<Event> {
    let names: Vec<&[u8]> = clip.event_names().collect();
    let named = |id: u32| names.get(id as usize).copied().filter(|name| !name.is_empty());
    let name = |id: u32| named(id).and_then(|name| std::str::from_utf8(name).ok()).map_or_else(|| id.to_string(), str::to_string);
    let inside = clip.events().filter(|event| event.frame < clip.frames());
    inside.map(|event| Event { frame: event.frame as usize, name: name(event.id) }).collect()
}

impl Motion {
    /// Adds events, and keeps the order of frames.
    pub fn add_events(&mut self, events: impl IntoIterator<Item = Event>) {
        self.events.extend(events);
        self.events.sort_by_key(|event| event.frame);
    }
}

/// The events of frames `from` to `to`, counted from `from`.
pub fn cut(events: &[Event], from: usize, to: usize) -> Vec<Event> {
    let inside = events.iter().filter(|event| (from..=to).contains(&event.frame));
    inside.map(|event| Event { frame: event.frame - from, name: event.name.clone() }).collect()
}

/// The events of a motion whose frames come `ratio` times as fast, and whose last frame is `last`.
pub fn resample(events: &[Event], ratio: f64, last: usize) -> Vec<Event> {
    let frame = |event: &Event| ((event.frame as f64 * ratio).round() as usize).min(last);
    events.iter().map(|event| Event { frame: frame(event), name: event.name.clone() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(frame: usize, name: &str) -> Event {
        Event { frame, name: name.into() }
    }

    #[test]
    fn names_take_the_ids_that_numbers_leave() {
        let (events, names) = to_clip(&[event(9, "clap"), event(3, "0"), event(4, "step"), event(5, "2"), event(9, "step")]);
        assert_eq!(
            events.iter().map(|event| (event.frame, event.id)).collect::<Vec<_>>(),
            [(3, 0), (4, 1), (5, 2), (9, 3), (9, 1)]
        );
        assert_eq!(names, ["", "step", "", "clap"]);
        assert_eq!(to_clip(&[event(1, "4294967295"), event(2, "7")]).1, Vec::<String>::new());
        assert_eq!(to_clip(&[event(1, "007"), event(2, "+7")]).1, ["007", "+7"]);
        // Too large for an id: a name.
        assert_eq!(to_clip(&[event(1, "4294967296")]).1, ["4294967296"]);
    }

    #[test]
    fn many_names_take_little_time() {
        let events: Vec<Event> = (0..200_000).map(|index| event(index, &format!("name {index}"))).collect();
        let begun = std::time::Instant::now();
        assert_eq!(to_clip(&events).1.len(), events.len());
        assert!(begun.elapsed().as_secs_f64() < 5.0);
    }

    #[test]
    fn cuts_and_rates_move_them() {
        let events = [event(2, "a"), event(5, "b"), event(9, "c")];
        assert_eq!(cut(&events, 2, 5), [event(0, "a"), event(3, "b")]);
        assert_eq!(resample(&events, 0.5, 4), [event(1, "a"), event(3, "b"), event(4, "c")]);
    }
}
