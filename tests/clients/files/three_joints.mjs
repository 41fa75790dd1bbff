// Run by Node: opens a GLB with three.js's GLTFLoader, plays its animation with an AnimationMixer, and writes where every
// joint is in some frames, and where the vertices of the skinned meshes are, as a browser would draw them.
//   node three_joints.mjs MODULES_FOLDER FILE OUT.json FIRST_FRAME COUNT STEP RATE_HZ
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, file, out, first, count, step, rate] = process.argv.slice(2);
const load = (name) => import(pathToFileURL(path.join(modules, 'three', name)));
globalThis.self = globalThis;
const THREE = await load('build/three.module.js');
const { GLTFLoader } = await load('examples/jsm/loaders/GLTFLoader.js');

const bytes = fs.readFileSync(file);
const gltf = await new GLTFLoader().parseAsync(
  bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
const mixer = new THREE.AnimationMixer(gltf.scene);
for (const clip of gltf.animations) {
  const action = mixer.clipAction(clip);
  action.clampWhenFinished = true;
  action.setLoop(THREE.LoopOnce);
  action.play();
}

// Names of nodes are made unique by the loader: the file's own are in its JSON.
const nameOf = (object) => {
  const index = gltf.parser.associations.get(object)?.nodes;
  return gltf.parser.json.nodes[index].name;
};
const frames = [];
for (let i = 0; i < Number(count); ++i) {
  const frame = Number(first) + i * Number(step);
  mixer.setTime(frame / Number(rate));
  gltf.scene.updateMatrixWorld(true);
  const joints = {};
  const bodies = {};
  gltf.scene.traverse((object) => {
    if (!object.isSkinnedMesh) return;
    const dancer = nameOf(object.skeleton.bones[0].parent);
    joints[dancer] = {};
    for (const bone of object.skeleton.bones) {
      joints[dancer][nameOf(bone)] = new THREE.Vector3().setFromMatrixPosition(bone.matrixWorld).toArray();
    }
    const bones = Object.values(joints[dancer]).map((p) => new THREE.Vector3(...p));
    const body = (bodies[dancer] ??= { vertices: 0, finite: true, furthest_from_bones_m: 0, lowest_m: 1e9 });
    const places = object.geometry.attributes.position;
    body.vertices += places.count;
    const place = new THREE.Vector3();
    for (let v = 0; v < places.count; v += 41) {
      object.localToWorld(object.getVertexPosition(v, place));
      body.finite &&= place.toArray().every(Number.isFinite);
      body.furthest_from_bones_m =
        Math.max(body.furthest_from_bones_m, Math.min(...bones.map((bone) => bone.distanceTo(place))));
      body.lowest_m = Math.min(body.lowest_m, place.y);
    }
  });
  frames.push({ frame, joints, bodies });
}
fs.writeFileSync(out, JSON.stringify({ three: THREE.REVISION, duration_s: gltf.animations[0].duration, frames }));
