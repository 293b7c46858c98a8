//! The solid figure: a body with volume, made of tapered capsules with an outline, a head that looks somewhere, and a shadow.
//!
//! [`SolidFigure`] stands beside [`FigureRenderer`], and has one: camera, poses and floor are the same, so that a program can change from one
//! style to the other in any frame. A program that does not use it does not link it.
//!
//! # How it is drawn
//!
//! - **Parts.** A person has 16: chest, pelvis, neck and head, and on each side upper arm, forearm, hand, thigh, shin and foot. Their joints are
//!   found by words in the joints' names (`joints.rs`), in rigs of CMU, Bandai, Mixamo, Xia, VRM, Rigify and ours; fingers are one hand, the
//!   joints of the spine one waist. If a rig is no person's, each bone is a capsule ([`Build::Bones`]); if it has more than [`MOST_PARTS`], only
//!   lines can be drawn ([`Build::Lines`]).
//! - **Sizes.** All radii are thousandths of the figure's height, which is 2.04 times thigh and shin: [`Look`].
//! - **Characters.** A [`Look`] has radii, materials and attachments such as a hat, hair, a skirt or a tail, in at most 200 bytes. It is written as
//!   text ([`look_text`]). The camera makes room for attachments as far as they reach in any direction.
//! - **Rows.** A part is the convex hull of one to four circles (`hull.rs`). Each row of it is one span, which `paint.rs` fills with the surface's
//!   own [`Surface::span`]. The outline is what the rows reach with a pixel more on each side; it is open where a part that was drawn before
//!   goes on, so that no seam shows at joints.
//! - **Order.** Parts are drawn from far to near. Two parts change places only if their depths differ by more than [`PASSING`] of the figure's
//!   height against the order of the frame before: nothing flickers. Therefore a picture can depend on the frame before.
//! - **Materials.** Displays of two colours have left limbs bright and right ones checkered, displays of greys have sides of different
//!   brightness, displays of hues have clothes, hands and feet in their side's hue, and a lit and a shaded side: [`Ink::tint`].
//!
//! # When lines are better
//!
//! On displays of two colours, for figures below 40 pixels; for arms before chest or face on such displays; where instructions count: solid
//! figures take five to seven times as many.

mod attach;
mod floor;
mod head;
mod hull;
mod joints;
pub mod look;
pub mod look_text;
mod paint;
mod parts;
mod sizes;
mod tint;
mod together;

use crate::camera::{Canvas, MAGNIFICATION_BITS, PIXEL_BITS, View, magnification};
use crate::ink::Ink;
use crate::renderer::{Extent, FigureRenderer, Stand};
use crate::rotation::{Rotation, RotationBackend, Vector};
use crate::skeleton::{Part as Role, Skeleton};
use crate::surface::{OnTarget, Surface};
use crate::{DrawError, Error, JointInfo, RIG_JOINTS};
use embedded_graphics::draw_target::DrawTarget;
pub use head::HeadPose;
use heapless::Vec;
use joints::Joints;
use look::MOST_ATTACHMENTS;
pub use look::{Look, LookError, MATERIALS, Material, RADII, Radius};
use paint::{Cut, Fill, Outline, Painter};
use pantin::{Player, Pose, WrongForm};
use pantin_math::vector::{cross, direction, dot};
use parts::{Body, HEAD, HUMAN_PARTS, Part};
use sizes::{HEAD_MIDDLE, Sizes};
pub use tint::{Light, Pattern, Tint};
pub use together::{MOST_FIGURES, draw_together};

/// Rows beyond a window that outlines and shaded sides may look at.
const MARGIN: i32 = 16;

/// Most parts of a figure.
pub const MOST_PARTS: usize = 48;

/// Two parts change places if their depths differ by more than this many thousandths of the figure's height.
pub const PASSING: i32 = 12;

/// What a rig is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// A person of 16 parts.
    Person,
    /// A capsule for each bone: the rig's names are not those of a person.
    Bones,
    /// Lines: the rig has no bones, or more than [`MOST_PARTS`].
    Lines,
}

/// What is drawn, with the joints that it needs.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Person(Joints),
    Bones,
    Lines,
}

