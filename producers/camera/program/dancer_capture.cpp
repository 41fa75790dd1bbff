#include "producers/camera/program/dancer_capture.h"

#include <utility>

#include "core/net/mono_clock.h"
#include "producers/first_sequence.h"

namespace dance {
namespace {

// After a longer absence the next dancer may be another one, and is measured again.
constexpr Duration kSomebodyElse = Duration::s(10);

}  // namespace

DancerCapture::DancerCapture(const GuestId& guest, CaptureSink& sink)
    : guest_(guest), sink_(sink), next_sequence_(first_sequence(mono_now())) {}

void DancerCapture::see_again(MonoTime now) {
  if (last_seen_.is_set() && now - last_seen_ > kSomebodyElse) {
    solver_->reset();
    if (extras_) extras_->reset();
    if (others_) others_->reset_body();
  }
  last_seen_ = now;
  ++stats_.seen;
}

void DancerCapture::publish(const Frame& frame, const BodyLandmarks& seen, const cv::Mat* right) {
  has_published_ = false;
  if (seen.found) see_again(frame.capture_time);
  std::optional<DepthHint> depth;
  if (stereo_ && right && seen.found) depth = stereo_->hint(frame.image, *right, seen);
  OtherViews views;
  if (others_) views = others_->see_first(seen, *solver_);
  Pose pose;
  if (!solver_->solve(seen, depth, pose, views)) return;
  // By another camera too.
  last_seen_ = frame.capture_time;
  pose.sequence = next_sequence_++;
  pose.clock_id = this_clock_id();
  pose.capture_time = frame.capture_time;
  if (extras_) extras_->steady_wrists(pose);
  // Receivers need the proportions to decode a dancer: they are sent first, and again when the
  // solver has better ones.
  const MonoTime now = mono_now();
  if (!next_skeleton_.is_set() || solver_->skeleton().version != said_version_) say_skeleton(now);
  sink_.capture(guest_, pose, now);
  const MonoTime published = mono_now();
  ++stats_.published;
  stats_.dequeued_to_published.add(published - frame.fetched);
  stats_.captured_to_published.add(published - frame.capture_time);
  if (published >= next_skeleton_) say_skeleton(published);
  pose_ = pose;
  has_published_ = true;
}

void DancerCapture::look_closer(const Frame& frame, const BodyLandmarks& seen) {
  if (!extras_) return;
  if (!has_published_) {
    // Nobody is left with the last expression.
    if (stats_.published > 0) extras_->rest(frame.capture_time, pose_, guest_, sink_);
    return;
  }
  const Eigen::Matrix3f R_WC = solver_->camera_stand().R_WC.cast<float>();
  extras_->look({frame, seen, pose_, R_WC, guest_, sink_});
}

void DancerCapture::say_skeleton(MonoTime now) {
  sink_.capture(guest_, TimedSkeleton{solver_->skeleton(), now, this_clock_id()});
  said_version_ = solver_->skeleton().version;
  next_skeleton_ = now + Duration::s(1);
}

void DancerCapture::restart() {
  if (extras_) extras_->reset();
}

}  // namespace dance
