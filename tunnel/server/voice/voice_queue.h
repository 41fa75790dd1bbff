// The voices that wait for one receiver: for the end of the turn, or, where its line is narrow, for
// their share of it. Bounded in number and in age, the oldest leaves first.
//
// Units/frames: MonoTime of the server's clock.
// Ownership:    owns a copy of the packets, of fixed size; never allocates.
// Threads:      none inside.
// Failure:      none; what left unsent is counted by the caller.
#pragma once

#include <array>
#include <cstring>

#include "core/base/assert.h"
#include "tunnel/wire/wire_voice.h"

namespace dance {

class VoiceQueue {
 public:
  // 60 ms of eight voices.
  static constexpr std::size_t kCapacity = 48;
  // A listener plays what comes later with a gap before it, or not at all.
  static constexpr Duration kLongestWait = Duration::ms(60);

  bool is_empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  // True where the oldest had to leave for it.
  bool push(const wire::VoiceRecord& record, MonoTime now) {
    const bool is_full = size_ == kCapacity;
    if (is_full) pop();
    Waiting& place = waiting_[(first_ + size_++) % kCapacity];
    DANCE_ASSERT(record.packet.size() <= place.bytes.size(), record.packet.size());
    place.record = record;
    place.since = now;
    std::memcpy(place.bytes.data(), record.packet.data(), record.packet.size());
    return is_full;
  }
  // The oldest; there must be one.
  wire::VoiceRecord front() const {
    DANCE_ASSERT(size_ > 0);
    const Waiting& oldest = waiting_[first_];
    wire::VoiceRecord record = oldest.record;
    record.packet = {oldest.bytes.data(), oldest.record.packet.size()};
    return record;
  }
  void pop() {
    DANCE_ASSERT(size_ > 0);
    first_ = (first_ + 1) % kCapacity;
    --size_;
  }
  // Drops what has waited for too long; how many.
  std::size_t drop_late(MonoTime now) {
    std::size_t dropped = 0;
    for (; size_ > 0 && now - waiting_[first_].since > kLongestWait; ++dropped) pop();
    return dropped;
  }

 private:
  struct Waiting {
    wire::VoiceRecord record;  // its packet's size counts, not where it was
    MonoTime since;
    std::array<std::uint8_t, kMaxVoiceBytes> bytes;
  };
  std::array<Waiting, kCapacity> waiting_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace dance
