// Reads Open Sound Control at ports of this machine with two independent libraries and prints what
// came as lines of JSON: each VMC frame with the places of its joints, put together from local
// positions and rotations as a receiver that takes both over does, and each packet of VRChat's
// trackers; at the end, for each port, what was counted.
//   node read_osc.mjs NODE_MODULES SECONDS PORT...
import { createRequire } from "node:module";
import dgram from "node:dgram";
import { pathToFileURL } from "node:url";

const [modules, seconds, ...ports] = process.argv.slice(2);
const osc = createRequire(modules + "/")("osc");
const oscMin = await import(pathToFileURL(modules + "/osc-min/dist/index.js").href);

const parents = { Spine: "Hips", Chest: "Spine", UpperChest: "Chest", Neck: "UpperChest", Head: "Neck" };
for (const side of ["Left", "Right"]) {
  const chain = (first, bones) => bones.forEach((bone, i) =>
    (parents[side + bone] = i === 0 ? first : side + bones[i - 1]));
  chain("UpperChest", ["Shoulder", "UpperArm", "LowerArm", "Hand"]);
  chain("Hips", ["UpperLeg", "LowerLeg", "Foot", "Toes"]);
}
const body = ["Hips", ...Object.keys(parents)];

const multiply = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz];
const turn = (q, v) => multiply(multiply(q, [...v, 0]), [-q[0], -q[1], -q[2], q[3]]).slice(0, 3);
const add = (a, b) => a.map((x, i) => x + b[i]);

function flat(packet) {
  const elements = packet.packets ?? packet.elements;
  if (elements) return elements.flatMap(flat);
  return [{ address: packet.address, args: (packet.args ?? []).map((a) => a.value ?? a) }];
}

// Of one port: what is wrong with a message, frames, counts.
class Reader {
  constructor(port) {
    this.counts = { port, packets: 0, messages: 0, malformed: 0, differing: 0, longest: 0, apart: 0,
      frames: 0, bones: 0, addresses: {} };
    this.frame = { bones: {} };
    this.socket = dgram.createSocket("udp4");
    this.socket.on("message", (bytes) => this.read(bytes));
    this.socket.bind(Number(port), "127.0.0.1");
  }
  read(bytes) {
    const counts = this.counts;
    counts.packets += 1;
    counts.longest = Math.max(counts.longest, bytes.length);
    let messages;
    try {
      messages = flat(osc.readPacket(bytes, { metadata: true }));
      const again = flat(oscMin.fromBuffer(bytes));
      if (JSON.stringify(messages) !== JSON.stringify(again)) counts.differing += 1;
    } catch (error) {
      counts.malformed += 1;
      return;
    }
    const trackers = {};
    for (const message of messages) this.take(message, trackers);
    if (Object.keys(trackers).length > 0) this.print({ trackers });
  }
  take({ address, args }, trackers) {
    const counts = this.counts;
    counts.messages += 1;
    counts.addresses[address] = (counts.addresses[address] ?? 0) + 1;
    if (args.some((a) => typeof a === "number" && !Number.isFinite(a))) counts.malformed += 1;
    if (address === "/VMC/Ext/T") this.frame = { t: args[0], bones: {} };
    else if (address === "/VMC/Ext/Root/Pos") this.frame.root = args;
    else if (address === "/VMC/Ext/Bone/Pos") {
      if (args.length !== 8) counts.malformed += 1;
      if (Math.abs(Math.hypot(...args.slice(4)) - 1) > 1e-5) counts.apart += 1;
      this.frame.bones[args[0]] = args.slice(1);
    } else if (address === "/VMC/Ext/Blend/Apply") this.finish();
    else if (address.startsWith("/tracking/")) trackers[address] = args;
  }
  finish() {
    const { t, root, bones } = this.frame;
    if (!root || !bones.Hips) return;  // listening began within the frame
    this.counts.frames += 1;
    this.counts.bones = Object.keys(bones).length;
    const frames = { root: { p: root.slice(1, 4), q: root.slice(4, 8) } };
    for (const bone of body) {
      const parent = frames[parents[bone] ?? "root"];
      const [x, y, z, ...q] = bones[bone];
      frames[bone] = { p: add(parent.p, turn(parent.q, [x, y, z])), q: multiply(parent.q, q) };
    }
    this.print({ t, p: Object.fromEntries(body.map((bone) => [bone, frames[bone].p])) });
  }
  print(line) {
    process.stdout.write(JSON.stringify({ port: Number(this.counts.port), ...line }) + "\n");
  }
}

const readers = ports.map((port) => new Reader(port));
setTimeout(() => {
  for (const reader of readers) {
    reader.socket.close();
    reader.print({ counts: reader.counts });
  }
}, 1000 * Number(seconds));
