#include "research/trackers/standing_take.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/smooth_step.h"
#include "core/motion/leg_reach.h"
#include "core/pose/heading.h"
#include "core/pose/kinematics.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

float between(Random& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

// A value that goes to one place after the other, and rests there for a while.
class Wanderer {
 public:
  Wanderer(float spread, float calm_s) : spread_(spread), calm_s_(calm_s) {}

  float step(float dt_s, Random& random) {
    left_s_ -= dt_s;
    if (left_s_ <= 0.0f) {
      to_ = spread_ * std::clamp(static_cast<float>(random.normal()), -2.0f, 2.0f);
      left_s_ = calm_s_ * between(random, 0.4, 1.8);
    }
    // Critically damped.
    const float w = 5.0f / calm_s_;
    speed_ += dt_s * (w * w * (to_ - value_) - 2.0f * w * speed_);
    value_ += dt_s * speed_;
    return value_;
  }

 private:
  float spread_, calm_s_;
  float value_ = 0.0f, speed_ = 0.0f, to_ = 0.0f, left_s_ = 0.0f;
};

struct FloorSpot {
  float x = 0.0f, z = 0.0f, heading = 0.0f;

  Vector3f at(float right, float forward) const {
    return Vector3f(x, 0.0f, z) + about_up(heading) * Vector3f(right, 0.0f, forward);
  }
};

// Where the body is to be, over the floor.
class FloorWay {
 public:
  FloorSpot step(float dt_s, Random& random) {
    left_s_ -= dt_s;
    if (left_s_ <= 0.0f) choose(random);
    const float turn = std::clamp(std::remainder(heading_ - spot_.heading, kRound), -1.0f, 1.0f);
    spot_.heading += dt_s * 2.2f * turn;
    const float away = std::hypot(x_ - spot_.x, z_ - spot_.z);
    const float wanted = std::min(pace_m_s_, 1.5f * away);
    speed_ += std::clamp(wanted - speed_, -1.6f * dt_s, 1.6f * dt_s);
    if (away > 1e-3f) {
      const float share = std::min(1.0f, dt_s * speed_ / away);
      velocity_ = Vector3f(x_ - spot_.x, 0.0f, z_ - spot_.z) * (share / dt_s);
      spot_.x += share * (x_ - spot_.x);
      spot_.z += share * (z_ - spot_.z);
    }
    return spot_;
  }
  const Vector3f& velocity() const { return velocity_; }

 private:
  static constexpr float kRound = 2.0f * std::numbers::pi_v<float>;

  void choose(Random& random) {
    const double draw = random.uniform();
    left_s_ = between(random, 1.5, 6.0);
    if (draw < 0.5) return;  // stands on
    heading_ = spot_.heading + between(random, -2.0, 2.0);
    if (draw < 0.75) return;  // turns on the spot
    pace_m_s_ = between(random, 0.4, 1.1);
    const float far = between(random, 0.2, 1.6);
    // Forwards mostly, and now and then aside or back.
    const float aside = random.uniform() < 0.7 ? 0.0f : between(random, -3.0, 3.0);
    x_ = std::clamp(spot_.x + far * std::sin(heading_ + aside), -1.5f, 1.5f);
    z_ = std::clamp(spot_.z + far * std::cos(heading_ + aside), -1.5f, 1.5f);
  }

  FloorSpot spot_;
  float x_ = 0.0f, z_ = 0.0f, heading_ = 0.0f;
  float pace_m_s_ = 0.8f, speed_ = 0.0f, left_s_ = 2.0f;
  Vector3f velocity_ = Vector3f::Zero();
};

// Two feet that stand, and step one after the other when they are no longer under the body.
class SteppingFeet {
 public:
  struct Foot {
    Vector3f place = Vector3f::Zero();  // below the ankle, on the floor
    float heading = 0.0f;
    Vector3f from = Vector3f::Zero(), to = Vector3f::Zero();
    float from_heading = 0.0f, to_heading = 0.0f;
    float lift_m = 0.0f, pitch_rad = 0.0f;
    float done = 1.0f;  // of the step
    float toes_out_rad = 0.1f;
  };

  explicit SteppingFeet(Random& random) {
    for (std::size_t side = 0; side < 2; ++side) {
      Foot& foot = feet_[side];
      foot.toes_out_rad = between(random, -0.05, 0.35);
      foot.place = wanted({}, Vector3f::Zero(), side);
      foot.heading = outwards(side);
    }
  }

  void step(const FloorSpot& body, const Vector3f& velocity, float dt_s, Random& random) {
    for (Foot& foot : feet_) swing(foot, dt_s);
    if (feet_[0].done < 1.0f || feet_[1].done < 1.0f) return;
    std::size_t worse = 0;
    std::array<float, 2> off{};
    for (std::size_t side = 0; side < 2; ++side) {
      const Vector3f to = wanted(body, velocity, side);
      const float turned = std::remainder(body.heading + outwards(side) - feet_[side].heading,
                                          2.0f * std::numbers::pi_v<float>);
      off[side] = (to - feet_[side].place).norm() + 0.25f * std::abs(turned);
      if (off[side] > off[worse]) worse = side;
    }
    const bool walks = velocity.norm() > 0.15f;
    if (off[worse] < (walks ? 0.12f : 0.16f)) return;
    begin(worse, body, velocity, random);
  }

  const Foot& operator[](std::size_t side) const { return feet_[side]; }
  float stance_m = 0.11f;  // of a foot, from the middle

 private:
  static float outwards(std::size_t side, float toes_out_rad) {
    return side == 0 ? toes_out_rad : -toes_out_rad;
  }
  float outwards(std::size_t side) const { return outwards(side, feet_[side].toes_out_rad); }
  Vector3f wanted(const FloorSpot& body, const Vector3f& velocity, std::size_t side) const {
    return body.at(side == 0 ? stance_m : -stance_m, 0.0f) + 0.28f * velocity;
  }
  void begin(std::size_t side, const FloorSpot& body, const Vector3f& velocity, Random& random) {
    Foot& foot = feet_[side];
    foot.from = foot.place;
    foot.from_heading = foot.heading;
    foot.to = wanted(body, velocity, side) +
              Vector3f(between(random, -0.03, 0.03), 0.0f, between(random, -0.03, 0.03));
    foot.to_heading = body.heading + outwards(side);
    foot.done = 0.0f;
    duration_s_ = between(random, 0.32, 0.5);
    lift_m_ = between(random, 0.03, 0.09);
  }
  void swing(Foot& foot, float dt_s) const {
    if (foot.done >= 1.0f) return;
    foot.done = std::min(1.0f, foot.done + dt_s / duration_s_);
    const float share = smooth_step(foot.done);
    foot.place = foot.from + share * (foot.to - foot.from);
    foot.heading = foot.from_heading + share * std::remainder(foot.to_heading - foot.from_heading,
                                                              2.0f * std::numbers::pi_v<float>);
    const float arc = std::sin(std::numbers::pi_v<float> * foot.done);
    foot.lift_m = lift_m_ * arc;
    foot.pitch_rad = 0.5f * arc * (1.0f - 1.4f * foot.done);
  }

  std::array<Foot, 2> feet_;
  float duration_s_ = 0.4f, lift_m_ = 0.06f;
};

// Where a hand is, from the chest: hanging, before the belly, held up, on the hips.
Vector3f hand_place(Random& random) {
  constexpr std::array<std::array<float, 3>, 6> kPlaces{{{0.28f, -0.62f, 0.05f},
                                                         {0.26f, -0.60f, 0.12f},
                                                         {0.18f, -0.30f, 0.34f},
                                                         {0.30f, -0.12f, 0.36f},
                                                         {0.24f, -0.36f, 0.04f},
                                                         {0.45f, 0.10f, 0.25f}}};
  const auto& place = kPlaces[random.uniform() < 0.55 ? random.below(3) : random.below(6)];
  return {place[0] + between(random, -0.05, 0.05), place[1] + between(random, -0.06, 0.06),
          place[2] + between(random, -0.05, 0.05)};
}

class StandingArm {
 public:
  StandingArm(std::size_t side, Random& random) : side_(side), to_(hand_place(random)), at_(to_) {}

  void step(const Skeleton& body, float grows, float dt_s, Random& random, Pose& pose,
            BodyFrames& frames) {
    left_s_ -= dt_s;
    if (left_s_ <= 0.0f) {
      to_ = hand_place(random);
      left_s_ = between(random, 1.0, 6.0);
    }
    speed_ += dt_s * (36.0f * (to_ - at_) - 12.0f * speed_);
    at_ += dt_s * speed_;
    const bool is_left = side_ == 0;
    const Limb& limb = is_left ? kLeftArm : kRightArm;
    const float out = is_left ? 1.0f : -1.0f;
    const Quaternionf& chest = frames.R_WB[index_of(Bone::kUpperChest)];
    const Vector3f target = frames.position(Bone::kUpperChest) +
                            chest * (grows * Vector3f(out * at_.x(), at_.y() + 0.1f, at_.z()));
    const Vector3f pole = chest * Vector3f(0.35f * out, -0.5f, -0.8f);
    solve_two_bone(body, limb, target, pole, Quaternionf::Identity(), pose, frames);
    const float bend = bend_.step(dt_s, random), spread = spread_.step(dt_s, random),
                twist = twist_.step(dt_s, random);
    pose.R_PB[index_of(limb.end)] = (Quaternionf(AngleAxisf(bend, Vector3f::UnitZ())) *
                                     Quaternionf(AngleAxisf(spread, Vector3f::UnitY())) *
                                     Quaternionf(AngleAxisf(twist, Vector3f::UnitX())))
                                        .normalized();
  }

 private:
  std::size_t side_;
  Vector3f to_, at_, speed_ = Vector3f::Zero();
  float left_s_ = 1.0f;
  Wanderer bend_{0.25f, 1.0f}, spread_{0.15f, 1.0f}, twist_{0.5f, 1.5f};
};

// Three turns of one bone, or of the hips.
class BoneLean {
 public:
  BoneLean(float pitch, float yaw, float roll, float calm_s)
      : pitch_(pitch, calm_s), yaw_(yaw, calm_s), roll_(roll, calm_s) {}
  Quaternionf step(float dt_s, Random& random) {
    const float pitch = pitch_.step(dt_s, random), yaw = yaw_.step(dt_s, random),
                roll = roll_.step(dt_s, random);
    return (Quaternionf(AngleAxisf(yaw, Vector3f::UnitY())) *
            Quaternionf(AngleAxisf(pitch, Vector3f::UnitX())) *
            Quaternionf(AngleAxisf(roll, Vector3f::UnitZ())))
        .normalized();
  }

 private:
  Wanderer pitch_, yaw_, roll_;
};

class Stander {
 public:
  Stander(float height_m, Random& random)
      : body_(average_skeleton(height_m)),
        grows_(height_m / 1.72f),
        feet_(random),
        arms_{StandingArm(0, random), StandingArm(1, random)} {
    feet_.stance_m = grows_ * between(random, 0.08, 0.15);
  }

  const Skeleton& body() const { return body_; }

  Pose step(float dt_s, Random& random) {
    const FloorSpot spot = way_.step(dt_s, random);
    feet_.step(spot, way_.velocity(), dt_s, random);
    Pose pose;
    // On one leg more than on the other, and on the one that stands while the other steps.
    const Vector3f middle = 0.5f * (feet_[0].place + feet_[1].place);
    float weight = shift_.step(dt_s, random);
    for (std::size_t side = 0; side < 2; ++side)
      if (feet_[side].done < 1.0f)
        carries_ += dt_s * 6.0f * ((side == 0 ? -0.5f : 0.5f) - carries_);
    if (feet_[0].done >= 1.0f && feet_[1].done >= 1.0f) carries_ -= dt_s * 4.0f * carries_;
    weight = std::clamp(weight + carries_, -0.8f, 0.8f);
    const Vector3f over = middle + 0.5f * weight * (feet_[0].place - feet_[1].place);
    const float forward = grows_ * (0.02f + ahead_.step(dt_s, random));
    pose.p_WH_m = 0.65f * over + 0.35f * spot.at(0.0f, 0.0f) +
                  about_up(spot.heading) * Vector3f(0.0f, 0.0f, forward);
    const float apart = (feet_[0].place - feet_[1].place).norm();
    pose.p_WH_m.y() = body_.hips_height_m() -
                      grows_ * (0.012f + 0.1f * apart * apart + std::abs(low_.step(dt_s, random)));
    const float between_feet = 0.5f * (feet_[0].heading + feet_[1].heading);
    const float heading = spot.heading + 0.5f * std::remainder(between_feet - spot.heading,
                                                               2.0f * std::numbers::pi_v<float>);
    pose.R_PB[0] = about_up(heading) * hips_.step(dt_s, random);
    for (std::size_t i = 0; i < spine_.size(); ++i)
      pose.R_PB[index_of(Bone::kSpine) + i] = spine_[i].step(dt_s, random);
    BodyFrames frames;
    forward_kinematics(body_, pose, frames);
    stand(pose, frames);
    for (StandingArm& arm : arms_) arm.step(body_, grows_, dt_s, random, pose, frames);
    return pose;
  }

 private:
  void stand(Pose& pose, BodyFrames& frames) {
    const BodyFrames like = frames;
    for (std::size_t side = 0; side < 2; ++side) {
      const Limb& leg = side == 0 ? kLeftLeg : kRightLeg;
      const SteppingFeet::Foot& foot = feet_[side];
      const float ankle_m = body_.hips_height_m() + body_.offset(leg.upper).y() +
                            body_.offset(leg.lower).y() + body_.offset(leg.end).y();
      const Quaternionf R =
          about_up(foot.heading) * Quaternionf(AngleAxisf(foot.pitch_rad, Vector3f::UnitX()));
      const Vector3f ankle =
          foot.place +
          Vector3f(0.0f, ankle_m + foot.lift_m + 0.1f * std::abs(foot.pitch_rad), 0.0f);
      reach_ankle(body_, leg, like, ankle, R, pose, frames);
    }
  }

  Skeleton body_;
  float grows_;
  FloorWay way_;
  SteppingFeet feet_;
  std::array<StandingArm, 2> arms_;
  Wanderer shift_{0.35f, 2.5f}, ahead_{0.02f, 2.0f}, low_{0.015f, 3.0f};
  float carries_ = 0.0f;
  BoneLean hips_{0.04f, 0.06f, 0.04f, 2.0f};
  // Spine, chest, upper chest, neck, head.
  std::array<BoneLean, 5> spine_{
      BoneLean(0.05f, 0.05f, 0.04f, 2.0f), BoneLean(0.04f, 0.06f, 0.03f, 2.0f),
      BoneLean(0.04f, 0.06f, 0.03f, 2.0f), BoneLean(0.10f, 0.20f, 0.06f, 1.2f),
      BoneLean(0.16f, 0.25f, 0.07f, 1.0f)};
};

}  // namespace

PredictTake standing_take(float height_m, double hz, double seconds, Random& random) {
  Stander stander(height_m, random);
  PredictTake take;
  take.name = "standing about";
  take.skeleton = stander.body();
  take.hz = hz;
  const auto dt_s = static_cast<float>(1.0 / hz);
  const auto frames = static_cast<std::size_t>(seconds * hz);
  for (std::size_t i = 0; i < frames; ++i) {
    Pose pose = stander.step(dt_s, random);
    normalize(pose);
    pose.capture_time = MonoTime() + Duration::seconds(1.0 + static_cast<double>(i) / hz);
    take.poses.push_back(pose);
  }
  return take;
}

}  // namespace dance