/// A figure before its camera that can be drawn with volume.
#[derive(Clone, Debug)]
pub struct SolidFigure<const N: usize, R: RotationBackend = Rotation> {
    figure: FigureRenderer<N, R>,
    kind: Kind,
    look: Look,
    sizes: Sizes,
    /// Up, ahead and left in the head's own axes, 2^13 long.
    head_axes: [[i16; 3]; 3],
    head: HeadPose,
    /// Parts, the farthest of the last picture first.
    order: Vec<u8, MOST_PARTS>,
    /// Whether there was a picture since the camera was set up.
    sorted: bool,
    /// Whether cameras make room for the head's volume.
    roomy: bool,
    /// Whether another face is drawn on the head.
    bare_face: bool,
}

/// Those that a hand reaches from the wrist beyond its radius.
const HAND_REACH: i32 = 44;
/// Joints of a person, and how far what hangs on them reaches from each in figure units.
type Ends = [(u8, i32); 5];
/// Length of the vectors in the head's axes.
const AXIS: i32 = 1 << 13;
/// A clip is looked at in about this many places before it plays.
const SAMPLES: u32 = 48;

impl<const N: usize, R: RotationBackend> SolidFigure<N, R> {
    /// No figure yet.
    pub const fn empty() -> Self {
        SolidFigure {
            figure: FigureRenderer::empty(),
            kind: Kind::Lines,
            look: Look::DEFAULT,
            sizes: Sizes::NOTHING,
            head_axes: [[0; 3]; 3],
            head: HeadPose { skull: [0; 3], up: [0; 3], face: [0; 3], left: [0; 3] },
            order: Vec::new(),
            sorted: false,
            roomy: true,
            bare_face: false,
        }
    }

    /// A figure and a camera for a clip of up to 192 joints; leaves the player at frame 0. See [`FigureRenderer::of_clip`].
    pub fn of_clip(player: &mut Player, canvas: Canvas, view: View, look: Look) -> Result<Self, Error> {
        let mut solid = Self::empty();
        solid.look = look;
        solid.set_up(player, canvas, &mut [JointInfo::default(); RIG_JOINTS])?;
        solid.aim(player, view);
        Ok(solid)
    }

    /// The first half of [`SolidFigure::of_clip`] in place: see [`FigureRenderer::set_up`].
    #[inline(never)]
    pub fn set_up(&mut self, player: &mut Player, canvas: Canvas, scratch: &mut [JointInfo]) -> Result<(), Error> {
        self.figure.set_up(player, canvas, scratch)?;
        self.know(player);
        Ok(())
    }

    /// Finds the parts.
    #[inline(never)]
    fn know(&mut self, player: &mut Player) {
        self.kind = match Joints::find(&player.clip().rig(), self.figure.skeleton()) {
            Some(joints) => Kind::Person(joints),
            None => Kind::Bones,
        };
        if let Kind::Person(joints) = self.kind {
            self.learn_head(player, &joints);
        }
        self.list();
    }

    /// Lists the parts.
    fn list(&mut self) {
        const { assert!(HUMAN_PARTS + MOST_ATTACHMENTS <= MOST_PARTS) };
        self.order.clear();
        let mut fits = true;
        if let Kind::Person(_) = self.kind {
            (0..HUMAN_PARTS as u8 + self.look.count()).for_each(|part| fits &= self.order.push(part).is_ok());
        } else {
            for (index, bone) in self.figure.skeleton().bones.iter().enumerate() {
                if bone.parent.is_some() && matches!(bone.part, Role::Bone | Role::Crown) {
                    fits &= self.order.push(index as u8).is_ok();
                }
            }
        }
        if !fits || self.order.is_empty() {
            self.kind = Kind::Lines;
        }
    }

