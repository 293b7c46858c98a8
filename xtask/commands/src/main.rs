//! The commands of `cargo xtask` that need the harness or the host tool.

mod arduino;
mod bench;
mod bindings;
mod blender;
mod campaign;
mod conformance;
mod downloads;
mod esp_idf;
mod esphome;
mod firmware;
mod fuzz;
mod gallery;
mod gba;
mod images;
mod independent;
mod log;
mod micropython;
mod packed;
mod sizes;
mod strips;
mod train;
mod uf2;
mod vectors;
mod wheels;

use std::process::ExitCode;

use clap::Parser;

/// Runs pantin's figures on emulated boards, and tests everything.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
enum Command {
    Arduino(arduino::Arduino),
    Conformance(conformance::Conformance),
    Bench(bench::command::Bench),
    Bindings(bindings::Bindings),
    Blender(blender::Blender),
    Coverage(campaign::Coverage),
    EspIdf(esp_idf::EspIdf),
    Esphome(esphome::Esphome),
    Firmware(firmware::Firmware),
    Fuzz(fuzz::Fuzz),
    Gallery(gallery::Gallery),
    Gba(gba::Gba),
    Images(downloads::Images),
    Independent(independent::Independent),
    #[command(hide = true)]
    Log(log::Log),
    Micropython(micropython::Micropython),
    Miri(campaign::Miri),
    MutantsDifferential(campaign::MutantsDifferential),
    Mutation(campaign::Mutation),
    Sizes(sizes::Sizing),
    Soak(campaign::Soak),
    Strips(strips::Strips),
    Train(train::Train),
    Uf2(uf2::Uf2),
    Vectors(vectors::Vectors),
    Wheels(wheels::Wheels),
}

fn main() -> ExitCode {
    let result = match Command::parse() {
        Command::Arduino(arduino) => arduino.run(),
        Command::Conformance(conformance) => conformance.run(),
        Command::Bench(bench) => bench.run(),
        Command::Bindings(bindings) => bindings.run(),
        Command::Blender(blender) => blender.run(),
        Command::Coverage(coverage) => coverage.run(),
        Command::EspIdf(component) => component.run(),
        Command::Esphome(esphome) => esphome.run(),
        Command::Firmware(firmware) => firmware.run(),
        Command::Fuzz(fuzz) => fuzz.run(),
        Command::Gallery(gallery) => gallery.run(),
        Command::Gba(gba) => gba.run(),
        Command::Images(images) => images.run(),
        Command::Independent(independent) => independent.run(),
        Command::Log(log) => log.run(),
        Command::Micropython(micropython) => micropython.run(),
        Command::Miri(miri) => miri.run(),
        Command::MutantsDifferential(differential) => differential.run(),
        Command::Mutation(mutation) => mutation.run(),
        Command::Sizes(sizes) => sizes.run(),
        Command::Soak(soak) => soak.run(),
        Command::Strips(strips) => strips.run(),
        Command::Train(train) => train.run(),
        Command::Uf2(uf2) => uf2.run(),
        Command::Vectors(vectors) => vectors.run(),
        Command::Wheels(wheels) => wheels.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
