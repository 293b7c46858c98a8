// The look "solid" of <pantin-player>: a body with volume, by the rules of the firmware's solid figure (pantin-figure, `solid`), drawn with paths of a canvas. Lengths are
// pixels here, or thousandths of the figure's height where that is said; depths are those of figure.js, whose camera and joints it has.

const [LEFT, RIGHT] = [2, 3];
// [joints] What the joints of arms and legs are called, from the trunk outwards. A joint with a word of `weak` is taken if there is none with the others; one with
// `generic` is the next of the limb.
const ARM = {
  weak: /shoulder|shldr/, generic: /arm/,
  strong: [/upper[_-]?arm|uparm|humerus|oberarm/, /forearm|lower_?arm|loarm|elbow|radius|unterarm/, /hand|wrist/],
};
const LEG = {
  weak: /hip/, generic: /leg/,
  strong: [/up(per_?)?leg|thigh|femur|oberschenkel/, /lower_?leg|loleg|shin|calf|knee|tibia|unterschenkel/, /foot|ankle|fuss|fu_/],
};
// [look] The default character: radii in thousandths of the height, of figures of 80 pixels and more and of smaller ones; heights of a figure for each width of an
// outline; colors; how far attachments reach from head, chest and hips in thousandths of the height.
export const STANDARD = {
  names: ["hip", "knee", "ankle", "shoulder", "elbow", "wrist", "hand", "heel", "toe", "chest", "waist", "pelvis", "neck", "skull"],
  radii: [[56, 36, 25, 40, 29, 21, 26, 26, 19, 50, 70, 58, 28, 78], [58, 39, 29, 43, 33, 26, 31, 28, 23, 51, 70, 59, 29, 88]],
  outline: 110,
  colors: { shirt: [235, 235, 225], trousers: [70, 92, 150], skin: [240, 190, 150], hair: [96, 60, 44], face: [255, 214, 176], nose: [255, 200, 160], eye: [20, 16, 20] },
  attachments: [],
  reaches: [0, 0, 0],
};
// How bright shaded sides are, and the heights from the head's joint to the skull's middle: above it, and ahead of it.
const SHADE = 0.62;
const SKULL = [0.062, 0.012];
// Radii at both ends of a side's parts, and joints of a part's far end.
const SEGMENTS = [["shoulder", "elbow"], ["elbow", "wrist"], ["wrist", "hand"], ["hip", "knee"], ["knee", "ankle"], ["ankle", "toe"]];
// Parts of a person: pelvis, chest, neck, head, six of each side, and what is attached.
const [CHEST, NECK, HEAD, LIMBS] = [1, 2, 3, 4];
const PARTS = LIMBS + 2 * SEGMENTS.length;
// What an attachment hangs on; the hips are another one.
const [ON_HEAD, ON_CHEST, ON_THIGHS] = [0, 1, 3];
// Thousandths of the height by which the head counts as nearer than the skull's middle, and an attachment as nearer than it is.
const [HEAD_OVER, OVER] = [30, 4];
// Joints at which parts meet, as bits: a part has no outline at a joint where another one was drawn before.
const [WAIST_JOINT, NECK_JOINT, HEAD_JOINT] = [1, 2, 4];
const jointOf = (side, index) => 8 << (6 * side + index);
const MOST_PARTS = 48;
// Two parts change places if their depths differ by more than this part of the height against the order of the picture before.
const PASSING = 0.012;

const clamp = (value, least, most) => Math.max(least, Math.min(most, value));
const mix = (a, b, part) => a + (b - a) * part;
const between = (a, b, part) => a.map((from, axis) => mix(from, b[axis], part));
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [0, 1, 2].map((axis) => a[(axis + 1) % 3] * b[(axis + 2) % 3] - a[(axis + 2) % 3] * b[(axis + 1) % 3]);
const unit = (v) => v.map((x) => x / (Math.hypot(...v) || 1));
// Camera's distance over that of a depth.
// What figure.js passes of a figure in a row.
function innerOf(figure) {
  const [bones, crown, size, hips, places, turns, points, inWorld, project, view, scale, seen, axis, height, target] = figure.inner();
  return { bones, crown, size, hips, places, turns, points, inWorld, project, view, scale, seen, axis, height, target };
}
const zoomOf = (depth) => 1 / clamp(1 + depth / 32768, 0.5, 1.5);

