// Training of the pose codec's model from recorded dances: where bones rest, how each coordinate
// goes on from earlier frames (least squares), how sure that is (maximum probability), and how the
// coordinates of one frame hang together. Each round encodes the takes with what the round before
// found, so that the model is learnt from frames as decoders have them.
//
// Units/frames: as core/codec/lattice/pose_model.h says.
// Ownership:    returns a model of its own.
// Threads:      runs two, which end with the call.
// Failure:      an Error says what the takes lack.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/codec/lattice/pose_model.h"
#include "research/codec_takes.h"

namespace dance {

struct CodecTraining {
  std::vector<CodecTake> fast;  // 60 frames a second
  std::vector<CodecTake>
      slow;  // 30; may be none: then the slow cases are as the generic model has them
  int rounds = 2;
  std::function<void(const std::string&)> tell;  // progress, a line each
};

Result<std::unique_ptr<PoseModel>> train_codec(const CodecTraining& training);

// The parts, in the order they are run. Frames of a take as decoders have them.
using DecodedTake = std::vector<ReferenceBody>;
struct TakeLattice {
  const CodecTake* take;
  std::unique_ptr<BodyLattice> lattice;
};
RestModel find_rest(const std::vector<CodecTake>& takes);
std::array<IntraModel, kCoordinateCount> find_intra(const std::vector<TakeLattice>& takes);
void fit_case(PoseModel& model, const std::vector<TakeLattice>& takes,
              const std::vector<DecodedTake>& decoded, const ReferenceCase& which);
// Log-linear model of the spread of one coordinate's residuals: rows of kSpreadFeatures features
// and the residual in steps; `weights` holds the start and receives the result.
void fit_spread(std::array<float, kSpreadFeatures>& weights, const std::vector<float>& rows);

}  // namespace dance
