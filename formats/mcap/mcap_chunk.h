// McapChunk: the messages of a chunk, compressed with zstd as they come, so that the work is spread
// over the messages, with their index.
//
// Units/frames: times in nanoseconds since 1970.
// Ownership:    holds the compressed bytes; after construction it allocates nothing.
// Threads:      none inside; one owner.
// Failure:      add() of a message that has no room is false, and changes nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

struct ZSTD_CCtx_s;

namespace dance {

class McapChunk {
 public:
  struct Entry {
    std::uint16_t channel;
    std::uint64_t log_ns;
    std::uint64_t offset;  // of the message in the chunk, before compression
  };

  explicit McapChunk(std::size_t most_bytes);
  ~McapChunk();
  McapChunk(McapChunk&&) noexcept;
  McapChunk& operator=(McapChunk&&) = delete;

  bool add(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_ns,
           std::uint64_t publish_ns, std::string_view data);
  // Ends the compression; afterwards the entries are in the order of their channels.
  void end();
  void clear();

  bool is_empty() const { return entries_.empty(); }
  std::span<const Entry> entries() const { return entries_; }
  std::span<const std::uint8_t> compressed() const { return {out_.data(), out_size_}; }
  std::uint64_t uncompressed_bytes() const { return uncompressed_bytes_; }
  std::uint32_t crc() const { return crc_; }
  std::uint64_t start_ns() const { return start_ns_; }
  std::uint64_t end_ns() const { return end_ns_; }

 private:
  void compress(std::span<const std::uint8_t> bytes, bool is_end);

  struct FreeContext {
    void operator()(ZSTD_CCtx_s* context) const;
  };
  std::unique_ptr<ZSTD_CCtx_s, FreeContext> context_;
  std::size_t most_bytes_;
  std::vector<std::uint8_t> out_;
  std::size_t out_size_ = 0;
  std::vector<Entry> entries_;
  std::uint64_t uncompressed_bytes_ = 0;
  std::uint32_t crc_ = 0;
  std::uint64_t start_ns_ = 0;
  std::uint64_t end_ns_ = 0;
};

}  // namespace dance
