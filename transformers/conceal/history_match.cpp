#include "transformers/conceal/history_match.h"

#include <algorithm>
#include <cmath>

#include "core/pose/heading.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr Duration kGrid = Duration::us(33'333);
// What is interpolated across more than that was not danced.
constexpr Duration kGap = Duration::ms(120);
// So much must have followed without a gap, and so much without a break: it will be shown.
constexpr std::size_t kRowsAfter = 15;
constexpr std::size_t kRowsUnbroken = 120;
constexpr double kStandingPart = 0.1;
// Faster than the large bones of a dancer turn: a sensor that lost its hold.
constexpr float kBroken_rad_s = 25.0f;
constexpr std::array<Bone, 8> kLarge{Bone::kHips,          Bone::kSpine,        Bone::kLeftUpperArm,
                                     Bone::kRightUpperArm, Bone::kLeftUpperLeg, Bone::kLeftLowerLeg,
                                     Bone::kRightUpperLeg, Bone::kRightLowerLeg};

constexpr std::array<Bone, 10> kMatched{
    Bone::kHead,      Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kRightLowerArm,
    Bone::kRightHand, Bone::kLeftLowerLeg, Bone::kLeftFoot, Bone::kRightLowerLeg,
    Bone::kRightFoot, Bone::kUpperChest};

bool is_broken(const Pose& before, const Pose& after) {
  const auto seconds = static_cast<float>((after.capture_time - before.capture_time).as_seconds());
  const float most_rad = kBroken_rad_s * seconds;
  if (most_rad > 2.0f) return false;  // a gap: anything may have happened
  // sin²(angle / 2) of the turn between them.
  const float most = std::sin(0.5f * most_rad) * std::sin(0.5f * most_rad);
  for (const Bone bone : kLarge) {
    const float dot = before.R_PB[index_of(bone)].dot(after.R_PB[index_of(bone)]);
    if (1.0f - dot * dot > most) return true;
  }
  return false;
}

}  // namespace

void HistoryMatch::measure(const Skeleton& skeleton, const Pose& pose, std::size_t at) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  const float heading = heading_rad(pose.R_PB[0]), c = std::cos(heading), s = std::sin(heading);
  Row& row = rows_[at];
  row.setZero();
  for (std::size_t j = 0; j < kJoints; ++j) {
    const Vector3f p = frames.position(kMatched[j]) - frames.p_WB_m[0];
    const auto column = static_cast<Eigen::Index>(3 * j);
    row[column] = c * p.x() - s * p.z();
    row[column + 1] = p.y();
    row[column + 2] = s * p.x() + c * p.z();
  }
  low_m_[at] =
      std::min(frames.position(Bone::kLeftToes).y(), frames.position(Bone::kRightToes).y());
  times_[at] = pose.capture_time;
}

void HistoryMatch::look(const PoseHistory& history, const Skeleton& skeleton) {
  size_ = 0;
  if (history.empty()) return;
  const MonoTime newest = history.newest().capture_time;
  std::size_t back = 0;
  for (std::size_t k = 0; k < kMost; ++k) {
    const MonoTime wanted = newest - kGrid * static_cast<std::int64_t>(k);
    if (newest - wanted > kLookBack) break;
    // The pose nearest to the moment.
    const auto distance = [&](std::size_t i) {
      const Duration d = history.newest(i).capture_time - wanted;
      return d < Duration() ? -d : d;
    };
    bool is_broken_here = false;
    while (back + 1 < history.size() && distance(back + 1) <= distance(back)) {
      is_broken_here = is_broken_here || is_broken(history.newest(back + 1), history.newest(back));
      ++back;
    }
    if (distance(back) > kGrid && back + 1 == history.size()) break;
    measure(skeleton, history.newest(back), size_);
    after_a_gap_[size_] = distance(back) > kGap / 2;
    is_broken_[size_] = is_broken_here;
    ++size_;
  }
  find_distances();
  find_floor();
}

void HistoryMatch::find_distances() {
  // Rows after it in time without.
  std::size_t since_gap = 0, since_break = kRowsUnbroken;
  std::array<bool, kMost> is_clear{};
  for (std::size_t k = 0; k < size_; ++k) {
    since_gap = after_a_gap_[k] ? 0 : since_gap + 1;
    since_break = is_broken_[k] ? 0 : since_break + 1;
    is_clear[k] = since_gap > kRowsAfter + kWindowRows && since_break > kRowsUnbroken + kWindowRows;
  }
  distance_.fill(-1.0f);
  for (std::size_t k = 1; k + kWindowRows < size_; ++k) {
    if (!is_clear[k + kWindowRows - 1]) continue;
    Row sum = Row::Zero();
    for (std::size_t i = 0; i < kWindowRows; ++i) sum += (rows_[i] - rows_[k + i]).square();
    distance_[k] = sum.sum() / static_cast<float>(kWindowRows * kJoints);
  }
}

void HistoryMatch::find_floor() {
  floor_m_ = 0.0f;
  if (size_ == 0) return;
  std::array<float, kMost> sorted;
  std::copy_n(low_m_.begin(), size_, sorted.begin());
  const auto at = static_cast<std::ptrdiff_t>(kStandingPart * static_cast<double>(size_ - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at,
                   sorted.begin() + static_cast<std::ptrdiff_t>(size_));
  floor_m_ = sorted[static_cast<std::size_t>(at)];
}

std::optional<HistoryMatch::Match> HistoryMatch::best(Duration least, Duration most) const {
  std::optional<Match> best;
  for (std::size_t k = 1; k < size_; ++k) {
    const Duration lag = times_[0] - times_[k];
    if (distance_[k] < 0.0f || lag < least || lag > most) continue;
    if (!best || distance_[k] < best->distance) best = Match{lag, distance_[k]};
  }
  return best;
}

}  // namespace dance
