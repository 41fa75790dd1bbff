// DancerMusic: where the dancer's own music stood at each moment of the dance, from the tags of the
// poses: the sender's half of musical time.
//
// Units/frames: times are capture times of one clock; positions in beats of the dancer's music.
// Ownership:    keeps the last 1024 tags (17 s at 60 Hz); no heap.
// Threads:      none inside; one owner.
// Failure:      a tag that does not fit the line by more than half a beat is another place of the
//               music: the line begins anew with it, and add() says so. A moment between is_known()
//               and the oldest tag is extrapolated.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/time.h"

namespace dance {

class DancerMusic {
 public:
  // Returns true where the music jumped. Tags that are not newer than what is there are ignored.
  bool add(MonoTime t, double beats);
  void clear() { count_ = 0; }

  // From half a second of tags on, as long as the last is not older than 10 s: a dancer stays in
  // time through a lapse.
  bool is_known(MonoTime t) const;
  double position(MonoTime t) const;
  MonoTime time_of(double beats) const;
  double beats_per_second() const { return beats_per_second_; }

 private:
  struct Tag {
    MonoTime time;
    double beats = 0.0;
  };
  static constexpr std::size_t kTags = 1024;

  std::size_t size() const { return count_ < kTags ? count_ : kTags; }
  // Counted from the oldest.
  const Tag& tag(std::size_t i) const { return tags_[(count_ - size() + i) % kTags]; }
  const Tag& newest() const { return tag(size() - 1); }
  void fit();

  std::array<Tag, kTags> tags_{};
  std::size_t count_ = 0;
  double beats_per_second_ = 0.0;  // of the last two seconds, for what lies beyond the newest tag
};

}  // namespace dance
