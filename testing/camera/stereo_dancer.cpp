#include "testing/camera/stereo_dancer.h"

#include <algorithm>

#include "producers/camera/lens.h"

namespace dance {
namespace {

struct LimbLook {
  Bone from;
  Bone to;
  double half_m;
  double brightness;
};
constexpr std::array<LimbLook, 9> kArmsAndLegs{{
    {Bone::kLeftUpperArm, Bone::kLeftLowerArm, 0.050, 150.0},
    {Bone::kLeftLowerArm, Bone::kLeftHand, 0.040, 170.0},
    {Bone::kRightUpperArm, Bone::kRightLowerArm, 0.050, 150.0},
    {Bone::kRightLowerArm, Bone::kRightHand, 0.040, 170.0},
    {Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, 0.073, 90.0},
    {Bone::kLeftLowerLeg, Bone::kLeftFoot, 0.050, 85.0},
    {Bone::kRightUpperLeg, Bone::kRightLowerLeg, 0.073, 95.0},
    {Bone::kRightLowerLeg, Bone::kRightFoot, 0.050, 80.0},
    {Bone::kNeck, Bone::kHead, 0.055, 180.0},
}};

Eigen::Vector3d turned(const Eigen::Vector3d& v_W) { return {v_W.x(), -v_W.y(), -v_W.z()}; }

}  // namespace

std::vector<SceneLimb> body_of(const BodyFrames& frames, const StageCamera& camera,
                               const DancerLook& look) {
  std::vector<SceneLimb> out;
  std::uint32_t pattern = 1;
  const auto add = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                       const Eigen::Vector3d& aside, double half_m, double flatness,
                       double brightness) {
    out.push_back(
        {from, to, aside, half_m * look.girth, flatness, brightness, look.contrast, pattern++});
  };
  const auto at = [&](Bone bone) { return camera.in_scene(frames.position(bone)); };
  const auto side_of = [&](Bone bone) {
    return turned((frames.R_WB[index_of(bone)] * Eigen::Vector3f::UnitX()).cast<double>());
  };
  for (const LimbLook& limb : kArmsAndLegs)
    add(at(limb.from), at(limb.to), side_of(Bone::kHips), limb.half_m, 1.0, limb.brightness);
  const Eigen::Vector3d shoulders = 0.5 * (at(Bone::kLeftUpperArm) + at(Bone::kRightUpperArm));
  const Eigen::Vector3d hips = 0.5 * (at(Bone::kLeftUpperLeg) + at(Bone::kRightUpperLeg));
  const Eigen::Vector3d waist = 0.55 * hips + 0.45 * shoulders;
  add(shoulders, waist, side_of(Bone::kUpperChest), 0.160, 0.70, 120.0);
  add(waist, hips, side_of(Bone::kHips), 0.165, 0.68, 110.0);
  for (const Bone bone : {Bone::kLeftUpperArm, Bone::kRightUpperArm})
    add(at(bone), at(bone) + Eigen::Vector3d(0.0, 0.02, 0.0), side_of(bone), 0.062, 1.0, 125.0);
  add(at(Bone::kHead), camera.in_scene(frames.tip(Tip::kHead)), side_of(Bone::kHead), 0.085, 1.1,
      175.0);
  add(at(Bone::kLeftHand), camera.in_scene(frames.tip(Tip::kLeftHand)), side_of(Bone::kLeftHand),
      0.03, 1.0, 180.0);
  add(at(Bone::kRightHand), camera.in_scene(frames.tip(Tip::kRightHand)), side_of(Bone::kRightHand),
      0.03, 1.0, 180.0);
  add(at(Bone::kLeftFoot), camera.in_scene(frames.tip(Tip::kLeftToes)), side_of(Bone::kLeftFoot),
      0.04, 1.0, 60.0);
  add(at(Bone::kRightFoot), camera.in_scene(frames.tip(Tip::kRightToes)), side_of(Bone::kRightFoot),
      0.04, 1.0, 60.0);
  return out;
}

