// What <pantin-player> loads for a bank with a state machine: what steers it, and its figure where that stands.
import { round } from "../decoder/turning.js";
import { isAlike } from "../animator/animator.js";
import { clamp, wideShifted } from "../animator/channels.js";
import { opened } from "../animator/open.js";

const FAULT = "the bank contradicts itself";
// 71 minutes.
const LONGEST_TIME = 2 ** 32 - 1;
// Places farther than this, in a figure's own unit, are cut off.
const FAR = 2n ** 30n;
// Where the figure's inner parts have its rotations, and the exponent of its unit less that of its clip.
const TURNS = 5;
const SHIFT = 15;

// Where a figure stands, for `place` of figure.js. Of the figure's rotations, the last is the view's.
function standOf([place, heading], axis, shift, turns, [turnAbout, , imageOf]) {
  const offset = [0, 0, 0];
  const turned = (angle, v) => {
    const turn = [32768, 0, 0, 0, 32768, 0, 0, 0, 32768];
    turnAbout(turn, 0, axis, angle);
    return imageOf(turn, v);
  };
  place.forEach((x, index) => (offset[(axis + 1 + index) % 3] = Number(clamp(wideShifted(x, -shift), -FAR, FAR))));
  return (v, isBack) => {
    if (!isBack) return turned(heading, v).map((x, index) => (x + offset[index]) | 0);
    turnAbout(turns, turns.length - 9, axis, heading);
    return turned(-heading | 0, v.map((x, index) => (x - offset[index]) | 0));
  };
}

// Lets a player steer the state machine of a bank: it gets its names and its events.
export function steer(bank, player, keys) {
  const { rig, tools: [, , , , figureOf, maths] } = bank;
  let character;
  try {
    character = opened(bank, keys);
  } catch {
    throw new Error(FAULT);
  }
  const { animator, initial } = character;
  const [states, parameters, inputs] = character.names;
  const axis = rig.up.findIndex(Boolean);
  let figure, form, view, poses;
  const dispatch = (name, detail) => player.dispatchEvent(new CustomEvent(name, { detail }));
  const stand = () => {
    const { clip } = animator.track;
    // Clips of another form are drawn by a figure of theirs.
    if (!isAlike(form, clip)) return aim(...view);
    const inner = figure.inner();
    figure.place(animator.pose, standOf(animator.placement, axis, inner[SHIFT], inner[TURNS], maths));
  };
  // `look` sets the figure up in another look than lines.
  const aim = (...wanted) => {
    const { clip } = animator.track;
    const [picture, look] = (view = wanted);
    if (!figure || !isAlike(form, clip)) figure = figureOf(clip, animator.pose);
    form = clip;
    poses ??= [...character.poses()];
    const visit = (pose) => poses.forEach(pose);
    if (look) look(clip, figure, picture, visit, poses, player);
    else figure.aim(...picture, visit);
    stand();
  };
  player.states = states;
  player.inputs = inputs;
  player.parameters = parameters.map((name, index) => {
    const [low, high, value] = character.parameters[index];
    return { name, range: [low, high], value };
  });
  return {
    aim,
    each: (stroke) => figure?.each(stroke),
    get solid() { return figure?.solid; },
    facts: {
      frames: 1, playable: 1, frame: 0, frameTime: initial.frameTimeNs, looped: 0, channels: rig.channels, moving: 0, rigBytes: 0, motionBytes: 0, joints: rig.joints.length,
      scalars: rig.scalars.length,
    },
    // Lets time pass, in microseconds. A clip that is no good is not played: the state before goes on.
    pass(time) {
      try {
        character.update(clamp(time, 0, LONGEST_TIME) || 0);
      } catch {}
      const name = states[character.state];
      if (figure) stand();
      player.draw();
      for (const event of animator.events) dispatch("heard", event);
      if (name === player.state) return;
      player.state = name;
      dispatch("state", name);
    },
    // Fires an input (2), holds it down (1) or lets it go (0). Without it, a RangeError.
    input(name, what) {
      const index = inputs.indexOf(name);
      if (index < 0) throw new RangeError(`the state machine has no input ${name}; it has ${inputs.join(", ") || "none"}`);
      if (what > 1) character.fire(index);
      else character.hold(index, what);
    },
    set(name, value) {
      const index = parameters.indexOf(name);
      if (index < 0) throw new RangeError(`the state machine has no parameter ${name}`);
      const parameter = player.parameters[index];
      const [low, high] = parameter.range;
      parameter.value = clamp(round(value) || 0, low, high);
      character.set(index, parameter.value);
    },
  };
}
