// The consumer and the receiver of Rokoko's protocol, over the loopback device.
#include "producers/rokoko/rokoko_receiver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "consumers/rokoko/rokoko_consumer.h"
#include "core/net/mono_clock.h"
#include "core/pose/kinematics.h"
#include "formats/bvh/clip_file.h"
#include "formats/rokoko/rokoko_writer.h"
#include "tests/formats/rokoko/rokoko_couple.h"
#include "tests/producers/rokoko/pose_log_sink.h"

namespace dance {
namespace {

constexpr float kRokokoTolerance_m = 1e-4f;
const GuestId kRokokoAna = GuestId::parse("ana").value();
const GuestId kBen = GuestId::parse("ben").value();

class RokokoPair : public testing::Test {
 protected:
  void SetUp() override {
    poller_ = std::move(*Poller::create());
    address_ = "127.0.0.1:" + std::to_string(*free_loopback_port());
  }
  void open_receiver(const std::string& actor = "") {
    auto receiver = RokokoReceiver::open({kBen, address_, actor}, sink_, *poller_);
    ASSERT_TRUE(receiver.has_value()) << receiver.error().what;
    receiver_ = std::move(*receiver);
  }
  std::unique_ptr<RokokoConsumer> consumer(RokokoConsumer::Dialect dialect) {
    auto opened = RokokoConsumer::open({address_, dialect, 1000.0, 7});
    EXPECT_TRUE(opened.has_value()) << opened.error().what;
    return std::move(*opened);
  }
  void take(std::string_view text, MonoTime received = mono_now(), std::uint16_t port = 5000) {
    receiver_->take(Address::loopback(port),
                    {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, received,
                    received);
  }
  // Until the receiver has so many datagrams; a second at most.
  void wait_for_poses(std::size_t poses) {
    for (int i = 0; i < 100 && sink_.poses.size() < poses; ++i) poller_->run_once(Duration::ms(10));
  }
  // All joints but the chest, which Studio's bodies do not have. Millimetres.
  struct Errors {
    float joints_m = 0.0f;
    // Studio's spine is one bone up to the upper chest: a bent chest changes its length.
    float spine_m = 0.0f;
    float chest_m = 0.0f;
    float turned_rad = 0.0f;
  };
  void compare(const Skeleton& skeleton, const Pose& pose, Errors& errors) {
    BodyFrames was, is;
    forward_kinematics(skeleton, pose, was);
    forward_kinematics(sink_.skeleton, sink_.poses.back(), is);
    const auto spine_m = [](const BodyFrames& frames) {
      return (frames.position(Bone::kUpperChest) - frames.position(Bone::kSpine)).norm();
    };
    errors.spine_m = std::max(errors.spine_m, std::abs(spine_m(was) - spine_m(is)));
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const float apart_m = (was.p_WB_m[b] - is.p_WB_m[b]).norm();
      float& worst = static_cast<Bone>(b) == Bone::kChest ? errors.chest_m : errors.joints_m;
      worst = std::max(worst, apart_m);
      if (static_cast<Bone>(b) != Bone::kChest && static_cast<Bone>(b) != Bone::kSpine)
        errors.turned_rad = std::max(errors.turned_rad, was.R_WB[b].angularDistance(is.R_WB[b]));
    }
  }
  Pose at(Pose pose, std::int64_t ms) {
    pose.clock_id = 7;
    pose.capture_time = began_ + Duration::ms(ms);
    return pose;
  }

