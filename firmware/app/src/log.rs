//! The log, with the feature `defmt`; without it these macros do nothing.

/// Writes a line to the log.
macro_rules! info {
    ($($words:tt)*) => {{
        #[cfg(feature = "defmt")]
        defmt::info!($($words)*);
    }};
}

/// Writes a line about an error to the log.
macro_rules! error {
    ($text:literal) => {{
        #[cfg(feature = "defmt")]
        defmt::error!($text);
    }};
    // An error that is no `defmt::Format`.
    ($text:literal, defmt::Display2Format(&$error:ident)) => {{
        #[cfg(feature = "defmt")]
        defmt::error!($text, defmt::Display2Format(&$error));
        #[cfg(not(feature = "defmt"))]
        let _ = &$error;
    }};
    ($text:literal, $error:expr) => {{
        #[cfg(feature = "defmt")]
        defmt::error!($text, $error);
        #[cfg(not(feature = "defmt"))]
        let _ = &$error;
    }};
}

pub(crate) use {error, info};
