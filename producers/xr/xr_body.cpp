#include "producers/xr/xr_body.h"

#include <cmath>
#include <numbers>

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

struct JointOfBone {
  Bone bone;
  int joint;
};

constexpr std::array<JointOfBone, 14> kUpperFb{{
    {Bone::kHips, XR_BODY_JOINT_HIPS_FB},
    {Bone::kSpine, XR_BODY_JOINT_SPINE_LOWER_FB},
    {Bone::kChest, XR_BODY_JOINT_SPINE_UPPER_FB},
    {Bone::kUpperChest, XR_BODY_JOINT_CHEST_FB},
    {Bone::kNeck, XR_BODY_JOINT_NECK_FB},
    {Bone::kHead, XR_BODY_JOINT_HEAD_FB},
    {Bone::kLeftShoulder, XR_BODY_JOINT_LEFT_SHOULDER_FB},
    {Bone::kLeftUpperArm, XR_BODY_JOINT_LEFT_ARM_UPPER_FB},
    {Bone::kLeftLowerArm, XR_BODY_JOINT_LEFT_ARM_LOWER_FB},
    {Bone::kLeftHand, XR_BODY_JOINT_LEFT_HAND_WRIST_FB},
    {Bone::kRightShoulder, XR_BODY_JOINT_RIGHT_SHOULDER_FB},
    {Bone::kRightUpperArm, XR_BODY_JOINT_RIGHT_ARM_UPPER_FB},
    {Bone::kRightLowerArm, XR_BODY_JOINT_RIGHT_ARM_LOWER_FB},
    {Bone::kRightHand, XR_BODY_JOINT_RIGHT_HAND_WRIST_FB},
}};
constexpr std::array<JointOfBone, 8> kLegsFb{{
    {Bone::kLeftUpperLeg, XR_FULL_BODY_JOINT_LEFT_UPPER_LEG_META},
    {Bone::kLeftLowerLeg, XR_FULL_BODY_JOINT_LEFT_LOWER_LEG_META},
    {Bone::kLeftFoot, XR_FULL_BODY_JOINT_LEFT_FOOT_ANKLE_META},
    {Bone::kLeftToes, XR_FULL_BODY_JOINT_LEFT_FOOT_BALL_META},
    {Bone::kRightUpperLeg, XR_FULL_BODY_JOINT_RIGHT_UPPER_LEG_META},
    {Bone::kRightLowerLeg, XR_FULL_BODY_JOINT_RIGHT_LOWER_LEG_META},
    {Bone::kRightFoot, XR_FULL_BODY_JOINT_RIGHT_FOOT_ANKLE_META},
    {Bone::kRightToes, XR_FULL_BODY_JOINT_RIGHT_FOOT_BALL_META},
}};
constexpr std::array<JointOfBone, kBoneCount> kBd{{
    {Bone::kHips, XR_BODY_JOINT_PELVIS_BD},
    {Bone::kSpine, XR_BODY_JOINT_SPINE1_BD},
    {Bone::kChest, XR_BODY_JOINT_SPINE2_BD},
    {Bone::kUpperChest, XR_BODY_JOINT_SPINE3_BD},
    {Bone::kNeck, XR_BODY_JOINT_NECK_BD},
    {Bone::kHead, XR_BODY_JOINT_HEAD_BD},
    {Bone::kLeftShoulder, XR_BODY_JOINT_LEFT_COLLAR_BD},
    {Bone::kLeftUpperArm, XR_BODY_JOINT_LEFT_SHOULDER_BD},
    {Bone::kLeftLowerArm, XR_BODY_JOINT_LEFT_ELBOW_BD},
    {Bone::kLeftHand, XR_BODY_JOINT_LEFT_WRIST_BD},
    {Bone::kRightShoulder, XR_BODY_JOINT_RIGHT_COLLAR_BD},
    {Bone::kRightUpperArm, XR_BODY_JOINT_RIGHT_SHOULDER_BD},
    {Bone::kRightLowerArm, XR_BODY_JOINT_RIGHT_ELBOW_BD},
    {Bone::kRightHand, XR_BODY_JOINT_RIGHT_WRIST_BD},
    {Bone::kLeftUpperLeg, XR_BODY_JOINT_LEFT_HIP_BD},
    {Bone::kLeftLowerLeg, XR_BODY_JOINT_LEFT_KNEE_BD},
    {Bone::kLeftFoot, XR_BODY_JOINT_LEFT_ANKLE_BD},
    {Bone::kLeftToes, XR_BODY_JOINT_LEFT_FOOT_BD},
    {Bone::kRightUpperLeg, XR_BODY_JOINT_RIGHT_HIP_BD},
    {Bone::kRightLowerLeg, XR_BODY_JOINT_RIGHT_KNEE_BD},
    {Bone::kRightFoot, XR_BODY_JOINT_RIGHT_ANKLE_BD},
    {Bone::kRightToes, XR_BODY_JOINT_RIGHT_FOOT_BD},
}};

