#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "formats/natnet/natnet_rig.h"
#include "tests/allocation_guard.h"
#include "tests/formats/natnet/natnet_figure.h"
#include "tests/formats/natnet/natnet_packets.h"

namespace dance {
namespace {

constexpr NatNetVersion kVersions[] = {{3, 0}, {3, 1}, {4, 0}, {4, 1}};

FigureFrame standing() {
  FigureFrame figure;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    figure.put(static_cast<Bone>(b),
               Eigen::Vector3f(0.01f * static_cast<float>(b), 1.0f, 0.02f * static_cast<float>(b)),
               Eigen::Quaternionf::Identity());
  return figure;
}

std::unique_ptr<NatNetModels> two_models() {
  auto models = std::make_unique<NatNetModels>();
  (void)models->skeletons.try_push(natnet_model(standing(), "Ana", 1));
  (void)models->skeletons.try_push(natnet_model(standing(), "Ben", 2, NatNetNames::kFbx));
  return models;
}

std::unique_ptr<NatNetFrame> two_skeletons() {
  auto frame = std::make_unique<NatNetFrame>();
  frame->number = 77;
  frame->rigid_bodies = 2;
  frame->timestamp_s = 12.5;
  frame->exposed_ticks = 123'456'789'012;
  frame->models_changed = true;
  for (const std::int32_t id : {1, 2})
    (void)frame->skeletons.try_push(natnet_skeleton(standing(), id, false));
  return frame;
}

TEST(NatNet, AFrameOfEachVersionIsRead) {
  const auto was = two_skeletons();
  auto is = std::make_unique<NatNetFrame>();
  for (const NatNetVersion version : kVersions) {
    ASSERT_EQ(read_natnet_frame(natnet_frame_packet(version, *was), version, *is),
              NatNetFault::kNone);
    EXPECT_EQ(is->number, 77u);
    EXPECT_EQ(is->rigid_bodies, 2u);
    EXPECT_EQ(is->timestamp_s, 12.5);
    EXPECT_EQ(is->exposed_ticks, was->exposed_ticks);
    EXPECT_TRUE(is->models_changed);
    ASSERT_EQ(is->skeletons.size(), 2u);
    EXPECT_EQ(is->skeletons[1].id, 2);
    ASSERT_EQ(is->skeletons[1].bones.size(), kNatNetJoints.size());
    for (std::size_t b = 0; b < kNatNetJoints.size(); ++b) {
      EXPECT_EQ(is->skeletons[1].bones[b].id, static_cast<std::int32_t>(b + 1));
      EXPECT_EQ(is->skeletons[1].bones[b].p_m, was->skeletons[1].bones[b].p_m);
      EXPECT_TRUE(is->skeletons[1].bones[b].is_tracked);
    }
  }
}

TEST(NatNet, TheModelsOfEachVersionAreRead) {
  const auto was = two_models();
  auto is = std::make_unique<NatNetModels>();
  for (const NatNetVersion version : kVersions) {
    ASSERT_EQ(read_natnet_models(natnet_models_packet(version, *was), version, *is),
              NatNetFault::kNone);
    EXPECT_EQ(is->others, 2u);
    ASSERT_EQ(is->skeletons.size(), 2u);
    EXPECT_EQ(is->skeletons[0].name.view(), "Ana");
    EXPECT_EQ(is->skeletons[0].bones[6].name.view(), "LUArm");
    EXPECT_EQ(is->skeletons[0].bones[6].parent_id, 6);
    EXPECT_EQ(is->skeletons[0].bones[6].offset_m, was->skeletons[0].bones[6].offset_m);
  }
}

TEST(NatNet, AServerSaysItsVersionAndItsTicks) {
  NatNetServer server;
  ASSERT_EQ(read_natnet_server(natnet_server_packet({3, 1}, 10'000'000), server),
            NatNetFault::kNone);
  EXPECT_EQ(server.version, (NatNetVersion{3, 1}));
  EXPECT_EQ(server.ticks_per_second, 10'000'000u);
  ASSERT_EQ(read_natnet_server(natnet_server_packet({4, 0}), server), NatNetFault::kNone);
  EXPECT_EQ(server.ticks_per_second, 0u);
  for (const NatNetVersion version : {NatNetVersion{2, 9}, {4, 2}, {5, 0}})
    EXPECT_EQ(read_natnet_server(natnet_server_packet(version), server),
              NatNetFault::kOtherVersion);
}

TEST(NatNet, TheNamesOfEachConventionAreFound) {
  for (const NatNetNames names : {NatNetNames::kMotive, NatNetNames::kFbx, NatNetNames::kBvh}) {
    const NatNetRig rig = find_natnet_rig(natnet_model(standing(), "Ana", 1, names));
    ASSERT_EQ(rig.parts.size(), kNatNetJoints.size());
    EXPECT_EQ(rig.bones_found, kNatNetJoints.size());
    for (std::size_t j = 0; j < kNatNetJoints.size(); ++j) {
      EXPECT_EQ(rig.parts[j].bone, static_cast<int>(index_of(kNatNetJoints[j].bone)))
          << kNatNetJoints[j].motive;
      EXPECT_EQ(rig.parts[j].parent, kNatNetJoints[j].parent);
    }
  }
}

TEST(NatNet, NamesWithTheSkeletonsNameAndFingersAreFound) {
  NatNetModel model;
  ASSERT_TRUE(model.name.assign("Ana"));
  std::int32_t id = 0;
  const std::pair<const char*, int> kNames[] = {
      {"Ana_LHand", -1},       {"Ana:LThumb1", 0},     {"RPinky3", 29},
      {"RightHandIndex2", 19}, {"LeftHandMiddle1", 6}, {"LIndex4", -1},
      {"RightFinger02", 17},   {"LeftFinger4", 12},    {"LeftFinger13", -1}};
  for (const auto& [name, finger] : kNames) {
    NatNetModelBone bone;
    ASSERT_TRUE(bone.name.assign(name));
    bone.id = ++id;
    ASSERT_TRUE(model.bones.try_push(bone));
  }
  const NatNetRig rig = find_natnet_rig(model);
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    EXPECT_EQ(rig.parts[i].finger_bone, kNames[i].second) << kNames[i].first;
  EXPECT_EQ(rig.parts[0].bone, static_cast<int>(index_of(Bone::kLeftHand)));
  EXPECT_EQ(rig.bones_found, 1u);
}

TEST(NatNet, ThreeBonesOfATrunkAreInOrder) {
  NatNetModel model;
  for (const char* name : {"Hips", "Spine", "Spine1", "Spine2"}) {
    NatNetModelBone bone;
    ASSERT_TRUE(bone.name.assign(name));
    bone.id = static_cast<std::int32_t>(model.bones.size() + 1);
    ASSERT_TRUE(model.bones.try_push(bone));
  }
  const NatNetRig rig = find_natnet_rig(model);
  EXPECT_EQ(rig.parts[1].bone, static_cast<int>(index_of(Bone::kSpine)));
  EXPECT_EQ(rig.parts[2].bone, static_cast<int>(index_of(Bone::kChest)));
  EXPECT_EQ(rig.parts[3].bone, static_cast<int>(index_of(Bone::kUpperChest)));
}

TEST(NatNet, ABoneThatIsNotFiniteOrNoRotationIsNotTracked) {
  auto frame = two_skeletons();
  auto read = std::make_unique<NatNetFrame>();
  auto& bones = frame->skeletons[0].bones;
  bones[0].p_m.x() = std::numeric_limits<float>::quiet_NaN();
  bones[1].p_m.y() = std::numeric_limits<float>::infinity();
  bones[2].R.coeffs().setZero();
  bones[3].is_tracked = false;
  ASSERT_EQ(read_natnet_frame(natnet_frame_packet({4, 1}, *frame), {4, 1}, *read),
            NatNetFault::kNone);
  for (std::size_t b = 0; b < 4; ++b) {
    EXPECT_FALSE(read->skeletons[0].bones[b].is_tracked) << b;
    EXPECT_TRUE(read->skeletons[0].bones[b].p_m.allFinite());
  }
  EXPECT_TRUE(read->skeletons[0].bones[4].is_tracked);
}

// The last four bytes of a frame say nothing.
TEST(NatNet, EachPrefixIsRefused) {
  auto frame = std::make_unique<NatNetFrame>();
  auto models = std::make_unique<NatNetModels>();
  NatNetServer server;
  for (const NatNetVersion version : kVersions) {
    const auto frames = natnet_frame_packet(version, *two_skeletons());
    for (std::size_t size = 0; size + 4 < frames.size(); ++size)
      EXPECT_NE(read_natnet_frame(std::span(frames).first(size), version, *frame),
                NatNetFault::kNone);
    const auto described = natnet_models_packet(version, *two_models());
    for (std::size_t size = 0; size < described.size(); ++size)
      EXPECT_NE(read_natnet_models(std::span(described).first(size), version, *models),
                NatNetFault::kNone);
  }
  const auto answer = natnet_server_packet({3, 1}, 1000);
  for (std::size_t size = 0; size < answer.size(); ++size)
    EXPECT_NE(read_natnet_server(std::span(answer).first(size), server), NatNetFault::kNone);
}

// Cut short, and with a header that says so.
TEST(NatNet, EachPrefixThatSaysItsLengthIsReadWithinItsEnd) {
  auto frame = std::make_unique<NatNetFrame>();
  auto models = std::make_unique<NatNetModels>();
  for (const NatNetVersion version : kVersions) {
    for (auto whole : {natnet_frame_packet(version, *two_skeletons()),
                       natnet_models_packet(version, *two_models())}) {
      for (std::size_t size = 4; size + 4 < whole.size(); ++size) {
        std::vector<std::uint8_t> cut(whole.begin(),
                                      whole.begin() + static_cast<std::ptrdiff_t>(size));
        cut[2] = static_cast<std::uint8_t>((size - 4) & 0xff);
        cut[3] = static_cast<std::uint8_t>((size - 4) >> 8);
        EXPECT_NE(read_natnet_frame(cut, version, *frame), NatNetFault::kNone);
        EXPECT_NE(read_natnet_models(cut, version, *models), NatNetFault::kNone);
      }
    }
  }
}

TEST(NatNet, EachFlippedBitGivesAFaultOrFiniteBones) {
  auto frame = std::make_unique<NatNetFrame>();
  auto models = std::make_unique<NatNetModels>();
  for (const NatNetVersion version : kVersions) {
    for (const auto& whole : {natnet_frame_packet(version, *two_skeletons()),
                              natnet_models_packet(version, *two_models())}) {
      for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        auto damaged = whole;
        damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
        read_natnet_models(damaged, version, *models);
        if (read_natnet_frame(damaged, version, *frame) != NatNetFault::kNone) continue;
        for (const auto& skeleton : frame->skeletons)
          for (const auto& bone : skeleton.bones) ASSERT_TRUE(bone.p_m.allFinite());
      }
    }
  }
}

// Every four bytes in turn as the largest count there is.
TEST(NatNet, NoCountIsTrusted) {
  auto frame = std::make_unique<NatNetFrame>();
  auto models = std::make_unique<NatNetModels>();
  for (const NatNetVersion version : kVersions) {
    for (const auto& whole : {natnet_frame_packet(version, *two_skeletons()),
                              natnet_models_packet(version, *two_models())}) {
      for (std::size_t at = 4; at + 4 <= whole.size(); ++at) {
        for (const unsigned value : {0xffu, 0x7fu, 0x00u}) {
          auto damaged = whole;
          for (std::size_t i = 0; i < 4; ++i) damaged[at + i] = static_cast<std::uint8_t>(value);
          read_natnet_frame(damaged, version, *frame);
          read_natnet_models(damaged, version, *models);
        }
      }
    }
  }
}

TEST(NatNet, TooManySkeletonsAndBonesAreRefused) {
  auto frame = std::make_unique<NatNetFrame>();
  NatNetPacketWriter body;
  for (int i = 0; i < 4; ++i) body.u32(0);  // number, sets, markers, rigid bodies
  auto more = body;
  more.u32(kMostNatNetSkeletons + 1);
  EXPECT_EQ(read_natnet_frame(more.packet(NatNetMessage::kFrame), {3, 1}, *frame),
            NatNetFault::kTooMany);
  body.u32(1).u32(1).u32(kMostNatNetBones + 1);
  EXPECT_EQ(read_natnet_frame(body.packet(NatNetMessage::kFrame), {3, 1}, *frame),
            NatNetFault::kTooMany);
}

TEST(NatNet, OtherMessagesAndVersionsAreRefused) {
  auto frame = std::make_unique<NatNetFrame>();
  const auto packet = natnet_frame_packet({3, 1}, *two_skeletons());
  EXPECT_EQ(read_natnet_frame(packet, {2, 9}, *frame), NatNetFault::kOtherVersion);
  EXPECT_EQ(read_natnet_frame(natnet_server_packet({3, 1}), {3, 1}, *frame),
            NatNetFault::kOtherMessage);
  EXPECT_FALSE(parse_natnet_version("2.9").has_value());
  EXPECT_FALSE(parse_natnet_version("3").has_value());
  EXPECT_EQ(parse_natnet_version("4.1"), (NatNetVersion{4, 1}));
}

TEST(NatNet, AFrameIsReadWithoutAllocating) {
  auto frame = std::make_unique<NatNetFrame>();
  const auto packet = natnet_frame_packet({4, 1}, *two_skeletons());
  const AllocationGuard guard;
  EXPECT_EQ(read_natnet_frame(packet, {4, 1}, *frame), NatNetFault::kNone);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
