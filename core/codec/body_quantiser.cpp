#include "core/codec/body_quantiser.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace dance {
namespace {

using exact::Quat;
using exact::Vec;

// How much of the budget's worth a turn of the shell has beside the joints.
constexpr double kShellWeight = 0.3;
// A correction is some millimetres at the end of a bone.
constexpr double kFarthestAim_rad = 0.3;

Quat to_quat(const Eigen::Quaternionf& q) {
  return exact::normalized({q.w(), q.x(), q.y(), q.z()});
}

constexpr auto kChildren = [] {
  std::array<std::array<std::int8_t, 3>, kBoneCount> children{};
  for (auto& of : children) of.fill(-1);
  for (std::size_t c = 1; c < kBoneCount; ++c) {
    auto& of = children[static_cast<std::size_t>(kBones[c].parent)];
    of[of[0] < 0 ? 0 : of[1] < 0 ? 1 : 2] = static_cast<std::int8_t>(c);
  }
  return children;
}();

double angle_between(const Quat& a, const Quat& b) {
  const Quat d = exact::conj(a) * b;
  return 2.0 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

}  // namespace

TrueBody true_body(const BodyLattice& lattice, const Pose& pose) {
  TrueBody body;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    body.local[b] = to_quat(pose.R_PB[b]);
    if (b == 0) {
      body.global[0] = body.local[0];
      body.joint[0] = {pose.p_WH_m.x(), pose.p_WH_m.y(), pose.p_WH_m.z()};
      continue;
    }
    const auto parent = static_cast<std::size_t>(kBones[b].parent);
    body.global[b] = body.global[parent] * body.local[b];
    body.joint[b] = body.joint[parent] + exact::rotate(body.global[parent], lattice.offset(b));
  }
  for (std::size_t t = 0; t < kTipCount; ++t) {
    const std::size_t b = index_of(kTipBones[t]);
    body.tip[t] = body.joint[b] + exact::rotate(body.global[b], lattice.tip(t));
  }
  return body;
}

BodyError error_of(const BodyLattice& lattice, const TrueBody& truth, const BodyState& body) {
  BodyError error;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const double far = exact::length(body.joint[b] - truth.joint[b]);
    error.joint_m = std::max(error.joint_m, far);
    error.mean_joint_m += far / (kBoneCount + kTipCount);
    error.angle_rad = std::max(error.angle_rad, angle_between(body.global[b], truth.global[b]));
  }
  for (std::size_t t = 0; t < kTipCount; ++t) {
    const std::size_t b = index_of(kTipBones[t]);
    const Vec tip = body.joint[b] + exact::rotate(body.global[b], lattice.tip(t));
    const double far = exact::length(tip - truth.tip[t]);
    error.joint_m = std::max(error.joint_m, far);
    error.mean_joint_m += far / (kBoneCount + kTipCount);
  }
  return error;
}

// The joints and tips that a bone carries, through bones that stand still.
void BodyQuantiser::gather_points(std::size_t bone, const Still& still, const BodyState* base) {
  point_count_ = 0;
  gather_from(bone, {}, {}, still, base);
}

void BodyQuantiser::gather_from(std::size_t bone, const Vec& at, const Quat& turn,
                                const Still& still, const BodyState* base) {
  const std::size_t tip = tip_of(bone);
  if (tip < kTipCount)
    points_[point_count_++] = {at + exact::rotate(turn, lattice_->tip(tip)), truth_->tip[tip],
                               true};
  for (const std::int8_t child : kChildren[bone]) {
    if (child < 0) break;
    const auto c = static_cast<std::size_t>(child);
    const Vec offset = at + exact::rotate(turn, lattice_->offset(c));
    points_[point_count_++] = {offset, truth_->joint[c], false};
    if (still[c])
      gather_from(c, offset, turn * (base ? lattice_->local(c, *base) : truth_->local[c]), still,
                  base);
  }
}

void BodyQuantiser::commit(std::size_t c, std::int32_t n) {
  const double step = lattice_->step(c, options_.level);
  predictor_->decoded(c, n);
  body_.x[c] = step * wrapped(n, lattice_->turn(c, options_.level));
}

