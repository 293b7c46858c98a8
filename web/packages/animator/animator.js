// A figure that plays one clip after another, with transitions, root motion and events. The firmware's animator.rs, transition.rs, carry.rs and switch.rs state each step.
import { abs, computeOf, floor, imul, max, min } from "../decoder/turning.js";
import { FREE, MOST, WHOLE, big, clamp, groupsOf, mixGroup, nearest, rewritten, headingOf, isTurn, rotated, scaledDown, turnedBy, weighted, wide, wideShifted, yawOf } from "./channels.js";
import { NORMAL, STATE, V, addPart, advance, beginLap, eachMoving, partOf, passLaps, placed, seek, start, travelOf } from "./track.js";

// Kinds of transitions: the third lets the difference of poses alone die out.
const CUT = 0;
const FADED = 2;
// Events that an update notes, at most.
const EVENTS = 16;
// Frames that are left of a transition where its cubics are solved again, so that the end is exactly zero.
const AGAIN = [2, 32, 128];
// The time in ns in which a difference of velocities dies out, at most, so that limbs do not swing past both motions.
const SWING_NS = 250e6;
// Frames that a transition advances by together with the clip in one update, at most.
const TOGETHER = 8;
// The word of a moving channel's state in the decoder that says whom it follows, and what that is if it reads its own segments.
const LEADER = 8;
const OWN = -1;

// Which joints of a clip are coded as exponential maps, as a text.
const codingOf = (clip) => (clip.coding ??= clip.joints.map(({ kinds }, index) => +(kinds !== clip.rig.joints[index].kinds)).join(""));
/** Whether poses of two clips mean the same. */
export const isAlike = (one, other) => one.rig.id === other.rig.id && one.exponent === other.exponent && codingOf(one) === codingOf(other);

// The root: the joint that carries the figure, in the form of a clip.
const rootOf = (clip, groups, carrier) => {
  const { rig } = clip;
  const { kinds, first } = rig.joints[carrier];
  const axis = rig.up.findIndex(Boolean);
  const turning = kinds.findIndex((kind) => kind > 2);
  const [shape, begin, count] = groups.find(([, begin, , index]) => index === carrier && begin === first + turning) ?? [FREE, 0, 0];
  const place = [1, 2].map((next) => kinds.indexOf((axis + next) % 3)).map((at) => (at < 0 ? at : first + at));
  return { axis, kinds, place, shape, channels: Array.from({ length: count }, (_, index) => begin + index), compute: computeOf(clip, carrier) };
};

// The cubics that bring differences and velocities to zero in a number of frames: factors for both.
const cubicOf = (frames) => {
  const fraction = (over, under) => {
    let shift = 29;
    while (shift < 58 && over * 2 ** shift < under * 2 ** 29) shift++;
    const factor = Number((big(over) << big(shift)) / big(under));
    return (x) => scaledDown(x, factor, shift);
  };
  const pairs = frames * (frames - 1);
  return [fraction(12, pairs * (frames + 1)), fraction(6, pairs), fraction(1, frames)];
};

/**
 * An animator that begins with frame 0 of a clip, carried by the joint of an index. Throws an Error for a rig without such a joint. `pose` is the one of this instant, whose root's
 * horizontal places are 0, and `placement` where the figure is: a BigInt for each horizontal axis, and an angle.
 */
