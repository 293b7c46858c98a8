// A clip at play by time: any display rate, speeds of -4 to 4, without drift. The firmware's track.rs and root.rs state each step.
//
// A track has a clip, its player, and the values `first` with which its moving channels begin; `rest` is the time after the frame in 2^-16 ns.
import { abs, floor, imul, max, round } from "../decoder/turning.js";
import { WHOLE, big, clamp, headingOf, nearest, rotated, turnOf, turnedBy, weighted, wide, wideShifted, yawOf } from "./channels.js";

// Speed 1.
export const NORMAL = 65536;
// Words of a moving channel's state in the decoder. The first is its value; V is the place of its velocity.
export const STATE = 9;
export const V = 1;
// Laps of a loop in one update, at most.
const LAPS = 64;
// A loop whose root comes back to within 5 cm, or 5 degrees, stays in its place, or keeps its heading. A rotation that is an eighth of a turn from that of frame 0
// turns on from lap to lap.
const NEAR = 5000000n;
const NEAR_TURN = 59652323;
const FAR_TURN = 2 ** 29;
// The root with the values of its channels, with those that come next, or with those of frame 0.
const NOW = 0;
const NEXT = 1;
const FIRST = 2;

const quotient = (a, b) => a / b - big(a % b < 0n);
export const size = (x) => (x < 0 ? -x : x);
// 5 cm in the unit of a clip's positions.
const nearOf = ({ rig, exponent }, most) => wideShifted(NEAR, -max(exponent, -most)) / big(round(rig.cmPerUnit * 1e6));

export const setSpeed = (track, speed) => {
  track.speed = clamp(speed, -4 * NORMAL, 4 * NORMAL);
  track.ended = track.stands = false;
};
const goTo = (track, frame) => {
  const { player, clip } = track;
  if (frame >= clip.frames) frame = clip.frames - 1;
  if (frame === player.frame) return;
  track.closed = false;
  player.seek(frame);
};
export const seek = (track, frame) => {
  goTo(track, frame);
  track.rest = 0;
  track.ended = track.stands = false;
};
// Plays a clip from a frame.
export const start = (track, clip, frame = 0, speed = NORMAL) => {
  const player = clip.play();
  Object.assign(track, { clip, player, first: player.state.slice(), rest: 0, ended: false, closed: false, lapped: false, seam: null });
  goTo(track, frame);
  setSpeed(track, speed);
  return track;
};
export const isLast = ({ clip, player }) => player.frame + 1 >= clip.frames;
// How far the instant is on the way from its frame to the next, in 2^-16.
export const partOf = ({ rest, clip }) => floor(rest / clip.frameTimeNs);
// Passes the moving channels and their velocities.
export const eachMoving = ({ player }, each) => {
  const { channels, state } = player;
  for (let index = 0; index < channels.length; index++) each(channels[index], state[index * STATE + V]);
};
// Adds a weight of what the channels move between the frame and the instant.
export const addPart = (track, out, weight = WHOLE) => {
  const part = ((partOf(track) >> 1) * weight) >> 15;
  if (track.rest) eachMoving(track, (channel, v) => (out[channel] += weighted(v, part)));
};

// Makes the velocities on a loop's last frame lead to frame 0, but for positions and rotations that do not come back: they go on as they did.
const leadToStart = ({ clip, player, first }) => {
  const { channels, raw, state } = player;
  const bound = Number(nearOf(clip, 31));
  let index = 0;
  const wayOf = (index) => (first[index * STATE] - raw[channels[index]]) | 0;
  const gapOf = (index) => abs((wayOf(index) - state[index * STATE + V]) | 0);
  clip.rig.joints.forEach(({ kinds, first: begin }) => {
    const from = index;
    let turnsOn = false;
    for (; channels[index] < begin + kinds.length; index++) turnsOn ||= kinds[channels[index] - begin] > 2 && gapOf(index) > FAR_TURN;
    for (let own = from; own < index; own++) if (!(kinds[channels[own] - begin] < 3 ? gapOf(own) > bound : turnsOn)) state[own * STATE + V] = wayOf(own);
  });
  for (; index < channels.length; index++) state[index * STATE + V] = wayOf(index);
};

