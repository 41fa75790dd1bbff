#include "producers/camera/multiview/joint_lengths.h"

#include <algorithm>
#include <cmath>

#include "core/base/median.h"
#include "producers/camera/solver/length_spans.h"

namespace dance {

using Eigen::Vector3d;

namespace {

constexpr double kSeenWell = 0.35;
constexpr std::size_t kFewest = 16;
// Bound of a length's ratio to the average of the body.
constexpr double kMostRatio = 1.5;
// Dancers hold back and head bent: what they stand is longer by this than the median of what is
// seen. Measured of recorded dances, 0.2 to 0.8 %.
constexpr double kStraightened = 1.0045;

constexpr LengthSpan kNeck{Length::kTorso, Landmark::kLeftShoulder, Landmark::kRightShoulder,
                           Landmark::kLeftEar, Landmark::kRightEar};

// Shank, thigh, back and neck of an average body together, as a share of its height.
double average_share() {
  const BodyLengths lengths = average_lengths(1.0);
  const BodyShape shape = shape_of(lengths);
  const auto of = [&shape](Bone bone) { return shape.skeleton.offset(bone).cast<double>(); };
  Vector3d neck = of(Bone::kNeck) + of(Bone::kHead) + shape.point_m[point_of(Landmark::kLeftEar)] -
                  of(Bone::kLeftShoulder) - of(Bone::kLeftUpperArm);
  neck.x() = 0.0;
  const auto length = [&lengths](Length l) { return lengths[static_cast<std::size_t>(l)]; };
  return neck.norm() + length(Length::kTorso) + length(Length::kThigh) + length(Length::kShank);
}

struct JointAt {
  MetPoint point;
  bool is_met = false;
};

}  // namespace

void JointLengths::begin(const RelativePose& pose, const KeyMoments& moments) {
  pose_ = pose;
  next_ = moments.first();
  for (Samples& s : samples_) s.count = 0;
  neck_.count = 0;
  moments_ = looked_ = met_ = 0;
  angle_sum_ = 0.0;
}

bool JointLengths::step(const KeyMoments& moments, const ViewHistory& other, int most_moments) {
  next_ = std::max(next_, moments.first());
  ViewMoment b;
  for (; most_moments > 0 && next_ < moments.added(); ++next_, --most_moments) {
    const ViewPoints& a = moments.entry(next_);
    if (other.at(a.time + Duration::seconds(pose_.later_s), b)) measure(a, b);
  }
  return next_ >= moments.added();
}

void JointLengths::measure(const ViewPoints& first, const ViewMoment& other) {
  std::array<JointAt, kViewPointCount> joints;
  Vector3d middle = Vector3d::Zero();
  int met = 0;
  for (std::size_t i = 0; i < kViewPointCount; ++i) {
    const double weight = std::min(static_cast<double>(first.weight[i]), other.weight[i]);
    if (weight < kSeenWell) continue;
    ++looked_;
    joints[i].is_met =
        meet(pose_, first.ray[i].cast<double>(), other.ray[i], static_cast<double>(first.ray_sd),
             static_cast<double>(other.nearest->ray_sd), joints[i].point);
    if (!joints[i].is_met) continue;
    ++met;
    middle += joints[i].point.p_A;
  }
  met_ += met;
  if (met == 0) return;
  ++moments_;
  middle /= met;
  const Vector3d eye_B = -(pose_.R_BA.transpose() * pose_.p_BA);
  angle_sum_ +=
      std::acos(std::clamp(middle.normalized().dot((middle - eye_B).normalized()), -1.0, 1.0));
  const auto add = [&joints](const LengthSpan& span, Samples& samples) {
    const JointAt &fa = joints[view_point_of(span.from_a)],
                  &fb = joints[view_point_of(span.from_b)], &ta = joints[view_point_of(span.to_a)],
                  &tb = joints[view_point_of(span.to_b)];
    if (!fa.is_met || !fb.is_met || !ta.is_met || !tb.is_met || samples.count == kMost) return;
    const Vector3d way = 0.5 * (ta.point.p_A + tb.point.p_A - fa.point.p_A - fb.point.p_A);
    // E|a + n|² = |a|² + E|n|²; the mean of two points has half the variance of one.
    const double share = span.from_a == span.from_b ? 0.5 : 0.25;
    const double noise =
        share * (fa.point.variance + fb.point.variance + ta.point.variance + tb.point.variance);
    const double squared = way.squaredNorm() - noise;
    samples.values[samples.count++] = static_cast<float>(std::sqrt(std::max(0.0, squared)));
  };
  for (const LengthSpan& span : kLengthSpans)
    add(span, samples_[static_cast<std::size_t>(span.length)]);
  add(kNeck, neck_);
}

double JointLengths::median_of(const Samples& samples) {
  if (samples.count < kFewest) return 0.0;
  std::array<float, kMost> sorted;
  std::copy_n(samples.values.begin(), samples.count, sorted.begin());
  return static_cast<double>(dance::median_of(std::span(sorted.data(), samples.count)));
}

double JointLengths::stature(const BodyLengths& lengths) const {
  static const double share = average_share();
  const double neck = median_of(neck_);
  if (!(neck > 0.0)) return height_of(lengths);
  const auto length = [&lengths](Length l) { return lengths[static_cast<std::size_t>(l)]; };
  return kStraightened *
         (neck + length(Length::kTorso) + length(Length::kThigh) + length(Length::kShank)) / share;
}

std::optional<BodyLengths> JointLengths::lengths() const {
  const BodyLengths average = average_lengths(1.0);
  BodyLengths lengths{};
  double ratio = 0.0;
  int ratios = 0;
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    lengths[l] = median_of(samples_[l]);
    if (!(lengths[l] > 0.0)) continue;
    ratio += std::log(lengths[l] / average[l]);
    ++ratios;
  }
  for (const Length l : {Length::kThigh, Length::kShank, Length::kTorso})
    if (!(lengths[static_cast<std::size_t>(l)] > 0.0)) return std::nullopt;
  const double usual = std::exp(ratio / ratios);
  for (std::size_t l = 0; l < kLengthCount; ++l) {
    if (!(lengths[l] > 0.0)) lengths[l] = usual * average[l];
    lengths[l] =
        std::clamp(lengths[l], usual * average[l] / kMostRatio, usual * average[l] * kMostRatio);
  }
  return lengths;
}

}  // namespace dance
