// Run by Node: opens a GLB as a VRM animation with the plugin that avatar apps on the web use, and writes what it found.
//   node vrm_animation.mjs MODULES_FOLDER FILE
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, file] = process.argv.slice(2);
const load = (name) => import(pathToFileURL(path.join(modules, name)));
globalThis.self = globalThis;
const { GLTFLoader } = await load('three/examples/jsm/loaders/GLTFLoader.js');
const { VRMAnimationLoaderPlugin } = await load('@pixiv/three-vrm-animation/lib/three-vrm-animation.module.js');

const loader = new GLTFLoader();
loader.register((parser) => new VRMAnimationLoaderPlugin(parser));
const bytes = fs.readFileSync(file);
const gltf = await loader.parseAsync(
  bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
const animations = gltf.userData.vrmAnimations ?? [];
const { translation, rotation } = animations[0].humanoidTracks;
console.log(JSON.stringify({
  animations: animations.length,
  rest_hips: animations[0].restHipsPosition.toArray(),
  hips: Array.from(translation.get('hips').values.slice(0, 3)),
  rotated: [...rotation.keys()],
}));
