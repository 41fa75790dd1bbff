#include "producers/receive/received_dancer.h"

#include "producers/first_sequence.h"

namespace dance {

void ReceivedDancer::set_skeleton(const Skeleton& skeleton) {
  if (!is_valid(skeleton)) {
    ++counters_.invalid;
    return;
  }
  Skeleton numbered = skeleton;
  numbered.version = wanted_.version;
  if (has_skeleton_ && numbered == wanted_) return;
  if (is_changed_) ++counters_.skeletons_left_out;
  wanted_ = numbered;
  has_skeleton_ = true;
  is_changed_ = true;
}

bool ReceivedDancer::capture(Pose& pose, MonoTime captured, MonoTime now) {
  if (!is_valid(pose)) {
    ++counters_.invalid;
    return false;
  }
  if (has_begun_ && captured <= newest_) {
    ++counters_.not_newer;
    return false;
  }
  if (!has_begun_) sequence_ = first_sequence(now);
  has_begun_ = true;
  newest_ = captured;
  normalize(pose);
  pose.sequence = sequence_++;
  pose.clock_id = clock_id_;
  pose.capture_time = captured;
  if (is_changed_ && now >= next_change_) {
    const std::uint32_t version = skeleton_.version + 1;
    skeleton_ = wanted_;
    skeleton_.version = version;
    is_changed_ = false;
    next_change_ = now + Duration::s(1);
    next_skeleton_ = MonoTime();
  }
  // Nobody can decode a dancer of unknown proportions: they go first.
  if (now >= next_skeleton_) {
    sink_.capture(guest_, TimedSkeleton{skeleton_, now, clock_id_});
    next_skeleton_ = now + Duration::s(1);
  }
  sink_.capture(guest_, pose, now);
  ++counters_.poses;
  return true;
}

bool ReceivedDancer::capture(Hands& hands) {
  if (!is_valid(hands)) {
    ++counters_.invalid;
    return false;
  }
  normalize(hands);
  hands.sequence = sequence_ - 1;
  hands.clock_id = clock_id_;
  hands.capture_time = newest_;
  sink_.capture(guest_, hands);
  return true;
}

}  // namespace dance
