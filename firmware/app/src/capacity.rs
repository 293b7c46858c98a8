//! The largest clip that a program can play, and the buffers that follow from it.

use pantin::{ChannelState, Player, Pose};
#[cfg(not(feature = "solid"))]
use pantin_figure::FigureRenderer as Figure;
use pantin_figure::rotation::RotationBackend;
#[cfg(feature = "solid")]
use pantin_figure::solid::SolidFigure as Figure;
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, DrawStyle, JointInfo, View};

/// Most joints of a rig, fingers and toes included: the workspace for setting a figure up. Boards with the feature `large` have room for
/// large rigs.
pub const RIG: usize = if cfg!(feature = "large") { 192 } else { 60 };

/// The largest clip that a program has buffers for. The only implementation is [`MaxClip`].
pub trait Capacity {
    /// Most channels of a clip.
    const CHANNELS: usize;
    /// Most moving channels of a clip.
    const MOVING: usize;
    /// Most joints of a figure, fingers and toes left out; those of the rig are at most [`RIG`].
    const JOINTS: usize;

    /// The decoder's state: one for each moving channel.
    type States: AsMut<[ChannelState]>;
    /// The values of a pose.
    type Pose: AsMut<[i32]>;
    /// The renderer of a figure.
    type Renderer<R: RotationBackend>: Renderer;
    /// The state of a link's channels.
    #[cfg(feature = "link")]
    type LinkChannels: AsMut<[pantin_link::Channel]>;

    /// Makes decoder states for [`MOVING`](Capacity::MOVING) channels.
    fn states() -> Self::States;
    /// Makes a pose of [`CHANNELS`](Capacity::CHANNELS) values.
    fn pose() -> Self::Pose;
    /// Makes link states for [`CHANNELS`](Capacity::CHANNELS) channels.
    #[cfg(feature = "link")]
    fn link_channels() -> Self::LinkChannels;
}

/// A clip of at most `CHANNELS` channels, `MOVING` of them moving, whose figure has at most `JOINTS` joints.
#[derive(Clone, Copy, Debug)]
pub struct MaxClip<const CHANNELS: usize, const MOVING: usize, const JOINTS: usize>;

impl<const CHANNELS: usize, const MOVING: usize, const JOINTS: usize> Capacity for MaxClip<CHANNELS, MOVING, JOINTS> {
    const CHANNELS: usize = CHANNELS;
    const MOVING: usize = MOVING;
    const JOINTS: usize = JOINTS;

    type States = [ChannelState; MOVING];
    type Pose = [i32; CHANNELS];
    type Renderer<R: RotationBackend> = Figure<JOINTS, R>;
    #[cfg(feature = "link")]
    type LinkChannels = [pantin_link::Channel; CHANNELS];

    #[inline(always)]
    fn states() -> Self::States {
        [ChannelState::NEW; MOVING]
    }

    #[inline(always)]
    fn pose() -> Self::Pose {
        [0; CHANNELS]
    }

    #[cfg(feature = "link")]
    #[inline(always)]
    fn link_channels() -> Self::LinkChannels {
        [pantin_link::Channel::default(); CHANNELS]
    }
}

/// How a figure is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// How lines are drawn, and whether there is a floor.
    pub lines: DrawStyle,
    /// A body with volume.
    #[cfg(feature = "solid")]
    pub solid: bool,
    /// Its character.
    #[cfg(feature = "solid")]
    pub look: pantin_figure::solid::Look,
}

/// A renderer of figures for any number of joints.
pub trait Renderer {
    /// Makes one that is not set up.
    fn empty() -> Self;

    /// Sets the figure of a player's clip up for a canvas.
    ///
    /// # Errors
    /// The rig has more joints than [`RIG`], or the figure more than the renderer.
    fn set_up(&mut self, player: &mut Player, canvas: Canvas) -> Result<(), pantin_figure::Error>;

    /// Sets the camera up for a view. The player stays at its frame.
    fn aim(&mut self, player: &mut Player, view: View, style: Style);

    /// Sets the camera up for poses that `poses` passes to its argument: it is called twice and must pass the same ones.
    #[cfg(feature = "steer")]
    fn look_at(&mut self, canvas: Canvas, view: View, style: Style, poses: impl FnMut(&mut dyn FnMut(&[i32])));

    /// Sets a camera up that stays where it is, for poses that stand somewhere in the world: see [`Renderer::look_at`].
    #[cfg(feature = "meet")]
    fn look_at_stands(
        &mut self,
        canvas: Canvas,
        view: View,
        style: Style,
        poses: impl FnMut(&mut dyn FnMut(&[i32], pantin_figure::Stand)),
    );

