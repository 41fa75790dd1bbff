// A trained model: rests of the bones, weights that predict each coordinate from earlier frames and
// other coordinates, weights of its spread, and the distribution of residuals. A model is a file of
// numbers with a name; both ends of the lattice codec need the same.
//
// Units/frames: features and means in steps of the lattice; spreads as log2 of steps.
// Ownership:    plain values of about half a megabyte: share them.
// Threads:      read-only once made.
// Failure:      read_model() names what is wrong with a file.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/codec/coding/symbol_distribution.h"
#include "core/codec/lattice/body_lattice.h"

namespace dance {

constexpr std::size_t kMeanFeatures = 12;
constexpr std::size_t kSpreadFeatures = 12;
constexpr std::size_t kSpeeds = 3;  // still, moving, fast

// One coordinate: mean = w · f by how fast the bone's end moves, log2 spread = w · g.
struct CoordinateModel {
  alignas(16) std::array<std::array<float, kMeanFeatures>, kSpeeds> mean{};
  alignas(16) std::array<float, kSpreadFeatures> spread{};
};

// Cases of delta frames: age of the newest reference and length of the run.
struct ReferenceCase {
  std::uint8_t slow = 0;  // 0: frames every 11 to 22 ms, 1: longer
  std::uint8_t age = 1;   // frames
  std::uint8_t run = 1;   // 1, 2 or 4
  bool operator==(const ReferenceCase&) const = default;
};
constexpr std::array<std::uint8_t, 7> kModelAges{1, 2, 3, 4, 6, 8, 12};
constexpr std::array<std::uint8_t, 3> kModelRuns{1, 2, 4};
constexpr std::size_t kCaseCount = 2 * kModelAges.size() * kModelRuns.size();

// Intra frames: each coordinate from those before it.
constexpr std::size_t kIntraTerms = 10;
struct IntraModel {
  std::array<std::uint8_t, kIntraTerms> from{};  // coordinate; only those before this one
  std::array<float, kIntraTerms> weight{};       // radians or metres per radian or metre
  float base = 0.0f;                             // radians or metres
  float spread_log2 = 0.0f;                      // of radians or metres
};

struct PoseModel {
  std::uint32_t name = 0;
  RestModel rest;
  DistributionTable table{};
  DistributionTable intra_table{};
  std::array<IntraModel, kCoordinateCount> intra;
  std::array<std::array<CoordinateModel, kCoordinateCount>, kCaseCount> coordinates;
};

// Index of the nearest trained case in `coordinates`, of a run of `run` frames, the newest `age`
// old.
std::size_t case_index(bool slow, std::size_t age, std::size_t run);

// Numbers are stored in half precision, so a model differs a little from the result of training
// once it was written and read. Its name is a hash of the file.
std::vector<std::uint8_t> write_model(const PoseModel& model);
Result<std::shared_ptr<const PoseModel>> read_model(std::span<const std::uint8_t> file);

// The model that this build was made with, and the untrained one that every build has.
std::shared_ptr<const PoseModel> built_in_model();
std::shared_ptr<const PoseModel> generic_model();

// A logistic distribution, of which a share is three times as wide.
DistributionTable logistic_table(double wide_share);

std::uint16_t to_half(float value);
float from_half(std::uint16_t half);

}  // namespace dance