// The cheapest of the whole numbers around the target; `weight` is what one step off costs there.
void BodyQuantiser::choose(std::size_t c, double target_steps, double weight, double lambda) {
  const Spread spread = predictor_->predict(c, body_);
  const SymbolLaw law(*bell_, spread);
  // A turn more or less is the same rotation: the one nearest the mean costs least.
  if (const std::int32_t turn = lattice_->turn(c, options_.level); turn != 0) {
    const double mean = static_cast<double>(spread.mean_256) / 256.0;
    target_steps += turn * exact::round_to_whole((mean - target_steps) / turn);
  }
  const auto nearest = static_cast<std::int32_t>(exact::round_to_whole(target_steps));
  const SymbolLaw::Symbol centre = law.find(nearest);
  SymbolLaw::Symbol best = centre;
  double best_bits = law.bits(best);
  const double d0 = nearest - target_steps;
  const double worth = lambda * weight;
  double best_cost = best_bits + worth * d0 * d0;
  // A number further off can but save the bits that there are.
  for (const int way : {-1, 1}) {
    SymbolLaw::Symbol symbol = centre;
    for (int far = 1; far <= 3; ++far) {
      const double d = nearest + way * far - target_steps;
      const double penalty = worth * d * d;
      if (penalty >= best_cost) break;
      symbol = law.beside(symbol, way);
      const double bits = law.bits(symbol);
      if (bits + penalty < best_cost) {
        best = symbol;
        best_bits = bits;
        best_cost = bits + penalty;
      }
    }
  }
  bits_ += best_bits;
  DANCE_ASSERT(choice_count_ < choices_.size());
  choices_[choice_count_++] = {law, best};
  commit(c, best.n);
}

// A bone that came to rest while it was aimed stays where truth has it only when it is aimed again.
bool BodyQuantiser::stands_in(std::size_t bone, const BodyState& base) const {
  return angle_between(lattice_->local(bone, base), truth_->local[bone]) <
         lattice_->step(first_coordinate(bone), options_.level);
}

bool BodyQuantiser::quantise_place(double lambda) {
  const double place[3] = {truth_->joint[0].x, truth_->joint[0].y, truth_->joint[0].z};
  for (std::size_t c = 0; c < 3; ++c) {
    const double step = lattice_->step(c, options_.level);
    const double in_budget = step / options_.error_m;
    choose(c, place[c] / step, 2.0 * in_budget * in_budget, lambda);
  }
  const Vec at{body_.x[0], body_.x[1], body_.x[2]};
  return exact::length(at - truth_->joint[0]) <= options_.inner * options_.error_m;
}

bool BodyQuantiser::is_good(std::size_t bone) const {
  for (const Point& p : points()) {
    const Vec at = body_.joint[bone] + exact::rotate(body_.global[bone], p.offset);
    const Vec off = at - p.truth;
    const double most = (p.is_tip ? 1.0 : options_.inner) * options_.error_m;
    if (exact::dot(off, off) > most * most) return false;
  }
  return std::abs(exact::dot(body_.global[bone], truth_->global[bone])) >= least_dot_;
}

