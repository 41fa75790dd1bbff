// A performer of the VMC protocol that shares no code with this tree: walks a circle half a metre
// wide, facing +Z of Unity, with the left arm straight up, and knows its own proportions.
//   node vmc_performer.mjs NODE_MODULES PORT SECONDS
import { createRequire } from "node:module";
import dgram from "node:dgram";

const [modules, port, seconds] = process.argv.slice(2);
const osc = createRequire(modules + "/")("osc");
const socket = dgram.createSocket("udp4");
const rate = 60;
const half = Math.SQRT1_2;

const rest = { Spine: [0, 0.1, 0], Chest: [0, 0.12, 0], Neck: [0, 0.25, 0], Head: [0, 0.09, 0] };
for (const [side, x] of [["Left", -1], ["Right", 1]]) {
  Object.assign(rest, {
    [side + "Shoulder"]: [0.03 * x, 0.2, 0], [side + "UpperArm"]: [0.14 * x, 0, 0],
    [side + "LowerArm"]: [0.27 * x, 0, 0], [side + "Hand"]: [0.24 * x, 0, 0],
    [side + "UpperLeg"]: [0.09 * x, -0.05, 0], [side + "LowerLeg"]: [0, -0.41, 0],
    [side + "Foot"]: [0, -0.39, -0.02], [side + "Toes"]: [0, -0.05, 0.13],
    [side + "ThumbProximal"]: [0.02 * x, 0, 0.02], [side + "IndexProximal"]: [0.09 * x, 0, 0.02],
  });
}
// In Unity's axes the left arm of the T-pose points to -X: up is -90 degrees about Z.
const rotations = { LeftUpperArm: [0, 0, -half, half], LeftThumbProximal: [0, 0.6, 0, 0.8] };

const float = (value) => ({ type: "f", value });
const transform = (address, name, p, q) => ({
  address, args: [{ type: "s", value: name }, ...p.map(float), ...q.map(float)] });
const send = (packets) =>
  socket.send(Buffer.from(osc.writeBundle({ timeTag: osc.timeTag(0), packets })), Number(port), "127.0.0.1");

const began = process.hrtime.bigint();
let frame = 0;
const timer = setInterval(() => {
  const t = Number(process.hrtime.bigint() - began) / 1e9;
  if (t > Number(seconds)) {
    clearInterval(timer);
    socket.close();
    return;
  }
  const angle = frame++ / rate;
  const hips = [0.5 * Math.sin(angle), 0.9, 0.5 * Math.cos(angle)];
  const bones = Object.entries(rest).map(([name, p]) =>
    transform("/VMC/Ext/Bone/Pos", name, p, rotations[name] ?? [0, 0, 0, 1]));
  send([transform("/VMC/Ext/Root/Pos", "root", [0, 0, 0], [0, 0, 0, 1]),
        transform("/VMC/Ext/Bone/Pos", "Hips", hips, [0, 0, 0, 1]), ...bones.slice(0, 12)]);
  send([...bones.slice(12), { address: "/VMC/Ext/Blend/Val", args: [{ type: "s", value: "Joy" }, float(1)] },
        { address: "/VMC/Ext/Blend/Apply", args: [] },
        { address: "/VMC/Ext/OK", args: [{ type: "i", value: 1 }] },
        { address: "/VMC/Ext/T", args: [float(t)] },
        { address: "/VMC/Ext/Midi/Note", args: [1, 2, 3].map((value) => ({ type: "i", value })) }]);
}, 1000 / rate);
