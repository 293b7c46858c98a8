//! Expressions of numbers, names and functions.
//!
//! ```text
//! sum     = product {("+" | "-") product}
//! product = signed {("*" | "/") signed}
//! signed  = ("-" | "+") signed | power
//! power   = atom ["^" signed]
//! atom    = number | name | function "(" sum ["," sum] ")" | "(" sum ")"
//! ```

use super::text::quoted;

/// Longest expression in bytes, and how deep it nests: parser and evaluation call themselves for each level.
pub const LONGEST: usize = 1000;
/// See [`LONGEST`].
pub const DEEPEST: usize = 50;

/// A function of one argument or of two.
#[derive(Clone, Copy, Debug)]
enum Function {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
}

const FUNCTIONS: [(&str, Function); 17] = [
    ("sin", Function::One(f64::sin)),
    ("cos", Function::One(f64::cos)),
    ("tan", Function::One(f64::tan)),
    ("asin", Function::One(f64::asin)),
    ("acos", Function::One(f64::acos)),
    ("atan", Function::One(f64::atan)),
    ("sqrt", Function::One(f64::sqrt)),
    ("exp", Function::One(f64::exp)),
    ("ln", Function::One(f64::ln)),
    ("abs", Function::One(f64::abs)),
    ("sign", Function::One(|x| if x == 0.0 { 0.0 } else { x.signum() })),
    ("floor", Function::One(f64::floor)),
    ("fract", Function::One(|x| x - x.floor())),
    ("round", Function::One(f64::round)),
    ("atan2", Function::Two(f64::atan2)),
    ("min", Function::Two(f64::min)),
    ("max", Function::Two(f64::max)),
];
const PI: &str = "PI";

/// An expression, its names replaced by their places in the list that it was parsed with.
#[derive(Clone, Debug)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// The value of a name.
    Name(usize),
    /// A function of one argument.
    One(fn(f64) -> f64, Box<Expression>),
    /// A function of two.
    Two(fn(f64, f64) -> f64, Box<[Expression; 2]>),
}

/// Whether a name is not taken by a function or a constant, and is made of letters, digits and `_`.
pub fn is_free(name: &str) -> bool {
    let taken = name == PI || FUNCTIONS.iter().any(|(function, _)| *function == name);
    let letters = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    !taken && letters && name.starts_with(|c: char| !c.is_ascii_digit())
}

impl Expression {
    /// Reads `text`, which may use `names`. The error says what was expected.
    pub fn parse(text: &str, names: &[&str]) -> Result<Expression, String> {
        if text.len() > LONGEST {
            return Err(format!("expected an expression of at most {LONGEST} characters; use `let`"));
        }
        let mut parser = Parser { text, at: 0, depth: 0, names };
        let expression = parser.sum()?;
        if parser.peek().is_some() { Err(parser.expected("an operator")) } else { Ok(expression) }
    }

    /// Whether its value depends on a name.
    pub fn uses(&self, name: usize) -> bool {
        match self {
            Expression::Number(_) => false,
            Expression::Name(own) => *own == name,
            Expression::One(_, x) => x.uses(name),
            Expression::Two(_, both) => both.iter().any(|x| x.uses(name)),
        }
    }

    /// Its value; `values` are those of the names.
    pub fn value(&self, values: &[f64]) -> f64 {
        match self {
            Expression::Number(number) => *number,
            Expression::Name(name) => values.get(*name).copied().unwrap_or(f64::NAN),
            Expression::One(function, x) => function(x.value(values)),
            Expression::Two(function, both) => function(both[0].value(values), both[1].value(values)),
        }
    }
}

fn two(function: fn(f64, f64) -> f64, x: Expression, y: Expression) -> Expression {
    Expression::Two(function, Box::new([x, y]))
}

struct Parser<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
    names: &'t [&'t str],
}

type Parsed = Result<Expression, String>;