// [joints] The joints of a person as indices of bones; undefined for other rigs. Joints that may be missing are -1.
function personOf(clip, { bones, crown, hips, size }) {
  const lengthOf = (index) => Math.hypot(...bones[index].offset);
  // The crown of the head is no joint of the rig.
  const nameOf = (index) => clip.rig.joints[bones[index].index]?.name.toLowerCase() ?? "";
  const above = (joint) => (joint < 0 || bones[joint].parent < 0 ? [] : [bones[joint].parent, ...above(bones[joint].parent)]);
  const limb = ({ weak, generic, strong }, side) => {
    const found = [];
    let other;
    bones.forEach(({ part }, index) => {
      const name = nameOf(index);
      if (part !== side || !name || clip.rig.joints[bones[index].index].isEnd) return;
      let role = strong.findIndex((words) => words.test(name));
      if (role < 0 && generic.test(name)) role = [0, 1, 2, 3].find((role) => found[role] === undefined);
      if (role >= 0) found[role] ??= index;
      else if (weak.test(name)) other ??= index;
    });
    const joints = [found[0] ?? other, found[1], found[2]];
    return joints.every((joint) => joint >= 0) && above(joints[1]).includes(joints[0]) && above(joints[2]).includes(joints[1]) && joints;
  };
  const [arms, legs] = [ARM, LEG].map((words) => [LEFT, RIGHT].map((side) => limb(words, side)));
  if (![...arms, ...legs].every(Boolean) || clip.rig.joints.some(({ name }) => /tail|wing/i.test(name))) return;
  const others = above(arms[1][0]);
  const chest = above(arms[0][0]).find((joint) => others.includes(joint));
  const child = (joint) => bones.findIndex(({ parent, part }) => parent === joint && part < LEFT);
  // In a rig that names no head: the last joint but the end of what rises from the chest between the arms.
  let head = crown ? bones[crown].parent : child(child(chest));
  for (let next = head; !crown && next >= 0 && child(next) >= 0; next = child(next)) head = next;
  let neck = [head, ...above(head)].find((joint) => joint >= 0 && bones[joint].parent === chest);
  if (!(neck >= 0)) return;
  // The arms hang on the neck.
  if (neck === head) neck = chest;
  const chain = [neck, ...above(neck)];
  chain.splice(chain.indexOf(hips) >>> 0);
  const total = chain.reduce((sum, joint) => sum + lengthOf(joint), 0);
  // The joint of the spine that is nearest to 2/5 of the way up.
  let [waist, nearest, sum] = [-1, total / 5, 0];
  for (const joint of chain) {
    const apart = Math.abs(total - sum - total * 0.4);
    if (apart < nearest) [waist, nearest] = [joint, apart];
    sum += lengthOf(joint);
  }
  // The joint that is farthest down the longest branch without thumbs.
  const farEnd = (joint, shortest) => {
    const reach = { [joint]: 0 };
    let best = -1;
    for (let index = joint + 1; bones[index]?.parent >= joint; index++) {
      const [name, { parent }] = [nameOf(index), bones[index]];
      reach[index] = /thumb/.test(name) && !/foot/.test(name) ? -Infinity : reach[parent] + lengthOf(index);
      if (reach[index] > shortest) [shortest, best] = [reach[index], index];
    }
    return best;
  };
  // Some exporters turn a foot's end with other axes than the joints': an end that leads back is none.
  const unfolded = (ankle, end) => {
    const before = bones[end]?.parent;
    const straight = (to) => {
      const way = [0, 0, 0];
      for (; to > ankle; to = bones[to].parent) bones[to].offset.forEach((x, axis) => (way[axis] += x));
      return Math.hypot(...way);
    };
    return before > ankle && straight(end) < straight(before) ? before : end;
  };
  return {
    hips, waist, neck, head, arms, legs,
    fingers: arms.map(([, , wrist]) => farEnd(wrist, size / 50)),
    toes: legs.map(([, , ankle]) => unfolded(ankle, farEnd(ankle, size / 30))),
  };
}

