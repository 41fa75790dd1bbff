#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "core/pose/kinematics.h"
#include "formats/osc/average_hand.h"
#include "formats/osc/unity_axes.h"
#include "formats/osc/vmc_bones.h"
#include "formats/osc/vmc_message.h"
#include "formats/osc/vmc_writer.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/formats/osc/decoded_osc.h"

namespace dance {
namespace {

using Kind = VmcMessage::Kind;

TEST(VmcBones, AreUnitysFiftyFiveEachOnce) {
  std::set<std::string> names;
  std::set<int> bones;
  int faces = 0;
  for (const VmcBone& bone : kVmcBones) {
    names.insert(bone.name);
    if (bone.bone < 0)
      ++faces;
    else
      bones.insert(bone.bone);
    EXPECT_EQ(find_vmc_bone(bone.name, VmcThumbs::kUnity), int{bone.bone}) << bone.name;
  }
  EXPECT_EQ(names.size(), 55u);
  EXPECT_EQ(bones.size(), 52u);
  EXPECT_EQ(faces, 3);
}

TEST(VmcBones, KeepLeftLeftAndKnowTheThumbsOfBothVrms) {
  const auto finger = [](std::string_view name) {
    for (std::size_t i = 0; i < kFingerBoneCount; ++i)
      if (kFingerBones[i].name == name) return static_cast<int>(kBoneCount + i);
    return -1;
  };
  EXPECT_EQ(find_vmc_bone("LeftHand", VmcThumbs::kUnity),
            static_cast<int>(index_of(Bone::kLeftHand)));
  EXPECT_EQ(find_vmc_bone("leftHand", VmcThumbs::kVrm1),
            static_cast<int>(index_of(Bone::kLeftHand)));
  EXPECT_EQ(find_vmc_bone("RightThumbProximal", VmcThumbs::kUnity), finger("rightThumbMetacarpal"));
  EXPECT_EQ(find_vmc_bone("RightThumbIntermediate", VmcThumbs::kUnity),
            finger("rightThumbProximal"));
  EXPECT_EQ(find_vmc_bone("RightThumbDistal", VmcThumbs::kUnity), finger("rightThumbDistal"));
  EXPECT_EQ(find_vmc_bone("rightThumbMetacarpal", VmcThumbs::kVrm1),
            finger("rightThumbMetacarpal"));
  EXPECT_EQ(find_vmc_bone("RightThumbProximal", VmcThumbs::kVrm1), finger("rightThumbProximal"));
  EXPECT_EQ(thumbs_told_by("leftThumbMetacarpal"), VmcThumbs::kVrm1);
  EXPECT_EQ(thumbs_told_by("LeftThumbIntermediate"), VmcThumbs::kUnity);
  EXPECT_EQ(thumbs_told_by("LeftThumbProximal"), std::nullopt);
  EXPECT_EQ(thumbs_told_by("LeftIndexIntermediate"), std::nullopt);
  for (const char* name : {"", "x", "hips ", "HIPS", "LeftTail", "Leftthumb"})
    EXPECT_EQ(find_vmc_bone(name, VmcThumbs::kUnity), std::nullopt) << name;
}

TEST(UnityAxes, MirrorAndLeadBack) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaternionf R = random_rotation(random);
    const Eigen::Vector3f p = random_direction(random);
    EXPECT_TRUE(is_same_rotation(other_hand(other_hand(R)), R));
    // What is rotated and mirrored is what is mirrored and rotated the mirrored way.
    EXPECT_LT((other_hand(R * p) - other_hand(R) * other_hand(p)).norm(), 1e-5f);
  }
}

std::map<std::string, std::vector<float>> bones_of(const std::vector<DecodedOsc>& messages) {
  std::map<std::string, std::vector<float>> bones;
  for (const DecodedOsc& message : messages)
    if (message.address == "/VMC/Ext/Bone/Pos") bones[message.texts.at(0)] = message.floats;
  return bones;
}

