//! The nodes of a world and its routes. What a field's type is nobody needs to know: numbers, words and nodes tell themselves apart.
//!
//! A prototype is known by the first node of its body, whose fields its interface names; the rest of the body is passed over.

use super::lexer::{Word, Words, shown};
use super::world::{Node, Prototype, Route, Value, World};
use crate::import::one_line;
use anyhow::{Result, bail};
use std::collections::{BTreeMap, HashMap, btree_map};

/// Nodes and prototypes in each other.
const DEEPEST: usize = 200;
/// Fields of one node: those of the standard have at most 50.
const MOST_FIELDS: usize = 256;
/// No length, angle or time of a real world comes near it.
const LARGEST: f64 = 1e9;

/// Reads the world.
pub fn world(mut words: Words) -> Result<World> {
    let mut parser = Parser { world: World::default(), depth: 0, open: Vec::new(), parts: BTreeMap::new() };
    let mut roots = Vec::new();
    while words.peek().is_some() {
        if let Some(node) = parser.statement(&mut words)? {
            roots.push(node);
        }
    }
    if let Some((kind, line)) = parser.endless() {
        bail!(words.error_at(line, format!("the prototype `{}` contains itself", one_line(&kind))));
    }
    parser.world.roots = roots;
    Ok(parser.world)
}

struct Parser {
    world: World,
    depth: usize,
    /// Names of the prototypes whose bodies are being read, the innermost last.
    open: Vec<String>,
    /// Types of the nodes in a prototype's body, each with the line of its first node, by the prototype's name.
    parts: BTreeMap<String, BTreeMap<String, usize>>,
}

fn plain<'a>(words: &mut Words<'a>, what: &str) -> Result<&'a [u8]> {
    match words.next() {
        Some(Word::Plain(word)) => Ok(word),
        other => bail!(words.error(format!("expected {what}, found {}", shown(other)))),
    }
}

fn name(words: &mut Words, what: &str) -> Result<String> {
    plain(words, what).map(|word| String::from_utf8_lossy(word).into_owned())
}

fn mark(words: &mut Words, wanted: u8, why: &str) -> Result<()> {
    match words.next() {
        Some(Word::Mark(found)) if found == wanted => Ok(()),
        other => bail!(words.error(format!("expected `{}` {why}, found {}", wanted as char, shown(other)))),
    }
}

/// Passes over everything up to the end of the bracket that was just opened.
fn pass(words: &mut Words) -> Result<()> {
    let (line, mut open) = (words.line(), 1);
    while open > 0 {
        match words.next() {
            Some(Word::Mark(b'{' | b'[')) => open += 1,
            Some(Word::Mark(_)) => open -= 1,
            Some(_) => {}
            None => bail!(words.error_at(line, "the bracket that opens here is never closed")),
        }
    }
    Ok(())
}

fn number(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    // Words like `inf` and `nan` are names here.
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text).starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let hexadecimal = text.strip_prefix("0x").or(text.strip_prefix("0X"));
    hexadecimal
        .and_then(|digits| u32::from_str_radix(digits, 16).ok())
        .map(f64::from)
        .or_else(|| text.parse().ok().filter(|_| digits))
}

impl Parser {
    /// A node at the top, or a statement that is none.
    fn statement(&mut self, words: &mut Words) -> Result<Option<usize>> {
        match words.peek() {
            Some(Word::Plain(b"PROFILE" | b"COMPONENT")) => {
                words.next();
                plain(words, "its name")?;
                Ok(None)
            }
            Some(Word::Plain(b"META")) => {
                words.next();
                while matches!(words.peek(), Some(Word::Text(_))) {
                    words.next();
                }
                Ok(None)
            }
            Some(Word::Plain(b"UNIT")) => {
                words.next();
                ["a quantity", "a unit's name", "a factor"].into_iter().try_for_each(|what| plain(words, what).map(drop))?;
                Ok(None)
            }
            Some(Word::Plain(b"IMPORT" | b"EXPORT")) => {
                words.next();
                plain(words, "a name")?;
                if words.peek() == Some(Word::Plain(b"AS")) {
                    words.next();
                    plain(words, "a name")?;
                }
                Ok(None)
            }
            Some(Word::Plain(b"PROTO" | b"EXTERNPROTO" | b"ROUTE")) => self.declaration(words).map(|()| None),
            _ => self.node(words),
        }
    }

