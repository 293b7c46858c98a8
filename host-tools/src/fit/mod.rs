//! From per-frame motion to segments: the fewest bits within the bound.
pub mod cost;
pub mod search;
