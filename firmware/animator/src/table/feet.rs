//! The table of a character's feet in a bank: when which point of a foot is on the ground. [`MACHINE.md`](https://docs.rs/pantin-animator) describes its bytes.

use super::TableError;
use pantin::Bank;

/// The type of a bank's section that holds the table of the feet.
pub const FEET_SECTION: u8 = 5;

/// The version of tables of feet that this library reads.
pub const FEET_VERSION: u8 = 1;

/// Most feet of a table.
pub const FEET: usize = 2;
/// Most points of a foot beside its ankle.
pub const POINTS: usize = 4;

const HEADER: usize = 8;
const FOOT: usize = 12;
const END: usize = 2;
const CONTACT: usize = 6;
const ENTRY: usize = 6;

/// A foot of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FootRow {
    /// The index of its ankle in the rig: the joint whose place inverse kinematics moves.
    pub ankle: u16,
    /// The joints that can be on the ground, End Sites included: each hangs on the ankle or on one that stands before it here.
    points: [u16; POINTS],
    count: u8,
}

impl FootRow {
    /// The joints that can be on the ground, beside the ankle.
    pub fn points(&self) -> &[u16] {
        self.points.get(..self.count.into()).unwrap_or_default()
    }
}

/// A stretch of a clip in which a point of a foot is on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// Which of the table's feet.
    pub foot: u8,
    /// 0 is the ankle, others are the row's points from 1.
    pub point: u8,
    /// Its first frame.
    pub from: u16,
    /// The first frame at which the point is no longer on the ground, or another one of the foot is.
    pub to: u16,
}

/// Where a transition that waits for a matching foot may begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The transition's index in the machine's table.
    pub transition: u8,
    /// The frame of the clip that it leaves.
    pub at: u16,
    /// The frame of the clip that it enters.
    pub start: u16,
}

/// A checked table of feet.
#[derive(Clone, Copy, Debug)]
pub struct FeetTable<'a> {
    /// Without the CRC.
    bytes: &'a [u8],
}

impl<'a> FeetTable<'a> {
    /// Finds and checks the table of a bank; `None` without one.
    pub fn of(bank: &Bank<'a>) -> Result<Option<FeetTable<'a>>, TableError> {
        let section = bank.section(FEET_SECTION).map_err(|_| TableError::Several)?;
        section.map(|bytes| FeetTable::new(bytes, bank.len())).transpose()
    }

    /// Checks a table for a bank with a number of clips.
    #[inline(never)]
    pub fn new(bytes: &'a [u8], clips: usize) -> Result<FeetTable<'a>, TableError> {
        let (body, stored) = bytes.split_last_chunk::<2>().ok_or(TableError::Truncated)?;
        if pantin::codec::crc::of(body) != u16::from_le_bytes(*stored) {
            return Err(TableError::BadCrc);
        }
        let table = FeetTable { bytes: body };
        let version = *body.first().ok_or(TableError::Truncated)?;
        if version != FEET_VERSION {
            return Err(TableError::UnsupportedVersion(version));
        }
        if !(1..=FEET).contains(&table.feet()) || table.clips() != clips {
            return Err(TableError::BadCount);
        }
        if body.len() != table.entries_at() + ENTRY * table.number(6) {
            return Err(TableError::Truncated);
        }
        if (0..table.feet()).any(|index| table.foot(index).is_none()) {
            return Err(TableError::BadValue);
        }
        let mut before = 0;
        for clip in 0..clips {
            let end = table.end(clip);
            if end < before {
                return Err(TableError::BadValue);
            }
            before = end;
        }
        let good = |index: usize| {
            let row = table.contact_row(index)?;
            let points = table.foot(row.foot.into())?.points().len();
            (row.from < row.to && usize::from(row.point) <= points).then_some(())
        };
        if before != table.number(4) || !(0..before).all(|index| good(index).is_some()) {
            return Err(TableError::BadValue);
        }
        Ok(table)
    }

    /// A number of two bytes.
    fn number(&self, at: usize) -> usize {
        match self.bytes.get(at..at + 2) {
            Some(&[low, high]) => usize::from(u16::from_le_bytes([low, high])),
            _ => 0,
        }
    }

    fn byte(&self, at: usize) -> u8 {
        self.bytes.get(at).copied().unwrap_or(0)
    }

    /// Number of feet: 1 or 2.
    pub fn feet(&self) -> usize {
        self.byte(1).into()
    }

    fn clips(&self) -> usize {
        self.byte(2).into()
    }

    /// A foot; `None` if there is none of this index.
    pub fn foot(&self, index: usize) -> Option<FootRow> {
        let at = HEADER + FOOT * index;
        let count = self.byte(at + 2);
        if index >= self.feet() || usize::from(count) > POINTS || self.byte(at + 3) != 0 {
            return None;
        }
        let mut points = [0; POINTS];
        points.iter_mut().zip(0..).for_each(|(point, number)| *point = self.number(at + 4 + 2 * number) as u16);
        Some(FootRow { ankle: self.number(at) as u16, points, count })
    }

    fn ends_at(&self) -> usize {
        HEADER + FOOT * self.feet()
    }

    /// The number of contacts of the clips up to and with one.
    fn end(&self, clip: usize) -> usize {
        self.number(self.ends_at() + END * clip)
    }

    fn contacts_at(&self) -> usize {
        self.ends_at() + END * self.clips()
    }

    fn entries_at(&self) -> usize {
        self.contacts_at() + CONTACT * self.number(4)
    }

    fn contact_row(&self, index: usize) -> Option<Contact> {
        let at = self.contacts_at() + CONTACT * index;
        let row = self.bytes.get(at..at + CONTACT)?;
        let &[foot, point, from_low, from_high, to_low, to_high] = row else { return None };
        let [from, to] = [[from_low, from_high], [to_low, to_high]].map(u16::from_le_bytes);
        Some(Contact { foot, point, from, to })
    }

    /// The contacts of a clip, by its index in the bank.
    pub fn contacts(&self, clip: u8) -> impl Iterator<Item = Contact> + use<'a> {
        let (table, clip) = (*self, usize::from(clip));
        let first = clip.checked_sub(1).map_or(0, |before| table.end(before));
        let last = if clip < table.clips() { table.end(clip) } else { first };
        (first..last).filter_map(move |index| table.contact_row(index))
    }

    /// The instants at which a transition may begin, in the order of their frames; a transition without any begins at once.
    pub fn entries(&self, transition: u8) -> impl Iterator<Item = Entry> + use<'a> {
        let table = *self;
        (0..table.number(6)).filter_map(move |index| table.entry(index)).filter(move |entry| entry.transition == transition)
    }