// What the root's channels are at an instant of its track, and how far it is turned.
const valueAt = ({ player, first }, what, channel) => {
  const { channels, raw, state } = player;
  const index = channels.indexOf(channel) * STATE;
  return index < 0 || !what ? (raw[channel] ?? 0) : what === NEXT ? (raw[channel] + state[index + V]) | 0 : first[index];
};
const turnsAt = (track, root, what) => root.channels.map((channel) => valueAt(track, what, channel));
const rootAt = (track, root, what) => [
  root.place.map((channel) => valueAt(track, what, channel)),
  turnOf(root.shape, root.kinds, turnsAt(track, root, what)) ? yawOf(root.axis) : 0,
];
// Finds where a lap takes the root: between the last frame of a loop and its first.
const findSeam = (track, root, [first, yaw], [next, nextYaw]) => {
  const turned = (nextYaw - yaw) | 0;
  const turns = abs(turned) > NEAR_TURN && !root.place.includes(-1);
  const way = next.map((to, axis) => big(to - first[axis]));
  const near = nearOf(track.clip, 40);
  const isNear = !turns && way.every((x) => size(x) <= near);
  track.seam = { first: first.map(big), way: isNear ? [0n, 0n] : way, turn: turns ? turned : 0 };
};
// On the last frame of a loop, lets the velocities lead to frame 0: those of the root, if one travels with the track, to where the next lap begins.
export const close = (track, root) => {
  const { clip, player, first } = track;
  if (track.closed || !clip.looped || !isLast(track)) return;
  // Without the lap to come, the root moves on as it did.
  const next = root && !track.seam && rootAt(track, root, NEXT);
  leadToStart(track);
  track.closed = true;
  if (!root) return;
  if (next) findSeam(track, root, rootAt(track, root, FIRST), next);
  const { way, turn } = track.seam;
  const { channels, raw, state } = player;
  let turns = [];
  if (turn && root.channels.length < 5) {
    turns = turnedBy(turn, root.axis, root.shape, root.kinds, turnsAt(track, root, FIRST));
    turns = nearest(root.shape, turns, root.channels.map((channel) => raw[channel]));
  }
  channels.forEach((channel, index) => {
    const axis = root.place.indexOf(channel);
    const to = axis < 0 ? turns[root.channels.indexOf(channel)] : first[index * STATE] + Number(big.asIntN(32, way[axis]));
    if (to !== undefined) state[index * STATE + V] = to - raw[channel];
  });
};
// Goes from the last frame of a loop to frame 0. In the first lap, learns where a lap takes the root. `isAlone`: no transition runs.
const lap = (track, root, isAlone) => {
  const next = root && !track.seam && rootAt(track, root, NEXT);
  goTo(track, 0);
  if (next) findSeam(track, root, rootAt(track, root, NOW), next);
  track.lapped ||= isAlone;
};
// Goes to the first frame of a loop, with where a lap of it takes the root.
export const beginLap = (track, root) => {
  seek(track, track.clip.frames);
  lap(track, root, false);
};

// Lets time pass, up to 2^42 ns. Returns the stretch of play: its first and last frame, whether the instants lie after these, how often the seam of a loop was passed, and
// the time that is left after the end of a clip that is no loop.
export const advance = (track, elapsed, root, isAlone) => {
  const { clip, player, speed } = track;
  const { frames, looped } = clip;
  // A clip that comes to its end moves on in this instant, so that a transition takes its motion over; then nothing moves.
  track.stands = track.ended;
  const frameTime = big(clip.frameTimeNs) << 16n;
  const from = player.frame;
  const isAfter = track.rest > 0;
  let rest = big(track.rest) + big(elapsed) * big(speed);
  const steps = quotient(rest, frameTime);
  rest -= steps * frameTime;
  const target = from + Number(steps);
  let to = target;
  let laps = 0;
  let left = 0;
  if (looped) {
    to = ((target % frames) + frames) % frames;
    laps = clamp((target - to) / frames, -LAPS, LAPS);
  } else if (target >= frames - 1 || target < 0) {
    to = target < 0 ? 0 : frames - 1;
    const over = size(big(target - to) * frameTime + rest);
    rest = 0n;
    if (over) track.ended = true;
    if (speed) left = Number(over / big(abs(speed)));
  }
  track.rest = Number(rest);
  if (laps && root && !track.seam) {
    goTo(track, frames);
    lap(track, root, isAlone);
  } else if (laps > 0 && !track.lapped) lap(track, root, isAlone);
  goTo(track, to);
  if (track.rest) close(track, root);
  return { from, isAfter, to, isAfterTo: track.rest > 0, laps, forward: speed >= 0, left };
};

// The way of a root since its clip was started at a placement, in two horizontal axes.
export const travelOf = ([place, heading], origin) => ({ anchor: place, heading: headingOf(heading), origin, laps: 0, lapHeading: headingOf(0), lapWay: [0n, 0n] });
// Passes the seam of a loop a number of times. A lap's way is turned by the laps before it, so that the same laps backwards take back the same numbers.
export const passLaps = (travel, { way, turn }, laps) => {
  const sign = Math.sign(laps);
  const face = () => (travel.lapHeading = headingOf(imul(turn, travel.laps)));
  for (let count = abs(laps); count--; ) {
    if (sign < 0) travel.laps--, face();
    travel.lapWay = rotated(travel.lapHeading, ...way).map((x, axis) => wide(travel.lapWay[axis] + big(sign) * x));
    if (sign > 0) travel.laps++, face();
  }
};
// Where the figure is while its root is at a place of the clip: the turn of a lap is about the place where the loop begins.
export const placed = (travel, place, seam) => {
  const first = seam?.first ?? [0n, 0n];
  const way = rotated(travel.lapHeading, ...place.map((x, axis) => x - first[axis])).map((x, axis) => wide(x + first[axis] + travel.lapWay[axis] - travel.origin[axis]));
  return [rotated(travel.heading, ...way).map((x, axis) => wide(travel.anchor[axis] + x)), (travel.heading[0] + travel.lapHeading[0]) | 0];
};
