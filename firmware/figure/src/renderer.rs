//! The whole way from a pose to a picture. What is drawn depends on the clip and the pose alone, never on frames before.

use crate::bounds::{Bounds, Orientation};
use crate::camera::{Camera, CameraTarget, Canvas, Level, PIXEL_BITS, View};
use crate::joint_info::JointInfo;
use crate::kinematics::Kinematics;
use crate::lines::{Dot, Ground, Head, Line, Lines, Visible};
use crate::rotation::{Rotation, RotationBackend, Vector};
use crate::skeleton::{Detail, Part, Skeleton};
use crate::{Error, RIG_JOINTS};
use heapless::Vec;
use pantin::{Angle, Player, Pose, WrongForm};

/// A figure of at most `N` joints before its camera.
#[derive(Clone, Debug)]
pub struct FigureRenderer<const N: usize, R: RotationBackend = Rotation> {
    skeleton: Skeleton<N>,
    orientation: Orientation,
    canvas: Canvas,
    /// Pixels by which [`FigureRenderer::shift`] moves the canvas to the right and down.
    offset: [i16; 2],
    camera: Camera,
    /// The camera's axes, in the form of the joints' rotations.
    view: R,
    target: Vector,
    ground: Ground,
    joints: Kinematics<N, R>,
    visible: Vec<Visible, N>,
    /// Indices of the bones that are drawn, the farthest first.
    order: Vec<u8, N>,
}

/// Where a figure stands in the world, beyond what its pose says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stand {
    /// Along the horizontal axes that follow the vertical one in the cycle x, y, z (for y up: z, x), in the unit of the pose's positions: 2^[`pantin::Form::length_exponent`]
    /// units of the source.
    pub place: [i64; 2],
    /// How far the figure is turned about the rig's vertical axis, before it is put to its place.
    pub heading: Angle,
}

/// Where joints are placed while a camera is set up.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Space {
    /// In the world, for the bounds.
    World,
    /// Before the camera, for the scale.
    View,
}

/// The largest scale: 2^14 sixteenths of a pixel a size.
const LARGEST_SCALE: i32 = 1 << 14;

/// The scale at which a clip is looked at before the final one is known. A fixed camera sees as far as a size to all sides, in 16 bits.
fn trial_scale(target: CameraTarget) -> i32 {
    match target {
        CameraTarget::Follow => LARGEST_SCALE,
        CameraTarget::Fixed => LARGEST_SCALE / 4,
    }
}

/// A clip is looked at in about this many places before it plays.
const SAMPLES: u32 = 48;

/// Most bytes of motion that the camera reads. A larger clip is divided into equal parts of at most this size, and the camera sees the first. The time of a
/// seek grows with the bytes.
const SURVEYED_BYTES: usize = 1 << 14;

impl<const N: usize, R: RotationBackend> FigureRenderer<N, R> {
    /// No figure yet.
    #[inline(always)]
    pub const fn empty() -> Self {
        FigureRenderer {
            skeleton: Skeleton::empty(),
            orientation: Orientation::UPRIGHT,
            canvas: Canvas { width: 0, height: 0 },
            offset: [0; 2],
            camera: Camera::NOWHERE,
            view: R::NONE,
            target: [0; 3],
            ground: Ground { axis: 1, height: 0, spacing: 1, dotted: false },
            joints: Kinematics::new(),
            visible: Vec::new(),
            order: Vec::new(),
        }
    }

    /// A figure and a camera for a clip of up to 192 joints; leaves the player at frame 0.
    ///
    /// It takes 192 scratch elements of 16 bytes and a copy of the renderer on the stack. On a small machine use
    /// [`FigureRenderer::empty`], [`FigureRenderer::set_up`] with scratch for the rig's own joints, and [`FigureRenderer::aim`].
    pub fn of_clip(player: &mut Player, canvas: Canvas, view: View) -> Result<Self, Error> {
        let mut renderer = Self::empty();
        renderer.set_up(player, canvas, &mut [JointInfo::default(); RIG_JOINTS])?;
        renderer.aim(player, view);
        Ok(renderer)
    }

    /// The first half of [`FigureRenderer::of_clip`] in place; `scratch` needs an element of 16 bytes for each joint of the rig, End
    /// Sites included. [`FigureRenderer::aim`] is the other half: the scratch memory is free again before it.
    #[inline(never)]
    pub fn set_up(&mut self, player: &mut Player, canvas: Canvas, scratch: &mut [JointInfo]) -> Result<(), Error> {
        player.rewind();
        self.skeleton.set_up(&player.clip().rig(), Detail::Body, player.pose(), scratch)?;
        self.canvas = canvas;
        self.offset = [0; 2];
        self.choose();
        Ok(())
    }

