#include "testing/camera/scene_network.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dance {

using Eigen::Vector3d;

namespace {

// Where the network has its points on a body 1.72 m tall, metres: a table of its own, so that the
// solver is not judged by what it believes.
struct Place {
  Landmark left, right;
  Bone on_left, on_right;
  double x, y, z;
};
constexpr Place kPlaces[]{
    {Landmark::kNose, Landmark::kNose, Bone::kHead, Bone::kHead, 0.0, 0.06, 0.12},
    {Landmark::kLeftEyeInner, Landmark::kRightEyeInner, Bone::kHead, Bone::kHead, 0.016, 0.095,
     0.1},
    {Landmark::kLeftEye, Landmark::kRightEye, Bone::kHead, Bone::kHead, 0.031, 0.096, 0.093},
    {Landmark::kLeftEyeOuter, Landmark::kRightEyeOuter, Bone::kHead, Bone::kHead, 0.045, 0.095,
     0.085},
    {Landmark::kLeftEar, Landmark::kRightEar, Bone::kHead, Bone::kHead, 0.072, 0.075, 0.0},
    {Landmark::kMouthLeft, Landmark::kMouthRight, Bone::kHead, Bone::kHead, 0.024, 0.025, 0.1},
    {Landmark::kLeftShoulder, Landmark::kRightShoulder, Bone::kLeftUpperArm, Bone::kRightUpperArm,
     0.0, 0.0, 0.0},
    {Landmark::kLeftElbow, Landmark::kRightElbow, Bone::kLeftLowerArm, Bone::kRightLowerArm, 0.0,
     0.0, 0.0},
    {Landmark::kLeftWrist, Landmark::kRightWrist, Bone::kLeftHand, Bone::kRightHand, 0.0, 0.0, 0.0},
    {Landmark::kLeftPinky, Landmark::kRightPinky, Bone::kLeftHand, Bone::kRightHand, 0.075, -0.004,
     -0.03},
    {Landmark::kLeftIndex, Landmark::kRightIndex, Bone::kLeftHand, Bone::kRightHand, 0.09, -0.002,
     0.022},
    {Landmark::kLeftThumb, Landmark::kRightThumb, Bone::kLeftHand, Bone::kRightHand, 0.05, -0.015,
     0.045},
    {Landmark::kLeftHip, Landmark::kRightHip, Bone::kLeftUpperLeg, Bone::kRightUpperLeg, 0.0, 0.0,
     0.0},
    {Landmark::kLeftKnee, Landmark::kRightKnee, Bone::kLeftLowerLeg, Bone::kRightLowerLeg, 0.0, 0.0,
     0.0},
    {Landmark::kLeftAnkle, Landmark::kRightAnkle, Bone::kLeftFoot, Bone::kRightFoot, 0.0, 0.0, 0.0},
    {Landmark::kLeftHeel, Landmark::kRightHeel, Bone::kLeftFoot, Bone::kRightFoot, 0.0, -0.048,
     0.01},
};
// The toe's point, from the toes' joint.
constexpr double kToeUp_m = 0.012, kToeBefore_m = 0.015;
constexpr double kReferenceBody_m = 1.72;

// The network tells a body from the hips outwards: which limb hangs on which.
constexpr std::array<int, kLandmarkCount> kHangsOn = [] {
  std::array<int, kLandmarkCount> on{};
  const auto hang = [&on](Landmark l, Landmark parent) {
    on[index_of(l)] = static_cast<int>(index_of(parent));
    on[index_of(l) + 1] = static_cast<int>(index_of(parent)) + 1;
  };
  // −1: the middle of the hips; −2: of the shoulders.
  for (std::size_t i = 0; i <= index_of(Landmark::kMouthRight); ++i) on[i] = -2;
  on[index_of(Landmark::kLeftHip)] = on[index_of(Landmark::kRightHip)] = -1;
  on[index_of(Landmark::kLeftShoulder)] = on[index_of(Landmark::kRightShoulder)] = -2;
  hang(Landmark::kLeftElbow, Landmark::kLeftShoulder);
  hang(Landmark::kLeftWrist, Landmark::kLeftElbow);
  for (const Landmark l : {Landmark::kLeftPinky, Landmark::kLeftIndex, Landmark::kLeftThumb})
    hang(l, Landmark::kLeftWrist);
  hang(Landmark::kLeftKnee, Landmark::kLeftHip);
  hang(Landmark::kLeftAnkle, Landmark::kLeftKnee);
  hang(Landmark::kLeftHeel, Landmark::kLeftAnkle);
  hang(Landmark::kLeftFootIndex, Landmark::kLeftAnkle);
  return on;
}();

// Parts that go out of sight together: both arms from the elbow, both legs from the knee.
constexpr std::array<std::array<Landmark, 5>, 4> kHiding{{
    {Landmark::kLeftElbow, Landmark::kLeftWrist, Landmark::kLeftPinky, Landmark::kLeftIndex,
     Landmark::kLeftThumb},
    {Landmark::kRightElbow, Landmark::kRightWrist, Landmark::kRightPinky, Landmark::kRightIndex,
     Landmark::kRightThumb},
    {Landmark::kLeftKnee, Landmark::kLeftAnkle, Landmark::kLeftHeel, Landmark::kLeftFootIndex,
     Landmark::kLeftFootIndex},
    {Landmark::kRightKnee, Landmark::kRightAnkle, Landmark::kRightHeel, Landmark::kRightFootIndex,
     Landmark::kRightFootIndex},
}};

// The same point of the other side.
constexpr std::size_t mirrored(std::size_t i) {
  if (i == index_of(Landmark::kNose)) return i;
  if (i >= index_of(Landmark::kLeftEar)) return i % 2 ? i + 1 : i - 1;
  return i < index_of(Landmark::kRightEyeInner) ? i + 3 : i - 3;
}

}  // namespace

