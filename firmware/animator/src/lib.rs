//! Motion that reacts: transitions between [`pantin`] clips, layers, root motion, events, inverse kinematics and a state machine, in
//! integers, without heap, float, `unsafe` or panic. The caller lends the memory. The poses are the same bits on every processor.
//!
//! ```
//! use pantin_animator::{Animator, Transition, Workspace};
//! # use fixed::types::I16F16;
//!
//! # fn play(walk: pantin::Clip, run: pantin::Clip) -> Result<(), Box<dyn std::error::Error>> {
//! let mut memory = Workspace::<80, 100>::new();
//! let mut animator = Animator::new(walk, memory.lend())?;
//! for picture in 0..200 {
//!     if picture == 100 {
//!         // From the walk, wherever it is, to the run's first frame, in 12 of the run's frames.
//!         animator.switch(run, 0, I16F16::ONE, Transition::Inertialized(12))?;
//!     }
//!     animator.update(16_667)?;
//!     let (_pose, _place) = (animator.pose(), animator.placement());
//!     while let Some(event) = animator.events().take() {
//!         println!("{:?}", animator.track().clip().event_name(event.id));
//!     }
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # What state is kept
//!
//! One player (20 bytes for each moving channel and 4 for each channel, as in the decoder), one [`Offset`] of 16 bytes for each channel,
//! the pose that comes out (4 bytes for each channel) and a [`Group`] of 6 bytes for each joint. There is no second player.
//!
//! # What a transition costs
//!
//! At the switch, the pose and the velocity of each channel are kept, the player starts the new clip in the same memory, and the
//! differences become a cubic that ends at zero, with velocity zero, after the given number of frames; of more than a quarter of a second,
//! the velocities' part ends after a quarter, and the cubics are solved again there. At speed 1 the player's own additions carry it, so
//! that a frame takes little more than without a transition. At other speeds, and where the clip ends or a loop begins again, each channel that has a
//! difference costs three more additions a frame and one that adds the difference to the clip. At the end the pose is the clip's, bit for bit. Another
//! transition can start at any time: the difference that is left is a part of the pose from which it starts.
//!
//! Of the angles that are the same rotation the nearest to the new clip's are taken, once, at the switch: Euler angles by the other triple,
//! exponential maps by a turn less, quaternions by their sign. Clips of different forms ([`pantin::Form`]) cost the conversion of the
//! joints that they code differently, at that instant too.
//!
//! # Root motion
//!
//! The root's horizontal position channels are 0 in [`Animator::pose`]; [`Animator::placement`] says where the figure is and what to turn it
//! by. A placement is a function of the clip's frame, the laps of the loop and the place where the clip was started, so that increments add up
//! exactly. A loop whose root does not come back to within 5 cm of its start goes on by its last velocity over the seam. A switch keeps
//! place and heading. A clip in which the root points straight up or down has no heading there.
//!
//! # Which type do I want?
//!
//! | to | use |
//! |---|---|
//! | play a clip and go over to others | [`Animator::switch`] with a [`Transition`] |
//! | fade from one moving clip to another | a second [`Track`] and [`layer::blend`] with a [`layer::Ramp`] |
//! | wave while walking | a [`Track`], a [`Mask`] and [`layer::blend`] |
//! | add a recoil | [`layer::add`] |
//! | breathe, blink | [`procedural::Breath`], [`procedural::Blink`] |
//! | keep feet where they stand | [`Character::lend_feet`], or a [`FootLock`] with an animator of one's own |
//! | reach for something | [`Limb`] |
//! | look at something | [`Look`] |
//! | mix a walk and a run in step | [`Track::sync_to`], or a state that blends |
//! | leave all this to a table | [`Character`], or a [`machine::Machine`] with an animator of one's own |
//! | play recorded inputs | [`session::Replay`] |
//! | place several figures | [`Scene`] |
//!
//! # The order of work in a frame
//!
//! 1. [`Animator::update`]: time, events, root motion, the transition, the pose.
//! 2. Layers, then procedural motion, on [`Animator::pose_mut`].
//! 3. Inverse kinematics, last: it needs the final pose.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod animator;
mod carry;
mod chain;
mod character;
mod detached;
mod ease;
mod error;
mod events;
mod feet;
mod foot;
mod groups;
pub mod layer;
mod lead;
mod look;
pub mod machine;
mod mask;
mod math;
mod memory;
pub mod procedural;
mod root;
mod scene;
pub mod session;
mod switch;
mod sync;
mod table;
mod track;
mod transition;
mod two_bone;

pub use animator::{Animator, RootMotion};
pub use character::{Character, first_clip, visit_poses};
pub use detached::{DetachedAnimator, DetachedCharacter};
pub use error::{Error, Name};
pub use events::{EVENTS, EventQueue, EventsLost, Fired};
pub use feet::Feet;
pub use foot::FootLock;
pub use groups::Group;
pub use look::{Look, Share};
pub use mask::Mask;
pub use memory::{LayerMemory, LayerWorkspace, Memory, Workspace};
pub use root::{GroundPose, Placement};
pub use scene::Scene;
pub use track::Track;
pub use transition::Offset;
pub use transition::Transition;
pub use two_bone::{Limb, Limits, Reach};