    /// Finds out what is ahead of the head in its own axes: the mean over poses of the clip of where the shoulders face, as rest poses of some
    /// captures do not say it.
    #[inline(never)]
    fn learn_head(&mut self, player: &mut Player, joints: &Joints) {
        let (now, frames) = (player.frame(), player.clip().frames());
        let stride = frames.div_ceil(SAMPLES).max(1);
        let (mut up, mut ahead) = ([0i32; 3], [0i32; 3]);
        let mut frame = 0;
        while frame < frames {
            player.seek(frame);
            let values = player.pose().values;
            self.figure.place_in_world(values);
            let way = |from: u8, to: u8| attach::way(&self.figure, from, to);
            let turned = self.figure.joints().turned(self.figure.skeleton(), values, &Rotation::IDENTITY, joints.head);
            let facing = cross(way(joints.arms[1][0], joints.arms[0][0]), way(joints.hips, joints.neck));
            // Sums of at most 2 SAMPLES directions, in the head's own axes.
            for (sum, v) in [(&mut ahead, facing), (&mut up, way(joints.neck, joints.head))] {
                sum.iter_mut().zip(turned.0).for_each(|(sum, column)| *sum += dot(column, v) >> 2);
            }
            frame += stride;
        }
        player.seek(now);
        let ahead = direction(ahead).map_or([0, 0, 1 << 15], |(v, _)| v);
        let risen = dot(up_of(up), ahead);
        let upright: Vector = core::array::from_fn(|axis| up_of(up)[axis] - ((ahead[axis] * risen) >> 15));
        let up = up_of(upright);
        let left = cross(up, ahead);
        self.head_axes = [up, ahead, left].map(|v| v.map(|x| (x >> 2).clamp(-AXIS, AXIS) as i16));
    }

    /// Sets the camera up for another view of the clip; leaves the player where it is.
    #[inline(never)]
    pub fn aim(&mut self, player: &mut Player, view: View) {
        let ends = self.ends();
        self.figure.aim_for(player, view, |extent, figure| cover(extent, figure, ends));
        self.measure();
    }

    /// Whether cameras that are set up from now on make room for head and hands, which are larger than those of lines: they do at first. Without
    /// it the camera is that of a [`FigureRenderer`].
    pub fn make_room(&mut self, room: bool) {
        self.roomy = room;
    }

    /// Joints and how far head, hands and attachments reach from them in figure units, of a person for whose volume there is room.
    fn ends(&self) -> Option<Ends> {
        let Kind::Person(joints) = self.kind else { return None };
        let eighth = sizes::height(&self.figure.skeleton().bones, &joints) >> 3;
        let reach = |thousandths: i32| eighth * thousandths / 125;
        let radius = |of: Radius| i32::from(self.look.radius(of, false));
        let [of_head, chest, hips] = self.look.reaches();
        let larger = if self.bare_face { sizes::larger_skull(self.figure.canvas()) } else { 0 };
        // The outline is part of the camera's margin.
        let head = HEAD_MIDDLE + larger * 15 / 8 + radius(Radius::Skull).max(of_head);
        let [left, right] = joints.arms.map(|[.., wrist]| (wrist, reach(HAND_REACH + radius(Radius::Hand))));
        self.roomy.then_some([(joints.head, reach(head)), left, right, (joints.neck, reach(chest)), (joints.hips, reach(hips))])
    }

    /// Works out sizes for the camera.
    fn measure(&mut self) {
        let joints = match &self.kind {
            Kind::Person(joints) => Some(joints),
            _ => None,
        };
        self.sizes = Sizes::new(&self.figure, joints, &self.look, self.bare_face);
        self.sorted = false;
    }

    /// Changes the character. Set the camera up after it: it makes room for the character's volume, and works its sizes out.
    pub fn set_look(&mut self, look: Look) {
        self.look = look;
        self.list();
    }

    /// Leaves the head's own face out, for another one that [`SolidFigure::draw_with_face`] draws, and makes the head larger, the more the fewer
    /// rows the display has. Set the camera up after it.
    pub fn set_bare_face(&mut self, bare: bool) {
        self.bare_face = bare;
    }

    /// The radius of a person's head in pixels, at the camera's target.
    pub fn head_radius(&self) -> u16 {
        (self.sizes.radii[Radius::Skull as usize] >> PIXEL_BITS) as u16
    }

    /// What the rig is drawn as.
    pub fn build(&self) -> Build {
        match self.kind {
            Kind::Person(_) => Build::Person,
            Kind::Bones => Build::Bones,
            Kind::Lines => Build::Lines,
        }
    }

