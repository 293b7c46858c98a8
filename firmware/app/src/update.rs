//! A clip's replacement over the line, while another one plays.

use crate::board::Board;

/// Who listens for a clip, whatever flash it goes to.
#[cfg(feature = "update")]
pub(crate) trait Listen {
    /// Takes a byte from the line, and hands it on if it is a letter.
    fn take(&mut self, byte: u8, send: &mut dyn FnMut(&[u8])) -> Option<u8>;
    /// Whether a clip came whole.
    fn is_whole(&self) -> bool;
    /// A picture was shown.
    fn picture(&mut self);
}

#[cfg(feature = "update")]
impl<S: pantin_store::Slot> Listen for pantin_store::Update<'_, S> {
    fn take(&mut self, byte: u8, send: &mut dyn FnMut(&[u8])) -> Option<u8> {
        pantin_store::Update::receive(self, byte, send)
    }

    fn is_whole(&self) -> bool {
        pantin_store::Update::is_complete(self)
    }

    fn picture(&mut self) {
        pantin_store::Update::frame_shown(self);
    }
}

/// Who listens, if anyone does. Without the feature `update` nobody does, and this is nothing.
#[derive(Default)]
pub(crate) struct Listener<'a> {
    #[cfg(feature = "update")]
    pub over: Option<&'a mut dyn Listen>,
    #[cfg(not(feature = "update"))]
    over: core::marker::PhantomData<&'a ()>,
}

#[cfg(not(feature = "update"))]
impl Listener<'_> {
    /// Letters are all that comes.
    #[inline(always)]
    pub fn letter<B: Board>(&mut self, byte: u8, _board: &mut B) -> Option<u8> {
        Some(byte)
    }

    #[inline(always)]
    pub fn poll<B: Board>(&mut self, board: &mut B) -> Option<u8> {
        board.poll()
    }

    #[inline(always)]
    pub fn is_whole(&self) -> bool {
        false
    }

    #[inline(always)]
    pub fn picture(&mut self) {}
}

#[cfg(feature = "update")]
impl Listener<'_> {
    /// The letter that a byte is, if it is no packet's.
    pub fn letter<B: Board>(&mut self, byte: u8, board: &mut B) -> Option<u8> {
        match &mut self.over {
            Some(update) => update.take(byte, &mut |bytes| board.send(bytes)),
            None => Some(byte),
        }
    }

    /// A letter, if one is there; what is there of packets before it is taken.
    pub fn poll<B: Board>(&mut self, board: &mut B) -> Option<u8> {
        while !self.is_whole() {
            let byte = board.poll()?;
            if let Some(letter) = self.letter(byte, board) {
                return Some(letter);
            }
        }
        None
    }

    /// Whether a clip came whole.
    pub fn is_whole(&self) -> bool {
        self.over.as_ref().is_some_and(|update| update.is_whole())
    }

    /// A picture was shown.
    pub fn picture(&mut self) {
        if let Some(update) = &mut self.over {
            update.picture();
        }
    }
}
