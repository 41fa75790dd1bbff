// The figures of guests: made beside the drawing, shared, bounded, and never absent.
#include "viewer/avatar/avatar_library.h"

#include <gtest/gtest.h>
#include <sys/prctl.h>

#include <atomic>
#include <fstream>
#include <future>
#include <iterator>
#include <thread>

#include "formats/avatar/mannequin_model.h"
#include "tests/allocation_guard.h"
#include "viewer/avatar/avatar_loader.h"

namespace dance {
namespace {

SceneGuest guest_called(const char* name, float height_m = 1.72f) {
  SceneGuest guest;
  guest.id = *GuestId::parse(name);
  guest.skeleton = average_skeleton(height_m);
  return guest;
}

SceneState scene_at(std::vector<SceneGuest> guests, double at_s = 100.0) {
  SceneState scene;
  scene.time = MonoTime::from_us(0) + Duration::seconds(at_s);
  scene.guests = std::move(guests);
  return scene;
}

// As the window does it: guests of each picture come without figures.
void undress(SceneState& scene) {
  for (SceneGuest& guest : scene.guests) guest.avatar.reset();
  scene.notes.clear();
}

AvatarModel model_called(const std::string& name) {
  static const AvatarModel mannequin =
      mannequin_model(average_skeleton(), look_of(GuestId()), false);
  AvatarModel model = mannequin;
  model.name = name;
  return model;
}

FileHash hash_of(std::uint8_t first) {
  FileHash hash;
  hash.bytes[0] = first;
  return hash;
}

TEST(AvatarLibrary, GivesEveryGuestAFigureInTheFirstPicture) {
  std::promise<void> may_go_on;
  AvatarLibraryOptions options;
  options.overrides = {{GuestId(), "slow.vrm"}};
  options.sources.read_file = [wait = may_go_on.get_future().share()](const std::string& path,
                                                                      const AvatarStop&) {
    wait.wait();
    return Result<AvatarModel>(model_called(path));
  };
  AvatarLibrary library(std::move(options));
  SceneState scene = scene_at({guest_called("alice"), guest_called("bob", 1.9f)});
  library.dress(scene);  // while the loading thread is held
  ASSERT_TRUE(scene.guests[0].avatar);
  EXPECT_EQ(scene.guests[0].avatar, scene.guests[1].avatar);
  EXPECT_TRUE(is_sound(*scene.guests[0].avatar));
  EXPECT_EQ(scene.guests[0].avatar->name, "mannequin");
  may_go_on.set_value();
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar->name, "slow.vrm");
}

TEST(AvatarLibrary, MakesMannequinsInTheDancersProportionsAndColours) {
  AvatarLibrary library;
  SceneState scene = scene_at({guest_called("alice", 1.6f), guest_called("bob", 1.9f)});
  scene.guests[1].wish.name = *GuestId::parse("dress-bun");
  scene.guests[1].wish.colour_rgb = {0.0f, 0.5f, 0.0f};
  scene.guests[1].wish.height_scale = 1.5f;
  library.wait_and_dress(scene);
  const AvatarModel& alice = *scene.guests[0].avatar;
  const AvatarModel& bob = *scene.guests[1].avatar;
  EXPECT_NEAR(alice.nodes[0].translation_m.y(), average_skeleton(1.6f).hips_height_m(), 0.003f);
  EXPECT_NEAR(bob.nodes[0].translation_m.y(), average_skeleton(1.9f).hips_height_m(), 0.003f);
  const auto has_colour = [&](const Eigen::Vector3f& colour) {
    return std::ranges::any_of(bob.materials, [&](const AvatarMaterial& material) {
      return material.base_colour.head<3>() == colour;
    });
  };
  EXPECT_TRUE(has_colour({0.0f, 0.5f, 0.0f}));
  EXPECT_EQ(scene.guests[0].height_scale, 1.0f);
  EXPECT_EQ(scene.guests[1].height_scale, 1.5f);
}

TEST(AvatarLibrary, KeepsAMannequinWhileTheMeasurementOnlyTrembles) {
  AvatarLibrary library;
  SceneState scene = scene_at({guest_called("alice")});
  library.wait_and_dress(scene);
  const auto before = scene.guests[0].avatar;
  for (const float by_m : {0.002f, -0.002f, 0.003f}) {
    scene.guests[0].skeleton = average_skeleton();
    for (auto& offset_m : scene.guests[0].skeleton.offset_m) offset_m.y() += by_m;
    library.wait_and_dress(scene);
    EXPECT_EQ(scene.guests[0].avatar, before);
  }
  scene.guests[0].skeleton = average_skeleton(1.85f);
  undress(scene);
  library.dress(scene);
  EXPECT_EQ(scene.guests[0].avatar, before) << "the last figure stays until the next is ready";
  library.wait_and_dress(scene);
  EXPECT_NE(scene.guests[0].avatar, before);
}

TEST(AvatarLibrary, MakesFingersWhenTheyAreSeenAndKeepsThem) {
  AvatarLibrary library;
  SceneState scene = scene_at({guest_called("alice")});
  library.wait_and_dress(scene);
  const auto mittens = scene.guests[0].avatar;
  scene.guests[0].hands = Hands();
  library.wait_and_dress(scene);
  const auto fingers = scene.guests[0].avatar;
  EXPECT_NE(fingers, mittens);
  scene.guests[0].hands.reset();
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar, fingers);
}

