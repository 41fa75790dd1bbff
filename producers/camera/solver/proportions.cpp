#include "producers/camera/solver/proportions.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Vector3d;

namespace {

constexpr double kSeenWell = 0.35;
// What the median is worth beside an average body, in logarithms. Feet, ears and hip joints are said less well than long bones.
constexpr std::array<double, kLengthCount> kWorth{0.95, 0.8,  0.95, 0.95, 0.95,
                                                  0.95, 0.95, 0.7,  0.7};
// No body is further from the average in one length than this factor.
constexpr double kOdd = 1.35;
constexpr double kLeastBody_m = 0.8, kMostBody_m = 2.4;
constexpr int kFewest = 8;

struct Span {
  Length length;
  Landmark from_a, from_b, to_a, to_b;
};
constexpr Span span_of(Length length, Landmark from, Landmark to) {
  return {length, from, from, to, to};
}
constexpr std::array kSpans{
    span_of(Length::kShoulders, Landmark::kLeftShoulder, Landmark::kRightShoulder),
    span_of(Length::kHips, Landmark::kLeftHip, Landmark::kRightHip),
    Span{Length::kTorso, Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftShoulder,
         Landmark::kRightShoulder},
    span_of(Length::kUpperArm, Landmark::kLeftShoulder, Landmark::kLeftElbow),
    span_of(Length::kUpperArm, Landmark::kRightShoulder, Landmark::kRightElbow),
    span_of(Length::kLowerArm, Landmark::kLeftElbow, Landmark::kLeftWrist),
    span_of(Length::kLowerArm, Landmark::kRightElbow, Landmark::kRightWrist),
    span_of(Length::kThigh, Landmark::kLeftHip, Landmark::kLeftKnee),
    span_of(Length::kThigh, Landmark::kRightHip, Landmark::kRightKnee),
    span_of(Length::kShank, Landmark::kLeftKnee, Landmark::kLeftAnkle),
    span_of(Length::kShank, Landmark::kRightKnee, Landmark::kRightAnkle),
    span_of(Length::kFoot, Landmark::kLeftHeel, Landmark::kLeftFootIndex),
    span_of(Length::kFoot, Landmark::kRightHeel, Landmark::kRightFootIndex),
    span_of(Length::kEars, Landmark::kLeftEar, Landmark::kRightEar),
};

}  // namespace

void Proportions::reset() {
  for (Samples& s : samples_) s.count = 0;
  scale_sum_ = scale_weight_ = 0.0;
  pictures_ = 0;
}

void Proportions::see(const Observation& seen, const std::optional<DepthHint>& depth) {
  if (!seen.is_usable || is_held()) return;
  if (depth && depth->joints > 0 && std::isfinite(depth->scale) && depth->scale > 0.3 &&
      depth->scale < 3.0 && std::isfinite(depth->scale_spread)) {
    const double sd = std::max(0.005, depth->scale_spread);
    scale_sum_ += depth->scale / (sd * sd);
    scale_weight_ += 1.0 / (sd * sd);
  }
  // Left and right share one row of samples: the mean of both of a picture.
  std::array<double, kLengthCount> sum{}, count{};
  for (const Span& span : kSpans) {
    const std::size_t i[]{index_of(span.from_a), index_of(span.from_b), index_of(span.to_a),
                          index_of(span.to_b)};
    bool is_seen = true;
    for (const std::size_t point : i) is_seen = is_seen && seen.world_weight[point] >= kSeenWell;
    if (!is_seen) continue;
    const double metres =
        0.5 *
        (seen.world_m[i[2]] + seen.world_m[i[3]] - seen.world_m[i[0]] - seen.world_m[i[1]]).norm();
    sum[static_cast<std::size_t>(span.length)] += metres;
    count[static_cast<std::size_t>(span.length)] += 1.0;
  }
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    Samples& samples = samples_[l];
    if (count[l] > 0.0 && samples.count < kHeld)
      samples.values[static_cast<std::size_t>(samples.count++)] =
          static_cast<float>(sum[l] / count[l]);
  }
  if (seen.visible > 0.8) ++pictures_;
}

double Proportions::scale(const BodyLengths& measured) const {
  const double tall_m = height_of(measured);
  if (height_m_) return *height_m_ / tall_m;
  const double scale = scale_weight_ > 0.0 ? scale_sum_ / scale_weight_ : 1.0;
  return std::clamp(scale * tall_m, kLeastBody_m, kMostBody_m) / tall_m;
}

BodyLengths Proportions::lengths() const {
  BodyLengths measured{};
  std::array<bool, kLengthCount> is_measured{};
  double ratio = 0.0;
  int ratios = 0;
  const BodyLengths average = average_lengths(1.0);
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    const Samples& samples = samples_[l];
    if (samples.count < kFewest) continue;
    std::array<float, kHeld> sorted = samples.values;
    const auto middle = sorted.begin() + samples.count / 2;
    std::nth_element(sorted.begin(), middle, sorted.begin() + samples.count);
    measured[l] = static_cast<double>(*middle);
    is_measured[l] = measured[l] > 0.01;
    if (is_measured[l] && kWorth[l] > 0.9) {
      ratio += std::log(measured[l] / average[l]);
      ++ratios;
    }
  }
  if (ratios == 0) return average_lengths(height_m_.value_or(1.72));
  const double height = std::exp(ratio / ratios);
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    const double expected = height * average[l];
    if (!is_measured[l]) measured[l] = expected;
    const double odd = std::clamp(measured[l] / expected, 1.0 / kOdd, kOdd);
    measured[l] = expected * std::pow(odd, kWorth[l]);
  }
  const double by = scale(measured);
  for (double& l : measured) l *= by;
  return measured;
}

}  // namespace dance
