//! A state machine at play: from the bank's bytes and inputs to pictures and places of joints.

use crate::render::scene::Scene;
use crate::render::smooth;
use anyhow::{Context, Result};
use pantin::{Bank, ChannelState, Clip, Matrix, Player};
use pantin_animator::machine::{FEET_SECTION, LAYERS, Table, TableError};
use pantin_animator::session::{Replay, Session};
use pantin_animator::{Character, Error, Feet, Group, LayerMemory, Mask, Memory, Offset, Placement, first_clip, visit_poses};
use pantin_convert::Remedy;
use pantin_figure::{CameraTarget, Canvas, Detail, FigureRenderer, JointInfo, RIG_JOINTS, Skeleton, Stand, View};
use pantin_images::image::Image;
use pantin_images::palette::Palette;
use pantin_images::shades::Shades;

/// Room for a character of a bank.
pub struct Room {
    states: Vec<ChannelState>,
    values: Vec<i32>,
    offsets: Vec<Offset>,
    pose: Vec<i32>,
    groups: Vec<Group>,
    second: (Vec<ChannelState>, Vec<i32>),
    layers: Vec<LayerRoom>,
    holds_feet: bool,
}

struct LayerRoom {
    states: Vec<ChannelState>,
    values: Vec<i32>,
    sampled: Vec<i32>,
    words: Vec<u32>,
}

impl Room {
    /// As much as the clips of a bank need.
    pub fn of(bytes: &[u8]) -> Result<Room> {
        let bank = Bank::new_checked(bytes)?;
        let (mut moving, mut channels, mut groups, mut words) = (0, 0, 0, 0);
        for entry in bank.entries() {
            let clip = bank.open(&entry)?;
            let rig = clip.rig();
            moving = moving.max(clip.moving());
            channels = channels.max(rig.channels());
            // One for the turns and one for the place of a joint, and one for each scalar.
            groups = groups.max(2 * rig.joint_count() + rig.channels());
            words = words.max(Mask::words(&rig));
        }
        let states = || vec![ChannelState::default(); moving];
        let values = || vec![0; channels];
        let layer = |_| LayerRoom { states: states(), values: values(), sampled: values(), words: vec![0; words] };
        Ok(Room {
            states: states(),
            values: values(),
            offsets: vec![Offset::ZERO; channels],
            pose: values(),
            groups: vec![Group::NONE; groups],
            second: (states(), values()),
            layers: (0..LAYERS).map(layer).collect(),
            holds_feet: bank.section(FEET_SECTION)?.is_some(),
        })
    }

    /// The character of the bank, at its start. `feet` is memory for what holds them.
    pub fn character<'a, 'm>(&'m mut self, bytes: &'a [u8], feet: &'m mut Feet<'a>) -> Result<Character<'a, 'm>> {
        let Room { states, values, offsets, pose, groups, second, layers, holds_feet } = self;
        let mut character = Character::new(bytes, Memory { states, values, offsets, pose, groups })?;
        character.lend_second(&mut second.0, &mut second.1)?;
        for LayerRoom { states, values, sampled, words } in layers.iter_mut().take(character.table().layers()) {
            character.lend_layer(LayerMemory { states, values, sampled, words })?;
        }
        if *holds_feet {
            character.lend_feet(feet)?;
        }
        Ok(character)
    }
}

/// Whether a bank has a state machine, or one that is damaged.
pub fn has_machine(bytes: &[u8]) -> bool {
    !matches!(Table::of_bank(bytes), Err(Error::Machine(TableError::Missing) | Error::Clip(_)))
}

/// Reads a session for a table; errors name the file and the line.
pub fn session<'a>(text: &'a str, name: &str, table: &Table<'a>) -> Result<Session<'a>> {
    Session::new_checked(text, table).map_err(|error| {
        let line = text.lines().nth(error.line.saturating_sub(1) as usize).unwrap_or("").trim();
        anyhow::anyhow!("{name}:{}: {}: {line}", error.line, error.to_string().split_once(": ").map_or("", |(_, words)| words))
    })
}

