#include "producers/camera/program/capture_chain.h"

#include "core/net/mono_clock.h"
#include "producers/first_sequence.h"

namespace dance {
namespace {

// After a longer absence the next dancer may be another one, and is measured again.
constexpr Duration kSomebodyElse = Duration::s(10);

}  // namespace

CaptureChain::CaptureChain(const GuestId& guest, CaptureSink& sink,
                           std::unique_ptr<PoseEstimator> estimator,
                           std::unique_ptr<BodySolver> solver)
    : guest_(guest),
      sink_(sink),
      estimator_(std::move(estimator)),
      solver_(std::move(solver)),
      body_(&estimator_->unfiltered()),
      next_sequence_(first_sequence(mono_now())) {}

void CaptureChain::see(const Frame& frame, const cv::Mat* right) {
  ++stats_.pictures;
  body_ = &estimator_->estimate(frame);
  // The solver smooths too, and smoothing twice would double the delay.
  const BodyLandmarks& seen = estimator_->unfiltered();
  if (seen.found) {
    if (last_seen_.is_set() && frame.capture_time - last_seen_ > kSomebodyElse) {
      solver_->reset();
      if (others_) others_->reset_body();
    }
    last_seen_ = frame.capture_time;
    ++stats_.seen;
  }
  std::optional<DepthHint> depth;
  if (stereo_ && right && seen.found) depth = stereo_->hint(frame.image, *right, seen);
  OtherViews views;
  if (others_) views = others_->see_first(seen, *solver_);
  Pose pose;
  if (!solver_->solve(seen, depth, pose, views)) return;
  pose.sequence = next_sequence_++;
  pose.clock_id = this_clock_id();
  pose.capture_time = frame.capture_time;
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
}

void CaptureChain::say_skeleton(MonoTime now) {
  sink_.capture(guest_, TimedSkeleton{solver_->skeleton(), now, this_clock_id()});
  said_version_ = solver_->skeleton().version;
  next_skeleton_ = now + Duration::s(1);
}

void CaptureChain::restart() { estimator_->reset(); }

}  // namespace dance
