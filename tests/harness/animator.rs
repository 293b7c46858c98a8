//! Scripts for animators and state machines, and what the crate pantin-animator makes of them: as `bindings/c/tests/animator.c` and `tests/web/animator.mjs` print it.

use std::fmt::Write as _;
use std::ops::Range;

use fixed::types::I16F16;
use pantin::{Angle, Bank, ChannelState, Clip};
use pantin_animator::machine::TableError;
use pantin_animator::machine::{FEET_SECTION, LAYERS, SECTION, Table};
use pantin_animator::session::{Input, Session};
use pantin_animator::{Animator, Character, Error, Feet, LayerWorkspace, Placement, Transition, Workspace};

/// Memory for every clip of the tests.
type Room = Workspace<4096, 512>;

/// Numbers from a fixed sequence.
pub struct Sequence(pub u64);

impl Sequence {
    /// A number below another one.
    pub fn below(&mut self, below: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (((self.0 >> 32) * u64::from(below)) >> 32) as u32
    }

    /// A whole number between two.
    fn between(&mut self, least: i32, most: i32) -> i32 {
        least + self.below((most - least) as u32 + 1).cast_signed()
    }
}

/// A script for an animator of some clips, with anything in any order: time, frames, seeks, speeds, places, and transitions of every kind.
pub fn script(clips: &[Clip<'_>], steps: u32, numbers: &mut Sequence) -> String {
    let mut text = String::new();
    for _ in 0..steps {
        let clip = numbers.below(clips.len() as u32);
        let frame = numbers.below(clips[clip as usize].frames() + 2);
        let speed = if numbers.below(2) == 0 { 65_536 } else { numbers.between(-280_000, 280_000) };
        let _ = match numbers.below(16) {
            0..2 => {
                let frames = [0, 1, 2, 3, 8, 32, 60, 255][numbers.below(8) as usize];
                writeln!(text, "w {clip} {frame} {speed} {} {frames}", numbers.below(3))
            }
            2 => writeln!(text, "k {frame}"),
            3 => writeln!(text, "v {speed}"),
            4 => {
                let place = [numbers.between(-9_000_000, 9_000_000), numbers.between(-9_000_000, 9_000_000)];
                writeln!(text, "s {} {} {}", place[0], place[1], numbers.between(-1_000_000_000, 1_000_000_000))
            }
            5..9 => writeln!(text, "p"),
            9 => writeln!(text, "t {}", numbers.below(9_000_000)),
            _ => writeln!(text, "t {}", numbers.below(70_000)),
        };
    }
    text
}

/// A script for a state machine: inputs that come and go, parameters, and times of pictures.
pub fn inputs(table: &Table<'_>, updates: u32, numbers: &mut Sequence) -> String {
    let mut text = String::new();
    let [inputs, parameters] = [table.inputs() as u32, table.parameters() as u32];
    for _ in 0..updates {
        while numbers.below(3) == 0 && inputs > 0 {
            let _ = writeln!(text, "{} {}", ["f", "h", "r", "h", "r"][numbers.below(5) as usize], numbers.below(inputs));
        }
        if numbers.below(8) == 0 && parameters > 0 {
            let parameter = numbers.below(parameters);
            let [least, most, _] = table.range(parameter as u8);
            let _ = writeln!(
                text,
                "s {parameter} {}",
                numbers.between(i32::from(least) - 3, i32::from(most) + 3).clamp(-32768, 32767)
            );
        }
        let most = if numbers.below(20) == 0 { 5_000_000 } else { 50_000 };
        let _ = writeln!(text, "u {}", numbers.below(most));
    }
    text
}

/// The script of a recorded session at a number of pictures a second.
pub fn recorded(text: &str, table: &Table<'_>, rate: u64) -> Option<String> {
    let session = Session::new_checked(text, table).ok()?;
    let (mut script, mut inputs) = (String::new(), session.inputs().peekable());
    let time = |picture: u64| (picture * 1_000_000 / rate) as u32;
    for picture in 1..=u64::from(session.end_us()) * rate / 1_000_000 {
        while let Some(timed) = inputs.next_if(|timed| timed.time_us <= time(picture)) {
            let _ = match timed.input {
                Input::Press(input) => writeln!(script, "f {input}"),
                Input::Hold(input) => writeln!(script, "h {input}"),
                Input::Release(input) => writeln!(script, "r {input}"),
                Input::Set(parameter, value) => writeln!(script, "s {parameter} {value}"),
                Input::End => Ok(()),
            };
        }
        let _ = writeln!(script, "u {}", time(picture) - time(picture - 1));
    }
    Some(script)
}

/// Updates of what [`steer`] prints in which a foot was held.
pub fn held(text: &str) -> usize {
    let is_held = |line: &&str| line.split(' ').skip(2).take(2).any(|joint| joint != "65535");
    text.lines().skip(1).filter(is_held).count()
}

/// A bank's table with anything in it that its rules nearly allow; `bank` has no table of its own.
pub fn with_table(bank: &[u8], clips: u32, numbers: &mut Sequence) -> Vec<u8> {
    let [states, parameters, inputs] = [1 + numbers.below(5), numbers.below(3), 1 + numbers.below(4)];
    let [own, any] = [numbers.below(3), numbers.below(3)];
    let transitions = any + own * states;
    let mut body =
        vec![1, states as u8, transitions as u8, parameters as u8, inputs as u8, numbers.below(states) as u8, any as u8, 0];
    let layers = numbers.below(3);
    body[7] = layers as u8;
    for state in 0..states {
        let blends = parameters > 0 && numbers.below(4) == 0;
        let other = if blends { numbers.below(clips) as u8 } else { 255 };
        let speed = if numbers.below(2) == 0 { 256 } else { numbers.between(-1030, 1030) } as i16;
        let (by, follow) = if blends { (numbers.below(parameters) as u8, numbers.below(80) as u8) } else { (0, 0) };
        body.extend([numbers.below(clips) as u8, other, by, follow]);
        body.extend(speed.to_le_bytes());
        body.extend([(any + own * state) as u8, own as u8]);
    }
    for _ in 0..transitions {
        let cause = if parameters > 0 { numbers.below(6) } else { numbers.below(4) };
        let argument = [0, numbers.below(inputs), numbers.below(inputs), numbers.below(3), 0, 0][cause as usize];
        body.extend([cause as u8, argument as u8]);
        body.extend((numbers.between(-20, 20) as i16).to_le_bytes());
        let first = if numbers.below(4) == 0 { 255 } else { numbers.below(40) as u8 };
        body.extend([numbers.below(states) as u8, numbers.below(3) as u8, numbers.below(30) as u8, first]);
    }
    for _ in 0..parameters {
        body.extend([-20i16, 20, 3].into_iter().flat_map(i16::to_le_bytes));
    }
    for _ in 0..layers {
        body.extend([numbers.below(clips) as u8, numbers.below(inputs) as u8, numbers.below(40) as u8, 0]);
        body.extend((0..8).map(|_| numbers.below(256) as u8));
    }
    (0..states + parameters + inputs).for_each(|_| body.extend([1, b'n']));
    for _ in 0..layers {
        let pattern = ["*", "*a*", "?*e* +", "root", "*\n*t", "b* +"][numbers.below(6) as usize];
        body.push(pattern.len() as u8);
        body.extend(pattern.bytes());
    }
    // Some tables are damaged in a place.
    if numbers.below(4) == 0 {
        let at = numbers.below(body.len() as u32) as usize;
        body[at] ^= 1 << numbers.below(8);
    }
    body.extend(pantin::codec::crc::of(&body).to_le_bytes());
    let mut bytes = bank.to_vec();
    bytes.push(SECTION);
    pantin::codec::varint::put(body.len() as u32, &mut |byte| bytes.push(byte));
    bytes.extend(body);
    bytes
}

/// A bank that is damaged in one or two places; its checksums are right, mostly.
pub fn damaged(sources: &[Vec<u8>], numbers: &mut Sequence) -> Vec<u8> {
    let mut bytes = sources[numbers.below(sources.len() as u32) as usize].clone();
    for _ in 0..=numbers.below(2) {
        let at = numbers.below(bytes.len() as u32) as usize;
        bytes[at] ^= 1 << numbers.below(8);
    }
    if numbers.below(8) > 0 {
        hostile::fix::bank(&mut bytes);
        hostile::fix::clips_of_bank(&mut bytes);
        mend_table(&mut bytes, SECTION);
    }
    bytes
}

/// A bank whose table of feet is damaged in one or two places; its checksum is right, mostly.
pub fn with_damaged_feet(bank: &[u8], numbers: &mut Sequence) -> Vec<u8> {
    let mut bytes = bank.to_vec();
    let Some(table) = table_of(bank, FEET_SECTION) else { return bytes };
    for _ in 0..=numbers.below(2) {
        let at = table.start + numbers.below(table.len() as u32) as usize;
        bytes[at] ^= 1 << numbers.below(8);
    }
    if numbers.below(8) > 0 {
        mend_table(&mut bytes, FEET_SECTION);
    }
    bytes
}

/// Where a table is in a bank, as far as its sections can be told.
fn table_of(bytes: &[u8], section: u8) -> Option<Range<usize>> {
    let table = Bank::new_checked(bytes).ok()?.section(section).ok()??;
    let at = table.as_ptr().addr() - bytes.as_ptr().addr();
    Some(at..at + table.len())
}

/// Makes the checksum of a table right.
fn mend_table(bytes: &mut [u8], section: u8) {
    if let Some(table) = table_of(bytes, section) {
        hostile::fix::rig(&mut bytes[table]);
    }
}

/// The clips among these files by their rig, and the rig's number with them.
pub fn by_rig(files: &[Vec<u8>]) -> Vec<(u32, Vec<&[u8]>)> {
    let mut groups: Vec<(u32, Vec<&[u8]>)> = vec![];
    for bytes in files {
        let Ok(clip) = Clip::new_checked(bytes) else { continue };
        match groups.iter_mut().find(|(rig, _)| *rig == clip.rig().id()) {
            Some((_, clips)) => clips.push(bytes),
            None => groups.push((clip.rig().id(), vec![bytes])),
        }
    }
    groups
}

/// A clip in another form: one bit of its head, which says how a joint is coded, is inverted, and its CRC is computed again.
pub fn in_another_form(file: &[u8]) -> Option<Vec<u8>> {
    let clip = Clip::new_checked(file).ok()?;
    let start = file.len().checked_sub(clip.motion_len()).filter(|_| clip.crc_len() == 2)?;
    (0..8 * 12).find_map(|bit| {
        let mut changed = file.to_vec();
        *changed.get_mut(start + bit / 8)? ^= 1 << (bit % 8);
        let (body, crc) = changed[start..].split_last_chunk_mut::<2>()?;
        *crc = pantin::codec::crc::update(pantin::codec::crc::of_prefix(file[3], clip.motion_len() as u32), body).to_le_bytes();
        let other = Clip::new_checked(&changed).ok()?;
        (other.frames() == clip.frames() && other.form() != clip.form()).then_some(changed)
    })
}

/// What an animator is at.
fn print(text: &mut String, animator: &mut Animator<'_, '_>) {
    let track = animator.track();
    let (frame, part, speed, ended) = (track.frame(), track.part().to_bits(), track.speed().to_bits(), u8::from(track.ended()));
    let Placement { place: [a, b], heading } = animator.placement();
    let hash = animator
        .pose()
        .values
        .iter()
        .fold(0x811c_9dc5u32, |hash, &value| (hash ^ value.cast_unsigned()).wrapping_mul(0x0100_0193));
    let left = animator.transition_left();
    let _ = write!(text, "{frame} {part} {speed} {ended} {left} {a} {b} {} {hash:08x}", heading.to_bits());
    for fired in animator.events().iter() {
        let _ = write!(text, " {}:{}", fired.id, fired.frame);
    }
    let _ = writeln!(text, " {}", animator.events().lost());
}

/// What an animator makes of a script; it begins with the first clip.
pub fn play(clips: &[Clip<'_>], script: &str) -> String {
    let mut text = String::new();
    let mut memory = Box::new(Room::new());
    let Ok(mut animator) = Animator::new(clips[0], memory.lend()) else { return "refused\n".into() };
    print(&mut text, &mut animator);
    for line in script.lines() {
        let (word, rest) = line.split_at(1);
        let numbers: Vec<i64> = rest.split_whitespace().map(|number| number.parse().unwrap_or(0)).collect();
        let mut refused = false;
        match word {
            "w" => {
                let frames = numbers[4] as u8;
                let transition =
                    [Transition::Cut, Transition::Inertialized(frames), Transition::Faded(frames)][numbers[3] as usize];
                let speed = I16F16::from_bits(numbers[2] as i32);
                refused = animator.switch(clips[numbers[0] as usize], numbers[1] as u32, speed, transition).is_err();
            }
            "k" => animator.seek(numbers[0] as u32),
            "v" => animator.set_speed(I16F16::from_bits(numbers[0] as i32)),
            "s" => animator
                .set_placement(Placement { place: [numbers[0], numbers[1]], heading: Angle::from_bits(numbers[2] as i32) }),
            "p" => drop(animator.step()),
            _ => drop(animator.update(numbers[0] as u32)),
        }
        if refused {
            text += "refused ";
        }
        print(&mut text, &mut animator);
        if numbers.len() == 1 {
            animator.events().take();
        } else {
            animator.events().clear();
        }
    }
    text
}

/// What is lent to a character besides its own memory.
#[derive(Clone, Copy, Debug)]
pub struct Lent {
    /// States blend and layers play.
    pub second: bool,
    /// Feet are held.
    pub feet: bool,
}

/// The state of a character and the joints at which its feet are held, then what its animator is at.
fn print_state(text: &mut String, character: &mut Character<'_, '_>) {
    let held = [0, 1].map(|foot| character.feet().and_then(|feet| feet.held(foot)).unwrap_or(u16::MAX));
    let _ = write!(text, "{} {} {} ", character.state(), held[0], held[1]);
    print(text, character.animator());
}

/// What the state machine of a bank makes of a script. "refused" if the bank has no machine that plays.
pub fn steer(bank: &[u8], lent: Lent, script: &str) -> String {
    let mut text = String::new();
    let mut memory = Box::new(Room::new());
    let (mut states, mut values) = (vec![ChannelState::NEW; 4096], vec![0; 512]);
    let mut layers = vec![LayerWorkspace::<4096, 512>::new(); LAYERS];
    let mut feet = Feet::new();
    let Ok(mut character) = Character::new(bank, memory.lend()) else { return "refused\n".into() };
    let Lent { second, feet: held } = lent;
    if second && character.lend_second(&mut states, &mut values).is_err() {
        return "refused\n".into();
    }
    let count = if second { character.table().layers() } else { 0 };
    for layer in layers.iter_mut().take(count) {
        if character.lend_layer(layer.lend()).is_err() {
            return "refused\n".into();
        }
    }
    if held && !matches!(character.lend_feet(&mut feet), Ok(()) | Err(Error::Machine(TableError::Missing))) {
        return "refused\n".into();
    }
    print_state(&mut text, &mut character);
    for line in script.lines() {
        let (word, rest) = line.split_at(1);
        let numbers: Vec<i64> = rest.split_whitespace().map(|number| number.parse().unwrap_or(0)).collect();
        match word {
            "f" => character.machine().fire(numbers[0] as u8),
            "h" => character.machine().hold(numbers[0] as u8, true),
            "r" => character.machine().hold(numbers[0] as u8, false),
            "s" => character.machine().set(numbers[0] as u8, numbers[1] as i16),
            _ => {
                let outcome = match character.update(numbers[0] as u32) {
                    Ok(updated) => u8::from(updated.entered.is_some()).to_string(),
                    Err(_) => "refused".into(),
                };
                let _ = write!(text, "{outcome} ");
                print_state(&mut text, &mut character);
            }
        }
    }
    text
}
