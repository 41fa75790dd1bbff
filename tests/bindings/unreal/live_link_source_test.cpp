// The C++ wrapper and Unreal's plug-in read the memory of a house: the consumer "engine" writes it
// in this process. Unreal is a stub of its API (unreal_stub.h).
#include <gtest/gtest.h>
#include <unistd.h>

#include <map>
#include <mutex>

#include "bindings/unreal/DanceAdapter.hpp"
#include "bindings/unreal/DanceGraph/Source/DanceGraph/DanceLiveLinkSource.h"
#include "consumers/engine/engine_consumer.h"
#include "core/net/mono_clock.h"
#include "tests/apps/run_program.h"
#include "tests/bindings/unreal/unreal_stub.h"

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
    subjects_[key.SubjectName].frame = data.data;
    ++subjects_[key.SubjectName].frames;
  }
  void RemoveSubject_AnyThread(const FLiveLinkSubjectKey& key) override {
    const std::lock_guard lock(mutex_);
    subjects_.erase(key.SubjectName);
  }
  Subject subject(const char* name) {
    const std::lock_guard lock(mutex_);
    const auto found = subjects_.find(FName(name));
    return found == subjects_.end() ? Subject() : found->second;
  }
  std::size_t size() {
    const std::lock_guard lock(mutex_);
    return subjects_.size();
  }

  TSharedPtr<ILiveLinkSource> added;

 private:
  std::mutex mutex_;
  std::map<FName, Subject> subjects_;
};

class UnrealBinding : public testing::Test {
 protected:
  void SetUp() override {
    name_ = "unreal-" + std::to_string(getpid());
    auto house = EngineConsumer::open(name_, 0.0, 7, mono_now());
    ASSERT_TRUE(house) << house.error().what;
    house_ = std::move(*house);
  }

  void stage(const char* guest, std::uint32_t sequence) {
    Pose pose;
    pose.clock_id = 7;
    pose.sequence = sequence;
    pose.capture_time = mono_now();
    pose.stamp(Hop::kStaged, pose.capture_time);
    pose.p_WH_m = Eigen::Vector3f(0.5f, 0.9f, 2.0f);
    // The left arm lowered.
    pose.R_PB[index_of(Bone::kLeftUpperArm)] = Eigen::AngleAxisf(-1.2f, Eigen::Vector3f::UnitZ());
    house_->on_skeleton(*GuestId::parse(guest), average_skeleton(1.6f), pose.capture_time);
    house_->on_pose(*GuestId::parse(guest), pose, pose.capture_time);
  }

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

}  // namespace
}  // namespace dance
