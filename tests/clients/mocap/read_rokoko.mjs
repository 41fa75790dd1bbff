// Hears Rokoko Studio's live stream as its plugins do: LZ4 by lz4js, JSON by the engine. Checks each datagram, and puts
// the bodies together again from the hip's place and the global rotations alone, with bone lengths of the first frame.
// Arguments: port, seconds, file for the joints (one JSON line for each actor of each frame). Prints a report.
import { createSocket } from 'node:dgram'
import { createWriteStream } from 'node:fs'
import { createRequire } from 'node:module'

const require = createRequire(process.env.NODE_PATH + '/')
const lz4 = require('lz4js')
const [port, seconds, file] = process.argv.slice(2)

// Joint: [parent, T-pose rotation in Studio as x y z w, from the tables of Rokoko's plugin for Unity].
const h = 0.5, r = Math.SQRT1_2
const upright = [0, 0, 1, 0]
const bodies = {
  hip: [null, [0, 0, 0, 1]], spine: ['hip', upright], chest: ['spine', upright], neck: ['chest', upright], head: ['neck', upright],
  leftShoulder: ['chest', [0, 0, r, -r]], leftUpperArm: ['leftShoulder', [-h, -h, h, -h]],
  leftLowerArm: ['leftUpperArm', [-h, -h, h, -h]], leftHand: ['leftLowerArm', [-h, -h, h, -h]],
  rightShoulder: ['chest', [0, 0, r, r]], rightUpperArm: ['rightShoulder', [h, -h, h, h]],
  rightLowerArm: ['rightUpperArm', [h, -h, h, h]], rightHand: ['rightLowerArm', [h, -h, h, h]],
  leftUpLeg: ['hip', [0, r, 0, r]], leftLeg: ['leftUpLeg', [0, r, 0, r]], leftFoot: ['leftLeg', [0, r, -r, 0]],
  leftToe: ['leftFoot', [0, r, -r, 0]], leftToeEnd: ['leftToe', [0, r, -r, 0]],
  rightUpLeg: ['hip', [0, -r, 0, r]], rightLeg: ['rightUpLeg', [0, -r, 0, r]], rightFoot: ['rightLeg', [0, -r, r, 0]],
  rightToe: ['rightFoot', [0, -r, r, 0]], rightToeEnd: ['rightToe', [0, -r, r, 0]],
}

const minus = (a, b) => a.map((v, i) => v - b[i])
const plus = (a, b) => a.map((v, i) => v + b[i])
const length = a => Math.hypot(...a)
const inverse = q => [-q[0], -q[1], -q[2], q[3]]
const times = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz]
const turned = (q, v) => times(times(q, [...v, 0]), inverse(q)).slice(0, 3)

const report = { datagrams: 0, packed: 0, malformed: 0, problems: [], actors: {}, longest: 0, worst_sent_mm: 0, fps: 0 }
const lines = createWriteStream(file)
const lengths = {}
let last = -1

function joint(body, name) {
  const { position: p, rotation: q } = body[name]
  const numbers = [p.x, p.y, p.z, q.x, q.y, q.z, q.w]
  if (!numbers.every(Number.isFinite)) throw new Error(`${name}: ${numbers}`)
  if (Math.abs(length(numbers.slice(3)) - 1) > 1e-4) throw new Error(`${name} is no rotation`)
  return { p: numbers.slice(0, 3), q: numbers.slice(3) }
}

function check(actor, timestamp) {
  for (const key of ['hasGloves', 'hasLeftGlove', 'hasRightGlove', 'hasBody', 'hasFace'])
    if (typeof actor.meta[key] !== 'boolean') throw new Error(`meta.${key}`)
  if (!(actor.dimensions.totalHeight > 1 && actor.dimensions.hipHeight > 0.5)) throw new Error('dimensions')
  if (!Array.isArray(actor.color) || actor.color.length !== 3) throw new Error('color')
  if (!actor.meta.hasBody || actor.meta.hasFace) throw new Error('a body without a face is expected')
  const at = {}, turn = {}, built = {}
  for (const [name, [parent, rest]] of Object.entries(bodies)) {
    const { p, q } = joint(actor.body, name)
    at[name] = p
    turn[name] = times(q, inverse(rest))
    if (!parent) { built[name] = p; continue }
    // A dancer's own proportions may come after the first poses.
    const key = `${actor.name}/${actor.dimensions.totalHeight}/${name}`
    // Between spine and chest there is a bone more at home: the direction is the rotation's, the distance is sent.
    const learnt = minus(p, at[parent])
    lengths[key] ??= turned(inverse(turn[parent]), learnt)
    let arm = lengths[key]
    if (name === 'chest') arm = arm.map(v => v * length(learnt) / length(arm))
    built[name] = plus(built[parent], turned(turn[parent], arm))
    report.worst_sent_mm = Math.max(report.worst_sent_mm, 1000 * length(minus(built[name], p)))
  }
  const seen = report.actors[actor.name] ??= { frames: 0, gloves: 0 }
  seen.frames++
  if (actor.meta.hasGloves) {
    seen.gloves++
    const fingers = Object.keys(actor.body).filter(name => /Thumb|Index|Middle|Ring|Little/.test(name))
    if (fingers.length !== 40) throw new Error(`${fingers.length} joints of fingers`)
    fingers.forEach(name => joint(actor.body, name))
  }
  // Ours is the mirror image: the left hand at +X.
  const joints = Object.fromEntries(Object.entries(built).map(([name, [x, y, z]]) => [name, [-x, y, z]]))
  const { totalHeight } = actor.dimensions
  lines.write(JSON.stringify({ name: actor.name, timestamp, totalHeight, joints }) + '\n')
}

const socket = createSocket('udp4')
socket.on('message', datagram => {
  report.datagrams++
  report.longest = Math.max(report.longest, datagram.length)
  try {
    const packed = datagram.readUInt32LE(0) === 0x184d2204
    report.packed += packed
    const frame = JSON.parse(packed ? Buffer.from(lz4.decompress(datagram)).toString('utf8') : datagram.toString('utf8'))
    if (frame.version !== '3,0') throw new Error(`version ${frame.version}`)
    report.fps = frame.fps
    if (!Array.isArray(frame.scene.props)) throw new Error('no props')
    if (!(frame.scene.timestamp >= last)) throw new Error('time went back')
    last = frame.scene.timestamp
    for (const actor of frame.scene.actors) check(actor, last)
  } catch (error) {
    report.malformed++
    if (report.problems.length < 5) report.problems.push(String(error))
  }
})
socket.bind(Number(port), '127.0.0.1')
setTimeout(() => {
  socket.close()
  lines.end(() => console.log(JSON.stringify(report)))
}, 1000 * Number(seconds))
