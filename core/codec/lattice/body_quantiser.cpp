#include "core/codec/lattice/body_quantiser.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace dance {
namespace {

using exact::Quat;
using exact::Vec;

// Weight of the skin's rotation beside the joints.
constexpr double kShellWeight = 0.3;
// A correction is some millimetres at the end of a bone.
constexpr double kFarthestAim_rad = 0.3;
// No skipping at the price of an error.
constexpr double kDear = 1e6;

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

BodyError error_of(const BodyLattice& lattice, const TrueBody& truth,
                   const LatticeBodyState& body) {
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

// The joints and tips that a bone carries, through still bones.
void BodyQuantiser::gather_points(std::size_t bone) {
  point_count_ = 0;
  const Vec& joint = truth_->joint[bone];
  const auto add = [&](const Vec& offset, const Vec& truth, bool is_tip) {
    Point& p = points_[point_count_++];
    p.offset = offset;
    p.arm = truth - joint;
    p.truth = truth;
    p.is_tip = is_tip;
  };
  if (const std::size_t tip = tip_of(bone); tip < kTipCount)
    add(lattice_->tip(tip), truth_->tip[tip], true);
  for (const std::int8_t child : kChildren[bone]) {
    if (child < 0) break;
    const auto c = static_cast<std::size_t>(child);
    add(lattice_->offset(c), truth_->joint[c], false);
    if (still_[c]) gather_beyond(c, bone, lattice_->offset(c), {});
  }
}

// `at` is where the bone's joint is, and `turn` how its parent is turned, in the root's frame.
void BodyQuantiser::gather_beyond(std::size_t bone, std::size_t root, const Vec& at,
                                  const Quat& turn) {
  const Quat turned = turn * still_local_[bone];
  const auto add = [&](const Vec& offset, const Vec& truth, bool is_tip) {
    Point& p = points_[point_count_++];
    p.offset = offset;
    p.arm = exact::rotate(truth_->global[root], offset);
    p.truth = truth;
    p.is_tip = is_tip;
  };
  if (const std::size_t tip = tip_of(bone); tip < kTipCount)
    add(at + exact::rotate(turned, lattice_->tip(tip)), truth_->tip[tip], true);
  for (const std::int8_t child : kChildren[bone]) {
    if (child < 0) break;
    const auto c = static_cast<std::size_t>(child);
    const Vec offset = at + exact::rotate(turned, lattice_->offset(c));
    add(offset, truth_->joint[c], false);
    if (still_[c]) gather_beyond(c, root, offset, turned);
  }
}

// The cheapest of the whole numbers around the target; `weight` is the cost of one step off.
[[gnu::always_inline]] inline double BodyQuantiser::choose(std::size_t first, std::size_t axis,
                                                           double target_steps, double weight,
                                                           double lambda) {
  const std::size_t c = first + axis;
  const Spread spread = predictor_->predict_axis(first, axis, body_);
  const SymbolDistribution distribution(*table_, spread);
  const std::int32_t turn = steps_->turn[c];
  // A turn more or less is the same rotation: the one nearest the mean costs least.
  if (axis == 2 && turn != 0) {
    const double off = static_cast<double>(spread.mean_256) / 256.0 - target_steps;
    if (std::abs(off) > 0.5 * turn) target_steps += turn * exact::round_to_whole(off / turn);
  }
  const auto nearest = static_cast<std::int32_t>(std::lrint(target_steps));
  SymbolDistribution::Symbol best = distribution.find(nearest);
  double best_bits = distribution.bits(best);
  const double d0 = nearest - target_steps;
  const double worth = lambda * weight;
  double best_cost = best_bits + worth * d0 * d0;
  // A number further off can save at most these bits.
  if (const int way = distribution.cheaper_way(best); way != 0) {
    SymbolDistribution::Symbol symbol = best;
    for (int far = 1; far <= 3; ++far) {
      const double d = d0 + way * far;
      const double penalty = worth * d * d;
      if (penalty >= best_cost) break;
      symbol = distribution.beside(symbol, way);
      const double bits = distribution.bits(symbol);
      if (bits + penalty < best_cost) {
        best = symbol;
        best_bits = bits;
        best_cost = bits + penalty;
      }
    }
  }
  bits_ += best_bits;
  DANCE_ASSERT(choice_count_ < choices_.size());
  choices_[choice_count_++] = {distribution, best};
  predictor_->decoded(c, best.n);
  const std::int32_t n = axis == 2 ? wrapped(best.n, turn) : best.n;
  body_.x[c] = steps_->step[c] * n;
  return steps_->step[c] * best.n;
}

// A bone that comes to rest while aimed reaches its true place only when aimed again.
bool BodyQuantiser::stands_in(std::size_t bone) const {
  const Quat off = exact::conj(still_local_[bone]) * truth_->local[bone];
  const double half_step = 0.5 * steps_->step[first_coordinate(bone)];
  return off.x * off.x + off.y * off.y + off.z * off.z < half_step * half_step;
}

bool BodyQuantiser::quantise_place(double lambda) {
  const Vec& place = truth_->joint[0];
  const double in_budget = steps_->step[0] / options_.error_m;
  const double weight = 2.0 * in_budget * in_budget;
  predictor_->look_at(0, body_);
  choose(0, 0, place.x * steps_->per_step[0], weight, lambda);
  choose(0, 1, place.y * steps_->per_step[1], weight, lambda);
  choose(0, 2, place.z * steps_->per_step[2], weight, lambda);
  const Vec at{body_.x[0], body_.x[1], body_.x[2]};
  return exact::length(at - place) <= options_.inner * options_.error_m;
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

bool BodyQuantiser::keep_bone(std::size_t bone) {
  const std::size_t c = first_coordinate(bone);
  lattice_->seat_bone(bone, body_);
  predictor_->look_at(c, body_);
  exact::SwingTwist at;
  if (base_ != nullptr)
    at = {base_->x[c], base_->x[c + 1], base_->x[c + 2]};
  else
    at = lattice_->angles_of(bone, truth_->local[bone]);
  choose(c, 0, at.u * steps_->per_step[c], 1.0, kDear);
  choose(c, 1, at.v * steps_->per_step[c + 1], 1.0, kDear);
  choose(c, 2, at.w * steps_->per_step[c + 2], 1.0, kDear);
  lattice_->place_bone(bone, body_);
  return is_good(bone);
}

bool BodyQuantiser::aim_bone(std::size_t bone, double lambda) {
  const std::size_t c = first_coordinate(bone);
  lattice_->seat_bone(bone, body_);
  predictor_->look_at(c, body_);
  const Quat& aimed = truth_->global[bone];
  const Quat from_room = lattice_->from_room(bone, body_, aimed);
  const auto [at, axes] = exact::nearly_swing_twist(lattice_->turn_of(bone, from_room, aimed));
  // Least squares of  off + Σ δᵢ axisᵢ × r  over the points r, with some stiffness of the skin: Hᵢₖ
  // = Σ (axisᵢ × r) · (axisₖ × r), gᵢ = Σ (axisᵢ × r) · off, by dot products.
  double uu = 0.0, uv = 0.0, uw = 0.0, vv = 0.0, vw = 0.0, ww = 0.0;
  double r2 = (lambda > 1e3 ? 0.05 : kShellWeight) * kShellRadius_m * kShellRadius_m;
  const double shell = r2;
  Vec torque;
  for (const Point& p : points()) {
    const Vec off = body_.joint[bone] + p.arm - p.truth;
    torque = torque + exact::cross(p.arm, off);
    r2 += exact::dot(p.arm, p.arm);
    const Vec r = exact::rotate(from_room, p.arm);
    const double u = exact::dot(axes.u, r), v = exact::dot(axes.v, r), w = exact::dot(axes.w, r);
    uu += u * u, uv += u * v, uw += u * w, vv += v * v, vw += v * w, ww += w * w;
  }
  // The hips' coordinates are those of the inverse.
  torque = (bone == 0 ? -1.0 : 1.0) * exact::rotate(from_room, torque);
  const double H_uu = r2 * exact::dot(axes.u, axes.u) - uu;
  const double H_uv = r2 * exact::dot(axes.u, axes.v) - uv;
  const double H_uw = r2 * exact::dot(axes.u, axes.w) - uw;
  const double H_vv = r2 * exact::dot(axes.v, axes.v) - vv;
  const double H_vw = r2 * exact::dot(axes.v, axes.w) - vw;
  const double H_ww = r2 * exact::dot(axes.w, axes.w) - ww;
  const double g_u = exact::dot(axes.u, torque), g_v = exact::dot(axes.v, torque),
               g_w = exact::dot(axes.w, torque);
  // Solves for u by cofactors; S is what a step of u costs when the others follow it, T one of v
  // when w does.
  const double C_u = H_vv * H_ww - H_vw * H_vw, C_v = H_uw * H_vw - H_uv * H_ww,
               C_w = H_uv * H_vw - H_vv * H_uw;
  const double det = H_uu * C_u + H_uv * C_v + H_uw * C_w;
  const double du_aim = -(C_u * g_u + C_v * g_v + C_w * g_w) / det;
  const double per_ww = 1.0 / H_ww;
  const double S = det / C_u, T = C_u * per_ww;
  // Where two of the three axes coincide (a swing of half a turn) the system is singular: the true
  // coordinates are rounded.
  const bool can_aim = std::abs(du_aim) < kFarthestAim_rad && S > 1e-4 * shell && T > 1e-4 * shell;
  const double du = can_aim ? du_aim : 0.0;

  const double *step = &steps_->step[c], *per_step = &steps_->per_step[c];
  const double per_budget = 1.0 / (options_.error_m * options_.error_m);
  const double swing_weight = step[0] * step[0] * per_budget;
  const double did_u =
      choose(c, 0, (at.u + du) * per_step[0], (can_aim ? S : H_uu) * swing_weight, lambda) - at.u;
  const double dv =
      can_aim ? -((g_v - H_vw * g_w * per_ww) + (H_uv - H_uw * H_vw * per_ww) * did_u) / T : 0.0;
  const double did_v =
      choose(c, 1, (at.v + dv) * per_step[1], (can_aim ? T : H_vv) * swing_weight, lambda) - at.v;
  const double dw = can_aim ? -(g_w + H_uw * did_u + H_vw * did_v) * per_ww : 0.0;
  choose(c, 2, (at.w + dw) * per_step[2], H_ww * step[2] * step[2] * per_budget, lambda);
  lattice_->place_bone(bone, body_);
  return is_good(bone);
}

bool BodyQuantiser::quantise(const BodyLattice& lattice, BodyPredictor& predictor,
                             const DistributionTable& table, const TrueBody& truth,
                             const Still& still, const ReferenceBody* base,
                             const QuantiseOptions& options) {
  lattice_ = &lattice;
  predictor_ = &predictor;
  table_ = &table;
  truth_ = &truth;
  base_ = base;
  still_ = still;
  options_ = options;
  steps_ = &lattice.steps(options.level);
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    if (!still_[bone]) continue;
    still_local_[bone] = base != nullptr ? lattice.rotation_of(bone, *base) : truth.local[bone];
    still_[bone] = stands_in(bone);
  }
  choice_count_ = 0;
  bits_ = 0.0;
  least_dot_ = std::cos(0.5 * angle_budget_rad(options.error_m));
  if (!quantise_place(options.lambda)) {
    choice_count_ = 0;
    bits_ = 0.0;
    predictor.forget();
    if (!quantise_place(kDear)) return false;
  }
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    gather_points(bone);
    const double bits = bits_;
    const std::size_t count = choice_count_;
    const BodyPredictor::Mood mood = predictor.mood();
    bool is_still = still_[bone];
    bool is_good = false;
    double lambda = options.lambda;
    for (int attempt = 0; attempt < 4 && !is_good; ++attempt) {
      bits_ = bits;
      choice_count_ = count;
      predictor.set_mood(mood);
      is_good = is_still ? keep_bone(bone) : aim_bone(bone, lambda);
      if (is_still)
        is_still = false;
      else
        lambda = attempt == 1 ? kDear : lambda * 4.0;
    }
    if (!is_good) return false;
  }
  return true;
}

}  // namespace dance
