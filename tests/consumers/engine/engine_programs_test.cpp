// The way of a pose through real programs: a dancer on a bus, `dance listen --to engine`, and this
// process as the engine, which loads libdance_adapter.so as one does; and the way back through
// `dance receive --from engine`.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "consumers/engine/dance_adapter.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

class EnginePrograms : public BusPrograms {
 protected:
  void SetUp() override {
    setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    library_ = dlopen(DANCE_BINARY_DIR "/lib/libdance_adapter.so.1", RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library_, nullptr) << dlerror();
  }
  template <class Function>
  Function* call(const char* name) {
    auto* function = reinterpret_cast<Function*>(dlsym(library_, name));
    EXPECT_NE(function, nullptr) << name;
    return function;
  }

  void* library_ = nullptr;
};

TEST_F(EnginePrograms, AnEngineSeesADancerOfTheBusMoveAndLeave) {
  start("dance-salsa", {"--bus", kBus, "--guest", "alice"});
  ChildProcess& house = start(
      "dance-listen", {"--to", "engine", "--name", "flow", "--where", "capture", "--bus", kBus});
  dance_adapter* adapter =
      call<decltype(dance_adapter_open)>("dance_adapter_open")("flow", DANCE_AXES_UNITY);
  ASSERT_NE(adapter, nullptr);
  auto* find = call<decltype(dance_adapter_find)>("dance_adapter_find");
  auto* newest = call<decltype(dance_adapter_newest)>("dance_adapter_newest");
  auto* at = call<decltype(dance_adapter_at)>("dance_adapter_at");
  auto* now_ns = call<decltype(dance_adapter_now_ns)>("dance_adapter_now_ns");
  std::uint32_t slot = 0;
  ASSERT_TRUE(wait_for([&] { return find(adapter, "alice", &slot) == DANCE_OK; }))
      << text_of(folder_.path("talk"));
  dance_pose pose{};
  pose.struct_size = sizeof pose;
  std::set<std::uint32_t> seen;
  std::map<std::uint32_t, int> kinds;
  ASSERT_TRUE(wait_for([&] {
    if (newest(adapter, slot, &pose) == DANCE_OK) {
      seen.insert(pose.sequence);
      EXPECT_GT(pose.hips_position[1], 0.5f);
      EXPECT_LE(pose.capture_ns, now_ns());
    }
    for (const std::int64_t ahead_ns : {-60'000'000, 0})
      if (at(adapter, slot, now_ns() + ahead_ns, &pose) == DANCE_OK) ++kinds[pose.kind];
    return seen.size() > 30 && kinds[DANCE_POSE_INTERPOLATED] > 0 &&
           kinds[DANCE_POSE_PREDICTED] > 0;
  })) << seen.size()
      << " poses, " << kinds[DANCE_POSE_INTERPOLATED] << " interpolated, "
      << kinds[DANCE_POSE_PREDICTED] << " predicted";
  dance_skeleton body{};
  body.struct_size = sizeof body;
  auto* skeleton = call<decltype(dance_adapter_skeleton)>("dance_adapter_skeleton");
  EXPECT_TRUE(
      wait_for([&] { return skeleton(adapter, slot, &body) == DANCE_OK && body.version > 0; }));

  house.stop(Duration::s(10));
  EXPECT_TRUE(house.ended_well()) << house.exit_text();
  EXPECT_EQ(call<decltype(dance_adapter_state)>("dance_adapter_state")(adapter), DANCE_NO_HOUSE);
  EXPECT_FALSE(
      std::filesystem::exists("/dev/shm/dance-engine-" + std::to_string(geteuid()) + "-flow"));
  call<decltype(dance_adapter_close)>("dance_adapter_close")(adapter);
}

TEST_F(EnginePrograms, WhatAnEngineTracksIsADancerOfTheBus) {
  auto bus = Bus::open(kBus);
  ASSERT_TRUE(bus) << bus.error().what;
  Pose heard;
  int poses = 0;
  (*bus)->subscribe<Pose>({Where::kCapture, *GuestId::parse("bob")},
                          [&](const Channel&, const Pose& pose, MonoTime) {
                            heard = pose;
                            ++poses;
                          });
  start("dance-receive", {"--from", "engine", "--name", "flow", "--guest", "bob", "--bus", kBus});
  dance_producer* producer =
      call<decltype(dance_producer_open)>("dance_producer_open")("flow", DANCE_AXES_UNREAL);
  ASSERT_NE(producer, nullptr);
  auto* produce = call<decltype(dance_producer_pose)>("dance_producer_pose");
  dance_pose pose{};
  pose.struct_size = sizeof pose;
  for (auto& q : pose.rotation) q[3] = 1.0f;
  pose.hips_position[0] = 150.0f;
  pose.hips_position[2] = 95.0f;
  pose.presence = kAllBones;
  pose.confidence = 0.5f;
  ASSERT_TRUE(wait_for([&] {
    produce(producer, &pose);
    (*bus)->drain(mono_now());
    return poses > 10;
  })) << text_of(folder_.path("talk"));
  EXPECT_TRUE(heard.p_WH_m.isApprox(Eigen::Vector3f(0.0f, 0.95f, 1.5f), 1e-5f));
  EXPECT_EQ(heard.confidence, 0.5f);
  EXPECT_EQ(heard.clock_id, this_clock_id());
  call<decltype(dance_producer_close)>("dance_producer_close")(producer);
}

TEST_F(EnginePrograms, ASecondHouseOfTheSameNameEndsWithTheCure) {
  start("dance-listen", {"--to", "engine", "--name", "flow", "--bus", kBus});
  ASSERT_TRUE(wait_for([&] {
    return std::filesystem::exists("/dev/shm/dance-engine-" + std::to_string(geteuid()) + "-flow");
  }));
  const Finished second = run_until(
      bin("dance-listen") + " --to engine --name flow --seconds 0.1 --bus " + quoted(kBus),
      [](const Finished& finished) { return finished.exit_code == 1; });
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.talk.find("another name"), std::string::npos) << second.talk;
}

}  // namespace
}  // namespace dance