// The turn about the vertical that brings a direction to the left (+X).
Quaternionf turn_to_left(const Vector3f& left) {
  const float angle = std::atan2(left.z(), left.x());
  return Quaternionf(Eigen::AngleAxisf(angle, Vector3f::UnitY()));
}

}  // namespace

Result<std::unique_ptr<XrBody>> XrBody::create(const XrDancerSession& session) {
  const XrRuntime& runtime = session.runtime();
  if (!runtime.sees_body_fb() && !runtime.sees_body_bd()) return std::unique_ptr<XrBody>();
  std::unique_ptr<XrBody> body(new XrBody(session));
  const auto opened = runtime.sees_body_fb() ? body->open_fb() : body->open_bd();
  if (!opened) return tl::make_unexpected(opened.error());
  return body;
}

XrBody::~XrBody() {
  if (fb_ != XR_NULL_HANDLE) destroy_fb_(fb_);
  if (bd_ != XR_NULL_HANDLE) destroy_bd_(bd_);
}

Result<void> XrBody::open_fb() {
  const XrRuntime& runtime = session_.runtime();
  const auto create = runtime.function<PFN_xrCreateBodyTrackerFB>("xrCreateBodyTrackerFB");
  destroy_fb_ = runtime.function<PFN_xrDestroyBodyTrackerFB>("xrDestroyBodyTrackerFB");
  locate_fb_ = runtime.function<PFN_xrLocateBodyJointsFB>("xrLocateBodyJointsFB");
  skeleton_fb_ = runtime.function<PFN_xrGetBodySkeletonFB>("xrGetBodySkeletonFB");
  if (create == nullptr || destroy_fb_ == nullptr || locate_fb_ == nullptr ||
      skeleton_fb_ == nullptr)
    return fail("the headset's runtime promises to see a body and does not");
  has_legs_ = runtime.sees_legs_fb();
  const auto joints = has_legs_ ? static_cast<std::size_t>(XR_FULL_BODY_JOINT_COUNT_META)
                                : static_cast<std::size_t>(XR_BODY_JOINT_COUNT_FB);
  located_.resize(joints);
  skeleton_.resize(joints);
  R_JB_.resize(joints, Quaternionf::Identity());
  XrBodyTrackerCreateInfoFB info{};
  info.type = XR_TYPE_BODY_TRACKER_CREATE_INFO_FB;
  info.bodyJointSet = has_legs_ ? XR_BODY_JOINT_SET_FULL_BODY_META : XR_BODY_JOINT_SET_DEFAULT_FB;
  return checked(create(session_.handle(), &info, &fb_), "to see a body");
}

Result<void> XrBody::open_bd() {
  const XrRuntime& runtime = session_.runtime();
  const auto create = runtime.function<PFN_xrCreateBodyTrackerBD>("xrCreateBodyTrackerBD");
  destroy_bd_ = runtime.function<PFN_xrDestroyBodyTrackerBD>("xrDestroyBodyTrackerBD");
  locate_bd_ = runtime.function<PFN_xrLocateBodyJointsBD>("xrLocateBodyJointsBD");
  if (create == nullptr || destroy_bd_ == nullptr || locate_bd_ == nullptr)
    return fail("the headset's runtime promises to see a body and does not");
  has_legs_ = true;
  XrBodyTrackerCreateInfoBD info{};
  info.type = XR_TYPE_BODY_TRACKER_CREATE_INFO_BD;
  info.jointSet = XR_BODY_JOINT_SET_FULL_BODY_JOINTS_BD;
  return checked(create(session_.handle(), &info, &bd_), "to see a body");
}

bool XrBody::see(XrTime time, FigureFrame& figure, XrTime& seen) {
  figure = FigureFrame();
  seen = time;
  if (time <= 0) return false;
  return fb_ != XR_NULL_HANDLE ? see_fb(time, figure, seen) : see_bd(time, figure);
}

