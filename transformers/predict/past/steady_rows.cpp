#include "transformers/predict/past/steady_rows.h"

#include <algorithm>

namespace dance {
namespace {

constexpr Duration kRowPeriod = Duration::ns(16'666'667);
// A pose so little before its row's time is the row.
constexpr Duration kAsGoodAs = Duration::ms(1);
// How the rows' times follow the poses' where the rates are alike.
constexpr Duration kFollowed = Duration::ms(6);
constexpr std::int64_t kFollowOneIn = 16;
constexpr float kTrembleKeep = 1.0f - 1.0f / 120.0f;  // 2 s
// More than this at once and a second, no bone turns; a bone that is seen there for so long is
// there.
constexpr float kSuddenTurn_rad = 0.4f;
constexpr float kSwiftestTurn_rad_s = 40.0f;
constexpr Duration kLongestLost = Duration::ms(70);
// The third difference of white noise has 20 times its variance.
constexpr float kThirdOfWhite = 20.0f;

}  // namespace

SteadyRows::Heard SteadyRows::observe(const Pose& pose) {
  const MonoTime capture = pose.capture_time;
  const bool restarts = is_empty_ || pose.clock_id != clock_id_ ||
                        capture > seen_time_ + kLongestGap || capture < seen_time_ - kLongestGap;
  if (restarts) {
    clock_id_ = pose.clock_id;
    seen_ = before_ = space_.row_of(pose, nullptr);
    seen_time_ = before_time_ = due_time_ = capture;
    row_time_ = capture;
    looked_count_ = 0;
    accepted_ = pose.R_PB;
    for (std::size_t b = 0; b < kBoneCount; ++b)
      lost_[b] = (pose.presence >> b & 1u) != 0 ? Duration() : kLongestLost;
    const Heard heard = Heard::kRestarted;
    is_empty_ = false;
    return heard;
  }
  if (capture <= seen_time_) return Heard::kRefused;
  before_ = seen_;
  before_time_ = seen_time_;
  Pose held = pose;
  hold_lost_bones(capture - before_time_, held);
  seen_ = space_.row_of(held, &before_);
  seen_time_ = capture;
  follow_source(capture);
  return Heard::kTaken;
}

// A bone that turns impossibly fast is an outlier: it stays until it comes back, or has stayed
// there. Soon after that, or after it was not seen at all, it may be anywhere.
void SteadyRows::hold_lost_bones(Duration step, Pose& pose) {
  const float most_rad =
      std::min(3.0f, kSuddenTurn_rad + kSwiftestTurn_rad_s * static_cast<float>(step.as_seconds()));
  const float least_cosine = std::cos(0.5f * most_rad);
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    if ((pose.presence >> b & 1u) == 0) {
      lost_[b] = kLongestLost;
      continue;
    }
    if (std::abs(pose.R_PB[b].dot(accepted_[b])) >= least_cosine) {
      lost_[b] = std::max(Duration(), lost_[b] - step / 8);
      accepted_[b] = pose.R_PB[b];
      continue;
    }
    lost_[b] += step;
    if (lost_[b] > kLongestLost) {
      lost_[b] = kLongestLost;
      accepted_[b] = pose.R_PB[b];
    } else {
      pose.R_PB[b] = accepted_[b];
      ++held_;
    }
  }
}

double SteadyRows::rows_until(MonoTime capture) const {
  if (is_empty_ || capture <= seen_time_ || capture > seen_time_ + kLongestGap) return 1.0;
  return static_cast<double>((capture - seen_time_).count_ns()) /
         static_cast<double>(kRowPeriod.count_ns());
}

void SteadyRows::follow_source(MonoTime capture) {
  const Duration late = capture - due_time_;
  if (late < kFollowed && late > -kFollowed) due_time_ += late / kFollowOneIn;
}

bool SteadyRows::next(BodyRow& row) {
  if (due_time_ > seen_time_ + kAsGoodAs) return false;
  const Duration step = seen_time_ - before_time_;
  const Duration into = due_time_ - before_time_;
  const float fraction =
      step > Duration()
          ? std::clamp(static_cast<float>(into.as_seconds() / step.as_seconds()), 0.0f, 1.0f)
          : 1.0f;
  for (std::size_t i = 0; i < kRowSize; ++i)
    row.v[i] = before_.v[i] + fraction * (seen_.v[i] - before_.v[i]);
  row_time_ = due_time_;
  due_time_ += kRowPeriod;
  note_tremble(row);
  return true;
}

void SteadyRows::note_tremble(const BodyRow& row) {
  if (looked_count_ == kLooked - 1) {
    std::size_t n = 0;
    std::array<float, kBoneNumbers> moving;
    std::size_t moving_count = 0;
    for (std::size_t b = 0; b < kBoneCount; ++b)
      for (std::size_t axis = 0; axis < 3; ++axis, ++n) {
        const std::size_t i = BodyRow::at(b, axis);
        const float third =
            row.v[i] - 3.0f * looked_[0].v[i] + 3.0f * looked_[1].v[i] - looked_[2].v[i];
        float& mean = third_differences_[n];
        mean = kTrembleKeep * mean + (1.0f - kTrembleKeep) * third * third;
        if (mean > 1e-14f) moving[moving_count++] = mean;
      }
    // Half of the numbers belong to bones that are slow: theirs is the sensor's.
    if (++rows_ % 16 == 0 && moving_count > 0) {
      const auto middle = moving.begin() + static_cast<std::ptrdiff_t>(moving_count / 2);
      std::nth_element(moving.begin(), middle,
                       moving.begin() + static_cast<std::ptrdiff_t>(moving_count));
      // Until it has heard for as long as it looks back, the mean is short of what it will be.
      const float heard = 1.0f - std::pow(kTrembleKeep, static_cast<float>(rows_));
      tremble_rad_ = std::sqrt(*middle / (kThirdOfWhite * heard));
    }
  }
  for (std::size_t i = kLooked - 1; i > 0; --i) looked_[i] = looked_[i - 1];
  looked_[0] = row;
  looked_count_ = std::min(looked_count_ + 1, kLooked - 1);
}

}  // namespace dance
