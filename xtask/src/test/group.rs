//! The groups of `cargo xtask test`, and which tests of the harness belong to each.

use anyhow::{Result, bail};

/// A group of checks that runs by itself, so that a machine of CI can take one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// What everybody runs before a commit.
    Daily,
    /// Every board's images in emulators, their sizes, and the decoder on every core.
    Boards,
    /// The decoders and packages of other languages.
    Bindings,
    /// The page and the player in browsers.
    Web,
    /// What a release and its users rely on.
    Packages,
    /// The encoder on captured clips of others.
    Captures,
}

impl Group {
    /// All groups.
    pub const ALL: [Group; 6] = [Group::Daily, Group::Boards, Group::Bindings, Group::Web, Group::Packages, Group::Captures];

    /// The group's option on the command line; the daily one has none.
    pub fn option(self) -> &'static str {
        match self {
            Group::Daily => "",
            Group::Boards => "--boards",
            Group::Bindings => "--bindings",
            Group::Web => "--web",
            Group::Packages => "--packages",
            Group::Captures => "--captures",
        }
    }

    /// The groups that options name: the daily one without any.
    pub fn named(options: &[String]) -> Result<Vec<Group>> {
        if options.iter().any(|option| option == "--all") {
            return Ok(Group::ALL.to_vec());
        }
        let mut groups = Vec::new();
        for option in options {
            match Group::ALL.into_iter().find(|group| group.option() == option && !option.is_empty()) {
                Some(group) => groups.push(group),
                None => bail!("no option is called {option}"),
            }
        }
        groups.sort_unstable();
        groups.dedup();
        Ok(if groups.is_empty() { vec![Group::Daily] } else { groups })
    }

    /// The arguments with which the harness' `suites` runs this group's tests; `None` where it has none.
    pub fn suites(self) -> Option<Vec<String>> {
        let chosen = |names: &[&str]| Some(names.iter().map(|name| (*name).to_owned()).collect());
        match self {
            Group::Daily => chosen(&DAILY),
            Group::Web => chosen(&WEB),
            // Whatever no other group takes.
            Group::Boards => Some(DAILY.iter().chain(&WEB).flat_map(|name| ["--skip".into(), (*name).into()]).collect()),
            Group::Bindings | Group::Packages | Group::Captures => None,
        }
    }
}

/// Tests of the format and of whatever runs on the host, and one emulated board of each architecture (Cortex-M3, Cortex-M0, RISC-V and ARM9): the
/// beginnings of their names.
const DAILY: [&str; 16] = [
    "conformance::a_decoder_written_from_the_format_alone",
    "conformance::the_decoder_for_the_web",
    "conformance::the_tables_of_the_decoder_for_the_web",
    "conformance::this_host",
    "differential::",
    "display::lm3s6965evb_plays_all_clips",
    "display::microbit_plays_all_clips",
    "display::riscv_virt_plays_all_clips",
    "display::sx1_plays_all_clips",
    "hostile::",
    "independent::",
    "laws::",
    "qemu::",
    "soak::",
    "steered::the_record",
    "vectors::",
];

/// A part of the names of the host tool's tests that convert captured clips: they take as long as a quarter of the other ones.
pub const CAPTURED: &str = "captured";

/// Tests that need a browser or the page's modules.
const WEB: [&str; 2] = ["web::", "conformance::webassembly"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_test_of_the_suites_is_in_one_group() {
        // libtest takes a name that has the filter anywhere: no filter of one group may be part of another's.
        for daily in DAILY {
            assert!(WEB.iter().all(|web| !web.contains(daily) && !daily.contains(web)), "{daily}");
        }
        let skipped: Vec<String> = Group::Boards.suites().unwrap().into_iter().filter(|word| word != "--skip").collect();
        let taken: Vec<String> = [Group::Daily, Group::Web].into_iter().filter_map(Group::suites).flatten().collect();
        assert_eq!(skipped, taken);
    }

    #[test]
    fn options_name_groups() {
        let named = |options: &[&str]| Group::named(&options.iter().map(|option| (*option).to_owned()).collect::<Vec<_>>());
        assert_eq!(named(&[]).unwrap(), [Group::Daily]);
        assert_eq!(named(&["--web", "--boards", "--web"]).unwrap(), [Group::Boards, Group::Web]);
        assert_eq!(named(&["--all"]).unwrap(), Group::ALL);
        assert!(named(&["--board"]).is_err() && named(&[""]).is_err());
    }
}
