//! The web page: its modules, its files and our clips, and the npm packages.

pub mod arduino;
pub mod browsers;
pub mod bundle;
pub mod compare;
mod downloads;
mod inline;
pub mod npm;
mod offline;
mod pack;
mod script;
pub mod site;
pub mod tools;