    /// The figure as lines: its camera and its joints.
    pub fn lines(&mut self) -> &mut FigureRenderer<N, R> {
        &mut self.figure
    }

    /// The figure's joints.
    pub fn skeleton(&self) -> &Skeleton<N> {
        self.figure.skeleton()
    }

    /// Moves the picture by whole pixels: see [`FigureRenderer::shift`].
    pub fn shift(&mut self, x: i16, y: i16) {
        self.figure.shift(x, y);
    }

    /// Sets the camera up for poses: see [`FigureRenderer::look_at`].
    pub fn look_at(&mut self, canvas: Canvas, view: View, poses: impl FnMut(&mut dyn FnMut(&[i32]))) {
        let ends = self.ends();
        self.figure.look_for(canvas, view, poses, |extent, figure| cover(extent, figure, ends));
        self.measure();
    }

    /// Sets the camera up for poses that stand somewhere in the world: see [`FigureRenderer::look_at_stands`].
    pub fn look_at_stands(&mut self, canvas: Canvas, view: View, poses: impl FnMut(&mut dyn FnMut(&[i32], crate::Stand))) {
        let ends = self.ends();
        self.figure.look_for_stands(canvas, view, poses, |extent, figure| cover(extent, figure, ends));
        self.measure();
    }

    /// Takes a pose: see [`FigureRenderer::set_pose`].
    pub fn set_pose(&mut self, pose: Pose<'_>) -> Result<(), WrongForm> {
        self.figure.set_pose(pose)?;
        self.turn_head(pose.values, 0);
        Ok(())
    }

    /// Takes a pose of a figure that stands somewhere in the world: see [`FigureRenderer::set_pose_at`].
    pub fn set_pose_at(&mut self, pose: Pose<'_>, stand: Stand) -> Result<(), WrongForm> {
        self.figure.set_pose_at(pose, stand)?;
        self.turn_head(pose.values, stand.heading.to_bits());
        Ok(())
    }

    /// Where the head looks.
    #[inline(never)]
    fn turn_head(&mut self, values: &[i32], heading: i32) {
        let Kind::Person(joints) = &self.kind else { return };
        let turned = self.figure.turned(values, heading, joints.head);
        let Some(visible) = self.figure.visible(joints.head) else { return };
        let magnification = magnification(visible.depth.into());
        let radius = (i32::from(self.sizes.radii[Radius::Skull as usize]) * magnification) >> MAGNIFICATION_BITS;
        // A vector of 2^13 figure units on the display, and how much shorter or longer the skull's radius is.
        let unit = self.figure.camera().length(AXIS).max(1);
        let [up, face, left] = self.head_axes.map(|axis| {
            let seen = self.figure.camera().vector(turned.rotate(axis.map(i32::from)));
            seen.map(|part| part * radius / unit)
        });
        let [above, before] = self.sizes.skull;
        let [x, y] = visible.place.map(i32::from);
        let place = |axis: usize| (up[axis] * above + face[axis] * before) >> 8;
        self.head = HeadPose { skull: [x + place(0), y + place(1), radius], up, face, left };
    }

    /// Draws the pose that was taken last on a clear surface: the floor, if it is wanted, and the parts from far to near.
    ///
    /// A rig of [`Build::Lines`] is drawn as lines.
    #[inline(never)]
    pub fn draw_on<S: Surface>(&mut self, surface: &mut S, floor: bool) {
        self.draw_with_face(surface, floor, |_, _| {});
    }

    /// Like [`SolidFigure::draw_on`]. After the head of a person, which [`SolidFigure::set_bare_face`] left without a face, `face` draws one; parts
    /// before the head cover it.
    #[inline(always)]
    pub fn draw_with_face<S: Surface>(&mut self, surface: &mut S, floor: bool, mut face: impl FnMut(&mut S, &HeadPose)) {
        if let Kind::Lines = self.kind {
            return self.figure.draw_on(surface, crate::DrawStyle { ground: floor, smooth: false });
        }
        self.sort();
        let body = self.body();
        let mut painter = Painter::on(surface);
        if floor {
            body.draw_floor(&mut painter, true);
        }
        let mut drawn = 0;
        for &part in self.order.iter() {
            body.draw(&mut painter, part, &mut drawn);
            if part == HEAD && matches!(self.kind, Kind::Person(_)) {
                face(painter.surface, &self.head);
            }
        }
    }

