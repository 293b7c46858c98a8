//! The web page: its modules, its files and our clips, and the npm packages.

pub mod bundle;
mod compare;
mod inline;
pub mod npm;
mod pack;
mod script;
pub mod site;
pub mod tools;
