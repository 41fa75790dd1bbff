// What training leaves: where bones are at rest, how each coordinate goes on from earlier frames or
// hangs together with the others, how sure that is, and the bell that the rest has. A model is a
// file of numbers with a name; two ends that speak the lattice codec need the same.
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
#include "core/codec/body_lattice.h"
#include "core/codec/symbol_law.h"

namespace dance {

constexpr std::size_t kMeanFeatures = 12;
constexpr std::size_t kSpreadFeatures = 12;
constexpr std::size_t kSpeeds = 3;  // still, moving, fast

// One coordinate's law: mean = w · f by how fast the bone's end moves, log2 spread = w · g.
struct CoordinateLaw {
  alignas(16) std::array<std::array<float, kMeanFeatures>, kSpeeds> mean{};
  alignas(16) std::array<float, kSpreadFeatures> spread{};
};

// Frames that refer to others: by how old the newest reference is and how many stand in a row.
struct ReferenceCase {
  std::uint8_t slow = 0;  // 0: frames every 11 to 22 ms, 1: longer
  std::uint8_t age = 1;   // frames
  std::uint8_t run = 1;   // 1, 2 or 4
  bool operator==(const ReferenceCase&) const = default;
};
constexpr std::array<std::uint8_t, 7> kModelAges{1, 2, 3, 4, 6, 8, 12};
constexpr std::array<std::uint8_t, 3> kModelRuns{1, 2, 4};
constexpr std::size_t kCaseCount = 2 * kModelAges.size() * kModelRuns.size();

// Frames that need no other: each coordinate from those before it.
constexpr std::size_t kIntraTerms = 10;
struct IntraLaw {
  std::array<std::uint8_t, kIntraTerms> from{};  // coordinate; only those before this one
  std::array<float, kIntraTerms> weight{};       // radians or metres per radian or metre
  float base = 0.0f;                             // radians or metres
  float spread_log2 = 0.0f;                      // of radians or metres
};

struct PoseModel {
  std::uint32_t name = 0;
  RestModel rest;
  BellShape bell{};
  BellShape intra_bell{};
  std::array<IntraLaw, kCoordinateCount> intra;
  std::array<std::array<CoordinateLaw, kCoordinateCount>, kCaseCount> laws;
};

// Where the nearest trained case stands in laws. `run` frames stand in a row, the newest `age` old.
std::size_t case_index(bool slow, std::size_t age, std::size_t run);

// Numbers are kept in half precision, so a model that was written and read again differs a little
// from what training found: it is what is read that counts. Its name is a hash of the file.
std::vector<std::uint8_t> write_model(const PoseModel& model);
Result<std::shared_ptr<const PoseModel>> read_model(std::span<const std::uint8_t> file);

// The model that this build was made with, and the untrained one that every build has.
std::shared_ptr<const PoseModel> built_in_model();
std::shared_ptr<const PoseModel> generic_model();

// Of a logistic law, of which a share is three times as wide.
BellShape logistic_bell(double wide_share);

std::uint16_t to_half(float value);
float from_half(std::uint16_t half);

}  // namespace dance