TEST(AvatarLibrary, GivesARawTwinTheFigureOfItsDancer) {
  AvatarLibrary library;
  SceneState scene = scene_at({guest_called("alice"), guest_called("alice-raw")});
  scene.guests[0].wish.height_scale = 1.2f;
  library.wait_and_dress(scene);
  ASSERT_TRUE(scene.guests[1].avatar);
  EXPECT_EQ(scene.guests[1].avatar, scene.guests[0].avatar);
  EXPECT_EQ(scene.guests[1].height_scale, 1.2f);
}

TEST(AvatarLibrary, SharesOneModelAmongAllWhoChoseAFile) {
  std::atomic<int> reads{0};
  AvatarLibraryOptions options;
  options.sources.read_hash = [&](const FileHash&, const AvatarStop&) {
    ++reads;
    return std::optional<Result<AvatarModel>>(model_called("shared"));
  };
  AvatarLibrary library(std::move(options));
  SceneState scene = scene_at({guest_called("alice"), guest_called("bob")});
  for (SceneGuest& guest : scene.guests) guest.wish.file = hash_of(1);
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar, scene.guests[1].avatar);
  EXPECT_EQ(scene.guests[0].avatar->name, "shared");
  EXPECT_EQ(reads, 1);
}

TEST(AvatarLibrary, ShowsAFileWhenItHasArrivedAndAMannequinUntilThen) {
  std::atomic<bool> is_here{false};
  AvatarLibraryOptions options;
  options.sources.read_hash = [&](const FileHash&,
                                  const AvatarStop&) -> std::optional<Result<AvatarModel>> {
    if (!is_here) return std::nullopt;
    return model_called("arrived");
  };
  AvatarLibrary library(std::move(options));
  SceneState scene = scene_at({guest_called("bob")});
  scene.guests[0].wish.file = hash_of(7);
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar->name, "mannequin");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("bob's avatar is on its way"), std::string::npos);
  is_here = true;
  scene.time += Duration::ms(500);
  undress(scene);
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar->name, "mannequin") << "it looks again only each second";
  scene.time += Duration::ms(600);
  undress(scene);
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar->name, "arrived");
  EXPECT_TRUE(scene.notes.empty());
}

TEST(AvatarLibrary, TellsForAWhileWhatCannotBeRead) {
  AvatarLibraryOptions options;
  options.overrides = {{*GuestId::parse("bob"), "broken.glb"}};
  options.sources.read_file = [](const std::string& path, const AvatarStop&) {
    return Result<AvatarModel>(fail(path + " has no bones"));
  };
  AvatarLibrary library(std::move(options));
  SceneState scene = scene_at({guest_called("alice"), guest_called("bob")});
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[1].avatar->name, "mannequin");
  EXPECT_EQ(scene.notes, std::vector<std::string>{"bob's avatar cannot be read: broken.glb has no "
                                                  "bones; shown as a mannequin"});
  undress(scene);
  scene.time += Duration::s(20);
  library.wait_and_dress(scene);
  EXPECT_TRUE(scene.notes.empty());
  EXPECT_TRUE(scene.guests[1].avatar);
}