    /// Sets the camera up for another view of the clip; leaves the player where it is.
    ///
    /// The player passes the clip twice; of a clip with more than 16 KiB of motion, which are about a minute, only the first of equal parts that are no larger:
    /// 0.1 s on a Cortex-M0 at 125 MHz. What the figure does later may then leave the display.
    #[inline(never)]
    pub fn aim(&mut self, player: &mut Player, view: View) {
        self.aim_for(player, view, Extent::include);
    }

    /// [`FigureRenderer::aim`] for what `cover` says that a pose covers of the display.
    #[inline(always)]
    pub(crate) fn aim_for(&mut self, player: &mut Player, view: View, cover: impl Fn(&mut Extent, &Self)) {
        let now = player.frame();
        let parts = player.clip().motion_len().div_ceil(SURVEYED_BYTES).max(1);
        let frames = player.clip().frames().div_ceil(parts as u32);
        let stride = frames.div_ceil(SAMPLES).max(1);
        let poses = |visit: &mut dyn FnMut(&[i32], ())| {
            let mut frame = 0;
            while frame < frames {
                player.seek(frame);
                visit(player.pose().values, ());
                frame += stride;
            }
        };
        self.frame(view, poses, Self::place, cover);
        player.seek(now);
    }

    /// Sets up the camera so that the figure fills the canvas over the clip. `poses` passes the values of some of the clip's poses,
    /// all of the skeleton's form, to its argument; it is called twice and must pass the same ones.
    pub fn new(skeleton: Skeleton<N>, canvas: Canvas, view: View, poses: impl FnMut(&mut dyn FnMut(&[i32]))) -> Self {
        let mut renderer = FigureRenderer { skeleton, ..Self::empty() };
        renderer.look_at(canvas, view, poses);
        renderer
    }

    /// [`FigureRenderer::new`] in place, for the skeleton that it has.
    pub fn look_at(&mut self, canvas: Canvas, view: View, poses: impl FnMut(&mut dyn FnMut(&[i32]))) {
        self.look_for(canvas, view, poses, Extent::include);
    }

    /// [`FigureRenderer::look_at`] for what `cover` says that a pose covers of the display.
    #[inline(always)]
    pub(crate) fn look_for(
        &mut self,
        canvas: Canvas,
        view: View,
        mut poses: impl FnMut(&mut dyn FnMut(&[i32])),
        cover: impl Fn(&mut Extent, &Self),
    ) {
        self.canvas = canvas;
        self.choose();
        self.frame(view, |visit| poses(&mut |values| visit(values, ())), Self::place, cover);
    }

    /// [`FigureRenderer::look_at`] for poses that stand somewhere in the world.
    pub fn look_at_stands(&mut self, canvas: Canvas, view: View, poses: impl FnMut(&mut dyn FnMut(&[i32], Stand))) {
        self.look_for_stands(canvas, view, poses, Extent::include);
    }

    /// [`FigureRenderer::look_at_stands`] for what `cover` says that a pose covers of the display.
    #[inline(always)]
    pub(crate) fn look_for_stands(
        &mut self,
        canvas: Canvas,
        view: View,
        poses: impl FnMut(&mut dyn FnMut(&[i32], Stand)),
        cover: impl Fn(&mut Extent, &Self),
    ) {
        self.canvas = canvas;
        self.choose();
        self.frame(view, poses, Self::place_at, cover);
    }

    /// Places the joints of a pose at the origin.
    fn place(&mut self, values: &[i32], _: (), space: Space) {
        match space {
            Space::World => self.joints.set_pose(&self.skeleton, values),
            Space::View => self.set_values(values),
        }
    }

    /// Places the joints of a pose that stands somewhere.
    fn place_at(&mut self, values: &[i32], stand: Stand, space: Space) {
        if space == Space::View {
            return self.set_values_at(values, stand);
        }
        let (turned, [x, y, z]) = self.stand(stand);
        let origin = self.back(stand, [-x, -y, -z]);
        self.joints.place_in(&self.skeleton, values, &turned, origin, self.skeleton.bones.len());
    }

