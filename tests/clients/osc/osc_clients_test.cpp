// What is sent as Open Sound Control, read by programs of others: two libraries of node and liblo's
// oscdump; and a performer of the VMC protocol, written with the former, that comes in.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/pose/kinematics.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

const std::string kModules = DANCE_SOURCE_DIR "/build/clients/node_modules";
const std::string kScripts = DANCE_SOURCE_DIR "/tests/clients/osc/";
constexpr int kAlicesPort = 39539;
constexpr int kBobsPort = 39540;
constexpr int kDumpPort = 39541;
constexpr int kVrchatPort = 9000;
constexpr float kNear_m = 1e-5f;

std::string seconds_to_run() {
  const char* seconds = std::getenv("DANCE_CLIENT_SECONDS");
  return seconds ? seconds : "15";
}

bool is_there(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

bool has_node() { return is_there("node") && std::filesystem::exists(kModules + "/osc"); }

std::string unity_name(std::size_t bone) {
  std::string name(kBones[bone].name);
  name[0] = static_cast<char>(std::toupper(name[0]));
  return name;
}

Eigen::Vector3f ours(const nlohmann::json& unity) {
  return {-unity[0].get<float>(), unity[1].get<float>(), unity[2].get<float>()};
}

class OscClients : public BusPrograms {
 protected:
  struct Shown {
    MonoTime captured;
    BodyFrames frames;
  };

  void open_couple() {
    std::ofstream file(folder_.path("couple.toml"));
    file << "[house]\nbus = \"" << kBus << "\"\nguests = [\"alice\", \"bob\"]\n"
         << "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\nrole = \"lead\"\n"
         << "[[produce]]\nkind = \"salsa\"\nguest = \"bob\"\nrole = \"follow\"\n"
         << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
    listen(file, "vmc", "alice", kAlicesPort, "");
    listen(file, "vmc", "bob", kBobsPort, "dialect = \"vrm0\"\n");
    listen(file, "vmc", "alice", kDumpPort, "dialect = \"vrm1\"\n");
    listen(file, "vrchat", "alice", kVrchatPort, "rate = 30\n");
    file.close();
    bus_ = *Bus::open(kBus);
    bus_->subscribe<TimedSkeleton>(
        Where::kStage, [&](const Channel& channel, const TimedSkeleton& timed, MonoTime) {
          skeletons_[std::string(channel.guest().view())] = timed.skeleton;
        });
    bus_->subscribe<Pose>(Where::kStage, [&](const Channel& channel, const Pose& pose, MonoTime) {
      const std::string guest(channel.guest().view());
      if (skeletons_.find(guest) == skeletons_.end()) return;
      Shown shown;
      shown.captured = pose.capture_time;
      forward_kinematics(skeletons_[guest], pose, shown.frames);
      shown_[guest].push_back(shown);
    });
    start("dance-join", {folder_.path("couple.toml"), "--no-view"});
    ASSERT_TRUE(wait_for([&] {
      bus_->drain(mono_now());
      return shown_["alice"].size() > 10 && shown_["bob"].size() > 10;
    })) << text_of(folder_.path("talk"));
  }
  static void listen(std::ofstream& file, const char* to, const std::string& guest, int port,
                     const char* more) {
    file << "[[listen]]\nto = \"" << to << "\"\nfrom = \"POSE/stage/" << guest
         << "\"\naddress = \"127.0.0.1:" << port << "\"\n"
         << more;
  }
  // Runs a client to its end while the bus is heard; what it printed.
  std::string run_client(const std::string& program, const std::vector<std::string>& arguments) {
    const std::string output = folder_.path("client");
    auto client = ChildProcess::start({program, arguments, output, folder_.path("client-talk")});
    if (!client) {
      ADD_FAILURE() << client.error().what;
      return "";
    }
    const auto is_over = [&] {
      if (bus_) bus_->drain(mono_now());
      return client->has_ended();
    };
    EXPECT_TRUE(wait_for(is_over, kTimeout + std::chrono::seconds(std::stoi(seconds_to_run()))));
    EXPECT_TRUE(client->ended_well()) << text_of(folder_.path("client-talk"));
    return text_of(output);
  }
  // The pose whose hips are there; nullptr where none was heard.
  const Shown* shown_at(const std::string& guest, const Eigen::Vector3f& hips_m) {
    const Shown* nearest = nullptr;
    for (const Shown& shown : shown_[guest])
      if (!nearest ||
          (shown.frames.p_WB_m[0] - hips_m).norm() < (nearest->frames.p_WB_m[0] - hips_m).norm())
        nearest = &shown;
    return nearest && (nearest->frames.p_WB_m[0] - hips_m).norm() < 1e-6f ? nearest : nullptr;
  }

  std::unique_ptr<Bus> bus_;
  std::map<std::string, Skeleton> skeletons_;
  std::map<std::string, std::vector<Shown>> shown_;
};

// Frames of one guest, as node put them together, against our own kinematics.
struct Compared {
  int frames = 0;
  int known = 0;
  float farthest_m = 0.0f;
  double largest_time_error_s = 0.0;
  std::optional<std::pair<double, MonoTime>> first;
};

TEST_F(OscClients, OfNodeReadEveryFrameOfACoupleAndSeeTheSameDance) {
  if (!has_node()) GTEST_SKIP() << "no node, or no npm packages: ./dance test --long fetches them";
  open_couple();
  const std::string output =
      run_client("/usr/bin/env", {"node", kScripts + "read_osc.mjs", kModules, seconds_to_run(),
                                  std::to_string(kAlicesPort), std::to_string(kBobsPort),
                                  std::to_string(kVrchatPort)});
  std::map<int, Compared> compared;
  std::map<int, nlohmann::json> counts;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line);
    const int port = json["port"];
    if (json.contains("counts")) counts[port] = json["counts"];
    Compared& mine = compared[port];
    if (json.contains("t")) {
      ++mine.frames;
      const Shown* shown = shown_at(port == kAlicesPort ? "alice" : "bob", ours(json["p"]["Hips"]));
      if (!shown) continue;
      ++mine.known;
      for (std::size_t b = 0; b < kBoneCount; ++b)
        mine.farthest_m = std::max(
            mine.farthest_m, (ours(json["p"][unity_name(b)]) - shown->frames.p_WB_m[b]).norm());
      const double t_s = json["t"];
      if (!mine.first) mine.first = {t_s, shown->captured};
      mine.largest_time_error_s = std::max(
          mine.largest_time_error_s, std::abs((shown->captured - mine.first->second).as_seconds() -
                                              (t_s - mine.first->first)));
    } else if (json.contains("trackers")) {
      ++mine.frames;
      const auto& trackers = json["trackers"];
      ASSERT_EQ(trackers.size(), 18u);
      const auto at = [&](const char* name) {
        return ours(trackers[std::string("/tracking/trackers/") + name + "/position"]);
      };
      const Shown* shown = shown_at("alice", at("1"));
      if (!shown) continue;
      ++mine.known;
      for (const auto& [name, bone] :
           {std::pair{"head", Bone::kHead}, std::pair{"3", Bone::kLeftFoot},
            std::pair{"5", Bone::kLeftLowerLeg}, std::pair{"8", Bone::kRightLowerArm}})
        mine.farthest_m =
            std::max(mine.farthest_m, (at(name) - shown->frames.position(bone)).norm());
    }
  }
  const double seconds = std::atof(seconds_to_run().c_str());
  for (const int port : {kAlicesPort, kBobsPort, kVrchatPort}) {
    const Compared& mine = compared[port];
    const nlohmann::json& count = counts[port];
    ASSERT_TRUE(count.is_object()) << output;
    std::printf("port %d: %s\n  %d frames, %d compared, farthest %.1e m\n", port,
                count.dump().c_str(), mine.frames, mine.known,
                static_cast<double>(mine.farthest_m));
    EXPECT_EQ(count["malformed"], 0);
    EXPECT_EQ(count["differing"], 0);
    EXPECT_EQ(count["apart"], 0) << "rotations that are not unit";
    EXPECT_LE(count["longest"], 1472);
    // Half of what is sent, as the machine may be busy; the couple dances at 60 Hz.
    EXPECT_GT(mine.frames, (port == kVrchatPort ? 15.0 : 30.0) * seconds);
    EXPECT_GT(mine.known, mine.frames * 9 / 10);
    EXPECT_LT(mine.farthest_m, kNear_m);
    EXPECT_LT(mine.largest_time_error_s, 1e-4);
    if (port == kVrchatPort) continue;
    EXPECT_EQ(count["bones"], 55);
    EXPECT_GT(count["addresses"]["/VMC/Ext/VRM"], 0);
  }
}

