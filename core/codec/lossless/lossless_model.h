// The adaptive state of both ends of the lossless codec, and the one template by which a frame is
// written and read: see lossless_codec.h beside it. Each number is predicted from earlier frames;
// the residual is coded in the context of recent residuals.
//
// Units/frames: a frame is 92 floats in groups: 22 rotations of 4, the hips' place, the confidence.
// Ownership:    plain values of about 70 KB, no heap inside.
// Threads:      none inside.
// Failure:      none: any bytes decode to some frame.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "core/codec/coding/adaptive_bits.h"
#include "core/codec/exact/least_squares.h"
#include "core/pose/pose.h"

namespace dance {

constexpr std::size_t kLosslessFloats = 4 * kBoneCount + 3 + 1;

// A pose's bits.
struct LosslessFrame {
  std::array<std::uint32_t, kLosslessFloats> floats;
  std::uint32_t presence = kAllBones;
  std::uint64_t music = 0;
};
LosslessFrame lossless_frame(const Pose& pose);
void to_pose(const LosslessFrame& frame, Pose& pose);

// What a frame begins with: which bones were measured, and the music. It depends on nothing else of
// the frames before.
class LosslessOpening {
 public:
  LosslessOpening() { restart(); }
  void restart();
  template <class Coder>
  void code(Coder& coder, std::uint32_t& presence, std::uint64_t& music);

 private:
  template <class Coder>
  void code_music(Coder& coder, std::uint64_t& music);

  std::uint32_t presence_ = kAllBones;
  std::array<std::uint64_t, 2> music_{};
  AdaptiveBit presence_stays_;
  AdaptiveTree<7> music_lengths_{};
};

class LosslessModel {
 public:
  LosslessModel();

  // Resets all state: the previous frame is the default Pose.
  void restart();
  bool is_key() const { return frames_ == 0; }
  std::uint8_t counter() const { return static_cast<std::uint8_t>(frames_ & 0x7f); }
  // Digest of all frames since the intra frame, equal at both ends of a stream.
  std::uint8_t digest() const { return static_cast<std::uint8_t>(digest_ >> 32); }

  // Writes `frame` (a BitEncoder) or fills it (a BitDecoder), and learns from it.
  template <class Coder>
  void code(Coder& coder, LosslessFrame& frame);

 private:
  static constexpr std::size_t kSteps = 4;  // earlier steps that a prediction uses
  static constexpr std::size_t kInputs = kSteps + 4;
  static constexpr std::size_t kClassBits = 6;
  static constexpr std::size_t kResidualContexts = 48;
  using ClassTree = AdaptiveTree<kClassBits>;

  // One of the 92 numbers.
  struct Track {
    Track();
    LeastSquares<kInputs> predictor;
    std::array<double, kSteps + 1> past{};  // the newest first; NaN counts as 0
    std::uint32_t bits = 0;                 // the newest, exactly
    double mean_residual = 0.0;
    std::uint32_t unchanged =
        0;  // the last frames in which it unchanged still, newest lowest, of two
  };
  struct Group {
    std::size_t first = 0;
    std::size_t count = 0;
    bool is_rotation = false;
  };
  // How much larger than usual the residuals of this frame are, in log2.
  struct Surprise {
    double sum = 0.0;
    double count = 0.0;
    double mean() const { return count > 0.0 ? sum / count : 0.0; }
  };
  static Group group(std::size_t index);

  template <class Coder>
  void code_group(Coder& coder, std::size_t index, LosslessFrame& frame, Surprise& of_frame);
  template <class Coder>
  float code_predicted(Coder& coder, float x, double predicted, double log_scale, double& cell);
  template <class Coder>
  float code_below_cell(Coder& coder, float x, int cell_log2, bool negative);
  template <class Coder>
  float code_largest(Coder& coder, std::size_t bone, float x, double predicted);
  template <class Coder>
  std::int64_t code_residual(Coder& coder, ClassTree& classes, AdaptiveBit& sign,
                             std::int64_t residual);
  std::size_t largest_of(const Group& g) const;
  void learn_residual(Track& track, double residual, double cell);

  std::uint64_t frames_ = 0;
  std::uint64_t digest_ = 0;
  std::array<Track, kLosslessFloats> tracks_;
  std::array<double, kBoneCount> largest_residual_{};
  LosslessOpening opening_;

  std::array<AdaptiveBit, 2> group_stands_{};
  std::array<bool, kBoneCount + 2> group_stood_{};
  std::array<AdaptiveBit, 4> float_stands_{};
  AdaptiveBit turns_over_;
  std::array<bool, kBoneCount> is_turned_over_{};
  std::array<ClassTree, kResidualContexts> residual_classes_{};
  std::array<AdaptiveBit, kResidualContexts> residual_signs_{};
  std::array<ClassTree, 36> largest_classes_{};
  std::array<AdaptiveBit, 36> largest_signs_{};
  AdaptiveTree<8> octaves_{};
};

}  // namespace dance