impl Parser<'_> {
    fn peek(&mut self) -> Option<u8> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text.as_bytes().get(self.at).copied()
    }

    fn accept(&mut self, mark: u8) -> bool {
        let found = self.peek() == Some(mark);
        self.at += usize::from(found);
        found
    }

    fn expected(&mut self, what: &str) -> String {
        self.peek();
        let rest = &self.text[self.at..];
        let found = if rest.is_empty() { "the end of the expression".into() } else { quoted(rest) };
        format!("expected {what}, found {found}")
    }

    fn sum(&mut self) -> Parsed {
        let mut sum = self.product()?;
        loop {
            if self.accept(b'+') {
                sum = two(|x, y| x + y, sum, self.product()?);
            } else if self.accept(b'-') {
                sum = two(|x, y| x - y, sum, self.product()?);
            } else {
                return Ok(sum);
            }
        }
    }

    fn product(&mut self) -> Parsed {
        let mut product = self.signed()?;
        loop {
            if self.accept(b'*') {
                product = two(|x, y| x * y, product, self.signed()?);
            } else if self.accept(b'/') {
                product = two(|x, y| x / y, product, self.signed()?);
            } else {
                return Ok(product);
            }
        }
    }

    /// Every level of nesting passes here.
    fn signed(&mut self) -> Parsed {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("expected at most {DEEPEST} parentheses or signs inside each other; use `let`"));
        }
        let signed = if self.accept(b'-') {
            Expression::One(|x| -x, Box::new(self.signed()?))
        } else if self.accept(b'+') {
            self.signed()?
        } else {
            let base = self.atom()?;
            if self.accept(b'^') { two(f64::powf, base, self.signed()?) } else { base }
        };
        self.depth -= 1;
        Ok(signed)
    }

    fn atom(&mut self) -> Parsed {
        match self.peek() {
            Some(b'(') => self.arguments().and_then(|arguments| self.only(arguments)),
            Some(byte) if byte.is_ascii_digit() || byte == b'.' => self.number(),
            Some(byte) if byte.is_ascii_alphabetic() || byte == b'_' => self.word(),
            _ => Err(self.expected("a number, a name, a function or `(`")),
        }
    }

    fn number(&mut self) -> Parsed {
        let rest = &self.text[self.at..];
        let digits = |text: &str| text.bytes().take_while(|byte| byte.is_ascii_digit() || *byte == b'.').count();
        let mut length = digits(rest);
        if let Some(exponent) = rest[length..].strip_prefix(['e', 'E']) {
            let sign = usize::from(exponent.starts_with(['-', '+']));
            let count = digits(&exponent[sign..]);
            length += if count > 0 { 1 + sign + count } else { 0 };
        }
        let Ok(number) = rest[..length].parse() else { return Err(self.expected("a number")) };
        self.at += length;
        Ok(Expression::Number(number))
    }

    fn word(&mut self) -> Parsed {
        let rest = &self.text[self.at..];
        let word = &rest[..rest.bytes().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').count()];
        if word == PI {
            self.at += word.len();
            return Ok(Expression::Number(std::f64::consts::PI));
        }
        if let Some(name) = self.names.iter().position(|name| *name == word) {
            self.at += word.len();
            return Ok(Expression::Name(name));
        }
        let Some((name, function)) = FUNCTIONS.iter().find(|(function, _)| *function == word) else {
            return Err(format!("unknown name `{word}`; expected a function, {PI}, or one of {}", self.names.join(", ")));
        };
        self.at += word.len();
        if self.peek() != Some(b'(') {
            return Err(self.expected(&format!("`(` after `{name}`")));
        }
        let mut arguments = self.arguments()?;
        match (function, arguments.pop(), arguments.pop()) {
            (Function::One(function), Some(x), None) => Ok(Expression::One(*function, Box::new(x))),
            (Function::Two(function), Some(y), Some(x)) => Ok(two(*function, x, y)),
            (Function::One(_), ..) => Err(format!("expected one argument of `{name}`, found two")),
            (Function::Two(_), ..) => Err(format!("expected two arguments of `{name}`, found one")),
        }
    }

    /// One or two, in parentheses.
    fn arguments(&mut self) -> Result<Vec<Expression>, String> {
        self.accept(b'(');
        let mut arguments = vec![self.sum()?];
        if self.accept(b',') {
            arguments.push(self.sum()?);
        }
        if self.accept(b')') { Ok(arguments) } else { Err(self.expected("an operator or `)`")) }
    }

    fn only(&mut self, mut arguments: Vec<Expression>) -> Parsed {
        match (arguments.pop(), arguments.pop()) {
            (Some(inner), None) => Ok(inner),
            _ => Err("expected a function's name before `(` with two arguments".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        Expression::parse(text, &["f", "t"]).map_or_else(|error| panic!("{text}: {error}"), |parsed| parsed.value(&[3.0, 0.1]))
    }

    #[test]
    fn operators_bind_as_usual() {
        for (text, expected) in [
            ("f + t", 3.1),
            ("1 - 2 + 3 - 4", -2.0),
            ("2*3/4*5/6", 1.25),
            ("8/4/2", 1.0),
            ("-f^2", -9.0),
            ("(-f)^2", 9.0),
            ("2^3^2 - 512", 0.0),
            ("2^-1", 0.5),
            ("10 - f^2*2 + 1", -7.0),
            ("2*-f", -6.0),
            ("- - + -1", -1.0),
            ("max(0, min(1, max(f, 2)))", 1.0),
            ("fract(0 - f/4)", 0.25),
            ("atan2(0, -1) - PI", 0.0),
            ("1e1 - .5 + 2.5E-1", 9.75),
            ("sin(PI/2) + sqrt(4) + sign(-2)", 2.0),
            ("sign(0) + 2 * sign(-0) + 4 * sign(0.1)", 4.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-12, "{text} is {}", value(text));
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, part) in [
            ("", "expected a number, a name, a function or `(`, found the end of the expression"),
            ("1 +", "found the end"),
            ("1 2", "expected an operator, found `2`"),
            ("(1", "expected an operator or `)`, found the end"),
            ("1)", "expected an operator, found `)`"),
            ("2f", "expected an operator, found `f`"),
            ("g", "unknown name `g`; expected a function, PI, or one of f, t"),
            ("sin f", "expected `(` after `sin`, found `f`"),
            ("sin(f, t)", "expected one argument of `sin`, found two"),
            ("min(f)", "expected two arguments of `min`, found one"),
            ("max(1, 2, 3)", "expected an operator or `)`, found `, 3)`"),
            ("(1, 2)", "expected a function's name"),
            ("1.2.3", "expected a number, found `1.2.3`"),
            ("1e", "expected an operator, found `e`"),
            ("{f}", "found `{f}`"),
            ("f\u{e9}", "expected an operator"),
        ] {
            let error = Expression::parse(text, &["f", "t"]).expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
        }
        for deep in ["(".repeat(51) + "1" + &")".repeat(51), "-".repeat(51) + "1", "2^".repeat(51) + "1"] {
            assert!(Expression::parse(&deep, &[]).unwrap_err().contains("inside each other"));
        }
        assert!(Expression::parse(&"1+".repeat(501), &[]).unwrap_err().contains("at most 1000"));
    }
}
