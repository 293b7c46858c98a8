//! Lines and discs in integers, straight into a [`Surface`](crate::surface::Surface).

mod clip;
mod disc;
mod line;
mod smooth;

pub use disc::disc;
pub use line::{dotted, line};
pub use smooth::smooth;
