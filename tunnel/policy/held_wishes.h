// HeldWishes: what programs of one house want, as each says it once a second: the last wish of
// each, until it has been silent for kHolds.
//
// Units/frames: times of this house's clock.
// Ownership:    plain value; kMost programs.
// Threads:      none inside.
// Failure:      hear() is false where there is no place for one more program.
#pragma once

#include <cstddef>

#include "core/base/fixed_list.h"
#include "core/base/time.h"

namespace dance {

template <class Program, class Wish, std::size_t kMost>
class HeldWishes {
 public:
  // It is said once a second; a program that was silent so long has ended.
  static constexpr Duration kHolds = Duration::s(5);

  struct Said {
    Program program{};
    Wish wish{};
    MonoTime at;
  };

  bool hear(const Program& program, const Wish& wish, MonoTime now) {
    for (Said& known : said_) {
      if (known.program != program) continue;
      known = {program, wish, now};
      return true;
    }
    return said_.try_push({program, wish, now});
  }
  // Removes the wishes that hold no longer; true where there were any.
  bool expire(MonoTime now) {
    const std::size_t before = said_.size();
    for (std::size_t i = said_.size(); i-- > 0;)
      if (now - said_[i].at > kHolds) said_.erase_at(i);
    return said_.size() != before;
  }
  const FixedList<Said, kMost>& all() const { return said_; }

 private:
  FixedList<Said, kMost> said_;
};

}  // namespace dance
