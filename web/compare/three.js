// Our walk as glTF, drawn in lines by three.js.
import { AnimationMixer, Clock, LineBasicMaterial, PerspectiveCamera, Scene, SkeletonHelper, WebGLRenderer } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const { scene: figure, animations } = await new GLTFLoader().loadAsync("walk.glb");
const renderer = new WebGLRenderer({ antialias: true });
renderer.setSize(480, 240);
document.body.append(renderer.domElement);
const lines = new SkeletonHelper(figure);
lines.material = new LineBasicMaterial({ color: 0x262b33 });
const scene = new Scene();
scene.add(figure, lines);
const mixer = new AnimationMixer(figure);
mixer.clipAction(animations[0]).play();
const camera = new PerspectiveCamera(40, 2, 0.1, 100);
camera.position.set(2.5, 1.5, 2.5);
camera.lookAt(0, 0.9, 0);
const clock = new Clock();
renderer.setAnimationLoop(() => {
  mixer.update(clock.getDelta());
  renderer.render(scene, camera);
  globalThis.first ??= performance.now();
});
