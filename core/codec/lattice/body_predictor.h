// Predicts the mean and spread of each coordinate of a body in turn, from earlier decoded frames
// and from the coordinates of this frame decoded so far. Encoder and decoder run the same
// prediction, so only residuals are sent.
//
// A bone continues as it moved in its parent, or its end as it moved in the room (a planted foot, a
// steady head): trained weights combine both.
//
// Units/frames: steps of the lattice; W for the room.
// Ownership:    refers to lattice, model and references, which must outlive it; no heap.
// Threads:      none inside.
// Failure:      none: with no reference it predicts a frame from itself.
#pragma once

#include <span>

#include "core/codec/exact/four_floats.h"
#include "core/codec/lattice/body_lattice.h"
#include "core/codec/lattice/pose_model.h"

namespace dance {

// Features of a coordinate, for training.
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
                std::size_t age, std::span<const ReferenceBody* const> references);

  // Call for each coordinate in order; `body` holds what is decoded before it, and the coordinate's
  // bone is seated.
  Spread predict(std::size_t coordinate, const LatticeBodyState& body);
  // The decoded coordinate.
  void decoded(std::size_t coordinate, double steps);
  // predict() in two parts: look_at() before the three coordinates of the place or of a bone, then
  // for each.
  void look_at(std::size_t first, const LatticeBodyState& body);
  Spread predict_axis(std::size_t first, std::size_t axis, const LatticeBodyState& body);

  // Of this frame so far: the surprise, and the log2 sizes of the last two residuals.
  struct Mood {
    float surprise = 0.0f, size = 0.0f, size_before = 0.0f;
  };
  // So that a bone can be tried again.
  Mood mood() const { return mood_; }
  void set_mood(const Mood& mood) { mood_ = mood; }
  void forget() { mood_ = {}; }

  bool is_intra() const { return run_ == 0; }
  // For training.
  Features features() const;
  double mean() const { return mean_; }
  double log2_spread() const { return log2_spread_; }

 private:
  void look_back();
  struct Room;
  Room look_at_room(std::size_t bone, const LatticeBodyState& body) const;
  Spread intra(std::size_t coordinate, const LatticeBodyState& body);

  const BodyLattice& lattice_;
  const LatticeSteps& steps_;
  const PoseModel& model_;
  float age_;
  std::size_t run_;
  std::array<const ReferenceBody*, 4> was_{};  // the references, the newest first
  const std::array<CoordinateModel, kCoordinateCount>* coordinates_;

  // Of each coordinate 1 and the steps from reference to reference, the newest first; and 1 and the
  // sizes of the first, of how it changed and of how that had changed before.
  std::array<exact::Four, kPaddedCount> moved_;
  std::array<exact::Four, kPaddedCount> sizes_;
  float body_speed_ = 0.0f;  // log2 of steps, mean over the body
  float body_noise_ = 0.0f;
  alignas(16) std::array<float, kCoordinateCount> residual_{};
  float residual_before_ = 0.0f, residual_before_that_ = 0.0f;  // of the same bone
  Mood mood_;
  // Of u, v and w of the bone: predictions from the room and its parent, their spreads, and the
  // residual of the other swing.
  std::array<exact::Four, 3> hints_, hint_sizes_, beside_;
  // Of the coordinate that was predicted last.
  std::size_t coordinate_ = 0;
  std::size_t speed_ = 0;  // of its bone's end
  double base_ = 0.0;
  std::array<float, 4> late_{};  // features of this bone's coordinates before it
  double mean_ = 0.0;
  float log2_spread_ = 0.0f;
};

namespace detail {
// Smallest spread, in steps.
constexpr float kFloor = 0.25f;
inline exact::Four size_of(exact::Four steps) {
  return exact::rough_log2(exact::abs(steps) + kFloor);
}
inline std::int64_t to_256(double steps) {
  const double near = exact::at_most(exact::at_least(steps, -4.0e6), 4.0e6);
  const double x = near * 256.0 + (0.5 + 0x1p31);
  return static_cast<std::int64_t>(x) - (std::int64_t{1} << 31);  // rounded down
}
// Branch-free, as the branch would be unpredictable.
inline float clamped(float log2_spread, float least, float most) {
  return exact::at_most(exact::max(exact::all(log2_spread), exact::all(least))[0], most);
}
// Of −8 to 15.
inline int class_of(float log2_spread) {
  return static_cast<int>(log2_spread * 4.0f + (0.5f + 64.0f)) - 64 + 16;
}
// w · f, added up as exact::sum() does: eight features as two vectors of four, and four one by one,
// as they are known last.
inline float weigh(const std::array<float, 12>& w, exact::Four a, exact::Four b,
                   const std::array<float, 4>& late) {
  const exact::Four m = exact::load_four(&w[0]) * a + exact::load_four(&w[4]) * b;
  return ((m[0] + w[8] * late[0]) + (m[1] + w[9] * late[1])) +
         ((m[2] + w[10] * late[2]) + (m[3] + w[11] * late[3]));
}
}  // namespace detail

// Inline, so that state passed from one coordinate to the next stays in registers.
[[gnu::always_inline]] inline Spread BodyPredictor::predict_axis(std::size_t first,
                                                                 std::size_t axis,
                                                                 const LatticeBodyState& body) {
  const std::size_t c = first + axis;
  if (is_intra()) return intra(c, body);
  if (first < 6) {  // the place and the hips
    hints_[axis] = exact::Four{residual_[0], residual_[1], residual_[2], residual_[3]};
    late_ = {residual_[4], 0.0f, 0.0f, 0.0f};
  } else {
    late_ = {residual_before_, residual_before_that_, beside_[axis][0], beside_[axis][1]};
  }
  coordinate_ = c;
  base_ = was_[0]->x[c] * steps_.per_step[c];
  const CoordinateModel& trained = (*coordinates_)[c];
  const float off = detail::weigh(trained.mean[speed_], moved_[c], hints_[axis], late_);
  const float log2_spread =
      detail::weigh(trained.spread, sizes_[c], hint_sizes_[axis],
                    {body_noise_, mood_.surprise, mood_.size, mood_.size_before});
  mean_ = base_ + static_cast<double>(off);
  log2_spread_ = detail::clamped(log2_spread, -4.0f, 12.0f);
  return {detail::to_256(mean_), detail::class_of(log2_spread_)};
}

inline Spread BodyPredictor::predict(std::size_t c, const LatticeBodyState& body) {
  const std::size_t axis = c % 3;
  if (axis == 0) look_at(c, body);
  return predict_axis(c - axis, axis, body);
}

[[gnu::always_inline]] inline void BodyPredictor::decoded(std::size_t c, double steps) {
  if (is_intra()) return;
  const auto r = static_cast<float>(steps - mean_);
  residual_[c] = r;
  residual_before_that_ = residual_before_;
  residual_before_ = r;
  // Four at a time; the maximum is branch-free.
  const exact::Four size = detail::size_of(exact::all(r));
  const float surprise = (size - exact::max(exact::all(log2_spread_), exact::all(-2.0f)))[0];
  mood_ = {mood_.surprise + 0.15f * (surprise - mood_.surprise), size[0], mood_.size};
}

}  // namespace dance
