#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/pose/kinematics.h"
#include "formats/rokoko/rokoko_reader.h"
#include "formats/rokoko/rokoko_writer.h"
#include "tests/allocation_guard.h"
#include "tests/formats/rokoko/rokoko_couple.h"

namespace dance {
namespace {

std::span<const std::uint8_t> rokoko_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string couple_text(double seconds = 3.0) {
  RokokoWriter writer;
  return std::string(writer.write(*rokoko_couple(seconds), 2, RokokoWriter::kMostTextBytes).text);
}

// Short enough to be damaged in every way.
std::string small_text() {
  RokokoWriter writer;
  auto frame = rokoko_couple(3.0);
  for (std::size_t j = 4; j < kRokokoJointCount; ++j) frame->actors[0].present[j] = false;
  return std::string(writer.write(*frame, 1, RokokoWriter::kMostTextBytes).text);
}

std::size_t joint_of(std::string_view name) { return find_rokoko_joint(name).value(); }

std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Rokoko, ADancerInTPoseHasStudiosRestRotations) {
  RokokoActor actor;
  const Hands hands;
  make_rokoko_actor(average_skeleton(), Pose(), &hands, actor);
  ASSERT_TRUE(actor.present.all());
  for (std::size_t j = 0; j < kRokokoJointCount; ++j)
    EXPECT_LT(actor.joints[j].rotation.angularDistance(rokoko_t_pose(j)),
              j == joint_of("spine") ? 0.05f : 1e-3f)
        << rokoko_joint_name(j);
}

// In Studio each bone points along its own -Y: of a left-handed space with the left hand at -X.
TEST(Rokoko, InTPoseTheBonesPointAlongTheirMinusY) {
  RokokoActor actor;
  const Hands hands;
  make_rokoko_actor(average_skeleton(), Pose(), &hands, actor);
  const auto along = [&](const char* from, const char* to) {
    const auto& a = actor.joints[joint_of(from)];
    const Eigen::Vector3f way = (actor.joints[joint_of(to)].position - a.position).normalized();
    return way.dot(a.rotation * -Eigen::Vector3f::UnitY());
  };
  EXPECT_GT(along("leftUpperArm", "leftLowerArm"), 0.999f);
  EXPECT_GT(along("rightLowerArm", "rightHand"), 0.999f);
  EXPECT_GT(along("leftUpLeg", "leftLeg"), 0.999f);
  EXPECT_GT(along("rightLeg", "rightFoot"), 0.99f);
  EXPECT_GT(along("spine", "chest"), 0.99f);
  EXPECT_GT(along("leftIndexProximal", "leftIndexMedial"), 0.999f);
  EXPECT_GT(along("rightThumbProximal", "rightThumbMedial"), 0.999f);
  EXPECT_GT(along("leftThumbMedial", "leftThumbDistal"), 0.999f);
  EXPECT_LT(actor.joint(RokokoBody::kLeftHand).position.x(), -0.5f);
  EXPECT_GT(actor.joint(RokokoBody::kLeftToe).position.z(), 0.05f);
}

TEST(Rokoko, ATurnToTheLeftIsAnotherWayRoundInStudio) {
  Pose pose;
  pose.R_PB[0] = Eigen::AngleAxisf(1.0f, Eigen::Vector3f::UnitY());
  pose.p_WH_m = {0.3f, 0.9f, -0.2f};
  RokokoActor actor;
  make_rokoko_actor(average_skeleton(), pose, nullptr, actor);
  const RokokoJoint& hip = actor.joint(RokokoBody::kHip);
  EXPECT_LT(hip.rotation.angularDistance(
                Eigen::Quaternionf(Eigen::AngleAxisf(-1.0f, Eigen::Vector3f::UnitY()))),
            1e-3f);
  EXPECT_LT((hip.position - Eigen::Vector3f(-0.3f, 0.9f, -0.2f)).norm(), 1e-6f);
}

TEST(Rokoko, WhatIsWrittenIsReadAgain) {
  const auto frame = rokoko_couple(7.25);
  RokokoReader reader;
  ASSERT_EQ(reader.read(rokoko_bytes(couple_text(7.25))), RokokoFault::kNone);
  const RokokoFrame& read = reader.frame();
  EXPECT_EQ(read.timestamp_s, 7.25);
  EXPECT_EQ(read.fps, 60.0);
  ASSERT_EQ(read.actors.size(), 2u);
  for (std::size_t a = 0; a < 2; ++a) {
    const RokokoActor& is = read.actors[a];
    const RokokoActor& was = frame->actors[a];
    EXPECT_EQ(is.name, was.name);
    EXPECT_EQ(is.color, was.color);
    EXPECT_EQ(is.present, was.present);
    EXPECT_TRUE(is.has_body);
    EXPECT_EQ(is.has_left_glove, was.has_left_glove);
    EXPECT_FALSE(is.has_face);
    EXPECT_NEAR(is.total_height_m, was.total_height_m, 1e-5f);
    EXPECT_NEAR(is.hip_height_m, was.hip_height_m, 1e-5f);
    for (std::size_t j = 0; j < kRokokoJointCount; ++j) {
      if (!was.present[j]) continue;
      EXPECT_LT((is.joints[j].position - was.joints[j].position).norm(), 2e-6f);
      EXPECT_LT(is.joints[j].rotation.angularDistance(was.joints[j].rotation), 1e-3f);
    }
  }
}

TEST(Rokoko, EitherWayOfWritingTheVersionIsRead) {
  const std::string text = couple_text();
  RokokoReader reader;
  for (const char* version : {"3", "3.0", "\"3.0\"", "\"3\""})
    EXPECT_EQ(reader.read(rokoko_bytes(with(text, "\"3,0\"", version))), RokokoFault::kNone)
        << version;
  for (const char* version : {"2", "\"2,5\"", "4", "null", "{}"})
    EXPECT_EQ(reader.read(rokoko_bytes(with(text, "\"3,0\"", version))), RokokoFault::kOtherVersion)
        << version;
}

TEST(Rokoko, KeysThatAreNotKnownChangeNothing) {
  std::string text = with(couple_text(), R"("characters":[])",
                          R"("characters":[{"name":"x","joints":[{"position":{"x":1}}]}],"q":{})");
  text = with(text, R"("hip":)", R"("tail":{"position":{"x":1}},"hip":)");
  RokokoReader reader;
  ASSERT_EQ(reader.read(rokoko_bytes(text)), RokokoFault::kNone);
  EXPECT_EQ(reader.frame().actors.size(), 2u);
  EXPECT_TRUE(reader.frame().actors[0].has(RokokoBody::kHip));
}

TEST(Rokoko, AJointThatIsNotWholeOrNotARotationIsAbsent) {
  RokokoReader reader;
  const std::string text = couple_text();
  const std::pair<const char*, const char*> kDamages[] = {
      {R"("hip":{"position":{"x":)", R"("hip":{"position":{"v":)"},
      {R"("hip":{"position":)", R"("hip":{"position":{"x":9e5,"y":0,"z":0},"p":)"},
      {R"("hip":{"position":)", R"("hip":{"position":[1,2,3],"p":)"},
      {R"("hip":)", R"("hop":)"}};
  for (const auto& [what, by] : kDamages) {
    ASSERT_EQ(reader.read(rokoko_bytes(with(text, what, by))), RokokoFault::kNone) << by;
    EXPECT_FALSE(reader.frame().actors[0].has(RokokoBody::kHip)) << by;
    EXPECT_TRUE(reader.frame().actors[0].has(RokokoBody::kHead));
  }
}

TEST(Rokoko, EachPrefixIsRefused) {
  const std::string text = small_text();
  RokokoReader reader;
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_NE(reader.read(rokoko_bytes(text).first(size)), RokokoFault::kNone) << size;
}

TEST(Rokoko, EachFlippedBitGivesAFaultOrFiniteJoints) {
  const std::string text = small_text();
  RokokoReader reader;
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    std::string damaged = text;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    if (reader.read(rokoko_bytes(damaged)) != RokokoFault::kNone) continue;
    for (const RokokoActor& actor : reader.frame().actors)
      for (std::size_t j = 0; j < kRokokoJointCount; ++j) {
        if (!actor.present[j]) continue;
        ASSERT_TRUE(actor.joints[j].position.allFinite());
        ASSERT_NEAR(actor.joints[j].rotation.norm(), 1.0f, 1e-3f);
      }
  }
}

