// What a network of bodies hears and says: points and a body as rows of numbers, seen from the
// floor under the head, turned as the head faces, and scaled to a body of average height.
//
// Units/frames: inputs as kInput… say, zero where a point is not tracked; outputs: the first two
//               columns of each bone's rotation but the head's, the hips from the floor under the
//               head, the ankles so, and the log odds that each foot stands.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; wants the head among the places.
#pragma once

#include <span>

#include "producers/trackers/body/body_guide.h"

namespace dance {

struct TrackerRow {
  // Of a point: whether it is tracked, its place, the first two columns of its rotation, its speed
  // and its turning speed.
  static constexpr std::size_t kPerPoint = 1 + 3 + 6 + 3 + 3;
  static constexpr std::size_t kInputs = kTrackedPointCount * kPerPoint;
  static constexpr std::size_t kTurns = (kBoneCount - 1) * 6;
  static constexpr std::size_t kHips = kTurns, kAnkles = kHips + 3, kStands = kAnkles + 6;
  static constexpr std::size_t kOutputs = kStands + 2;
  // Steps of the network; what it says is of the moment one step later.
  static constexpr double kStep_hz = 60.0;

  using Inputs = std::array<float, kInputs>;
  using Outputs = std::array<float, kOutputs>;
};

// Where a row is seen from.
struct TrackerView {
  TrackerView(const Place& head, float height_m);

  Eigen::Vector3f to_row(const Eigen::Vector3f& p_W_m) const {
    return scale * (R_WV.conjugate() * (p_W_m - origin_W_m));
  }
  Eigen::Vector3f to_world(const Eigen::Vector3f& p) const {
    return origin_W_m + R_WV * (p / scale);
  }

  Eigen::Vector3f origin_W_m;
  Eigen::Quaternionf R_WV;
  float scale;
};

// `before` is so many seconds earlier.
void write_inputs(const TrackerView& view, const BonePlaces& before, const BonePlaces& now,
                  float seconds, std::span<float, TrackerRow::kInputs> row);
void write_outputs(const TrackerView& view, const BodyFrames& body,
                   const std::array<float, 2>& stands, std::span<float, TrackerRow::kOutputs> row);
// The head's rotation is not in the row. Rotations are made orthonormal.
void read_outputs(const TrackerView& view, std::span<const float, TrackerRow::kOutputs> row,
                  const Eigen::Quaternionf& R_WHead, BodyGuess& guess);

}  // namespace dance
