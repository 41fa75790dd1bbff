#include "formats/recording/recording.h"

#include <algorithm>
#include <limits>

namespace dance {
namespace {

template <class T>
bool keep(std::vector<Recorded<T>>& list, std::size_t count, std::size_t limit,
          std::uint64_t& left_out, const T& value, std::int64_t time_us) {
  if (count >= limit) {
    ++left_out;
    return false;
  }
  list.push_back({time_us, value});
  return true;
}

// How far a guest's lists have been told.
struct Told {
  std::size_t skeletons = 0;
  std::size_t poses = 0;
  std::size_t hands = 0;
};

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

template <class T>
std::int64_t next_time(const std::vector<Recorded<T>>& list, std::size_t told) {
  return told < list.size() ? list[told].time_us : kNever;
}

}  // namespace

RecordedGuest* Recording::guest_of(const GuestId& guest) {
  const auto found = std::find_if(guests_.begin(), guests_.end(),
                                  [&](const RecordedGuest& each) { return each.guest == guest; });
  if (found != guests_.end()) return &*found;
  if (guests_.size() >= limits_.guests) {
    ++overflow_.guests;
    return nullptr;
  }
  guests_.push_back({guest, {}, {}, {}});
  return &guests_.back();
}

const RecordedGuest* Recording::find(const GuestId& guest) const {
  const auto found = std::find_if(guests_.begin(), guests_.end(),
                                  [&](const RecordedGuest& each) { return each.guest == guest; });
  return found == guests_.end() ? nullptr : &*found;
}

void Recording::on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t time_us) {
  RecordedGuest* of = guest_of(guest);
  if (of && (of->skeletons.empty() || !(of->skeletons.back().value == skeleton)))
    skeleton_count_ += keep(of->skeletons, skeleton_count_, limits_.skeletons, overflow_.skeletons,
                            skeleton, time_us);
}

void Recording::on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) {
  if (RecordedGuest* of = guest_of(guest))
    pose_count_ += keep(of->poses, pose_count_, limits_.poses, overflow_.poses, pose, time_us);
}

void Recording::on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) {
  if (RecordedGuest* of = guest_of(guest))
    hands_count_ += keep(of->hands, hands_count_, limits_.hands, overflow_.hands, hands, time_us);
}

void Recording::on_beat(const Beat& beat, std::int64_t time_us) {
  keep(beats_, beats_.size(), limits_.beats, overflow_.beats, beat, time_us);
}

void Recording::play_into(RecordingSink& sink) const {
  std::vector<Told> told(guests_.size());
  std::size_t told_beats = 0;
  for (;;) {
    std::int64_t next = next_time(beats_, told_beats);
    for (std::size_t g = 0; g < guests_.size(); ++g)
      next = std::min({next, next_time(guests_[g].skeletons, told[g].skeletons),
                       next_time(guests_[g].poses, told[g].poses),
                       next_time(guests_[g].hands, told[g].hands)});
    if (next == kNever) return;
    // One of each at a time: times may go back within a list, and what is due is told then.
    if (next_time(beats_, told_beats) <= next) sink.on_beat(beats_[told_beats++].value, next);
    for (std::size_t g = 0; g < guests_.size(); ++g) {
      const RecordedGuest& of = guests_[g];
      Told& at = told[g];
      if (next_time(of.skeletons, at.skeletons) <= next)
        sink.on_skeleton(of.guest, of.skeletons[at.skeletons++].value, next);
      if (next_time(of.poses, at.poses) <= next)
        sink.on_pose(of.guest, of.poses[at.poses++].value, next);
      if (next_time(of.hands, at.hands) <= next)
        sink.on_hands(of.guest, of.hands[at.hands++].value, next);
    }
  }
}

}  // namespace dance