    /// Sets the camera up for poses, with what `place` needs to know of each: a program that places all at the origin does not hold the code
    /// for stands.
    fn frame<S>(
        &mut self,
        view: View,
        mut poses: impl FnMut(&mut dyn FnMut(&[i32], S)),
        place: impl Fn(&mut Self, &[i32], S, Space),
        cover: impl Fn(&mut Extent, &Self),
    ) {
        let mut bounds = Bounds::new();
        poses(&mut |values, stand| {
            place(self, values, stand, Space::World);
            bounds.include(&self.skeleton, &self.joints);
        });
        let orientation = bounds.orientation(view.up.unwrap_or(self.skeleton.up));
        let size = self.skeleton.size;
        let set_camera = |renderer: &mut Self, scale| {
            renderer.camera = Camera::new(&bounds, orientation, size, view, scale);
            renderer.view = R::of_view(renderer.camera.view());
        };
        let upwards = orientation.up[orientation.axis] > 0;
        let height = if upwards { bounds.low[orientation.axis] } else { bounds.high[orientation.axis] };
        self.ground = Ground::new(orientation.axis, height, size, self.canvas);
        self.orientation = orientation;
        let trial = trial_scale(view.track);
        set_camera(self, trial);
        let mut frame = Extent::default();
        poses(&mut |values, stand| {
            place(self, values, stand, Space::View);
            cover(&mut frame, self);
        });
        let scale = frame.scale(self.canvas, trial);
        set_camera(self, scale);
        let [columns, rows] = [self.canvas.width, self.canvas.height].map(|pixels| i32::from(pixels) << PIXEL_BITS);
        let [right, down] = self.offset.map(|pixels| i32::from(pixels) << PIXEL_BITS);
        self.camera.set_center(right + columns / 2, down + rows / 2 - (frame.top + frame.bottom) / 2 * scale / trial);
    }

    /// Takes a pose: forward kinematics, and where the camera sees the joints. A pose of another form than the clip's is refused.
    pub fn set_pose(&mut self, pose: Pose<'_>) -> Result<(), WrongForm> {
        self.skeleton.form().check(pose.form)?;
        self.set_values(pose.values);
        Ok(())
    }

    #[inline(never)]
    fn set_values(&mut self, pose: &[i32]) {
        let hips = self.skeleton.hips;
        self.target = self.camera.target(self.joints.place_one(&self.skeleton, pose, hips));
        self.joints.place_in(&self.skeleton, pose, &self.view, self.target, self.skeleton.bones.len());
        self.see();
    }

    /// Takes a pose of a figure that stands somewhere in the world: the ground and a camera that is fixed stay where they are. A pose of
    /// another form than the clip's is refused.
    pub fn set_pose_at(&mut self, pose: Pose<'_>, stand: Stand) -> Result<(), WrongForm> {
        self.skeleton.form().check(pose.form)?;
        self.set_values_at(pose.values, stand);
        Ok(())
    }

    #[inline(never)]
    fn set_values_at(&mut self, pose: &[i32], stand: Stand) {
        let (turned, place) = self.stand(stand);
        let hips = self.joints.place_one(&self.skeleton, pose, self.skeleton.hips);
        let [x, y, z] = turned.rotate_any(hips);
        let [place_x, place_y, place_z] = place;
        let world = [x.wrapping_add(place_x), y.wrapping_add(place_y), z.wrapping_add(place_z)];
        self.target = self.camera.target(world);
        let [x, y, z] = self.target;
        // The target as the figure sees it, and the camera's axes as they are to a figure that is not turned.
        let origin = self.back(stand, [x.wrapping_sub(place_x), y.wrapping_sub(place_y), z.wrapping_sub(place_z)]);
        let mut view = self.view;
        view.turn(self.skeleton.up.axis() % 3, stand.heading.to_bits());
        self.joints.place_in(&self.skeleton, pose, &view, origin, self.skeleton.bones.len());
        self.see();
    }

    /// The turn of a stand, and its place, in figure units.
    fn stand(&self, stand: Stand) -> (R, Vector) {
        let axis = self.skeleton.up.axis() % 3;
        let mut turned = R::NONE;
        turned.turn(axis, stand.heading.to_bits());
        let shift = self.skeleton.position_shift;
        let mut place = [0; 3];
        for (at, raw) in [(axis + 1) % 3, (axis + 2) % 3].into_iter().zip(stand.place) {
            let scaled = if shift >= 0 { raw >> shift.min(63) } else { raw.wrapping_shl(shift.unsigned_abs()) };
            place[at] = scaled.clamp(-(1 << 30), 1 << 30) as i32;
        }
        (turned, place)
    }

    /// A vector of the world as a figure sees it that is turned so.
    fn back(&self, stand: Stand, v: Vector) -> Vector {
        let mut back = R::NONE;
        back.turn(self.skeleton.up.axis() % 3, stand.heading.to_bits().wrapping_neg());
        back.rotate_any(v)
    }

