// The C++ wrapper and Unreal's plug-in read the memory of a house: the consumer "engine" writes it
// in this process. Unreal is a stub of its API (unreal_stub.h).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>

#include "bindings/unreal/DanceAdapter.hpp"
#include "bindings/unreal/DanceGraph/Source/DanceGraph/DanceLiveLinkSource.h"
#include "consumers/engine/engine_consumer.h"
#include "core/net/mono_clock.h"
#include "tests/apps/run_program.h"
#include "tests/bindings/unreal/unreal_stub.h"
#include "tests/test_folder.h"

std::unique_ptr<IModuleInterface> make_module_DanceGraph();

namespace dance {
namespace {

class KeepingClient : public ILiveLinkClient {
 public:
  struct Subject {
    FLiveLinkSkeletonStaticData skeleton;
    FLiveLinkAnimationFrameData frame;
    int skeletons = 0;
    int frames = 0;
    std::set<int> upper_arms_mm;  // how far they were from the shoulder, in all frames
  };

  FGuid AddSource(TSharedPtr<ILiveLinkSource> source) override {
    added = std::move(source);
    added->ReceiveClient(this, FGuid());
    return FGuid();
  }
  void PushSubjectStaticData_AnyThread(const FLiveLinkSubjectKey& key, UClass*,
                                       FLiveLinkStaticDataStruct&& data) override {
    const std::lock_guard lock(mutex_);
    subjects_[key.SubjectName].skeleton = data.data;
    ++subjects_[key.SubjectName].skeletons;
  }
  void PushSubjectFrameData_AnyThread(const FLiveLinkSubjectKey& key,
                                      FLiveLinkFrameDataStruct&& data) override {
    const std::lock_guard lock(mutex_);
    Subject& subject = subjects_[key.SubjectName];
    subject.frame = data.data;
    ++subject.frames;
    const FTransform& arm = data.data.Transforms[int32(index_of(Bone::kLeftUpperArm))];
    subject.upper_arms_mm.insert(static_cast<int>(std::lround(arm.Place.Y * 10.0)));
  }
  void RemoveSubject_AnyThread(const FLiveLinkSubjectKey& key) override {
    const std::lock_guard lock(mutex_);
    subjects_.erase(key.SubjectName);
    ++removals_;
  }
  Subject subject(const char* name) {
    const std::lock_guard lock(mutex_);
    const auto found = subjects_.find(FName(name));
    return found == subjects_.end() ? Subject() : found->second;
  }
  int removals() {
    const std::lock_guard lock(mutex_);
    return removals_;
  }
  std::size_t size() {
    const std::lock_guard lock(mutex_);
    return subjects_.size();
  }

  TSharedPtr<ILiveLinkSource> added;

 private:
  std::mutex mutex_;
  std::map<FName, Subject> subjects_;
  int removals_ = 0;
};

class UnrealBinding : public testing::Test {
 protected:
  void SetUp() override {
    name_ = "unreal-" + std::to_string(getpid());
    auto house = EngineConsumer::open(name_, 0.0, 7, mono_now());
    ASSERT_TRUE(house) << house.error().what;
    house_ = std::move(*house);
    put_into_plugin(DANCE_ADAPTER_FILE);
  }
  void TearDown() override { IPluginManager::Get().plugin = nullptr; }

  // The plug-in's folder, with this library.
  void put_into_plugin(const char* library) {
    const std::filesystem::path folder = folder_.path("DanceGraph/Source/DanceGraph/ThirdParty");
    std::filesystem::create_directories(folder);
    std::filesystem::remove(folder / "libdance_adapter.so.1");
    std::filesystem::create_symlink(library, folder / "libdance_adapter.so.1");
    IPluginManager::Get().plugin =
        std::make_shared<IPlugin>(FString(folder_.path("DanceGraph").c_str()));
  }

  void stage(const char* guest, std::uint32_t sequence, float height_m = 1.6f) {
    Pose pose;
    pose.clock_id = 7;
    pose.sequence = sequence;
    pose.capture_time = mono_now();
    pose.stamp(Hop::kStaged, pose.capture_time);
    pose.p_WH_m = Eigen::Vector3f(0.5f, 0.9f, 2.0f);
    // The left arm lowered.
    pose.R_PB[index_of(Bone::kLeftUpperArm)] = Eigen::AngleAxisf(-1.2f, Eigen::Vector3f::UnitZ());
    house_->on_skeleton(*GuestId::parse(guest), average_skeleton(height_m), pose.capture_time);
    house_->on_pose(*GuestId::parse(guest), pose, pose.capture_time);
  }

