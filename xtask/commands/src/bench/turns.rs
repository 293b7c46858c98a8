//! Guest instructions of reading a pose: a joint by its name, its angles, its place, and all places.

use std::path::Path;

use anyhow::{Result, ensure};
use harness::qemu::{LM3S6965EVB, MICROBIT, Machine};

use super::guest::Guest;
use super::{Goal, table};
use xtask::steps::say;

/// What the first regions of `turns` in `firmware/testsuite` measure, in their order.
const CALLS: [&str; 7] = [
    "find a joint by its name",
    "its rotation (Pose::turn)",
    "its angles in its own order",
    "the place of the toes, JointChain::locate",
    "set up Kinematics",
    "the place of the toes, Kinematics::place",
    "all places, Kinematics::set_pose",
];

/// The forms of the rotations of which the other regions measure angles in another order and the whole angle, in turn.
const FORMS: [&str; 3] = ["Euler angles", "an exponential map", "a quaternion"];

/// The most instructions that a processor should take.
struct Most {
    euler: f64,
    angle: f64,
    place: f64,
    places: f64,
}

const MACHINES: [(&str, Machine, Option<Most>); 2] = [
    ("Cortex-M0", MICROBIT, None),
    ("Cortex-M3", LM3S6965EVB, Some(Most { euler: 1500.0, angle: 1200.0, place: 3000.0, places: 12_000.0 })),
];

/// Reads the pose in the middle of our walk, and rotations of every form.
pub fn run(walk: &Path) -> Result<Vec<Goal>> {
    let mut columns = vec![];
    let mut goals = vec![];
    for (core, machine, most) in MACHINES {
        let counts = Guest::new(machine, "turns")?.counts(Some(walk))?;
        ensure!(counts.len() > CALLS.len(), "{} regions: expected more than {}", counts.len(), CALLS.len());
        let (calls, turns) = counts.split_at(CALLS.len());
        // The worst of all rotations, for each form and call.
        let worst = |at: usize| turns.iter().skip(at).step_by(2 * FORMS.len()).copied().max().unwrap_or(0);
        let numbers = [calls, &(0..2 * FORMS.len()).map(worst).collect::<Vec<_>>()].concat();
        if let Some(most) = most {
            let worst = |at: usize| (0..FORMS.len()).map(|form| numbers[CALLS.len() + 2 * form + at]).max().unwrap_or(0) as f64;
            let what = |what: &str| format!("{core}: instructions of {what}");
            goals.extend([
                Goal::at_most(what("Euler angles in another order, worst form"), worst(0), most.euler, 0, ""),
                Goal::at_most(what("the whole angle, worst form"), worst(1), most.angle, 0, ""),
                Goal::at_most(what("the place of the toes of our walk"), numbers[5] as f64, most.place, 0, ""),
                Goal::at_most(what("the places of all joints of our walk"), numbers[6] as f64, most.places, 0, ""),
            ]);
        }
        columns.push(numbers);
    }
    say("   instructions of reading a pose of our walk, and rotations of each form, the worst of six");
    let of_form = |form: &&str| [format!("angles in another order, of {form}"), format!("the whole angle, of {form}")];
    let names = CALLS.iter().map(|name| (*name).to_owned()).chain(FORMS.iter().flat_map(of_form));
    let rows: Vec<_> = names
        .enumerate()
        .map(|(row, name)| [vec![name], columns.iter().map(|own| own[row].to_string()).collect()].concat())
        .collect();
    table::print(&["call", MACHINES[0].0, MACHINES[1].0], &rows);
    Ok(goals)
}
