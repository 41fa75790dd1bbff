// McapWriter: an MCAP file with compressed chunks, indices and statistics, written as it comes. A
// file whose writer was killed has all chunks that were ended; readers recover them.
//
// Units/frames: times in nanoseconds since 1970.
// Ownership:    holds one chunk (4 MiB) and the chunks' index, at most kMostIndex_bytes, some
//               100,000 chunks of a full stage. It allocates for new channels and where the index
//               grows, not for messages.
// Threads:      none inside; one owner.
// Failure:      what `put` does with the bytes; messages that are left out, as one is too large or
//               the index is full, are counted.
// Source:       MCAP specification (mcap.dev/spec), version 0.
#pragma once

#include <functional>
#include <string>

#include "formats/mcap/mcap_chunk.h"
#include "formats/mcap/mcap_record.h"

namespace dance {

class McapWriter {
 public:
  static constexpr std::size_t kChunk_bytes = std::size_t{4} << 20;
  static constexpr std::size_t kMostIndex_bytes = std::size_t{256} << 20;

  using Put = std::function<void(std::span<const std::uint8_t> bytes)>;

  explicit McapWriter(Put put, std::size_t chunk_bytes = kChunk_bytes,
                      std::size_t most_index_bytes = kMostIndex_bytes);

  // Numbers to refer to them; at most 65,535 of each (our bug beyond).
  std::uint16_t add_schema(std::string_view name, std::string_view json_schema);
  std::uint16_t add_channel(std::uint16_t schema, std::string_view topic);
  // `json` as its channel's schema has it.
  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_ns,
             std::uint64_t publish_ns, std::string_view json);
  // Writes the chunk that is being filled; a reader has it from then on.
  void end_chunk();
  // The end of the data, the summary and the footer; nothing may be written afterwards.
  void finish();

  std::uint64_t messages() const { return messages_; }
  std::uint64_t left_out() const { return left_out_; }
  std::uint64_t bytes() const { return offset_; }

 private:
  void put(std::span<const std::uint8_t> bytes);
  void put_record();
  void index_chunk(std::uint64_t chunk_offset, std::uint64_t chunk_bytes);
  void put_summary();

  Put put_;
  std::size_t most_index_bytes_;
  McapChunk chunk_;
  McapRecord record_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;  // of all bytes since the last reset
  // Records that stand again in the summary.
  McapRecord schemas_;
  McapRecord channels_;
  McapRecord chunk_index_;
  std::vector<std::uint64_t> channel_messages_;  // by number, from 1
  std::uint16_t schema_count_ = 0;
  std::uint32_t chunk_count_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t start_ns_ = 0;
  std::uint64_t end_ns_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace dance
