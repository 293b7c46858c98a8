// The packages as a program in Node uses them: `node check.mjs CLIP CHARACTER`. Prints what was measured.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { openCharacter } from "@pantin/animator";
import { openClip } from "@pantin/decoder";
import * as min from "@pantin/decoder/min";
import { findJoint } from "@pantin/decoder/turns";
import * as minTurns from "@pantin/decoder/turns/min";
import { PantinPlayer } from "@pantin/player";
import { PantinCharacter, PantinPose, toAnimationClip } from "@pantin/three";
import { AnimationMixer, Bone, Euler, Float32BufferAttribute, BufferGeometry, Group, Mesh, Quaternion, Skeleton, Vector3 } from "three";

const bytes = readFileSync(process.argv[2]);
const clip = openClip(bytes);
const short = min.openClip(bytes).play();
const named = clip.joints.filter(({ name }) => name).map(({ name }) => name);
for (const player = clip.play(); player.step() && short.step(); ) {
  assert.deepEqual(player.raw, short.raw);
  for (const name of named) assert.deepEqual(findJoint(player, name).euler("YZX"), minTurns.findJoint(short, name).euler("YZX"));
}

// Without a page, the element is a class and nothing more.
assert.equal(typeof PantinPlayer, "function");

// A figure of bones: below an armature that turns, scales and is elsewhere, the joints are where they are without it.
function figure(inside = new Group(), joints = clip.joints) {
  const root = new Group().add(inside);
  const bones = joints.map(({ name, offset }) => Object.assign(new Bone(), { name: name && `mixamorig${name}` }).translateX(offset[0]).translateY(offset[1]).translateZ(offset[2]));
  const { scale } = inside;
  joints.forEach(({ parent }, index) => {
    bones[index].position.divide(scale);
    (parent < 0 ? inside : bones[parent]).add(bones[index]);
  });
  return { root, bones };
}
const places = ({ root, bones }) => (root.updateMatrixWorld(true), bones.map((bone) => new Vector3().setFromMatrixPosition(bone.matrixWorld)));
const map = (name) => `mixamorig${name}`;
const armature = new Group();
armature.rotation.set(-Math.PI / 2, 0.3, 0);
armature.scale.setScalar(0.01);
armature.position.set(4, 5, 6);
const [plain, turned] = [figure(), figure(armature)];
const poses = [plain, turned].map(({ root }) => new PantinPose(clip, root, { map }));
assert.deepEqual(poses[0].missing, { joints: [], scalars: [] });
const mixers = [plain, turned].map(({ root }) => {
  const mixer = new AnimationMixer(root);
  mixer.clipAction(toAnimationClip(clip, root, { map })).play();
  return mixer;
});
const player = clip.play();
let farthest = 0;
for (let frame = 0; frame < clip.frames; frame += 7) {
  const world = player.seek(frame).world();
  const compare = (figure) => places(figure).forEach((place, joint) => clip.joints[joint].isEnd || (farthest = Math.max(farthest, place.distanceTo(new Vector3().fromArray(world, 3 * joint)))));
  poses.forEach((pose) => pose.setTime((frame * clip.frameTimeNs) / 1e9 + 1e-7));
  [plain, turned].forEach(compare);
  mixers.forEach((mixer) => mixer.setTime((frame * clip.frameTimeNs) / 1e9));
  [plain, turned].forEach(compare);
}
const size = Math.max(...clip.joints.map(({ offset }) => Math.hypot(...offset)));
assert.ok(farthest < 1e-4 * size, `a joint is ${farthest} away, where a bone has ${size}`);
assert.throws(() => new PantinPose(clip, new Group().add(Object.assign(new Bone(), { name: "thumb" }))), /map.*hips.*thumb/);

// On bones of half the length, with axes of their own and other rest directions of the limbs below a joint, the limbs point where those of the clip do.
const upright = new Quaternion().setFromUnitVectors(new Vector3(...clip.rig.up), new Vector3(0, 1, 0));
const other = figure(armature.clone(false));
const rests = [];
clip.joints.forEach(({ parent, offset }, index) => {
  const bone = other.bones[index];
  rests[index] = new Vector3(...offset).applyQuaternion(upright).multiplyScalar(0.5).applyAxisAngle(new Vector3(0, 0, 1), index % 3 ? 0 : 0.5).add(rests[parent] ?? new Vector3());
  bone.parent.updateWorldMatrix(true, false);
  const above = bone.parent.getWorldQuaternion(new Quaternion()).invert();
  bone.position.copy(bone.parent.worldToLocal(rests[index].clone()));
  bone.quaternion.copy(above.multiply(new Quaternion().setFromEuler(new Euler(index, 2 * index, 3 * index))));
});
const retargeted = new PantinPose(clip, other.root, { map, retarget: true });
let [greatest, limbs] = [0, 0];
for (let frame = 0; frame < clip.frames; frame += 11) {
  retargeted.player.seek(frame);
  retargeted.apply();
  const [world, now] = [player.seek(frame).world(), places(other)];
  clip.joints.forEach(({ parent, isEnd }, joint) => {
    const siblings = clip.joints.filter((one) => one.parent === parent && !one.isEnd).length;
    if (isEnd || siblings !== 1 || !(clip.joints[parent]?.parent >= 0)) return;
    const way = new Vector3().fromArray(world, 3 * joint).sub(new Vector3().fromArray(world, 3 * parent)).applyQuaternion(upright);
    if (way.length() < 1e-3 * size) return;
    greatest = Math.max(greatest, way.angleTo(now[joint].clone().sub(now[parent])));
    limbs += 1;
  });
}
assert.ok(limbs > 50 && greatest < 1e-5, `${limbs} limbs, ${greatest} radians`);
assert.ok(new PantinPose(clip, new Skeleton(plain.bones), { map }).joints.length > 10);

