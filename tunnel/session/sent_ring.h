// What the last 256 datagrams to one receiver carried, so that an acknowledgement of a datagram
// says which frames the receiver has; and what share of those with records was never acknowledged.
//
// Units/frames: datagram numbers are 16 bit and wrap.
// Ownership:    plain value of fixed size; never allocates.
// Threads:      none inside.
// Failure:      acknowledgements of what was never sent, or long ago, do nothing; acknowledge() is
//               false for them.
#pragma once

#include <array>
#include <cstdint>

#include "tunnel/session/loss_meter.h"
#include "tunnel/wire/wire_records.h"

namespace dance {

class SentRing {
 public:
  struct Frame {
    std::uint32_t stream;
    std::uint16_t sequence;
    std::uint8_t slot;
  };

  // A frame of the datagram that is being filled.
  void add(const Frame& frame) {
    frames_[next_frame_ % kFrames] = frame;
    ++next_frame_;
  }
  // The datagram leaves: its number. One without records is not answered, and so tells of no loss.
  std::uint16_t commit(bool has_records) {
    Datagram& datagram = datagrams_[next_ % kDatagrams];
    datagram = {first_frame_, next_frame_, next_, false, true, has_records};
    first_frame_ = next_frame_;
    if (static_cast<std::uint16_t>(next_ - settled_) >= kDatagrams) ++settled_;
    return next_++;
  }

  template <class OnFrame>
  bool acknowledge(const wire::Acks& acks, OnFrame on_frame) {
    // Ahead of what was sent, or older than the ring.
    if (static_cast<std::uint16_t>(next_ - 1 - acks.newest) >= kDatagrams - wire::kAckSpan)
      return false;
    if (!datagrams_[acks.newest % kDatagrams].is_used) return false;
    for (std::uint8_t back = 0; back < wire::kAckSpan; ++back) {
      if (back > 0 && (acks.before >> (back - 1) & 1) == 0) continue;
      const auto number = static_cast<std::uint16_t>(acks.newest - back);
      Datagram& datagram = datagrams_[number % kDatagrams];
      if (!datagram.is_used || datagram.number != number || datagram.is_acked) continue;
      datagram.is_acked = true;
      ++acked_;
      if (next_frame_ - datagram.first > kFrames) continue;  // overwritten
      for (std::uint32_t i = datagram.first; i != datagram.end; ++i) {
        const Frame& frame = frames_[i % kFrames];
        if (!is_excepted(acks, back, frame.slot)) on_frame(frame);
      }
    }
    while (static_cast<std::int16_t>(acks.newest - (wire::kAckSpan - 1) - settled_) > 0) {
      const Datagram& datagram = datagrams_[settled_ % kDatagrams];
      if (datagram.has_records) loss_.add(!datagram.is_acked);
      ++settled_;
    }
    return true;
  }

  const LossMeter& loss() const { return loss_; }
  std::uint64_t acked() const { return acked_; }

 private:
  static constexpr std::uint16_t kDatagrams = 256;
  static constexpr std::uint32_t kFrames = 2048;  // over a second of thirty dancers

  struct Datagram {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
    std::uint16_t number = 0;
    bool is_acked = false;
    bool is_used = false;
    bool has_records = false;
  };

  static bool is_excepted(const wire::Acks& acks, std::uint8_t back, std::uint8_t slot) {
    for (const wire::AckExcept& except : acks.excepts)
      if (except.back == back && except.slot == slot) return true;
    return false;
  }

  std::array<Frame, kFrames> frames_{};
  std::array<Datagram, kDatagrams> datagrams_{};
  std::uint32_t first_frame_ = 0;
  std::uint32_t next_frame_ = 0;
  std::uint16_t next_ = 0;
  std::uint16_t settled_ = 0;  // older ones are counted as come or lost
  std::uint64_t acked_ = 0;
  LossMeter loss_;
};

}  // namespace dance
