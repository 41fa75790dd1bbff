// Which frames of one stream somebody has: the newest and the 63 before it.
//
// Units/frames: the low 16 bits of sequences, which wrap; streams as in
//               tunnel/session/stream_gate.h.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; what is older than the window is forgotten.
#pragma once

#include <cstdint>

namespace dance {

class FrameWindow {
 public:
  FrameWindow() = default;
  // `bits` as bits() gives them.
  FrameWindow(std::uint32_t stream, std::uint16_t newest, std::uint64_t bits)
      : stream_(stream), newest_(newest), bits_((bits & 1) != 0 ? bits : 0) {}

  void add(std::uint32_t stream, std::uint16_t sequence) {
    const auto ahead = static_cast<std::int16_t>(sequence - newest_);
    if (bits_ == 0 || stream != stream_ || ahead >= kSpan) {
      stream_ = stream;
      newest_ = sequence;
      bits_ = 1;
    } else if (ahead > 0) {
      bits_ = bits_ << ahead | 1;
      newest_ = sequence;
    } else if (ahead > -kSpan) {
      bits_ |= std::uint64_t{1} << -ahead;
    }
  }
  void clear() { bits_ = 0; }

  // Only what both have.
  void intersect(const FrameWindow& other) {
    const auto ahead = static_cast<std::int16_t>(newest_ - other.newest_);
    if (bits_ == 0 || other.bits_ == 0 || stream_ != other.stream_ || ahead >= kSpan ||
        ahead <= -kSpan) {
      bits_ = 0;
      return;
    }
    if (ahead >= 0) {
      bits_ = bits_ >> ahead & other.bits_;
      newest_ = other.newest_;
    } else {
      bits_ &= other.bits_ >> -ahead;
    }
    while (bits_ != 0 && (bits_ & 1) == 0) {
      bits_ >>= 1;
      --newest_;
    }
  }

  bool operator==(const FrameWindow&) const = default;

  bool is_of(std::uint32_t stream) const { return bits_ != 0 && stream_ == stream; }
  bool has(std::uint16_t sequence) const {
    const auto behind = static_cast<std::int16_t>(newest_ - sequence);
    return behind >= 0 && behind < kSpan && (bits_ >> behind & 1) != 0;
  }
  std::uint32_t stream() const { return stream_; }
  std::uint16_t newest() const { return newest_; }
  std::uint64_t bits() const { return bits_; }  // bit i: newest − i; bit 0 is set, or none is

 private:
  static constexpr int kSpan = 64;
  std::uint32_t stream_ = 0;
  std::uint16_t newest_ = 0;
  std::uint64_t bits_ = 0;
};

}  // namespace dance