    /// Where the camera sees a joint.
    #[inline(always)]
    pub(crate) fn visible(&self, joint: u8) -> Option<Visible> {
        self.visible.get(usize::from(joint)).copied()
    }

    /// How a joint is turned, in the camera's axes, of a figure that is turned by `heading`.
    pub(crate) fn turned(&self, pose: &[i32], heading: i32, joint: u8) -> R {
        let mut view = self.view;
        if heading != 0 {
            view.turn(self.skeleton.up.axis() % 3, heading);
        }
        self.joints.turned(&self.skeleton, pose, &view, joint)
    }

    /// Places the joints of a pose in the world.
    pub(crate) fn place_in_world(&mut self, pose: &[i32]) {
        self.joints.set_pose(&self.skeleton, pose);
    }

    /// The ground, as the camera sees it.
    pub(crate) fn ground_level(&self) -> Level {
        let axis = self.ground.axis % 3;
        let mut upright = [0; 3];
        upright[axis] = 1 << 13;
        let mut level = [0; 3];
        level[axis] = self.ground.height.wrapping_sub(self.target[axis]);
        let [upright, level] = [self.view.rotate(upright), self.view.rotate_any(level)];
        self.camera.level(upright, level)
    }

    /// The place on a level below a joint, in sixteenths of a pixel, and its depth.
    pub(crate) fn below(&self, joint: u8, level: &Level) -> [i32; 3] {
        let place = self.camera.moved_to(level, self.joints.position(joint.into()));
        [place.x, place.y, place.depth]
    }

    /// Depth of a bone's middle.
    #[inline(always)]
    pub(crate) fn bone_depth(&self, index: u8) -> i32 {
        self.ends(index).map_or(0, |(from, to)| (i32::from(from.depth) + i32::from(to.depth)) >> 1)
    }

    /// Where the camera sees the joints that were placed.
    #[inline(always)]
    fn see(&mut self) {
        self.visible.clear();
        let camera = &self.camera;
        // One a joint: there is room.
        for &position in self.joints.positions() {
            let _ = self.visible.push(Visible::from(camera.project(position)));
        }
    }

    /// Shows every line of the ground, on a canvas that is large enough for lines.
    #[inline(always)]
    pub fn each_ground_line(&self, show: impl FnMut(Line)) {
        self.ground.each_line(&self.camera, self.target, show);
    }

    /// Shows every dot of the ground, on a smaller one.
    #[inline(always)]
    pub fn each_dot(&self, show: impl FnMut(Dot)) {
        self.ground.each_dot(&self.camera, self.target, show);
    }

    /// Shows every bone, as far as they were sorted from far to near.
    #[inline(always)]
    pub fn each_bone(&self, mut show: impl FnMut(Line)) {
        for &index in &self.order {
            let Some(bone) = self.skeleton.bones.get(usize::from(index)) else { continue };
            if let Some((from, to)) = self.ends(index) {
                show(bone.line(from, to, &self.camera));
            }
        }
    }

    /// Where the camera sees a joint's parent, and the joint.
    #[inline(always)]
    fn ends(&self, index: u8) -> Option<(Visible, Visible)> {
        let parent = self.skeleton.bones.get(usize::from(index))?.parent?;
        Some((*self.visible.get(usize::from(parent))?, *self.visible.get(usize::from(index))?))
    }

    /// The head, for a rig that names one.
    pub fn head(&self) -> Option<Head> {
        let crown = self.skeleton.bones.iter().position(|bone| bone.part == Part::Crown)?;
        let (from, to) = self.ends(crown as u8)?;
        Some(Head::new(from, to, &self.camera, self.skeleton.head_radius))
    }

    /// Which bones are drawn.
    fn choose(&mut self) {
        self.order.clear();
        for (index, bone) in self.skeleton.bones.iter().enumerate() {
            if bone.part == Part::Bone && bone.parent.is_some() {
                // One a bone: there is room.
                let _ = self.order.push(index as u8);
            }
        }
    }

