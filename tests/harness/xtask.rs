//! `cargo xtask`: the commands of the repository.

mod bench;
mod cmd;

use std::process::ExitCode;

use clap::Parser;

/// Runs pantin's figures on emulated boards, and tests everything.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
enum Command {
    Conformance(cmd::conformance::Conformance),
    Bench(cmd::bench::Bench),
    Demo(cmd::demo::Demo),
    Firmware(cmd::firmware::Firmware),
    Fuzz(cmd::fuzz::Fuzz),
    Gallery(cmd::gallery::Gallery),
    Sizes(cmd::sizes::Sizing),
    Strips(cmd::strips::Strips),
    Test(cmd::test::Test),
    Uf2(cmd::uf2::Uf2),
    Vectors(cmd::vectors::Vectors),
    Web(cmd::web::Web),
}

fn main() -> ExitCode {
    let result = match Command::parse() {
        Command::Conformance(conformance) => conformance.run(),
        Command::Bench(bench) => bench.run(),
        Command::Demo(demo) => demo.run(),
        Command::Firmware(firmware) => firmware.run(),
        Command::Fuzz(fuzz) => fuzz.run(),
        Command::Gallery(gallery) => gallery.run(),
        Command::Sizes(sizes) => sizes.run(),
        Command::Strips(strips) => strips.run(),
        Command::Test(test) => test.run(),
        Command::Uf2(uf2) => uf2.run(),
        Command::Vectors(vectors) => vectors.run(),
        Command::Web(web) => web.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
