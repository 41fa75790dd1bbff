#include "research/capture/capture_eval.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "producers/camera/files/bgr_picture.h"
#include "producers/camera/files/picture_file.h"
#include "producers/camera/files/video_reel.h"
#include "research/capture/thread_time.h"

namespace dance {
namespace {

double ms_since(std::int64_t start_ns) {
  return static_cast<double>(thread_time_ns() - start_ns) * 1e-6;
}

double worst_difference(std::span<const float> a, std::span<const float> b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, static_cast<double>(std::abs(a[i] - b[i])));
  return worst;
}

class CaptureEval {
 public:
  explicit CaptureEval(const CaptureEvalOptions& options) : options_(options) {
    options_.estimator.clock_ns = thread_time_ns;
  }
  Result<void> open();
  Result<void> add_picture(const std::string& path);
  Result<void> add_video(const std::string& path);
  CaptureRun finish() &&;

 private:
  Result<std::unique_ptr<PoseEstimator>> opened(bool tracks) const;
  void begin_sequence();
  Result<void> take(PoseEstimator* of_one, const Frame& frame, std::string name);
  void take_several(const Frame& frame, std::vector<CapturedPerson>& people);
  void take_hands_and_face(const Frame& frame, std::size_t person, CapturedPerson& seen);
  Result<void> compare(PoseEstimator& estimator);

  CaptureEvalOptions options_;
  CaptureRun run_;
  std::unique_ptr<PoseEstimator> still_, moving_;  // of one dancer
  std::unique_ptr<PeopleEstimator> several_;       // instead of these
  std::unique_ptr<LandmarkNetwork> other_;
  Extras extras_;
  std::vector<HandTracker> hands_;  // of each dancer; none: not asked for
  std::vector<FaceTracker> face_;
  std::unique_ptr<HandsEval> judge_;  // of a video
  std::uint64_t in_sequence_ = 0;
};

Result<std::unique_ptr<PoseEstimator>> CaptureEval::opened(bool tracks) const {
  EstimatorOptions options = options_.estimator;
  options.tracks = tracks;
  return PoseEstimator::open(options);
}

Result<void> CaptureEval::open() {
  if (options_.people > 1) {
    PeopleOptions people;
    people.people = options_.people;
    people.search_interval = options_.estimator.search_interval;
    DANCE_TRY(several_, PeopleEstimator::open(options_.estimator, people));
  } else {
    DANCE_TRY(still_, opened(false));
    DANCE_TRY(moving_, opened(true));
  }
  // What engines do once only is not counted.
  Frame blank;
  blank.image = cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(0));
  for (PoseEstimator* estimator : {still_.get(), moving_.get()}) {
    if (estimator == nullptr) continue;
    estimator->network().look(blank.image, {32.0f, 32.0f, 64.0f, 0.0f});
    if (!estimator->network().run()) return fail("the network does not run");
  }
  if (options_.sees_hands) {
    DANCE_TRY(extras_.hands,
              HandNetworks::open(chosen_engine(options_.estimator.engine),
                                 pose_models_folder(options_.estimator.models_folder)));
    hands_.assign(options_.people, HandTracker(*extras_.hands));
  }
  if (options_.sees_face) {
    DANCE_TRY(extras_.face,
              FaceNetworks::open(chosen_engine(options_.estimator.engine),
                                 pose_models_folder(options_.estimator.models_folder)));
    face_.assign(options_.people, FaceTracker(*extras_.face));
  }
  if (!options_.compares_engines) return {};
  EngineComparison& engines = run_.engines;
  engines.first = chosen_engine(options_.estimator.engine);
  engines.second =
      engines.first == EngineKind::kXnnpack ? EngineKind::kOpenCv : EngineKind::kXnnpack;
  DANCE_TRY(PoseGraph graph,
            read_landmark_model(pose_models_folder(options_.estimator.models_folder),
                                options_.estimator.model));
  DANCE_TRY(LandmarkNetwork network, LandmarkNetwork::make(engines.second, std::move(graph)));
  other_ = std::make_unique<LandmarkNetwork>(std::move(network));
  if (!other_->run()) return fail("the second engine does not run");
  return {};
}