TEST(AvatarLibrary, TellsOfANameThatIsNotAmongTheAvatarsHere) {
  AvatarLibraryOptions options;
  options.sources.shipped_file = [](std::string_view name) {
    return name == "mara" ? std::string("mara.vrm") : std::string();
  };
  options.sources.read_file = [](const std::string& path, const AvatarStop&) {
    return Result<AvatarModel>(model_called(path));
  };
  AvatarLibrary library(std::move(options));
  SceneState scene = scene_at({guest_called("alice"), guest_called("bob")});
  scene.guests[0].wish.name = *GuestId::parse("mara");
  scene.guests[1].wish.name = *GuestId::parse("nobody");
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar->name, "mara.vrm");
  EXPECT_EQ(scene.guests[1].avatar->name, "mannequin");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("nobody is not among those here"), std::string::npos);
}

TEST(AvatarLibrary, IsBoundedInNumberAndBytes) {
  AvatarLibraryOptions options;
  options.most_models = 4;
  options.sources.read_hash = [](const FileHash& hash,
                                 const AvatarStop&) -> std::optional<Result<AvatarModel>> {
    AvatarModel model = model_called("large");
    // Number 99 alone is more than all that may be kept.
    model.pictures.push_back({1, 1, std::vector<std::uint8_t>(4)});
    if (hash == hash_of(99)) model.pictures[0].rgba.resize(std::size_t{64} << 20);
    return model;
  };
  options.most_bytes = std::size_t{32} << 20;
  AvatarLibrary library(std::move(options));
  SceneState scene = scene_at({guest_called("alice")});
  for (std::uint8_t i = 1; i < 20; ++i) {
    scene.guests[0].wish.file = hash_of(i);
    scene.time += Duration::ms(20);
    undress(scene);
    library.wait_and_dress(scene);
    EXPECT_EQ(scene.guests[0].avatar->name, "large");
  }
  library.dress(scene);
  EXPECT_LE(library.models(), 4u);
  EXPECT_LE(library.size_bytes(), std::size_t{32} << 20);
  scene.guests[0].wish.file = hash_of(99);
  undress(scene);
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar->name, "mannequin");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("no room"), std::string::npos);
  EXPECT_LE(library.size_bytes(), std::size_t{32} << 20);
}

// Two files of 20 MiB where there is room for one.
AvatarLibraryOptions with_room_for_one(std::atomic<int>& reads) {
  AvatarLibraryOptions options;
  options.most_bytes = std::size_t{32} << 20;
  options.sources.read_hash = [&reads](const FileHash& hash,
                                       const AvatarStop&) -> std::optional<Result<AvatarModel>> {
    ++reads;
    AvatarModel model = model_called(hash == hash_of(1) ? "first" : "second");
    model.pictures.push_back({1, 1, std::vector<std::uint8_t>(std::size_t{20} << 20)});
    return model;
  };
  return options;
}

TEST(AvatarLibrary, WhatHadNoRoomIsReadAgainWhenThereIsSome) {
  std::atomic<int> reads{0};
  AvatarLibrary library(with_room_for_one(reads));
  SceneState scene = scene_at({guest_called("alice"), guest_called("bob")});
  scene.guests[0].wish.file = hash_of(1);
  scene.guests[1].wish.file = hash_of(2);
  library.wait_and_dress(scene);
  EXPECT_EQ(scene.guests[0].avatar->name, "first");
  EXPECT_EQ(scene.guests[1].avatar->name, "mannequin");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("bob's avatar has no room"), std::string::npos);
  // While there is none it is not read in vain.
  for (int i = 0; i < 4; ++i) {
    scene.time += Duration::s(6);
    undress(scene);
    library.wait_and_dress(scene);
    EXPECT_EQ(scene.guests[1].avatar->name, "mannequin");
  }
  EXPECT_EQ(reads, 2);
  scene.guests[0].wish.file = {};  // alice takes her mannequin
  for (int i = 0; i < 2; ++i) {
    scene.time += Duration::s(3);
    undress(scene);
    library.wait_and_dress(scene);
  }
  EXPECT_EQ(scene.guests[1].avatar->name, "second");
  EXPECT_TRUE(scene.notes.empty());
  EXPECT_EQ(reads, 3);
  EXPECT_LE(library.size_bytes(), std::size_t{32} << 20);
}

