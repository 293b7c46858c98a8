//! Converts a motion to a clip while the program is built.

use pantin_build::{Length, Options, Recipe};

fn main() -> Result<(), pantin_build::Error> {
    let recipe = Recipe::new().options(Options::new().max_error(Length::cm(1.0)));
    pantin_build::clip("../../motions/walk.keys").recipe(recipe).emit()
}
