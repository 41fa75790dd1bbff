#include "core/codec/lattice/body_predictor.h"

#include <algorithm>

namespace dance {
namespace {

using detail::kFloor;
using detail::size_of;
using exact::Four;

// An end that moves less than this a frame is still; more than the other is fast.
constexpr double kStill_m = 0.0012;
constexpr double kFast_m = 0.006;
constexpr float kPi = static_cast<float>(exact::kPi);
// Below this distance a bone's end has no direction.
constexpr float kNearest_m = 1e-6f;

void store(std::array<float, 12>& to, Four a, Four b, Four c) {
  exact::store_four(&to[0], a);
  exact::store_four(&to[4], b);
  exact::store_four(&to[8], c);
}

exact::Vec place_of(const ReferenceBody& body) { return {body.x[0], body.x[1], body.x[2]}; }

// Differences of angles, within half a turn.
Four short_way(Four apart) {
  apart -= exact::only(apart > kPi, exact::all(2.0f * kPi));
  return apart - exact::only(apart < -kPi, exact::all(-2.0f * kPi));
}

// The coordinates that are twists, and the lane of a bone's twist.
alignas(16) constexpr auto kIsTwist = [] {
  std::array<std::int32_t, kPaddedCount> is{};
  for (std::size_t c = 5; c < kCoordinateCount; c += 3) is[c] = -1;
  return is;
}();
constexpr exact::FourInts kTwistLane{0, 0, -1, 0};

}  // namespace

BodyPredictor::BodyPredictor(const BodyLattice& lattice, const PoseModel& model, std::size_t level,
                             bool slow, std::size_t age,
                             std::span<const ReferenceBody* const> references)
    : lattice_(lattice),
      steps_(lattice.steps(level)),
      model_(model),
      age_(static_cast<float>(age)),
      run_(references.size()),
      coordinates_(&model.coordinates[case_index(slow, age, references.size())]) {
  if (is_intra()) return;
  // With fewer references the oldest is repeated.
  for (std::size_t i = 0; i < was_.size(); ++i) was_[i] = references[std::min(i, run_ - 1)];
  look_back();
}

void BodyPredictor::look_back() {
  using exact::load_two;
  const Four ones = exact::all(1.0f);
  Four speed{}, noise{};
  for (std::size_t c = 0; c < kPaddedCount; c += 4) {
    const exact::Two per_step = load_two(&steps_.per_step[c]),
                     per_step_2 = load_two(&steps_.per_step[c + 2]);
    const Four per_step_float = exact::load_four(&steps_.per_step_float[c]);
    const auto is_twist = *reinterpret_cast<const exact::FourInts*>(&kIsTwist[c]);
    Four moved[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double *a = &was_[i]->x[c], *b = &was_[i + 1]->x[c];
      const exact::Two apart = load_two(a) - load_two(b),
                       apart_2 = load_two(a + 2) - load_two(b + 2);
      moved[i] =
          exact::choose(is_twist, short_way(exact::to_floats(apart, apart_2)) * per_step_float,
                        exact::to_floats(apart * per_step, apart_2 * per_step_2));
    }
    const Four size = size_of(moved[0]), change = size_of(moved[0] - moved[1]),
               older = size_of(moved[1] - moved[2]);
    speed += size;
    noise += change;
    Four *m = &moved_[c], *s = &sizes_[c];
    m[0] = ones, m[1] = moved[0], m[2] = moved[1], m[3] = moved[2];
    exact::transpose(m[0], m[1], m[2], m[3]);
    s[0] = ones, s[1] = size, s[2] = change, s[3] = older;
    exact::transpose(s[0], s[1], s[2], s[3]);
  }
  // Padding counts as unmoved.
  constexpr float kPads = static_cast<float>(kPaddedCount - kCoordinateCount);
  const float nothing = exact::rough_log2(kFloor) * kPads;
  body_speed_ = (exact::sum(speed) - nothing) / static_cast<float>(kCoordinateCount);
  body_noise_ = (exact::sum(noise) - nothing) / static_cast<float>(kCoordinateCount);
}

// Where a bone's end and roll were in the room in the newest reference, relative to its present
// parent, and the changes of that; in steps.
struct BodyPredictor::Room {
  Four hold{}, speed{}, turn{};
};

// Swing and twist as in core/codec/exact/swing_twist.h, of three references side by side.
[[gnu::always_inline]] inline BodyPredictor::Room BodyPredictor::look_at_room(
    std::size_t bone, const LatticeBodyState& body) const {
  const exact::Vec d0 = was_[0]->end[bone] - body.joint[bone],
                   d1 = was_[1]->end[bone] - body.joint[bone],
                   d2 = was_[2]->end[bone] - body.joint[bone];
  const Four x = exact::to_floats(d0.x, d1.x, d2.x, 0.0),
             y = exact::to_floats(d0.y, d1.y, d2.y, 0.0),
             z = exact::to_floats(d0.z, d1.z, d2.z, 0.0);
  Four qw = was_[0]->spun[bone], qx = was_[1]->spun[bone], qy = was_[2]->spun[bone], qz{};
  exact::transpose(qw, qx, qy, qz);
  const exact::Quat& seat = body.seat[bone];
  const float sw = static_cast<float>(seat.w), sx = static_cast<float>(seat.x),
              sy = static_cast<float>(seat.y), sz = static_cast<float>(seat.z);
  // To the seat's frame: v − 2 w (s × v) + 2 s × (s × v)
  const Four tx = 2.0f * (sy * z - sz * y), ty = 2.0f * (sz * x - sx * z),
             tz = 2.0f * (sx * y - sy * x);
  const Four dx = x - sw * tx + (sy * tz - sz * ty), dy = y - sw * ty + (sz * tx - sx * tz),
             dz = z - sw * tz + (sx * ty - sy * tx);
  const Four rho2 = dx * dx + dy * dy;
  const Four inverse =
      1.0f / exact::max(exact::sqrt(rho2 + dz * dz) + exact::abs(dz), exact::all(kNearest_m));
  Four k = 2.0f * inverse * exact::atan_of_square(rho2 * inverse * inverse);
  const Four rho = exact::max(exact::sqrt(rho2), exact::all(kNearest_m));
  k = dz < 0.0f ? kPi / rho - k : k;
  const Four w = sw * qw + sx * qx + sy * qy + sz * qz;
  const Four w_z = sw * qz - sz * qw - sx * qy + sy * qx;
  const Four t = (w < 0.0f ? -w_z : w_z) /
                 exact::max(exact::sqrt(w * w + w_z * w_z) + exact::abs(w), exact::all(1e-6f));
  // From here on u, v and w side by side, reference by reference.
  Four newest = -k * dy, before = k * dx, oldest = 4.0f * t * exact::atan_of_square(t * t), none{};
  exact::transpose(newest, before, oldest, none);
  const std::size_t c = first_coordinate(bone);
  const double* was = &was_[0]->x[c];
  const Four in_parent = exact::to_floats(was[0], was[1], was[2], 0.0);
  const Four per_step{steps_.per_step_float[c], steps_.per_step_float[c + 1],
                      steps_.per_step_float[c + 2], 0.0f};
  const auto steps = [&](Four apart) {
    return exact::choose(kTwistLane, short_way(apart), apart) * per_step;
  };
  const Four speed = steps(newest - before);
  return {steps(newest - in_parent), speed, speed - steps(before - oldest)};
}

void BodyPredictor::look_at(std::size_t c, const LatticeBodyState& body) {
  if (is_intra()) return;
  const std::size_t bone = c < 3 ? 0 : (c - 3) / 3;
  residual_before_ = residual_before_that_ = 0.0f;
  speed_ = 1;
  if (run_ > 1) {
    const ReferenceBody &a = *was_[0], &b = *was_[1];
    const exact::Vec v = bone == 0 ? place_of(a) - place_of(b) : a.end[bone] - b.end[bone];
    const double v2 = exact::dot(v, v);
    speed_ = (v2 >= kStill_m * kStill_m ? 1u : 0u) + (v2 >= kFast_m * kFast_m ? 1u : 0u);
  }
  const Four moved{moved_[c][1], moved_[c + 1][1], moved_[c + 2][1], 0.0f};
  Room room;
  if (bone > 0) {
    room = look_at_room(bone, body);
    const float* parent =
        &residual_[first_coordinate(static_cast<std::size_t>(kBones[bone].parent))];
    hints_[0] = room.hold;
    hints_[1] = room.speed;
    hints_[2] = room.turn;
    Four of_parent = Four{parent[0], parent[1], parent[2], 0.0f} * steps_.of_parent[bone];
    exact::transpose(hints_[0], hints_[1], hints_[2], of_parent);
    beside_[0] = Four{moved[1], room.hold[1], 0.0f, 0.0f};
    beside_[1] = Four{moved[0], room.hold[0], 0.0f, 0.0f};
    beside_[2] = Four{};
  } else {
    for (std::size_t i = c; i < 6; ++i) residual_[i] = 0.0f;
  }
  hint_sizes_[0] = size_of(room.speed);
  hint_sizes_[1] = size_of(room.turn);
  hint_sizes_[2] = size_of(room.hold + age_ * (room.speed - moved));
  Four all_over = exact::all(body_speed_);
  exact::transpose(hint_sizes_[0], hint_sizes_[1], hint_sizes_[2], all_over);
}

// Hips are as high as legs are long: their height counts from there.
Spread BodyPredictor::intra(std::size_t c, const LatticeBodyState& body) {
  const IntraModel& trained = model_.intra[c];
  const double standing_m = lattice_.offset(0).y;
  double mean = static_cast<double>(trained.base) + (c == 1 ? standing_m : 0.0);
  for (std::size_t i = 0; i < kIntraTerms; ++i) {
    const std::size_t from = trained.from[i];
    mean +=
        static_cast<double>(trained.weight[i]) * (body.x[from] - (from == 1 ? standing_m : 0.0));
  }
  mean_ = mean * steps_.per_step[c];
  log2_spread_ = trained.spread_log2 + exact::rough_log2(static_cast<float>(steps_.per_step[c]));
  return {detail::to_256(mean_), detail::class_of(detail::clamped(log2_spread_, -8.0f, 15.0f))};
}

Features BodyPredictor::features() const {
  const std::size_t axis = coordinate_ % 3;
  Features f;
  store(f.mean, moved_[coordinate_], hints_[axis], Four{late_[0], late_[1], late_[2], late_[3]});
  store(f.spread, sizes_[coordinate_], hint_sizes_[axis],
        Four{body_noise_, mood_.surprise, mood_.size, mood_.size_before});
  f.speed = speed_;
  f.base = base_;
  return f;
}

std::size_t case_index(bool slow, std::size_t age, std::size_t run) {
  std::size_t a = 0;
  while (a + 1 < kModelAges.size() && kModelAges[a + 1] <= age) ++a;
  const std::size_t r = run >= 4 ? 2 : run >= 2 ? 1 : 0;
  return ((slow ? 1 : 0) * kModelAges.size() + a) * kModelRuns.size() + r;
}

}  // namespace dance
