//! A clip's figure, or its face, before one camera or several.

use super::scene::Scene;
use super::smooth;
use crate::face::cast::{Cast, drives};
use anyhow::{Context, Result};
use pantin::{ChannelState, Clip, Player};
use pantin_face::Model;
use pantin_figure::solid::{Build, Look, SolidFigure};
use pantin_figure::{Canvas, RIG_JOINTS, View};
use pantin_images::image::Image;
use pantin_images::palette::Palette;
use pantin_images::shades::Shades;

/// Most columns and rows of a picture made of a display's pixels: the figure's places have 16 bits, four of them below the pixel.
pub const MOST_PIXELS: usize = 1024;

/// How lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStyle {
    /// One pixel wide, as the firmware draws on a display.
    Pixels,
    /// Smooth, thicker the nearer.
    Smooth,
}

/// What a body is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line for each bone.
    Lines,
    /// A body with volume.
    Solid(Look, FacePlace),
}

/// Where the face of a clip with a body and a face is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacePlace {
    /// Beside the body.
    Beside,
    /// On the body's head, if it is a person's.
    Neck,
}

/// Pixels of a side of the larger picture that is reduced to a smooth one.
const REDUCED_FROM: usize = 1024;
/// Most pixels of a side that become one.
const MOST_REDUCED: usize = 4;

/// The memory of a player.
pub struct PlayerBuffers {
    states: Vec<ChannelState>,
    pose: Vec<i32>,
}

impl PlayerBuffers {
    /// Allocates what `clip` needs.
    pub fn of(clip: &Clip) -> PlayerBuffers {
        PlayerBuffers { states: vec![ChannelState::default(); clip.moving()], pose: vec![0; clip.rig().channels()] }
    }

    /// A player at frame 0.
    pub fn player<'a, 'm>(&'m mut self, clip: Clip<'a>) -> Result<Player<'a, 'm>> {
        Ok(Player::new(clip, &mut self.states, &mut self.pose)?)
    }
}

/// Draws the figure of one frame after another, each view by its own camera.
pub struct Figure<'a, 'm> {
    player: Player<'a, 'm>,
    /// One for each view; none if the clip has no body.
    bodies: Vec<SolidFigure<RIG_JOINTS>>,
    face: Option<Box<Cast<'a>>>,
    /// Whether the face is on the body's head.
    on_neck: bool,
    size: [usize; 2],
    factor: usize,
    style: Style,
    /// Pixels that solid figures are drawn with for a pixel of the picture.
    finer: usize,
}

impl<'a, 'm> Figure<'a, 'm> {
    /// Sets up the cameras for pictures of `size` (columns, rows). `model` is the face that the clip drives.
    pub fn new(
        mut player: Player<'a, 'm>,
        size: [usize; 2],
        views: &[View],
        model: Model<'a>,
        (style, lines): (Style, LineStyle),
    ) -> Result<Figure<'a, 'm>> {
        let longest = size[0].max(size[1]);
        let factor = longest.div_ceil(MOST_PIXELS);
        let finer = match (style, lines) {
            (Style::Solid(..), LineStyle::Smooth) => (REDUCED_FROM / longest).clamp(1, MOST_REDUCED),
            _ => 1,
        };
        let [width, height] = size.map(|pixels| (pixels * finer).div_ceil(factor) as u16);
        let canvas = Canvas { width, height };
        let has_body = player.clip().rig().joint_count() > 0;
        // From where a body is seen by default, its face looks straight ahead, as in the firmware.
        let ahead = |view: &View| (view.orbit, view.tilt) == (View::default().orbit, View::default().tilt);
        let face_view = |view: &View| if has_body && ahead(view) { View { orbit: 0, tilt: 0, ..*view } } else { *view };
        let face_views: Vec<View> = views.iter().map(face_view).collect();
        let has_face = drives(player.clip(), &model);
        let (look, on_neck) = match style {
            Style::Solid(look, place) => (look, place == FacePlace::Neck && has_body && has_face),
            Style::Lines => (Look::DEFAULT, false),
        };
        let mut bodies_in = |area: Canvas, on_neck: bool| {
            let mut body_of = |view: &View| {
                let mut body = SolidFigure::of_clip(&mut player, area, *view, look).context(
                    "this figure cannot be drawn; `pantin convert --retarget display` makes a clip of its motion that can be",
                )?;
                if style == Style::Lines || on_neck {
                    body.make_room(style != Style::Lines);
                    body.set_bare_face(on_neck);
                    body.aim(&mut player, *view);
                }
                anyhow::Ok(body)
            };
            if has_body { views.iter().map(&mut body_of).collect::<Result<Vec<_>>>() } else { Ok(Vec::new()) }
        };
        if on_neck {
            let bodies = bodies_in(canvas, true)?;
            if bodies.iter().all(|body| body.build() == Build::Person) {
                let face = Cast::on_heads(model, player.clip(), &bodies)?.map(Box::new);
                return Ok(Figure { player, bodies, face, on_neck, size, factor, style, finer });
            }
        }
        let area = if has_face { canvas.with_face().body } else { canvas };
        let bodies = bodies_in(area, false)?;
        let face = Cast::of_model(model, player.clip(), canvas, &face_views)?.map(Box::new);
        Ok(Figure { player, bodies, face, on_neck: false, size, factor, style, finer })
    }

