// PredictModel: what training on recorded dances leaves for prediction: where bones usually are,
// the network that bodies have in common, and how much each way of predicting is worth at each
// horizon, before a dancer has shown anything.
//
// Units/frames: as body_row.h and body_net.h beside it; trembles in rad.
// Ownership:    plain values of about two megabytes: share them.
// Threads:      read-only once made.
// Failure:      read_predict_model() names what is wrong with a file.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/pose/skeleton.h"
#include "transformers/predict/model/body_net.h"
#include "transformers/predict/model/body_row.h"

namespace dance {

// Ways of predicting where a body goes, each a row of numbers that are added with a weight.
enum class Prediction : std::uint8_t {
  kSlope1,  // as it went over the last 1, 3, 6, 12 frames
  kSlope3,
  kSlope6,
  kSlope12,
  kReturn,     // to the mean of the last 4 s
  kLikeShort,  // where moments like this one stood (alike over 0.3 s), and how they went
  kLikeShortSlope,
  kLikeLong,  // the same, alike over 2 s
  kLikeLongSlope,
  kWentShort,  // how moments like this one went on, by horizon
  kWentLong,
  kNet,  // the network, by horizon
};
constexpr std::size_t kPredictions = 12;
constexpr std::size_t kCommonPredictions = 9;  // the same at all horizons

using PredictionWeights = std::array<std::array<float, kPredictions>, kHorizons>;
// Bones, place, heading: what counts differs.
constexpr std::size_t kWeightKinds = 4;  // trunk and head, arms, legs, the root
constexpr std::array<std::uint8_t, kRowGroups> kKindOfGroup{0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1,
                                                            1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 3, 3};
using KindWeights = std::array<PredictionWeights, kWeightKinds>;

// What the network is worth for a dancer: nothing (it is not asked), what it is for others than it
// was trained on, or what it is for those.
enum class Acquaintance : std::uint8_t { kNone, kOthers, kDancer };
constexpr std::size_t kAcquaintances = 3;

// A dancer that the model was trained on: lengths of the bones, m.
using BoneLengths = std::array<float, kBoneCount>;
BoneLengths bone_lengths(const Skeleton& skeleton);
// Whether no bone differs by more than `most_m`.
bool is_alike(const BoneLengths& a, const BoneLengths& b, float most_m);
constexpr std::size_t kMostKnownDancers = 64;

struct PredictModel {
  std::uint32_t name = 0;
  BoneRotations centres = identity_rotations();
  std::array<float, kRowGroups> lever{};  // m that a turn of 1 rad moves: what an error counts
  // Errors at a horizon are counted in this: the usual length of a way there, m.
  std::array<float, kHorizons> horizon_scale{};
  BodyNet net = BodyNet::blank();
  // [Acquaintance][0: seen for some seconds only, 1: for long][0: a still sensor, 1: one that
  // trembles]
  std::array<std::array<std::array<KindWeights, 2>, 2>, kAcquaintances> weights{};
  std::array<float, 2> tremble_rad{};  // of those two
  std::vector<BoneLengths> dancers;

  bool knows(const Skeleton& skeleton) const;
};

// Numbers are kept in 16 bits, so a model that was written and read again differs a little: it is
// what is read that counts. Its name is a hash of the file.
std::vector<std::uint8_t> write_predict_model(const PredictModel& model);
Result<std::shared_ptr<const PredictModel>> read_predict_model(std::span<const std::uint8_t> file);

// The model that this build was made with.
std::shared_ptr<const PredictModel> built_in_predict_model();

}  // namespace dance
