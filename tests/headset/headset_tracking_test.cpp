// dance headset without pictures, as a user runs it: the dancer on the bus, what headsets do, and
// what is felt.
#include <gtest/gtest.h>

#include <numbers>

#include "core/signal/haptic.h"
#include "core/signal/touch.h"
#include "tests/headset/headset_programs.h"

namespace dance {
namespace {

class HeadsetTracking : public HeadsetPrograms {
 protected:
  ChildProcess& put_on_tracking(const std::string& script, std::vector<std::string> more = {}) {
    more.insert(more.begin(), "--tracking-only");
    return put_on(script, std::move(more));
  }
};

float turn_between(float a_rad, float b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2.0f * std::numbers::pi_v<float>));
}

TEST_F(HeadsetTracking, TheDancerIsOnTheBusWithABodyWhereItWasSaid) {
  put_on_tracking("", {"--at", "1,2,90", "--rate", "50"});
  ASSERT_TRUE(until([&] {
    return captured_["alice"].poses > 150 && captured_["alice"].skeletons > 0;
  })) << talk();
  const Pose& pose = newest("alice");
  EXPECT_EQ(pose.presence, kAllBones);
  EXPECT_NEAR(pose.p_WH_m.x(), 1.0f, 0.35f);
  EXPECT_NEAR(pose.p_WH_m.z(), 2.0f, 0.35f);
  EXPECT_GT(pose.p_WH_m.y(), 0.6f);
  EXPECT_LT(turn_between(heading_rad(pose.R_PB[0]), 0.5f * std::numbers::pi_v<float>), 0.3f);
  // No more than were wanted, whatever the machine does, and each newer than the one before.
  const auto& times = captured_["alice"].captured;
  const double span_s = (times.back() - times.front()).as_seconds();
  EXPECT_GT(span_s / static_cast<double>(times.size() - 1), 0.95 / 50.0);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]);
  EXPECT_EQ(said("alice dances with it"), 1) << talk();
  children_.front().stop(Duration::s(60));
  EXPECT_TRUE(children_.front().ended_well()) << children_.front().exit_text() << talk();
  EXPECT_EQ(said(" poses, "), 1) << "a summary at the end: " << talk();
  EXPECT_TRUE(has_recorded("session EXITING")) << "the session is ended, not dropped";
}

TEST_F(HeadsetTracking, TheDancerIsPutBeforeWhoStandsThereFaceToFace) {
  Pose bob;
  bob.p_WH_m = {0.0f, 0.95f, 0.0f};
  const auto bob_stands = [&] {
    bob.capture_time = mono_now();
    bob.clock_id = this_clock_id();
    ++bob.sequence;
    bus_->publish(Where::kStage, *GuestId::parse("bob"), bob);
  };
  put_on_tracking("");
  ASSERT_TRUE(until([&] {
    bob_stands();
    return captured_["alice"].poses > 50;
  })) << talk();
  EXPECT_NEAR(newest("alice").p_WH_m.z(), 1.1f, 0.35f);
  EXPECT_LT(turn_between(heading_rad(newest("alice").R_PB[0]), std::numbers::pi_v<float>), 0.3f);
}

TEST_F(HeadsetTracking, GoesOnWhateverTheHeadsetDoesAndSaysEachInOneLine) {
  put_on_tracking(
      // A head moves a little, whatever its eyes look at.
      "at 0 pose head 0 1.65 0 0 0 0 1\nat 60 pose head 1.2 1.65 0 0 0 0 1\n"
      "at 0 pose hips 0 0.95 0 0 0 0 1\n"
      "at 2 nan head\nat 2.5 zero_quaternion head\nat 3 nan left-hand\n"
      "at 3.5 lose hips\nat 7 find hips\n"
      "at 8 focus off\nat 11 focus on\n"
      "at 13 lose_session\n"
      "at 17 lose head\nat 20 find head\n"
      "at 22 lose_instance\n");
  ASSERT_TRUE(until([&] { return said("hips is not tracked any more") == 1; })) << talk();
  EXPECT_TRUE(hears_more(20)) << talk();
  ASSERT_TRUE(until([&] { return said("hips is tracked again") == 1; })) << talk();
  ASSERT_TRUE(until([&] { return said("put down") == 1; })) << talk();
  EXPECT_TRUE(hears_more(5)) << "the dance goes on: " << talk();
  ASSERT_TRUE(until([&] { return said("the headset is worn again") == 1; })) << talk();
  ASSERT_TRUE(until([&] { return said("lost its session; it is looked for again") == 1; }));
  ASSERT_TRUE(until([&] { return said("is back: alice dances with it") == 1; })) << talk();
  EXPECT_TRUE(hears_more(20)) << talk();
  ASSERT_TRUE(until([&] { return said("head is not tracked any more") == 1; })) << talk();
  ASSERT_TRUE(until([&] { return said("head is tracked again") == 1; })) << talk();
  ASSERT_TRUE(until([&] { return said("is back: alice dances with it") == 2; })) << talk();
  EXPECT_TRUE(hears_more(20)) << talk();
  EXPECT_EQ(said("lost its session; it is looked for again"), 2) << talk();
  EXPECT_EQ(said("hips is not tracked"), 1) << talk();
  EXPECT_EQ(said("hips is tracked again"), 1) << talk();
  EXPECT_EQ(said("put down"), 1) << talk();
  EXPECT_EQ(said("is here: alice"), 1) << talk();
  EXPECT_FALSE(children_.front().has_ended());
}

