#include "formats/osc/vmc_writer.h"

#include <algorithm>

#include "core/pose/face_shapes.h"
#include "formats/osc/average_hand.h"
#include "formats/osc/unity_axes.h"

namespace dance {
namespace {

constexpr std::int32_t kCalibrated = 3;
constexpr std::int32_t kUncalibrated = 0;
constexpr std::int32_t kNormalMode = 0;

// Eyes and jaw of a head 0.22 m high, from the head bone.
Eigen::Vector3f rest_of_face_m(VmcFace face, const Skeleton& skeleton) {
  const float scale = skeleton.tip(Tip::kHead).norm() / 0.22f;
  switch (face) {
    case VmcFace::kLeftEye:
      return scale * Eigen::Vector3f(0.031f, 0.075f, 0.075f);
    case VmcFace::kRightEye:
      return scale * Eigen::Vector3f(-0.031f, 0.075f, 0.075f);
    case VmcFace::kJaw:
      return scale * Eigen::Vector3f(0.0f, 0.01f, 0.02f);
  }
  return Eigen::Vector3f::Zero();
}

}  // namespace

VmcWriter::VmcWriter(OscPacketSink& sink, VmcDialect dialect) : bundles_(sink), dialect_(dialect) {
  set_skeleton(average_skeleton());
}

void VmcWriter::set_skeleton(const Skeleton& skeleton) {
  const FingerOffsets fingers_m = average_hand(skeleton);
  for (std::size_t i = 0; i < kVmcBoneCount; ++i) {
    const VmcBone& bone = kVmcBones[i];
    if (bone.is_body())
      rest_m_[i] = skeleton.offset_m[static_cast<std::size_t>(bone.bone)];
    else if (bone.is_finger())
      rest_m_[i] = fingers_m[bone.finger()];
    else
      rest_m_[i] = rest_of_face_m(bone.face, skeleton);
  }
}

void VmcWriter::add_state(bool has_dancer, bool is_tracked, float time_s) {
  bundles_.add("/VMC/Ext/OK", {std::int32_t{has_dancer}, has_dancer ? kCalibrated : kUncalibrated,
                               kNormalMode, std::int32_t{is_tracked}});
  bundles_.add("/VMC/Ext/T", {time_s});
}

void VmcWriter::add_transform(const char* address, const char* name, const Eigen::Vector3f& p_m,
                              const Eigen::Quaternionf& R) {
  const Eigen::Vector3f p = other_hand(p_m);
  const Eigen::Quaternionf q = other_hand(R);
  bundles_.add(address, {name, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
}

void VmcWriter::add_expressions(const Face& face) {
  const auto add = [this](const char* name, float value) {
    bundles_.add("/VMC/Ext/Blend/Val", {name, value});
  };
  for (std::size_t i = 0; i < kExpressionCount; ++i) add(kExpressionNames[i], face.weight[i]);
  const bool is_vrm0 = dialect_ == VmcDialect::kVrm0;
  // What was said before the face was seen.
  add(is_vrm0 ? "Neutral" : "neutral", 0.0f);
  const VrmFace vrm = vrm_face(face);
  add(is_vrm0 ? "A" : "aa", vrm.aa);
  add(is_vrm0 ? "I" : "ih", vrm.ih);
  add(is_vrm0 ? "U" : "ou", vrm.ou);
  add(is_vrm0 ? "E" : "ee", vrm.ee);
  add(is_vrm0 ? "O" : "oh", vrm.oh);
  add(is_vrm0 ? "Blink" : "blink", vrm.blink);
  add(is_vrm0 ? "Blink_L" : "blinkLeft", vrm.blink_left);
  add(is_vrm0 ? "Blink_R" : "blinkRight", vrm.blink_right);
}

void VmcWriter::write_pose(const Pose& pose, const Hands* hands, float time_s, const Face* face) {
  const Eigen::Quaternionf at_rest = Eigen::Quaternionf::Identity();
  add_state(true, true, time_s);
  add_transform("/VMC/Ext/Root/Pos", "root", Eigen::Vector3f::Zero(), at_rest);
  for (std::size_t i = 0; i < kVmcBoneCount; ++i) {
    const VmcBone& bone = kVmcBones[i];
    const bool is_hips = bone.bone == static_cast<std::int8_t>(index_of(Bone::kHips));
    const Eigen::Vector3f& p_m = is_hips ? pose.p_WH_m : rest_m_[i];
    if (bone.is_body())
      add_transform("/VMC/Ext/Bone/Pos", bone.name, p_m,
                    pose.R_PB[static_cast<std::size_t>(bone.bone)]);
    else
      add_transform("/VMC/Ext/Bone/Pos", bone.name, p_m,
                    bone.is_finger() && hands ? hands->R_PB[bone.finger()] : at_rest);
  }
  // Receivers that wait for Apply get it; of a dancer without a face one name leaves what another
  // program sends of it as it is.
  if (face)
    add_expressions(*face);
  else
    bundles_.add("/VMC/Ext/Blend/Val",
                 {dialect_ == VmcDialect::kVrm0 ? "Neutral" : "neutral", 1.0f});
  bundles_.add("/VMC/Ext/Blend/Apply", {});
  bundles_.flush();
}

void VmcWriter::write_silence(bool has_dancer, float time_s) {
  add_state(has_dancer, false, time_s);
  bundles_.flush();
}

void VmcWriter::write_model(const char* title) {
  bundles_.add("/VMC/Ext/VRM", {"", title});
  bundles_.flush();
}

}  // namespace dance
