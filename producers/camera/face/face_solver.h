// FaceSolver: turns a face's points into the 52 expressions of ARKit. What a face looks like at
// rest is learned in the first two seconds in which it looks about ahead; an expression is how far
// distances between points differ from that. Some cannot be told from these points and stay 0:
// cheekPuff, jawForward, mouthDimple, tongueOut.
//
// Units/frames: as core/pose/face.h and producers/camera/face/face_features.h say.
// Ownership:    keeps the numbers of the first pictures (7 KB); no heap.
// Threads:      none inside; one owner.
// Failure:      before the face at rest is known, and where no face is seen, expressions fade to 0.
//               Weights are always within 0…1.
// Source:       meaning of the expressions: ARKit; Casiez, Roussel, Vogel: 1€ filter, CHI 2012.
#pragma once

#include "core/pose/face.h"
#include "producers/camera/estimator/one_euro.h"
#include "producers/camera/face/face_features.h"

namespace dance {

// How far each expression is shown by a face with these features, of which those at rest are known.
// Differences up to `noise` say nothing.
std::array<float, kExpressionCount> expressions_of(const FaceFeatures& is, const FaceFeatures& rest,
                                                   float noise);

class FaceSolver {
 public:
  // `smooth` as SolverOptions has it.
  explicit FaceSolver(double smooth = 1.0) : smooth_(smooth) {}

  // The face as it is in the picture of `now`.
  void see(const FaceLandmarks& face, MonoTime now);
  // After see(): where the eyes look, gaze_of(). What they do on average while the face at rest is
  // learned is straight ahead.
  void see_gaze(const std::optional<Eigen::Vector2f>& gaze_rad);
  // Weights and presence. False where no face has been seen for so long that all have faded.
  bool write(MonoTime now, Face& out) const;
  // Of the last face that was seen.
  const Eigen::Quaternionf& R_CHead() const { return R_CHead_; }
  bool knows_rest() const { return samples_ >= kSamples; }
  void reset();

 private:
  static constexpr std::size_t kSamples = 60;
  bool learn_rest(const CapturedFaceShape& shape);

  double smooth_;
  std::array<FaceFeatures, kSamples> sample_{};
  std::size_t samples_ = 0;
  FaceFeatures rest_{};
  std::array<OneEuro, kExpressionCount> filters_;
  std::array<float, kExpressionCount> weight_{};
  Eigen::Vector2f gaze_sum_rad_ = Eigen::Vector2f::Zero();
  int gazes_ = 0;
  std::array<OneEuro, 2> gaze_filters_;
  Eigen::Vector2f gaze_rad_ = Eigen::Vector2f::Zero();
  bool has_gaze_ = false;
  Eigen::Quaternionf R_CHead_ = Eigen::Quaternionf::Identity();
  bool is_seen_ = false, has_seen_ = false;
  MonoTime seen_;
};

// Left and right exchanged, as a mirror does.
void mirror(Face& face);

}  // namespace dance
