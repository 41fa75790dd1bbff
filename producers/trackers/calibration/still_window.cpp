#include "producers/trackers/calibration/still_window.h"

#include <algorithm>

namespace dance {
namespace {

// Of the head, of any other point: people sway, and stretched arms tremble.
constexpr float kStillHead_m = 0.04f, kStillPoint_m = 0.06f;
constexpr float kStill_rad = 0.25f;
constexpr Duration kLongestGap = Duration::ms(200);
constexpr int kFewestFrames = 12;
constexpr std::uint32_t kHeadAndHands = 0b111;

}  // namespace

bool StillWindow::is_still(const TrackerFrame& frame) const {
  if ((frame.presence & kHeadAndHands) != (first_.presence & kHeadAndHands)) return false;
  if (frame.time - newest_ > kLongestGap) return false;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if (((frame.presence & first_.presence) >> i & 1u) == 0) continue;
    const float most = i == index_of(TrackedPoint::kHead) ? kStillHead_m : kStillPoint_m;
    if ((frame.p_WT_m[i] - first_.p_WT_m[i]).norm() > most) return false;
    if (frame.R_WT[i].angularDistance(first_.R_WT[i]) > kStill_rad) return false;
  }
  return true;
}

bool StillWindow::add(const TrackerFrame& frame) {
  if (count_ == 0 || !is_still(frame)) {
    first_ = frame;
    count_ = 0;
    seen_.fill(0);
    position_sums_.fill(Eigen::Vector3f::Zero());
    rotation_sums_.fill(Eigen::Vector4f::Zero());
  }
  newest_ = frame.time;
  ++count_;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((frame.presence >> i & 1u) == 0) continue;
    if ((first_.presence >> i & 1u) == 0)
      first_.put(static_cast<TrackedPoint>(i), frame.p_WT_m[i], frame.R_WT[i]);
    ++seen_[i];
    position_sums_[i] += frame.p_WT_m[i] - first_.p_WT_m[i];
    const float sign = frame.R_WT[i].dot(first_.R_WT[i]) < 0.0f ? -1.0f : 1.0f;
    rotation_sums_[i] += sign * frame.R_WT[i].coeffs();
  }
  if (count_ < kFewestFrames || newest_ - first_.time < kLength) return false;
  means_.presence = 0;
  means_.time = newest_;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    // A tracker that is out of sight now and then tells enough.
    if (2 * seen_[i] < count_) continue;
    means_.presence |= 1u << i;
    means_.places[i].p_W_m = first_.p_WT_m[i] + position_sums_[i] / static_cast<float>(seen_[i]);
    means_.places[i].R_W.coeffs() = rotation_sums_[i].normalized();
  }
  count_ = 0;
  return true;
}

float StillWindow::progress() const {
  if (count_ == 0) return 0.0f;
  const double part = (newest_ - first_.time).as_seconds() / kLength.as_seconds();
  return static_cast<float>(std::clamp(part, 0.0, 1.0));
}

}  // namespace dance
