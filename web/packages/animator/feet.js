// Planted feet stay where they are put: in states, and through transitions, which wait for a matching foot. The firmware's
// module feet, with chain.rs, two_bone.rs and ease.rs and the vectors of pantin-math, states each step. Places in the world are BigInts, as in animator.js.
import { Q, abs, clz32, floor, max, min, normalize, round } from "../decoder/turning.js";
import { MAP, MOST, big, clamp, headingOf, nearest, partsOf, rotated, weighted, wide, wideShifted, writtenTo } from "./channels.js";
import { must } from "./machine-table.js";
import { size } from "./track.js";

const { PI, asin, sin, sqrt, trunc } = Math;
const UNIT = 1 << 15;
const HALF = UNIT / 2;
const Q22 = 2 ** 22;
// Where the inner parts of a figure have its rotations, and what places its joints.
const FIGURE_TURNS = 5;
const FIGURE_PLACE = 7;
// Microseconds in which a foot that is let go comes back to its clip, and those of the longest step.
const RELEASE = 200000;
const LONGEST_STEP = 4000000;
// Those in which a figure goes down or comes up by nearly two thirds of its way: nearly straight legs bend by the root of it.
const DROP = 50000;
// The sine of the least bend of a knee that shows its axis, 2 degrees.
const LEAST_SINE = UNIT / 28;
const ORIGIN = [0, 0, 0];
// Rotations are nine numbers, as in figure.js.
const UNTURNED = [UNIT, 0, 0, 0, UNIT, 0, 0, 0, UNIT];

const farther = ([a, b]) => (size(a) > size(b) ? size(a) : size(b));
const plus = (a, b) => a.map((x, axis) => (x + b[axis]) | 0);
const difference = (a, b) => a.map((x, axis) => (x - b[axis]) | 0);
const squareOf = (vector) => vector.reduce((all, x) => all + x * x, 0);
const farTo = (a, b) => floor(sqrt(squareOf(difference(a, b))));
const anyBit = (vector) => vector.reduce((all, x) => all | abs(x), 0);
const cycled = (vector, by) => vector.map((_, axis) => vector[(axis + by) % 3]);
const scalarProduct = (a, b) => (a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + HALF) >> 15;
const crossed = (a, b) => a.map((_, axis) => (a[(axis + 1) % 3] * b[(axis + 2) % 3] - a[(axis + 2) % 3] * b[(axis + 1) % 3] + HALF) >> 15);
// A vector of length 1 at most, times a length below 2^16.
const times = (vector, by) => vector.map((x) => (min(max(x, -UNIT), UNIT) * (min(max(by, -0xffff), 0xffff) >> 1)) >> 14);
const transposed = (turn) => turn.map((_, index) => turn[(index * 3) % 8 || index]);

// Entries of the firmware's tables.
const rootEntry = (index) => round(Q22 / sqrt(index / 128));
const circleEntry = (index) => round(sin((index * PI) / 64) * Q22) >> 7;
// The direction of a vector in Q15, and its length; neither for a vector without length.
const directionOf = (vector) => {
  const largest = anyBit(vector);
  if (!largest) return [];
  const up = max(clz32(largest), 1) - 1;
  let down = 16;
  const parts = () => vector.map((x) => (x << up) >> down);
  down -= squareOf(parts()) < 2 ** 30;
  const square = min(squareOf(parts()), 2 ** 32 - 1);
  const index = square >>> 23;
  const root = rootEntry(index);
  const inverse = (root + (((rootEntry(index + 1) - root) * ((square >>> 8) & 0x7fff)) >> 15)) >> 7;
  return [parts().map((x) => (x * inverse + HALF) >> 15), floor((((((square >>> 15) + 1) >> 1) * inverse) >> 14) * 2 ** (down - up))];
};
// The angle of a unit vector.
const angleOf = (y, x) => {
  const across = abs(y);
  const along = abs(x);
  const small = min(across, along);
  const index = min(16, round((asin((2 * (small >> 8) + 1) / 256) * 64) / PI));
  let angle = index * 2 ** 25 + ((small * circleEntry(index + 32) - max(across, along) * circleEntry(index) + HALF) >> 15) * 20861;
  if (across > along) angle = 2 ** 30 - angle;
  if (x < 0) angle = -(2 ** 31) - angle;
  return (y < 0 ? -angle : angle) | 0;
};

