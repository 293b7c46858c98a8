// Two clips in step, by the events of their footsteps. The firmware's sync.rs states each step.
import { abs, floor, min } from "../decoder/turning.js";
import { clamp } from "./channels.js";
import { partOf } from "./track.js";

// The footsteps of a clip: frames, and whether of the right foot.
const stepsOf = ({ events, eventNames }) => {
  const [left, right] = ["left_foot_down", "right_foot_down"].map((name) => eventNames.indexOf(name));
  return left < 0 || right < 0 ? [] : events.filter(({ id }) => id === left || id === right).map(({ frame, id }) => [frame, id === right]);
};
// Frames of a stride: from one footstep of the left foot to the next, on average; -1 without footsteps.
export const strideOf = (clip) => {
  const strides = stepsOf(clip).filter(([, isRight]) => !isRight).length;
  return strides ? floor(clip.frames / strides) : -1;
};
// The instant of a clip, in 2^-16 frames, that is in step with another: of several strides the one that is nearest to a frame. -1 without footsteps.
export const inStep = (track, clip, near) => {
  const { frame } = track.player;
  const { frames } = track.clip;
  const own = stepsOf(track.clip);
  const its = stepsOf(clip);
  if (!own.length || !its.length) return -1;
  // The foot that came down last, and how far the gait is on the way to the next footstep; over the seam of the loop.
  const [end, endRight] = own.at(-1);
  const [from, isRight] = own.findLast(([at]) => at <= frame) ?? [end - frames, endRight];
  const [to] = own.find(([at]) => at > frame) ?? [own[0][0] + frames];
  const part = to === from ? 0 : clamp(Math.trunc(((frame - from) * 65536 + partOf(track)) / (to - from)), 0, 0xffff);
  const whole = clip.frames * 65536;
  let best = -1;
  let least = Infinity;
  its.forEach(([before, wasRight], index) => {
    if (wasRight !== isRight) return;
    const [behind] = its[index + 1] ?? [its[0][0] + clip.frames];
    const at = (((before * 65536 + (behind - before) * part) % whole) + whole) % whole;
    const apart = abs(at - near * 65536);
    const away = min(apart, whole - apart);
    if (away >= least) return;
    least = away;
    best = at;
  });
  return best;
};
