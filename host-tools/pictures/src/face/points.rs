//! Feature points of a mesh, by MPEG-4 number: our text, or the `.fdp` of xface.

use anyhow::{Context, Result, ensure};
use std::collections::HashMap;

/// Feature points: the number, such as `8.3`, and the index of a vertex from 0.
pub type Points = HashMap<String, usize>;

/// The number of feature points of each group, from group 2 on (ISO/IEC 14496-2, annex C).
const GROUPS: [u8; 10] = [14, 14, 6, 4, 4, 1, 10, 15, 10, 6];

/// Parses the content of a file of either kind.
pub fn parse(text: &str) -> Result<Points> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.contains("<xfdp") { fdp(text) } else { own(text) }
}

/// Lines of a feature point's number and a vertex, counted from 0; `#` begins a comment.
fn own(text: &str) -> Result<Points> {
    let mut points = Points::new();
    for (number, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
        let place = || format!("line {}", number + 1);
        match words[..] {
            [] => {}
            [name, vertex] => {
                ensure!(is_number(name), "{}: {name} is no number of an MPEG-4 feature point, 2.1 to 11.6", place());
                let vertex = vertex.parse().with_context(|| format!("{}: {vertex} is no vertex", place()))?;
                ensure!(points.insert(name.into(), vertex).is_none(), "{}: {name} is given twice", place());
            }
            _ => anyhow::bail!("{}: expected a number such as 8.3, and a vertex", place()),
        }
    }
    ensure!(!points.is_empty(), "no feature points");
    Ok(points)
}

fn is_number(name: &str) -> bool {
    let numbers = |(group, number): (&str, &str)| Some((group.parse::<u8>().ok()?, number.parse::<u8>().ok()?));
    let Some((group, number)) = name.split_once('.').and_then(numbers) else { return false };
    let count = GROUPS.get(usize::from(group).wrapping_sub(2));
    // Written as the rules look it up.
    count.is_some_and(|count| (1..=*count).contains(&number)) && name == format!("{group}.{number}")
}

/// The points of an `.fdp` that lie on the part of the mesh that most of them lie on: the others' vertices are counted in parts of their own.
fn fdp(text: &str) -> Result<Points> {
    let mut parts: HashMap<&str, Points> = HashMap::new();
    for element in text.split("<fdp ").skip(1) {
        let tag = element.split('>').next().unwrap_or("");
        let value = |name: &str| tag.split_once(&format!("{name}=\""))?.1.split('"').next();
        let (name, index) = (value("name").context("an fdp without a name")?, value("index").context("an fdp without an index")?);
        let vertex = index.parse().with_context(|| format!("{name}: {index} is no vertex"))?;
        parts.entry(value("affects").unwrap_or("")).or_default().entry(name.into()).or_insert(vertex);
    }
    parts.into_values().max_by_key(|points| points.len()).context("no feature points")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_formats_are_read() {
        let own = parse("# a mouth\n8.3 12 # left\n\n8.4 13\n").unwrap();
        assert_eq!((own["8.3"], own["8.4"], own.len()), (12, 13, 2));
        let text = "<xfdp><fdp affects=\"skin\" index=\"35\" name=\"8.3\"><indices>1 2</indices></fdp>\
            <fdp affects=\"teeth\" index=\"0\" name=\"2.1\"/><fdp affects=\"skin\" index=\"7\" name=\"2.1\"/></xfdp>";
        let fdp = parse(text).unwrap();
        assert_eq!((fdp["8.3"], fdp["2.1"], fdp.len()), (35, 7, 2));
        for (text, wanted) in [
            ("8.3", "line 1"),
            ("8.3 1\n99.3 1", "line 2: 99.3 is no"),
            ("2.15 3", "2.15 is no"),
            ("08.3 3", "08.3 is no"),
            ("1.1 3", "MPEG-4"),
            ("8.3 x", "no vertex"),
            ("lip 3", "MPEG-4"),
            ("8.3 1\n8.3 2", "twice"),
            ("", "no feature"),
        ] {
            let error = format!("{:#}", parse(text).unwrap_err());
            assert!(error.contains(wanted), "{text}: {error}");
        }
    }
}
