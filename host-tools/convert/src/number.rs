//! Numbers in sentences.

use std::fmt::{Display, Formatter, Result};

/// A number as people write it: very large and very small ones with an exponent, in place of hundreds of digits.
#[derive(Clone, Copy, Debug)]
pub struct Number(pub f64);

impl Display for Number {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        let Number(number) = *self;
        let short = number == 0.0 || !number.is_finite() || (1e-9..1e15).contains(&number.abs());
        if short { write!(out, "{number}") } else { write!(out, "{number:e}") }
    }
}

#[cfg(test)]
mod tests {
    use super::Number;

    #[test]
    fn numbers_are_short() {
        let text = [0.0, 50.0, 0.1, -1e-300, 1.5e300, f64::INFINITY].map(|number| Number(number).to_string());
        assert_eq!(text, ["0", "50", "0.1", "-1e-300", "1.5e300", "inf"]);
    }
}
