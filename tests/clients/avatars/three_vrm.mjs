// Run by Node: avatars in Chromium, loaded and drawn by three-vrm, as web apps for avatars do. Writes what was loaded as
// one line of JSON and, where the scene names a picture, a PNG of it.
//   node three_vrm.mjs MODULES_FOLDER SCENE.json
// The scene: {"avatars": [{"file": …, "animation": …, "time_s": …, "x_m": …, "turn_deg": …,
//   "pose": {"leftLowerLeg": [x, y, z in degrees]}, "expressions": {"aa": 1}}],
//   "picture": …, "size": [w, h], "eye_m": […], "look_m": […], "fov_deg": …, "background": …}; only "avatars" is needed.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';

const [modules, sceneFile] = process.argv.slice(2);
const scene = JSON.parse(fs.readFileSync(sceneFile, 'utf8'));
const base64 = (file) => (file ? fs.readFileSync(file).toString('base64') : null);
for (const avatar of scene.avatars) {
  avatar.bytes = base64(avatar.file);
  avatar.animationBytes = base64(avatar.animation);
}
const imports = {
  three: '/modules/three/build/three.module.js',
  'three/addons/': '/modules/three/examples/jsm/',
  '@pixiv/three-vrm': '/modules/@pixiv/three-vrm/lib/three-vrm.module.js',
  '@pixiv/three-vrm-animation': '/modules/@pixiv/three-vrm-animation/lib/three-vrm-animation.module.js',
};

// Runs in the page; only its text is used here.
async function draw(scene) {
  const THREE = await import('three');
  const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
  const { VRMLoaderPlugin, VRMUtils } = await import('@pixiv/three-vrm');
  const { VRMAnimationLoaderPlugin, createVRMAnimationClip } = await import('@pixiv/three-vrm-animation');
  const [width, height] = scene.size ?? [640, 640];
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setSize(width, height);
  renderer.shadowMap.enabled = true;
  const stage = new THREE.Scene();
  stage.background = new THREE.Color(scene.background ?? '#3a4150');
  const sun = new THREE.DirectionalLight(0xffffff, Math.PI * 0.8);
  sun.position.set(1.5, 4, 3);
  sun.castShadow = true;
  stage.add(sun, new THREE.AmbientLight(0xffffff, Math.PI * 0.35));
  const floor = new THREE.Mesh(new THREE.CircleGeometry(6, 64), new THREE.MeshLambertMaterial({ color: '#8a7f78' }));
  floor.rotation.x = -Math.PI / 2;
  floor.receiveShadow = true;
  stage.add(floor);
  const camera = new THREE.PerspectiveCamera(scene.fov_deg ?? 30, width / height, 0.05, 50);
  camera.position.set(...(scene.eye_m ?? [0, 1.1, 4.2]));
  camera.lookAt(...(scene.look_m ?? [0, 0.9, 0]));
  const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const load = (text) => {
    const loader = new GLTFLoader();
    loader.register((parser) => new VRMLoaderPlugin(parser));
    loader.register((parser) => new VRMAnimationLoaderPlugin(parser));
    return loader.parseAsync(bytesOf(text), '');
  };
  const report = [];
  for (const avatar of scene.avatars) {
    const gltf = await load(avatar.bytes);
    const vrm = gltf.userData.vrm;
    if (!vrm) throw new Error('no VRM in it');
    VRMUtils.rotateVRM0(vrm);
    vrm.scene.traverse((object) => { object.castShadow = true; object.frustumCulled = false; });
    vrm.scene.position.x = avatar.x_m ?? 0;
    vrm.scene.position.z = avatar.z_m ?? 0;
    vrm.scene.rotation.y = ((avatar.turn_deg ?? 0) * Math.PI) / 180;
    stage.add(vrm.scene);
    const mixer = new THREE.AnimationMixer(vrm.scene);
    if (avatar.animationBytes) {
      const animation = (await load(avatar.animationBytes)).userData.vrmAnimations[0];
      mixer.clipAction(createVRMAnimationClip(animation, vrm)).play();
    }
    // A pose is taken within half a second.
    const bend = (share) => {
      for (const [bone, euler] of Object.entries(avatar.pose ?? {})) {
        const angles = euler.map((d) => (share * d * Math.PI) / 180);
        vrm.humanoid.getNormalizedBoneNode(bone).rotation.set(...angles, 'XYZ');
      }
    };
    for (const [name, weight] of Object.entries(avatar.expressions ?? {})) vrm.expressionManager.setValue(name, weight);
    // A second of dance before the picture, so that what swings swings.
    const step = 1 / 60;
    const end = avatar.time_s ?? 0;
    mixer.setTime(Math.max(0, end - 1));
    vrm.update(0);
    vrm.springBoneManager?.reset();
    for (let i = 0; i < 60; ++i) {
      mixer.setTime(Math.max(0, end - 1 + (i + 1) * step));
      bend(Math.min(1, (i + 1) / 30));
      vrm.update(step);
    }
    stage.updateMatrixWorld(true);
    const box = { min: [1e9, 1e9, 1e9], max: [-1e9, -1e9, -1e9] };
    let triangles = 0;
    let finite = true;
    const materials = new Set();
    const place = new THREE.Vector3();
    vrm.scene.traverse((object) => {
      if (!object.isSkinnedMesh) return;
      for (const m of [object.material].flat()) materials.add(`${m.type}`);
      triangles += object.geometry.index.count / 3;
      for (let v = 0; v < object.geometry.attributes.position.count; ++v) {
        object.localToWorld(object.getVertexPosition(v, place));
        const p = place.toArray();
        finite &&= p.every(Number.isFinite);
        for (let axis = 0; axis < 3; ++axis) {
          box.min[axis] = Math.min(box.min[axis], p[axis]);
          box.max[axis] = Math.max(box.max[axis], p[axis]);
        }
      }
    });
    report.push({ meta: vrm.meta, bones: Object.keys(vrm.humanoid.humanBones).length, triangles, finite, box,
      expressions: Object.keys(vrm.expressionManager?.expressionMap ?? {}),
      spring_joints: vrm.springBoneManager?.joints.size ?? 0,
      colliders: vrm.springBoneManager?.colliders.length ?? 0, materials: [...materials].sort() });
  }
  renderer.render(stage, camera);
  return { avatars: report, picture: scene.picture ? renderer.domElement.toDataURL('image/png') : null };
}

