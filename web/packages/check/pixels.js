// In the page: a glTF file as its own animation moves it, and as a clip of that animation does, picture by picture.
import { openClip } from "@pantin/decoder";
import { PantinPose } from "@pantin/three";
import { AnimationMixer, Box3, Color, DirectionalLight, HemisphereLight, PerspectiveCamera, PropertyBinding, Scene, SkeletonHelper, Vector3, WebGLRenderer } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const SIZE = 256;
const PICTURES = 24;
// Of 255: less is a shade that nobody sees.
const SEEN = 24;

const renderer = new WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
renderer.setSize(SIZE, SIZE);
document.body.append(renderer.domElement);

function stage({ scene }) {
  const stage = new Scene();
  stage.background = new Color(0x000000);
  const sun = new DirectionalLight(0xffffff, 2);
  sun.position.set(1, 2, 3);
  stage.add(new HemisphereLight(0xffffff, 0x444444, 2), sun, scene);
  let meshes = 0;
  scene.traverse((node) => {
    meshes += node.isMesh ? 1 : 0;
    node.frustumCulled = false;
  });
  if (!meshes) stage.add(new SkeletonHelper(scene));
  return stage;
}

function pixels(stage, camera) {
  renderer.render(stage, camera);
  const gl = renderer.getContext();
  const out = new Uint8Array(4 * SIZE * SIZE);
  gl.readPixels(0, 0, SIZE, SIZE, gl.RGBA, gl.UNSIGNED_BYTE, out);
  return out;
}

// Whether a pixel of one picture has its like in another at most one pixel away: textures shimmer where a figure moves by less than that.
function hasItsLike(one, other, at) {
  const [x, y] = [(at / 4) % SIZE, Math.floor(at / 4 / SIZE)];
  for (let row = Math.max(y - 1, 0); row <= Math.min(y + 1, SIZE - 1); row++)
    for (let column = Math.max(x - 1, 0); column <= Math.min(x + 1, SIZE - 1); column++) {
      const there = 4 * (row * SIZE + column);
      if (Math.max(...[0, 1, 2].map((part) => Math.abs(one[at + part] - other[there + part]))) <= SEEN) return true;
    }
  return false;
}

// How many pixels show the figure, and which part of them has not its like, in the picture with most and on average.
globalThis.compare = async (file, clipFile, animation) => {
  const load = async () => new GLTFLoader().loadAsync(file);
  const [own, other] = [await load(), await load()];
  const clip = openClip(await (await fetch(clipFile)).arrayBuffer());
  // A node without a name is called by its number in the clip.
  const numbered = new Map();
  for (const [node, { nodes }] of other.parser.associations) if (nodes !== undefined && node.isObject3D) numbered.set(`node${nodes}`, node);
  const pose = new PantinPose(clip, other.scene, { map: (name) => numbered.get(name) ?? PropertyBinding.sanitizeNodeName(name) });
  const mixer = new AnimationMixer(own.scene);
  mixer.clipAction(own.animations[animation]).play();
  const stages = [stage(own), stage(other)];
  mixer.setTime(0);
  own.scene.updateMatrixWorld(true);
  const box = new Box3().setFromObject(own.scene, true);
  if (box.isEmpty()) own.scene.traverse((node) => box.expandByPoint(node.getWorldPosition(new Vector3())));
  const [middle, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3()).length()];
  const camera = new PerspectiveCamera(40, 1, size / 100, size * 10);
  camera.position.copy(middle).add(new Vector3(0.8, 0.4, 1).multiplyScalar(1.1 * size));
  camera.lookAt(middle);
  let [most, sum, shown, worst] = [0, 0, 0, null];
  for (let picture = 0; picture < PICTURES; picture++) {
    const frame = Math.round((picture * (clip.frames - 1)) / PICTURES);
    const seconds = (frame * clip.frameTimeNs) / 1e9;
    mixer.setTime(Math.min(seconds, own.animations[animation].duration - 1e-6));
    pose.setTime(seconds + 1e-7);
    const [a, b] = stages.map((stage) => pixels(stage, camera));
    let [seen, differ] = [0, 0];
    for (let at = 0; at < a.length; at += 4) {
      const isShown = (of) => of[at] | of[at + 1] | of[at + 2];
      if (!isShown(a) && !isShown(b)) continue;
      seen++;
      differ += hasItsLike(a, b, at) && hasItsLike(b, a, at) ? 0 : 1;
    }
    shown += seen / PICTURES;
    sum += differ / seen / PICTURES;
    if (differ / seen >= most) [most, worst] = [differ / seen, [a, b]];
  }
  const picture = (data) => {
    const canvas = Object.assign(document.createElement("canvas"), { width: SIZE, height: SIZE });
    const image = new ImageData(SIZE, SIZE);
    // The lowest row comes first.
    for (let row = 0; row < SIZE; row++) image.data.set(data.subarray(4 * SIZE * row, 4 * SIZE * (row + 1)), 4 * SIZE * (SIZE - 1 - row));
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas.toDataURL();
  };
  return { missing: pose.missing, shown: Math.round(shown), mean: sum, most, worst: worst.map(picture) };
};
globalThis.isReady = true;