TEST_F(HeadsetTracking, AComebackIsToTheSamePlaceAndBody) {
  // Who comes back stands elsewhere in the room, and is so in the house too.
  put_on_tracking(
      "at 2 pose head 0 1.65 0 0 0 0 1\nat 2.1 pose head 1 1.65 0 0 0 0 1\n"
      "at 2 pose left-hand -0.25 0.75 -0.05 0 0 0 1\n"
      "at 2.1 pose left-hand 0.75 0.75 -0.05 0 0 0 1\n"
      "at 2 pose right-hand 0.25 0.75 -0.05 0 0 0 1\n"
      "at 2.1 pose right-hand 1.25 0.75 -0.05 0 0 0 1\nat 5 lose_session\n",
      {"--at", "0,0,180"});
  ASSERT_TRUE(until([&] { return said("is back") == 1; })) << talk();
  captured_.clear();
  ASSERT_TRUE(hears_more(90)) << talk();
  EXPECT_NEAR(newest("alice").p_WH_m.x(), 1.0f, 0.35f);
}

TEST_F(HeadsetTracking, AHeadsetThatIsAsleepIsToldOnceAndWaitedFor) {
  put_on_tracking("no system until 7\n");
  ASSERT_TRUE(until([&] { return said("asleep or not connected") == 1; })) << talk();
  ASSERT_TRUE(until([&] { return captured_["alice"].poses > 20; })) << talk();
  EXPECT_EQ(said("asleep or not connected"), 1) << talk();
  EXPECT_EQ(said("it is looked for again, and the dance goes on"), 1) << talk();
  EXPECT_EQ(said("is here: alice dances with it"), 1) << talk();
}

TEST_F(HeadsetTracking, WithoutARuntimeOneLineSaysSoUntilItIsTold) {
  set("XR_RUNTIME_JSON", folder_.path("nowhere.json"));
  ChildProcess& program = put_on_tracking("", {"--seconds", "6"});
  ASSERT_TRUE(until([&] { return program.has_ended(); })) << talk();
  EXPECT_TRUE(program.ended_well()) << program.exit_text();
  EXPECT_EQ(said("no OpenXR runtime can be had"), 1) << talk();
  EXPECT_EQ(count_of(talk(), "\n"), 1) << talk();
}

// As when the runtime is closed, or starts anew: a house starts the program again.
TEST_F(HeadsetTracking, EndsWithAnErrorWhenTheRuntimeEndsTheSession) {
  ChildProcess& program = put_on_tracking("at 2 exit\n");
  ASSERT_TRUE(until([&] { return program.has_ended(); })) << talk();
  EXPECT_EQ(program.exit_code(), 1) << program.exit_text() << talk();
  EXPECT_EQ(said("the headset's runtime has ended the session"), 1) << talk();
}

TEST_F(HeadsetTracking, ADancerStaysWhereTheRuntimesSpaceIsMoved) {
  put_on_tracking("at 4 jump 0.8 0 0.5 60\nat 7 pose head 0.1 1.65 0 0 0 0 1\n",
                  {"--at", "1,2,90"});
  ASSERT_TRUE(until([&] { return captured_["alice"].poses > 20; })) << talk();
  const Pose before = newest("alice");
  ASSERT_TRUE(hears_more(500)) << talk();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(hears_more(1));
    EXPECT_LT((newest("alice").p_WH_m - before.p_WH_m).norm(), 0.25f);
    EXPECT_LT(newest("alice").R_PB[0].angularDistance(before.R_PB[0]), 0.4f);
  }
}

