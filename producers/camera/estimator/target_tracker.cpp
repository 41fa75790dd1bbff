#include "producers/camera/estimator/target_tracker.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// In sides of the region, which are about one and a half times a body's height: how far the middle
// of the hips may be from where it is expected, at once and for each second since the last picture.
// Twice what the fastest dancers reach.
constexpr float kJump_sides = 0.15f;
constexpr float kJump_sides_per_s = 2.0f;
constexpr float kGrowth = 1.5f;
// Just after a loss a person farther away than this is not the target.
constexpr Duration kShort = Duration::ms(500);
constexpr float kNear_sides = 0.6f;
constexpr float kTargetSpeedWeight = 0.3f;

float dissimilarity(const BodyRegion& was, const BodyRegion& is) {
  return (centre_of(is) - centre_of(was)).norm() / was.side_px +
         std::abs(std::log(is.side_px / was.side_px));
}

}  // namespace

const SeenPerson* TargetTracker::choose(std::span<const SeenPerson> people, MonoTime now,
                                        const FollowOptions& options) const {
  if (people.empty()) return nullptr;
  const auto best = [&](const auto& cost) {
    return &*std::min_element(
        people.begin(), people.end(),
        [&](const SeenPerson& a, const SeenPerson& b) { return cost(a.region) < cost(b.region); });
  };
  if (last_ && now - last_time_ < options.reacquire_time) {
    const SeenPerson* person =
        best([&](const BodyRegion& region) { return dissimilarity(*last_, region); });
    const bool is_near = dissimilarity(*last_, person->region) < kNear_sides;
    return is_near || now - last_time_ > kShort ? person : nullptr;
  }
  switch (options.choice) {
    case FollowOptions::Choice::kLargest:
      return best([](const BodyRegion& region) { return -region.side_px; });
    case FollowOptions::Choice::kNearest:
      return best(
          [&](const BodyRegion& region) { return (centre_of(region) - options.place_px).norm(); });
    case FollowOptions::Choice::kSurest:
      break;
  }
  return &people.front();
}

bool TargetTracker::is_plausible(const BodyRegion& region, MonoTime now) const {
  if (!last_) return true;
  const float passed_s = static_cast<float>((now - last_time_).as_seconds());
  const Eigen::Vector2f expected = centre_of(*last_) + passed_s * speed_px_s_;
  const float allowed = kJump_sides + kJump_sides_per_s * passed_s;
  const float growth = region.side_px / last_->side_px;
  return (centre_of(region) - expected).norm() <= allowed * last_->side_px &&
         growth <= kGrowth * (1.0f + passed_s) && growth * kGrowth * (1.0f + passed_s) >= 1.0f;
}

void TargetTracker::update(const BodyRegion& region, MonoTime now) {
  if (last_ && now > last_time_) {
    const float passed_s = static_cast<float>((now - last_time_).as_seconds());
    const Eigen::Vector2f speed = (centre_of(region) - centre_of(*last_)) / passed_s;
    speed_px_s_ += kTargetSpeedWeight * (speed - speed_px_s_);
  }
  last_ = region;
  last_time_ = now;
}

}  // namespace dance
