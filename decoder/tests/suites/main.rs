//! The decoder's tests. They are one program: mutation tests build it again for each mutant.

mod bank;
mod common;
mod detached;
mod fields;
mod forms;
mod golden;
#[cfg(feature = "keys")]
mod keys;
mod matrices;
mod playing;
mod poses;
mod rigs;
mod seeking;
mod statements;