TEST(VmcWriter, WritesAKnownPoseAsUnityWouldSeeIt) {
  KeptPackets kept;
  VmcWriter writer(kept, VmcDialect::kVrm0);
  Pose pose;
  pose.p_WH_m = {0.5f, 0.9f, -2.0f};
  // The left arm down: about +Z by -90 degrees in W, where left is +X.
  const float half = std::sqrt(0.5f);
  pose.R_PB[index_of(Bone::kLeftUpperArm)] = Eigen::Quaternionf(half, 0.0f, 0.0f, -half);
  writer.write_pose(pose, nullptr, 1.25f);
  const auto messages = kept.decoded();
  ASSERT_EQ(messages.size(), 3u + 55u + 2u);
  EXPECT_EQ(messages[0].address, "/VMC/Ext/OK");
  EXPECT_EQ(messages[0].types, "iiii");
  EXPECT_EQ(messages[0].ints, (std::vector<int>{1, 3, 0, 1}));
  EXPECT_EQ(messages[1].address, "/VMC/Ext/T");
  EXPECT_EQ(messages[1].floats, std::vector<float>{1.25f});
  EXPECT_EQ(messages[2].address, "/VMC/Ext/Root/Pos");
  EXPECT_EQ(messages[2].texts, std::vector<std::string>{"root"});
  EXPECT_EQ(messages[2].floats, (std::vector<float>{0, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(messages[58].address, "/VMC/Ext/Blend/Val");
  EXPECT_EQ(messages[58].texts, std::vector<std::string>{"Neutral"});
  EXPECT_EQ(messages[59].address, "/VMC/Ext/Blend/Apply");
  const auto bones = bones_of(messages);
  ASSERT_EQ(bones.size(), 55u);
  EXPECT_EQ(bones.at("Hips"), (std::vector<float>{-0.5f, 0.9f, -2.0f, 0, 0, 0, 1}));
  // In Unity the left arm points to -X, and down is +90 degrees about +Z.
  const auto arm = bones.at("LeftUpperArm");
  EXPECT_LT(arm[0], 0.0f);
  EXPECT_FLOAT_EQ(arm[5], half);
  EXPECT_FLOAT_EQ(arm[6], half);
  EXPECT_LT(bones.at("LeftEye")[0], 0.0f);
  EXPECT_GT(bones.at("RightIndexProximal")[0], 0.0f);
}

TEST(VmcWriter, AFaceIsArKitsNamesAndVrmsOwn) {
  for (const VmcDialect dialect : {VmcDialect::kVrm0, VmcDialect::kVrm1}) {
    KeptPackets sink;
    VmcWriter writer(sink, dialect);
    Face face;
    face[Expression::kJawOpen] = 0.5f;
    face[Expression::kEyeBlinkLeft] = 1.0f;
    face[Expression::kEyeBlinkRight] = 0.25f;
    writer.write_pose(Pose(), nullptr, 1.0f, &face);
    std::map<std::string, float> shown;
    int applied = 0;
    for (const DecodedOsc& message : sink.decoded()) {
      if (message.address == "/VMC/Ext/Blend/Apply") ++applied;
      if (message.address != "/VMC/Ext/Blend/Val") continue;
      EXPECT_EQ(applied, 0) << "after what it applies";
      shown[message.texts.at(0)] = message.floats.at(0);
    }
    EXPECT_EQ(applied, 1);
    EXPECT_EQ(shown.size(), kExpressionCount + 9);
    EXPECT_EQ(shown.at("jawOpen"), 0.5f);
    EXPECT_EQ(shown.at("eyeBlinkLeft"), 1.0f);
    const bool is_vrm0 = dialect == VmcDialect::kVrm0;
    EXPECT_EQ(shown.at(is_vrm0 ? "A" : "aa"), 0.5f);
    EXPECT_EQ(shown.at(is_vrm0 ? "Blink" : "blink"), 0.25f);
    EXPECT_EQ(shown.at(is_vrm0 ? "Blink_L" : "blinkLeft"), 0.75f);
    EXPECT_EQ(shown.at(is_vrm0 ? "Blink_R" : "blinkRight"), 0.0f);
    EXPECT_EQ(shown.at(is_vrm0 ? "Neutral" : "neutral"), 0.0f) << "what was said before";
  }
}

TEST(VmcWriter, KeepsEachPacketWithinAnEthernetFrame) {
  KeptPackets kept;
  VmcWriter writer(kept, VmcDialect::kVrm1);
  writer.write_pose(Pose(), nullptr, 0.0f);
  EXPECT_EQ(kept.packets.size(), 4u);
  std::size_t bytes = 0;
  for (const auto& packet : kept.packets) {
    EXPECT_LE(packet.size(), 1472u);
    bytes += packet.size();
  }
  EXPECT_EQ(bytes, 4724u);
  EXPECT_EQ(kept.decoded()[58].texts, std::vector<std::string>{"neutral"});
}

// What a receiver that takes positions over shows: bones in Unity's axes, put together by itself.
TEST(VmcWriter, GivesReceiversThatTakePositionsOverTheDancersOwnBody) {
  Random random(11);
  const Skeleton skeleton = average_skeleton(1.58f);
  KeptPackets kept;
  VmcWriter writer(kept, VmcDialect::kVrm0);
  writer.set_skeleton(skeleton);
  for (int i = 0; i < 50; ++i) {
    kept.packets.clear();
    const Pose pose = random_pose(random);
    writer.write_pose(pose, nullptr, 0.0f);
    const auto bones = bones_of(kept.decoded());
    BodyFrames frames;
    forward_kinematics(skeleton, pose, frames);
    std::array<Eigen::Affine3f, kBoneCount> T_UB;
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      std::string name(kBones[b].name);
      name[0] = static_cast<char>(std::toupper(name[0]));
      const auto& v = bones.at(name);
      const Eigen::Affine3f local =
          Eigen::Translation3f(v[0], v[1], v[2]) * Eigen::Quaternionf(v[6], v[3], v[4], v[5]);
      T_UB[b] = b == 0 ? local : T_UB[static_cast<std::size_t>(kBones[b].parent)] * local;
      const Eigen::Vector3f p_U = T_UB[b].translation();
      EXPECT_LT((Eigen::Vector3f(-p_U.x(), p_U.y(), p_U.z()) - frames.p_WB_m[b]).norm(), 1e-5f)
          << name;
    }
  }
}

TEST(VmcWriter, SendsFingersAndAllocatesNothing) {
  class Bytes : public OscPacketSink {
   public:
    void on_packet(std::span<const std::uint8_t> packet) override { count += packet.size(); }
    std::size_t count = 0;
  } bytes;
  VmcWriter writer(bytes, VmcDialect::kVrm0);
  Hands hands;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    writer.write_pose(Pose(), &hands, 0.1f * static_cast<float>(i));
    writer.write_silence(true, 1.0f);
    writer.write_model("alice");
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(bytes.count, 100u * 4724u);
}

TEST(AverageHand, IsMirroredAndGrowsWithTheDancer) {
  const FingerOffsets of_tall = average_hand(average_skeleton(1.9f));
  const FingerOffsets of_small = average_hand(average_skeleton(1.5f));
  for (std::size_t i = 0; i < kFingerBoneCount / 2; ++i) {
    const Eigen::Vector3f& left = of_tall[i];
    const Eigen::Vector3f& right = of_tall[i + kFingerBoneCount / 2];
    EXPECT_LT((other_hand(left) - right).norm(), 1e-6f) << i;
    EXPECT_NEAR(left.norm() / of_small[i].norm(), 1.9f / 1.5f, 1e-4f) << i;
  }
}

OscMessage message_of(const char* address, const std::vector<OscValue>& values) {
  OscMessage message;
  message.address = address;
  for (const OscValue& value : values) {
    OscArgument argument;
    argument.kind = value.kind == OscValue::Kind::kInt     ? OscArgument::Kind::kInt
                    : value.kind == OscValue::Kind::kFloat ? OscArgument::Kind::kFloat
                                                           : OscArgument::Kind::kText;
    argument.number = value.number;
    argument.real = value.real;
    argument.text = value.text;
    EXPECT_TRUE(message.arguments.try_push(argument));
  }
  return message;
}

TEST(VmcMessage, TakesWhatTheProtocolSaysAndIgnoresWhatItAdded) {
  const auto bone = parse_vmc(
      message_of("/VMC/Ext/Bone/Pos", {"Head", 1.0f, 2.0f, 3.0f, 0.0f, 0.6f, 0.0f, 0.8f, "more"}));
  EXPECT_EQ(bone.kind, Kind::kBone);
  EXPECT_EQ(bone.name, "Head");
  EXPECT_EQ(bone.p_m, Eigen::Vector3f(-1, 2, 3));
  EXPECT_FLOAT_EQ(bone.R.y(), -0.6f);
  EXPECT_FLOAT_EQ(bone.R.w(), 0.8f);
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/Root/Pos", {"root", 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
                                                       1.0f, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f}))
                .kind,
            Kind::kRoot);
  EXPECT_TRUE(parse_vmc(message_of("/VMC/Ext/OK", {std::int32_t{1}})).is_loaded);
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/T", {2.5f})).time_s, 2.5f);
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/Blend/Val", {"Joy", 0.5f})).value, 0.5f);
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/Blend/Apply", {})).kind, Kind::kBlendApply);
  for (const char* address : {"/VMC/Ext/Cam", "/VMC/Thru/a/b", "/VMC/Ext/Bone/Poss", "/", ""})
    EXPECT_EQ(parse_vmc(message_of(address, {})).kind, Kind::kOther) << address;
}

TEST(VmcMessage, RefusesTooFewArgumentsOtherTypesAndNumbersThatAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<std::vector<OscValue>> wrong{
      {},
      {"Head"},
      {"Head", 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f},
      {1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f},
      {"Head", 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, std::int32_t{1}},
      {"Head", nan, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f},
      {"Head", 0.0f, -inf, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f},
      {"Head", 0.0f, 1e9f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f},
      {"Head", 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f},
      {"Head", 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 3e38f},
      {"Head", 0.0f, 0.0f, 0.0f, nan, 0.0f, 0.0f, 1.0f},
  };
  for (const auto& values : wrong)
    for (const char* address : {"/VMC/Ext/Bone/Pos", "/VMC/Ext/Root/Pos"})
      EXPECT_EQ(parse_vmc(message_of(address, values)).kind, Kind::kMalformed) << values.size();
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/T", {std::int32_t{1}})).kind, Kind::kMalformed);
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/T", {nan})).kind, Kind::kMalformed);
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/OK", {"1"})).kind, Kind::kMalformed);
  EXPECT_EQ(parse_vmc(message_of("/VMC/Ext/Blend/Val", {"Joy"})).kind, Kind::kMalformed);
}

}  // namespace
}  // namespace dance
