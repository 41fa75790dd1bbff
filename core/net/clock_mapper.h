// Maps another clock's stamps onto ours and back: the offset between the two, estimated from
// ping/pong round trips. Delay only ever adds to a round trip, so the shortest of the last ones
// tell the offset best; an older one counts as less certain by what the clocks may have drifted
// since. The applied offset follows the estimate slowly, so that mapped times do not jump.
//
// Units/frames: theirs are plain microseconds of their clock; ours is MonoTime. offset = theirs −
//               ours. What is left is half the difference between the two directions' shortest
//               delays, which no exchange of times can see.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      add() refuses (false) a sample that cannot be (negative round trip, over a minute);
//               steps() counts jumps after a clock was set or a host slept.
// Source:       minimum filter as in RFC 5905 (NTP), clock filter algorithm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

class ClockMapper {
 public:
  struct Sample {
    MonoTime sent;                  // ours, when the ping left
    std::int64_t their_receive_us;  // theirs, when it came in
    std::int64_t their_send_us;     // theirs, when the pong left
    MonoTime received;              // ours, when the pong came in
  };

  bool add(const Sample& sample);
  void reset() { *this = ClockMapper(); }

  bool is_mapped() const { return count_ > 0; }
  // Before the first sample the offset is 0.
  MonoTime to_ours(std::int64_t their_us) const {
    return MonoTime::from_ns(their_us * 1000 - offset_ns_);
  }
  std::int64_t to_theirs_us(MonoTime ours) const {
    const std::int64_t ns = ours.since_zero_ns() + offset_ns_;
    return ns >= 0 ? (ns + 500) / 1000 : -((-ns + 500) / 1000);
  }
  Duration offset() const { return Duration::ns(offset_ns_); }
  Duration newest_round_trip() const { return Duration::ns(newest_round_trip_ns_); }
  Duration shortest_round_trip() const;
  std::uint64_t steps() const { return steps_; }

 private:
  static constexpr std::size_t kWindow = 64;  // 13 s at five pings a second
  struct Estimate {
    std::int64_t offset_ns = 0;
    std::int64_t round_trip_ns = 0;
    std::int64_t at_ns = 0;  // ours
  };
  const Estimate& best(std::int64_t now_ns) const;
  bool contradicts(const Estimate& fresh) const;
  void follow(std::int64_t target_ns, std::int64_t now_ns);

  std::array<Estimate, kWindow> ring_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::int64_t offset_ns_ = 0;
  std::int64_t followed_at_ns_ = 0;
  std::int64_t newest_round_trip_ns_ = 0;
  std::int64_t settled_at_ns_ = 0;
  int contradictions_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace dance
