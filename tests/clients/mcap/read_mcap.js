// Reads an MCAP file with @mcap/core, from front to back and by its indices, and compares it with a table of the same poses.
//   node read_mcap.js NIGHT.mcap NIGHT.csv    (modules by NODE_PATH)
// Prints one JSON object: counts, and the largest distance between a composition of transforms and the table's places.
"use strict";
const fs = require("fs");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const fzstd = require("fzstd");
const Ajv = require("ajv");
const foxglove = require("@foxglove/schemas/jsonschema");

const [mcapPath, csvPath] = process.argv.slice(2);
const decompressHandlers = { zstd: (bytes) => fzstd.decompress(bytes) };
const ajv = new Ajv({ strict: false });
const report = { messages: 0, indexed_messages: 0, invalid: 0, out_of_order: 0, topics: {}, guests: {}, compared: 0,
  largest_difference_mm: 0, upright: false, drawn_entities: 0, entities_without_frame: 0, problems: [] };
const problem = (text) => { if (report.problems.length < 10) report.problems.push(text); };

// --- transforms -----------------------------------------------------------------------------------------------------
const rotate = ({ x, y, z, w }, [a, b, c]) => {
  const [tx, ty, tz] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
};
class Frames {
  constructor() { this.of = new Map(); }
  take(transforms) { for (const each of transforms) this.of.set(each.child_frame_id, each); }
  // A point of `frame` in the frame `to`.
  place(frame, to, point = [0, 0, 0]) {
    for (let depth = 0; frame !== to; ++depth) {
      const step = this.of.get(frame);
      if (!step || depth > 30) return undefined;
      const t = step.translation;
      point = rotate(step.rotation, point).map((value, i) => value + [t.x, t.y, t.z][i]);
      frame = step.parent_frame_id;
    }
    return point;
  }
}

// --- the table ------------------------------------------------------------------------------------------------------
const rows = new Map();
const lines = fs.readFileSync(csvPath, "utf8").trimEnd().split("\n");
const columns = lines[0].split(",");
const column = new Map(columns.map((name, i) => [name, i]));
const joints = columns.filter((name) => name.endsWith("_x_m")).map((name) => name.slice(0, -4));
for (const line of lines.slice(1)) {
  const cells = line.split(",");
  rows.set(cells[column.get("guest")] + " " + cells[column.get("sequence")], cells);
}

// --- messages -------------------------------------------------------------------------------------------------------
const schemas = new Map(), channels = new Map(), validators = new Map(), frames = new Frames();
let lastTime = 0n;
const bodies = new Map(); // topic: entities of the newest update

function validatorsOf(schema) {
  if (!validators.has(schema.id)) {
    const list = [ajv.compile(JSON.parse(new TextDecoder().decode(schema.data)))];
    const name = schema.name.replace("foxglove.", "");
    // Foxglove's own schema, where it is one of theirs.
    if (name !== schema.name) list.push(ajv.compile({ ...foxglove[name], $id: undefined }));
    validators.set(schema.id, list);
  }
  return validators.get(schema.id);
}

function compare(topic, message) {
  const guest = topic.split("/")[2];
  const row = rows.get(guest + " " + message.sequence);
  if (!row) return;
  for (const joint of joints) {
    const at = frames.place(guest + "/" + joint, "stage");
    const far = at ? Math.hypot(...["_x_m", "_y_m", "_z_m"].map((axis, i) => at[i] - Number(row[column.get(joint + axis)])))
      : Infinity;
    report.largest_difference_mm = Math.max(report.largest_difference_mm, far * 1000);
  }
  ++report.compared;
}

function take(message) {
  const channel = channels.get(message.channelId);
  const schema = schemas.get(channel.schemaId);
  ++report.messages;
  report.topics[channel.topic] = (report.topics[channel.topic] ?? 0) + 1;
  if (message.logTime < lastTime) ++report.out_of_order;
  lastTime = message.logTime;
  const json = JSON.parse(new TextDecoder().decode(message.data));
  for (const validate of validatorsOf(schema)) {
    if (validate(json)) continue;
    ++report.invalid;
    problem(channel.topic + ": " + ajv.errorsText(validate.errors));
  }
  if (schema.name === "foxglove.FrameTransforms") {
    frames.take(json.transforms);
    if (channel.topic.startsWith("/guest/")) compare(channel.topic, message);
  } else if (schema.name === "foxglove.SceneUpdate") {
    bodies.set(channel.topic, json.entities);
  } else if (schema.name === "dancegraph.Pose") {
    report.guests[json.guest] = (report.guests[json.guest] ?? 0) + 1;
  }
}

async function main() {
  const bytes = fs.readFileSync(mcapPath);
  const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  for (let at = 0; at < bytes.length; at += 65536) {
    stream.append(bytes.subarray(at, at + 65536));
    for (let record; (record = stream.nextRecord()); ) {
      if (record.type === "Schema") schemas.set(record.id, record);
      if (record.type === "Channel") channels.set(record.id, record);
      if (record.type === "Message") take(record);
    }
  }
  if (!stream.done()) problem("the stream has no end");
  if (stream.bytesRemaining() !== 0) problem("bytes after the end");

  // By the indices: the same messages, in the order of their times.
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
  };
  const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  let time = 0n;
  for await (const message of indexed.readMessages({ validateCrcs: true })) {
    ++report.indexed_messages;
    if (message.logTime < time) problem("the index is out of order");
    time = message.logTime;
  }
  if (Number(indexed.statistics.messageCount) !== report.messages) problem("the statistics count other messages");
  if (indexed.statistics.chunkCount !== indexed.chunkIndexes.length) problem("the statistics count other chunks");
  // One channel's messages alone, as a panel asks for them.
  for (const [topic, count] of Object.entries(report.topics)) {
    let found = 0;
    for await (const message of indexed.readMessages({ topics: [topic] })) found += message ? 1 : 0;
    if (found !== count) problem(topic + ": " + found + " by its index, " + count + " in the stream");
  }

  // Foxglove is Z up: every head is above its hips there. What is drawn hangs on frames that are there.
  report.upright = Object.keys(report.guests).every((guest) => {
    const head = frames.place(guest + "/headTip", "world"), hips = frames.place(guest + "/hips", "world");
    return head && hips && head[2] > hips[2] + 0.3 && hips[2] > 0.5;
  });
  for (const entities of bodies.values()) {
    for (const entity of entities) {
      ++report.drawn_entities;
      if (frames.place(entity.frame_id, "world") === undefined) ++report.entities_without_frame;
    }
  }
  console.log(JSON.stringify(report));
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
