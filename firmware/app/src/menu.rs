//! A menu for boards with one button or two: what is chosen, and what choosing it does.

use crate::commands::Command;
use crate::source::TextLine;
use crate::view_state::{Effect, ViewState};

/// What the menu offers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Item {
    Clip,
    Pause,
    Style,
    Speed,
    View,
    Sleep,
    About,
    Close,
}

/// In the order in which they follow each other.
const ITEMS: [Item; 8] = [Item::Clip, Item::Pause, Item::Style, Item::Speed, Item::View, Item::Sleep, Item::About, Item::Close];

/// Fastest of the speeds that the menu goes through, and slowest, as powers of two.
const FASTEST: i8 = 1;
const SLOWEST: i8 = -2;

impl Item {
    /// What the display says of it.
    fn words(self, view_state: &ViewState) -> &'static str {
        match self {
            Item::Clip => "clip",
            Item::Pause if view_state.paused => "play",
            Item::Pause => "pause",
            #[cfg(feature = "solid")]
            Item::Style if view_state.style.solid => "style: solid",
            Item::Style if view_state.style.lines.smooth => "style: smooth",
            Item::Style => "style: lines",
            Item::Speed => match view_state.rate_log2 {
                ..=-2 => "speed: x1/4",
                -1 => "speed: x1/2",
                0 => "speed: x1",
                1.. => "speed: x2",
            },
            Item::View => "view",
            Item::Sleep if view_state.idle.awake => "sleep: never",
            Item::Sleep => "sleep: 10 min",
            Item::About => concat!("Pantin ", env!("CARGO_PKG_VERSION")),
            Item::Close => "close",
        }
    }
}

/// Applies a command, which the menu takes while it is open. Returns what else is to be done for it.
pub(crate) fn apply(view_state: &mut ViewState, command: Command) -> Effect {
    let Some(at) = view_state.menu else { return view_state.apply(command) };
    match command {
        Command::NextClip | Command::OrbitRight | Command::Slower => view_state.menu = Some(next(at)),
        Command::PreviousClip | Command::OrbitLeft | Command::Faster => {
            view_state.menu = Some(at.checked_sub(1).unwrap_or(ITEMS.len() - 1));
        }
        Command::Menu | Command::Pause => return choose(view_state, item(at)),
        // A letter for which the menu has no use does what it does without it.
        _ => return view_state.apply(command),
    }
    Effect::Nothing
}

/// The item of a number.
fn item(at: usize) -> Item {
    ITEMS.get(at).copied().unwrap_or(Item::Close)
}

/// The number after another: the first after the last.
fn next(at: usize) -> usize {
    if at + 1 < ITEMS.len() { at + 1 } else { 0 }
}

/// Carries an item out. The menu stays open, so that the same press chooses again.
fn choose(view_state: &mut ViewState, item: Item) -> Effect {
    match item {
        Item::Clip => return view_state.apply(Command::NextClip),
        Item::Pause => return view_state.apply(Command::Pause),
        Item::View => return view_state.apply(Command::View),
        Item::Style => {
            let lines = &mut view_state.style.lines;
            #[cfg(feature = "solid")]
            if lines.smooth || view_state.style.solid {
                lines.smooth = false;
                return view_state.apply(Command::Style);
            }
            lines.smooth = !lines.smooth;
        }
        Item::Speed => {
            view_state.rate_log2 = if view_state.rate_log2 >= FASTEST { SLOWEST } else { view_state.rate_log2 + 1 };
            return Effect::Rate;
        }
        Item::Sleep => view_state.idle.awake = !view_state.idle.awake,
        Item::About => {}
        Item::Close => view_state.menu = None,
    }
    Effect::Nothing
}

/// What presses do, for displays of at least as many columns of letters, and for narrower ones.
const PRESSES: &str = "press: next  hold: choose";
const PRESSES_SHORT: &str = "hold: choose";

/// The lines at the top and at the bottom of a display of `columns` letters: the item, and what presses do.
pub(crate) fn lines(view_state: &ViewState, at: usize, columns: usize) -> [TextLine; 2] {
    let (mut top, mut bottom) = (TextLine::new(), TextLine::new());
    let _ = top.push_str("> ");
    let _ = top.push_str(item(at).words(view_state));
    let _ = bottom.push_str(if columns < PRESSES.len() { PRESSES_SHORT } else { PRESSES });
    [top, bottom]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Options;

    #[test]
    fn one_button_reaches_everything() {
        let mut view_state = ViewState::new(&Options::parse([]));
        assert_eq!(apply(&mut view_state, Command::NextClip), Effect::Clip(1));
        apply(&mut view_state, Command::Menu);
        assert_eq!(apply(&mut view_state, Command::Menu), Effect::Clip(1));
        let mut seen = vec![];
        for at in 0..ITEMS.len() {
            assert_eq!(view_state.menu, Some(at));
            // 72 pixels of letters that are 4 wide.
            let narrow = lines(&view_state, at, 18);
            assert!(narrow.iter().all(|line| line.len() <= 18), "{narrow:?}");
            seen.push(lines(&view_state, at, 32)[0].clone());
            assert_eq!(apply(&mut view_state, Command::NextClip), Effect::Nothing);
        }
        seen.dedup();
        assert_eq!((seen.len(), view_state.menu), (ITEMS.len(), Some(0)));
        // Back to the last, which closes it.
        apply(&mut view_state, Command::PreviousClip);
        apply(&mut view_state, Command::Menu);
        assert_eq!(view_state.menu, None);
    }

    #[cfg(feature = "solid")]
    #[test]
    fn the_camera_is_set_up_for_a_style_that_the_menu_chooses() {
        let mut view_state = ViewState::new(&Options { solid: true, ..Options::parse([]) });
        view_state.menu = ITEMS.iter().position(|item| *item == Item::Style);
        assert_eq!(apply(&mut view_state, Command::Pause), Effect::Aim);
    }

    #[test]
    fn styles_and_speeds_come_back() {
        let mut view_state = ViewState::new(&Options::parse([]));
        for (at, item) in ITEMS
            .into_iter()
            .enumerate()
            .filter(|(_, item)| matches!(item, Item::Style | Item::Speed | Item::Pause | Item::Sleep))
        {
            let first = item.words(&view_state);
            let mut passed = 0;
            while passed == 0 || item.words(&view_state) != first {
                view_state.menu = Some(at);
                apply(&mut view_state, Command::Pause);
                passed += 1;
                assert!(passed < 5, "{first}");
            }
            assert!(passed > 1, "{first}");
        }
    }
}