    /// Puts the farthest bone first. The order of the frame before is nearly right; bones as far as each other keep that of the
    /// skeleton, so that the outcome is the frame's alone.
    #[inline(never)]
    pub fn sort(&mut self) {
        // Twice the depth of a bone's middle, then its index.
        let key = |renderer: &Self, index: u8| {
            let ends = renderer.ends(index);
            ends.map_or(0, |(from, to)| (i32::from(from.depth) + i32::from(to.depth)) * 256 - i32::from(index))
        };
        for place in 1..self.order.len() {
            let Some(&moving) = self.order.get(place) else { return };
            let (own, mut place) = (key(self, moving), place);
            while let Some(&before) = self.order.get(place.wrapping_sub(1))
                && key(self, before) < own
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
    }

    /// The lines and dots of a pose, gathered.
    pub fn lines(&mut self, pose: Pose<'_>) -> Result<Lines<N>, WrongForm> {
        self.set_pose(pose)?;
        Ok(self.placed_lines())
    }

    /// The lines and dots of the pose that was placed last, gathered.
    pub fn placed_lines(&mut self) -> Lines<N> {
        self.sort();
        let mut lines = Lines::default();
        // There is room for all of them.
        if self.ground.dotted {
            self.each_dot(|dot| {
                let _ = lines.dots.push(dot);
            });
        } else {
            self.each_ground_line(|line| {
                let _ = lines.ground.push(line);
            });
        }
        self.each_bone(|line| {
            let _ = lines.bones.push(line);
        });
        lines.head = self.head();
        lines
    }

    /// The display's size.
    pub(crate) fn canvas(&self) -> Canvas {
        self.canvas
    }

    /// The ground.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Takes over the camera and the ground of another figure of the same rig.
    pub(crate) fn share_camera(&mut self, other: &Self) {
        self.orientation = other.orientation;
        self.canvas = other.canvas;
        self.offset = other.offset;
        self.camera = other.camera;
        self.view = other.view;
        self.ground = other.ground;
    }

    /// The figure's joints.
    pub fn skeleton(&self) -> &Skeleton<N> {
        &self.skeleton
    }

    /// The same, to be set up in place before [`FigureRenderer::look_at`].
    pub fn skeleton_mut(&mut self) -> &mut Skeleton<N> {
        &mut self.skeleton
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Moves the picture by whole pixels: a place among several figures. Cameras that are set up later keep it there, until
    /// [`FigureRenderer::set_up`].
    pub fn shift(&mut self, x: i16, y: i16) {
        self.offset = [self.offset[0].saturating_add(x), self.offset[1].saturating_add(y)];
        let (_, _, [column, row]) = self.camera.framing();
        self.camera.set_center(column + (i32::from(x) << PIXEL_BITS), row + (i32::from(y) << PIXEL_BITS));
    }

    /// Up and facing, as the camera takes them.
    pub fn orientation(&self) -> Orientation {
        self.orientation
    }

    /// Where in the world the camera looked at the last pose.
    pub fn target(&self) -> Vector {
        self.target
    }

    /// Where the joints of the last pose are in the camera's axes.
    pub fn joints(&self) -> &Kinematics<N, R> {
        &self.joints
    }
}

/// What the figure covers of the display over a clip, in sixteenths of a pixel from the target.
#[derive(Default)]
pub(crate) struct Extent {
    top: i32,
    bottom: i32,
    side: i32,
}

impl Extent {
    /// Takes in a figure of lines.
    pub(crate) fn include<const N: usize, R: RotationBackend>(&mut self, renderer: &FigureRenderer<N, R>) {
        self.include_bones(renderer);
        if let Some(head) = renderer.head() {
            self.widen(head.centre, head.radius);
        }
    }

    /// Takes in the bones.
    pub(crate) fn include_bones<const N: usize, R: RotationBackend>(&mut self, renderer: &FigureRenderer<N, R>) {
        renderer.each_bone(|Line { from, to, .. }| {
            self.widen(from, 0);
            self.widen(to, 0);
        });
    }

    /// Takes in a circle, in sixteenths of a pixel.
    pub(crate) fn widen(&mut self, [x, y]: [i16; 2], radius: i16) {
        let (x, y, radius) = (i32::from(x), i32::from(y), i32::from(radius));
        self.side = self.side.max(x.abs() + radius);
        self.top = self.top.min(y - radius);
        self.bottom = self.bottom.max(y + radius);
    }

    /// The scale at which all of it fits, with a margin of a 20th of the canvas, if it was seen at a scale of `trial`.
    fn scale(&self, canvas: Canvas, trial: i32) -> i32 {
        let unit = trial / 64;
        let fit = |pixels: u16, covered: i32| {
            let room = (i32::from(pixels) * 9 / 10) << PIXEL_BITS;
            room * 64 / (covered / unit).max(1)
        };
        fit(canvas.height, self.bottom - self.top).min(fit(canvas.width, 2 * self.side)).clamp(1, LARGEST_SCALE)
    }
}
