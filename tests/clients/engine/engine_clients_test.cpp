// Programs of engines read a real house: a salsa couple, the house that stages it, and its consumer
// "engine"; in the middle of it the house is killed and started again. Where the client has a
// dancer's bones is compared with where the stage had them, pose by pose.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include "core/program/child_process.h"
#include "tests/apps/bus_programs.h"
#include "tests/clients/engine/staged_poses.h"

namespace dance {
namespace {

constexpr double kFurthest_mm = 0.1;
constexpr int kFewest = 20;  // poses of each guest, before and after: the slowest machine has them

double client_seconds() {
  const char* given = std::getenv("DANCE_CLIENT_SECONDS");
  const double seconds = given ? std::atof(given) : 0.0;
  return seconds > 0.0 ? seconds : 15.0;
}

bool has_program(const std::string& name) {
  return run("command -v " + name + " >/dev/null").exit_code == 0;
}

class EngineClients : public BusPrograms {
 protected:
  void SetUp() override {
    name_ = "clients-" + std::to_string(getpid());
    setenv("DANCE_ADAPTER_LIBRARY", DANCE_ADAPTER_FILE, 1);
    setenv("LD_LIBRARY_PATH", DANCE_BINARY_DIR "/lib", 1);
    setenv("PYTHONPATH", DANCE_SOURCE_DIR "/bindings/python:" DANCE_SOURCE_DIR "/bindings/blender",
           1);
    setenv("PYTHONDONTWRITEBYTECODE", "1", 1);
    setenv("HOME", folder_.path().c_str(), 1);  // engines put files there
    setenv("LANG", "en_US.UTF-8", 1);
    auto bus = Bus::open(kBus);
    ASSERT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    staged_ = std::make_unique<StagedPoses>(*bus_);
    // Beside the house, so that they dance on when it is gone.
    start("dance-salsa", {"--guest", "alice", "--role", "follow", "--bus", kBus});
    start("dance-salsa", {"--guest", "bob", "--role", "lead", "--bus", kBus});
    std::ofstream(folder_.path("house.toml"))
        << "[house]\nbus = \"" << kBus << "\"\nguests = [\"alice\", \"bob\"]\n"
        << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n"
        << "[[listen]]\nto = \"engine\"\nname = \"" << name_ << "\"\n";
    house_ = open();
    ASSERT_TRUE(wait_for([&] {
      bus_->drain(mono_now());
      return staged_->has_skeletons_of(2) && staged_->size() > 10;
    })) << text_of(folder_.path("talk"));
  }

  std::unique_ptr<ChildProcess> open() {
    auto house = ChildProcess::start({bin("dance-join"),
                                      {folder_.path("house.toml"), "--no-view"},
                                      folder_.path("house.out"),
                                      folder_.path("house.err")});
    if (!house) ADD_FAILURE() << house.error().what;
    return house ? std::make_unique<ChildProcess>(std::move(*house)) : nullptr;
  }

