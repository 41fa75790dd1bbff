#include "consumers/engine/engine_consumer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <limits>
#include <vector>

#include "core/pose/history.h"
#include "core/pose/kinematics.h"
#include "tests/allocation_guard.h"
#include "tests/consumers/engine/engine_house.h"
#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

Eigen::Quaternionf rotation(const dance_pose& pose, std::size_t bone) {
  return Eigen::Quaternionf(Eigen::Vector4f(pose.rotation[bone]));
}

TEST_F(EngineHouse, AnEngineReadsTheNewestPoseAsItCame) {
  Random random(1);
  const Pose sent = random_pose(random);
  const MonoTime now = mono_now();
  show(kAlice, sent, now - Duration::ms(30), now - Duration::ms(2));
  auto pose = of_size<dance_pose>();
  ASSERT_EQ(dance_adapter_newest(adapter_, slot_of("alice"), &pose), DANCE_OK);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_TRUE(is_same_rotation(rotation(pose, b), sent.R_PB[b]));
  EXPECT_EQ(Eigen::Vector3f(pose.hips_position), sent.p_WH_m);
  EXPECT_EQ(pose.capture_ns, (now - Duration::ms(30)).since_zero_ns());
  EXPECT_EQ(pose.staged_ns, (now - Duration::ms(2)).since_zero_ns());
  EXPECT_EQ(pose.kind, static_cast<std::uint32_t>(DANCE_POSE_NEWEST));
  EXPECT_EQ(pose.presence, kAllBones);
}