TEST_F(OscClients, OscdumpOfLibloReadsEveryMessage) {
  if (!is_there("oscdump") || !is_there("timeout"))
    GTEST_SKIP() << "no oscdump: apt-get install liblo-tools";
  open_couple();
  const std::string output =
      run_client("/bin/sh", {"-c", "timeout -s INT " + seconds_to_run() + " oscdump -L " +
                                       std::to_string(kDumpPort) + "; true"});
  const std::map<std::string, std::string> types{{"/VMC/Ext/OK", "iiii"},
                                                 {"/VMC/Ext/T", "f"},
                                                 {"/VMC/Ext/Root/Pos", "sfffffff"},
                                                 {"/VMC/Ext/Bone/Pos", "sfffffff"},
                                                 {"/VMC/Ext/Blend/Val", "sf"},
                                                 {"/VMC/Ext/Blend/Apply", ""},
                                                 {"/VMC/Ext/VRM", "ss"}};
  std::map<std::string, int> messages;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string stamp, address, type;
    words >> stamp >> address;
    const auto known = types.find(address);
    ASSERT_NE(known, types.end()) << line;
    if (!known->second.empty()) words >> type;
    ASSERT_EQ(type, known->second) << line;
    EXPECT_EQ(line.find("nan"), std::string::npos) << line;
    EXPECT_EQ(line.find("inf"), std::string::npos) << line;
    ++messages[address];
  }
  std::printf("oscdump: %d frames\n", messages["/VMC/Ext/Blend/Apply"]);
  EXPECT_GT(messages["/VMC/Ext/Blend/Apply"], 30.0 * std::atof(seconds_to_run().c_str()));
  EXPECT_NEAR(messages["/VMC/Ext/Bone/Pos"], 55 * messages["/VMC/Ext/Blend/Apply"], 2 * 55);
}

