#include "producers/camera/estimator/person_detector.h"

#include <algorithm>

#include "producers/camera/region/region_sampler.h"

namespace dance {
namespace {

constexpr AnchorGrid kGrids[] = {{28, 2}, {14, 2}, {7, 6}};

}  // namespace

PersonDetector::PersonDetector(std::unique_ptr<PoseEngine> engine)
    : engine_(std::move(engine)), boxes_(kGrids, kNumbers, kSide_px) {}

Result<PersonDetector> PersonDetector::make(EngineKind engine, PoseGraph graph) {
  int boxes = -1, scores = -1;
  for (const int output : graph.outputs) {
    if (graph.shape(output) == Shape{1, kAnchors, kNumbers}) boxes = output;
    if (graph.shape(output) == Shape{1, kAnchors, 1}) scores = output;
  }
  if (boxes < 0 || scores < 0 || graph.shape(graph.input) != Shape{1, kSide_px, kSide_px, 3})
    return fail("it is not the network that finds people");
  keep_outputs(graph, {boxes, scores});
  fold_pads(graph);
  DANCE_TRY(auto made, make_engine(engine, graph));
  return PersonDetector(std::move(made));
}

std::span<const SeenPerson> PersonDetector::find(const cv::Mat& picture, float least_score) {
  look(picture);
  return find_looked(least_score);
}

// The whole picture in a square, black bars beside it.
const BodyRegion& PersonDetector::look(const cv::Mat& picture) {
  const auto width = static_cast<float>(picture.cols), height = static_cast<float>(picture.rows);
  whole_ = {0.5f * width, 0.5f * height, std::max(width, height), 0.0f};
  sample_region(picture, whole_, kSide_px, Beyond::kBlack, -1.0f, 1.0f, engine_->input());
  return whole_;
}

std::span<const SeenPerson> PersonDetector::find_looked(float least_score) {
  if (!engine_->run()) return {};
  boxes_.decode(engine_->output(0), engine_->output(1), least_score);
  const RegionFrame frame(whole_);
  std::size_t people = 0;
  while (!boxes_.is_empty() && people < kMostPeople) {
    const AnchorBox box = boxes_.take_surest();
    people_[people++] = {box.score,
                         region_of(frame.in_picture(box.point(0)), frame.in_picture(box.point(1)))};
  }
  return {people_.data(), people};
}

}  // namespace dance