TEST(Rokoko, DepthNamesAndActorsAreBounded) {
  RokokoReader reader;
  EXPECT_EQ(reader.read(rokoko_bytes(std::string(1'000'000, '['))), RokokoFault::kNotJson);
  std::string deep;
  for (int i = 0; i < 50'000; ++i) deep += R"({"scene":)";
  EXPECT_EQ(reader.read(rokoko_bytes(deep)), RokokoFault::kNotJson);
  const auto scene = [](const std::string& actors) {
    return R"({"version":"3,0","scene":{"timestamp":1,"actors":[)" + actors + "]}}";
  };
  EXPECT_EQ(reader.read(rokoko_bytes(scene(R"({"name":")" + std::string(65, 'n') + "\"}"))),
            RokokoFault::kBadName);
  EXPECT_EQ(reader.read(rokoko_bytes(scene("{}"))), RokokoFault::kBadName);
  EXPECT_EQ(reader.read(rokoko_bytes(scene(R"({"name":"a"})"))), RokokoFault::kNone);
  std::string many = R"({"name":"a"})";
  for (std::size_t i = 0; i < RokokoFrame::kMostActors; ++i) many += R"(,{"name":"a"})";
  EXPECT_EQ(reader.read(rokoko_bytes(scene(many))), RokokoFault::kTooManyActors);
  EXPECT_EQ(reader.read(rokoko_bytes(R"({"version":"3,0","scene":{"actors":[]}})")),
            RokokoFault::kNoScene);
  EXPECT_EQ(reader.read(rokoko_bytes("\xff\xfe")), RokokoFault::kNotJson);
}