const page = `<!doctype html><meta charset="utf-8"><script type="importmap">${JSON.stringify({ imports })}</script>
<script type="module">${draw}
let said;
try { said = await draw(await (await fetch('/scene')).json()); }
catch (error) { said = { error: String(error) + (error.stack ?? '') }; }
await fetch('/seen', { method: 'POST', body: JSON.stringify(said) });</script>`;

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'dance-three-vrm-'));
const finish = (seen) => {
  chromium?.kill('SIGKILL');
  server.close();
  server.closeAllConnections();
  if (seen.picture) fs.writeFileSync(scene.picture, Buffer.from(seen.picture.split(',')[1], 'base64'));
  delete seen.picture;
  console.log(JSON.stringify(seen));
  setTimeout(() => { fs.rmSync(folder, { recursive: true, force: true }); process.exit(0); }, 200);
};
const answer = (response, type, body) => { response.setHeader('content-type', type); response.end(body); };
const server = http.createServer((request, response) => {
  if (request.url === '/') return answer(response, 'text/html', page);
  if (request.url === '/scene') return answer(response, 'application/json', JSON.stringify(scene));
  if (request.url.startsWith('/modules/')) {
    const file = path.join(modules, path.normalize(request.url.slice('/modules'.length)));
    if (fs.existsSync(file)) return answer(response, 'text/javascript', fs.readFileSync(file));
  }
  if (request.url === '/seen') {
    let body = '';
    request.on('data', (part) => { body += part; });
    return request.on('end', () => { response.end(); finish(JSON.parse(body)); });
  }
  response.statusCode = 404;
  return response.end();
});
let chromium;
server.listen(0, '127.0.0.1', () => {
  chromium = spawn('chromium', ['--headless', '--no-sandbox', '--disable-extensions', '--disable-background-networking',
    '--no-first-run', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', `--user-data-dir=${folder}/profile`,
    '--remote-debugging-pipe', `http://127.0.0.1:${server.address().port}/`],
  { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
  chromium.on('error', (error) => finish({ error: String(error) }));
});
setTimeout(() => finish({ error: 'Chromium said nothing for 100 s' }), 100000).unref();