    /// Takes the pose to draw of a figure that stands somewhere in the world.
    #[cfg(feature = "steer")]
    fn set_pose_at(&mut self, pose: Pose<'_>, stand: pantin_figure::Stand);

    /// Moves the picture on the display by columns and rows.
    fn shift(&mut self, columns: i16, rows: i16);

    /// Takes the pose to draw.
    fn set_pose(&mut self, pose: Pose<'_>);

    /// Draws the figure on a framebuffer.
    fn draw<L: Layout>(&mut self, framebuffer: &mut Framebuffer<L>, style: Style);

    /// Draws the figure on a framebuffer, and the face of a body with volume by `face`.
    #[cfg(feature = "neck")]
    fn draw_with_face<L: Layout>(
        &mut self,
        framebuffer: &mut Framebuffer<L>,
        style: Style,
        face: impl FnMut(&mut Framebuffer<L>, &pantin_figure::solid::HeadPose),
    );

    /// Leaves the face of a body with volume out. The camera is set up after it.
    #[cfg(feature = "neck")]
    fn set_bare_face(&mut self);

    /// Returns the radius of a person's head in pixels.
    #[cfg(feature = "neck")]
    fn head_radius(&self) -> u16;

    /// Returns whether the figure is a person.
    #[cfg(feature = "neck")]
    fn is_person(&self) -> bool;

    /// Returns the number of bones that are drawn.
    fn bones(&self) -> usize;
}

/// Lets a camera that is set up next make room for what a style draws.
#[inline(always)]
fn make_room<const N: usize, R: RotationBackend>(figure: &mut Figure<N, R>, style: Style) {
    #[cfg(feature = "solid")]
    {
        figure.set_look(style.look);
        figure.make_room(style.solid);
    }
    #[cfg(not(feature = "solid"))]
    let _ = (figure, style);
}

impl<const N: usize, R: RotationBackend> Renderer for Figure<N, R> {
    #[inline(always)]
    fn empty() -> Self {
        Figure::empty()
    }

    // Not inlined: the workspace is on the stack only while a figure is set up.
    #[inline(never)]
    fn set_up(&mut self, player: &mut Player, canvas: Canvas) -> Result<(), pantin_figure::Error> {
        Figure::set_up(self, player, canvas, &mut [JointInfo::default(); RIG])
    }

    #[inline(always)]
    fn aim(&mut self, player: &mut Player, view: View, style: Style) {
        make_room(self, style);
        Figure::aim(self, player, view);
    }

    #[cfg(feature = "steer")]
    #[inline(always)]
    fn look_at(&mut self, canvas: Canvas, view: View, style: Style, poses: impl FnMut(&mut dyn FnMut(&[i32]))) {
        make_room(self, style);
        Figure::look_at(self, canvas, view, poses);
    }

    #[cfg(feature = "meet")]
    #[inline(always)]
    fn look_at_stands(
        &mut self,
        canvas: Canvas,
        view: View,
        style: Style,
        poses: impl FnMut(&mut dyn FnMut(&[i32], pantin_figure::Stand)),
    ) {
        make_room(self, style);
        Figure::look_at_stands(self, canvas, view, poses);
    }

    #[cfg(feature = "steer")]
    #[inline(always)]
    fn set_pose_at(&mut self, pose: Pose<'_>, stand: pantin_figure::Stand) {
        // The pose is of the rig that the renderer was set up for.
        let _ = Figure::set_pose_at(self, pose, stand);
    }

    #[inline(always)]
    fn shift(&mut self, columns: i16, rows: i16) {
        Figure::shift(self, columns, rows);
    }

    #[inline(always)]
    fn set_pose(&mut self, pose: Pose<'_>) {
        // The pose is of the clip that the renderer was set up for.
        let _ = Figure::set_pose(self, pose);
    }

    #[inline(always)]
    fn draw<L: Layout>(&mut self, framebuffer: &mut Framebuffer<L>, style: Style) {
        #[cfg(feature = "solid")]
        if style.solid {
            return self.draw_on(framebuffer, style.lines.ground);
        }
        #[cfg(feature = "solid")]
        let figure = self.lines();
        #[cfg(not(feature = "solid"))]
        let figure = self;
        figure.draw_on(framebuffer, style.lines);
    }

    #[cfg(feature = "neck")]
    #[inline(always)]
    fn draw_with_face<L: Layout>(
        &mut self,
        framebuffer: &mut Framebuffer<L>,
        style: Style,
        face: impl FnMut(&mut Framebuffer<L>, &pantin_figure::solid::HeadPose),
    ) {
        if style.solid {
            return Figure::draw_with_face(self, framebuffer, style.lines.ground, face);
        }
        self.lines().draw_on(framebuffer, style.lines);
    }

    #[cfg(feature = "neck")]
    #[inline(always)]
    fn set_bare_face(&mut self) {
        Figure::set_bare_face(self, true);
    }

    #[cfg(feature = "neck")]
    #[inline(always)]
    fn head_radius(&self) -> u16 {
        Figure::head_radius(self)
    }

    #[cfg(feature = "neck")]
    #[inline(always)]
    fn is_person(&self) -> bool {
        self.build() == pantin_figure::solid::Build::Person
    }

    #[inline(always)]
    fn bones(&self) -> usize {
        self.skeleton().bones.len()
    }
}