bool XrBody::learn_axes() {
  XrBodySkeletonFB info{};
  info.type = XR_TYPE_BODY_SKELETON_FB;
  info.jointCount = static_cast<std::uint32_t>(skeleton_.size());
  info.joints = skeleton_.data();
  if (XR_FAILED(skeleton_fb_(fb_, &info))) return false;
  const XrSpaceLocationFlags kAll =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  const auto left = place_of(
      kAll, skeleton_[static_cast<std::size_t>(XR_BODY_JOINT_LEFT_ARM_LOWER_FB)].pose, false);
  const auto right = place_of(
      kAll, skeleton_[static_cast<std::size_t>(XR_BODY_JOINT_RIGHT_ARM_LOWER_FB)].pose, false);
  if (!left || !right) return false;
  const Quaternionf turn = turn_to_left(left->p_m - right->p_m);
  for (std::size_t i = 0; i < skeleton_.size(); ++i) {
    const auto place = place_of(kAll, skeleton_[i].pose, false);
    R_JB_[i] = place ? (turn * place->R).conjugate() : Quaternionf::Identity();
  }
  return true;
}

bool XrBody::see_fb(XrTime time, FigureFrame& figure, XrTime& seen) {
  XrBodyJointsLocateInfoFB info{};
  info.type = XR_TYPE_BODY_JOINTS_LOCATE_INFO_FB;
  info.baseSpace = session_.base();
  info.time = time;
  XrBodyJointLocationsFB locations{};
  locations.type = XR_TYPE_BODY_JOINT_LOCATIONS_FB;
  locations.jointCount = static_cast<std::uint32_t>(located_.size());
  locations.jointLocations = located_.data();
  if (XR_FAILED(locate_fb_(fb_, &info, &locations)) || locations.isActive != XR_TRUE) return false;
  if (locations.time > 0) seen = locations.time;
  if (!has_axes_ || locations.skeletonChangedCount != skeleton_change_) {
    has_axes_ = learn_axes();
    skeleton_change_ = locations.skeletonChangedCount;
  }
  if (!has_axes_) return false;
  const auto put = [&](const JointOfBone& each) {
    const auto joint = static_cast<std::size_t>(each.joint);
    if (const auto place = place_of(located_[joint].locationFlags, located_[joint].pose, false))
      figure.put(each.bone, place->p_m, (place->R * R_JB_[joint]).normalized());
  };
  for (const JointOfBone& each : kUpperFb) put(each);
  if (has_legs_)
    for (const JointOfBone& each : kLegsFb) put(each);
  return figure.has(Bone::kHips) && figure.has(Bone::kHead);
}

bool XrBody::see_bd(XrTime time, FigureFrame& figure) {
  XrBodyJointsLocateInfoBD info{};
  info.type = XR_TYPE_BODY_JOINTS_LOCATE_INFO_BD;
  info.baseSpace = session_.base();
  info.time = time;
  std::array<XrBodyJointLocationBD, XR_BODY_JOINT_COUNT_BD> located{};
  XrBodyJointLocationsBD locations{};
  locations.type = XR_TYPE_BODY_JOINT_LOCATIONS_BD;
  locations.jointLocationCount = XR_BODY_JOINT_COUNT_BD;
  locations.jointLocations = located.data();
  if (XR_FAILED(locate_bd_(bd_, &info, &locations))) return false;
  for (const JointOfBone& each : kBd) {
    const XrBodyJointLocationBD& joint = located[static_cast<std::size_t>(each.joint)];
    if (const auto place = place_of(joint.locationFlags, joint.pose, false))
      figure.put(each.bone, place->p_m, place->R);
  }
  if (!figure.has(Bone::kHips) || !figure.has(Bone::kHead) || !figure.has(Bone::kLeftUpperLeg) ||
      !figure.has(Bone::kRightUpperLeg))
    return false;
  // In T-pose a body looks along +Z as SMPL's does, or along -Z as OpenXR does: its hips tell.
  const Vector3f left = figure.R_WB[index_of(Bone::kHips)].conjugate() *
                        (figure.p_WB_m[index_of(Bone::kLeftUpperLeg)] -
                         figure.p_WB_m[index_of(Bone::kRightUpperLeg)]);
  const Quaternionf turned(0.0f, 0.0f, 1.0f, 0.0f);
  if (left.x() < 0.0f)
    for (Quaternionf& R : figure.R_WB) R = R * turned;
  return true;
}

}  // namespace dance
