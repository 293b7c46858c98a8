//! Lines, dots and discs in integers, straight into a [`Surface`](crate::surface::Surface).

mod clip;
mod disc;
mod dots;
mod line;
mod smooth;

pub use disc::disc;
pub use dots::Dots;
pub use line::{Pace, dotted, line, thick, walk};
pub use smooth::smooth;