TEST(AvatarLibrary, OneModelTakesNoLargePartOfTheCache) {
  std::atomic<int> reads{0};
  AvatarLibraryOptions options = with_room_for_one(reads);
  options.most_model_bytes = std::size_t{8} << 20;
  AvatarLibrary library(std::move(options));
  SceneState scene = scene_at({guest_called("alice")});
  scene.guests[0].wish.file = hash_of(1);
  for (int i = 0; i < 3; ++i) {
    library.wait_and_dress(scene);
    EXPECT_EQ(scene.guests[0].avatar->name, "mannequin");
    scene.time += Duration::s(6);
  }
  ASSERT_FALSE(scene.notes.empty());
  EXPECT_NE(scene.notes[0].find("too large"), std::string::npos);
  EXPECT_EQ(reads, 1);
  EXPECT_LT(library.size_bytes(), std::size_t{8} << 20);
  const AvatarLibraryOptions usual;
  EXPECT_LT(3 * usual.most_model_bytes, usual.most_bytes);
  EXPECT_LE(AvatarLimits().bytes, usual.most_model_bytes);
}

// The reading thread is told, so that a window closes at once, and what waits is not begun.
TEST(AvatarLibrary, ItsEndStopsWhatIsBeingRead) {
  std::promise<void> has_begun;
  std::atomic<int> begun{0};
  std::atomic<bool> was_stopped{false};
  {
    AvatarLibraryOptions options;
    options.sources.read_file = [&](const std::string&, const AvatarStop& stop) {
      if (++begun == 1) has_begun.set_value();
      while (!stop()) std::this_thread::yield();  // without the stop this test never ends
      was_stopped = true;
      return Result<AvatarModel>(fail("stopped"));
    };
    options.overrides = {{*GuestId::parse("alice"), "slow.vrm"},
                         {*GuestId::parse("bob"), "other.vrm"}};
    AvatarLibrary library(std::move(options));
    SceneState scene = scene_at({guest_called("alice"), guest_called("bob")});
    library.dress(scene);
    has_begun.get_future().wait();
  }
  EXPECT_TRUE(was_stopped);
  EXPECT_EQ(begun, 1);
}

TEST(AvatarLibrary, AllocatesNothingWhileNothingChanges) {
  AvatarLibrary library;
  SceneState scene = scene_at({guest_called("alice"), guest_called("bob")});
  library.wait_and_dress(scene);
  undress(scene);
  const AllocationGuard guard;
  library.dress(scene);
  EXPECT_EQ(guard.allocations(), 0u);
}

// Files of remote guests are read there.
TEST(AvatarLoader, ReadsOnAConfinedThreadWhereTheKernelHasSeccomp) {
#if !defined(DANCE_HAVE_SECCOMP) || defined(DANCE_SANITIZED)
  GTEST_SKIP() << "this build has no seccomp";
#endif
  if (prctl(PR_GET_SECCOMP) < 0) GTEST_SKIP() << "this kernel has no seccomp";
  AvatarLoader loader;
  std::string status;
  const auto job = loader.start([&](const AvatarStop&) -> AvatarJob::Made {
    std::ifstream file("/proc/thread-self/status");
    status.assign(std::istreambuf_iterator<char>(file), {});
    return std::nullopt;
  });
  loader.wait();
  EXPECT_TRUE(job->is_done());
  EXPECT_NE(status.find("Seccomp:\t2"), std::string::npos) << status;
}

}  // namespace
}  // namespace dance
