// MCAP files in memory for tests.
//
// Ownership: plain values.
// Threads:   none.
// Failure:   none.
#pragma once

#include <vector>

#include "formats/mcap/dance_mcap_reader.h"
#include "formats/mcap/dance_mcap_writer.h"
#include "tests/formats/recording/recorded_night.h"

namespace dance {

using McapBytes = std::vector<std::uint8_t>;

inline McapWriter::Put put_into(McapBytes& bytes) {
  return [&bytes](std::span<const std::uint8_t> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
}

inline McapBytes mcap_of(const Recording& night, bool is_finished = true) {
  McapBytes bytes;
  DanceMcapWriter writer(put_into(bytes));
  night.play_into(writer);
  if (is_finished)
    writer.finish();
  else
    writer.end_chunk();
  return bytes;
}

// The same messages without compression: in one chunk, or bare.
inline McapBytes plain_mcap_of(const McapBytes& packed, bool is_chunked) {
  McapBytes bytes(kMcapMagic.begin(), kMcapMagic.end());
  McapRecord schemas, messages, chunk;
  std::vector<std::string> names, topics;
  McapReader reader = McapReader::over(packed).value();
  const auto number_of = [](std::vector<std::string>& list, std::string_view name) {
    const auto found = std::find(list.begin(), list.end(), name);
    if (found == list.end()) list.emplace_back(name);
    return static_cast<std::uint16_t>(std::find(list.begin(), list.end(), name) - list.begin() + 1);
  };
  while (const auto message = reader.next()) {
    const std::size_t schema_count = names.size(), topic_count = topics.size();
    const std::uint16_t schema = number_of(names, message->schema);
    const std::uint16_t topic = number_of(topics, message->topic);
    if (names.size() > schema_count) {
      schemas.begin(McapOp::kSchema);
      schemas.u16(schema);
      for (const std::string_view text :
           {message->schema, std::string_view("jsonschema"), std::string_view("{}")})
        schemas.text(text);
      schemas.end();
    }
    if (topics.size() > topic_count) {
      schemas.begin(McapOp::kChannel);
      schemas.u16(topic);
      schemas.u16(schema);
      schemas.text(message->topic);
      schemas.text("json");
      schemas.u32(0);
      schemas.end();
    }
    messages.begin(McapOp::kMessage);
    messages.u16(topic);
    messages.u32(message->sequence);
    messages.u64(message->log_ns);
    messages.u64(message->publish_ns);
    for (const char c : message->data) messages.u8(static_cast<std::uint8_t>(c));
    messages.end();
  }
  const auto add = [&](std::span<const std::uint8_t> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  if (is_chunked) {
    chunk.begin(McapOp::kChunk);
    chunk.u64(0);
    chunk.u64(0);
    chunk.u64(schemas.size() + messages.size());
    chunk.u32(0);  // no checksum
    chunk.text("");
    chunk.u64(schemas.size() + messages.size());
    chunk.end(schemas.size() + messages.size());
    add(chunk.bytes());
  }
  add(schemas.bytes());
  add(messages.bytes());
  return bytes;
}

}  // namespace dance