  void listen_until(const std::function<bool()>& is_over, double seconds) {
    const MonoTime end = mono_now() + Duration::ms(static_cast<std::int64_t>(1000.0 * seconds));
    while (!is_over() && mono_now() < end) {
      bus_->drain(mono_now());
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  // The client reads for so long, and the house is killed and comes back in the middle of it.
  StagedPoseComparison read_by(const std::string& command, dance_axes axes) {
    const double seconds = client_seconds();
    auto client = ChildProcess::start(
        {"/bin/sh",
         {"-c", "exec " + command + " " + name_ + " " + std::to_string(seconds)},
         folder_.path("client.out"),
         folder_.path("client.err")});
    if (!client) {
      ADD_FAILURE() << client.error().what;
      return {};
    }
    const auto lines = [&] { return lines_of("pose"); };
    // Blender takes its time to start.
    listen_until([&] { return client->has_ended() || lines() >= 4 * kFewest; }, 60.0);
    listen_until([&] { return client->has_ended(); }, 0.4 * seconds);
    house_->kill_now();
    bus_->drain(mono_now());
    staged_->mark();
    house_ = open();
    listen_until([&] { return client->has_ended(); }, seconds + 120.0);
    EXPECT_TRUE(client->ended_well()) << client->exit_text() << said();
    return staged_->compare(text_of(folder_.path("client.out")), axes);
  }
  int lines_of(const std::string& word) const {
    const std::string output = text_of(folder_.path("client.out"));
    int lines = 0;
    for (std::size_t at = 0; (at = output.find(word + " ", at)) != std::string::npos; ++at) ++lines;
    return lines;
  }
  std::string said() const {
    return "\n" + text_of(folder_.path("client.err")) + text_of(folder_.path("house.err")) +
           text_of(folder_.path("client.out")).substr(0, 500);
  }

  void expect_alike(const StagedPoseComparison& read) const {
    EXPECT_LT(read.furthest_mm, kFurthest_mm);
    EXPECT_EQ(read.unreadable, 0);
    int all = 0;
    for (const char* guest : {"alice", "bob"}) {
      const auto count = read.poses.find(guest), after = read.poses_after.find(guest);
      const int before_kill = (count == read.poses.end() ? 0 : count->second) -
                              (after == read.poses_after.end() ? 0 : after->second);
      EXPECT_GE(before_kill, kFewest) << guest << said();
      EXPECT_GE(after == read.poses_after.end() ? 0 : after->second, kFewest)
          << guest << " is not read again after the house came back" << said();
      all += count == read.poses.end() ? 0 : count->second;
    }
    EXPECT_LE(read.unheard, all / 20) << "poses that no stage had";
    ASSERT_TRUE(read.has_counters) << said();
    EXPECT_EQ(read.counters[3], 0u) << "damaged";
    EXPECT_GE(read.counters[4], 2u) << "houses found";
    std::printf("%d poses compared, furthest %.4f mm; reads %llu, retries %llu, busy %llu\n", all,
                read.furthest_mm, read.counters[0], read.counters[1], read.counters[2]);
  }

  std::string name_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<StagedPoses> staged_;
  std::unique_ptr<ChildProcess> house_;
};

TEST_F(EngineClients, ACPlusPlusProgramHasTheDancersWhereTheStageHasThem) {
  expect_alike(read_by(DANCE_BINARY_DIR "/tests/read_dancers", DANCE_AXES_UNREAL));
}

TEST_F(EngineClients, PythonHasTheDancersWhereTheStageHasThem) {
  if (!has_program("python3")) GTEST_SKIP() << "python3 is not here: apt-get install python3";
  expect_alike(read_by("python3 " DANCE_SOURCE_DIR "/tests/clients/engine/read_dancers.py",
                       DANCE_AXES_GLTF));
}

TEST_F(EngineClients, CSharpHasTheDancersOnARigOfItsOwnAndMakesNoGarbage) {
  if (!has_program("mcs") || !has_program("mono"))
    GTEST_SKIP() << "mono is not here: apt-get install mono-mcs mono-runtime";
  const Finished compiled =
      run("mcs -unsafe -warn:4 -out:" + folder_.path("ReadDancers.exe") + " " +
          DANCE_SOURCE_DIR "/tests/clients/engine/ReadDancers.cs " DANCE_SOURCE_DIR
                           "/bindings/csharp/*.cs 2>&1");
  ASSERT_EQ(compiled.exit_code, 0) << compiled.output;
  const StagedPoseComparison read =
      read_by("mono " + folder_.path("ReadDancers.exe"), DANCE_AXES_UNITY);
  expect_alike(read);
  EXPECT_EQ(read.collections, 0);
}

TEST_F(EngineClients, UnitysComponentsHaveTheDancersOnHumanoidAvatars) {
  if (!has_program("mcs") || !has_program("mono"))
    GTEST_SKIP() << "mono is not here: apt-get install mono-mcs mono-runtime";
  const Finished compiled = run(
      "cd " DANCE_SOURCE_DIR " && mcs -unsafe -nowarn:0649 -out:" + folder_.path("UnityScene.exe") +
      " tests/clients/engine/UnityScene.cs tests/bindings/unity/UnityEngineStub.cs "
      "bindings/unity/Runtime/*.cs bindings/csharp/*.cs 2>&1");
  ASSERT_EQ(compiled.exit_code, 0) << compiled.output;
  expect_alike(read_by("mono " + folder_.path("UnityScene.exe"), DANCE_AXES_UNITY));
}

TEST_F(EngineClients, GodotHasTheDancersOnSkeletonsOfItsOwn) {
  if (!has_program("godot3-server"))
    GTEST_SKIP() << "godot3-server is not here: apt-get install godot3-server";
  const Finished copied =
      run("cp -r " DANCE_BINARY_DIR "/bindings/godot " + folder_.path("project") +
          " && cp " DANCE_SOURCE_DIR "/tests/clients/engine/read_dancers.gd " +
          folder_.path("project") + " 2>&1");
  ASSERT_EQ(copied.exit_code, 0) << copied.output;
  expect_alike(read_by("godot3-server --path " + folder_.path("project") + " -s read_dancers.gd",
                       DANCE_AXES_GLTF));
}

TEST_F(EngineClients, BlenderHasTheDancersOnArmaturesThatItMade) {
  if (!has_program("blender")) GTEST_SKIP() << "Blender is not here: apt-get install blender";
  expect_alike(
      read_by("blender -b --factory-startup -noaudio --python-use-system-env "
              "--python-exit-code 3 --python " DANCE_SOURCE_DIR
              "/tests/clients/engine/read_dancers_blender.py --",
              DANCE_AXES_BLENDER));
}

}  // namespace
}  // namespace dance
