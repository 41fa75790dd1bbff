#include "consumers/files/glb_consumer.h"

#include <gtest/gtest.h>

#include "core/pose/kinematics.h"
#include "formats/gltf/glb.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

const GuestId kLead = GuestId::parse("alice").value();
const GuestId kFollow = GuestId::parse("bob").value();

MonoTime at_s(double s) { return MonoTime::from_us(5'000'000) + Duration::seconds(s); }

// Walks along X, a metre a second of its clock.
Pose walking(double s, std::uint64_t clock_id, double clock_ahead_s) {
  Pose pose;
  pose.capture_time = at_s(s + clock_ahead_s);
  pose.clock_id = clock_id;
  pose.p_WH_m = {static_cast<float>(s), 0.9f, 0.0f};
  return pose;
}

class GlbConsumers : public testing::Test {
 protected:
  std::shared_ptr<OutputFile> output() { return std::move(*OutputFile::open(path())); }
  std::string path() const { return folder_.path("dance.glb"); }
  std::vector<NamedClip> written() {
    auto clips = read_glb(bytes_in(path()));
    EXPECT_TRUE(clips.has_value()) << clips.error().what;
    return clips ? std::move(*clips) : std::vector<NamedClip>();
  }
  TestFolder folder_{"glb-consumer"};
};

TEST_F(GlbConsumers, WriteAllGuestsOnOneTimeLineWhateverTheirClocks) {
  GlbConsumer consumer(output(), 60.0, GuestId());
  // Bob's house is 1000 s ahead, sends 25 poses a second and begins half a second later.
  for (int i = 0; i < 60; ++i) consumer.on_pose(kLead, walking(i / 30.0, 1, 0.0), at_s(i / 30.0));
  for (int i = 0; i < 30; ++i)
    consumer.on_pose(kFollow, walking(0.5 + i / 25.0, 2, 1000.0), at_s(0.5 + i / 25.0));
  consumer.on_skeleton(kFollow, average_skeleton(1.9f), at_s(1.0));
  ASSERT_TRUE(consumer.finish().has_value());
  const auto clips = written();
  ASSERT_EQ(clips.size(), 2u);
  ASSERT_EQ(clips[0].clip.frames.size(), clips[1].clip.frames.size());
  EXPECT_NEAR(static_cast<double>(clips[0].clip.frames.size()), 119.0, 1.0);
  // Both walk through the same places at the same moments.
  for (std::size_t f = 35; f < 90; ++f)
    EXPECT_NEAR(clips[0].clip.frames[f].p_WH_m.x(), clips[1].clip.frames[f].p_WH_m.x(), 2e-3f);
  // Before it comes, and after it has left, bob stands still.
  EXPECT_NEAR(clips[1].clip.frames[0].p_WH_m.x(), 0.5f, 1e-3f);
  EXPECT_NEAR(clips[1].clip.frames.back().p_WH_m.x(), 0.5f + 29.0f / 25.0f, 1e-3f);
  EXPECT_NEAR(standing_height_m(clips[1].clip.skeleton), 1.9f, 0.01f);
  EXPECT_NE(consumer.summary().find("frames of alice, bob to "), std::string::npos)
      << consumer.summary();
}

TEST_F(GlbConsumers, KeepHandsAndLeaveOthersOutWhereOneGuestIsChosen) {
  GlbConsumer consumer(output(), 60.0, kLead);
  for (int i = 0; i < 30; ++i) {
    consumer.on_pose(kLead, walking(i / 60.0, 1, 0.0), at_s(i / 60.0));
    consumer.on_pose(kFollow, walking(i / 60.0, 1, 0.0), at_s(i / 60.0));
    Hands hands;
    hands.clock_id = 1;
    hands.capture_time = at_s(i / 60.0);
    hands.presence = (1u << kFingerBoneCount) - 1;
    hands.R_PB[4] = Eigen::AngleAxisf(0.03f * static_cast<float>(i), Eigen::Vector3f::UnitZ());
    consumer.on_hands(kLead, hands, at_s(i / 60.0));
  }
  ASSERT_TRUE(consumer.finish().has_value());
  const auto clips = written();
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].name, "alice");
  ASSERT_EQ(clips[0].clip.hands.size(), 30u);
  EXPECT_NEAR(clips[0].clip.hands[20].R_PB[4].angularDistance(Eigen::Quaternionf::Identity()), 0.6f,
              1e-2f);
}

TEST_F(GlbConsumers, CountWhatIsLeftOutAndStayBounded) {
  GlbConsumer consumer(output(), 60.0, GuestId(), 20);
  for (int i = 0; i < 30; ++i) consumer.on_pose(kLead, walking(i / 60.0, 1, 0.0), at_s(i / 60.0));
  ASSERT_TRUE(consumer.finish().has_value());
  EXPECT_EQ(written().front().clip.frames.size(), 20u);
  EXPECT_NE(consumer.summary().find("10 messages left out"), std::string::npos)
      << consumer.summary();
}

TEST_F(GlbConsumers, ASilenceIsStoodThroughAndCounted) {
  GlbConsumer consumer(output(), 60.0, GuestId());
  for (const double begin_s : {0.0, 5.0})
    for (int i = 0; i < 10; ++i)
      consumer.on_pose(kLead, walking(begin_s + i / 60.0, 1, 0.0), at_s(begin_s + i / 60.0));
  consumer.on_pose(kLead, walking(1.0, 1, 0.0), at_s(6.0));  // old
  ASSERT_TRUE(consumer.finish().has_value());
  const auto clips = written();
  ASSERT_EQ(clips.size(), 1u);
  ASSERT_EQ(clips[0].clip.frames.size(), 310u);
  EXPECT_NEAR(clips[0].clip.frames[200].p_WH_m.x(), 9.0f / 60.0f, 1e-3f);
  EXPECT_NEAR(clips[0].clip.frames[305].p_WH_m.x(), 305.0f / 60.0f, 1e-3f);
  EXPECT_NE(consumer.summary().find("1 silences"), std::string::npos) << consumer.summary();
  EXPECT_NE(consumer.summary().find("1 poses and hands left out"), std::string::npos)
      << consumer.summary();
}

TEST_F(GlbConsumers, SayThatNobodyWasHeardInsteadOfAnEmptyFile) {
  GlbConsumer consumer(output(), 60.0, kFollow);
  const auto finished = consumer.finish();
  ASSERT_FALSE(finished.has_value());
  EXPECT_NE(finished.error().what.find("no GLB written, as no pose was heard of bob"),
            std::string::npos);
}

}  // namespace
}  // namespace dance
