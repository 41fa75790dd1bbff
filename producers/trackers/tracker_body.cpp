#include "producers/trackers/tracker_body.h"

#include "producers/trackers/body/geometric_guide.h"
#include "producers/trackers/body/learned_guide.h"

namespace dance {
namespace {

// After a longer gap the dance begins anew.
constexpr Duration kLongestPause = Duration::ms(500);

std::unique_ptr<BodyGuide> guide_of(const TrackerBody::Options& options) {
  if (options.guide == TrackerGuide::kGeometric) return std::make_unique<GeometricGuide>();
  return std::make_unique<LearnedGuide>(options.model ? options.model : built_in_tracker_model());
}

bool is_smoothed(std::size_t point) { return point > index_of(TrackedPoint::kRightHand); }

}  // namespace

TrackerBody::TrackerBody(const Options& options)
    : options_(options), skeleton_(skeleton_of(calibration_.values())), guide_(guide_of(options)) {}

TrackerBody::~TrackerBody() = default;
TrackerBody::TrackerBody(TrackerBody&&) noexcept = default;
TrackerBody& TrackerBody::operator=(TrackerBody&&) noexcept = default;

void TrackerBody::take_body() {
  const std::uint32_t version = skeleton_.version;
  skeleton_ = skeleton_of(calibration_.values());
  skeleton_.version = version + 1;
}

void TrackerBody::forget_motion() {
  guide_->reset();
  fit_.reset();
  for (PlaceSmoother& smoother : smoothers_) smoother.reset();
  newest_ = MonoTime();
}

void TrackerBody::reset() {
  calibration_.reset();
  refiner_.reset();
  take_body();
  forget_motion();
}

bool TrackerBody::restore(const CalibrationValues& values) {
  if (!calibration_.restore(values)) return false;
  refiner_.reset();
  take_body();
  forget_motion();
  return true;
}

bool TrackerBody::solve(const TrackerFrame& frame, Pose& pose) {
  if (!is_valid(frame) || !frame.has(TrackedPoint::kHead)) return false;
  // A clock that was set back is another clock.
  if (newest_.is_set() && newest_ - frame.time > kLongestPause) forget_motion();
  if (newest_.is_set() && frame.time <= newest_) return false;
  if (newest_.is_set() && frame.time - newest_ > kLongestPause) forget_motion();
  const float seconds =
      newest_.is_set() ? static_cast<float>((frame.time - newest_).as_seconds()) : 0.0f;
  newest_ = frame.time;
  const bool mounts_changed = calibration_.observe(frame);
  if (mounts_changed) {
    take_body();
    refiner_.reset();
  }
  BonePlaces bones;
  calibration_.place_bones(frame, bones);
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if (!is_smoothed(i)) continue;
    if ((bones.presence >> i & 1u) == 0)
      smoothers_[i].reset();
    else
      bones.places[i] = smoothers_[i].follow(bones.places[i], seconds);
  }
  guide_->guess(skeleton_, bones, seconds, guess_);
  refiner_.observe(bones, guess_, seconds);
  refiner_.apply(bones);
  fit_.fit(skeleton_, guess_, bones, mounts_changed, seconds, pose);
  pose.presence = kAllBones;
  pose.confidence = calibration_.state() == CalibrationState::kNeedsTPose ? 0.5f : 1.0f;
  pose.capture_time = frame.time;
  return true;
}

}  // namespace dance
