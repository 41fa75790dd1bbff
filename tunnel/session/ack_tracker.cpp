#include "tunnel/session/ack_tracker.h"

#include "core/base/assert.h"

namespace dance {

bool AckTracker::note_except(std::uint16_t number, const Slots& failed) {
  for (std::size_t i = excepts_.size(); i-- > 0;)
    if (!window_.covers(excepts_[i].number)) excepts_.erase_at(i);
  if (failed.size() > wire::kMaxAckExcepts) return false;
  if (failed.size() > wire::kMaxAckExcepts - excepts_.size()) {
    // Somebody fails in each datagram: the others' acknowledgements must go on.
    excepts_.clear();
    window_.forget();
  }
  for (const std::uint8_t slot : failed) {
    const bool pushed = excepts_.try_push({number, slot});
    DANCE_ASSERT(pushed);
  }
  window_.note(number);
  return true;
}

void AckTracker::owe(MonoTime due, bool is_clean, MonoTime now) {
  if (++untold_ >= (is_clean ? kMostUntoldOnClean : kMostUntold))
    due_ = now;
  else if (!due_.is_set())
    due_ = due;
}

bool AckTracker::want_intra_frame(std::uint8_t slot, MonoTime now) {
  if (!wants_.try_push(slot)) return false;
  due_ = now;
  return true;
}

bool AckTracker::is_ripe(MonoTime now, bool is_clean) const {
  return due_.is_set() &&
         (now >= due_ || !is_clean || now - told_at_ >= kCleanGap || untold_ >= kMostUntold);
}

void AckTracker::fill(wire::RecordsHeader& header) const {
  header.has_acks = window_.has_any();
  if (!header.has_acks) return;
  header.acks.newest = window_.newest();
  header.acks.before = window_.before();
  for (const Except& except : excepts_) {
    if (!window_.covers(except.number)) continue;
    const auto back = static_cast<std::uint8_t>(window_.newest() - except.number);
    const bool pushed = header.acks.excepts.try_push({back, except.slot});
    DANCE_ASSERT(pushed);
  }
}

void AckTracker::tell(wire::RecordsHeader& header, MonoTime now) {
  fill(header);
  header.wants = wants_;
  wants_.clear();
  due_ = MonoTime();
  told_at_ = now;
  untold_ = 0;
}

}  // namespace dance
