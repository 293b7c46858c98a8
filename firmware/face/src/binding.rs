//! Binds the scalars of a clip to the shapes of a face: by name once, then one multiplication and one shift for each in every frame.

use crate::model::{Model, NameEntry};
use crate::target::Target;
use crate::weights::{Weights, shifted};
use heapless::Vec;
use pantin::{Pose, Rig, Scalars, WrongForm};

/// A scalar that drives a shape.
#[derive(Clone, Copy, Debug)]
struct Drive {
    /// The channel of a pose, as bytes: as a `u16` it would cost a byte of padding in each of many entries.
    channel: [u8; 2],
    target: Target,
    mantissa: i8,
    shift: i8,
}

/// Maximum number of shapes that the scalars of a clip drive together; a scalar may drive several.
pub const BINDINGS: usize = 80;

/// Which scalars of a clip drive which shapes of a face.
///
/// ```
/// # fn play(clip: pantin::Clip) -> Result<(), Box<dyn core::error::Error>> {
/// use pantin_face::{Binding, MODEL, Model, Morph, VERTICES, Weights};
///
/// let model = Model::new_checked(MODEL)?;
/// let mut morph = Morph::<VERTICES>::new(&model)?;
/// let mut weights = Weights::new();
/// let binding = Binding::new(&clip.rig(), &model);
/// # let (mut states, mut pose) = (vec![pantin::ChannelState::default(); clip.moving()], vec![0; clip.rig().channels()]);
/// let player = pantin::Player::new(clip, &mut states, &mut pose)?;
/// // In every frame:
/// binding.read_checked(player.pose(), &mut weights)?;
/// morph.apply(&model, &weights);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Binding {
    drives: Vec<Drive, BINDINGS>,
    driving: u16,
    scalars: u16,
    /// That of the rig whose scalars are bound; `None` for scalars alone.
    rig_id: Option<u32>,
}

/// A clip with this many scalars that drive a face is a face, whatever else it holds.
const SUFFICIENT: u16 = 3;

impl Binding {
    /// A binding of no scalars, for [`Binding::set_up`].
    pub const EMPTY: Binding = Binding { drives: Vec::new(), driving: 0, scalars: 0, rig_id: None };

    /// Binds the scalars of `rig` whose names `model` has. Bindings beyond [`BINDINGS`] are dropped.
    #[inline(always)]
    pub fn new(rig: &Rig, model: &Model) -> Binding {
        let mut binding = Binding::EMPTY;
        binding.set_up(rig, model);
        binding
    }

    /// Binds in place, where nothing was bound before: [`Binding::new`] may copy its result, for which a small machine may have no RAM.
    #[inline(never)]
    pub fn set_up(&mut self, rig: &Rig, model: &Model) {
        self.rig_id = Some(rig.id());
        self.bind_scalars(rig.scalars(), rig.joint_channels(), model);
    }

    /// Binds scalars of which the first is channel `first` of a pose.
    #[inline(always)]
    pub fn bind_scalars(&mut self, scalars: Scalars, first: usize, model: &Model) {
        for (index, scalar) in scalars.enumerate() {
            let wanted = scalar.name_hash();
            let mut known = false;
            for entry in model.name_entries().filter(|entry| entry.hash == wanted) {
                known = true;
                let channel = ((first + index) as u16).to_le_bytes();
                let shift = scalar.exponent.saturating_add(entry.exponent);
                let NameEntry { target, mantissa, .. } = entry;
                let _ = self.drives.push(Drive { channel, target, mantissa, shift });
            }
            self.driving += u16::from(known);
            self.scalars += 1;
        }
    }

    /// Number of scalars that drive the face.
    pub fn driving(&self) -> usize {
        usize::from(self.driving)
    }

    /// Whether the clip is a face: three of its scalars drive one, or all of them. A single name among others may mean something else.
    pub fn is_face(&self) -> bool {
        self.driving >= SUFFICIENT || (self.driving > 0 && self.driving == self.scalars)
    }

    /// [`Binding::read`] of a pose that may be of another rig: then the error is [`WrongForm::Rig`], and the weights stay as they were. A binding that
    /// was made of scalars alone takes every pose.
    pub fn read_checked(&self, pose: Pose<'_>, weights: &mut Weights) -> Result<(), WrongForm> {
        if self.rig_id.is_some_and(|id| id != pose.form.rig_id()) {
            return Err(WrongForm::Rig);
        }
        self.read(pose.values, weights);
        Ok(())
    }

    /// Sets `weights` to those of `pose`, the values of a player of the rig that was bound: those of another rig give wrong weights
    /// ([`Binding::read_checked`] refuses them). Weights that no scalar drives become 0.
    pub fn read(&self, pose: &[i32], weights: &mut Weights) {
        weights.clear();
        for drive in &self.drives {
            let raw = pose.get(usize::from(u16::from_le_bytes(drive.channel))).map_or(0, |raw| raw >> 16);
            if raw == 0 {
                continue;
            }
            // 2^15 times 2^7. Negative sums are raised to 0 later: two opposite units may share a channel.
            let value = shifted(raw * i32::from(drive.mantissa), drive.shift);
            weights.add_to(drive.target, value);
        }
    }
}
