#include "producers/trackers/net/tracker_features.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"

namespace dance {
namespace {

using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kRowHeight_m = 1.72f;
constexpr float kSpeedUnit_m_s = 2.0f, kTurnUnit_rad_s = 5.0f;
constexpr float kMostSpeed = 5.0f;  // in these units: a glitch is not worth more

// Bones of the arms lie along x, all others along y.
bool lies_along_x(std::size_t bone) {
  return bone >= index_of(Bone::kLeftShoulder) && bone <= index_of(Bone::kRightHand);
}

float* put(float* to, const Vector3f& v) {
  std::copy_n(v.data(), 3, to);
  return to + 3;
}

float* put(float* to, const Quaternionf& R) {
  const Matrix3f m = R.toRotationMatrix();
  return put(put(to, Vector3f(m.col(0))), Vector3f(m.col(1)));
}

Vector3f vector_at(std::span<const float, TrackerRow::kOutputs> row, std::size_t at) {
  return {row[at], row[at + 1], row[at + 2]};
}

Quaternionf rotation_at(std::span<const float, TrackerRow::kOutputs> row, std::size_t at,
                        bool x_first) {
  Vector3f x = vector_at(row, at), y = vector_at(row, at + 3);
  Vector3f& first = x_first ? x : y;
  Vector3f& second = x_first ? y : x;
  if (!(first.squaredNorm() > 1e-8f)) return Quaternionf::Identity();
  first.normalize();
  second -= first * first.dot(second);
  if (!(second.squaredNorm() > 1e-8f)) second = first.unitOrthogonal();
  second.normalize();
  Matrix3f m;
  m << x, y, x.cross(y);
  return Quaternionf(m).normalized();
}

Vector3f bounded(const Vector3f& v) {
  const float size = v.norm();
  return size > kMostSpeed ? Vector3f(v * (kMostSpeed / size)) : v;
}

}  // namespace

TrackerView::TrackerView(const Place& head, float height_m)
    : origin_W_m(head.p_W_m.x(), 0.0f, head.p_W_m.z()),
      R_WV(heading_turn(head.R_W)),
      scale(kRowHeight_m / height_m) {}

void write_inputs(const TrackerView& view, const BonePlaces& before, const BonePlaces& now,
                  float seconds, std::span<float, TrackerRow::kInputs> row) {
  std::fill(row.begin(), row.end(), 0.0f);
  const Quaternionf R_VW = view.R_WV.conjugate();
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((now.presence >> i & 1u) == 0) continue;
    float* to = row.data() + i * TrackerRow::kPerPoint;
    *to++ = 1.0f;
    const Place& place = now.places[i];
    to = put(to, view.to_row(place.p_W_m));
    to = put(to, Quaternionf(R_VW * place.R_W));
    if ((before.presence >> i & 1u) == 0 || seconds <= 0.0f) continue;
    const Place& was = before.places[i];
    const Vector3f moved = view.scale * (R_VW * (place.p_W_m - was.p_W_m));
    const Vector3f turned = R_VW * rotation_vector(place.R_W * was.R_W.conjugate());
    to = put(to, bounded(moved / (seconds * kSpeedUnit_m_s)));
    put(to, bounded(turned / (seconds * kTurnUnit_rad_s)));
  }
}

void write_outputs(const TrackerView& view, const BodyFrames& body,
                   const std::array<float, 2>& stands, std::span<float, TrackerRow::kOutputs> row) {
  const Quaternionf R_VW = view.R_WV.conjugate();
  float* to = row.data();
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if (b != index_of(Bone::kHead)) to = put(to, Quaternionf(R_VW * body.R_WB[b]));
  to = put(to, view.to_row(body.p_WB_m[0]));
  to = put(to, view.to_row(body.position(Bone::kLeftFoot)));
  to = put(to, view.to_row(body.position(Bone::kRightFoot)));
  *to++ = stands[0];
  *to++ = stands[1];
}

void read_outputs(const TrackerView& view, std::span<const float, TrackerRow::kOutputs> row,
                  const Quaternionf& R_WHead, BodyGuess& guess) {
  std::size_t at = 0;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    if (b == index_of(Bone::kHead)) {
      guess.R_WB[b] = R_WHead;
      continue;
    }
    guess.R_WB[b] = view.R_WV * rotation_at(row, at, lies_along_x(b));
    at += 6;
  }
  guess.p_WH_m = view.to_world(vector_at(row, TrackerRow::kHips));
  for (std::size_t side = 0; side < 2; ++side) {
    guess.ankles_W_m[side] = view.to_world(vector_at(row, TrackerRow::kAnkles + 3 * side));
    guess.stands[side] = 1.0f / (1.0f + std::exp(-row[TrackerRow::kStands + side]));
  }
}

}  // namespace dance
