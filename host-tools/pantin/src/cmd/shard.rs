//! `--shard I/N`: a part of many files, for one of several machines.

use anyhow::{Context, Result, ensure};

/// The part that one of several runs converts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 0.
    index: usize,
    count: usize,
}

/// Reads `I/N`, with I from 1 to N.
pub fn parse(text: &str) -> Result<Shard> {
    let numbers = || -> Option<[usize; 2]> {
        let (index, count) = text.split_once('/')?;
        Some([index.parse().ok()?, count.parse().ok()?])
    };
    let [index, count] = numbers().context("expected I/N, as in 1/8")?;
    ensure!((1..=count).contains(&index), "expected I/N with I from 1 to N");
    Ok(Shard { index: index - 1, count })
}

impl Shard {
    /// Every N-th of the items, in their order: neighbours often take equally long.
    pub fn of<T>(self, items: Vec<T>) -> Vec<T> {
        items.into_iter().skip(self.index).step_by(self.count).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_in_one_shard() {
        for count in [1, 2, 3, 7, 20] {
            let shards = (1..=count).map(|index| parse(&format!("{index}/{count}")).unwrap().of((0..10).collect()));
            let mut all: Vec<usize> = shards.flatten().collect();
            all.sort_unstable();
            assert_eq!(all, (0..10).collect::<Vec<_>>());
        }
        assert_eq!(parse("2/3").unwrap().of((0..10).collect()), [1, 4, 7]);
    }

    #[test]
    fn other_texts_are_refused() {
        for text in ["", "1", "0/3", "4/3", "1/0", "0/0", "-1/3", "1/3/5", "a/b", "1/"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