void SceneNetwork::hide() {
  is_hidden_.fill(false);
  for (std::size_t part = 0; part < kHiding.size(); ++part) {
    hidden_s_[part] -= 1.0 / hz_;
    if (hidden_s_[part] <= 0.0 && random_.uniform() < errors_.hidden_per_s / hz_)
      hidden_s_[part] = -errors_.hidden_for_s * std::log(1.0 - random_.uniform());
    if (hidden_s_[part] > 0.0)
      for (const Landmark l : kHiding[part]) is_hidden_[index_of(l)] = true;
  }
}

void SceneNetwork::draw_flip(const std::array<Vector3d, kLandmarkCount>& p_C_m) {
  if (!(errors_.flips_per_s > 0.0)) return;
  // Seen from behind, the left hip is on the left of the picture.
  const bool is_back =
      p_C_m[index_of(Landmark::kLeftHip)].x() < p_C_m[index_of(Landmark::kRightHip)].x();
  flipped_s_ = is_back ? std::max(0.0, flipped_s_ - 1.0 / hz_) : 0.0;
  if (!is_back || flipped_s_ > 0.0 || random_.uniform() >= errors_.flips_per_s / hz_) return;
  flipped_s_ = std::clamp(-errors_.flip_for_s * std::log(1.0 - random_.uniform()), 1.0 / hz_,
                          errors_.flip_most_s);
  is_depth_reversed_ = random_.uniform() < 0.5;
}

void SceneNetwork::flip(BodyLandmarks& out) const {
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const std::size_t other = mirrored(i);
    if (other > i) {
      std::swap(out.image_px[i], out.image_px[other]);
      std::swap(out.world_m[i], out.world_m[other]);
      std::swap(out.visibility[i], out.visibility[other]);
    }
    if (is_depth_reversed_) out.world_m[i].z() = -out.world_m[i].z();
  }
}

void SceneNetwork::write_world(const std::array<Vector3d, kLandmarkCount>& p_C_m,
                               BodyLandmarks& out) const {
  const auto middle = [&p_C_m](Landmark left) {
    return Vector3d(0.5 * (p_C_m[index_of(left)] + p_C_m[index_of(left) + 1]));
  };
  const Vector3d hips = middle(Landmark::kLeftHip), shoulders = middle(Landmark::kLeftShoulder);
  const auto wrong = [&](const Vector3d& bone, const LastingError& turn,
                         const LastingError& stretch) {
    const Vector3d sd(errors_.aside_sd, errors_.aside_sd, errors_.depth_sd);
    const Vector3d told = bone + bone.norm() * sd.cwiseProduct(turn.value);
    // The direction is wrong by the one, the length by the other.
    return Vector3d(told.normalized() * bone.norm() *
                    (1.0 + errors_.length_sd * stretch.value.x()));
  };
  std::array<Vector3d, kLandmarkCount> told;
  // The nose's errors are free for the back: the head hangs on the shoulders with those of its own
  // points.
  const Vector3d told_shoulders = wrong(shoulders - hips, world_[index_of(Landmark::kLeftHip)],
                                        length_[index_of(Landmark::kLeftHip)]);
  const LastingError& neck = world_[index_of(Landmark::kNose)];
  constexpr std::size_t kFirst[]{11, 12, 23, 24};
  const auto tell = [&](std::size_t i) {
    const int on = kHangsOn[i];
    const Vector3d from = on == -1   ? hips
                          : on == -2 ? shoulders
                                     : p_C_m[static_cast<std::size_t>(on)];
    const Vector3d told_from = on == -1   ? Vector3d::Zero()
                               : on == -2 ? told_shoulders
                                          : told[static_cast<std::size_t>(on)];
    const Vector3d bone = p_C_m[i] - from;
    const std::size_t pair = i == 12 ? 11 : i == 24 ? 23 : i;
    if (i <= index_of(Landmark::kMouthRight)) {
      told[i] = told_from + wrong(bone, neck, length_[0]);
    } else if (pair != i || i == 11 || i == 23) {
      // Both ends of the line across err the opposite way.
      LastingError turn = world_[pair];
      if (pair != i) turn.value = -turn.value;
      told[i] = told_from + wrong(bone, turn, length_[pair]);
    } else {
      told[i] = told_from + wrong(bone, world_[i], length_[i]);
    }
  };
  for (const std::size_t i : kFirst) tell(i);
  for (std::size_t i = 0; i < kLandmarkCount; ++i)
    if (std::find(std::begin(kFirst), std::end(kFirst), i) == std::end(kFirst)) tell(i);
  for (std::size_t i = 0; i < kLandmarkCount; ++i)
    out.world_m[i] = (errors_.scale * told[i]).cast<float>();
}