    /// The figure as it is drawn.
    #[inline(always)]
    fn body(&self) -> Body<'_, N, R> {
        Body { figure: &self.figure, kind: &self.kind, sizes: &self.sizes, look: &self.look, head: &self.head }
    }

    /// Takes over camera and ground of another figure of the same rig, so that both stand in one world: see [`draw_together`].
    pub fn share_camera(&mut self, other: &Self) {
        self.figure.share_camera(&other.figure);
        self.measure();
    }

    /// Clears the target and draws the figure in a pose, with the floor.
    pub fn draw<D>(&mut self, pose: Pose<'_>, target: &mut D) -> Result<(), DrawError<D::Error>>
    where
        D: DrawTarget,
        D::Color: Ink,
    {
        target.clear(D::Color::DARK).map_err(DrawError::Target)?;
        self.set_pose(pose).map_err(DrawError::WrongForm)?;
        let mut surface = OnTarget::new(target);
        self.draw_on(&mut surface, true);
        surface.outcome().map_err(DrawError::Target)
    }

    #[inline(always)]
    fn keys(&self) -> Keys {
        let Kind::Person(joints) = &self.kind else { return Keys(None) };
        let mut keys = [0; MOST_PARTS];
        self.body().human_keys(joints, &mut keys);
        Keys(Some(keys))
    }

    /// Puts the farthest part first. The first picture is sorted exactly, later ones from the order of the one before.
    #[inline(never)]
    fn sort(&mut self) {
        let keys = self.keys();
        let figure = &self.figure;
        let key = |part: u8| keys.of(figure, part);
        let passing = if self.sorted { self.sizes.depth * PASSING / 1000 } else { 0 };
        for place in 1..self.order.len() {
            let Some(&moving) = self.order.get(place) else { return };
            let (own, mut place) = (key(moving), place);
            while let Some(&before) = self.order.get(place.wrapping_sub(1))
                && key(before) + passing < own
            {
                if let Some(here) = self.order.get_mut(place) {
                    *here = before;
                }
                place -= 1;
            }
            if let Some(here) = self.order.get_mut(place) {
                *here = moving;
            }
        }
        self.sorted = true;
    }
}

/// How far away a person's parts count as; the bones of other rigs know it.
struct Keys(Option<[i32; MOST_PARTS]>);

impl Keys {
    /// How far away a part counts as, in units of depth.
    #[inline(always)]
    fn of<const N: usize, R: RotationBackend>(&self, figure: &FigureRenderer<N, R>, part: u8) -> i32 {
        match &self.0 {
            Some(keys) => keys.get(usize::from(part)).copied().unwrap_or(0),
            None => figure.bone_depth(part),
        }
    }
}

/// Takes in what a pose covers: the bones, and circles about joints, given with their radii in figure units.
fn cover<const N: usize, R: RotationBackend>(extent: &mut Extent, figure: &FigureRenderer<N, R>, ends: Option<Ends>) {
    let Some(ends) = ends else { return extent.include(figure) };
    extent.include_bones(figure);
    for (joint, reach) in ends {
        if let Some(seen) = figure.visible(joint).filter(|_| reach > 0) {
            let radius = (figure.camera().length(reach) * magnification(seen.depth.into())) >> MAGNIFICATION_BITS;
            extent.widen(seen.place, radius.min(i16::MAX.into()) as i16);
        }
    }
}

/// The joints of a person.
fn joints_of(kind: &Kind) -> Option<&Joints> {
    match kind {
        Kind::Person(joints) => Some(joints),
        _ => None,
    }
}

/// A direction; up along y for none.
fn up_of(v: Vector) -> Vector {
    direction(v).map_or([0, 1 << 15, 0], |(v, _)| v)
}

