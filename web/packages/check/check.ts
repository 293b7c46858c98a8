// What the packages' types allow, and what they do not.
import { openCharacter, type Character } from "@pantin/animator";
import { openBank, openClip, type Clip, type Player } from "@pantin/decoder";
import { openClip as openShort } from "@pantin/decoder/min";
import { degrees, findJoint, type EulerOrder } from "@pantin/decoder/turns";
import { findJoint as findShort } from "@pantin/decoder/turns/min";
import { PantinPlayer, type Heard } from "@pantin/player";
import { PantinCharacter, PantinPose, toAnimationClip } from "@pantin/three";
import { AnimationMixer, Object3D, Skeleton } from "three";

export async function use(bytes: ArrayBuffer, root: Object3D): Promise<number> {
  const clip: Clip = openClip(bytes);
  openShort(new Uint8Array(bytes)).play().step();
  openBank(bytes).open("walk");
  const player: Player = clip.play().seek(3);
  const turns: Float32Array = player.rotation(0, new Float32Array(4));
  const knee = findJoint(player, "LeftLeg");
  const order: EulerOrder = knee.order ?? "ZYX";
  const angles: Int32Array = knee.euler(order, new Int32Array(3));
  turns[0] = findShort(player, "LeftLeg").euler("XYZ").map(degrees)[0] ?? angles[0];
  // @ts-expect-error There is no such order.
  knee.euler("XYX");
  new AnimationMixer(root).clipAction(toAnimationClip(clip, root, { name: "walk", map: { Hips: "hips", Toe: null } })).play();
  const pose = new PantinPose(clip, new Skeleton([]), { morphs: (name) => name.toLowerCase(), scale: 0.01, retarget: true, inPlace: true }).update(0.1);
  const character: Character = openCharacter(bytes);
  character.hold("go", true);
  new PantinCharacter(character, root, { retarget: true }).update(0.1).apply();
  const [east]: readonly number[] = character.placement.position;
  character.inPlace = character.events.some(({ name }) => name === "left_foot_down") && east !== 0;
  // @ts-expect-error It is set by `set`.
  character.parameters[0].value = 3;
  const element: PantinPlayer = document.createElement("pantin-player");
  element.src = "walk.ptn";
  element.addEventListener("heard", ({ detail }) => console.log((detail satisfies Heard).name));
  element.addEventListener("ended", () => element.pause());
  element.addEventListener("error", ({ detail }) => console.log(detail.toUpperCase(), element.error?.message));
  element.addEventListener("click", ({ clientX }) => console.log(clientX));
  element.playbackRate = element.readyState === 4 ? 2 : 1;
  await element.play();
  await element.load(new URL("walk.ptn", location.href), "walk");
  // @ts-expect-error It can only be read.
  element.frame = 4;
  // @ts-expect-error There is no such look.
  element.look = "cubes";
  return turns.length + pose.missing.joints.length;
}
