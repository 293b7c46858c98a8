// The state machine of a bank, and what it plays: an animator, the second clip of a blend, and layers. The firmware's machine.rs and character.rs state each step.
import { floor, max, min } from "../decoder/turning.js";
import { animatorOf } from "./animator.js";
import { WHOLE, big, clamp, isTurn, weighted } from "./channels.js";
import { inStep, strideOf } from "./gait.js";
import { ABOVE, END, EVENT, INPUT, NOTHING, RELEASED, maskOf } from "./machine-table.js";
import { NORMAL, addPart, advance, close, partOf, seek, setSpeed, start } from "./track.js";

// How often the state changes in one instant, and at how many instants in the middle of an update, at most.
const CHANGES = 4;
// What a layer does.
const RESTS = 0;
const PLAYS = 1;
const FADES = 2;
const LONGEST = 2n ** 63n;
// Poses of a clip that the camera looks at, at most.
const VISITS = 24;

const bit = (index) => (index < 32 ? 1 << index : 0);

// The carrier of a figure that plays several clips: the first joint with positions that moves in one of them. Captures often hang on a joint that stands still at the origin; where
// one above the carrier is turned, it stays the carrier.
const carrierOf = ({ joints }, players) => {
  const isPlace = (kind) => kind < 3;
  const hasPlace = ({ kinds }) => kinds.some(isPlace);
  let carrier = Infinity;
  let upright = Infinity;
  for (const { channels, raw } of players) {
    joints.some((joint, index) => {
      const { kinds, first } = joint;
      if (index >= carrier) return true;
      if (hasPlace(joint) && channels.some((channel) => channel >= first && channel < first + kinds.length)) {
        carrier = index;
        return true;
      }
      if (kinds.some((kind, at) => !isPlace(kind) && (!isTurn(kind) || raw[first + at]))) upright = min(upright, index);
    });
  }
  return carrier === Infinity || upright < carrier ? max(0, joints.findIndex(hasPlace)) : carrier;
};

/**
 * The character of a bank: `open` opens its clips by their index, and `table` is that of its state machine. Throws an Error for clips that are damaged or lack what the machine needs.
 * `update` does so for a clip that a state or a layer begins to play; the old state goes on then. `lendFeet` makes what holds the feet of an animator, if the bank has a table of them.
 */