    fn entry(&self, index: usize) -> Option<Entry> {
        let at = self.entries_at() + ENTRY * index;
        let &[transition, _, at_low, at_high, low, high] = self.bytes.get(at..at + ENTRY)? else { return None };
        let [at, start] = [[at_low, at_high], [low, high]].map(u16::from_le_bytes);
        Some(Entry { transition, at, start })
    }

    /// The next instant at or after a frame of the clip at which a transition may begin, in the round of a loop, and how many frames it is away.
    pub(crate) fn next_entry(&self, transition: u8, frame: u32, frames: u32, looped: bool) -> Option<(Entry, u32)> {
        let away = |entry: Entry| {
            let at = u32::from(entry.at);
            let ahead = at.checked_sub(frame).or_else(|| looped.then(|| (at + frames).wrapping_sub(frame)));
            Some((entry, ahead?))
        };
        self.entries(transition).filter_map(away).min_by_key(|(_, ahead)| *ahead)
    }

    /// The point of a foot that is on the ground at a frame of a clip.
    pub fn contact(&self, clip: u8, foot: u8, frame: u32) -> Option<u8> {
        let within = |row: &Contact| row.foot == foot && (u32::from(row.from)..u32::from(row.to)).contains(&frame);
        self.contacts(clip).find(within).map(|row| row.point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of one foot with a point, for two clips, with two contacts and an entry.
    fn body() -> Vec<u8> {
        let mut body = vec![FEET_VERSION, 1, 2, 0, 2, 0, 1, 0];
        body.extend([5, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0, 0]);
        body.extend([1, 0, 2, 0]);
        body.extend([0, 1, 3, 0, 9, 0]);
        body.extend([0, 0, 0, 0, 4, 0]);
        body.extend([7, 0, 12, 0, 2, 0]);
        body
    }

    fn sealed(mut body: Vec<u8>) -> Vec<u8> {
        let crc = pantin::codec::crc::of(&body);
        body.extend(crc.to_le_bytes());
        body
    }

    #[test]
    fn it_says_which_point_is_on_the_ground() {
        let bytes = sealed(body());
        let table = FeetTable::new(&bytes, 2).unwrap();
        assert_eq!((table.foot(0).unwrap().ankle, table.foot(0).unwrap().points()), (5, &[6][..]));
        assert_eq!([2, 3, 8, 9].map(|frame| table.contact(0, 0, frame)), [None, Some(1), Some(1), None]);
        assert_eq!(table.contact(1, 0, 3), Some(0));
        assert_eq!((table.contact(2, 0, 3), table.contact(0, 1, 3)), (None, None));
        let entry = Entry { transition: 7, at: 12, start: 2 };
        let next = |frame, looped| table.next_entry(7, frame, 20, looped);
        assert_eq!((next(10, false), next(13, false), next(13, true)), (Some((entry, 2)), None, Some((entry, 19))));
        assert_eq!(table.next_entry(6, 0, 20, true), None);
    }

    #[test]
    fn whatever_is_wrong_with_it_is_refused() {
        let whole = sealed(body());
        for len in 0..whole.len() {
            assert!(FeetTable::new(&whole[..len], 2).is_err(), "{len}");
            if let Some(len) = len.checked_sub(1) {
                assert!(FeetTable::new(&sealed(body()[..len.min(body().len() - 1)].to_vec()), 2).is_err(), "{len}");
            }
        }
        assert!(FeetTable::new(&whole, 3).is_err());
        for (at, value) in
            [(0, 2), (1, 0), (1, 3), (2, 1), (4, 1), (6, 0), (10, 5), (11, 1), (20, 3), (22, 1), (24, 1), (25, 2), (26, 9)]
        {
            let mut body = body();
            body[at] = value;
            assert!(FeetTable::new(&sealed(body), 2).is_err(), "{at}: {value}");
        }
        // A second foot that no contact names, as it should be and with too many points.
        for (points, good) in [(4, true), (5, false)] {
            let mut body = body();
            body[1] = 2;
            body.splice(20..20, [9, 0, points, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
            assert_eq!(FeetTable::new(&sealed(body), 2).is_ok(), good, "{points} points");
        }
    }
}
