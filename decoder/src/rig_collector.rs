//! A rig that arrives over a line in front of its clip.

use crate::error::{Memory, OpenError, TooSmall};
use crate::prefix::Prefix;
use crate::rig::Rig;

/// Collects the rig from the first bytes of a file that arrives in pieces, for a receiver that knows no rig beforehand; then a
/// [`crate::Stream`] plays the rest.
///
/// ```
/// use pantin::{ChannelState, CollectError, RigCollector, Stream};
/// fn receive(mut pieces: impl Iterator<Item = &'static [u8]>) -> Result<(), CollectError> {
///     let (mut rig, mut buffer) = ([0; 1024], [0; Stream::BUFFER]);
///     let (mut states, mut values) = ([ChannelState::NEW; 96], [0; 144]);
///     let mut collector = RigCollector::new(&mut rig);
///     let mut rest: &[u8] = &[];
///     while !collector.is_complete() {
///         let Some(piece) = pieces.next() else { return Ok(()) };
///         rest = &piece[collector.feed(piece)?..];
///     }
///     let mut stream = collector.stream(&mut buffer, &mut states, &mut values)?;
///     let _taken = stream.feed(rest);
///     // From here on as with `Stream::new`.
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct RigCollector<'m> {
    prefix: Prefix,
    buffer: &'m mut [u8],
    len: usize,
    complete: bool,
}

/// Why a rig cannot be collected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CollectError {
    /// The bytes are no clip, or a clip without a rig ([`OpenError::WrongRig`]). It stays so.
    Open(OpenError),
    /// The rig, or the clip, needs more memory.
    TooSmall(TooSmall),
}

impl core::fmt::Display for CollectError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            CollectError::Open(error) => error.fmt(f),
            CollectError::TooSmall(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for CollectError {}

impl From<OpenError> for CollectError {
    fn from(error: OpenError) -> Self {
        CollectError::Open(error)
    }
}

impl From<TooSmall> for CollectError {
    fn from(error: TooSmall) -> Self {
        CollectError::TooSmall(error)
    }
}

impl<'m> RigCollector<'m> {
    /// Waits for the first byte. `buffer` holds the rig's bytes for as long as its clips play.
    pub fn new(buffer: &'m mut [u8]) -> Self {
        RigCollector { prefix: Prefix::default(), buffer, len: 0, complete: false }
    }

    /// Takes bytes and returns how many: fewer than all once the rig is complete. The rest is the stream's.
    pub fn feed(&mut self, bytes: &[u8]) -> Result<usize, CollectError> {
        for (taken, &byte) in bytes.iter().enumerate() {
            if self.complete {
                return Ok(taken);
            }
            let left = self.prefix.rig_len();
            if let Some(left) = left {
                let (needed, given) = (self.len + left as usize, self.buffer.len());
                let place = self.buffer.get_mut(self.len).filter(|_| needed <= given);
                *place.ok_or(TooSmall { memory: Memory::Rig, needed, given })? = byte;
                self.len += 1;
            }
            if self.prefix.push(byte, None)? {
                return Err(OpenError::WrongRig.into());
            }
            self.complete = left.is_some() && self.prefix.rig_len().is_none();
        }
        Ok(bytes.len())
    }

    /// Whether the rig has arrived.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// A stream that continues behind the rig, which it checks first; memory as for [`crate::Stream::new`].
    pub fn stream<'s>(
        self,
        buffer: &'s mut [u8],
        states: &'s mut [crate::ChannelState],
        values: &'s mut [i32],
    ) -> Result<crate::Stream<'m, 's>, CollectError> {
        let (buffer_of_rig, len) = (self.buffer, self.len);
        let rig = Rig::new_checked(buffer_of_rig.get(..len).unwrap_or(&[]))?;
        Ok(crate::Stream::behind(self.prefix, rig, buffer, states, values)?)
    }
}