export const characterOf = (rig, table, open, lendFeet) => {
  const clips = [];
  const clipOf = (index) => (clips[index] ??= open(index));
  const { states, parameters } = table;
  const values = parameters.map(([, , value]) => value);
  let state = table.first;
  let fired = 0;
  let held = 0;
  let heldBefore = 0;
  let seen = 0;
  let entered = false;
  let isBlending = false;
  // How much of the second clip is mixed in, of WHOLE.
  let mixed = 0;
  // Where both clips and their roots were in the last update, if they are in step.
  let led;
  // The index of the transition that waits for a matching foot.
  let waiting = Infinity;

  function* players() {
    for (const row of states) yield clipOf(row.clip).play();
  }
  // One that plays backwards and is no loop begins at its last frame, where it would be over at frame 0.
  const begun = (frame, { looped, frames }, speed) => (!frame && speed < 0 && !looped ? frames - 1 : frame);
  const row = () => states[state];
  const initial = clipOf(row().clip);
  const animator = animatorOf(initial, carrierOf(rig, [...players()]));
  const { pose, track } = animator;
  setSpeed(track, row().speed);
  const frame = begun(0, initial, row().speed);
  if (frame) {
    animator.seek(frame);
    animator.stand([[0n, 0n], 0]);
  }
  const feet = lendFeet?.(animator);
  const second = start({}, initial);
  const layers = table.layers.map((layer) => {
    const clip = clipOf(layer.clip);
    return { ...layer, mask: maskOf(rig, layer.patterns), track: start({}, clip), sampled: new Int32Array(rig.channels), left: 0, weight: 0, to: 0, doing: RESTS };
  });

  // ---- Blends
  const weightOf = (parameter) => {
    const [low, high] = parameters[parameter];
    return clamp(Math.trunc(((values[parameter] - low) * WHOLE) / (high - low)), 0, WHOLE);
  };
  // The way between two instants of a loop, less than a lap, in the clip's axes; nothing over a seam that turns the figure.
  const wayBetween = ([before, from], [now, to], seam, isForward) => {
    const way = to.map((x, axis) => (x - from[axis]) | 0);
    if (isForward ? now >= before : now <= before) return way;
    if (seam && !seam.turn) return way.map((x, axis) => (x + (isForward ? 1 : -1) * Number(big.asIntN(32, seam.way[axis]))) | 0);
  };
  // Lets the second clip lead the figure too: by a weight of its way since the update before.
  const lead = (weight) => {
    const places = animator.roots(second);
    const instants = [track, second].map((own, index) => [own.player.frame + partOf(own) / 65536, places[index]]);
    const [own, its] = [track, second].map(({ seam }, index) => led && wayBetween(led[index], instants[index], seam, track.speed >= 0));
    if (own && its) animator.lead(its.map((x, axis) => weighted((x - own[axis]) | 0, weight)));
    led = instants;
  };
  // Brings the second clip in step with the first by the footsteps of both, and lets the first play at a speed between the two.
  const keepStep = (weight) => {
    const strides = [track, second].map(({ clip }) => strideOf(clip));
    if (strides.includes(-1)) return seek(second, track.player.frame);
    // The stride takes a time between those of the two clips, whatever their frame rates.
    const [time, its] = [track, second].map(({ clip }, index) => big(strides[index]) * big(clip.frameTimeNs));
    const mixed = time + (((its - time) * big(weight)) >> 15n);
    const speedOf = (time) => {
      const fast = clamp(time * big(row().speed), -LONGEST, LONGEST - 1n);
      return mixed ? Number(clamp(fast / mixed, -4n * big(NORMAL), 4n * big(NORMAL))) : 0;
    };
    setSpeed(track, speedOf(time));
    setSpeed(second, speedOf(its));
    const at = inStep(track, second.clip, second.player.frame);
    if (at < 0) throw new Error("pantin: no footsteps");
    seek(second, floor(at / 65536));
    second.rest = (at % 65536) * second.clip.frameTimeNs;
    if (second.rest) close(second);
    if (track.clip.looped && second.clip.looped) lead(weight);
  };
  // Lets the blend follow its parameter.
  const keepUp = (elapsed) => {
    if (!isBlending) return;
    const { by, follow } = row();
    const to = weightOf(by);
    const step = Math.ceil((elapsed * WHOLE) / follow);
    mixed = follow ? clamp(to, mixed - step, mixed + step) : to;
  };
  const blend = () => {
    const { other, by, follow, speed } = row();
    if (other === NOTHING) return;
    if (!isBlending) {
      start(second, clipOf(other), 0, speed);
      if (second.clip.looped) animator.beginLap(second);
      mixed = follow ? 0 : weightOf(by);
      led = undefined;
    }
    isBlending = true;
    keepStep(mixed);
    animator.mix(second, second.player.raw, mixed, () => true);
    addPart(second, pose, mixed);
    animator.leavePlace();
  };

  // ---- Transitions
  const happens = ({ cause, argument, threshold }, [down, up, heard]) =>
    cause === END ? track.ended
    : cause === INPUT ? down & bit(argument)
    : cause === RELEASED ? up & bit(argument)
    : cause === EVENT ? animator.events.slice(heard).some(({ id }) => id === argument)
    : cause === ABOVE ? values[argument] > threshold : values[argument] < threshold;
  const make = ({ to, kind, frames, start: first }, at) => {
    const { clip: index, speed } = states[to];
    const clip = clipOf(index);
    // Without footsteps it begins at its first frame.
    const frame = at ?? (first === NOTHING ? max(0, floor(inStep(track, clip, 0) / 65536)) : first);
    // Until here the pose has the first clip's part alone.
    if (isBlending) blend();
    animator.change(clip, begun(frame, clip, speed), speed, kind, frames, isBlending && second, isBlending ? mixed : 0);
    state = to;
    waiting = Infinity;
    isBlending = false;
    entered = true;
  };
  // Takes the first transition whose condition holds, then those of the states that are entered: all in one instant, so that the display rate does not matter. None leads back, but in its
  // first state a machine may start the same state again. One that waits is made unless one before it happens, and at the end of its clip. Returns whether there was one.
  const enter = (inputs, then) => {
    const been = new Set();
    for (let count = 0; count < CHANGES; count++) {
      been.add(state);
      const own = state;
      const isOpen = (transition) => !(been.size > 1 && been.has(transition.to)) && happens(transition, inputs);
      const isDue = waiting < Infinity && track.ended;
      let index = table.transitions.indexOf(table.anywhere.find((transition) => transition.to !== own && isOpen(transition)) ?? table.ways[own].find(isOpen));
      // Without its sign, -1 is no index: nothing waits before it.
      if (index >>> 0 >= waiting) index = isDue ? waiting : -1;
      if (index < 0) return count > 0;
      if (!isDue && feet?.next(index)) {
        waiting = index;
        return count > 0;
      }
      make(table.transitions[index]);
      inputs = [...then, animator.events.length];
    }
    return true;
  };
  const run = (left) => {
    const before = [held & heldBefore, ~(held | heldBefore)];
    let heard = 0;
    for (let count = 0; count < CHANGES; count++) {
      heard = animator.events.length;
      const entry = feet?.next(waiting);
      const whole = entry?.[1] < left ? entry[1] : left;
      const isEntry = whole < left;
      left += animator.play(whole) - whole;
      if (!left) break;
      if (isEntry) make(table.transitions[waiting], entry[0]);
      else if (!enter([...before, heard], before)) break;
      blend();
    }
    animator.hold(left);
    enter([fired | held, ~held, heard], [held, ~held]);
    blend();
  };

  // ---- Layers
  const fadeTo = (layer, weight) => {
    layer.to = weight;
    layer.left = layer.fade;
    if (!layer.fade) layer.weight = weight;
  };
  const fade = (layer, elapsed) => {
    if (elapsed >= layer.left) {
      layer.weight = layer.to;
      layer.left = 0;
    } else {
      layer.weight += Math.trunc(((layer.to - layer.weight) * elapsed) / layer.left);
      layer.left -= elapsed;
    }
  };
  // A loop is to go when its input is let go, another clip when what is left of it is the time that it takes to go.
  const isOver = ({ track: { clip, player, ended }, input, fade }) =>
    clip.looped ? !(held & bit(input)) : ended || max(0, clip.frames - player.frame - 1) * clip.frameTimeNs <= fade * 1000;
  const updateLayer = (layer, elapsed) => {
    const { input, mask, sampled } = layer;
    const isAllowed = (layer.states[state >> 3] >> (state & 7)) & 1;
    if (layer.doing === RESTS) {
      if (!isAllowed || !(seen & bit(input))) return;
      start(layer.track, clipOf(layer.clip));
      fadeTo(layer, WHOLE);
      layer.doing = PLAYS;
    } else {
      advance(layer.track, elapsed * 1000);
      fade(layer, elapsed);
    }
    if (layer.doing === PLAYS && (!isAllowed || isOver(layer))) {
      fadeTo(layer, 0);
      layer.doing = FADES;
    }
    const { weight } = layer;
    if (layer.doing === FADES && !weight) {
      layer.doing = RESTS;
      return;
    }
    sampled.set(layer.track.player.raw);
    addPart(layer.track, sampled);
    animator.mix(layer.track, sampled, weight, (index) => weight && mask.has(index));
    animator.leavePlace();
  };

  const hold = (input, isDown) => (held = isDown ? held | bit(input) : held & ~bit(input));
  return {
    animator, initial, hold, parameters,
    names: table.names,
    fire: (input) => (fired |= bit(input)),
    // Within its range; what the table lacks does nothing.
    set: (parameter, value) => {
      if (parameter in values) values[parameter] = clamp(value, parameters[parameter][0], parameters[parameter][1]);
    },
    get state() {
      return state;
    },
    get entered() {
      return entered;
    },
    // Lets time pass, in microseconds up to 71 minutes, then takes the transition whose condition holds.
    update: (elapsed) => {
      animator.forget();
      entered = false;
      keepUp(elapsed);
      try {
        run(elapsed * 1000);
      } finally {
        seen = fired | held;
        fired = 0;
        heldBefore = held;
      }
      layers.forEach((layer) => updateLayer(layer, elapsed));
      // Of two clips that are blended the figure has the feet of the one that there is more of.
      const { clip, other } = row();
      const [own, { player }] = isBlending && mixed > WHOLE / 2 ? [other, second] : [clip, track];
      feet?.hold(own, player.frame, isBlending && mixed > 0 && mixed < WHOLE, entered, elapsed);
    },
    // Some poses of the states' clips, with the root at the origin.
    *poses() {
      for (const player of players()) {
        const { frames } = player.clip;
        for (let at = 0, stride = max(1, Math.ceil(frames / VISITS)); at < frames; at += stride) {
          const values = player.seek(at).raw.slice();
          for (const channel of animator.place) if (channel >= 0) values[channel] = 0;
          yield values;
        }
      }
    },
  };
};
