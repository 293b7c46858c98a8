//! `cargo xtask`: the commands of the repository.

mod bench;
mod cmd;

use std::process::ExitCode;

use clap::Parser;

/// Runs pantin's figures on emulated boards, and tests everything.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
enum Command {
    Bench(cmd::bench::Bench),
    Demo(cmd::demo::Demo),
    Test(cmd::test::Test),
}

fn main() -> ExitCode {
    let result = match Command::parse() {
        Command::Bench(bench) => bench.run(),
        Command::Demo(demo) => demo.run(),
        Command::Test(test) => test.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
