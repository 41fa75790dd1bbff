// The records of an MCAP file: their numbers, and a builder of their bytes.
//
// Units/frames: little-endian; times in nanoseconds since 1970.
// Ownership:    a McapRecord holds its bytes, and reuses their memory.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       MCAP specification (mcap.dev/spec), version 0.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace dance {

constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kMcapRecordHead_bytes = 9;  // the number, and the content's length

enum class McapOp : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

class McapRecord {
 public:
  void clear() { bytes_.clear(); }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  std::span<const std::uint8_t> bytes() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }

  // Several records may follow each other.
  void begin(McapOp op) {
    u8(static_cast<std::uint8_t>(op));
    begin_ = bytes_.size();
    u64(0);
  }
  // `more_bytes` of the content are kept elsewhere and follow.
  void end(std::size_t more_bytes = 0) { put_length<8>(begin_, more_bytes); }

  void u8(std::uint8_t v) { bytes_.push_back(v); }
  void u16(std::uint16_t v) { put<2>(v); }
  void u32(std::uint32_t v) { put<4>(v); }
  void u64(std::uint64_t v) { put<8>(v); }
  void text(std::string_view t) {
    u32(static_cast<std::uint32_t>(t.size()));
    bytes_.insert(bytes_.end(), t.begin(), t.end());
  }
  // An array or a map: its size in bytes stands before it.
  std::size_t begin_list() {
    u32(0);
    return bytes_.size() - 4;
  }
  void end_list(std::size_t list) { put_length<4>(list, 0); }

 private:
  template <std::size_t kBytes>
  void put(std::uint64_t v) {
    for (std::size_t i = 0; i < kBytes; ++i)
      bytes_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  template <std::size_t kBytes>
  void put_length(std::size_t at, std::size_t more_bytes) {
    const std::uint64_t length = bytes_.size() - at - kBytes + more_bytes;
    for (std::size_t i = 0; i < kBytes; ++i)
      bytes_[at + i] = static_cast<std::uint8_t>(length >> (8 * i));
  }

  std::vector<std::uint8_t> bytes_;
  std::size_t begin_ = 0;
};

}  // namespace dance
