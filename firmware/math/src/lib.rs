//! Integer arithmetic for poses: sine and arctangent, rotations, vectors, and where joints are. No heap, no float; no product is wider than 32 bits in a
//! frame, except in [`JointChain`].
//!
//! # Which type do I want?
//!
//! | to | use |
//! |---|---|
//! | know where all joints are, or some of them, and how they are turned | [`Kinematics`] |
//! | know where one joint is as exactly as the clip has it, whatever it takes | [`JointChain`] |
//! | compute with rotations of 15 fraction bits | [`rotation::Rotation`] |
//! | compute with directions and lengths | [`vector`] |
//!
//! `pantin-figure`, which draws poses, and `pantin-animator`, which changes them, compute with this crate.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod chain;
mod kinematics;
pub mod rotation;
pub mod trig;
pub mod units;
pub mod vector;

pub use chain::{ChainError, JointChain, WorldJoint};
pub use kinematics::{JointPlace, Kinematics, KinematicsError};
