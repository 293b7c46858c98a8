//! The rules of a table, checked once: afterwards every row that another names is there.

use super::{Cause, INPUTS, LAYERS, NONE, PARAMETERS, STATES, Table, TableError, VERSION};

impl<'a> Table<'a> {
    /// Checks a table for a bank with a number of clips.
    #[inline(never)]
    pub fn new(bytes: &'a [u8], clips: usize) -> Result<Table<'a>, TableError> {
        let (body, stored) = bytes.split_last_chunk::<2>().ok_or(TableError::Truncated)?;
        if pantin::codec::crc::of(body) != u16::from_le_bytes(*stored) {
            return Err(TableError::BadCrc);
        }
        let table = Table { bytes: body };
        table.check_header()?;
        table.check_names()?;
        if usize::from(table.first()) >= table.states() {
            return Err(TableError::NoSuchState(table.first()));
        }
        for parameter in 0..table.parameters() {
            let [least, most, initial] = table.parameter_row(parameter);
            if least >= most || !(least..=most).contains(&initial) {
                return Err(TableError::BadValue);
            }
        }
        table.check_layers(clips)?;
        table.check_transitions(NONE, (0, table.any_transitions() as u8))?;
        for state in 0..table.states() as u8 {
            table.check_state(state, clips)?;
        }
        table.check_reach()?;
        Ok(table)
    }

    /// Checks version and counts.
    fn check_header(&self) -> Result<(), TableError> {
        let &[version, _, _, _, _, _, _, _, ..] = self.bytes else { return Err(TableError::Truncated) };
        if version != VERSION {
            return Err(TableError::UnsupportedVersion(version));
        }
        let too_many =
            self.states() > STATES || self.parameters() > PARAMETERS || self.inputs() > INPUTS || self.layers() > LAYERS;
        if too_many || self.states() == 0 { Err(TableError::BadCount) } else { Ok(()) }
    }

    /// Checks that the names end where the table does.
    fn check_names(&self) -> Result<(), TableError> {
        let mut rest = self.bytes.get(self.names_at()..).ok_or(TableError::Truncated)?;
        for _ in 0..self.states() + self.parameters() + self.inputs() + self.layers() {
            let (len, after) = rest.split_first().ok_or(TableError::Truncated)?;
            rest = after.get(usize::from(*len)..).ok_or(TableError::Truncated)?;
        }
        if rest.is_empty() { Ok(()) } else { Err(TableError::Truncated) }
    }

    fn check_layers(&self, clips: usize) -> Result<(), TableError> {
        for index in 0..self.layers() {
            let row = self.layer(index).ok_or(TableError::BadValue)?;
            if usize::from(row.clip) >= clips {
                return Err(TableError::NoSuchClip { state: (self.states() + index) as u8 });
            }
            if usize::from(row.input) >= self.inputs() {
                return Err(TableError::NoSuchInput(row.input));
            }
        }
        Ok(())
    }

    fn check_state(&self, state: u8, clips: usize) -> Result<(), TableError> {
        let row = self.state(state).ok_or(TableError::BadValue)?;
        if usize::from(row.clip) >= clips || row.blend.is_some_and(|(clip, _)| usize::from(clip) >= clips) {
            return Err(TableError::NoSuchClip { state });
        }
        match row.blend {
            Some((_, parameter)) if usize::from(parameter) >= self.parameters() => Err(TableError::NoSuchInput(parameter)),
            _ => self.check_transitions(state, row.transitions),
        }
    }

    /// Checks the transitions of a state.
    fn check_transitions(&self, state: u8, (first, count): (u8, u8)) -> Result<(), TableError> {
        let end = usize::from(first) + usize::from(count);
        if end > self.transitions() {
            return Err(TableError::NoSuchTransition { state });
        }
        for index in usize::from(first)..end {
            let row = self.transition(index).ok_or(TableError::BadValue)?;
            if usize::from(row.to) >= self.states() {
                return Err(TableError::NoSuchState(row.to));
            }
            let (given, named) = match row.cause {
                Cause::Input(input) | Cause::Released(input) => (self.inputs(), input),
                Cause::Above(parameter, _) | Cause::Below(parameter, _) => (self.parameters(), parameter),
                Cause::End | Cause::Event(_) => continue,
            };
            if usize::from(named) >= given {
                return Err(TableError::NoSuchInput(named));
            }
        }
        let cause = |index: usize| self.transition(index).map(|row| row.cause);
        let repeats = |index: usize| {
            let own = cause(index);
            (usize::from(first)..index).any(|before| cause(before) == own)
        };
        if (usize::from(first)..end).any(repeats) { Err(TableError::Ambiguous { state }) } else { Ok(()) }
    }

    /// Checks that transitions lead from the first state to every other.
    fn check_reach(&self) -> Result<(), TableError> {
        let led_to = |first: usize, count: usize| {
            let rows = (first..first + count).filter_map(|index| self.transition(index));
            rows.fold(0u64, |states, row| states | 1 << (usize::from(row.to) % STATES))
        };
        let is_in = |states: u64, state: usize| states >> state & 1 != 0;
        let mut reached = 1u64 << (usize::from(self.first()) % STATES) | led_to(0, self.any_transitions());
        loop {
            let before = reached;
            for state in (0..self.states()).filter(|state| is_in(before, *state)) {
                if let Some(row) = self.state(state as u8) {
                    reached |= led_to(row.transitions.0.into(), row.transitions.1.into());
                }
            }
            if reached == before {
                break;
            }
        }
        match (0..self.states()).find(|state| !is_in(reached, *state)) {
            Some(state) => Err(TableError::Unreachable(state as u8)),
            None => Ok(()),
        }
    }
}
