#include "producers/camera/estimator/landmark_network.h"

#include <algorithm>
#include <cmath>

#include "producers/camera/region/region_sampler.h"

namespace dance {
namespace {

constexpr int kPoints =
    39;  // of which the first 33 are the body's, and the next two say where it is
constexpr int kNumbersOfPoint = 5;
constexpr int kHeat_cells = 64;
constexpr int kReach_cells = 3;
constexpr float kLeastHeat = 0.5f;

}  // namespace

Result<LandmarkNetwork> LandmarkNetwork::make(EngineKind engine, PoseGraph graph) {
  const Shape due[] = {{1, kPoints * kNumbersOfPoint},
                       {1, 1},
                       {1, kHeat_cells, kHeat_cells, kPoints},
                       {1, kPoints * 3}};
  std::vector<int> outputs;
  for (const Shape& shape : due)
    for (const int output : graph.outputs)
      if (graph.shape(output) == shape) outputs.push_back(output);
  if (outputs.size() != std::size(due) ||
      graph.shape(graph.input) != Shape{1, kSide_px, kSide_px, 3})
    return fail("it is not a network that finds the points of a body");
  // Without the branch that draws the outline of the body.
  keep_outputs(graph, outputs);
  fold_pads(graph);
  DANCE_TRY(auto made, make_engine(engine, graph));
  return LandmarkNetwork(std::move(made));
}

void LandmarkNetwork::look(const cv::Mat& picture, const BodyRegion& region) {
  region_ = region;
  sample_region(picture, region, kSide_px, Beyond::kNearest, 0.0f, 1.0f, engine_->input());
}

// The heatmap's centroid around the regressed point, where its peak is high enough; in parts of the
// region.
Eigen::Vector2f LandmarkNetwork::refined(std::size_t point, const Eigen::Vector2f& coarse) const {
  constexpr auto kCells = static_cast<float>(kHeat_cells);
  // Far beyond the region nothing is near; and such numbers do not fit an int.
  if (coarse.cwiseAbs().maxCoeff() > 16.0f) return coarse;
  const int column = static_cast<int>(coarse.x() * kCells);
  const int row = static_cast<int>(coarse.y() * kCells);
  if (column < 0 || column >= kHeat_cells || row < 0) return coarse;
  const std::span<const float> cells = heat();
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  float total = 0.0f, most = 0.0f;
  for (int r = std::max(row - kReach_cells, 0); r < std::min(row + kReach_cells + 1, kHeat_cells);
       ++r) {
    for (int c = std::max(column - kReach_cells, 0);
         c < std::min(column + kReach_cells + 1, kHeat_cells); ++c) {
      const float h =
          sigmoid(cells[static_cast<std::size_t>((r * kHeat_cells + c) * kPoints) + point]);
      total += h;
      most = std::max(most, h);
      sum += h * Eigen::Vector2f(static_cast<float>(c), static_cast<float>(r));
    }
  }
  if (!(most >= kLeastHeat)) return coarse;
  return sum / (kCells * total);
}

bool LandmarkNetwork::read(SeenBody& out) const {
  constexpr auto kSide = static_cast<float>(kSide_px);
  const std::span<const float> numbers = landmark_numbers(), world = world_numbers();
  out.presence = presence();
  if (!std::isfinite(out.presence) || !all_finite(numbers) || !all_finite(world)) return false;
  const RegionFrame frame(region_);
  for (std::size_t i = 0; i < kLandmarkCount + 2; ++i) {
    const float* n = numbers.data() + i * kNumbersOfPoint;
    const Eigen::Vector2f at = refined(i, Eigen::Vector2f(n[0], n[1]) / kSide);
    const Eigen::Vector2f px = frame.in_picture(at);
    if (i >= kLandmarkCount) {
      out.next_px[i - kLandmarkCount] = px;
      continue;
    }
    out.image_px[i] = {px.x(), px.y(), n[2] / kSide * region_.side_px};
    out.visibility[i] = sigmoid(n[3]);
    const float* w = world.data() + 3 * i;
    const Eigen::Vector2f wxy = frame.turned({w[0], w[1]});
    out.world_m[i] = {wxy.x(), wxy.y(), w[2]};
  }
  return true;
}

}  // namespace dance
