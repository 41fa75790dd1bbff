// MCAP files in memory for tests.
//
// Ownership: plain values.
// Threads:   none.
// Failure:   none.
#pragma once

#include <map>
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

// The same messages without compression: in one chunk, or bare. In one chunk also packed by `pack`,
// and one channel behind the other.
struct PlainMcapOptions {
  bool is_chunked = true;
  bool by_channel = false;
  std::string compression;
  std::vector<std::uint8_t> (*pack)(std::span<const std::uint8_t> bytes) = nullptr;
};
inline McapBytes plain_mcap_of(const McapBytes& packed, const PlainMcapOptions& options);
inline McapBytes plain_mcap_of(const McapBytes& packed, bool is_chunked) {
  PlainMcapOptions options;
  options.is_chunked = is_chunked;
  return plain_mcap_of(packed, options);
}
inline McapBytes plain_mcap_of(const McapBytes& packed, const PlainMcapOptions& options) {
  const bool is_chunked = options.is_chunked;
  McapBytes bytes(kMcapMagic.begin(), kMcapMagic.end());
  McapRecord schemas, messages, chunk;
  std::map<std::uint16_t, McapRecord> of_channel;
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
    McapRecord& to = options.by_channel ? of_channel[topic] : messages;
    to.begin(McapOp::kMessage);
    to.u16(topic);
    to.u32(message->sequence);
    to.u64(message->log_ns);
    to.u64(message->publish_ns);
    for (const char c : message->data) to.u8(static_cast<std::uint8_t>(c));
    to.end();
  }
  for (const auto& [topic, record] : of_channel)
    for (const std::uint8_t byte : record.bytes()) messages.u8(byte);
  const auto add = [&](std::span<const std::uint8_t> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  if (is_chunked) {
    chunk.begin(McapOp::kChunk);
    chunk.u64(0);
    chunk.u64(0);
    chunk.u64(schemas.size() + messages.size());
    chunk.u32(0);  // no checksum
    chunk.text(options.compression);
    if (options.pack != nullptr) {
      std::vector<std::uint8_t> content(schemas.bytes().begin(), schemas.bytes().end());
      content.insert(content.end(), messages.bytes().begin(), messages.bytes().end());
      const std::vector<std::uint8_t> small = options.pack(content);
      chunk.u64(small.size());
      chunk.end(small.size());
      add(chunk.bytes());
      add(small);
      return bytes;
    }
    chunk.u64(schemas.size() + messages.size());
    chunk.end(schemas.size() + messages.size());
    add(chunk.bytes());
  }
  add(schemas.bytes());
  add(messages.bytes());
  return bytes;
}

}  // namespace dance