// A character walks, turns and waves on bones as in its own numbers: in the world, and in its place; on bones of half the length it goes half as far.
const walker = openCharacter(readFileSync(process.argv[3]));
const [inside, small] = [figure(armature.clone(false), walker.joints), figure(new Group(), walker.joints)];
small.bones.forEach(({ position }) => position.multiplyScalar(0.5));
const shown = [new PantinCharacter(walker, inside.root, { map }), new PantinCharacter(walker, small.root, { map, retarget: true })];
assert.deepEqual(shown.map(({ missing }) => missing.joints), [[], []]);
const apart = (figure, factor, world) => Math.max(...places(figure).map((place, joint) => (walker.joints[joint].isEnd ? 0 : place.distanceTo(new Vector3().fromArray(world, 3 * joint).multiplyScalar(factor)))));
const soles = ["left-foot", "left-toes", "right-foot", "right-toes"].map(walker.joint);
let before;
for (let picture = 0; picture < 480; picture++) {
  walker.hold("go", picture < 200);
  if (picture === 320) walker.fire("left");
  shown[0].update(1 / 60);
  shown[1].apply();
  const world = walker.world();
  assert.ok(apart(inside, 1, world) < 1e-4 * size, `picture ${picture}: ${apart(inside, 1, world)}`);
  assert.ok(apart(small, 0.5, world) < 1e-4 * size, `picture ${picture}: ${apart(small, 0.5, world)}`);
  // Who walks or turns, 2 cm a picture, stands on something.
  const now = soles.map((joint) => new Vector3(world[3 * joint], 0, world[3 * joint + 2]));
  if (/walk|turn/.test(walker.state) && before) assert.ok(now.some((place, index) => place.distanceTo(before[index]) < 0.3), `picture ${picture}`);
  before = now;
}
// A figure that faces another way at rest walks that way: its way and its bones are turned.
const aside = figure(new Group(), walker.joints);
const turned90 = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), Math.PI / 2);
aside.bones.forEach(({ position }) => position.applyQuaternion(turned90));
new PantinCharacter(walker, aside.root, { map, retarget: true });
const there = walker.world();
places(aside).forEach((place, joint) => assert.ok(walker.joints[joint].isEnd || place.distanceTo(new Vector3().fromArray(there, 3 * joint).applyQuaternion(turned90)) < 1e-4 * size, `${joint}`));
const { position, heading } = walker.placement;
assert.ok(position[2] > 300 && Math.abs(Math.abs(heading) - Math.PI / 2) < 0.1, `${position} ${heading}`);
walker.inPlace = true;
shown.forEach((figure) => figure.apply());
assert.ok(apart(inside, 1, walker.world()) < 1e-4 * size && Math.hypot(...walker.translation(0)) < 200);
assert.throws(() => walker.fire("fly"), /go, jump/);

// Scalars move morph targets; frames of 100 characters are decoded and posed.
if (clip.scalars.length) {
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute([0, 0, 0], 3));
  geometry.morphAttributes.position = clip.scalars.map(({ name }) => Object.assign(new Float32BufferAttribute([0, 0, 0], 3), { name }));
  const mesh = new Mesh(geometry);
  new PantinPose(clip, mesh).setTime(clip.duration / 2);
  assert.ok(mesh.morphTargetInfluences.some(Boolean));
}
const crowd = Array.from({ length: 100 }, (_, index) => new PantinPose(clip, figure().root, { map }).setTime(index / 50));
const frames = 200;
let begun = 0;
for (let frame = -60; frame < frames; frame++) {
  if (!frame) begun = performance.now();
  for (const pose of crowd) pose.update(pose.time + 1 / 60 < clip.duration || clip.looped ? 1 / 60 : -pose.time);
}
const ms = (performance.now() - begun) / frames;
assert.ok(ms < 8, `${ms} ms a frame`);
console.log(JSON.stringify({ characters: crowd.length, joints: clip.joints.filter(({ isEnd }) => !isEnd).length, ms, farthest, size }));