BodyLandmarks SceneNetwork::see(const std::array<Vector3d, kLandmarkCount>& p_C_m,
                                const Pinhole& camera, MonoTime t) {
  const double keep_image = std::exp(-1.0 / (hz_ * errors_.image_memory_s)),
               keep_world = std::exp(-1.0 / (hz_ * errors_.world_memory_s));
  for (LastingError& l : image_) l.go_on(random_, keep_image);
  for (LastingError& l : world_) l.go_on(random_, keep_world);
  for (LastingError& l : length_) l.go_on(random_, keep_world);
  hide();
  BodyLandmarks out;
  out.found = true;
  out.is_new = !began_;
  began_ = true;
  out.presence = 0.99f;
  out.capture_time = t;
  Eigen::AlignedBox2d box;
  for (const Vector3d& p : p_C_m) box.extend(camera.project(p));
  const double side = 1.25 * box.sizes().maxCoeff();
  out.region = {static_cast<float>(box.center().x()), static_cast<float>(box.center().y()),
                static_cast<float>(side), 0.0f};
  for (std::size_t i = 0; errors_.hides_outside && i < kLandmarkCount; ++i) {
    const Eigen::Vector2d pixel = camera.project(p_C_m[i]);
    is_hidden_[i] = is_hidden_[i] || pixel.x() < 0.0 || pixel.y() < 0.0 ||
                    pixel.x() > camera.width_px || pixel.y() > camera.height_px;
  }
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double worse = is_hidden_[i] ? errors_.hidden_image_sd : 1.0;
    const Eigen::Vector2d pixel = camera.project(p_C_m[i]) + Eigen::Vector2d(0.5, 0.5) +
                                  errors_.image_sd * worse * side * image_[i].value.head<2>();
    out.image_px[i] =
        Eigen::Vector3f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), 0.0f);
    out.visibility[i] = is_hidden_[i] ? 0.1f : 0.97f;
  }
  write_world(p_C_m, out);
  draw_flip(p_C_m);
  if (is_flipped()) flip(out);
  return out;
}

std::array<Vector3d, kLandmarkCount> points_of(const BodyFrames& frames, double height_m,
                                               const SceneNetwork& network) {
  const double size = height_m / kReferenceBody_m;
  std::array<Vector3d, kLandmarkCount> points;
  const auto put = [&](Landmark l, Bone bone, const Vector3d& in_bone) {
    points[index_of(l)] =
        (frames.position(bone) + frames.R_WB[index_of(bone)] * in_bone.cast<float>())
            .cast<double>();
  };
  for (const Place& p : kPlaces) {
    const Vector3d left = size * Vector3d(p.x, p.y, p.z) + network.place_m(index_of(p.left));
    put(p.left, p.on_left, left);
    if (p.left != p.right) put(p.right, p.on_right, {-left.x(), left.y(), left.z()});
  }
  put(Landmark::kLeftFootIndex, Bone::kLeftToes, {0.0, size * kToeUp_m, size * kToeBefore_m});
  put(Landmark::kRightFootIndex, Bone::kRightToes, {0.0, size * kToeUp_m, size * kToeBefore_m});
  return points;
}

}  // namespace dance