export const animatorOf = (first, carrier) => {
  const { channels } = first.rig;
  const pose = new Int32Array(channels);
  // Differences that a transition takes away, their velocities, accelerations and slopes.
  const d = new Int32Array(channels);
  const v = new Int32Array(channels);
  const w = new Int32Array(channels);
  const k = new Int32Array(channels);
  const track = {};
  let groups, root, travel;
  let left = 0;
  // Frames that are left when velocities have died out, if that is before the end.
  let leftThen = 0;
  // Time of the transition's frame in ns, and whether the transition advances with the clip: then by how many frames it has.
  let rest = 0;
  let isCarried = false;
  let carried = 0;
  let place = [0n, 0n];
  let placement = [place, 0];
  let events = [];
  let lost = 0;

  const note = (event) => (events.length < EVENTS ? events.push(event) : lost++);
  const between = (isForward, from, to) => {
    const passed = [];
    for (const event of track.clip.events) {
      if (event.frame >= (isForward ? to : from)) break;
      if (event.frame >= (isForward ? from : to)) passed.push(event);
    }
    if (!isForward) passed.reverse();
    passed.forEach(note);
  };
  const pass = ({ from, isAfter, to, isAfterTo, laps, forward }) => {
    const { frames } = track.clip;
    if (laps && track.seam) passLaps(travel, track.seam, laps);
    const [begin, end, first, last] = forward ? [from + 1, to + 1, 0, frames] : [from + isAfter, to + isAfterTo, frames, 0];
    if (!laps) return between(forward, begin, end);
    between(forward, begin, last);
    for (let more = abs(laps); --more; ) between(forward, first, last);
    between(forward, first, end);
  };

  const solve = (from = 0, to = channels, frames = left) => {
    const [byPlace, byVelocity, end] = frames > 2 ? cubicOf(frames) : [];
    for (let c = from; c < to; c++) {
      if (!frames || !(d[c] | v[c])) d[c] = v[c] = w[c] = k[c] = 0;
      else if (frames < 2) {
        v[c] = -d[c];
        w[c] = d[c];
        k[c] = 0;
      } else if (frames < 3) {
        w[c] = -d[c] - 2 * v[c];
        k[c] = 2 * d[c] + 3 * v[c];
      } else {
        k[c] = byPlace(d[c]) + byVelocity(v[c]);
        w[c] = -end(v[c]) - floor((k[c] * (frames - 1)) / 2);
      }
    }
  };
  // Lets velocities die out in fewer frames than differences: the sum of two cubics is one.
  const solveApart = (few) => {
    const without = (other, frames) => {
      const kept = other.slice();
      other.fill(0);
      solve(0, channels, frames);
      other.set(kept);
      return [w, k].map((own) => own.slice());
    };
    const [accelerations, slopes] = without(v);
    without(d, few);
    for (let c = 0; c < channels; c++) {
      w[c] += accelerations[c];
      k[c] += slopes[c];
    }
  };
  // Not before velocities that die out in fewer frames have done so.
  const solvesAt = (at) => (at === leftThen ? at > 0 : AGAIN.includes(at) && (at < leftThen || !leftThen));
  const solveAgain = () => solvesAt(left) && solve();
  const runTransition = (elapsed) => {
    const { frameTimeNs } = track.clip;
    for (rest += elapsed; rest >= frameTimeNs && left; rest -= frameTimeNs) {
      left--;
      for (let c = 0; c < channels; c++) {
        if (!(d[c] | v[c])) continue;
        d[c] += v[c];
        v[c] += w[c];
        w[c] += k[c];
      }
      solveAgain();
    }
    if (!left) rest = 0;
  };

  // While differences are carried, they are what they were when that began: a number of frames later, they are these.
  const later = (c) => d[c] + imul(carried, v[c]) + imul((carried * (carried - 1)) / 2, w[c]) + imul((carried * (carried - 1) * (carried - 2)) / 6, k[c]);
  const laterVelocity = (c) => (v[c] + imul(carried, w[c]) + imul((carried * (carried - 1)) / 2, k[c])) | 0;
  const leaveCarried = () => {
    for (let c = 0; c < channels && isCarried; c++) {
      d[c] = later(c);
      v[c] = laterVelocity(c);
      w[c] += imul(carried, k[c]);
    }
    isCarried = false;
  };
  // Between frames a moving channel goes a part of the sum of the clip's velocity and the difference's, which is rounded once.
  const addCarried = () => {
    const part = partOf(track) >> 1;
    const { channels: moving, state } = track.player;
    for (let c = 0, next = 0; c < channels; c++) {
      const isMoving = moving[next] === c;
      if (isMoving || d[c] | v[c]) pose[c] += later(c) + weighted((laterVelocity(c) + (isMoving ? state[STATE * next + V] : 0)) | 0, part);
      next += isMoving;
    }
  };
  // Whether a transition may advance with a clip whose channels follow no others, before its last frame and past no frame where the cubics are solved.
  const carry = (frames) => {
    const { channels: moving, frame, state } = track.player;
    if (left < 3 || left < frames || frame + frames + 1 >= track.clip.frames ) return false;
    for (let passed = 1; passed < frames; passed++) if (solvesAt(left - passed)) return false;
    if (isCarried) return true;
    if (moving.some((_, index) => state[STATE * index + LEADER] !== OWN)) return false;
    for (const c of moving) if (!(d[c] | v[c])) w[c] = k[c] = 0;
    isCarried = true;
    carried = 0;
    return true;
  };
  // Lets clip and transition advance by the same frames; nothing if they part.
  const playCarried = (elapsed) => {
    const { clip: { frameTimeNs }, player } = track;
    const total = rest + elapsed;
    const frames = floor(total / frameTimeNs);
    if (!left || track.speed !== NORMAL || track.rest !== rest * 65536 || frames > TOGETHER || !carry(frames)) return leaveCarried();
    const from = player.frame;
    const isAfter = rest > 0;
    for (let step = frames; step--; ) player.step();
    carried += frames;
    left -= frames;
    rest = total - frames * frameTimeNs;
    track.rest = rest * 65536;
    if (frames && solvesAt(left)) {
      leaveCarried();
      solve();
    }
    return { from, isAfter, to: player.frame, isAfterTo: rest > 0, laps: 0, forward: true, left: 0 };
  };

  const leavePlace = () => {
    for (const channel of root.place) if (channel >= 0) pose[channel] = 0;
  };
  // Writes the pose of the instant, and takes the root's place out of it.
  const compose = () => {
    const part = floor((rest * 65536) / track.clip.frameTimeNs) >> 1;
    pose.set(track.player.raw);
    if (isCarried) addCarried();
    else {
      for (let c = 0; c < channels && left; c++) if (d[c] | v[c]) pose[c] += d[c] + weighted(v[c], part);
      addPart(track, pose);
    }
    place = root.place.map((channel) => big(pose[channel] ?? 0));
    leavePlace();
  };
  const placedAt = (place) => placed(travel, place, track.seam);
  const locate = () => (placement = placedAt(place));
  const stand = (at) => {
    travel = travelOf(at, place);
    locate();
  };
  const isAlone = () => !left;

  // Lets time pass up to the end of a clip that is no loop, and returns the time that is left: ns.
  const play = (elapsed) => {
    let passage = playCarried(elapsed);
    const isApart = !passage;
    passage ??= advance(track, elapsed, root, isAlone());
    pass(passage);
    if (isApart) runTransition(max(0, elapsed - passage.left));
    compose();
    locate();
    return passage.left;
  };
  // Lets time pass after the end of the clip: a transition still runs.
  const hold = (elapsed) => {
    if (!left || !elapsed) return;
    leaveCarried();
    runTransition(elapsed);
    compose();
    locate();
  };

  // The kept poses of up to 4 channels, of this instant and of a frame later, changed.
  const alter = (begin, count, make) => {
    const end = begin + min(count, 4);
    const [here, next] = make([...d.subarray(begin, end)], [...v.subarray(begin, end)]);
    d.set(here, begin);
    v.set(next, begin);
  };
  // Keeps the pose of this instant and of a frame of the new clip later, as difference and velocity. A weight of a second track may be mixed in.
  const ratioOf = (own, clip) => min(floor((clip.frameTimeNs * 65536) / own.clip.frameTimeNs), 2 ** 30);
  // Adds a weight of what the channels of a track move in a frame of the new clip.
  const addMotion = (own, weight, clip) => {
    const speed = floor((own.speed * ratioOf(own, clip)) / 65536);
    if (!own.stands) eachMoving(own, (c, x) => (v[c] += scaledDown(weighted(x, weight), speed, 16)));
  };
  const takeMotion = (clip, second, weight) => {
    const ratio = ratioOf(track, clip);
    for (let c = 0; c < channels; c++) {
      d[c] = pose[c];
      v[c] = pose[c] + (left ? scaledDown(v[c], ratio, 16) : 0);
    }
    addMotion(track, WHOLE - weight, clip);
    if (second) addMotion(second, weight, clip);
  };
  // Turns the root in the kept poses, and its horizontal velocity.
  const turnMotion = (by) => {
    const turned = (own) => turnedBy(by, root.axis, root.shape, root.kinds, own);
    const [begin = 0] = root.channels;
    alter(begin, root.channels.length, (here, next) => [turned(here), turned(next)]);
    if (root.place.includes(-1)) return;
    rotated(headingOf(by), ...root.place.map((c) => big((v[c] - d[c]) | 0))).forEach((x, axis) => {
      const c = root.place[axis];
      v[c] = d[c] + Number(big.asIntN(32, x));
    });
  };
  // Makes the kept poses the difference to the new clip's pose, and its velocity.
  const takeDifference = (isFaded) => {
    const { raw } = track.player;
    for (const [shape, begin, count] of groups) {
      if (!shape) continue;
      alter(begin, count, (here, next) => {
        here = nearest(shape, here, raw.subarray(begin, begin + count));
        return [here, nearest(shape, next, here)];
      });
    }
    for (let c = 0; c < channels; c++) {
      v[c] = isFaded ? 0 : v[c] - d[c];
      d[c] -= raw[c];
    }
    if (!isFaded) eachMoving(track, (c, own) => (v[c] -= scaledDown(own, track.speed, 16)));
  };
  // Brings the kept poses from the old clip's form to that of the new one.
  const convert = (old, clip) => {
    const { joints } = clip.rig;
    const unit = 2 ** clamp(old.exponent - clip.exponent, -31, 31);
    groups = groupsOf(clip);
    joints.forEach(({ kinds, first }, index) => {
      const inUnit = (x) => clamp(floor(x * unit), -MOST, MOST);
      kinds.forEach((kind, at) => kind < 3 && alter(first + at, 1, ([here], [next]) => [[inUnit(here)], [inUnit(next)]]));
      const wasMap = old.joints[index].kinds !== old.rig.joints[index].kinds;
      const group = kinds.some(isTurn) && groups.find(([shape, , , own]) => own === index && (shape === 1 || shape === 2));
      const was = wasMap ? 2 : 1;
      if (group && group[0] !== was) alter(group[1], group[2], (...poses) => poses.map((own) => rewritten(was, group[0], kinds, own)));
    });
    root = rootOf(clip, groups, carrier);
  };
  // Goes over to a clip of the same rig from a frame, in a number of frames of the new clip. On an error the old clip plays on.
  const change = (clip, frame, speed, kind, frames, second, weight = 0) => {
    const old = track.clip;
    let [now, heading] = placement;
    if (old.rig.id !== clip.rig.id) throw new Error("pantin: another rig");
    leaveCarried();
    root.compute(pose);
    const yaw = yawOf(root.axis);
    takeMotion(clip, second, weight);
    start(track, clip, frame, speed);
    if (!isAlike(old, clip)) {
      convert(old, clip);
      now = now.map((x) => wideShifted(x, old.exponent - clip.exponent));
    }
    // The new clip's heading stands where the old one's stood.
    root.compute(track.player.raw);
    const turned = (yaw - yawOf(root.axis)) | 0;
    turnMotion(-turned | 0);
    takeDifference(kind === FADED);
    left = kind === CUT ? 0 : frames;
    rest = 0;
    const few = max(2, Math.ceil(SWING_NS / clip.frameTimeNs));
    leftThen = few + 2 < left ? left - few : 0;
    if (leftThen) solveApart(few);
    else solve();
    // The figure keeps its place: only the root's velocity dies out, and where it carries the root is added to the way.
    for (const c of root.place) if (c >= 0) {
      d[c] = -Math.trunc((v[c] * left) / 3);
      solve(c, c + 1);
    }
    between(true, track.player.frame, track.player.frame + 1);
    compose();
    stand([now, (heading + turned) | 0]);
  };
  // Mixes another pose of the clip's form in, but not the root's horizontal place: groups that `has` says, at a weight.
  const mix = (other, values, weight, has) => {
    if (!isAlike(track.clip, other.clip)) throw new Error("pantin: another form");
    for (const group of groups) if (has(group[3])) mixGroup(pose, values, group, weight);
  };

  start(track, first);
  if (!first.rig.joints[carrier]) throw new Error("pantin: no joint carries the figure");
  groups = groupsOf(first);
  root = rootOf(first, groups, carrier);
  track.lapped = first.looped;
  between(true, 0, 1);
  compose();
  travel = travelOf(placement, place);
  return {
    track, pose, play, hold, stand, change, mix, leavePlace, leaveCarried, placedAt,
    seek: (frame) => {
      leaveCarried();
      seek(track, frame);
      compose();
      locate();
    },
    forget: () => {
      events = [];
      lost = 0;
    },
    // What tests compare.
    get lost() {
      return lost;
    },
    get events() {
      return events;
    },
    // Lets the figure go a way of the world beside its clip's while the transition lasts. Nothing moves in this instant; the next pose that is composed brings the place after.
    glide: (way) => {
      const turned = rotated(headingOf(-travel.heading[0] | 0), ...way).map((x, axis) => (root.place[axis] < 0 ? 0n : x));
      travel.origin = travel.origin.map((x, axis) => wide(x - turned[axis]));
      turned.forEach((x, axis) => {
        const c = root.place[axis];
        d[c] -= Number(x);
        solve(c, c + 1);
      });
    },
    beginLap: (second) => beginLap(second, root),
    // Where the roots of the animator's track and of a second one are.
    roots: (second) => {
      const at = root.place.map((channel) => second.player.raw[channel] ?? 0);
      const part = partOf(second) >> 1;
      if (second.rest) eachMoving(second, (c, own) => root.place.includes(c) && (at[root.place.indexOf(c)] = (at[root.place.indexOf(c)] + weighted(own, part)) | 0));
      return [place.map(Number), at];
    },
    // Lets the figure go a way of the clip's axes beside the clip.
    lead: (way) => {
      const turned = rotated(travel.lapHeading, ...way.map(big));
      travel.origin = travel.origin.map((x, axis) => wide(x - turned[axis]));
      locate();
    },
    get groups() {
      return groups;
    },
    get left() {
      return left;
    },
    get place() {
      return root.place;
    },
    get placement() {
      return placement;
    },
  };
};
