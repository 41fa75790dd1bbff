// Draws one moment of an MCAP file from nothing but its transforms and scene updates, as Foxglove's 3D panel does: read with
// @mcap/core, drawn by three.js in chromium. It makes docs/pictures/mcap.png.
//   NODE_PATH=build/clients/node_modules node tests/clients/mcap/draw_mcap.js couple.mcap 3.2 mcap.png
"use strict";
const fs = require("fs");
const os = require("os");
const path = require("path");
const { execFileSync } = require("child_process");
const { McapIndexedReader } = require("@mcap/core");
const fzstd = require("fzstd");

const [mcapPath, seconds, picturePath] = process.argv.slice(2);

// What a panel has at that moment: the newest transform of each frame, the newest entities of each topic.
async function moment() {
  const bytes = fs.readFileSync(mcapPath);
  const reader = await McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
    },
    decompressHandlers: { zstd: (packed) => fzstd.decompress(packed) },
  });
  const until = reader.statistics.messageStartTime + BigInt(Math.round(Number(seconds) * 1e9));
  const transforms = {}, entities = {};
  for await (const message of reader.readMessages({ endTime: until })) {
    const schema = reader.schemasById.get(reader.channelsById.get(message.channelId).schemaId).name;
    if (!schema.startsWith("foxglove.")) continue;
    const json = JSON.parse(new TextDecoder().decode(message.data));
    for (const each of json.transforms ?? []) transforms[each.child_frame_id] = each;
    for (const each of json.entities ?? []) entities[each.id] = each;
  }
  return { transforms, entities: Object.values(entities) };
}

const page = (scene, three) => `<!doctype html><body style="margin:0"><script type="importmap">
{"imports":{"three":"file://${three}"}}</script><script type="module">
import * as THREE from "three";
const { transforms, entities } = ${JSON.stringify(scene)};
const stage = new THREE.Scene();
stage.background = new THREE.Color(0x15151c);
stage.add(new THREE.HemisphereLight(0xffffff, 0x665544, 1.6));
const sun = new THREE.DirectionalLight(0xffffff, 2.2);
sun.position.set(2, -4, 6);  // +Z is up
stage.add(sun);
const groups = new Map();
function frame(id) {
  if (groups.has(id)) return groups.get(id);
  const group = new THREE.Group(), t = transforms[id];
  groups.set(id, group);
  if (t) {
    group.position.copy(t.translation);
    group.quaternion.copy(t.rotation);
    frame(t.parent_frame_id).add(group);
  } else {
    stage.add(group);
  }
  return group;
}
const paint = (c) => new THREE.MeshStandardMaterial({ color: new THREE.Color(c.r, c.g, c.b).convertSRGBToLinear(), roughness: 0.7 });
function put(entity, shape, object) {
  object.position.copy(shape.pose.position);
  object.quaternion.multiplyQuaternions(new THREE.Quaternion().copy(shape.pose.orientation), object.quaternion.clone());
  frame(entity.frame_id).add(object);
}
for (const e of entities) {
  for (const s of e.spheres) { const m = new THREE.Mesh(new THREE.SphereGeometry(0.5, 24, 16), paint(s.color)); m.scale.copy(s.size); put(e, s, m); }
  for (const s of e.cubes) { const m = new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1), paint(s.color)); m.scale.copy(s.size); put(e, s, m); }
  for (const s of e.cylinders) {
    const g = new THREE.CylinderGeometry(0.5 * s.top_scale, 0.5 * s.bottom_scale, 1, 24);
    g.rotateX(Math.PI / 2);
    const m = new THREE.Mesh(g, paint(s.color));
    m.scale.copy(s.size);
    put(e, s, m);
  }
  for (const s of e.lines) {
    const g = new THREE.BufferGeometry().setFromPoints(s.points.map((p) => new THREE.Vector3(p.x, p.y + 0.002, p.z)));
    put(e, s, new THREE.LineSegments(g, new THREE.LineBasicMaterial({ color: new THREE.Color(s.color.r, s.color.g, s.color.b) })));
  }
  for (const s of e.texts) {
    const canvas = Object.assign(document.createElement("canvas"), { width: 256, height: 64 }), c = canvas.getContext("2d");
    c.font = "44px sans-serif"; c.textAlign = "center"; c.fillStyle = "white"; c.fillText(s.text, 128, 48);
    const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas) }));
    sprite.scale.set(s.font_size * 4, s.font_size, 1);
    put(e, s, sprite);
  }
}
const camera = new THREE.PerspectiveCamera(32, 960 / 600, 0.1, 50);
stage.updateMatrixWorld(true);
const middle = new THREE.Vector3();
let hips = 0;
for (const [id, group] of groups) if (id.endsWith("/hips")) { middle.add(group.getWorldPosition(new THREE.Vector3())); ++hips; }
middle.divideScalar(Math.max(1, hips));
camera.up.set(0, 0, 1);
camera.position.set(middle.x + 3.4, middle.y - 2.9, 1.9);
camera.lookAt(middle.x, middle.y, 0.92);
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(960, 600);
document.body.append(renderer.domElement);
renderer.render(stage, camera);
</script>`;

moment().then((scene) => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "draw-mcap-"));
  const three = require.resolve("three").replace(/three\.cjs$/, "three.module.js");
  fs.writeFileSync(path.join(folder, "page.html"), page(scene, three));
  execFileSync("chromium", ["--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--allow-file-access-from-files", "--hide-scrollbars", "--window-size=960,600",
    "--virtual-time-budget=20000", "--user-data-dir=" + folder, "--screenshot=" + path.resolve(picturePath),
    "file://" + path.join(folder, "page.html")], { stdio: "ignore", timeout: 120000 });
  fs.rmSync(folder, { recursive: true, force: true });
});
