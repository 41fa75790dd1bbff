// Whether poses on a path go twice, once more with the next: while the path loses some. A pose that
// was lost is then there a frame later, which a stage that waits for stragglers still shows, and
// which the next pose may refer to. Where nothing is lost it would be bytes for nothing.
//
// Units/frames: losses are shares of datagrams, 0 to 1.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "tunnel/session/loss_meter.h"
#include "tunnel/wire/wire_records.h"

namespace dance {

class Repetition {
 public:
  void update(const LossMeter& path) {
    // A meter begins with an estimate: only what was seen counts.
    is_on_ = is_on_ ? path.loss() > kOffBelow : path.lost() >= kSeen && path.loss() > kOnAbove;
  }
  bool is_on() const { return is_on_; }
  // What is still lost with it: what goes together with the one after it.
  float residual(const LossMeter& path) const { return is_on_ ? path.in_a_row() : path.loss(); }

 private:
  static constexpr float kOnAbove = 0.005f;
  static constexpr float kOffBelow = 0.002f;
  static constexpr std::uint64_t kSeen = 3;

  bool is_on_ = false;
};

// The pose that went before, to go once more.
struct SentPose {
  wire::Record record;  // without its payload
  std::array<std::uint8_t, wire::kMaxPayload> payload;
  std::size_t size = 0;  // 0 = none

  void keep(const wire::Record& sent) {
    record = sent;
    record.payload = {};
    // How it travelled is told once.
    record.published_age_us = record.sent_age_us = record.server_age_us = wire::kNoAge;
    size = sent.payload.size();
    std::copy(sent.payload.begin(), sent.payload.end(), payload.begin());
  }
  wire::Record again() const {
    wire::Record repeat = record;
    repeat.payload = {payload.data(), size};
    return repeat;
  }
  // Whether it is the one just before, of the same stream.
  bool is_before(const wire::Record& next) const {
    return size > 0 && record.slot == next.slot && record.stream == next.stream &&
           record.sequence + 1 == next.sequence;
  }
};

}  // namespace dance
