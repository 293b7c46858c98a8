//! The largest clip on boards with 64 KiB of RAM or more.

/// At most 400 channels, 320 of them moving, and 80 joints of a figure, fingers and toes left out.
pub type Capacity = pantin_app::MaxClip<400, 320, 80>;
