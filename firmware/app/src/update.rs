//! Receives a clip over the serial line while another one plays.

use crate::board::Board;

/// A [`pantin_store::Update`], whatever flash it writes.
#[cfg(feature = "update")]
pub(crate) trait Receive {
    /// Takes a byte from the serial line, and returns it if it is no packet's.
    fn receive(&mut self, byte: u8, send: &mut dyn FnMut(&[u8])) -> Option<u8>;
    /// Returns whether a whole clip has arrived.
    fn is_complete(&self) -> bool;
    /// Takes note of a picture on the display.
    fn frame_shown(&mut self);
}

#[cfg(feature = "update")]
impl<S: pantin_store::Slot> Receive for pantin_store::Update<'_, S> {
    fn receive(&mut self, byte: u8, send: &mut dyn FnMut(&[u8])) -> Option<u8> {
        pantin_store::Update::receive(self, byte, send)
    }

    fn is_complete(&self) -> bool {
        pantin_store::Update::is_complete(self)
    }

    fn frame_shown(&mut self) {
        pantin_store::Update::frame_shown(self);
    }
}

/// Takes the packets of an update out of what the serial line receives. Without the feature `update`, or without an update, it does nothing.
#[derive(Default)]
pub(crate) struct Listener<'a> {
    #[cfg(feature = "update")]
    pub update: Option<&'a mut dyn Receive>,
    #[cfg(not(feature = "update"))]
    update: core::marker::PhantomData<&'a ()>,
}

#[cfg(not(feature = "update"))]
impl Listener<'_> {
    #[inline(always)]
    pub fn receive<B: Board>(&mut self, byte: u8, _board: &mut B) -> Option<u8> {
        Some(byte)
    }

    #[inline(always)]
    pub fn is_complete(&self) -> bool {
        false
    }

    #[inline(always)]
    pub fn frame_shown(&mut self) {}
}

#[cfg(feature = "update")]
impl Listener<'_> {
    /// Takes a byte from the serial line, and returns it if it is no packet's.
    pub fn receive<B: Board>(&mut self, byte: u8, board: &mut B) -> Option<u8> {
        match &mut self.update {
            Some(update) => update.receive(byte, &mut |bytes| board.send(bytes)),
            None => Some(byte),
        }
    }

    /// Returns whether a whole clip has arrived.
    pub fn is_complete(&self) -> bool {
        self.update.as_ref().is_some_and(|update| update.is_complete())
    }

    /// Takes note of a picture on the display.
    pub fn frame_shown(&mut self) {
        if let Some(update) = &mut self.update {
            update.frame_shown();
        }
    }
}