TEST_F(EngineHouse, BetweenPosesItIsWhatThePoseHistorySays) {
  Random random(2);
  PoseHistory history(32);
  const MonoTime begin = mono_now() - Duration::ms(400);
  const Duration lag = Duration::ms(35);
  for (int i = 0; i < 20; ++i) {
    Pose pose = random_pose(random, 0.4f);
    normalize(pose);
    const MonoTime captured = begin + Duration::us(16'667) * i;
    show(kAlice, pose, captured, captured + lag);
    pose.capture_time = captured;
    history.push(pose);
  }
  const std::uint32_t slot = slot_of("alice");
  for (int i = 0; i < 300; ++i) {
    const MonoTime content = begin + Duration::us(1'050) * i;
    const auto wanted = history.at(content);
    auto pose = of_size<dance_pose>();
    ASSERT_EQ(dance_adapter_at(adapter_, slot, (content + lag).since_zero_ns(), &pose), DANCE_OK);
    EXPECT_EQ(pose.capture_ns, wanted->pose.capture_time.since_zero_ns());
    EXPECT_EQ(pose.time_ns, (content + lag).since_zero_ns());
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_EQ(rotation(pose, b).coeffs(), wanted->pose.R_PB[b].coeffs()) << i << " bone " << b;
    EXPECT_EQ(Eigen::Vector3f(pose.hips_position), wanted->pose.p_WH_m);
  }
}

TEST_F(EngineHouse, SaysHowAPoseWasMadeAndHoldsWhatIsTooFar) {
  const MonoTime begin = mono_now() - Duration::ms(500);
  for (int i = 0; i < 10; ++i)
    show(kAlice, Pose(), begin + Duration::ms(10) * i, begin + Duration::ms(10) * i);
  const std::uint32_t slot = slot_of("alice");
  const auto kind_at = [&](Duration since) {
    auto pose = of_size<dance_pose>();
    EXPECT_EQ(dance_adapter_at(adapter_, slot, (begin + since).since_zero_ns(), &pose), DANCE_OK);
    return std::pair(static_cast<dance_pose_kind>(pose.kind),
                     Duration::ns(pose.time_ns - begin.since_zero_ns()));
  };
  EXPECT_EQ(kind_at(Duration::ms(90)), std::pair(DANCE_POSE_NEWEST, Duration::ms(90)));
  EXPECT_EQ(kind_at(Duration::ms(45)), std::pair(DANCE_POSE_INTERPOLATED, Duration::ms(45)));
  EXPECT_EQ(kind_at(Duration::ms(190)), std::pair(DANCE_POSE_PREDICTED, Duration::ms(190)));
  EXPECT_EQ(kind_at(Duration::ms(900)), std::pair(DANCE_POSE_HELD, Duration::ms(190)));
  EXPECT_EQ(kind_at(-Duration::ms(5)), std::pair(DANCE_POSE_HELD, Duration()));
}

TEST_F(EngineHouse, AnEngineGetsProportionsHandsAndWhoIsThere) {
  const MonoTime now = mono_now();
  Skeleton tall = average_skeleton(1.9f);
  tall.version = 41;
  consumer_->on_skeleton(kAlice, tall, now);
  EXPECT_EQ(dance_adapter_guests(adapter_, nullptr, 0), 0u) << "nobody has been seen yet";
  show(kBob, Pose(), now, now);
  show(kAlice, Pose(), now, now);
  dance_guest guests[DANCE_MAX_GUESTS]{};
  guests[0].struct_size = sizeof(dance_guest);
  ASSERT_EQ(dance_adapter_guests(adapter_, guests, 1), 2u) << "more than there was room for";
  ASSERT_EQ(dance_adapter_guests(adapter_, guests, DANCE_MAX_GUESTS), 2u);
  EXPECT_STREQ(guests[0].id, "alice");
  EXPECT_STREQ(guests[1].id, "bob");
  EXPECT_EQ(guests[0].has_skeleton, 1u);
  EXPECT_EQ(guests[1].has_skeleton, 0u);
  EXPECT_EQ(guests[1].newest_ns, now.since_zero_ns());

  auto skeleton = of_size<dance_skeleton>();
  ASSERT_EQ(dance_adapter_skeleton(adapter_, guests[0].slot, &skeleton), DANCE_OK);
  EXPECT_EQ(skeleton.version, 1u);
  EXPECT_EQ(Eigen::Vector3f(skeleton.offset[0]), tall.offset_m[0]);
  consumer_->on_skeleton(kAlice, tall, now);
  ASSERT_EQ(dance_adapter_skeleton(adapter_, guests[0].slot, &skeleton), DANCE_OK);
  EXPECT_EQ(skeleton.version, 1u) << "the same again";
  ASSERT_EQ(dance_adapter_skeleton(adapter_, guests[1].slot, &skeleton), DANCE_OK);
  EXPECT_EQ(skeleton.version, 0u);
  EXPECT_EQ(Eigen::Vector3f(skeleton.offset[5]), average_skeleton().offset_m[5]);

  auto fingers = of_size<dance_hands>();
  EXPECT_EQ(dance_adapter_hands(adapter_, guests[0].slot, &fingers), DANCE_NO_DATA);
  Hands hands;
  hands.R_PB[3] = Eigen::Quaternionf(Eigen::AngleAxisf(0.7f, Eigen::Vector3f::UnitZ()));
  hands.presence = 0x3fffffff;
  hands.clock_id = this_clock_id();
  hands.capture_time = now;
  consumer_->on_hands(kAlice, hands, now);
  ASSERT_EQ(dance_adapter_hands(adapter_, guests[0].slot, &fingers), DANCE_OK);
  EXPECT_EQ(Eigen::Vector4f(fingers.rotation[3]), hands.R_PB[3].coeffs());
  EXPECT_EQ(fingers.presence, 0x3fffffffu);
}

TEST_F(EngineHouse, AnEngineHearsTheBeat) {
  auto heard = of_size<dance_beat>();
  EXPECT_EQ(dance_adapter_beat(adapter_, dance_adapter_now_ns(), &heard), DANCE_NO_DATA);
  const MonoTime now = mono_now();
  Beat beat;
  beat.time = now;
  beat.clock_id = this_clock_id();
  beat.beat_time = now + Duration::ms(100);
  beat.beat = 64.0;
  beat.tempo_bpm = 120.0;
  beat.beats_per_bar = 4;
  beat.confidence = 0.75f;
  beat.playing = true;
  consumer_->on_beat(beat, now);
  const std::int64_t later_ns = (now + Duration::ms(600)).since_zero_ns();
  ASSERT_EQ(dance_adapter_beat(adapter_, later_ns, &heard), DANCE_OK);
  EXPECT_NEAR(heard.position_beats, 65.0, 1e-6);
  EXPECT_EQ(heard.tempo_bpm, 120.0);
  EXPECT_EQ(heard.beats_per_bar, 4u);
  EXPECT_EQ(heard.playing, 1u);
  EXPECT_EQ(dance_adapter_beat(adapter_, (now + Duration::s(4)).since_zero_ns(), &heard),
            DANCE_NO_DATA);
  beat.playing = false;
  consumer_->on_beat(beat, now);
  ASSERT_EQ(dance_adapter_beat(adapter_, later_ns, &heard), DANCE_OK);
  EXPECT_EQ(heard.position_beats, 64.0);
  EXPECT_EQ(heard.playing, 0u);
  beat.clock_id = this_clock_id() ^ 1;
  consumer_->on_beat(beat, now);
  EXPECT_EQ(consumer_->counters().invalid, 1u) << "the beat of another clock";
}

TEST_F(EngineHouse, WhoFallsSilentLeavesAndWhoComesIsAnotherGeneration) {
  const MonoTime now = mono_now(), then = now - EngineConsumer::kSilence;
  show(kAlice, Pose(), then, then);
  consumer_->on_second(now);
  const std::uint32_t slot = slot_of("alice");
  auto pose = of_size<dance_pose>();
  ASSERT_EQ(dance_adapter_newest(adapter_, slot, &pose), DANCE_OK);
  const std::uint32_t generation = pose.generation;
  consumer_->on_second(now + Duration::ms(1));
  EXPECT_EQ(dance_adapter_newest(adapter_, slot, &pose), DANCE_NO_GUEST);
  std::uint32_t none = 0;
  EXPECT_EQ(dance_adapter_find(adapter_, "alice", &none), DANCE_NO_GUEST);
  for (std::size_t i = 0; i < engine::kGuestSlots; ++i)
    show(*GuestId::parse("g" + std::to_string(i)), Pose(), now, now);
  ASSERT_EQ(dance_adapter_newest(adapter_, slot, &pose), DANCE_OK);
  EXPECT_NE(pose.generation, generation);
  show(kAlice, Pose(), now, now);
  EXPECT_EQ(consumer_->counters().too_many, 1u);
  EXPECT_NE(consumer_->summary().find("beyond 64"), std::string::npos);
}

TEST_F(EngineHouse, TheDanceOfAnotherClockIsShownAsItsPosesCome) {
  const MonoTime now = mono_now();
  for (int i = 0; i < 20; ++i) {
    Pose pose;
    pose.clock_id = this_clock_id() ^ 1;
    pose.capture_time = MonoTime::from_ns(5'000'000'000) + Duration::ms(10) * i;
    consumer_->on_pose(kAlice, pose, now + Duration::ms(10) * (i - 20));
  }
  auto pose = of_size<dance_pose>();
  ASSERT_EQ(dance_adapter_newest(adapter_, slot_of("alice"), &pose), DANCE_OK);
  EXPECT_EQ(pose.capture_ns, (now - Duration::ms(10)).since_zero_ns());
}

TEST_F(EngineHouse, NeitherSideAllocatesOnThePathOfAPose) {
  const MonoTime now = mono_now();
  Skeleton skeleton = average_skeleton();
  auto pose = of_size<dance_pose>();
  auto guest = of_size<dance_guest>();
  dance_adapter_state(adapter_);
  AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    const MonoTime t = now + Duration::ms(10) * (i - 100);
    show(i % 2 == 0 ? kAlice : kBob, Pose(), t, t);
    skeleton.offset_m[0].y() += 0.001f;
    consumer_->on_skeleton(kAlice, skeleton, t);
    consumer_->on_hands(kAlice, Hands(), t);
    consumer_->on_second(now);
    EXPECT_GE(dance_adapter_guests(adapter_, &guest, 1), 1u);
    EXPECT_EQ(dance_adapter_newest(adapter_, guest.slot, &pose), DANCE_OK);
    EXPECT_EQ(dance_adapter_at(adapter_, guest.slot, t.since_zero_ns() + 9'000'000, &pose),
              DANCE_OK);
    EXPECT_EQ(dance_adapter_at(adapter_, guest.slot, t.since_zero_ns() - 9'000'000, &pose),
              DANCE_OK);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST_F(EngineHouse, AHandleOutlivesTheHouseAndFindsTheNextOne) {
  MonoTime now = mono_now();
  show(kAlice, Pose(), now, now);
  EXPECT_EQ(dance_adapter_state(adapter_), DANCE_OK);
  ASSERT_TRUE(consumer_->finish());
  consumer_->on_pose(kAlice, Pose(), now);  // too late, and no crash
  EXPECT_EQ(dance_adapter_state(adapter_), DANCE_NO_HOUSE);
  EXPECT_EQ(dance_adapter_guests(adapter_, nullptr, 0), 0u);
  consumer_.reset();
  open();
  now = mono_now();
  show(kBob, Pose(), now, now);
  while (dance_adapter_state(adapter_) != DANCE_OK) usleep(10'000);
  slot_of("bob");
  auto counters = of_size<dance_counters>();
  ASSERT_EQ(dance_adapter_counters(adapter_, &counters), DANCE_OK);
  EXPECT_EQ(counters.attached, 2u);
}

TEST_F(EngineHouse, TheSameDancerStandsAtTheSamePlaceInAllAxes) {
  Random random(6);
  const MonoTime now = mono_now();
  const Pose sent = random_pose(random);
  show(kAlice, sent, now, now);
  BodyFrames frames;
  forward_kinematics(average_skeleton(), sent, frames);
  for (const auto& [axes, place] :
       std::vector<std::pair<dance_axes, Eigen::Vector3f (*)(const Eigen::Vector3f&)>>{
           {DANCE_AXES_GLTF, [](const Eigen::Vector3f& p) { return p; }},
           {DANCE_AXES_UNITY,
            [](const Eigen::Vector3f& p) { return Eigen::Vector3f(-p.x(), p.y(), p.z()); }},
           {DANCE_AXES_UNREAL,
            [](const Eigen::Vector3f&
                   p) { return Eigen::Vector3f(100 * p.z(), -100 * p.x(), 100 * p.y()); }},
           {DANCE_AXES_BLENDER,
            [](const Eigen::Vector3f& p) { return Eigen::Vector3f(p.x(), -p.z(), p.y()); }}}) {
    dance_adapter* engine = dance_adapter_open(memory_of_test().c_str(), axes);
    auto pose = of_size<dance_pose>();
    auto skeleton = of_size<dance_skeleton>();
    auto world = of_size<dance_world>();
    const std::uint32_t slot = slot_of("alice");
    ASSERT_EQ(dance_adapter_newest(engine, slot, &pose), DANCE_OK);
    ASSERT_EQ(dance_adapter_skeleton(engine, slot, &skeleton), DANCE_OK);
    ASSERT_EQ(dance_world_of(&skeleton, &pose, &world), DANCE_OK);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_TRUE(Eigen::Vector3f(world.position[b]).isApprox(place(frames.p_WB_m[b]), 1e-4f));
    for (std::size_t t = 0; t < kTipCount; ++t)
      EXPECT_TRUE(Eigen::Vector3f(world.tip[t]).isApprox(place(frames.p_WT_m[t]), 1e-4f));
    dance_adapter_close(engine);
  }
}

TEST_F(EngineHouse, WrongArgumentsAreAnswersAndNoCrash) {
  const MonoTime now = mono_now();
  show(kAlice, Pose(), now, now);
  auto pose = of_size<dance_pose>();
  const std::int64_t now_ns = now.since_zero_ns();
  for (const char* name : {"Stage", "a b", "../x", "0123456789012345678901234"})
    EXPECT_EQ(dance_adapter_open(name, DANCE_AXES_GLTF), nullptr) << name;
  EXPECT_EQ(dance_adapter_newest(nullptr, 0, &pose), DANCE_BAD_ARGUMENT);
  EXPECT_EQ(dance_adapter_newest(adapter_, 0, nullptr), DANCE_BAD_ARGUMENT);
  EXPECT_EQ(dance_adapter_newest(adapter_, DANCE_MAX_GUESTS, &pose), DANCE_BAD_ARGUMENT);
  EXPECT_EQ(dance_adapter_newest(adapter_, 5, &pose), DANCE_NO_GUEST);
  for (const std::uint32_t size : {0u, 4u, std::uint32_t{sizeof pose} - 1, 0xffffffffu}) {
    pose.struct_size = size;
    EXPECT_EQ(dance_adapter_newest(adapter_, 0, &pose), DANCE_BAD_ARGUMENT);
  }
  pose.struct_size = sizeof pose;
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::min(), std::int64_t{0},
                                  std::numeric_limits<std::int64_t>::max()})
    EXPECT_EQ(dance_adapter_at(adapter_, 0, time, &pose), DANCE_BAD_ARGUMENT);
  EXPECT_EQ(dance_adapter_at(adapter_, 0, now_ns, &pose), DANCE_OK);
  EXPECT_EQ(dance_adapter_find(adapter_, "ALICE", &pose.kind), DANCE_BAD_ARGUMENT);
  EXPECT_EQ(dance_adapter_state(nullptr), DANCE_BAD_ARGUMENT);
  dance_adapter_close(nullptr);
  EXPECT_EQ(dance_bone_name(DANCE_BONES), nullptr);
  EXPECT_STREQ(dance_bone_name(21), "rightToes");
  EXPECT_STREQ(dance_finger_bone_name(0), "leftThumbMetacarpal");
  EXPECT_EQ(dance_bone_parent(0), -1);
  EXPECT_EQ(dance_bone_parent(9), 8);
  EXPECT_EQ(dance_finger_bone_parent(29), 28);
  EXPECT_EQ(dance_adapter_abi(), static_cast<std::uint32_t>(DANCE_ADAPTER_ABI));
}

TEST_F(EngineHouse, ACallerOfALaterVersionGetsZerosForWhatThisOneDoesNotKnow) {
  struct Later {
    dance_pose pose;
    std::uint32_t more[4];
  };
  const MonoTime now = mono_now();
  show(kAlice, Pose(), now, now);
  Later later;
  std::memset(&later, 0xff, sizeof later);
  later.pose.struct_size = sizeof later;
  ASSERT_EQ(dance_adapter_newest(adapter_, slot_of("alice"), &later.pose), DANCE_OK);
  for (const std::uint32_t word : later.more) EXPECT_EQ(word, 0u);
}

TEST(EngineConsumer, ANameThatIsTakenOrUnfitIsToldWithTheCure) {
  const auto first = EngineConsumer::open(memory_of_test(), 0.0, 1, mono_now());
  ASSERT_TRUE(first);
  const auto second = EngineConsumer::open(memory_of_test(), 0.0, 1, mono_now());
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("another name"), std::string::npos);
  const auto unfit = EngineConsumer::open("My Stage", 0.0, 1, mono_now());
  ASSERT_FALSE(unfit);
  EXPECT_NE(unfit.error().what.find("a-z"), std::string::npos);
}

}  // namespace
}  // namespace dance
