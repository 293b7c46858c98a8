//! The log, where the board has one.

/// A line of the log.
macro_rules! info {
    ($($words:tt)*) => {{
        #[cfg(feature = "defmt")]
        defmt::info!($($words)*);
    }};
}

/// A line of the log about what went wrong.
macro_rules! error {
    ($text:literal) => {{
        #[cfg(feature = "defmt")]
        defmt::error!($text);
    }};
    ($text:literal, $error:expr) => {{
        #[cfg(feature = "defmt")]
        defmt::error!($text, $error);
        #[cfg(not(feature = "defmt"))]
        let _ = &$error;
    }};
}

pub(crate) use {error, info};