/// Where a figure stands, as the renderer takes it.
pub fn stand(placement: Placement) -> Stand {
    Stand { place: placement.place, heading: placement.heading }
}

/// The figure of a bank's state machine before a camera.
pub struct Stage {
    renderer: Box<FigureRenderer<RIG_JOINTS>>,
    size: [usize; 2],
    factor: usize,
}

impl Stage {
    /// A camera for the clips of all states. With [`CameraTarget::Fixed`] it sees all that a session shows.
    pub fn new<'a>(bytes: &'a [u8], size: [usize; 2], view: View, session: Option<&Replay<'a>>) -> Result<Stage> {
        let factor = size[0].max(size[1]).div_ceil(crate::render::figure::MOST_PIXELS);
        let [width, height] = size.map(|pixels| pixels.div_ceil(factor) as u16);
        let canvas = Canvas { width, height };
        let (mut room, mut feet) = (Room::of(bytes)?, Feet::new());
        let character = room.character(bytes, &mut feet)?;
        let mut skeleton = Skeleton::empty();
        let (pose, _) = character.pose();
        let rig = first_clip(bytes)?.rig();
        skeleton
            .set_up(&rig, Detail::Body, pose, &mut [JointInfo::default(); RIG_JOINTS])
            .context("this figure cannot be drawn")?;
        let form = pose.form.to_form();
        drop(character);
        let mut renderer = Box::new(FigureRenderer::empty());
        *renderer.skeleton_mut() = skeleton;
        let mut failed = None;
        match session.filter(|_| view.track == CameraTarget::Fixed) {
            None => renderer.look_at(canvas, view, |visit| {
                let Room { states, values, pose, .. } = &mut room;
                let visited =
                    visit_poses(bytes, states, values, pose, &mut |clip: &Clip, values| match form.check(clip.form_ref()) {
                        Ok(()) => visit(values),
                        Err(error) => failed = Some(anyhow::Error::from(error)),
                    });
                failed = failed.take().or(visited.err().map(Into::into));
            }),
            Some(replay) => renderer.look_at_stands(canvas, view, |visit| {
                let played = play(bytes, *replay, |character| {
                    let (pose, placement) = character.pose();
                    form.check(pose.form)?;
                    visit(pose.values, stand(placement));
                    Ok(())
                });
                failed = failed.take().or(played.err());
            }),
        }
        if let Some(error) = failed {
            let text = format!("{error:#}: the clips of a state machine are drawn together where they have one form");
            return Err(pantin_convert::Error::source(text).remedy(Remedy::ShareForm).into());
        }
        Ok(Stage { renderer, size, factor })
    }

    /// The renderer, with the character's pose of this instant placed.
    pub fn place(&mut self, character: &Character<'_, '_>) -> Result<&mut FigureRenderer<RIG_JOINTS>> {
        let (pose, placement) = character.pose();
        self.renderer.set_pose_at(pose, stand(placement))?;
        Ok(&mut self.renderer)
    }

    /// The character at this instant, as a display of pixels shows it.
    pub fn shades(&mut self, character: &Character<'_, '_>, ground: bool, mono: bool) -> Result<Shades> {
        let mut shades = Shades::new(self.size[0], self.size[1]);
        shades.draw_placed(self.place(character)?, ground, mono);
        Ok(shades)
    }

    /// The same as a picture: in pixels, or with smooth lines.
    pub fn image(&mut self, character: &Character<'_, '_>, smooth: bool, palette: &Palette) -> Result<Image> {
        if !smooth {
            return Ok(self.shades(character, true, palette.is_mono())?.image(palette));
        }
        let ([width, height], factor) = (self.size, self.factor as f32);
        Ok(smooth::draw(&Scene::of_placed(self.place(character)?, factor), width, height, palette))
    }
}

