// dance receive hears a server of NatNet that was written from the layout alone.
#include <gtest/gtest.h>

#include "core/pose/kinematics.h"
#include "tests/apps/bus_programs.h"
#include "tests/clients/mocap/joint_lines.h"

namespace dance {
namespace {

const std::string kServer = DANCE_SOURCE_DIR "/tests/clients/mocap/natnet_server.py";

struct Named {
  const char* name;
  Bone bone;
};
constexpr Named kJoints[] = {{"Hip", Bone::kHips},
                             {"Ab", Bone::kSpine},
                             {"Chest", Bone::kUpperChest},
                             {"Neck", Bone::kNeck},
                             {"Head", Bone::kHead},
                             {"LHand", Bone::kLeftHand},
                             {"LFArm", Bone::kLeftLowerArm},
                             {"LUArm", Bone::kLeftUpperArm},
                             {"RHand", Bone::kRightHand},
                             {"RFArm", Bone::kRightLowerArm},
                             {"RUArm", Bone::kRightUpperArm},
                             {"LShin", Bone::kLeftLowerLeg},
                             {"LFoot", Bone::kLeftFoot},
                             {"LToe", Bone::kLeftToes},
                             {"RShin", Bone::kRightLowerLeg},
                             {"RFoot", Bone::kRightFoot},
                             {"RToe", Bone::kRightToes},
                             {"LShoulder", Bone::kLeftShoulder}};

class NatNetClient : public BusPrograms {
 protected:
  void SetUp() override {
    if (run("python3 --version").exit_code != 0)
      GTEST_SKIP() << "python3 is missing; apt-get install python3";
    bus_ = std::move(*Bus::open(kBus));
    bus_->subscribe<TimedSkeleton>(Where::kCapture,
                                   [this](const Channel&, const TimedSkeleton& timed, MonoTime) {
                                     skeleton_ = timed.skeleton;
                                   });
    bus_->subscribe<Pose>(Where::kCapture, [this](const Channel&, const Pose& pose, MonoTime) {
      BodyFrames frames;
      forward_kinematics(skeleton_, pose, frames);
      JointPlaces places;
      for (const Named& joint : kJoints)
        places[joint.name] = frames.position(joint.bone).cast<double>();
      heard_.push_back(std::move(places));
      if (!captured_.empty() && pose.capture_time <= captured_.back()) ++out_of_order_;
      captured_.push_back(pose.capture_time);
    });
    bus_->subscribe<Hands>(Where::kCapture,
                           [this](const Channel&, const Hands&, MonoTime) { ++hands_; });
  }
  void stream(const std::string& version, const std::string& coordinates,
              const std::string& seconds) {
    heard_.clear();
    captured_.clear();
    const std::string truth_path = folder_.path("truth");
    ChildProcess& receiver =
        start("dance-receive", {"--from", "natnet", "--bus", kBus, "--guest", "ana", "--actor",
                                "Ana", "--listen", "239.255.42.99:1511?interface=127.0.0.1"});
    auto server =
        ChildProcess::start({"/usr/bin/env",
                             {"python3", kServer, version, coordinates, seconds, truth_path},
                             folder_.path("server"),
                             folder_.path("server-talk")});
    ASSERT_TRUE(server.has_value());
    const MonoTime latest = mono_now() + Duration::seconds(std::stod(seconds) + 20.0);
    while (!server->has_ended() && mono_now() < latest) {
      bus_->drain(mono_now());
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(server->ended_well()) << text_of(folder_.path("server-talk"));
    bus_->drain(mono_now());
    receiver.stop(Duration::s(5));
    std::vector<JointPlaces> truth;
    for (JointLine& line : read_joint_lines(truth_path)) truth.push_back(std::move(line.joints));
    EXPECT_GT(static_cast<double>(heard_.size()), 0.3 * static_cast<double>(truth.size()))
        << text_of(folder_.path("talk"));
    double worst_m = 0.0;
    for (const JointPlaces& places : heard_) {
      const JointPlaces* frame = nearest(truth, places, "Hip");
      ASSERT_NE(frame, nullptr);
      worst_m = std::max(worst_m, worst_apart_m(*frame, places));
    }
    EXPECT_LT(worst_m, 1e-4);
    EXPECT_EQ(out_of_order_, 0);
    EXPECT_GT(hands_, 0);
    std::printf("NatNet %s, %s bones: %zu of %zu frames, all joints within %.3f mm\n",
                version.c_str(), coordinates.c_str(), heard_.size(), truth.size(),
                1000.0 * worst_m);
  }

  std::unique_ptr<Bus> bus_;
  Skeleton skeleton_ = average_skeleton();
  std::vector<JointPlaces> heard_;
  std::vector<MonoTime> captured_;
  int out_of_order_ = 0;
  int hands_ = 0;
};

TEST_F(NatNetClient, HearsVersion3WithGlobalBones) { stream("3.1", "global", "4"); }
TEST_F(NatNetClient, HearsVersion3WithBonesInTheirParents) { stream("3.1", "local", "4"); }
TEST_F(NatNetClient, HearsVersion4WithGlobalBones) { stream("4.1", "global", client_seconds()); }
TEST_F(NatNetClient, HearsVersion4WithBonesInTheirParents) { stream("4.1", "local", "4"); }

}  // namespace
}  // namespace dance
