#include "producers/xr/xr_hands.h"

#include "core/pose/mirror.h"

namespace dance {

using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr float kPinch_m = 0.018f;
constexpr float kPalmToGrip_m = 0.02f;  // from the bones of the palm to the middle of a handle

// Of a left hand in T-pose: fingers along +X, the back up, the thumb between them and +Z, bending
// across the palm.
const Vector3f kThumb(0.70710678f, 0.0f, 0.70710678f);
const Vector3f kThumbNail(-0.56568542f, 0.6f, 0.56568542f);

// Turns a bone of the T-pose into its OpenXR joint: R_BJ, from where the joint's tip and back
// point.
Quaternionf joint_in_bone(const Vector3f& tip, const Vector3f& back) {
  Matrix3f R;
  R.col(2) = -tip;
  R.col(1) = back;
  R.col(0) = R.col(1).cross(R.col(2));
  return Quaternionf(R).normalized();
}

Quaternionf bone_of(const Quaternionf& R_joint, XrHand hand, bool is_thumb) {
  const bool is_left = hand == XrHand::kLeft;
  const Vector3f tip = is_thumb ? kThumb : Vector3f::UnitX();
  const Vector3f back = is_thumb ? kThumbNail : Vector3f::UnitY();
  const Quaternionf R_BJ =
      is_left ? joint_in_bone(tip, back) : joint_in_bone(mirrored(tip), mirrored(back));
  return (R_joint * R_BJ.conjugate()).normalized();
}

// Thumb to little finger; of each the joints that are bones of ours, from the hand outwards.
constexpr std::array<XrHandJointEXT, 5> kFirstJoints{
    XR_HAND_JOINT_THUMB_METACARPAL_EXT, XR_HAND_JOINT_INDEX_PROXIMAL_EXT,
    XR_HAND_JOINT_MIDDLE_PROXIMAL_EXT, XR_HAND_JOINT_RING_PROXIMAL_EXT,
    XR_HAND_JOINT_LITTLE_PROXIMAL_EXT};

}  // namespace

XrPlace grip_of(const XrHandJoints& joints, XrHand hand) {
  const XrPlace& palm = joints.at(XR_HAND_JOINT_PALM_EXT);
  // Palm: back +Y, fingers -Z; the thumb of a left hand is at +X. Grip: to the thumb -Z, +X out of
  // a left hand's palm and out of a right hand's back.
  Matrix3f R_PG;
  if (hand == XrHand::kLeft)
    R_PG << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  else
    R_PG << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return {palm.p_m - palm.R * Vector3f(0.0f, kPalmToGrip_m, 0.0f),
          (palm.R * Quaternionf(R_PG)).normalized()};
}

XrPlace aim_of(const XrHandJoints& joints) {
  return {joints.at(XR_HAND_JOINT_INDEX_PROXIMAL_EXT).p_m, joints.at(XR_HAND_JOINT_PALM_EXT).R};
}

void write_fingers(const XrHandJoints& joints, XrHand hand, Hands& out) {
  const std::size_t first = hand == XrHand::kLeft ? 0 : kFingerBoneCount / 2;
  const Quaternionf R_hand = bone_of(joints.at(XR_HAND_JOINT_PALM_EXT).R, hand, false);
  for (std::size_t finger = 0; finger < kFirstJoints.size(); ++finger) {
    Quaternionf R_parent = R_hand;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joint = static_cast<XrHandJointEXT>(kFirstJoints[finger] + static_cast<int>(i));
      const Quaternionf R = bone_of(joints.at(joint).R, hand, finger == 0);
      const std::size_t bone = first + 3 * finger + i;
      out.R_PB[bone] = (R_parent.conjugate() * R).normalized();
      out.presence |= 1u << bone;
      R_parent = R;
    }
  }
}

bool is_pinching(const XrHandJoints& joints) {
  return (joints.at(XR_HAND_JOINT_THUMB_TIP_EXT).p_m - joints.at(XR_HAND_JOINT_INDEX_TIP_EXT).p_m)
             .norm() < kPinch_m;
}

Result<std::unique_ptr<XrHands>> XrHands::create(const XrDancerSession& session) {
  std::unique_ptr<XrHands> hands(new XrHands(session));
  if (auto opened = hands->open(); !opened) return tl::make_unexpected(opened.error());
  return hands;
}

XrHands::~XrHands() {
  for (const XrHandTrackerEXT tracker : trackers_)
    if (tracker != XR_NULL_HANDLE) destroy_(tracker);
}

Result<void> XrHands::open() {
  const XrRuntime& runtime = session_.runtime();
  const auto create = runtime.function<PFN_xrCreateHandTrackerEXT>("xrCreateHandTrackerEXT");
  destroy_ = runtime.function<PFN_xrDestroyHandTrackerEXT>("xrDestroyHandTrackerEXT");
  locate_ = runtime.function<PFN_xrLocateHandJointsEXT>("xrLocateHandJointsEXT");
  if (create == nullptr || destroy_ == nullptr || locate_ == nullptr)
    return fail("the headset's runtime promises to see hands and does not");
  for (std::size_t i = 0; i < kXrHands; ++i) {
    XrHandTrackerCreateInfoEXT info{};
    info.type = XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT;
    info.hand = i == 0 ? XR_HAND_LEFT_EXT : XR_HAND_RIGHT_EXT;
    info.handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT;
    if (auto made = checked(create(session_.handle(), &info, &trackers_[i]), "to see hands"); !made)
      return made;
  }
  return {};
}

std::optional<XrHandJoints> XrHands::see(XrHand hand, XrTime time) {
  XrHandJointsLocateInfoEXT info{};
  info.type = XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT;
  info.baseSpace = session_.base();
  info.time = time;
  std::array<XrHandJointLocationEXT, XR_HAND_JOINT_COUNT_EXT> located{};
  XrHandJointLocationsEXT locations{};
  locations.type = XR_TYPE_HAND_JOINT_LOCATIONS_EXT;
  locations.jointCount = XR_HAND_JOINT_COUNT_EXT;
  locations.jointLocations = located.data();
  const XrHandTrackerEXT tracker = trackers_[static_cast<std::size_t>(hand)];
  if (time <= 0 || XR_FAILED(locate_(tracker, &info, &locations)) || locations.isActive != XR_TRUE)
    return std::nullopt;
  XrHandJoints joints;
  for (std::size_t i = 0; i < located.size(); ++i) {
    const auto place = place_of(located[i].locationFlags, located[i].pose, false);
    if (!place) return std::nullopt;
    joints.joints[i] = *place;
  }
  return joints;
}

}  // namespace dance