    fn declaration(&mut self, words: &mut Words) -> Result<()> {
        match plain(words, "a declaration")? {
            b"ROUTE" => self.route(words),
            b"PROTO" => self.prototype(words),
            _ => {
                name(words, "a prototype's name")?;
                mark(words, b'[', "after a prototype's name")?;
                pass(words)?;
                if words.peek() == Some(Word::Mark(b'[')) {
                    words.next();
                    return pass(words);
                }
                words.next();
                Ok(())
            }
        }
    }

    fn route(&mut self, words: &mut Words) -> Result<()> {
        let line = words.line();
        let from = name(words, "a node and its event")?;
        let to = plain(words, "`TO`")?;
        let into = name(words, "a node and its event")?;
        let (Some((from, _)), Some((into, event)), b"TO") = (from.split_once('.'), into.split_once('.'), to) else {
            bail!(words.error_at(line, "expected `ROUTE node.event TO node.event`"));
        };
        let [source, target] = [from, into].map(|name| self.world.names.get(name).copied());
        let route = Route { source: (source, from.into()), target: (target, into.into()), event: event.into() };
        self.world.routes.push(route);
        Ok(())
    }

    fn prototype(&mut self, words: &mut Words) -> Result<()> {
        let kind = name(words, "a prototype's name")?;
        mark(words, b'[', "after a prototype's name")?;
        // Names of the body are its own, and its routes move every instance alike.
        let outside = (std::mem::take(&mut self.world.names), self.world.routes.len());
        self.deeper(words)?;
        self.open.push(kind.clone());
        let interface = self.fields(words, b']')?;
        mark(words, b'{', "before a prototype's body")?;
        let mut first = None;
        while words.peek() != Some(Word::Mark(b'}')) {
            if words.peek().is_none() {
                bail!(words.error(format!("the body of the prototype `{kind}` never ends")));
            }
            let node = self.statement(words)?;
            first = first.or(node);
        }
        words.next();
        self.depth -= 1;
        self.open.pop();
        self.world.names = outside.0;
        self.world.routes.truncate(outside.1);
        if let Some(first) = first {
            self.world.prototypes.insert(kind, Prototype { interface, first });
        }
        Ok(())
    }

    /// A node, a `USE` of one, or `NULL`.
    fn node(&mut self, words: &mut Words) -> Result<Option<usize>> {
        let word = name(words, "a node")?;
        match word.as_str() {
            "NULL" => return Ok(None),
            "USE" => {
                let used = name(words, "a name")?;
                return match self.world.names.get(&used) {
                    Some(&node) => Ok(Some(node)),
                    None => bail!(words.error(format!("USE of `{used}`, which no DEF before it names"))),
                };
            }
            _ => {}
        }
        let (def, kind) = match word.as_str() {
            "DEF" => (Some(name(words, "a name")?), name(words, "a node's type")?),
            _ => (None, word),
        };
        let line = words.line();
        mark(words, b'{', "after a node's type")?;
        self.deeper(words)?;
        if let Some(open) = self.open.last() {
            let parts = self.parts.entry(open.clone()).or_default();
            parts.entry(kind.clone()).or_insert(line);
        }
        let node = self.world.nodes.len();
        self.world.nodes.push(Node { kind, def: def.clone(), line, fields: Vec::new() });
        if let Some(def) = def {
            self.world.names.insert(def, node);
        }
        self.world.nodes[node].fields = self.fields(words, b'}')?;
        self.depth -= 1;
        Ok(Some(node))
    }