    /// Whether the face is on the body's head.
    pub fn is_face_on_neck(&self) -> bool {
        self.on_neck
    }

    /// What a solid figure is drawn as; none of a clip without joints.
    pub fn build(&self) -> Option<Build> {
        self.bodies.first().map(SolidFigure::build)
    }

    /// Goes to a frame.
    pub fn seek(&mut self, frame: u32) {
        self.player.seek(frame);
    }

    /// The frame as a view's camera sees it.
    pub fn scene(&mut self, view: usize) -> Scene {
        let (factor, pose) = (self.factor as f32, self.player.pose());
        let mut scene = self.bodies.get_mut(view).map_or_else(Scene::default, |body| Scene::of(body.lines(), pose, factor));
        if let Some(cast) = &mut self.face {
            // The canvas is rounded up to whole pixels of the display.
            let [width, height] = self.size.map(|pixels| pixels as f32);
            let side = (f32::from(cast.side()) * factor).min(width).min(height);
            scene.add_face(&cast.lines(pose.values, view), factor, side);
        }
        scene
    }

    /// The same as a picture. Pixels are at most [`MOST_PIXELS`] a side.
    pub fn image(&mut self, view: usize, look: LineStyle, palette: &Palette) -> Image {
        let [width, height] = self.size;
        if self.style != Style::Lines {
            return self.solid_image(view, look, palette);
        }
        match look {
            LineStyle::Smooth => smooth::draw(&self.scene(view), width, height, palette),
            LineStyle::Pixels => {
                let mut shades = Shades::new(width, height);
                if let Some(body) = self.bodies.get_mut(view) {
                    shades.draw(body.lines(), self.player.pose(), true, palette.is_mono());
                }
                if let Some(cast) = &mut self.face {
                    shades.draw_lines(&cast.lines(self.player.pose().values, view), palette.is_mono());
                }
                shades.image(palette)
            }
        }
    }
    /// A picture of the solid figure: a smooth one is drawn larger and reduced.
    fn solid_image(&mut self, view: usize, look: LineStyle, palette: &Palette) -> Image {
        let [width, height] = self.size;
        let [columns, rows] = self.size.map(|pixels| (pixels * self.finer).div_ceil(self.factor));
        let mut shades = Shades::new(columns, rows);
        let (pose, depth) = (self.player.pose(), palette.depth());
        match (self.bodies.get_mut(view), &mut self.face) {
            (Some(body), Some(cast)) if self.on_neck => {
                shades.draw_solid_with(body, pose, true, depth, &mut cast.on_head(pose.values, view));
            }
            (Some(body), _) => shades.draw_solid(body, pose, true, depth),
            (None, _) => {}
        }
        if let Some(cast) = self.face.as_mut().filter(|_| !self.on_neck) {
            shades.draw_lines(&cast.lines(self.player.pose().values, view), palette.is_mono());
        }
        let image = shades.image(palette);
        match look {
            LineStyle::Smooth if self.finer > 1 => image.reduced(self.finer),
            _ if self.factor > 1 => image.enlarged(self.factor).cropped(width, height),
            _ => image,
        }
    }
}