std::array<Eigen::Vector3d, kLandmarkCount> joints_of(const BodyFrames& frames,
                                                      const StageCamera& camera) {
  std::array<Eigen::Vector3d, kLandmarkCount> out;
  const auto at = [&](Bone bone) { return camera.in_scene(frames.position(bone)); };
  const auto set = [&](Landmark l, const Eigen::Vector3d& p) { out[index_of(l)] = p; };
  const auto& R_WHead = frames.R_WB[index_of(Bone::kHead)];
  const Eigen::Vector3f face =
      frames.position(Bone::kHead) + R_WHead * Eigen::Vector3f(0, 0.06f, 0.09f);
  // The face's points count little here: one place for all but the ears.
  for (std::size_t i = 0; i <= index_of(Landmark::kMouthRight); ++i) out[i] = camera.in_scene(face);
  set(Landmark::kLeftEar,
      camera.in_scene(frames.position(Bone::kHead) + R_WHead * Eigen::Vector3f(0.08f, 0.06f, 0)));
  set(Landmark::kRightEar,
      camera.in_scene(frames.position(Bone::kHead) + R_WHead * Eigen::Vector3f(-0.08f, 0.06f, 0)));
  set(Landmark::kLeftShoulder, at(Bone::kLeftUpperArm));
  set(Landmark::kRightShoulder, at(Bone::kRightUpperArm));
  set(Landmark::kLeftElbow, at(Bone::kLeftLowerArm));
  set(Landmark::kRightElbow, at(Bone::kRightLowerArm));
  set(Landmark::kLeftWrist, at(Bone::kLeftHand));
  set(Landmark::kRightWrist, at(Bone::kRightHand));
  for (const Landmark l : {Landmark::kLeftPinky, Landmark::kLeftIndex, Landmark::kLeftThumb})
    set(l, camera.in_scene(frames.tip(Tip::kLeftHand)));
  for (const Landmark l : {Landmark::kRightPinky, Landmark::kRightIndex, Landmark::kRightThumb})
    set(l, camera.in_scene(frames.tip(Tip::kRightHand)));
  set(Landmark::kLeftHip, at(Bone::kLeftUpperLeg));
  set(Landmark::kRightHip, at(Bone::kRightUpperLeg));
  set(Landmark::kLeftKnee, at(Bone::kLeftLowerLeg));
  set(Landmark::kRightKnee, at(Bone::kRightLowerLeg));
  set(Landmark::kLeftAnkle, at(Bone::kLeftFoot));
  set(Landmark::kRightAnkle, at(Bone::kRightFoot));
  set(Landmark::kLeftHeel, at(Bone::kLeftFoot) + Eigen::Vector3d(0, 0.06, 0));
  set(Landmark::kRightHeel, at(Bone::kRightFoot) + Eigen::Vector3d(0, 0.06, 0));
  set(Landmark::kLeftFootIndex, camera.in_scene(frames.tip(Tip::kLeftToes)));
  set(Landmark::kRightFootIndex, camera.in_scene(frames.tip(Tip::kRightToes)));
  return out;
}

BodyLandmarks landmarks_of(const std::array<Eigen::Vector3d, kLandmarkCount>& joints_S_m,
                           const StereoRig& rig, Side side, const NetworkErrors& errors,
                           Random& random) {
  const bool is_left = side == Side::kLeft;
  const Pinhole& eye = is_left ? rig.left : rig.right;
  const auto in_eye = [&](const Eigen::Vector3d& p_L) -> Eigen::Vector3d {
    return is_left ? p_L : rig.R_RL * p_L + rig.p_RL_m;
  };
  const Eigen::Vector3d hips = in_eye(
      0.5 * (joints_S_m[index_of(Landmark::kLeftHip)] + joints_S_m[index_of(Landmark::kRightHip)]));
  BodyLandmarks out;
  out.found = true;
  out.presence = 1.0f;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const Eigen::Vector3d p = in_eye(joints_S_m[i]);
    const Eigen::Vector2d px = pixel_of(eye, p.head<2>() / p.z());
    const Eigen::Vector3d relative = (p - hips) / errors.scale;
    out.image_px[i] = {static_cast<float>(px.x() + errors.image_px * random.normal()),
                       static_cast<float>(px.y() + errors.image_px * random.normal()),
                       static_cast<float>(relative.z() * eye.fx_px / p.z())};
    out.world_m[i] = {static_cast<float>(relative.x() + errors.across_m * random.normal()),
                      static_cast<float>(relative.y() + errors.across_m * random.normal()),
                      static_cast<float>(relative.z() + errors.depth_m * random.normal())};
    const bool is_inside =
        px.x() >= 0.0 && px.y() >= 0.0 && px.x() < eye.width_px && px.y() < eye.height_px;
    out.visibility[i] = is_inside ? 0.95f : 0.1f;
  }
  // The network's origin is midway between its own hips.
  const Eigen::Vector3f origin =
      0.5f * (out.world(Landmark::kLeftHip) + out.world(Landmark::kRightHip));
  for (Eigen::Vector3f& p : out.world_m) p -= origin;
  return out;
}

}  // namespace dance
