// The way back: programs of engines send a dancer of their own, and the house has it as a capture.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>

#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr int kFewest = 30;  // poses heard

class EngineProducers : public BusPrograms {
 protected:
  void SetUp() override {
    name_ = "way-back-" + std::to_string(getpid());
    setenv("DANCE_ADAPTER_LIBRARY", DANCE_ADAPTER_FILE, 1);
    setenv("LD_LIBRARY_PATH", DANCE_BINARY_DIR "/lib", 1);
    setenv("PYTHONPATH", DANCE_SOURCE_DIR "/bindings/python", 1);
    setenv("PYTHONDONTWRITEBYTECODE", "1", 1);
    setenv("HOME", folder_.path().c_str(), 1);
    setenv("LANG", "en_US.UTF-8", 1);
    auto bus = Bus::open(kBus);
    ASSERT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    bus_->subscribe<Pose>({Where::kCapture, *GuestId::parse("carol")},
                          [this](const Channel&, const Pose& pose, MonoTime) {
                            ++heard_;
                            check(pose);
                          });
    start("dance-receive",
          {"--from", "engine", "--name", name_, "--guest", "carol", "--bus", kBus});
  }
  bool has(const char* program) {
    return run(std::string("command -v ") + program + " >/dev/null").exit_code == 0;
  }

  // What the senders say: the left arm lowered about the stage's +Z, walking along +X.
  void check(const Pose& pose) {
    const Eigen::Quaternionf& arm = pose.R_PB[index_of(Bone::kLeftUpperArm)];
    const Eigen::Quaternionf wanted(Eigen::AngleAxisf(-1.2f, Eigen::Vector3f::UnitZ()));
    wrong_ += arm.angularDistance(wanted) > 1e-3f;
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (b != index_of(Bone::kLeftUpperArm))
        wrong_ += pose.R_PB[b].angularDistance(Eigen::Quaternionf::Identity()) > 1e-3f;
    const Eigen::Vector3f& hips = pose.p_WH_m;
    const float step = 1000.0f * hips.x();
    wrong_ += hips.x() < 0.0f || hips.x() > 0.5f || std::abs(step - std::round(step)) > 1e-2f;
    wrong_ += std::abs(hips.y() - 0.9f) > 1e-5f || std::abs(hips.z()) > 1e-5f;
    wrong_ += pose.presence != kAllBones;
  }

  // The sender begins before the receiver is there, and is heard when it comes.
  void expect_heard(const std::string& command) {
    start("/bin/sh", {"-c", "exec " + command + " " + name_ + " 60"});
    EXPECT_TRUE(wait_for([&] {
      bus_->drain(mono_now());
      return heard_ >= kFewest;
    })) << heard_
        << " poses\n"
        << text_of(folder_.path("talk")) << text_of(folder_.path("output"));
    EXPECT_EQ(wrong_, 0);
  }

  std::string name_;
  std::unique_ptr<Bus> bus_;
  int heard_ = 0;
  int wrong_ = 0;
};

TEST_F(EngineProducers, PythonsDancerIsACaptureOfTheHouse) {
  if (!has("python3")) GTEST_SKIP() << "python3 is not here: apt-get install python3";
  expect_heard("python3 " DANCE_SOURCE_DIR "/tests/clients/engine/send_dancer.py");
}

TEST_F(EngineProducers, CSharpsDancerInUnitysAxesIsACaptureOfTheHouse) {
  if (!has("mcs") || !has("mono"))
    GTEST_SKIP() << "mono is not here: apt-get install mono-mcs mono-runtime";
  const Finished compiled = run("mcs -unsafe -warn:4 -out:" + folder_.path("SendDancer.exe") + " " +
                                DANCE_SOURCE_DIR "/tests/clients/engine/SendDancer.cs " +
                                DANCE_SOURCE_DIR "/bindings/csharp/*.cs 2>&1");
  ASSERT_EQ(compiled.exit_code, 0) << compiled.output;
  expect_heard("mono " + folder_.path("SendDancer.exe"));
}

TEST_F(EngineProducers, GodotsDancerIsACaptureOfTheHouse) {
  if (!has("godot3-server"))
    GTEST_SKIP() << "godot3-server is not here: apt-get install godot3-server";
  const Finished copied = run(
      "cp -r " DANCE_BINARY_DIR "/bindings/godot " + folder_.path("project") +
      " && cp " DANCE_SOURCE_DIR "/tests/clients/engine/send_dancer.gd " + folder_.path("project"));
  ASSERT_EQ(copied.exit_code, 0) << copied.output << copied.talk;
  expect_heard("godot3-server --path " + folder_.path("project") + " -s send_dancer.gd");
}

}  // namespace
}  // namespace dance