bool BodyQuantiser::quantise_bone(std::size_t bone, bool is_still, double lambda) {
  const std::size_t c = first_coordinate(bone);
  const auto level = options_.level;
  lattice_->seat_bone(bone, body_);
  if (is_still) {
    exact::SwingTwist a;
    if (base_ == nullptr) a = lattice_->angles_of(bone, truth_->local[bone]);
    const double angles[3] = {a.u, a.v, a.w};
    for (std::size_t i = 0; i < 3; ++i) {
      const double target = base_ ? base_->x[c + i] : angles[i];
      choose(c + i, target * lattice_->per_step(c + i, level), 1.0, 1e6);
    }
    lattice_->place_bone(bone, body_);
    return is_good(bone);
  }
  const Vec& joint = body_.joint[bone];
  const Quat& aimed = truth_->global[bone];
  const exact::SwingTwist at = lattice_->angles_in_room(bone, body_, aimed);
  const std::array<Vec, 3> axis = lattice_->axes_in_room(bone, body_, aimed, at);
  // Least squares of  off + Σ δᵢ axisᵢ × r  over the points r, with some resistance of the shell.
  double H[3][3] = {}, g[3] = {};
  const double shell = (lambda > 1e3 ? 0.05 : kShellWeight) * kShellRadius_m * kShellRadius_m;
  for (const Point& p : points()) {
    const Vec r = exact::rotate(aimed, p.offset);
    const Vec off = joint + r - p.truth;
    const Vec J[3] = {exact::cross(axis[0], r), exact::cross(axis[1], r), exact::cross(axis[2], r)};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k <= i; ++k) H[i][k] += exact::dot(J[i], J[k]);
      g[i] += exact::dot(J[i], off);
    }
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k <= i; ++k) H[i][k] += shell * exact::dot(axis[i], axis[k]);
  H[0][1] = H[1][0], H[0][2] = H[2][0], H[1][2] = H[2][1];
  // Eliminates w, then v: what a step of u costs when the others follow it.
  const double b_w[3] = {H[2][0] / H[2][2], H[2][1] / H[2][2], g[2] / H[2][2]};
  const double H00 = H[0][0] - H[0][2] * b_w[0], H01 = H[0][1] - H[0][2] * b_w[1];
  const double H11 = H[1][1] - H[1][2] * b_w[1];
  const double g0 = g[0] - H[0][2] * b_w[2], g1 = g[1] - H[1][2] * b_w[2];
  const double S = H00 - H01 * H01 / H11;
  // Where two of the three turn about the same axis (a swing of half a turn) no aim can be reckoned:
  // there the truth is rounded as it is.
  const double du_aim = -(g0 - H01 * g1 / H11) / S;
  const bool can_aim =
      std::abs(du_aim) < kFarthestAim_rad && S > 1e-4 * shell && H11 > 1e-4 * shell;
  const double du = can_aim ? du_aim : 0.0;

  const double step[3] = {lattice_->step(c, level), lattice_->step(c + 1, level),
                          lattice_->step(c + 2, level)};
  const double per_budget = 1.0 / (options_.error_m * options_.error_m);
  choose(c, (at.u + du) / step[0], (can_aim ? S : H[0][0]) * step[0] * step[0] * per_budget,
         lambda);
  const double did_u = choices_[choice_count_ - 1].symbol.n * step[0] - at.u;
  const double dv = can_aim ? -(g1 + H01 * did_u) / H11 : 0.0;
  choose(c + 1, (at.v + dv) / step[1], (can_aim ? H11 : H[1][1]) * step[1] * step[1] * per_budget,
         lambda);
  const double did_v = choices_[choice_count_ - 1].symbol.n * step[1] - at.v;
  const double dw = can_aim ? -(g[2] + H[2][0] * did_u + H[2][1] * did_v) / H[2][2] : 0.0;
  choose(c + 2, (at.w + dw) / step[2], H[2][2] * step[2] * step[2] * per_budget, lambda);
  lattice_->place_bone(bone, body_);
  return is_good(bone);
}

bool BodyQuantiser::quantise(const BodyLattice& lattice, BodyPredictor& predictor,
                             const BellShape& bell, const TrueBody& truth, const Still& still,
                             const BodyState* base, const QuantiseOptions& options) {
  lattice_ = &lattice;
  predictor_ = &predictor;
  bell_ = &bell;
  truth_ = &truth;
  base_ = base;
  still_ = still;
  options_ = options;
  if (base != nullptr)
    for (std::size_t bone = 0; bone < kBoneCount; ++bone)
      still_[bone] = still_[bone] && stands_in(bone, *base);
  options_ = options;
  choice_count_ = 0;
  bits_ = 0.0;
  least_dot_ = std::cos(0.5 * angle_budget_rad(options.error_m));
  if (!quantise_place(options.lambda)) {
    choice_count_ = 0;
    bits_ = 0.0;
    predictor.forget();
    if (!quantise_place(1e6)) return false;
  }
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    gather_points(bone, still_, base);
    const double bits = bits_;
    const std::size_t count = choice_count_;
    const exact::Four mood = predictor.mood();
    bool is_still = still_[bone];
    bool is_good = false;
    double lambda = options.lambda;
    for (int attempt = 0; attempt < 4 && !is_good; ++attempt) {
      bits_ = bits;
      choice_count_ = count;
      predictor.set_mood(mood);
      is_good = quantise_bone(bone, is_still, lambda);
      if (is_still)
        is_still = false;
      else
        lambda = attempt == 1 ? 1e6 : lambda * 4.0;
    }
    if (!is_good) return false;
  }
  return true;
}

}  // namespace dance
