//! Measured numbers beside what they should be.

use serde::{Deserialize, Serialize};

use super::table;

/// A row of docs/BENCHMARKS.md: a measured number and its goal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// What was measured.
    pub what: String,
    /// The number, with its unit.
    pub value: String,
    /// What it should be; empty where nothing was set.
    pub goal: String,
    /// Whether it is so.
    pub met: bool,
}

impl Goal {
    /// A number that should be at most `most`, both shown with `digits` decimals and `unit`.
    pub fn at_most(what: impl Into<String>, value: f64, most: f64, digits: usize, unit: &str) -> Self {
        let shown = |number: f64, digits| format!("{number:.digits$} {unit}").trim_end().to_owned();
        let goal = format!("at most {}", format_args!("{most} {unit}")).trim_end().to_owned();
        Self { what: what.into(), value: shown(value, digits), goal, met: value <= most }
    }

    /// A number without a goal.
    pub fn told(what: impl Into<String>, value: impl Into<String>) -> Self {
        Self { what: what.into(), value: value.into(), goal: String::new(), met: true }
    }

    fn verdict(&self) -> String {
        match (self.goal.is_empty(), self.met) {
            (true, _) => String::new(),
            (false, true) => "yes".into(),
            (false, false) => "NO".into(),
        }
    }
}

/// The goals as a table for a terminal.
pub fn print(goals: &[Goal]) {
    let rows: Vec<_> =
        goals.iter().map(|goal| vec![goal.what.clone(), goal.value.clone(), goal.goal.clone(), goal.verdict()]).collect();
    table::print(&["measured", "", "goal", "met"], &rows);
}

/// The goals as a table in Markdown.
pub fn markdown(goals: &[Goal]) -> String {
    let mut text = String::from("| measured | | goal |\n|---|--:|--:|\n");
    for goal in goals {
        let missed = if goal.met { "" } else { " (missed)" };
        text.push_str(&format!("| {} | {} | {}{missed} |\n", goal.what, goal.value, goal.goal));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missed_goal_says_so() {
        let goals = [Goal::at_most("code", 5000.0, 4096.0, 0, "bytes"), Goal::told("poses", "3")];
        assert!(!goals[0].met);
        let expected =
            "| measured | | goal |\n|---|--:|--:|\n| code | 5000 bytes | at most 4096 bytes (missed) |\n| poses | 3 |  |\n";
        assert_eq!(markdown(&goals), expected);
    }
}