Result<void> CaptureEval::compare(PoseEstimator& estimator) {
  LandmarkNetwork& first = estimator.network();
  EngineComparison& engines = run_.engines;
  std::copy(first.input().begin(), first.input().end(), other_->input().begin());
  std::int64_t start_ns = thread_time_ns();
  if (!first.run()) return fail("the network does not run");
  engines.first_ms += ms_since(start_ns);
  start_ns = thread_time_ns();
  if (!other_->run()) return fail("the second engine does not run");
  engines.second_ms += ms_since(start_ns);
  ++engines.regions;
  engines.worst_point_px =
      std::max(engines.worst_point_px,
               worst_difference(first.landmark_numbers(), other_->landmark_numbers()));
  engines.worst_world_m = std::max(
      engines.worst_world_m, worst_difference(first.world_numbers(), other_->world_numbers()));
  return {};
}

// What was seen before says nothing of what comes.
void CaptureEval::begin_sequence() {
  if (several_)
    several_->reset();
  else
    moving_->reset();
  for (HandTracker& hands : hands_) hands.reset();
  for (FaceTracker& face : face_) face.reset();
}

void CaptureEval::take_hands_and_face(const Frame& frame, std::size_t person,
                                      CapturedPerson& seen) {
  if (!hands_.empty()) {
    const std::int64_t start_ns = thread_time_ns();
    for (const HandSide side : {HandSide::kLeft, HandSide::kRight})
      seen.hands[static_cast<std::size_t>(side)] = hands_[person].look(frame, seen.body, side);
    run_.hands_ms += ms_since(start_ns);
  }
  if (!face_.empty()) {
    const std::int64_t start_ns = thread_time_ns();
    seen.face = face_[person].look(frame, seen.body);
    run_.face_ms += ms_since(start_ns);
  }
}

void CaptureEval::take_several(const Frame& frame, std::vector<CapturedPerson>& people) {
  const std::int64_t start_ns = thread_time_ns();
  const auto bodies = several_->estimate(frame);
  run_.ms += ms_since(start_ns);
  for (std::size_t i = 0; i < people.size(); ++i) {
    people[i].body = people[i].unfiltered = bodies[i];
    take_hands_and_face(frame, i, people[i]);
  }
}

Result<void> CaptureEval::take(PoseEstimator* of_one, const Frame& frame, std::string name) {
  EvaluatedFrame& seen = run_.frames.emplace_back();
  seen.name = std::move(name);
  seen.people.resize(options_.people);
  if (several_) {
    take_several(frame, seen.people);
    return {};
  }
  PoseEstimator& estimator = *of_one;
  const std::int64_t start_ns = thread_time_ns();
  const BodyLandmarks& body = estimator.estimate(frame);
  run_.ms += ms_since(start_ns);
  seen.people[0].body = body;
  seen.people[0].unfiltered = estimator.unfiltered();
  take_hands_and_face(frame, 0, seen.people[0]);
  if (judge_) judge_->see(frame, body, estimator.unfiltered());
  return other_ && body.found ? compare(estimator) : Result<void>{};
}

Result<void> CaptureEval::add_picture(const std::string& path) {
  const std::int64_t start_ns = thread_time_ns();
  Frame frame;
  DANCE_TRY(frame.image, read_bgr_picture(path));
  run_.decode_ms += ms_since(start_ns);
  if (options_.sequence_hz > 0.0) {
    frame.capture_time = MonoTime{} + Duration::seconds(1.0 + static_cast<double>(in_sequence_) /
                                                                  options_.sequence_hz);
    frame.sequence = in_sequence_++;
    return take(moving_.get(), frame, std::filesystem::path(path).filename().string());
  }
  begin_sequence();
  return take(still_.get(), frame, std::filesystem::path(path).filename().string());
}