    /// A prototype whose instance would have another instance of it inside, and the line of a node that makes it so.
    fn endless(&self) -> Option<(String, usize)> {
        // Prototypes are followed depth first; those on the way are `false`, those that end are `true`.
        let mut ends: HashMap<&str, bool> = HashMap::new();
        for kind in self.parts.keys() {
            let mut way: Vec<(&str, btree_map::Iter<String, usize>)> = Vec::new();
            let mut next = (!ends.contains_key(kind.as_str())).then_some(kind.as_str());
            loop {
                if let Some(parts) = next.and_then(|kind| Some((kind, self.parts.get(kind)?))) {
                    ends.insert(parts.0, false);
                    way.push((parts.0, parts.1.iter()));
                }
                let Some((last, parts)) = way.last_mut() else { break };
                next = match parts.next() {
                    Some((part, &line)) => match ends.get(part.as_str()) {
                        Some(false) => return Some((part.clone(), line)),
                        Some(true) => None,
                        None => Some(part),
                    },
                    None => {
                        ends.insert(last, true);
                        way.pop();
                        None
                    }
                };
            }
        }
        None
    }

    fn deeper(&mut self, words: &Words) -> Result<()> {
        self.depth += 1;
        if self.depth > DEEPEST {
            bail!(words.error(format!("more than {DEEPEST} nodes in each other")));
        }
        Ok(())
    }

    /// Fields with their values up to the bracket `end`.
    fn fields(&mut self, words: &mut Words, end: u8) -> Result<Vec<(String, Value)>> {
        let line = words.line();
        let mut fields = Vec::new();
        loop {
            if fields.len() > MOST_FIELDS {
                bail!(words.error_at(line, format!("more than {MOST_FIELDS} fields")));
            }
            match words.peek() {
                Some(Word::Mark(found)) if found == end => break,
                None => bail!(words.error_at(line, "the bracket that opens here is never closed")),
                Some(Word::Plain(b"PROTO" | b"EXTERNPROTO" | b"ROUTE")) => self.declaration(words)?,
                Some(Word::Plain(b"eventIn" | b"eventOut" | b"inputOnly" | b"outputOnly")) => {
                    words.next();
                    name(words, "an event's type")?;
                    let event = name(words, "an event's name")?;
                    if words.peek() == Some(Word::Plain(b"IS")) {
                        fields.push((event, self.value(words)?));
                    }
                }
                Some(Word::Plain(b"field" | b"exposedField" | b"initializeOnly" | b"inputOutput")) => {
                    words.next();
                    name(words, "a field's type")?;
                }
                _ => {
                    let field = name(words, "a field")?;
                    fields.push((field, self.value(words)?));
                }
            }
        }
        words.next();
        Ok(fields)
    }

    fn value(&mut self, words: &mut Words) -> Result<Value> {
        let mut value = Value { line: words.line(), ..Value::default() };
        match words.peek() {
            Some(Word::Mark(b'[')) => {
                words.next();
                while words.peek() != Some(Word::Mark(b']')) {
                    if words.peek().is_none() {
                        bail!(words.error_at(value.line, "the list that begins here never ends"));
                    }
                    self.element(words, &mut value)?;
                }
                words.next();
            }
            Some(Word::Plain(b"IS")) => {
                words.next();
                value.is = Some(name(words, "a field of the prototype")?);
            }
            Some(Word::Plain(word)) if number(word).is_some() => {
                while matches!(words.peek(), Some(Word::Plain(word)) if number(word).is_some()) {
                    self.element(words, &mut value)?;
                }
            }
            Some(Word::Plain(_) | Word::Text(_)) => self.element(words, &mut value)?,
            _ => {}
        }
        Ok(value)
    }

    fn element(&mut self, words: &mut Words, value: &mut Value) -> Result<()> {
        match words.peek() {
            Some(Word::Text(_)) => {
                words.next();
            }
            Some(Word::Plain(word)) => match number(word) {
                Some(number) => {
                    words.next();
                    if number.is_nan() || number.abs() > LARGEST {
                        bail!(words.error(format!(
                            "expected a number of at most {LARGEST:e}, found {}",
                            shown(Some(Word::Plain(word)))
                        )));
                    }
                    value.numbers.push(number);
                }
                None => {
                    let mut ahead = words.clone();
                    ahead.next();
                    let named = matches!(word, b"USE" | b"DEF" | b"NULL");
                    if named || ahead.next() == Some(Word::Mark(b'{')) {
                        value.nodes.extend(self.node(words)?);
                    } else if word == b"ROUTE" {
                        self.declaration(words)?;
                    } else {
                        words.next();
                    }
                }
            },
            other => bail!(words.error(format!("expected a value, found {}", shown(other)))),
        }
        Ok(())
    }
}
