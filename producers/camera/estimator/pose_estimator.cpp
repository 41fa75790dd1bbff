#include "producers/camera/estimator/pose_estimator.h"

#include <opencv2/core/utility.hpp>
#include <utility>

namespace dance {

Result<PoseNetworks> open_networks(const EstimatorOptions& options) {
  // One core for the camera; the others are for music, network and display.
  cv::setNumThreads(1);
  const std::string folder = pose_models_folder(options.models_folder);
  const auto in_file = [&](const std::string& name, const Error& error) {
    return fail(folder + "/" + name + ": " + error.what);
  };
  DANCE_TRY(PoseGraph people, read_detector(folder));
  DANCE_TRY(PoseGraph points, read_landmark_model(folder, options.model));
  auto detector = PersonDetector::make(options.engine, std::move(people));
  if (!detector) return in_file("pose_detection.tflite", detector.error());
  auto network = LandmarkNetwork::make(options.engine, std::move(points));
  if (!network)
    return in_file("pose_landmark_" + std::string(name_of(options.model)) + ".tflite",
                   network.error());
  return PoseNetworks{std::move(*detector), std::move(*network)};
}

Result<std::unique_ptr<PoseEstimator>> PoseEstimator::open(const EstimatorOptions& options) {
  DANCE_TRY(PoseNetworks networks, open_networks(options));
  return std::unique_ptr<PoseEstimator>(
      new PoseEstimator(options, std::move(networks.detector), std::move(networks.landmarks)));
}

PoseEstimator::PoseEstimator(const EstimatorOptions& options, PersonDetector detector,
                             LandmarkNetwork network)
    : options_(options), detector_(std::move(detector)), network_(std::move(network)) {}

void PoseEstimator::reset() {
  next_region_.reset();
  nobody_since_.reset();
  last_search_.reset();
  is_exchanged_ = false;
  smoothing_.reset();
  target_.reset();
  switch_detector_.reset();
}

void PoseEstimator::follow(float x_px, float y_px) {
  reset();
  options_.follow.choice = FollowOptions::Choice::kNearest;
  options_.follow.place_px = {x_px, y_px};
}

bool PoseEstimator::is_due_to_search(MonoTime now) const {
  if (!nobody_since_ || !last_search_ || now - *nobody_since_ < options_.search_eagerly)
    return true;
  return now - *last_search_ >= options_.search_interval || now < *last_search_;
}

std::optional<BodyRegion> PoseEstimator::search(const Frame& frame) {
  const MonoTime now = frame.capture_time;
  if (!nobody_since_) nobody_since_ = now;
  if (!is_due_to_search(now)) return std::nullopt;
  last_search_ = now;
  ++counters_.searches;
  const std::int64_t start_ns = clock_ns();
  const auto people = detector_.find(frame.image, options_.least_score);
  const SeenPerson* person = target_.choose(people, now, options_.follow);
  times_.search_ns += clock_ns() - start_ns;
  if (!person || !(person->region.side_px >= 1.0f)) return std::nullopt;
  return person->region;
}

void PoseEstimator::lose(MonoTime now) {
  if (next_region_) {
    ++counters_.losses;
    nobody_since_ = now;
  }
  next_region_.reset();
  is_exchanged_ = false;
  smoothing_.lose();
  target_.on_lost();
  switch_detector_.on_lost(now);
}

bool PoseEstimator::is_exchanged(const Frame& frame, const BodyRegion& seen) {
  const MonoTime now = frame.capture_time;
  if (!options_.tracks || !options_.follow.watches_others || !switch_detector_.is_due(now))
    return false;
  const std::int64_t start_ns = clock_ns();
  ++counters_.looks;
  const auto people = detector_.find(frame.image, options_.least_score);
  const std::optional<BodyRegion> other = switch_detector_.update(people, seen, now);
  times_.search_ns += clock_ns() - start_ns;
  if (!other || !(other->side_px >= 1.0f)) return false;
  ++counters_.exchanged;
  smoothing_.reset();
  target_.reset();
  next_region_ = other;
  is_exchanged_ = true;
  return true;
}

const BodyLandmarks& PoseEstimator::estimate(const Frame& frame) {
  ++counters_.pictures;
  const MonoTime now = frame.capture_time;
  result_.found = result_.is_new = false;
  result_.presence = 0.0f;
  result_.capture_time = now;
  unfiltered_.found = unfiltered_.is_new = false;
  unfiltered_.presence = 0.0f;
  unfiltered_.capture_time = now;
  if (frame.image.type() != CV_8UC3 || frame.image.empty()) {
    ++counters_.unusable;
    lose(now);
    return result_;
  }
  // State in pixels is invalid in a picture of another size.
  if (!options_.tracks || frame.image.size() != picture_size_) reset();
  picture_size_ = frame.image.size();

  const bool is_new = !next_region_ || std::exchange(is_exchanged_, false);
  const std::optional<BodyRegion> region = next_region_ ? next_region_ : search(frame);
  if (!region) return result_;
  std::int64_t last_ns = clock_ns();
  const auto stage = [&](std::int64_t& sum) {
    const std::int64_t now_ns = clock_ns();
    sum += now_ns - std::exchange(last_ns, now_ns);
  };
  network_.look(frame.image, *region);
  stage(times_.region_ns);
  const bool did_run = network_.run();
  stage(times_.network_ns);
  if (!did_run || !network_.read(body_)) {
    ++counters_.unusable;
    lose(now);
    return result_;
  }
  if (!(body_.presence > options_.least_presence)) {
    lose(now);
    return result_;
  }
  const BodyRegion seen = body_.next_region();
  if (!is_new && options_.follow.refuses_jumps && !target_.is_plausible(seen, now)) {
    ++counters_.refused;
    lose(now);
    return result_;
  }
  stage(times_.rest_ns);
  if (!is_new && is_exchanged(frame, seen)) return result_;
  last_ns = clock_ns();
  target_.update(seen, now);
  write_points(body_, unfiltered_);
  unfiltered_.found = true;
  unfiltered_.is_new = is_new;
  unfiltered_.presence = body_.presence;
  unfiltered_.region = *region;
  smoothing_.smooth(now, !options_.smooths, body_);
  result_ = unfiltered_;
  if (options_.smooths) write_points(body_, result_);
  nobody_since_.reset();
  next_region_ = body_.next_region();
  if (!(next_region_->side_px >= 1.0f)) lose(now);
  ++counters_.found;
  stage(times_.rest_ns);
  return result_;
}

}  // namespace dance