  TestFolder folder_{"unreal"};
  std::string name_;
  std::unique_ptr<EngineConsumer> house_;
};

TEST_F(UnrealBinding, TheWrapperReadsWhatTheHouseWrites) {
  const dancegraph::Library library(DANCE_ADAPTER_FILE);
  ASSERT_TRUE(library) << library.problem();
  dancegraph::Adapter adapter(library, name_.c_str(), DANCE_AXES_UNREAL);
  ASSERT_TRUE(adapter);
  stage("alice", 41);
  stage("bob", 17);
  dancegraph::GuestList guests;
  ASSERT_TRUE(wait_for([&] {
    adapter.guests(guests);
    return guests.count == 2;
  }));
  EXPECT_EQ(adapter.state(), DANCE_OK);
  std::uint32_t slot = 99;
  ASSERT_EQ(adapter.find("bob", slot), DANCE_OK);
  auto pose = dancegraph::make<dance_pose>();
  ASSERT_EQ(adapter.newest(slot, pose), DANCE_OK);
  EXPECT_EQ(pose.sequence, 17u);
  // 2 m before the middle and 0.5 m to the dancer's left, in centimetres: Unreal's right is +Y.
  EXPECT_NEAR(pose.hips_position[0], 200.0f, 1e-3f);
  EXPECT_NEAR(pose.hips_position[1], -50.0f, 1e-3f);
  EXPECT_NEAR(pose.hips_position[2], 90.0f, 1e-3f);
  auto skeleton = dancegraph::make<dance_skeleton>();
  auto world = dancegraph::make<dance_world>();
  ASSERT_EQ(adapter.skeleton(slot, skeleton), DANCE_OK);
  ASSERT_EQ(adapter.world_of(skeleton, pose, world), DANCE_OK);
  const auto hand = world.position[index_of(Bone::kLeftHand)];
  const auto other = world.position[index_of(Bone::kRightHand)];
  EXPECT_LT(hand[2], other[2] - 30.0f) << "the lowered hand";
  EXPECT_LT(hand[1], other[1]) << "the left one";
  EXPECT_EQ(adapter.newest(DANCE_MAX_GUESTS, pose), DANCE_BAD_ARGUMENT);
}

TEST_F(UnrealBinding, TheWrapperMovesItsHandleAndIsFalseWithoutLibraryOrName) {
  const dancegraph::Library none("/no/such/libdance_adapter.so");
  EXPECT_FALSE(none);
  EXPECT_NE(std::string(none.problem()).find("install dancegraph"), std::string::npos);
  dancegraph::Adapter closed(none, nullptr, DANCE_AXES_UNREAL);
  EXPECT_FALSE(closed);
  auto pose = dancegraph::make<dance_pose>();
  EXPECT_EQ(closed.newest(0, pose), DANCE_NO_HOUSE);
  dancegraph::Producer silent(none, nullptr, DANCE_AXES_UNREAL);
  EXPECT_FALSE(silent);
  EXPECT_EQ(silent.pose(pose), DANCE_NO_HOUSE);

  const dancegraph::Library library(DANCE_ADAPTER_FILE);
  ASSERT_TRUE(library);
  EXPECT_FALSE(dancegraph::Adapter(library, "No Name!", DANCE_AXES_UNREAL));
  dancegraph::Adapter first(library, name_.c_str(), DANCE_AXES_UNREAL);
  dancegraph::Adapter second(std::move(first));
  EXPECT_FALSE(first);
  EXPECT_TRUE(second);
  first = std::move(second);
  EXPECT_TRUE(first);
  EXPECT_FALSE(second);
  dancegraph::Producer producer(library, ("none-" + name_).c_str(), DANCE_AXES_UNREAL);
  ASSERT_TRUE(producer);
  for (auto& rotation : pose.rotation) rotation[3] = 1.0f;
  EXPECT_EQ(producer.pose(pose), DANCE_NO_HOUSE);
  pose.rotation[3][0] = 5.0f;
  EXPECT_EQ(producer.pose(pose), DANCE_INVALID);
}

TEST_F(UnrealBinding, LiveLinkHasASubjectOfEachDancerWhileItIsThere) {
  KeepingClient client;
  IModularFeatures::Get().client = &client;
  const auto module = make_module_DanceGraph();
  module->StartupModule();
  ASSERT_NE(IConsoleManager::Get().command, nullptr);
  TArray<FString> arguments;
  arguments.Add(FString(name_.c_str()));
  IConsoleManager::Get().command(arguments);
  ASSERT_NE(client.added, nullptr);
  ASSERT_TRUE(client.added->IsSourceStillValid()) << *client.added->GetSourceStatus().string;
  std::uint32_t sequence = 1;
  ASSERT_TRUE(wait_for([&] {
    stage("alice", ++sequence);
    return client.subject("alice").frames > 3;
  }));
  const KeepingClient::Subject alice = client.subject("alice");
  EXPECT_EQ(alice.skeletons, 1) << "again only when it is another";
  ASSERT_EQ(alice.skeleton.BoneNames.Num(), DANCE_BONES);
  ASSERT_EQ(alice.frame.Transforms.Num(), DANCE_BONES);
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    EXPECT_EQ(alice.skeleton.BoneNames[int32(b)], FName(std::string(kBones[b].name).c_str()));
    EXPECT_EQ(alice.skeleton.BoneParents[int32(b)], kBones[b].parent);
  }
  const FTransform& hips = alice.frame.Transforms[0];
  EXPECT_NEAR(hips.Place.X, 200.0, 1e-3);
  EXPECT_NEAR(hips.Place.Y, -50.0, 1e-3);
  EXPECT_NEAR(hips.Place.Z, 90.0, 1e-3);
  // About glTF's +Z by -1.2 is about Unreal's +X by +1.2: of one handedness is not the other.
  const FTransform& arm = alice.frame.Transforms[int32(index_of(Bone::kLeftUpperArm))];
  EXPECT_NEAR(arm.Rotation.X, std::sin(0.6), 1e-5);
  EXPECT_NEAR(arm.Rotation.W, std::cos(0.6), 1e-5);
  const Eigen::Vector3f offset = average_skeleton(1.6f).offset(Bone::kLeftUpperArm);
  EXPECT_NEAR(arm.Place.Y, -100.0 * offset.x(), 1e-3);
  // Bob comes; alice has been silent for too long.
  house_->on_second(mono_now() + EngineConsumer::kSilence + Duration::s(1));
  ASSERT_TRUE(wait_for([&] {
    stage("bob", ++sequence);
    return client.subject("bob").frames > 0 && client.subject("alice").frames == 0;
  }));
  EXPECT_EQ(client.size(), 1u);
  client.added->RequestSourceShutdown();
  module->ShutdownModule();
  IModularFeatures::Get().client = nullptr;
}

TEST_F(UnrealBinding, TheLibraryOfThePluginsFolderIsTakenAndElseTheSystems) {
  const auto is_there = [&] {
    return FDanceLiveLinkSource(FString(name_.c_str())).IsSourceStillValid();
  };
  EXPECT_TRUE(is_there()) << "in the plug-in's folder";
  const std::string file =
      folder_.path("DanceGraph/Source/DanceGraph/ThirdParty/libdance_adapter.so.1");
  std::filesystem::remove(file);
  std::ofstream(file) << "no library";
  EXPECT_FALSE(is_there()) << "the plug-in's is taken, not the system's";
  std::filesystem::remove(file);
  // What this process has loaded is found by its name with a version: as of the package, which has
  // no other.
  const dancegraph::Library loaded(DANCE_ADAPTER_FILE);
  EXPECT_TRUE(is_there()) << "the plug-in has none";
  IPluginManager::Get().plugin = nullptr;
  EXPECT_TRUE(is_there()) << "no plug-in of that name";
}

TEST_F(UnrealBinding, ADancerThatStartsAgainIsRemovedOnceAndIsThereAtOnce) {
  KeepingClient client;
  FDanceLiveLinkSource source(FString(name_.c_str()));
  source.ReceiveClient(&client, FGuid());
  std::uint32_t sequence = 0;
  constexpr int kRestarts = 20;
  for (int restart = 0; restart <= kRestarts; ++restart) {
    MonoTime now = mono_now();
    // Between two reads of the source, mostly.
    if (restart > 0) house_->on_second(now + EngineConsumer::kSilence + Duration::s(1));
    const float height_m = restart % 2 == 0 ? 1.6f : 1.9f;
    const int arm_mm = static_cast<int>(
        std::lround(-1000.0f * average_skeleton(height_m).offset(Bone::kLeftUpperArm).x()));
    stage("alice", ++sequence, height_m);
    ASSERT_TRUE(wait_for([&] {
      stage("alice", ++sequence, height_m);
      const auto seen = client.subject("alice");
      return client.removals() >= restart && seen.frames > 2 && seen.upper_arms_mm.count(arm_mm);
    })) << restart;
    EXPECT_GT(client.subject("alice").skeletons, 0) << "frames of a removed subject";
    EXPECT_EQ(client.removals(), restart);
  }
  source.RequestSourceShutdown();
}

TEST_F(UnrealBinding, TwoDancersKeepTheirOwnProportionsWhenTheWriterIsFaster) {
  put_into_plugin(BUSY_ADAPTER_FILE);
  KeepingClient client;
  FDanceLiveLinkSource source(FString(name_.c_str()));
  source.ReceiveClient(&client, FGuid());
  std::uint32_t sequence = 0;
  ASSERT_TRUE(wait_for([&] {
    stage("alice", ++sequence, 1.5f);
    stage("bob", sequence, 1.9f);
    return client.subject("alice").frames > 30 && client.subject("bob").frames > 30;
  }));
  source.RequestSourceShutdown();
  for (const auto& [guest, height_m] : {std::pair("alice", 1.5f), std::pair("bob", 1.9f)}) {
    const float x_m = average_skeleton(height_m).offset(Bone::kLeftUpperArm).x();
    EXPECT_EQ(client.subject(guest).upper_arms_mm,
              std::set<int>{static_cast<int>(std::lround(-1000.0f * x_m))})
        << guest;
  }
}

}  // namespace
}  // namespace dance
