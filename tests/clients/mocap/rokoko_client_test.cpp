// A living couple as Rokoko Studio's stream, read by node with lz4js as Rokoko's plugins read it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/net/udp_socket.h"
#include "core/pose/kinematics.h"
#include "formats/rokoko/rokoko_frame.h"
#include "tests/apps/bus_programs.h"
#include "tests/clients/mocap/joint_lines.h"

namespace dance {
namespace {

const std::string kModules = DANCE_SOURCE_DIR "/build/clients/node_modules";
const std::string kReader = DANCE_SOURCE_DIR "/tests/clients/mocap/read_rokoko.mjs";

class RokokoClient : public BusPrograms {
 protected:
  void SetUp() override {
    if (run("node --version").exit_code != 0)
      GTEST_SKIP() << "node is missing; apt-get install npm";
    if (!std::filesystem::exists(kModules + "/lz4js"))
      GTEST_SKIP() << "lz4js is missing; tests/clients/fetch_clients.sh fetches it";
    open_house();
    bus_ = std::move(*Bus::open(kBus));
    bus_->subscribe<TimedSkeleton>(
        Where::kStage, [this](const Channel& channel, const TimedSkeleton& timed, MonoTime) {
          skeletons_[std::string(channel.guest().view())] = timed.skeleton;
        });
    bus_->subscribe<Pose>(Where::kStage,
                          [this](const Channel& channel, const Pose& pose, MonoTime) {
                            keep(std::string(channel.guest().view()), pose);
                          });
  }
  // By the names of Studio's joints.
  void keep(const std::string& guest, const Pose& pose) {
    const auto skeleton = skeletons_.find(guest);
    if (skeleton == skeletons_.end()) return;
    BodyFrames frames;
    forward_kinematics(skeleton->second, pose, frames);
    JointPlaces places;
    for (std::size_t j = 0; j < kRokokoBodyJointCount; ++j)
      if (const auto bone = bone_of(static_cast<RokokoBody>(j)))
        places[std::string(rokoko_joint_name(j))] = frames.position(*bone).cast<double>();
    places["leftToeEnd"] = frames.tip(Tip::kLeftToes).cast<double>();
    places["rightToeEnd"] = frames.tip(Tip::kRightToes).cast<double>();
    staged_[guest].push_back(std::move(places));
  }
  nlohmann::json read_stream(const std::string& dialect, const std::string& seconds,
                             const std::string& file) {
    const std::string port = std::to_string(*free_loopback_port());
    start("dance-listen", {"--bus", kBus, "--to", "rokoko", "--dialect", dialect, "--address",
                           "127.0.0.1:" + port});
    const std::string report = folder_.path("report");
    auto child = ChildProcess::start({"/bin/sh",
                                      {"-c", "NODE_PATH=" + kModules + " node " + kReader + " " +
                                                 port + " " + seconds + " " + file},
                                      report,
                                      folder_.path("node")});
    if (!child) return {};
    const MonoTime latest = mono_now() + Duration::seconds(std::stod(seconds) + 20.0);
    while (!child->has_ended() && mono_now() < latest) {
      bus_->drain(mono_now());
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_TRUE(child->ended_well()) << text_of(folder_.path("node"));
    return nlohmann::json::parse(text_of(report), nullptr, false);
  }

  std::unique_ptr<Bus> bus_;
  std::map<std::string, Skeleton> skeletons_;
  std::map<std::string, std::vector<JointPlaces>> staged_;
};

TEST_F(RokokoClient, BuildsALivingCoupleFromRotationsWithAllJointsInTheirPlaces) {
  const std::string file = folder_.path("joints");
  const nlohmann::json report = read_stream("lz4", client_seconds(), file);
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["malformed"], 0) << report.dump(1);
  EXPECT_EQ(report["packed"], report["datagrams"]);
  EXPECT_EQ(report["actors"].size(), 2u) << report.dump(1);
  const double frames = 5.0 * std::stod(client_seconds());  // of 60 a second
  EXPECT_GT(report["datagrams"].get<double>(), frames) << report.dump(1);
  EXPECT_LT(report["worst_sent_mm"].get<double>(), 0.1) << report.dump(1);
  EXPECT_LE(report["longest"].get<int>(), 32'768);

  const auto lines = read_joint_lines(file);
  ASSERT_GT(static_cast<double>(lines.size()), 2.0 * frames);
  double worst_m = 0.0;
  std::map<std::string, int> compared;
  for (const JointLine& line : lines) {
    const auto& staged = staged_[line.name];
    // Not what came before the program had the dancer's proportions, or while this test did not
    // hear the stage.
    const double height_m = standing_height_m(skeletons_[line.name]);
    if (std::abs(height_m - line.total_height_m) > 1e-4) continue;
    const JointPlaces* truth = staged.empty() ? nullptr : nearest(staged, line.joints, "hip");
    if (!truth || (truth->at("hip") - line.joints.at("hip")).norm() > 1e-5) continue;
    worst_m = std::max(worst_m, worst_apart_m(*truth, line.joints));
    ++compared[line.name];
  }
  EXPECT_GT(compared["alice"], frames / 2.0) << report.dump(1);
  EXPECT_GT(compared["bob"], frames / 2.0);
  EXPECT_LT(worst_m, 1e-4);
  std::printf("%d and %d bodies built from rotations, all joints within %.3f mm, %s datagrams\n",
              compared["alice"], compared["bob"], 1000.0 * worst_m,
              report["datagrams"].dump().c_str());
}

TEST_F(RokokoClient, ReadsPlainJsonToo) {
  const nlohmann::json report = read_stream("json", "3", folder_.path("joints"));
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["malformed"], 0) << report.dump(1);
  EXPECT_EQ(report["packed"], 0);
  EXPECT_EQ(report["actors"].size(), 2u) << report.dump(1);
}

}  // namespace
}  // namespace dance