// [sizes] Lengths of a person, as parts of others.
function measuresOf(bones, { arms, legs, fingers, toes, neck, head }) {
  const way = (from, to) => {
    let sum = 0;
    for (; to !== from && to >= 0; to = bones[to].parent) sum += Math.hypot(...bones[to].offset);
    return sum || 1;
  };
  // 2.04 times the mean of thigh and shin on both sides.
  const height = legs.reduce((sum, [hip, knee, ankle]) => sum + 1.02 * (way(hip, knee) + way(knee, ankle)), 0);
  return {
    height,
    // The neck is the last 0.075 of the height: some rigs have its joint deep in the chest.
    neckStart: Math.max(0, 1 - (0.075 * height) / way(neck, head)),
    hands: arms.map(([, elbow, wrist], side) => (0.055 * height) / (fingers[side] < 0 ? way(elbow, wrist) : way(wrist, fingers[side]))),
    feet: legs.map(([, knee, ankle], side) => {
      const foot = way(ankle, toes[side]);
      return { toes: toes[side] < 0 ? 95 / 78 : clamp(foot, 0.095 * height, 0.135 * height) / foot, down: (0.018 * height) / way(knee, ankle), back: toes[side] < 0 ? 40 / 256 : (0.012 * height) / foot };
    }),
  };
}

// [hull] The hull of one to four circles: a path of what lies between every two and every three of them, and one of its outline, which is open where `open` circles go on outwards.
function pathsOf(circles, open) {
  const [path, edge] = [new Path2D(), new Path2D()];
  const centre = (own) => [0, 1].map((axis) => (circles.reduce((sum, circle) => sum + circle[axis], 0) - own[axis]) / Math.max(1, circles.length - 1));
  // The part of a circle from one angle to another, without what is open: what lies 0.45 of the radius and more beyond its middle.
  const arc = (index, from, to) => {
    const [x, y, r] = circles[index];
    path.arc(x, y, r, from, to);
    const piece = (from, to) => to > from && (edge.moveTo(x + r * Math.cos(from), y + r * Math.sin(from)), edge.arc(x, y, r, from, to));
    const [inX, inY] = centre(circles[index]);
    if (!open.includes(index) || Math.hypot(inX - x, inY - y) <= r / 4) return piece(from, to);
    const gap = Math.acos(0.45);
    const outward = Math.atan2(y - inY, x - inX);
    const first = outward + 2 * Math.PI * Math.ceil((from - outward - gap) / (2 * Math.PI));
    piece(from, Math.min(to, first - gap));
    piece(Math.max(from, first + gap), to);
  };
  for (let a = 0; a < circles.length; a++) {
    const [x, y, r] = circles[a];
    let isAlone = true;
    circles.forEach(([u, v, s], b) => {
      const apart = Math.hypot(u - x, v - y);
      if (a === b || apart <= Math.abs(r - s)) return;
      isAlone = false;
      if (b < a) return;
      const [way, lean] = [Math.atan2(v - y, u - x), Math.acos((r - s) / apart)];
      path.moveTo(x + r * Math.cos(way + lean), y + r * Math.sin(way + lean));
      arc(a, way + lean, way - lean + 2 * Math.PI);
      arc(b, way - lean, way + lean);
      path.closePath();
      for (const sign of [-1, 1]) {
        const [cos, sin] = [Math.cos(way + sign * lean), Math.sin(way + sign * lean)];
        edge.moveTo(x + r * cos, y + r * sin);
        edge.lineTo(u + s * cos, v + s * sin);
      }
    });
    if (!isAlone) continue;
    path.moveTo(x + r, y);
    arc(a, 0, 2 * Math.PI);
    path.closePath();
  }
  const corner = (...triangle) => {
    const [[ax, ay], [bx, by], [cx, cy]] = triangle;
    const isLeft = (bx - ax) * (cy - ay) < (by - ay) * (cx - ax);
    path.moveTo(ax, ay);
    path.lineTo(...(isLeft ? [cx, cy] : [bx, by]));
    path.lineTo(...(isLeft ? [bx, by] : [cx, cy]));
    path.closePath();
  };
  circles.forEach((a, first) => circles.slice(first + 1).forEach((b, next) => circles.slice(first + next + 2).forEach((c) => corner(a, b, c))));
  return { path, edge };
}

const css = (color) => `rgb(${color.map(Math.round)})`;
const lit = (color, light) => css(color.slice(0, 3).map((part) => part * light));

// [paint] Draws a hull: its outline, its shaded side, and what the hull and the hull moved by `shift` share in its own color. Returns its path.
function paint(context, circles, { color, light, shift, edge, width, open = [] }) {
  const paths = pathsOf(circles, open);
  if (width) {
    Object.assign(context, { strokeStyle: edge, lineWidth: 2 * width, lineCap: "butt" });
    context.stroke(paths.edge);
  }
  context.fillStyle = lit(color, light * (shift ? SHADE : 1));
  context.fill(paths.path);
  if (shift) {
    context.save();
    context.clip(paths.path);
    context.translate(-shift[0], -shift[1]);
    context.fillStyle = lit(color, light);
    context.fill(paths.path);
    context.restore();
  }
  return paths.path;
}

