#include "viewer/practice/step_score_board.h"

namespace dance {
namespace {
constexpr Duration kHolds = Duration::s(3);
constexpr Duration kKept = Duration::s(10);
}  // namespace

std::optional<std::size_t> StepScoreBoard::place_of(const GuestId& guest, MonoTime now) {
  std::optional<std::size_t> spare;
  for (std::size_t i = 0; i < kMostDancers; ++i) {
    if (all_[i].guest == guest) return i;
    const bool is_spare = !all_[i].guest.is_set() || now - all_[i].heard > kKept;
    if (is_spare && !spare) spare = i;
  }
  if (!spare) return std::nullopt;
  scores_[*spare] = StepScore();
  all_[*spare] = {guest, now, {}};
  return spare;
}

void StepScoreBoard::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  if (const auto place = place_of(guest, now)) scores_[*place].set_body(skeleton);
}

void StepScoreBoard::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  if (pose.clock_id != clock_id_) return;
  const auto place = place_of(guest, now);
  if (!place) return;
  scores_[*place].add(pose, music_);
  all_[*place].heard = now;
  all_[*place].figures = scores_[*place].figures();
  latest_.put(all_);
}

std::optional<StepScoreBoard::Of> StepScoreBoard::find(const std::optional<GuestId>& guest,
                                                       MonoTime now) {
  if (const All* news = latest_.take()) shown_ = *news;
  std::optional<Of> found;
  for (const Of& it : shown_) {
    if (!it.guest.is_set() || now - it.heard >= kHolds) continue;
    if (guest ? it.guest == *guest : !found || it.guest < found->guest) found = it;
  }
  return found;
}

}  // namespace dance
