#include "producers/camera/solver/proportions.h"

#include <algorithm>
#include <cmath>

#include "core/base/median.h"
#include "producers/camera/solver/length_spans.h"

namespace dance {

using Eigen::Vector3d;

namespace {

constexpr double kSeenWell = 0.35;
// Weight of the median against an average body, in logarithms. Feet, ears and hip joints are
// measured less well than long bones.
constexpr std::array<double, kLengthCount> kWorth{0.95, 0.8,  0.95, 0.95, 0.95,
                                                  0.95, 0.95, 0.7,  0.7};
// Bound of a length's ratio to the average.
constexpr double kMostRatio = 1.7;
constexpr double kLeastBody_m = 0.8, kMostBody_m = 2.4;
constexpr int kFewest = 8;
// A bone lies across the view where its depth is less than half its length; its length in the
// picture then has this weight.
constexpr double kAcross = 0.87, kPictureWorth = 0.7;

}  // namespace

void Proportions::reset() {
  for (Samples& s : network_) s.count = 0;
  discard_image_lengths();
  scale_sum_ = scale_weight_ = 0.0;
  pictures_ = 0;
  held_.reset();
}

void Proportions::hold(const BodyLengths& lengths) {
  held_ = lengths;
  pictures_ = kHeld;
}

void Proportions::discard_image_lengths() {
  for (Samples& s : pictured_) s.count = 0;
}

void Proportions::measure(const Observation& seen, const Points& points, bool across_only,
                          AllSamples& all) {
  // Left and right share one list of samples: the mean of both in a picture.
  std::array<double, kLengthCount> sum{}, count{};
  for (const LengthSpan& span : kLengthSpans) {
    const std::size_t i[]{index_of(span.from_a), index_of(span.from_b), index_of(span.to_a),
                          index_of(span.to_b)};
    bool is_seen = true;
    for (const std::size_t point : i)
      is_seen = is_seen && seen.world_weight[point] >= kSeenWell && seen.weight[point] >= kSeenWell;
    if (!is_seen) continue;
    const Vector3d way = 0.5 * (points[i[2]] + points[i[3]] - points[i[0]] - points[i[1]]);
    if (across_only && way.head<2>().norm() < kAcross * way.norm()) continue;
    sum[static_cast<std::size_t>(span.length)] += way.norm();
    count[static_cast<std::size_t>(span.length)] += 1.0;
  }
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    Samples& samples = all[l];
    if (count[l] > 0.0 && samples.count < kHeld)
      samples.values[static_cast<std::size_t>(samples.count++)] =
          static_cast<float>(sum[l] / count[l]);
  }
}

void Proportions::see(const Observation& seen, const Points& pictured_m,
                      const std::optional<DepthHint>& depth) {
  if (!seen.is_usable || is_held()) return;
  if (depth && depth->joints > 0 && std::isfinite(depth->scale) && depth->scale > 0.3 &&
      depth->scale < 3.0 && std::isfinite(depth->scale_spread)) {
    const double sd = std::max(0.005, depth->scale_spread);
    scale_sum_ += depth->scale / (sd * sd);
    scale_weight_ += 1.0 / (sd * sd);
  }
  measure(seen, seen.world_m, false, network_);
  measure(seen, pictured_m, true, pictured_);
  if (seen.visible > 0.8) ++pictures_;
}

double Proportions::scale(const BodyLengths& measured) const {
  const double tall_m = height_of(measured);
  if (height_m_) return *height_m_ / tall_m;
  const double scale = scale_weight_ > 0.0 ? scale_sum_ / scale_weight_ : 1.0;
  return std::clamp(scale * tall_m, kLeastBody_m, kMostBody_m) / tall_m;
}

bool Proportions::medians(const AllSamples& all, BodyLengths& lengths,
                          std::array<bool, kLengthCount>& is_measured) {
  const BodyLengths average = average_lengths(1.0);
  double ratio = 0.0;
  int ratios = 0;
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    const Samples& samples = all[l];
    is_measured[l] = false;
    if (samples.count < kFewest) continue;
    std::array<float, kHeld> sorted = samples.values;
    const std::span<float> measured(sorted.data(), static_cast<std::size_t>(samples.count));
    lengths[l] = static_cast<double>(median_of(measured));
    is_measured[l] = lengths[l] > 0.01;
    if (is_measured[l] && kWorth[l] > 0.9) {
      ratio += std::log(lengths[l] / average[l]);
      ++ratios;
    }
  }
  if (ratios < 3) return false;
  // Lengths without a measurement follow the others.
  for (std::size_t l = 0; l < kLengthCount; ++l)
    if (!is_measured[l]) lengths[l] = std::exp(ratio / ratios) * average[l];
  return true;
}

BodyLengths Proportions::lengths() const {
  if (held_) return *held_;
  BodyLengths network{}, pictured{};
  std::array<bool, kLengthCount> has_network{}, is_pictured{};
  if (!medians(network_, network, has_network)) return average_lengths(height_m_.value_or(1.72));
  const double height = height_of(network);
  const BodyLengths average = average_lengths(height);
  const bool has_pictured = medians(pictured_, pictured, is_pictured);
  // A picture shows relative lengths only.
  const double to_network = has_pictured ? height / height_of(pictured) : 1.0;
  BodyLengths lengths = network;
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    if (has_pictured && is_pictured[l])
      lengths[l] = has_network[l]
                       ? network[l] * std::pow(to_network * pictured[l] / network[l], kPictureWorth)
                       : to_network * pictured[l];
    const double ratio = std::clamp(lengths[l] / average[l], 1.0 / kMostRatio, kMostRatio);
    lengths[l] = average[l] * std::pow(ratio, kWorth[l]);
  }
  return scaled(lengths, scale(lengths));
}

}  // namespace dance