// [head] Skull and jaw in the hair's color, and a face that moves across them with the gaze. Vectors are as long as the skull's radius.
function drawHead(context, { skull, up, face, left }, colors, edge, width) {
  const [x, y, r] = skull;
  // In 256ths of the radius along face, up and left.
  const place = (ahead, above, aside) => [0, 1, 2].map((axis) => (axis < 2 ? skull[axis] : 0) + (face[axis] * ahead + up[axis] * above + left[axis] * aside) / 256);
  const circle = (radius, ...at) => [...place(...at).slice(0, 2), radius];
  // 1 if the face looks at the camera.
  const toward = clamp(-face[2] / r, -1, 1);
  const isDetailed = r >= 7;
  const side = r / 4;
  const plain = (circles, color) => paint(context, circles, { color, light: 1 });
  const nose = (ahead) => circle(Math.max(0.56, r / 6), ahead, -56, 0);
  if (toward < 0.1) paint(context, [nose(271)], { color: colors.nose, light: 1, edge, width });
  const shaded = (way) => isDetailed && [way, way * 1.5].map((x) => Math.min(9 * 1.5, x / 16));
  const hull = paint(context, [skull, circle(r * 0.82, 36, -90, 0)], { color: colors.hair, light: 1, edge, width, shift: shaded(side) });
  const size = toward < 0 ? 0.8 + toward * 0.55 : 0.84;
  if (size > 0.15 && toward > -0.75) {
    context.save();
    context.clip(hull);
    paint(context, [circle(r * size, 133 + 192 * Math.max(0, -toward), -51, 0)], { color: colors.face, light: 1, shift: shaded(side / 2) });
    context.restore();
  }
  if (toward > -0.35) {
    for (const aside of [-1, 1]) {
      const [eyeX, eyeY, away] = isDetailed ? place(236, 5, aside * 99) : place(205, 0, aside * 115);
      if (-away * (isDetailed ? 8 : 4) <= r) continue;
      if (isDetailed) plain([-20, 20].map((above) => circle(Math.max(0.5, r / 10), 220, above, aside * 92)), colors.eye);
      else plain([[eyeX, eyeY + r / 10, 0.6]], colors.eye);
    }
  }
  if (toward >= 0.1 && isDetailed) {
    const [x, y, radius] = nose(258);
    paint(context, [[x, y, radius]], { color: colors.face, light: SHADE });
    plain([[x - r / 20, y - r / 16, radius * 0.75]], colors.nose);
  } else if (toward >= 0.1 && toward < 0.84) plain([nose(293)], colors.nose);
}

// Characters by their URLs: those that have arrived, and promises of them; and what players were told of those that are no good.
const characters = {};
const arriving = {};
const told = new WeakMap();
const urlOf = (player) => player.getAttribute("character-look");

