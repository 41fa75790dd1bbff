// McapReader: the messages of an MCAP file in the order of the file, with their channels. It reads
// from front to back and trusts no index, so that files of killed writers and files without a
// summary read alike.
//
// Units/frames: times in nanoseconds since 1970.
// Ownership:    owns the file; a message's views are valid until the next call. Holds one chunk, at
//               most kMostChunk_bytes before and after decompression.
// Threads:      none inside; one owner.
// Failure:      open() names the file and the reason. Input is untrusted: what is damaged is left
//               out and counted by cause. A read error is not an end: ended() reports it.
// Source:       MCAP specification (mcap.dev/spec), version 0.
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "formats/mcap/mcap_record.h"

struct ZSTD_DCtx_s;

namespace dance {

class Lz4Unpacker;

struct McapMessage {
  std::string_view schema;  // its name
  std::string_view topic;
  std::string_view encoding;  // of the data
  std::uint32_t sequence = 0;
  std::uint64_t log_ns = 0;
  std::uint64_t publish_ns = 0;
  std::string_view data;
};

class McapReader {
 public:
  static constexpr std::size_t kMostChunk_bytes = std::size_t{64} << 20;
  static constexpr std::size_t kMostRecord_bytes = kMostChunk_bytes + 4096;
  static constexpr std::size_t kMostChannels = 4096;
  static constexpr std::size_t kMostName_bytes = 256;
  // More than real messages compress; a small file shall not cost hours.
  static constexpr std::uint64_t kMostRatio = 1000;
  static constexpr std::uint64_t kFreeOfRatio_bytes = std::uint64_t{1} << 20;

  struct Counters {
    std::uint64_t messages = 0;
    std::uint64_t malformed = 0;          // records that are not as the specification has them
    std::uint64_t damaged_chunks = 0;     // wrong checksum, or cannot be unpacked
    std::uint64_t damaged_bytes = 0;      // outside records
    std::uint64_t cut_records = 0;        // at the end of the file
    std::uint64_t oversized = 0;          // chunks and records beyond the bounds
    std::uint64_t other_compression = 0;  // chunks in a compression other than zstd and lz4
    std::uint64_t without_channel = 0;    // messages
    std::uint64_t beyond_channels = 0;    // schemas and channels beyond kMostChannels
    std::uint64_t lost() const {
      return malformed + damaged_chunks + damaged_bytes + cut_records + oversized +
             other_compression + without_channel + beyond_channels;
    }
  };

  static Result<McapReader> open(const std::string& path);
  // Reads bytes in memory, which must outlive the reader; an Error where they are no MCAP file.
  static Result<McapReader> over(std::span<const std::uint8_t> bytes);
  McapReader(McapReader&&) noexcept;
  McapReader& operator=(McapReader&&) noexcept;
  ~McapReader();

  std::optional<McapMessage> next();
  // Goes back to the beginning; what was counted is forgotten. Not of a pipe.
  bool can_rewind() const { return !file_ || size_bytes_.has_value(); }
  Result<void> rewind();
  // After the last message: success at the end of the file, else the read error.
  Result<void> ended() const;
  // False at the end of a file whose writer did not end it.
  bool was_finished() const { return was_finished_; }
  const Counters& counters() const { return counters_; }

 private:
  struct Channel {
    std::uint16_t schema = 0;
    std::string topic;
    std::string encoding;
  };
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct FreeContext {
    void operator()(ZSTD_DCtx_s* context) const;
  };

  McapReader();
  Result<void> begin(std::string name);
  std::optional<std::span<const std::uint8_t>> read(std::size_t bytes);
  bool skip(std::uint64_t bytes);
  std::uint64_t left_bytes() const;
  // The bytes at a place of the file, as many as there are up to `most`.
  std::span<const std::uint8_t> look_at(std::uint64_t at, std::size_t most);
  bool begins_records(std::uint64_t at);
  bool find_records(std::uint64_t from);
  // The next record's content and number, of the file or of the chunk that is being read.
  bool next_in_file();
  bool next_in_chunk();
  // The chunk's bytes; nullopt of one that cannot be unpacked.
  std::optional<std::span<const std::uint8_t>> unpack(std::string_view compression,
                                                      std::size_t size,
                                                      std::span<const std::uint8_t> packed);
  bool take(McapOp op, std::span<const std::uint8_t> content);  // true: message_ is one
  void open_chunk(std::span<const std::uint8_t> content);
  void take_schema(std::span<const std::uint8_t> content);
  void take_channel(std::span<const std::uint8_t> content);
  bool take_message(std::span<const std::uint8_t> content);

  std::string name_;
  std::unique_ptr<std::FILE, CloseFile> file_;  // null when reading memory
  std::span<const std::uint8_t> whole_;         // of a reader of memory
  std::span<const std::uint8_t> memory_;
  std::optional<std::uint64_t> size_bytes_;  // none of a pipe
  int tries_ = 0;                            // of searches behind damage, in the whole file
  std::uint64_t at_bytes_ = 0;               // where the next record is
  std::vector<std::uint8_t> buffer_;
  std::vector<std::uint8_t> window_;
  std::unique_ptr<ZSTD_DCtx_s, FreeContext> context_;
  std::unique_ptr<Lz4Unpacker> lz4_;  // for chunks of up to
  std::size_t lz4_bytes_ = 0;
  std::vector<std::uint8_t> unpacked_;
  std::span<const std::uint8_t> chunk_;  // what is left of the chunk that is being read
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  McapMessage message_;
  bool is_at_end_ = false;
  bool was_finished_ = false;
  int read_error_ = 0;  // errno
  Counters counters_;
};

}  // namespace dance
