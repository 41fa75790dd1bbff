// Says of each coordinate of a body, one after the other, where it will be and how sure that is:
// from earlier decoded frames and from what of this frame is decoded already. Encoder and decoder
// run the same, so what is predicted need not be sent.
//
// A bone goes on as it did in its parent, or its end as it did in the room (a planted foot, a
// steady head): training weighs both.
//
// Units/frames: steps of the lattice; W for the room.
// Ownership:    looks at lattice, model and references, which must outlive it; no heap.
// Threads:      none inside.
// Failure:      none: with no reference it predicts a frame from itself.
#pragma once

#include <span>

#include "core/codec/body_lattice.h"
#include "core/codec/four_floats.h"
#include "core/codec/pose_model.h"

namespace dance {

struct Features {
  alignas(16) std::array<float, kMeanFeatures> mean{};
  alignas(16) std::array<float, kSpreadFeatures> spread{};
  std::size_t speed = 0;
  double base = 0.0;  // of the reference, steps
};

class BodyPredictor {
 public:
  // references[0] is the newest, `age` frames old; the others one frame apart. Empty: no reference.
  BodyPredictor(const BodyLattice& lattice, const PoseModel& model, std::size_t level, bool slow,
                std::size_t age, std::span<const BodyState* const> references);

  // Call for each coordinate in order; `body` holds what is decoded before it, and the coordinate's
  // bone is seated.
  Spread predict(std::size_t coordinate, const BodyState& body);
  // What the coordinate turned out to be.
  void decoded(std::size_t coordinate, double steps);

  // So that a bone can be tried again.
  exact::Four mood() const { return mood_; }
  void set_mood(exact::Four mood) { mood_ = mood; }
  void forget() { mood_ = exact::Four{body_noise_, 0.0f, 0.0f, 0.0f}; }

  bool is_intra() const { return run_ == 0; }
  // For training.
  const Features& features() const { return features_; }
  double mean() const { return mean_; }
  double log2_spread() const { return log2_spread_; }

 private:
  void look_back();
  // At the three coordinates from c on: of the place, or of a bone.
  void look_at(std::size_t c, const BodyState& body);
  struct Room;
  Room look_at_room(std::size_t bone, const BodyState& body) const;
  Spread intra(std::size_t coordinate, const BodyState& body);

  const BodyLattice& lattice_;
  const LatticeSteps& steps_;
  const PoseModel& model_;
  float age_;
  std::size_t run_;
  std::array<const BodyState*, 4> was_{};  // the references, the newest first
  const std::array<CoordinateLaw, kCoordinateCount>* laws_;

  // Of each coordinate 1 and the steps from reference to reference, the newest first; and 1 and the
  // sizes of the first, of how it changed and of how that had changed before.
  std::array<exact::Four, kPaddedCount> moved_;
  std::array<exact::Four, kPaddedCount> sizes_;
  float body_speed_ = 0.0f;  // log2 of steps, mean over the body
  float body_noise_ = 0.0f;
  alignas(16) std::array<float, kCoordinateCount> residual_{};
  float residual_before_ = 0.0f, residual_before_that_ = 0.0f;  // of the same bone
  // Of this frame so far: body_noise_, how surprising it is, and the log2 sizes of the last two
  // residuals.
  exact::Four mood_{};
  // Of u, v and w of the bone: what the room and its parent say, how sure that is, and how its other
  // way of swinging went.
  std::array<exact::Four, 3> said_, said_sizes_, beside_;
  Features features_;
  double mean_ = 0.0;
  float log2_spread_ = 0.0f;
};

}  // namespace dance