Result<void> CaptureEval::add_video(const std::string& path) {
  DANCE_TRY(const auto reel, VideoReel::open(path));
  begin_sequence();
  if (options_.judges_hands && !several_ && !(hands_.empty() && face_.empty()))
    judge_ = std::make_unique<HandsEval>(extras_, reel->width_px(), reel->height_px());
  Frame frame;
  for (std::uint64_t i = 0;; ++i) {
    const std::int64_t start_ns = thread_time_ns();
    if (!reel->step()) break;
    if (i % options_.every != 0) continue;
    const std::string name = reel->name() + "#" + std::to_string(i);
    if (!reel->read(frame.image))
      return fail(path + ": frame " + std::to_string(i) + " is damaged");
    run_.decode_ms += ms_since(start_ns);
    if (options_.lost_frame == i) frame.image.setTo(cv::Scalar::all(0));
    frame.sequence = i;
    frame.capture_time = MonoTime{} + Duration::s(1) + reel->time();
    if (auto taken = take(moving_.get(), frame, name); !taken) return taken;
  }
  if (judge_) run_.hands = judge_->figures();
  judge_.reset();
  return {};
}

CaptureRun CaptureEval::finish() && {
  if (several_) {
    run_.of_several = several_->tracker().counters();
    return std::move(run_);
  }
  for (const PoseEstimator* estimator : {still_.get(), moving_.get()}) {
    const EstimatorCounters& c = estimator->counters();
    run_.counters.searches += c.searches;
    run_.counters.losses += c.losses;
    run_.counters.refused += c.refused;
    run_.counters.looks += c.looks;
    run_.counters.exchanged += c.exchanged;
    run_.counters.found += c.found;
    run_.counters.pictures += c.pictures;
    const EstimatorTimes& t = estimator->times();
    run_.times.search_ns += t.search_ns;
    run_.times.region_ns += t.region_ns;
    run_.times.network_ns += t.network_ns;
    run_.times.rest_ns += t.rest_ns;
  }
  return std::move(run_);
}

}  // namespace

LossComparison compare_after_loss(const CaptureRun& lost, const CaptureRun& uninterrupted,
                                  std::size_t lost_frame) {
  constexpr std::size_t kFrames = 20;
  LossComparison after;
  BodySmoothing continued, begun_anew;
  const auto smoothed = [](const BodyLandmarks& body, BodySmoothing& smoothing) {
    SeenBody seen;
    seen.image_px = body.image_px;
    seen.world_m = body.world_m;
    seen.visibility = body.visibility;
    for (Eigen::Vector2f& next : seen.next_px) next.setZero();
    smoothing.smooth(body.capture_time, false, seen);
    return seen.world_m;
  };
  const auto distance_mm = [](const auto& a, const auto& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kLandmarkCount; ++i)
      sum += 1000.0 * static_cast<double>((a[i] - b[i]).norm());
    return sum / static_cast<double>(kLandmarkCount);
  };
  const std::size_t end =
      std::min({lost_frame + 1 + kFrames, lost.frames.size(), uninterrupted.frames.size()});
  for (std::size_t f = 0; f < end; ++f) {
    const CapturedPerson& seen = lost.frames[f].people[0];
    const CapturedPerson& known = uninterrupted.frames[f].people[0];
    if (!seen.body.found) {
      begun_anew.reset();
      continue;
    }
    const auto on = smoothed(seen.unfiltered, continued),
               anew = smoothed(seen.unfiltered, begun_anew);
    if (f <= lost_frame || !known.body.found) continue;
    ++after.frames;
    after.from_continued_mm += distance_mm(seen.body.world_m, on);
    after.from_begun_anew_mm += distance_mm(seen.body.world_m, anew);
    after.from_uninterrupted_mm += distance_mm(seen.body.world_m, known.body.world_m);
  }
  for (double* sum :
       {&after.from_continued_mm, &after.from_begun_anew_mm, &after.from_uninterrupted_mm})
    *sum /= std::max(1, after.frames);
  return after;
}

Result<CaptureRun> evaluate_capture(const std::vector<std::string>& files,
                                    const CaptureEvalOptions& options) {
  CaptureEval eval(options);
  if (auto opened = eval.open(); !opened) return tl::make_unexpected(opened.error());
  for (const std::string& file : files) {
    if (auto fine = check_file(file); !fine) return tl::make_unexpected(fine.error());
    auto added = is_picture(file) ? eval.add_picture(file) : eval.add_video(file);
    if (!added) return tl::make_unexpected(added.error());
  }
  return std::move(eval).finish();
}

}  // namespace dance