TEST_F(OscClients, APerformerWrittenWithNodeComesInAsADancer) {
  if (!has_node()) GTEST_SKIP() << "no node, or no npm packages: ./dance test --long fetches them";
  bus_ = *Bus::open(kBus);
  Skeleton skeleton;
  std::vector<Pose> poses;
  std::vector<Hands> hands;
  const From carol(Where::kCapture, *GuestId::parse("carol"));
  bus_->subscribe<TimedSkeleton>(carol, [&](const Channel&, const TimedSkeleton& timed, MonoTime) {
    skeleton = timed.skeleton;
  });
  bus_->subscribe<Pose>(carol,
                        [&](const Channel&, const Pose& pose, MonoTime) { poses.push_back(pose); });
  bus_->subscribe<Hands>(
      carol, [&](const Channel&, const Hands& fingers, MonoTime) { hands.push_back(fingers); });
  ChildProcess& receiver =
      start("dance-receive", {"--from", "vmc", "--guest", "carol", "--bus", kBus});
  ASSERT_TRUE(wait_for(
      [&] { return text_of(folder_.path("talk")).find("takes carol") != std::string::npos; }));
  run_client("/usr/bin/env",
             {"node", kScripts + "vmc_performer.mjs", kModules, "39539", seconds_to_run()});
  receiver.ask_to_stop();
  EXPECT_TRUE(wait_for([&] { return receiver.has_ended(); }));
  EXPECT_TRUE(receiver.ended_well());
  const std::string talk = text_of(folder_.path("talk"));
  EXPECT_NE(talk.find("of the sender's proportions"), std::string::npos) << talk;
  EXPECT_EQ(talk.find("malformed"), std::string::npos) << talk;

  ASSERT_GT(poses.size(), 30.0 * std::atof(seconds_to_run().c_str()));
  EXPECT_NEAR(skeleton.offset(Bone::kLeftLowerArm).x(), 0.27f, 1e-5f);
  EXPECT_NEAR(skeleton.offset(Bone::kRightHand).x(), -0.24f, 1e-5f);
  EXPECT_TRUE(skeleton.offset(Bone::kUpperChest).isZero());  // it has none
  EXPECT_NEAR(skeleton.hips_height_m(), 0.05f + 0.41f + 0.39f + 0.05f + 0.02f, 0.01f);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& pose = poses[i];
    EXPECT_NEAR(std::hypot(pose.p_WH_m.x(), pose.p_WH_m.z()), 0.5f, 1e-5f);
    EXPECT_EQ(pose.presence, kAllBones & ~(1u << index_of(Bone::kUpperChest)));
    if (i > 0) {
      EXPECT_GT(pose.capture_time, poses[i - 1].capture_time);
      EXPECT_EQ(pose.sequence, poses[i - 1].sequence + 1);
    }
    BodyFrames frames;
    forward_kinematics(skeleton, pose, frames);
    // The left arm is up, the right one to the right.
    EXPECT_LT((frames.position(Bone::kLeftHand) - frames.position(Bone::kLeftUpperArm) -
               Eigen::Vector3f(0.0f, 0.51f, 0.0f))
                  .norm(),
              kNear_m);
    EXPECT_LT((frames.position(Bone::kRightHand) - frames.position(Bone::kRightUpperArm) -
               Eigen::Vector3f(-0.51f, 0.0f, 0.0f))
                  .norm(),
              kNear_m);
  }
  ASSERT_EQ(hands.size(), poses.size());
  EXPECT_NEAR(hands.back().R_PB[0].w(), 0.8f, 1e-5f);
  EXPECT_NEAR(hands.back().R_PB[0].y(), -0.6f, 1e-5f);
}

}  // namespace
}  // namespace dance