TEST(Rokoko, ADatagramWithoutRoomForAnActorEndsBeforeIt) {
  RokokoWriter writer;
  RokokoReader reader;
  const auto frame = rokoko_couple(1.0);
  const std::size_t one = writer.write(*frame, 1, RokokoWriter::kMostTextBytes).text.size();
  const auto written = writer.write(*frame, 2, one + 100);
  EXPECT_EQ(written.actors, 1u);
  EXPECT_LE(written.text.size(), one + 100);
  ASSERT_EQ(reader.read(rokoko_bytes(written.text)), RokokoFault::kNone);
  EXPECT_EQ(reader.frame().actors.size(), 1u);
}

TEST(Rokoko, TheFullestActorFitsIntoItsBound) {
  RokokoFrame frame;
  RokokoActor actor;
  ASSERT_TRUE(actor.name.assign(std::string(RokokoActor::kLongestName, 'n')));
  actor.present.set();
  for (RokokoJoint& joint : actor.joints) joint.position.setConstant(-999.999999f);
  ASSERT_TRUE(frame.actors.try_push(actor));
  RokokoWriter writer;
  EXPECT_LT(writer.write(frame, 1, 1 << 20).text.size(), RokokoWriter::kMostActorBytes);
}

TEST(Rokoko, AnActorIsMadeAndWrittenWithoutAllocating) {
  RokokoWriter writer;
  auto frame = rokoko_couple(1.0);
  const Hands hands;
  const Pose pose;
  const Skeleton skeleton = average_skeleton();
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) {
    make_rokoko_actor(skeleton, pose, &hands, frame->actors[0]);
    EXPECT_EQ(writer.write(*frame, 2, RokokoWriter::kMostTextBytes).actors, 2u);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
