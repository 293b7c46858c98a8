//! The suites of the store, one module each.

mod board;
mod mock;
mod power;
mod transfer;