TEST_F(HeadsetTracking, AHeadsetThatLiesOnATableIsNoDancer) {
  put_on_tracking("at 3 focus off\nat 9 focus on\n");
  ASSERT_TRUE(until([&] { return captured_["alice"].poses > 20; })) << talk();
  ASSERT_TRUE(until([&] { return said("put down") == 1; })) << talk();
  ASSERT_TRUE(until([&] { return said("the headset is worn again") == 1; })) << talk();
  ASSERT_TRUE(hears_more(20)) << talk();
  Duration longest;
  const std::vector<MonoTime>& captured = captured_["alice"].captured;
  for (std::size_t i = 1; i < captured.size(); ++i)
    longest = std::max(longest, captured[i] - captured[i - 1]);
  EXPECT_GT(longest, Duration::s(2)) << "while nobody wears it";
}

TEST_F(HeadsetTracking, AHapticOnTheBusIsFeltInThatHand) {
  put_on_tracking("");
  ASSERT_TRUE(until([&] { return captured_["alice"].poses > 0; })) << talk();
  Haptic haptic;
  haptic.bone = Bone::kLeftLowerArm;
  haptic.source = HapticSource::kLead;
  haptic.amplitude = 0.5f;
  haptic.duration = Duration::ms(150);
  haptic.frequency_hz = 90.0f;
  haptic.clock_id = this_clock_id();
  EXPECT_TRUE(until([&] {
    haptic.time = haptic.play_time = mono_now();
    ++haptic.number;
    bus_->publish(Where::kCapture, *GuestId::parse("alice"), haptic);
    return has_recorded("haptic left 0.5000 150000000 90.00 ");
  })) << record();
  EXPECT_FALSE(has_recorded("haptic right")) << record();
}

TEST_F(HeadsetTracking, ATouchOnTheStageIsFeltWhereItIs) {
  put_on_tracking("");
  ASSERT_TRUE(until([&] { return captured_["alice"].poses > 0; })) << talk();
  Touch touch;
  touch.bone = Bone::kRightHand;
  touch.other_bone = Bone::kLeftHand;
  touch.force_n = 20.0f;
  touch.approach_m_s = 1.0f;
  touch.clock_id = this_clock_id();
  touch.other = *GuestId::parse("bob");
  EXPECT_TRUE(until([&] {
    touch.time = mono_now();
    ++touch.contact;
    bus_->publish(Where::kStage, *GuestId::parse("alice"), touch);
    return has_recorded("haptic right");
  })) << record();
  EXPECT_FALSE(has_recorded("haptic left")) << record();
}

TEST_F(HeadsetTracking, NothingIsFeltWhereThatIsNotWanted) {
  put_on_tracking("", {"--no-haptics"});
  ASSERT_TRUE(until([&] { return captured_["alice"].poses > 0; })) << talk();
  Haptic haptic;
  haptic.bone = Bone::kLeftHand;
  haptic.amplitude = 0.5f;
  haptic.clock_id = this_clock_id();
  for (int i = 0; i < 10; ++i) {
    haptic.time = haptic.play_time = mono_now();
    ++haptic.number;
    bus_->publish(Where::kCapture, *GuestId::parse("alice"), haptic);
    ASSERT_TRUE(hears_more(5)) << talk();
  }
  EXPECT_FALSE(has_recorded("haptic left")) << record();
}

TEST(HeadsetProgram, SaysInOneLineWhatIsWrong) {
  struct Wrong {
    const char* words;
    const char* line;
  };
  for (const Wrong& it :
       {Wrong{"--at here", "--at 'here': write X,Z or X,Z,HEADING"},
        Wrong{"--guest 'Not A Guest'", "Not A Guest"}, Wrong{"--rate 5", "--rate"},
        Wrong{"--body none", "--body"}, Wrong{"--feel smell", "smell"}}) {
    const Finished refused = run(bin("dance-headset") + " --tracking-only " + it.words);
    EXPECT_NE(refused.exit_code, 0) << it.words;
    EXPECT_NE(refused.talk.find(it.line), std::string::npos) << refused.talk;
  }
}

}  // namespace
}  // namespace dance