  std::unique_ptr<Poller> poller_;
  std::string address_;
  PoseLogSink sink_;
  std::unique_ptr<RokokoReceiver> receiver_;
  MonoTime began_ = mono_now();
};

TEST_F(RokokoPair, ASalsaGoesThroughWithEachJointInItsPlace) {
  for (const auto dialect : {RokokoConsumer::Dialect::kLz4, RokokoConsumer::Dialect::kJson}) {
    open_receiver();
    const auto sender = consumer(dialect);
    SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
    sender->on_skeleton(kRokokoAna, dancer.skeleton(), began_);
    sink_ = PoseLogSink();
    Errors errors;
    for (int i = 0; i < 500; ++i) {
      Pose pose;
      dancer.dance_at(Duration::ms(16 * i), pose);
      sender->on_pose(kRokokoAna, at(pose, 16 * i), began_ + Duration::ms(16 * i));
      wait_for_poses(static_cast<std::size_t>(i) + 1);
      ASSERT_EQ(sink_.poses.size(), static_cast<std::size_t>(i) + 1);
      compare(dancer.skeleton(), pose, errors);
    }
    EXPECT_LT(errors.joints_m, kRokokoTolerance_m);
    EXPECT_LT(errors.turned_rad, 2e-3f);
    EXPECT_LT(errors.chest_m, 0.02f);
    EXPECT_EQ(sink_.poses.front().presence, kAllBones);
    EXPECT_NEAR(standing_height_m(sink_.skeleton), standing_height_m(dancer.skeleton()), 0.002f);
    receiver_.reset();
  }
}

// From Debian's assimp-testmodels or beside the tree.
TEST_F(RokokoPair, RealDancesGoThroughWithEachJointInItsPlace) {
  std::vector<std::string> takes;
  for (const char* folder :
       {DANCE_SOURCE_DIR "/../shared/data/mocap", "/usr/share/assimp/models/BVH"}) {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none))
      if (entry.path().string().find(".bvh") != std::string::npos && takes.size() < 4)
        takes.push_back(entry.path());
  }
  if (takes.empty()) GTEST_SKIP() << "no real takes: install assimp-testmodels";
  std::size_t danced = 0;
  for (const std::string& take : takes) {
    const auto loaded = load_clip(take);
    if (!loaded || loaded->clip.frames.size() < 100) continue;
    ++danced;
    open_receiver();
    const auto sender = consumer(RokokoConsumer::Dialect::kLz4);
    sink_ = PoseLogSink();
    sender->on_skeleton(kRokokoAna, loaded->clip.skeleton, began_);
    Errors errors;
    const std::size_t step = std::max<std::size_t>(1, loaded->clip.frames.size() / 300);
    std::size_t sent = 0;
    for (std::size_t f = 0; f < loaded->clip.frames.size(); f += step) {
      const auto ms = static_cast<std::int64_t>(16 * sent);
      const Pose pose = at(loaded->clip.frames[f], ms);
      sender->on_pose(kRokokoAna, pose, began_ + Duration::ms(ms));
      wait_for_poses(++sent);
      ASSERT_EQ(sink_.poses.size(), sent) << receiver_->summary();
      compare(loaded->clip.skeleton, pose, errors);
    }
    // A trunk that stretches is published again after a second, which is longer than this lasts.
    EXPECT_LT(errors.joints_m, std::max(1e-3f, errors.spine_m + kRokokoTolerance_m)) << take;
    EXPECT_LT(errors.turned_rad, 2e-3f) << take;
    RecordProperty("chest_mm", std::to_string(1000.0f * errors.chest_m));
    receiver_.reset();
  }
  EXPECT_GT(danced, 0u);
}

TEST_F(RokokoPair, FingersGoThrough) {
  open_receiver();
  const auto sender = consumer(RokokoConsumer::Dialect::kLz4);
  Hands hands;
  for (std::size_t f = 0; f < kFingerBoneCount; ++f)
    hands.R_PB[f] = Eigen::AngleAxisf(0.02f * static_cast<float>(f), Eigen::Vector3f::UnitZ());
  hands.presence = (1u << kFingerBoneCount) - 1;
  sender->on_hands(kRokokoAna, hands, began_);
  sender->on_pose(kRokokoAna, at(Pose(), 0), began_);
  wait_for_poses(1);
  ASSERT_EQ(sink_.hands.size(), 1u);
  EXPECT_EQ(sink_.hands[0].presence, hands.presence);
  for (std::size_t f = 0; f < kFingerBoneCount; ++f)
    EXPECT_LT(sink_.hands[0].R_PB[f].angularDistance(hands.R_PB[f]), 2e-3f) << f;
}

TEST_F(RokokoPair, TheActorThatIsAskedForIsTaken) {
  open_receiver("ben");
  const auto sender = consumer(RokokoConsumer::Dialect::kLz4);
  Pose pose;
  pose.p_WH_m.x() = 1.0f;
  sender->on_pose(kRokokoAna, at(pose, 0), began_);
  pose.p_WH_m.x() = -1.0f;
  sender->on_pose(kBen, at(pose, 1), began_ + Duration::ms(1));
  wait_for_poses(1);
  ASSERT_EQ(sink_.poses.size(), 1u);
  EXPECT_NEAR(sink_.poses[0].p_WH_m.x(), -1.0f, 1e-5f);
  EXPECT_NE(receiver_->summary().find("1 without the actor"), std::string::npos);
}