// A part of the time in which a foot comes back, in 2^-15.
const shareOf = (since, whole) => floor((since * UNIT) / whole);

/**
 * The feet of the fields of a table whose checksum is right, for an animator of a bank with a number of clips. `maths` and `figureOf` are those of figure.js; the other tools are those of
 * character.js. Throws an Error for a table that contradicts itself or the rig. `next` has the frame of the new clip at which a transition that waits begins, and the time in ns until
 * then; `hold` corrects the pose of an update.
 */
export const feetOf = ({ u8, take, more }, clips, animator, figureOf, [turnAbout, sinCosOf, imageOf]) => {
  const { pose, track } = animator;
  const { rig } = track.clip;
  const up = rig.up.findIndex(Boolean);
  const upward = rig.up[up];
  const narrow = (x) => clamp(Number(x), -MOST, MOST);
  // x / 2^shift, cut off at the range.
  const shifted = (x, shift) => (shift < 0 ? narrow(x * 2 ** min(-shift, 31)) : x >> min(shift, 31));
  const added = (a, b) => a.map((x, axis) => wide(x + b[axis]));
  const apart = (a, b) => a.map((x, axis) => wide(x - b[axis]));
  // The form of the clip that was entered last: its groups, the exponent of its unit, and the shift of its places to figure units.
  let groups, shift;
  let { exponent } = track.clip;
  // The shift of the rig's offsets to figure units.
  const down = 18 - clz32(anyBit(rig.joints.flatMap(({ rest }) => rest)));

  // ---- The table
  const u16 = () => u8() | (u8() << 8);
  const rows = (length, of) => Array.from({ length }, of);
  const [version, count, own] = take(4);
  const counts = rows(2, u16);
  must(version === 1 && own === clips && (count === 1 || count === 2));
  // The ankle, how many points there are, a reserved byte, and the points.
  const named = rows(count, () => [u16(), u8(), u8(), u16(), u16(), u16(), u16()]);
  const ends = rows(clips, u16);
  // A foot, a point of it that is on the ground, and frames; a transition, a reserved byte, and frames of the old and the new clip.
  const [contacts, entries] = counts.map((count) => rows(count, () => [u8(), u8(), u16(), u16()]));
  must(!more() && ends.at(-1) === contacts.length && ends.every((end, clip) => end >= (ends[clip - 1] ?? 0)));
  contacts.forEach(([foot, point, from, to]) => must(foot < count && point <= named[foot][1] && from < to));

  // ---- Joints
  // What a figure of one joint makes of a map or a quaternion.
  const turnOf = [[10, 11, 12], [6, 7, 8, 9]].map((kinds) => {
    const joints = [{ name: "", parent: -1, kinds, first: 0, rest: ORIGIN }];
    const inner = figureOf({ rig: { joints, exponent: 0 }, joints, exponent: 0 }, []).inner();
    return (parts) => {
      inner[FIGURE_PLACE](parts, ORIGIN);
      return inner[FIGURE_TURNS];
    };
  });
  const then = (turn, other) => [0, 3, 6].flatMap((column) => imageOf(turn, other.slice(column, column + 3)));
  const columns = (a, b) => [...a, ...b, ...crossed(a, b)];
  const eulerOf = (turn, i, j, k) => {
    const at = (row, column) => turn[3 * column + row];
    const sign = (i + 1) % 3 === j ? 1 : -1;
    const [aim = ORIGIN] = directionOf([at(i, i), -sign * at(i, j), 0]);
    const third = angleOf(aim[1], aim[0]);
    const [sine, cosine] = sinCosOf(third);
    const image = (row) => (sign * at(row, i) * sine + at(row, j) * cosine) >> 15;
    return [angleOf(sign * image(k), image(j)), angleOf(sign * at(i, k), (at(i, i) * cosine - sign * at(i, j) * sine) >> 15), third];
  };
  // Makes a rotation the decoder's quaternion, by its largest component.
  const takeTurn = (turn) => {
    const trace = turn[0] + turn[4] + turn[8];
    const first = [UNIT + trace, turn[5] - turn[7], turn[6] - turn[2], turn[1] - turn[3]];
    // Four times the product of two components.
    const product = (a, b) => (a && b ? turn[3 * a + b - 4] + turn[3 * b + a - 4] + (a === b && UNIT - trace) : first[a + b]);
    const best = first.reduce((best, _, own) => (product(own, own) > product(best, best) ? own : best), 0);
    Q.set(first.map((_, own) => product(own, best) * 4096));
    normalize(Q);
  };
  const offsetOf = (index) => rig.joints[index].rest.map((x) => shifted(x, down));
  // The shape of what turns a joint, its axes, and its channels in a pose.
  const turningOf = (index, pose) => {
    const { kinds, first } = rig.joints[index];
    const turning = kinds.filter((kind) => kind > 2);
    const begin = first + kinds.indexOf(turning[0]);
    const [shape] = groups.find(([, from, , own]) => own === index && from === begin) ?? [0];
    return [shape, turning.map((kind) => (kind - (kind > 6)) % 3), pose.subarray(begin, begin + turning.length)];
  };
  // Where a joint is, and how what hangs on it is turned. `known` are those that are known of the pose.
  const jointAt = (index, pose, known) => (index < 0 ? [ORIGIN, UNTURNED] : (known[index] ??= follow(index, pose, known)));
  const follow = (index, pose, known) => {
    const { kinds, first, parent } = rig.joints[index];
    const [place, turn] = jointAt(parent, pose, known);
    const [shape, axes, own] = turningOf(index, pose);
    const turned = shape < MAP ? [...turn] : then(turn, turnOf[shape - MAP](partsOf(shape, kinds, own)));
    if (shape < MAP) axes.slice(0, 3).forEach((axis, at) => turnAbout(turned, 0, axis, own[at]));
    return [plus(place, imageOf(turn, offsetOf(index).map((x, axis) => (kinds.lastIndexOf(axis) < 0 ? x : shifted(pose[first + kinds.lastIndexOf(axis)], shift))))), turned];
  };
  // Writes a joint's rotation to its channels. One with fewer than three angles takes those that it has.
  const write = (index, parent, turn) => {
    const [shape, axes, own] = turningOf(index, pose);
    const local = then(transposed(parent), turn);
    if (shape < MAP) {
      const [i, j = (i + 1) % 3, k = (6 - i - j) % 3] = axes;
      own.set(nearest(shape, eulerOf(local, i, j, k), own).slice(0, axes.length));
    } else {
      takeTurn(local);
      own.set(writtenTo(shape, rig.joints[index].kinds, own));
    }
  };
  // The indices of the joints down to one.
  const chainOf = (index) => (rig.joints[index] ? [...chainOf(rig.joints[index].parent), index] : []);

  // ---- A foot
  const footOf = ([ankle, count, reserved, ...others]) => {
    // The ankle and the foot's points, and the joint above the leg, and hip, knee and ankle.
    const joints = [ankle, ...others.slice(0, count)];
    const chain = chainOf(ankle);
    const leg = [-1, ...chain].slice(-4);
    // A leg has three joints, and 12 lead to an ankle at most.
    must(count < 5 && !reserved && chain.length > 2 && chain.length < 13);
    joints.forEach((joint, index) => must(!index || joints.slice(0, index).includes(rig.joints[joint]?.parent)));
    // Lengths of thigh and shin, and the distances of hip and ankle that the knee allows: it bends by 150 degrees at most, and by 1 degree at least.
    const [upper, lower] = leg.slice(2).map((index) => directionOf(offsetOf(index))[1]);
    must(upper && lower);
    const [closest, farthest] = [1789569707, 11930465].map((bend) => floor(sqrt(max(0, upper ** 2 + lower ** 2 + floor((2 * upper * lower * sinCosOf(bend)[1]) / UNIT)))));
    // The axis of the knee, and the sine of the greatest bend that it was seen at; the point that is held, and where it stays; the one that was on the ground before, and where it was; -1 for none.
    let hinge;
    let most = 0;
    let point = -1;
    let before = -1;
    let anchor = [0n, 0n, 0n];
    let last = anchor;
    // Whether the height stays, too; whether it is not held before it has come back to its clip; how high it is lifted on its way, and how long that takes.
    let isLevel, steps;
    // The least height over the ground at which the pose had the held point.
    let lowest;
    let lift = 0;
    let whole = RELEASE;
    // For two horizontal axes and the height, a distance from the clip that dies out, the one that it would go in the whole time at its velocity, and the time since it was let go.
    let eases = [[0, 0, RELEASE], [0, 0, RELEASE], [0, 0, RELEASE]];

    const length = () => shifted(upper + lower, -shift);
    const legIn = (known = []) => leg.map((index) => jointAt(index, pose, known));
    const pointIn = (pose, point, known) => jointAt(joints[point], pose, known)[0].map((x) => shifted(x, -shift));
    const wholeOf = (axis) => (axis < 2 ? whole : RELEASE);
    // Lets go of the foot that is this far from where it goes, along one axis.
    const release = (again, far) => {
      point = -1;
      steps = again;
      lift = upward * (min(far, length() >> 1) >> 2);
      whole = RELEASE;
      eases = eases.map(([d, v, since], axis) => [d, v, axis < 2 || isLevel ? 0 : since]);
      isLevel = false;
    };
    // It steps back to its clip.
    const letGo = () => release(true, length() >> 2);
    const left = () => {
      const [a, b, height] = eases.map(([d, v, since], axis) => {
        const part = shareOf(since, wholeOf(axis));
        const rest = UNIT - part;
        const square = (rest * rest) >> 15;
        return narrow(weighted(d, (square * (UNIT + 2 * part)) >> 15) + weighted(v, (square * part) >> 15));
      });
      // The square of 4 t (1 - t), in 2^-13 of a lift, from rest to rest: nothing of a foot that is held, or where the clip has it.
      const part = shareOf(eases[0][2], whole);
      const rise = (part * (UNIT - part)) >> 15;
      return [a, b, (height + floor((lift * ((rise * rise) >> 13)) / 8192)) | 0];
    };
    // What is left of its way has no velocity from now on; its lift is a part of the height that is left.
    const settle = () => {
      const rest = left();
      eases = eases.map((ease, axis) => (axis < 2 || lift ? [rest[axis], 0, 0] : ease));
    };
    // Where it would be held at another point.
    const anchorAt = (world, contact) => added(anchor, apart(world(contact), world(point)));
    const unitOf = (vector, length) => vector.map((x) => (clamp(x, -length, length) * trunc(2 ** 29 / max(length, 256))) >> 14);
    const bonesOf = (hip, knee, ankle) => [unitOf(difference(knee, hip), upper), unitOf(difference(ankle, knee), lower)];
    // Remembers how the leg bends in a pose in which it bends as it should: not in one of a transition. At least 2 degrees tell it, and half of what was seen: nearly straight legs bend to any side.
    const learn = ([, [hip], [knee, turn], [ankle]]) => {
      const [bend, sine] = directionOf(crossed(...bonesOf(hip, knee, ankle)));
      if (!(sine > max(most >> 1, LEAST_SINE))) return;
      const own = imageOf(transposed(turn), bend);
      if (hinge && sine <= most && scalarProduct(own, hinge) < 0) return;
      hinge = own;
      most = max(most, sine);
    };
    // The distance of the ankle from the hip past which it comes less and less far, so that the leg does not snap straight: where it bends by 25 degrees, or where the pose has the ankle. A pose that
    // bends by less than 14 degrees gives up these, when its ankle has to move by a 64th of the leg.
    const freeOf = ([, [hip], , [ankle]], way) => {
      const own = min(farTo(ankle, hip), farthest);
      const part = farthest >> 6;
      const over = max(0, own - (farthest - (farthest >> 7)));
      return max(own - floor((over * min(max(...way.map(abs)), part)) / max(1, part)), farthest - floor((3 * farthest) / 128));
    };
    // Lets time pass; returns the leg, the way of its ankle and how far it may go at least, if the ankle is not where the clip has it.
    const update = ([toWorld, toPose], contact, isCalm, elapsed) => {
      const isWhole = () => eases.every(([, , since], axis) => since === wholeOf(axis));
      if (contact < 0 && point < 0 && isWhole()) {
        before = contact;
        if (isCalm && !hinge) learn(legIn());
        return;
      }
      eases = eases.map(([d, v, since], axis) => [d, v, min(since + elapsed, wholeOf(axis))]);
      const known = [];
      const world = (point) => toWorld(pointIn(pose, point, known));
      const withLeft = () => added(world(contact), left().map(big));
      if (contact < 0) {
        if (point >= 0) release(false, max(abs(eases[0][0]), abs(eases[1][0])));
      } else if (point >= 0) {
        anchor = anchorAt(world, contact);
        if (point !== contact) lowest = undefined;
        point = contact;
      } else {
        const place = withLeft();
        // Half of the leg in a second.
        const rests = before === contact && apart(place, last).every((x) => size(x) <= (big(length()) * big(elapsed)) / 2000000n);
        if (before < 0 || !steps ? isCalm || rests : isCalm && eases[0][2] === whole && rests) {
          settle();
          point = contact;
          anchor = place;
          isLevel = false;
          lowest = undefined;
        }
      }
      if (point >= 0) {
        const at = world(point);
        const way = apart(anchor, at);
        const height = big(upward) * at[2];
        eases = eases.map((ease, axis) => {
          const d = narrow(way[axis]);
          return axis < 2 || isLevel ? [d, elapsed ? narrow(trunc((((d - ease[0]) | 0) * RELEASE) / elapsed)) : 0, 0] : ease;
        });
        isLevel &&= !isCalm;
        if (farther(way) > length() >> 2) letGo();
        if (!(lowest <= height)) lowest = height;
        // The other clip of a blend lifts it.
        if (point >= 0 && height - lowest > floor(length() / 12)) release(true, 0);
      } else if (isWhole()) {
        lift = 0;
      }
      before = contact;
      if (contact >= 0) last = withLeft();
      const way = toPose(left()).map((x) => shifted(x, shift));
      if (isCalm) learn(legIn(known));
      if (!anyBit(way)) return;
      const own = legIn(known);
      const [, [hip], , [ankle]] = own;
      const reached = farTo(ankle, hip);
      // Stretched by more than three quarters of the way to where the leg is straight, and by more than a 32nd of it.
      if (point >= 0 && farTo(plus(ankle, way), hip) > reached + max(floor((max(0, farthest - reached) * 3) / 4), farthest >> 5)) {
        settle();
        letGo();
      }
      return [own, way, freeOf(own, way)];
    };
    // How far the foot is from where the clip that was entered will have it, its place, and whether it stays on the ground; nothing if it was and is in the air.
    const wayOf = ([toWorld], [toEnd], contact) => {
      const known = [];
      const { raw } = track.player;
      learn(leg.map((index) => jointAt(index, raw, known)));
      const own = contact < 0 ? point : contact;
      if (own < 0) return [];
      const world = (point) => toWorld(pointIn(pose, point, []));
      const [, , rest] = left();
      const place = point < 0 ? added(world(own), left().map(big)) : anchorAt(world, own);
      if (point >= 0) place[2] = wide(world(own)[2] + big(rest));
      return [apart(place, toEnd(pointIn(raw, own, known))), place, point >= 0 && contact >= 0];
    };
    // Enters a clip in which it stays at a place, or steps to one that is far away while a transition runs.
    const enter = (contact, place, far, time) => {
      before = contact;
      if (place) {
        point = contact;
        anchor = place;
        isLevel = true;
        lowest = undefined;
        return;
      }
      if (point < 0) {
        // What is near goes with its clips.
        if (far <= floor(length() / 24) || !time) return;
        settle();
      }
      // A foot that was in the air has nothing to come back from.
      const least = point < 0 && !anyBit([eases[0][0], eases[1][0]]) ? 1 : RELEASE;
      release(true, far);
      whole = clamp(time, least, LONGEST_STEP);
      eases = eases.map(([d, v, since], axis) => [d, axis < 2 ? narrow(trunc((v * whole) / RELEASE)) : v, since]);
    };
    const convert = (by) => {
      lift = shifted(lift, -by);
      last = last.map((x) => wideShifted(x, by));
      anchor = anchor.map((x) => wideShifted(x, by));
      eases = eases.map(([d, v, since]) => [shifted(d, -by), shifted(v, -by), since]);
    };
    // How far the hips go down for a leg that is to reach a target.
    const dropTo = ([[, hip, , ankle], left, free]) => {
      const way = difference(difference(hip[0], ankle[0]), left);
      const height = upward * way[up];
      way[up] = 0;
      return height - floor(sqrt(max(0, free ** 2 - squareOf(way))));
    };
    // The axis about which the knee bends to a sine of `wanted`, after whether it is square to both bones. The bend of the pose stays, and what is added is about the axis that was seen, as
    // nearly straight legs bend to any side; a bend the other way does not stay. One that was never bent bends across the way to its target.
    const axisOf = (own, known, wanted, way) => {
      let [axis, sine = 0] = directionOf(own);
      if (!known) return sine > LEAST_SINE ? [true, [axis]] : [false, directionOf(crossed(way, [UNIT, 0, 0]))];
      const back = axis ? ((min(sine, 2 * UNIT) >> 1) * min(scalarProduct(axis, known), 0)) >> 14 : 0;
      if (back) {
        own = difference(own, times(known, back));
        [axis, sine = 0] = directionOf(own);
      }
      wanted = max(wanted, trunc(LEAST_SINE));
      if (axis && wanted <= sine) return [!back, [axis]];
      [axis = known] = directionOf(plus(own, times(known, wanted - sine)));
      return [false, [axis]];
    };
    // Turns hip and knee so that the ankle comes to a target, or as near as the knee allows. The ankle keeps its rotation in the world.
    const solve = ([[, above], [hip, hipTurn], [knee, kneeTurn], [ankle, ankleTurn]], target) => {
      const [way, distance] = directionOf(difference(target, hip));
      if (!way || difference(target, ankle).every((x) => abs(x) < 3)) return;
      const old = bonesOf(hip, knee, ankle);
      const reached = clamp(distance, closest, farthest);
      const [a, b, d] = [upper, lower, reached].map((length) => length >> 2);
      const cosine = clamp(trunc(((a * a + d * d - b * b) * 2) / max(1, (a * d) >> 13)), -UNIT, UNIT);
      const side = floor(sqrt(UNIT * UNIT - cosine * cosine));
      const [isSquare, [axis = [0, 0, UNIT]]] = axisOf(crossed(...old), hinge && imageOf(kneeTurn, hinge), b && trunc((side * d) / b), way);
      const [across] = directionOf(crossed(way, axis));
      const squares = old.map((bone) => (isSquare ? axis : directionOf(crossed(crossed(bone, axis), bone))[0]));
      if (!across || !squares.every(Boolean)) return;
      const thigh = way.map((x, axis) => ((x * cosine) >> 15) + ((across[axis] * side) >> 15));
      const shin = unitOf(difference(times(way, reached), times(thigh, upper)), lower);
      const turns = [thigh, shin].map((bone, index) => then(then(columns(bone, crossed(across, way)), transposed(columns(old[index], squares[index]))), [hipTurn, kneeTurn][index]));
      [above, ...turns].forEach((turn, index) => write(leg[index + 1], turn, [...turns, ankleTurn][index]));
    };
    // Goes down with the hips; a foot that is free stays where it is.
    const reachDown = (wanted, sunk) => {
      if (!wanted && !sunk) return;
      const raised = (place, by) => place.map((x, axis) => (axis === up ? (x + by) | 0 : x));
      const moved = (places, by) => places.map(([place, turn]) => [raised(place, by), turn]);
      const own = () => {
        const places = moved(legIn(), sunk);
        return [places, ORIGIN, freeOf(places, ORIGIN)];
      };
      const [places, way, free] = wanted ?? own();
      const target = plus(places[3][0], way);
      const lowered = moved(places, -sunk);
      const [, [hip]] = lowered;
      const [aim, distance] = directionOf(difference(target, hip));
      const soft = max(farthest - (farthest >> 7) - free, farthest >> 8);
      const over = min(distance - free, 0xffff);
      // Past the free distance it comes less and less far.
      solve(lowered, over > 0 ? plus(hip, times(aim, free + floor((over * soft) / (over + soft)))) : target);
    };
    return [convert, length, wayOf, enter, update, dropTo, reachDown];
  };
  const feet = named.map(footOf);
  const carrier = chainOf(named[0][0]).slice(0, -3).map((index) => rig.joints[index]).find(({ kinds }) => kinds.includes(up));

  // ---- Both feet
  const find = () => {
    const by = exponent - track.clip.exponent;
    ({ groups } = animator);
    ({ exponent } = track.clip);
    shift = rig.exponent + down - exponent;
    feet.forEach(([convert]) => convert(by));
  };
  // Between the axes of a pose and those of the world: two horizontal coordinates and the height.
  const frameOf = ([place, heading]) => {
    const there = headingOf(heading);
    const back = [-heading | 0, -there[1], there[2]];
    return [
      (point) => {
        const [a, b, height] = cycled(point, up + 1).map(big);
        return [...added(rotated(there, a, b), place), height];
      },
      ([a, b, height]) => cycled([...rotated(back, big(a), big(b)).map((x) => Number(x) | 0), height], 2 - up),
    ];
  };
  // Places the clip that was entered by the feet that are held and are on the ground in it, too.
  const enterAll = (frame, found) => {
    animator.leaveCarried();
    const place = animator.place.map((channel) => big(track.player.raw[channel] ?? 0));
    const [at, heading] = animator.placedAt(place);
    // The points of the clip's pose have its place in them.
    const end = frameOf([apart(at, rotated(headingOf(heading), ...place)), heading]);
    const ways = feet.map((foot, index) => foot[2](frame, end, found[index]));
    const length = feet[0][1]();
    // Of two ways the mean, or the shorter one if they are far apart.
    let [[glide] = [[0n, 0n, 0n]], [other] = []] = ways.filter(([, , stays]) => stays);
    if (other) {
      if (farther(apart(glide, other)) <= length >> 3) glide = glide.map((x, axis) => (x + other[axis]) / 2n);
      else if (farther(glide) > farther(other)) glide = other;
    }
    if (farther(glide) > length >> 1 || animator.left < 2) glide = [0n, 0n, 0n];
    if (farther(glide)) animator.glide(glide);
    const time = floor((animator.left * track.clip.frameTimeNs) / 1000);
    feet.forEach(([, , , enter], index) => {
      const [way, place, stays] = ways[index];
      if (!way) return;
      const far = Number(farther(apart(way, glide)));
      enter(found[index], stays && far <= floor(length / 12) && place, far, time);
    });
  };
  // How far the figure went down in the last update, in figure units.
  let sunk = 0;
  find();
  return {
    next: (transition) => {
      const { clip, player, speed } = track;
      const part = floor(track.rest / clip.frameTimeNs);
      // Not before the transition that runs has ended, rounded up to its whole frames: in 65536ths of a frame.
      const behind = Math.ceil((part + animator.left * max(speed, 0)) / 65536);
      const from = clip.looped ? (player.frame + behind) % clip.frames : player.frame + behind;
      let least = Infinity;
      let start;
      for (const [own, , at, to] of entries) {
        let ahead = at - from;
        if (ahead < 0) ahead = clip.looped ? ahead + clip.frames : Infinity;
        if (own === transition && speed > 0 && ahead < least) {
          least = ahead;
          start = to;
        }
      }
      // Rounded up, so that the frame is reached.
      if (least < Infinity) return [start, Number((big((least + behind) * 65536 - part) * big(clip.frameTimeNs) + big(speed - 1)) / big(speed))];
    },
    hold: (clip, frame, isBlended, entered, elapsed) => {
      if (entered) find();
      const axes = frameOf(animator.placement);
      // The points that are on the ground.
      const rows = contacts.slice(ends[clip - 1] ?? 0, ends[clip]);
      const found = feet.map((_, foot) => rows.find(([own, , from, to]) => own === foot && frame >= from && frame < to)?.[1] ?? -1);
      if (entered) enterAll(axes, found);
      const wanted = feet.map(([, , , , update], foot) => update(axes, found[foot], !animator.left && !isBlended, elapsed));
      // 2 cm, at most.
      const most = shifted(shifted(min(floor((2000000 * 256) / round(rig.cmPerUnit * 1e6)), 2 ** 30), exponent + 8), shift);
      const goal = min(most, max(0, ...feet.map(([, , , , , dropTo], foot) => wanted[foot] ? dropTo(wanted[foot]) : 0)));
      sunk = goal + trunc(((sunk - goal) * DROP) / (DROP + elapsed));
      const drop = carrier ? sunk : 0;
      if (drop) pose[carrier.first + carrier.kinds.lastIndexOf(up)] -= upward * shifted(drop, -shift);
      feet.forEach((foot, index) => foot[6](wanted[index], upward * drop));
    },
  };
};
