// ChunkRequests: which chunks of one file have been asked for and have not come, at most kMost: the
// window of a transfer.
//
// Units/frames: MonoTime of one clock.
// Ownership:    plain value of fixed size.
// Threads:      none inside.
// Failure:      add() is false where the window is full.
#pragma once

#include "core/base/fixed_list.h"
#include "core/base/time.h"

namespace dance {

class ChunkRequests {
 public:
  static constexpr std::size_t kMost = 64;

  bool is_full() const { return asked_.is_full(); }
  std::size_t free() const { return kMost - asked_.size(); }
  bool is_empty() const { return asked_.empty(); }
  bool has(std::size_t index) const { return find(index) < asked_.size(); }
  bool add(std::size_t index, MonoTime now) {
    return asked_.try_push({static_cast<std::uint16_t>(index), now});
  }
  // When it was asked for; MonoTime() = it was not.
  MonoTime take(std::size_t index) {
    const std::size_t i = find(index);
    if (i == asked_.size()) return MonoTime();
    const MonoTime at = asked_[i].at;
    asked_.erase_at(i);
    return at;
  }
  // Forgets what was asked for before then; the number.
  std::size_t expire(MonoTime before) {
    std::size_t expired = 0;
    for (std::size_t i = asked_.size(); i-- > 0;) {
      if (asked_[i].at >= before) continue;
      asked_.erase_at(i);
      ++expired;
    }
    return expired;
  }
  MonoTime oldest() const {
    MonoTime oldest;
    for (const Asked& it : asked_)
      if (!oldest.is_set() || it.at < oldest) oldest = it.at;
    return oldest;
  }
  void clear() { asked_.clear(); }

 private:
  struct Asked {
    std::uint16_t index = 0;
    MonoTime at;
  };
  std::size_t find(std::size_t index) const {
    std::size_t i = 0;
    while (i < asked_.size() && asked_[i].index != index) ++i;
    return i;
  }

  FixedList<Asked, kMost> asked_;
};

}  // namespace dance