async function fetched(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${response.status}`);
  const [{ lookOf }, bytes] = await Promise.all([import("./pantin-looks.js"), response.arrayBuffer()]);
  characters[url] = lookOf(new Uint8Array(bytes), STANDARD);
}

// Says what is wrong with a player's character, once, and takes it back.
function report(player, problem = "") {
  const before = told.get(player) ?? "";
  if (problem ? player.trouble === problem : !before) return;
  told.set(player, problem);
  if (problem || player.trouble === before) player.trouble = problem;
  if (problem) player.dispatchEvent(new CustomEvent("error", { detail: problem }));
}

/** Resolves once the character of a player's attribute is there. The player reports one that is no good, and its figure is the default character. */
export async function dressed(player) {
  const url = urlOf(player);
  if (!url) return;
  try {
    await (arriving[url] ??= fetched(url));
  } catch ({ message }) {
    // Who loads it again tries again.
    delete arriving[url];
    characters[url] = { ...STANDARD, problem: `${url}: ${message}` };
  }
  if (urlOf(player) === url) report(player, characters[url].problem);
}

/**
 * The solid look of a figure of figure.js, unless it is `known`, as the character of the player's attribute; nothing for a rig that can only be drawn in lines. `cover` makes room for it: `aim` of the
 * figure takes it. `learn` finds out where the head looks, by the poses for which the camera was set up; `draw` draws the pose that was placed.
 */
export function solidOf(clip, figure, known, player) {
  const url = urlOf(player);
  const solid = known ?? volumeOf(clip, figure);
  const awaits = url && !characters[url];
  // It stays as it is until its character has arrived, and is drawn again then.
  if (!known || !awaits) solid?.dress(characters[url] ?? STANDARD);
  if (awaits) dressed(player).then(() => player.turn(0, 0));
  else report(player, characters[url]?.problem);
  return solid;
}

// Sets a figure up in this look. `poses` is another value where `visit` passes other poses.
export function aim(clip, figure, view, visit, poses, player) {
  const solid = (figure.solid = solidOf(clip, figure, figure.solid, player));
  figure.aim(...view, visit, solid?.cover);
  solid?.learn(visit, poses);
}

function volumeOf(clip, figure) {
  const { bones, crown, size } = innerOf(figure);
  const person = personOf(clip, innerOf(figure));
  let order = person ? [...Array(PARTS).keys()] : bones.flatMap(({ isShown, parent }, index) => (isShown || (crown === index && parent >= 0) ? [index] : []));
  if (!order.length || order.length > MOST_PARTS) return;
  const measures = person ? measuresOf(bones, person) : { height: size };
  let headAxes = [[0, 1, 0], [0, 0, 1], [1, 0, 0]];
  let learned = 0;
  // Of the pose that is drawn: the height in pixels and in units of depth, radii, joints, and the head.
  let [inner, height, depth, radii, head] = [{}, 0, 1, {}, null];
  let [look, sizes] = [STANDARD, []];
  const pixelsOf = (length) => (length * inner.scale) / inner.seen / 16;
  const joint = (index) => [inner.points[3 * index] / 16, inner.points[3 * index + 1] / 16, inner.points[3 * index + 2]];
  const depthOf = (index) => inner.points[3 * index + 2];
  const boneDepth = (index) => (depthOf(index) + depthOf(bones[index].parent)) / 2;
  const round = ([x, y, depth], radius) => [x, y, radius * zoomOf(depth)];
  const circle = (place, radius) => round(place, height * radii[radius]);
  const measure = () => {
    inner = innerOf(figure);
    height = pixelsOf(measures.height);
    depth = (measures.height * 8192) / inner.seen;
    radii = sizes[height < 80 ? 1 : 0];
  };

  const waist = () => (person.waist < 0 ? between(joint(person.hips), joint(person.neck), 0.4) : joint(person.waist));
  const hand = (side) => {
    const [, elbow, wrist] = person.arms[side].map(joint);
    const ratio = measures.hands[side];
    return person.fingers[side] < 0 ? between(elbow, wrist, 1 + ratio) : between(wrist, joint(person.fingers[side]), ratio);
  };
  // Heel and toes.
  const foot = (side) => {
    const [, knee, ankle] = person.legs[side].map(joint);
    const { toes, down, back } = measures.feet[side];
    const far = person.toes[side] < 0 ? [ankle[0] + head.face[0], ankle[1] + head.face[1], ankle[2]] : joint(person.toes[side]);
    const [below, behind] = [between(knee, ankle, 1 + down), between(ankle, far, -back)];
    return [below.map((x, axis) => x + behind[axis] - ankle[axis]), between(ankle, far, toes)];
  };
  const turnHead = () => {
    const at = 9 * person.head;
    const turned = (v) => unit([0, 1, 2].map((row) => inner.turns[at + row] * v[0] + inner.turns[at + row + 3] * v[1] + inner.turns[at + row + 6] * v[2]));
    const place = joint(person.head);
    const radius = height * radii.skull * zoomOf(place[2]);
    const [up, face, left] = headAxes.map((axis) => turned(axis).map((x) => x * radius));
    const [above, ahead] = SKULL.map((part) => part / radii.skull);
    const [x, y] = [0, 1].map((axis) => place[axis] + up[axis] * above + face[axis] * ahead);
    head = { skull: [x, y, radius], up, face, left, depth: place[2] + (up[2] / radius) * SKULL[0] * depth };
  };

  // [attach] An anchor: its origin, and left, up and ahead, each as long as `length` pixels or thousandths of the height. Axes are right, down and away.
  const way = (from, to) => unit([0, 1, 2].map((axis) => inner.places[3 * to + axis] - inner.places[3 * from + axis]));
  const anchorOf = (anchor, left) => {
    if (anchor === ON_HEAD) return { origin: [head.skull[0], head.skull[1], head.depth], axes: [head.left, head.up, head.face], length: head.skull[2], thousandths: radii.skull * 1000 };
    const [one, other] = (anchor === ON_CHEST ? person.arms : person.legs).map(([joint]) => joint);
    const leftward = way(other, one);
    const [hip, knee] = person.legs[left < 0 ? 1 : 0];
    const [origin, up] = anchor === ON_THIGHS ? [joint(hip), way(knee, hip)] : [between(joint(one), joint(other), 0.5), way(person.hips, person.neck)];
    const length = height * zoomOf(origin[2]);
    return { origin, axes: [leftward, up, cross(leftward, up)].map((axis) => axis.map((x) => x * length)), length, thousandths: 1000 };
  };
  const along = ({ axes }, place) => [0, 1, 2].map((index) => axes.reduce((sum, axis, of) => sum + axis[index] * place[of], 0));
  const attachedPart = ({ anchor, color, circles }) => ({
    color, ends: [], covers: 0,
    circles: circles.map((place) => {
      const frame = anchorOf(anchor, place[0]);
      const [x, y] = along(frame, place).map((part) => part / frame.thousandths);
      return [frame.origin[0] + x, frame.origin[1] + y, (place[3] * frame.length) / frame.thousandths];
    }),
  });
  // How far away it counts as: a skirt as much as the nearer thigh.
  const attachedKey = ({ anchor, circles }, thighs) => {
    if (anchor === ON_THIGHS) return Math.min(...thighs) - (depth * OVER) / 1000;
    const frame = anchorOf(anchor, 0);
    const away = circles.reduce((sum, place) => sum + along(frame, place)[2] / frame.length, 0) / circles.length;
    return frame.origin[2] + (depth * (away - (anchor === ON_HEAD ? HEAD_OVER : 0) - OVER)) / 1000;
  };

  // [parts] How far away the parts of a person count as. Upper arm and thigh count as what is farther from the trunk, so that they lie over it or under it as a whole.
  const personKeys = () => {
    const [arms, legs] = [person.arms, person.legs].map((limbs) => limbs.map((limb) => limb.map(depthOf)));
    const trunk = (arms[0][0] + arms[1][0] + legs[0][0] + legs[1][0] + 2 * waist()[2]) / 6;
    const thighs = legs.map(([hip, knee]) => mix(hip, knee, 0.7));
    const pelvis = Math.min(Math.max(...thighs, trunk), trunk + depth * 0.08);
    const sides = [0, 1].flatMap((side) => {
      const [[shoulder, elbow, wrist], [hip, knee, ankle]] = [arms[side], legs[side]];
      return [mix(shoulder, elbow, 0.75), (elbow + wrist) / 2, mix(wrist, hand(side)[2], 0.7), mix(hip, knee, 0.7), (knee + ankle) / 2, mix(ankle, foot(side)[1][2], 0.6) - depth / 200];
    });
    return [pelvis + depth / 200, trunk, head.depth - depth * 0.024, head.depth - (depth * HEAD_OVER) / 1000, ...sides, ...look.attachments.map((own) => attachedKey(own, thighs))];
  };
  // Puts the farthest part first. The first picture is sorted exactly, later ones from the order of the one before.
  let isSorted = false;
  const sort = () => {
    const keys = person && personKeys();
    const keyOf = (part) => (person ? keys[part] : boneDepth(part));
    const passing = isSorted ? depth * PASSING : 0;
    isSorted = true;
    for (let next = 1; next < order.length; next++) {
      const moving = order[next];
      let place = next;
      for (; place > 0 && keyOf(order[place - 1]) + passing < keyOf(moving); place--) order[place] = order[place - 1];
      order[place] = moving;
    }
  };

  const trunkPart = (part) => {
    if (part === NECK) {
      const to = joint(person.head);
      return { circles: [circle(between(joint(person.neck), to, measures.neckStart), "neck"), circle(to, "neck")], color: look.colors.skin, ends: [[0, NECK_JOINT], [1, HEAD_JOINT]], covers: 0 };
    }
    const [limbs, inwards, radius, color, first] = part === CHEST ? [person.arms, 0.24, "chest", look.colors.shirt, 0] : [person.legs, 0.1, "pelvis", look.colors.trousers, 3];
    const ends = limbs.map(([limb]) => joint(limb));
    const middle = between(...ends, 0.5);
    const circles = ends.map((end) => circle(between(end, middle, inwards), radius));
    const covers = jointOf(0, first) | jointOf(1, first) | (part === CHEST ? NECK_JOINT : 0);
    return { circles: [...circles, circle(waist(), "waist")], color, ends: [[2, WAIST_JOINT]], covers };
  };
  const sidePart = (part, colors) => {
    const side = +(part >= LIMBS + SEGMENTS.length);
    const index = (part - LIMBS) % SEGMENTS.length;
    const [limb, at] = index < 3 ? [person.arms[side], index] : [person.legs[side], index - 3];
    const [own, end] = [colors[side], side ? colors[2] : colors[0]];
    const { skin, trousers } = look.colors;
    const [from, to] = SEGMENTS[index];
    const [heel, toes] = index === 5 ? foot(side) : [];
    const far = index === 2 ? hand(side) : (toes ?? joint(limb[at + 1]));
    const circles = [circle(joint(limb[at]), from), circle(far, to)];
    if (heel) circles.push(circle(heel, "heel"));
    return {
      circles, color: [own, skin, end, trousers, trousers, end][index], isRight: side === 1, depth: depthOf(limb[Math.min(at + 1, 2)]),
      ends: [[0, jointOf(side, index)], ...(at < 2 ? [[1, jointOf(side, index + 1)]] : [])], covers: 0,
    };
  };
  // A bone of a rig that is no person's: long ones are thicker, within what keeps a figure one.
  const bonePart = (index, colors) => {
    const { parent, part, offset } = bones[index];
    const radius = Math.max(0.5, pixelsOf(clamp(Math.hypot(...offset) / 6, size / 60, size / 22)));
    const color = part === LEFT ? colors[0] : part === RIGHT ? colors[1] : look.colors.shirt;
    // Bits of the first joints alone.
    const bit = (joint) => (joint < 31 ? 1 << joint : 0);
    return { circles: [round(joint(parent), radius), round(joint(index), radius * 0.75)], color, isRight: part === RIGHT, depth: boneDepth(index), ends: [[0, bit(parent)], [1, bit(index)]], covers: 0 };
  };

  // [floor] The place on the ground below a joint.
  const below = () => {
    const { view, places, axis, height, target, project } = inner;
    const column = view.slice(3 * axis, 3 * axis + 3);
    const upright = unit(column);
    const level = dot(upright, column) * ((height - target[axis]) / 32768);
    const to = [0, 0, 0];
    return (index) => {
      const place = [0, 1, 2].map((at) => places[3 * index + at]);
      const by = level - dot(upright, place);
      project(...place.map((x, at) => x + upright[at] * by), to, 0);
      return [to[0] / 16, to[1] / 16, to[2]];
    };
  };
  const floor = (context, { stage, line, shadow }) => {
    const under = below();
    // A disc as it lies on the floor, in heights times 4.
    const disc = ([x, y, depth], part) => [x, 4 * y, height * part * zoomOf(depth)];
    const flat = (circles, color) => {
      context.save();
      context.scale(1, 0.25);
      paint(context, circles, { color, light: 1 });
      context.restore();
    };
    flat([disc(under(person?.hips ?? inner.hips), 0.62)], stage);
    Object.assign(context, { strokeStyle: css(line), lineWidth: 1, lineCap: "round" });
    figure.ground((x, y, u, v) => {
      context.beginPath();
      context.moveTo(x / 16, y / 16);
      context.lineTo(u / 16, v / 16);
      context.stroke();
    });
    if (!person) return;
    const ankles = person.legs.map(([, , ankle]) => ankle);
    const risen = Math.max(0, Math.min(...ankles.map((ankle) => under(ankle)[1] - joint(ankle)[1])));
    const scale = clamp(1 - (risen * 0.6) / height, 0.45, 1);
    const hips = disc(under(person.hips), 0.105 * scale);
    const feet = ankles.map((ankle, side) => [ankle, person.toes[side] < 0 ? ankle : person.toes[side], 0.07]);
    for (const [from, to, part] of [[...person.arms.map(([shoulder]) => shoulder), 0.084], ...feet]) flat([hips, disc(between(under(from), under(to), 0.5), part * scale)], shadow);
  };

  return {
    // Takes a character.
    dress(character) {
      if (character === look && sizes.length) return;
      look = character;
      sizes = look.radii.map((radii) => Object.fromEntries(radii.map((radius, index) => [STANDARD.names[index], radius / 1000])));
      if (person) order = [...Array(PARTS + look.attachments.length).keys()];
      isSorted = false;
    },
    cover: person && ((widen) => {
      measure();
      const around = (index, part) => widen(...joint(index).slice(0, 2).map((x) => x * 16), Math.min(32767, 16 * pixelsOf(measures.height) * part * zoomOf(depthOf(index))));
      for (const index of [...bones.keys()]) if (bones[index].isShown) for (const end of [index, bones[index].parent]) around(end, 0);
      const [ofHead, ofChest, ofHips] = look.reaches.map((reach) => reach / 1000);
      around(person.head, SKULL[0] + Math.max(sizes[0].skull, ofHead));
      for (const [, , wrist] of person.arms) around(wrist, 0.044 + sizes[0].hand);
      if (ofChest) around(person.neck, ofChest);
      if (ofHips) around(person.hips, ofHips);
    }),
    // [mod] The mean over poses of where the shoulders face, in the head's own axes: rest poses of some captures do not say it.
    learn(visit, poses) {
      isSorted = false;
      if (!person || learned === poses) return;
      learned = poses;
      const { inWorld, places, turns } = innerOf(figure);
      let [up, ahead] = [[0, 0, 0], [0, 0, 0]];
      const at = (index) => places.subarray(3 * index, 3 * index + 3);
      const way = (from, to) => unit([0, 1, 2].map((axis) => at(to)[axis] - at(from)[axis]));
      visit((raw) => {
        inWorld(raw, [0, 0, 0]);
        const own = (v) => [0, 1, 2].map((column) => dot(turns.subarray(9 * person.head + 3 * column), v));
        const facing = cross(way(person.arms[1][0], person.arms[0][0]), way(person.hips, person.neck));
        [ahead, up] = [[ahead, facing], [up, way(person.neck, person.head)]].map(([sum, v]) => own(v).map((x, axis) => sum[axis] + x));
      });
      ahead = unit(ahead);
      up = unit(up);
      const risen = dot(up, ahead);
      up = unit(up.map((x, axis) => x - ahead[axis] * risen));
      headAxes = [up, ahead, cross(up, ahead)];
    },
    // Colors are red, green and blue of the ground, the outlines, the left and the right side, and of what is behind the figure.
    draw(context, [ground, middle, left, right, , , paper], rows, aside) {
      measure();
      if (person) turnHead();
      sort();
      const isDark = paper[0] + 2 * paper[1] + paper[2] < 512;
      const stated = look.colors;
      const edge = css(stated.edge ?? (isDark ? [6, 8, 14] : middle.slice(0, 3)));
      // Whole pixels, as in the firmware.
      const width = Math.floor(clamp((Math.min(height, rows) + 0.5) / look.outline, 1, 8));
      const over = (part) => between(paper.slice(0, 3), ground, part);
      context.save();
      context.translate(aside, 0);
      floor(context, { stage: stated.stage ?? over(0.16), line: stated.floor ?? over(0.3), shadow: stated.shadow ?? (isDark ? paper.slice(0, 3).map((x) => x * 0.7) : over(0.4)) });
      let drawn = 0;
      for (const index of order) {
        if (person && index === HEAD) {
          drawHead(context, head, stated, edge, width);
          drawn |= HEAD_JOINT;
          continue;
        }
        const colors = [stated.left ?? left, stated.right ?? right, stated["right-end"] ?? right];
        const part = !person ? bonePart(index, colors) : index < LIMBS ? trunkPart(index) : index < PARTS ? sidePart(index, colors) : attachedPart(look.attachments[index - PARTS]);
        const { circles, color, isRight, ends } = part;
        const bright = clamp(0.94 - ((part.depth ?? 0) / depth) * 0.9, SHADE, 1) * (isRight ? 0.9 : 1);
        // 0.42 of the mean radius towards the lower right.
        const mean = circles.reduce((sum, [, , r]) => sum + r, 0) / circles.length;
        const shift = height >= 80 && [0.242, 0.34].map((way) => mean * way);
        paint(context, circles, { color, light: bright, shift, edge, width, open: ends.flatMap(([circle, joint]) => (joint & drawn ? [circle] : [])) });
        drawn |= ends.reduce((all, [, joint]) => all | joint, part.covers);
      }
      context.restore();
    },
  };
}
