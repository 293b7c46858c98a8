//! Draws a wireframe face from weights of its action units, in fixed point: sparse morphs, rotations, a camera, lines. There is no heap, no
//! float, no product wider than 32 bits and no division per vertex.
//!
//! # Which type do I want?
//!
//! | task | type |
//! |---|---|
//! | the face itself | [`MODEL`], or [`SMALL`] for small displays, checked by [`Model::new_checked`] |
//! | weights by name, such as `"smile"` or ARKit's `"jawOpen"` | [`Weights::set`]; [`NAMES`] lists the names |
//! | weights from a clip of the `pantin` crate | [`Binding`] |
//! | from weights to vertices | [`Morph`] |
//! | from vertices to a display | [`FaceRenderer`], seen from a [`FaceView`] |
//! | lips for speech, from sound or from visemes with times | [`talk::Talk`] |
//! | what the model consists of | [`curve`], [`shape`], [`model`] |
//!
//! A picture takes three calls: [`Morph::apply`], [`FaceRenderer::project`], [`FaceRenderer::draw`].
//!
//! ```
//! use embedded_graphics::{mock_display::MockDisplay, pixelcolor::BinaryColor};
//! use pantin_face::{FaceRenderer, FaceView, MODEL, Model, Morph, VERTICES, Weight, Weights};
//! use pantin_figure::Canvas;
//!
//! # let mut display = MockDisplay::<BinaryColor>::new();
//! # display.set_allow_overdraw(true);
//! // Any `DrawTarget` of embedded-graphics whose colour is `BinaryColor`, `Gray4`, `Gray8`, `Rgb565` or `Rgb888`.
//! let display: &mut MockDisplay<BinaryColor> = &mut display;
//!
//! let model = Model::new_checked(MODEL)?;
//! let mut morph = Morph::<VERTICES>::new(&model)?;
//! let mut renderer = FaceRenderer::<VERTICES>::new(&model, Canvas { width: 64, height: 64 }, FaceView::default());
//!
//! let mut weights = Weights::new();
//! weights.set(&model, "jawOpen", Weight::lit("0.5"))?;
//! weights.set(&model, "blink_left", Weight::ONE)?;
//!
//! morph.apply(&model, &weights);
//! renderer.project(&model, &morph);
//! renderer.draw(&model, display)?;
//! # assert_ne!(display.affected_area().size.height, 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! On small machines make the large values in a `static` or in place: `Morph::EMPTY` and [`Morph::set_up`], `FaceRenderer::EMPTY` and
//! [`FaceRenderer::set_up`]. A morph takes 6 bytes of RAM for each vertex, a renderer 5 and about 0.5 KB.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod binding;
mod bytes;
mod camera;
mod checked;
mod crossing;
pub mod curve;
mod emotes;
mod error;
mod format;
pub mod model;
mod morph;
mod opening;
mod opening_clip;
mod outline;
mod pen;
mod polygon;
mod projection;
mod renderer;
mod rotate;
pub mod shape;
mod strokes;
pub mod talk;
mod target;
mod vertex;
mod weights;

pub use binding::{BINDINGS, Binding};
pub use camera::FaceView;
pub use emotes::EMOTES;
pub use error::{ModelError, UnknownName};
pub use fixed;
pub use model::{Model, NameEntry, SHAPES};
pub use morph::Morph;
pub use renderer::FaceRenderer;
pub use target::Target;
pub use vertex::Vertex;
pub use weights::{FULL_WEIGHT, Weight, Weights};

/// The model of Pantin's own face, for [`Model::new_checked`]. `pantin face model` writes it; docs/FACE.md describes its units.
pub static MODEL: &[u8] = include_bytes!("../face.model");

/// [`MODEL`] without what canvases of at most [`SMALL_HEIGHT`] rows do not show: there its pictures are the same, and it takes less RAM and time.
/// `pantin face model --small` writes it.
pub static SMALL: &[u8] = include_bytes!("../small.model");

/// Rows of the highest canvas on which [`SMALL`] looks like [`MODEL`]: the face has fewer than 96 pixels.
pub const SMALL_HEIGHT: u16 = 102;

/// A face of filled shapes in two tones for small displays, driven by the same names as [`MODEL`] and by four of its own: `glasses`, `hearts`, `tears` and
/// `sound`. `pantin face model --cartoon` writes it.
pub static CARTOON: &[u8] = include_bytes!("../cartoon.model");

/// A face of two eyes alone, as robots have them: rectangles that blink, look, squint and bend, with the props of [`CARTOON`]. `pantin face model --cartoon
/// eyes` writes it.
pub static EYES: &[u8] = include_bytes!("../eyes.model");

/// A face of few strokes: dots for eyes, brows, and a line for the mouth, with the props of [`CARTOON`]. `pantin face model --cartoon minimal` writes it.
pub static MINIMAL: &[u8] = include_bytes!("../minimal.model");

/// The names that drive Pantin's own face, one per line: its units, sums of units such as `joy` and `viseme_aa`, the blend shapes of ARKit and
/// the facial animation parameters of MPEG-4. docs/FACE.md explains them.
///
/// ```
/// assert!(pantin_face::NAMES.lines().any(|name| name == "smile_left"));
/// ```
pub static NAMES: &str = include_str!("../face.names");

/// Number of vertices for which [`Morph`] and [`FaceRenderer`] need space to hold Pantin's own face (it has 239). Other models may need more.
pub const VERTICES: usize = 240;

/// Like [`VERTICES`], for [`SMALL`].
pub const SMALL_VERTICES: usize = 195;

/// Like [`VERTICES`], for [`CARTOON`].
pub const CARTOON_VERTICES: usize = 97;