/// The view whose sides are those of the figure at the start: front sees its face. The camera of a [`Stage`] takes the mean of the directions in which the figure faces in the
/// clips of all states; where some face another way, a character turns them so that the figure goes on as it faces.
pub fn view_at_start(bytes: &[u8], view: View) -> Result<View> {
    let clip = first_clip(bytes)?;
    let canvas = Canvas { width: 64, height: 64 };
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut values = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut values)?;
    let own = FigureRenderer::<RIG_JOINTS>::of_clip(&mut player, canvas, view).context("this figure cannot be drawn")?;
    let mean = Stage::new(bytes, [64, 64], View { track: CameraTarget::Follow, ..view }, None)?.renderer.orientation();
    let ahead = own.orientation().facing.map(f64::from);
    let [up, facing] = [mean.up, mean.facing].map(|vector| vector.map(f64::from));
    let left: [f64; 3] = std::array::from_fn(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        (up[next] * facing[last] - up[last] * facing[next]) / 32_768.0
    });
    let along = |other: [f64; 3]| ahead.iter().zip(other).map(|(a, b)| a * b).sum::<f64>();
    let degrees = along(left).atan2(along(facing)).to_degrees().round() as i16;
    Ok(View { orbit: (view.orbit + degrees + 180).rem_euclid(360) - 180, ..view })
}

/// Plays a session from its start, and passes the character at each picture to `show`.
pub fn play<'a>(
    bytes: &'a [u8],
    mut replay: Replay<'a>,
    mut show: impl FnMut(&mut Character<'a, '_>) -> Result<()>,
) -> Result<()> {
    let (mut room, mut feet) = (Room::of(bytes)?, Feet::new());
    let mut character = room.character(bytes, &mut feet)?;
    while replay.next(&mut character)? {
        show(&mut character)?;
    }
    Ok(())
}

/// Where every joint of the character is in the world, in cm, in the order of the rig, End Sites included.
pub fn joints(character: &mut Character<'_, '_>) -> Vec<[f64; 3]> {
    let clip = *character.animator().track().clip();
    let (pose, placement) = character.pose();
    let rig = clip.rig();
    let cm = f64::from(rig.unit_micro_cm()) * 1e-6;
    let [own, rigs] = [pose.form.length_exponent(), rig.length_exponent()].map(|exponent| cm * f64::from(exponent).exp2());
    let up = rig.up().axis();
    let [sin, cos] = {
        let (sin, cos) = placement.heading.sin_cos();
        [sin, cos].map(|x| x.to_num::<f64>())
    };
    let mut world: Vec<(Matrix, [f64; 3])> = Vec::new();
    for (index, joint) in rig.joints().enumerate() {
        let Some(reference) = rig.joint_ref(index) else { continue };
        let moved = pose.position(&reference).unwrap_or_default();
        let offset: [f64; 3] =
            std::array::from_fn(|axis| moved[axis].map_or(f64::from(joint.offset[axis]) * rigs, |raw| f64::from(raw) * own));
        let turn = pose.turn(&reference).map_or(Matrix::IDENTITY, |turn| turn.matrix());
        world.push(match joint.parent.and_then(|parent| world.get(usize::from(parent))) {
            None => (turn, offset),
            Some((above, place)) => {
                // In 2^-16 cm, which the matrix takes as integers.
                let reach = above.apply(offset.map(|x| (x * 65_536.0) as i32));
                (above.then(&turn), std::array::from_fn(|axis| place[axis] + reach[axis] as f64 / 65_536.0))
            }
        });
    }
    let [a, b] = [(up + 1) % 3, (up + 2) % 3];
    let place = placement.place.map(|x| x as f64 * own);
    let stands = |(_, mut at): (Matrix, [f64; 3])| {
        (at[a], at[b]) = (at[a] * cos - at[b] * sin + place[0], at[a] * sin + at[b] * cos + place[1]);
        at
    };
    world.into_iter().map(stands).collect()
}