impl<const N: usize, R: RotationBackend> Body<'_, N, R> {
    /// Draws a part. `drawn` has the joints of those that were drawn before.
    #[inline(never)]
    fn draw<S: Surface>(&self, painter: &mut Painter<S>, part: u8, drawn: &mut u64) {
        let joints = joints_of(self.kind);
        if joints.is_some() && part == HEAD {
            self.head.draw(painter, self.look, 256, self.sizes.outline, self.sizes.bare_face);
            *drawn |= 4;
            return;
        }
        let key = self.depth_of(part);
        let mut made = Part::new();
        match joints {
            Some(joints) => match usize::from(part).checked_sub(HUMAN_PARTS).and_then(|index| self.look.attachments().nth(index))
            {
                Some(attachment) => self.attached(joints, &attachment, &mut made),
                None => self.human(joints, part, &mut made),
            },
            None => self.bone(part, &mut made),
        }
        let part = &made;
        let light = self.light(key, part.right);
        let lit = S::Ink::tint(&part.tint, light);
        let edge = S::Ink::tint(&self.look.tint(Material::Edge), 256);
        let mut outline = Outline { ink: edge, width: self.sizes.outline, cuts: [Cut::None; 2] };
        for (cut, (circle, joint)) in outline.cuts.iter_mut().zip(part.ends) {
            if joint & *drawn != 0 {
                *cut = open_at(&part.circles, circle.into());
            }
        }
        let shaded = S::Ink::SHADED && !self.sizes.small;
        let fill = if !S::Ink::TONES {
            match part.tint.pattern {
                Pattern::Checkered => Fill::Checkered(lit, edge),
                Pattern::Dark => Fill::Rimmed(S::Ink::tint(&self.look.tint(Material::Face), 256), lit),
                Pattern::Bright => Fill::Plain(lit),
            }
        } else if shaded {
            // 0.42 of the mean radius towards the lower right.
            let sum: i32 = part.circles.iter().map(|circle| circle[2]).sum();
            let mean = divided(sum, part.circles.len());
            let shift = |parts: i32| ((mean * parts) >> 12).clamp(1, MARGIN - 2);
            let shade = ((u32::from(light) * tint::SHADE) >> 8) as Light;
            Fill::Shaded(lit, S::Ink::tint(&part.tint, shade), [shift(62), shift(87)])
        } else {
            Fill::Plain(lit)
        };
        painter.hull(&part.circles, false, &outline, &fill);
        *drawn |= part.covers;
    }

    /// Depth of a part, as far as its light depends on it.
    fn depth_of(&self, part: u8) -> i32 {
        match joints_of(self.kind) {
            Some(joints) => match self.human_joint(joints, part) {
                Some(joint) => self.joint(joint)[2],
                None => 0,
            },
            None => self.figure.bone_depth(part),
        }
    }

    /// The joint at the far end of a part of a person.
    fn human_joint(&self, joints: &Joints, part: u8) -> Option<u8> {
        let limb = part.checked_sub(4).filter(|_| usize::from(part) < HUMAN_PARTS)?;
        let side = usize::from(limb >= 6);
        let index = usize::from(limb % 6);
        let [arm, leg] = [joints.arms.get(side)?, joints.legs.get(side)?];
        if index < 3 { arm.get((index + 1).min(2)).copied() } else { leg.get((index - 2).min(2)).copied() }
    }

    /// 0.94 at the target's distance, more before it and less behind it, from 0.62 to 1; 0.9 of that on the right.
    fn light(&self, depth: i32, right: bool) -> Light {
        let light = (241 - depth * 230 / self.sizes.depth.max(1)).clamp(159, 256);
        (if right { light * 9 / 10 } else { light }) as Light
    }
}

/// The cut at a circle of a part, away from the others' middle.
#[inline(never)]
fn open_at(circles: &[hull::Circle], index: usize) -> Cut {
    let Some(own) = circles.get(index) else { return Cut::None };
    let others = circles.len().saturating_sub(1);
    let [x, y] = circles.iter().fold([0; 2], |[x, y], circle| [x + circle[0], y + circle[1]]);
    Cut::at(own, [divided(x - own[0], others) - own[0], divided(y - own[1], others) - own[1]])
}

/// A sum over up to four circles, divided by their number: by constants, as a small processor has no instruction for it.
#[inline(never)]
fn divided(sum: i32, count: usize) -> i32 {
    match count {
        0 | 1 => sum,
        2 => sum / 2,
        3 => sum / 3,
        _ => sum / 4,
    }
}
