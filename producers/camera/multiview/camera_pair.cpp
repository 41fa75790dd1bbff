#include "producers/camera/multiview/camera_pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "producers/camera/multiview/view_alignment.h"

namespace dance {
namespace {

// By how much the stamps may differ; where a search starts.
constexpr double kStartsApart_s = 0.05;
constexpr double kMostLater_s = 0.25;
constexpr int kHeldIterations = 4, kFreeIterations = 6, kLastIterations = 12;
// What a placement has to be.
constexpr double kMostTurnSd_rad = 0.055, kMostLaterSd_s = 0.006, kMostSpread = 6.0;
constexpr double kLeastMet = 0.85;
constexpr double kLeastAngle_rad = 0.1, kLeastBaseline_m = 0.15, kMostBaseline_m = 25.0;
// A search that found nothing is repeated after so many further moments.
constexpr std::uint64_t kPatience = 12;
// While it is followed: an iteration, or some moments' lengths, in one of so many calls.
constexpr std::uint32_t kFollowEvery = 4;
constexpr int kMomentsInCall = 12;
// Of a search: moments times iterations in one call.
constexpr int kMomentStepsInCall = 240, kMostSteps = 4;
constexpr int kLengthMoments = 60;
// A camera was moved where rays miss each other by so much more than they did.
constexpr double kMovedTimes = 2.5, kMovedSpread = 4.0;
constexpr double kRecentOver = 8.0, kUsualOver = 60.0;
constexpr Duration kKept = Duration::s(33);
constexpr Duration kOverlap = Duration::ms(300);

}  // namespace

void CameraPair::see_other(const ViewPoints& points) { other_.add(points); }

void CameraPair::see_first(const ViewPoints& points, const DancerSize& size) {
  now_ = points.time;
  const ViewPoints* newest = other_.newest();
  if (points.distance_m > 0.0f && newest && points.time - newest->time < kOverlap &&
      newest->time - points.time < kOverlap)
    moments_.add(points);
  moments_.drop_before(points.time - kKept);
  ++calls_;
  if (placement_) {
    check_moments();
    if (placement_) follow(size);
  } else if (is_measuring_) {
    if (lengths_.step(moments_, other_, kMomentsInCall)) finish_lengths(size);
  } else {
    // An iteration costs as much as it has moments.
    const int steps = std::clamp(kMomentStepsInCall / std::max(1, moments()), 1, kMostSteps);
    for (int i = 0; i < steps && !is_measuring_; ++i) search();
  }
}

void CameraPair::search() {
  if (!is_searching_) {
    if (moments_.added() < search_from_ || moments_.count() < kFewestMoments) return;
    is_searching_ = true;
    start_ = 0;
    has_start_ = false;
    best_ = Candidate();
  }
  if (!has_start_) return begin_start();
  const bool is_last = start_ >= kStarts;
  const bool is_stepped = fit_.step(moments_, other_, is_last || iteration_ >= kHeldIterations);
  ++iteration_;
  if (is_last) {
    if (!is_stepped || iteration_ >= kLastIterations) accept_or_wait();
    return;
  }
  if (is_stepped && iteration_ < kHeldIterations + kFreeIterations) return;
  if (is_stepped && fit_.cost() < best_.cost) best_ = {fit_.pose(), fit_.cost()};
  ++start_;
  has_start_ = false;
}

void CameraPair::begin_start() {
  has_start_ = true;
  iteration_ = 0;
  RelativePose pose;
  if (start_ < kStarts) {
    // 0, −50, 50, −100 … ms
    const int half = (start_ + 1) / 2;
    pose.later_s = kStartsApart_s * (start_ % 2 ? -half : half);
    if (!align_views(moments_, other_, pose)) {
      ++start_;
      has_start_ = false;
      return;
    }
  } else {
    if (best_.cost >= 1e9) return accept_or_wait();
    pose = best_.pose;
  }
  fit_.begin(pose);
}

bool CameraPair::is_good() const {
  return fit_.spread() < kMostSpread && fit_.turn_sd_rad() < kMostTurnSd_rad &&
         fit_.later_sd_s() < kMostLaterSd_s && std::abs(fit_.pose().later_s) < kMostLater_s &&
         fit_.moments() >= kFewestMoments / 2;
}

void CameraPair::accept_or_wait() {
  is_searching_ = false;
  if (best_.cost < 1e9 && is_good()) {
    lengths_.begin(fit_.pose(), moments_);
    is_measuring_ = true;
    return;
  }
  search_from_ = moments_.added() + kPatience;
}

void CameraPair::finish_lengths(const DancerSize& size) {
  is_measuring_ = false;
  const auto lengths = lengths_.lengths();
  double baseline_m = 0.0;
  if (lengths)
    baseline_m = size.told_m ? *size.told_m / lengths_.stature(*lengths)
                             : size.measured_m / height_of(*lengths);
  const bool is_usable = lengths && lengths_.met_share() > kLeastMet &&
                         lengths_.angle_rad() > kLeastAngle_rad && baseline_m > kLeastBaseline_m &&
                         baseline_m < kMostBaseline_m;
  if (!is_usable) {
    if (placement_) return;  // the last ones are kept
    search_from_ = moments_.added() + kPatience;
    return;
  }
  if (!placement_) {
    checked_ = moments_.added();
    recent_spread_ = usual_spread_ = std::max(1.0, fit_.spread());
    has_told_lengths_ = false;
  }
  placement_ = {fit_.pose(),        baseline_m,        lengths_.angle_rad(),
                fit_.turn_sd_rad(), fit_.later_sd_s(), fit_.spread()};
  if (has_told_lengths_ || lengths_.moments() < kLengthMoments) return;
  has_told_lengths_ = true;
  new_lengths_ = scaled(*lengths, baseline_m);
}

std::optional<BodyLengths> CameraPair::take_lengths() {
  return std::exchange(new_lengths_, std::nullopt);
}

void CameraPair::reset_body() {
  moments_.clear();
  checked_ = 0;
  is_searching_ = is_measuring_ = has_told_lengths_ = false;
  search_from_ = kFewestMoments;
  new_lengths_.reset();
}

void CameraPair::follow(const DancerSize& size) {
  if (is_measuring_) {
    if (lengths_.step(moments_, other_, kMomentsInCall)) finish_lengths(size);
    return;
  }
  if (calls_ % kFollowEvery != 0) return;
  if (!fit_.step(moments_, other_, true)) return;
  if (!is_good()) {
    // Too little moves now: what is known stays.
    fit_.begin(placement_->pose);
    return;
  }
  lengths_.begin(fit_.pose(), moments_);
  is_measuring_ = true;
}

void CameraPair::check_moments() {
  checked_ = std::max(checked_, moments_.first());
  while (checked_ < moments_.added()) {
    const ViewPoints& moment = moments_.entry(checked_);
    const ViewPoints* newest = other_.newest();
    const bool is_waiting =
        newest && newest->time < moment.time + Duration::seconds(placement_->pose.later_s) &&
        now_ - moment.time < kOverlap * 2;
    if (is_waiting) return;
    ++checked_;
    const double spread = spread_of_moment(placement_->pose, moment, other_);
    if (spread < 0.0) continue;
    recent_spread_ += (spread - recent_spread_) / kRecentOver;
    usual_spread_ += (std::min(spread, 1.5 * usual_spread_) - usual_spread_) / kUsualOver;
    // A placement that would not be taken now is not kept either.
    const double most = std::min(kMostSpread, std::max(kMovedSpread, kMovedTimes * usual_spread_));
    if (recent_spread_ > most) return give_up();
  }
}

void CameraPair::give_up() {
  placement_.reset();
  reset_body();
  ++moves_;
}

}  // namespace dance