TEST_F(RokokoPair, CaptureTimesKeepTheirDistancesAndAreNotInTheFuture) {
  open_receiver();
  RokokoWriter writer;
  const auto frame = rokoko_couple(1.0);
  const MonoTime base = mono_now();
  // The third comes 8 ms late.
  const int delays_ms[] = {0, 0, 8, 0, 0};
  for (int i = 0; i < 5; ++i) {
    frame->timestamp_s = 100.0 + 0.020 * i;
    const auto text = writer.write(*frame, 2, RokokoWriter::kMostTextBytes).text;
    const MonoTime received = base + Duration::ms(20 * i + delays_ms[i]);
    take(text, received);
  }
  ASSERT_EQ(sink_.poses.size(), 5u);
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR((sink_.poses[static_cast<std::size_t>(i)].capture_time - base).as_seconds(),
                0.020 * i, 1e-4);
}

std::string text_of_couple(double timestamp_s, float x_m) {
  RokokoWriter writer;
  const auto frame = rokoko_couple(1.0);
  frame->timestamp_s = timestamp_s;
  for (RokokoActor& actor : frame->actors)
    for (RokokoJoint& joint : actor.joints) joint.position.x() += x_m;
  return std::string(writer.write(*frame, 2, RokokoWriter::kMostTextBytes).text);
}

TEST_F(RokokoPair, OneSenderAtATimeAndItsClockAlone) {
  open_receiver();
  for (int i = 0; i < 200; ++i) {
    const MonoTime received = began_ + Duration::ms(20 * i);
    // The second is a day ahead; a third has nobody.
    take(text_of_couple(100.0 + 0.02 * i, 0.0f), received, 5000);
    take(text_of_couple(86'400.0 + 0.02 * i, 3.0f), received + Duration::ms(2), 5001);
    take(R"({"version":3,"scene":{"timestamp":9,"actors":[]}})", received, 5002);
    ASSERT_EQ(sink_.poses.size(), static_cast<std::size_t>(i) + 1);
    EXPECT_EQ(sink_.poses.back().capture_time, received);
  }
  EXPECT_EQ(receiver_->summary().find("jumps"), std::string::npos) << receiver_->summary();
  EXPECT_NE(receiver_->summary().find("400 of a second sender"), std::string::npos)
      << receiver_->summary();
  // The first falls silent.
  const MonoTime later = began_ + Duration::ms(20 * 199 + 2000);
  take(text_of_couple(86'404.0, 3.0f), later, 5001);
  ASSERT_EQ(sink_.poses.size(), 201u);
  EXPECT_EQ(sink_.poses.back().capture_time, later);
}

TEST_F(RokokoPair, StampsOfDatagramsWithoutTheActorTellNoClock) {
  open_receiver("nobody");
  for (int i = 0; i < 10; ++i) take(text_of_couple(1000.0 * i, 0.0f));
  EXPECT_EQ(receiver_->summary().find("jumps"), std::string::npos) << receiver_->summary();
}

TEST_F(RokokoPair, AFloodIsReadABatchATurn) {
  open_receiver();
  auto sender = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(sender.has_value());
  const std::uint8_t junk[] = {'{'};
  for (int i = 0; i < 20; ++i) sender->send_now(*Address::resolve(address_), junk);
  poller_->run_once(Duration::ms(100));
  EXPECT_NE(receiver_->summary().find("of 8 datagrams"), std::string::npos) << receiver_->summary();
  for (int i = 0; i < 5; ++i) poller_->run_once(Duration::ms(5));
  EXPECT_NE(receiver_->summary().find("of 20 datagrams"), std::string::npos);
}

TEST_F(RokokoPair, DamageIsCountedByCauseAndChangesNothing) {
  open_receiver();
  take("{");
  take("\x04\x22\x4d\x18 damaged");
  take(R"({"version":2,"scene":{"timestamp":1,"actors":[]}})");
  take(R"({"version":3,"scene":{"timestamp":1,"actors":[{"name":"a","meta":{"hasBody":true}}]}})");
  take("");
  EXPECT_EQ(sink_.poses.size(), 0u);
  EXPECT_EQ(receiver_->refused(RokokoFault::kNotJson), 2u);
  EXPECT_EQ(receiver_->refused(RokokoFault::kNotLz4), 1u);
  EXPECT_EQ(receiver_->refused(RokokoFault::kOtherVersion), 1u);
  EXPECT_EQ(receiver_->summary(),
            "0 poses of 5 datagrams from Rokoko Studio, 1 damaged LZ4, 2 no JSON, 1 not JSON v3, 1 "
            "with joints missing");
}

TEST_F(RokokoPair, APortThatIsTakenIsNamed) {
  open_receiver();
  const auto second = RokokoReceiver::open({kRokokoAna, address_, ""}, sink_, *poller_);
  ASSERT_FALSE(second.has_value());
  EXPECT_NE(second.error().what.find("is taken"), std::string::npos);
}

}  // namespace
}  // namespace dance
