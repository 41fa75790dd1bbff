// Chooses the lattice point of a body: closed-loop quantisation bone by bone, each aimed from its
// decoded joint at the true place of its end, so that errors do not add up along a limb; of the
// points near enough the one of least rate-distortion cost.
//
// Units/frames: metres, radians, W; an error of 1 is the budget.
// Ownership:    owns memory for one frame; keeps no references after a call.
// Threads:      none inside.
// Failure:      quantise() is false where a joint would be further off than the budget: a finer
//               level, or a lower lambda, helps.
#pragma once

#include <array>
#include <span>

#include "core/codec/coding/symbol_distribution.h"
#include "core/codec/lattice/body_lattice.h"
#include "core/codec/lattice/body_predictor.h"
#include "core/pose/pose.h"

namespace dance {

// The exact body.
struct TrueBody {
  std::array<exact::Quat, kBoneCount> local{};
  std::array<exact::Quat, kBoneCount> global{};
  std::array<exact::Vec, kBoneCount> joint{};
  std::array<exact::Vec, kTipCount> tip{};
};
TrueBody true_body(const BodyLattice& lattice, const Pose& pose);

// The largest errors of a decoded body.
struct BodyError {
  double joint_m = 0.0;    // joints and tips
  double angle_rad = 0.0;  // of a bone in W
  double mean_joint_m = 0.0;
};
BodyError error_of(const BodyLattice& lattice, const TrueBody& truth, const LatticeBodyState& body);

// Largest angular error of a bone.
constexpr double kAngleCap_rad = 0.0698;
inline double angle_budget_rad(double error_m) {
  return error_m / kShellRadius_m < kAngleCap_rad ? error_m / kShellRadius_m : kAngleCap_rad;
}

struct QuantiseOptions {
  std::size_t level = 3;
  double error_m = 0.001;
  double inner = 0.9;   // the joints' part of the budget, which leaves room for the next ones
  double lambda = 6.0;  // rate-distortion weight: bits for an error of the whole budget
};

class BodyQuantiser {
 public:
  struct Choice {
    SymbolDistribution distribution;
    SymbolDistribution::Symbol symbol;
  };
  // Bones unchanged since the previous frame.
  using Still = std::array<bool, kBoneCount>;

  bool quantise(const BodyLattice& lattice, BodyPredictor& predictor,
                const DistributionTable& table, const TrueBody& truth, const Still& still,
                const ReferenceBody* base, const QuantiseOptions& options);

  const LatticeBodyState& body() const { return body_; }
  std::span<const Choice> choices() const { return {choices_.data(), choice_count_}; }
  double bits() const { return bits_; }

 private:
  struct Point {
    exact::Vec offset;  // in the bone's frame
    exact::Vec arm;     // the same in W, with the bone's true rotation
    exact::Vec truth;   // in W
    bool is_tip;
  };
  std::span<const Point> points() const { return {points_.data(), point_count_}; }
  void gather_points(std::size_t bone);
  void gather_beyond(std::size_t bone, std::size_t root, const exact::Vec& at,
                     const exact::Quat& turn);
  bool stands_in(std::size_t bone) const;
  bool quantise_place(double lambda);
  // As in the previous frame; or so that the points attached to it come to their true places.
  bool keep_bone(std::size_t bone);
  bool aim_bone(std::size_t bone, double lambda);
  // The coded coordinate, before wrapping.
  double choose(std::size_t first, std::size_t axis, double target_steps, double weight,
                double lambda);
  bool is_good(std::size_t bone) const;

  const BodyLattice* lattice_ = nullptr;
  const LatticeSteps* steps_ = nullptr;
  BodyPredictor* predictor_ = nullptr;
  const DistributionTable* table_ = nullptr;
  const TrueBody* truth_ = nullptr;
  const ReferenceBody* base_ = nullptr;
  QuantiseOptions options_;
  Still still_{};
  std::array<exact::Quat, kBoneCount> still_local_;  // of still bones
  LatticeBodyState body_;
  std::array<Choice, kCoordinateCount> choices_;
  std::size_t choice_count_ = 0;
  std::array<Point, kBoneCount + kTipCount> points_{};
  std::size_t point_count_ = 0;
  double bits_ = 0.0;
  double least_dot_ = 0.0;  // of a bone's rotation with the true one
};

// A number of steps wrapped to the turn around 0.
inline std::int32_t wrapped(std::int64_t n, std::int32_t turn) {
  if (turn == 0 || (n >= -(turn / 2) && n < (turn + 1) / 2)) return static_cast<std::int32_t>(n);
  std::int64_t m = n % turn;
  if (m >= (turn + 1) / 2) m -= turn;
  if (m < -(turn / 2)) m += turn;
  return static_cast<std::int32_t>(m);
}

}  // namespace dance
