#include "viewer/replay/recorded_teacher.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_folder.h"
#include "tests/viewer/replay/recorded_night.h"
#include "tests/viewer/test_scene.h"

namespace dance {
namespace {

constexpr double kRecorded_s = 6.0;

class RecordedTeacherTest : public testing::Test {
 protected:
  void SetUp() override { write_recorded_night(options_.file, kRecorded_s, false); }

  // The hips in 50 pictures a second, from the first one in which the recording is loaded.
  std::vector<Eigen::Vector3f> hips_over(RecordedTeacher& teacher, const TeacherChoices& choices,
                                         double seconds) {
    SceneState scene = scene_at(now_);
    for (int tries = 0; tries < 20'000 && scene.guests.size() < 2; ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      scene = scene_at(now_);
      teacher.join(pupil_, choices, scene);
    }
    std::vector<Eigen::Vector3f> hips{figure_of(scene).pose.p_WH_m};
    for (int i = 0; i < static_cast<int>(seconds * 50.0); ++i) {
      now_ += Duration::ms(20);
      scene = scene_at(now_);
      teacher.join(pupil_, choices, scene);
      hips.push_back(figure_of(scene).pose.p_WH_m);
    }
    return hips;
  }
  SceneState scene_at(MonoTime now) const {
    SceneState scene;
    scene.time = now;
    scene.guests.push_back(guest_at_ease("pupil", Eigen::Vector3f::Zero(), 0.0f));
    return scene;
  }
  static const SceneGuest& figure_of(const SceneState& scene) {
    static const SceneGuest none;
    for (const SceneGuest& guest : scene.guests)
      if (guest.id.view() == "teacher") return guest;
    ADD_FAILURE() << "no teacher";
    return none;
  }
  std::unique_ptr<RecordedTeacher> open() {
    auto teacher = RecordedTeacher::open(options_);
    EXPECT_TRUE(teacher) << teacher.error().what;
    return teacher ? std::move(*teacher) : nullptr;
  }

  TestFolder folder_{"teacher"};
  TeacherOptions options_{folder_.path("night.lcm"), {}, {}};
  std::optional<GuestId> pupil_ = GuestId::parse("pupil");
  MonoTime now_ = MonoTime::from_us(50'000'000);
};

TEST_F(RecordedTeacherTest, DancesTransparentlyBesideThePupilAndLoops) {
  const auto teacher = open();
  ASSERT_TRUE(teacher);
  const auto hips = hips_over(*teacher, {}, 2.2 * kRecorded_s);
  EXPECT_NEAR(hips.front().x(), -TeacherPlace::kBeside_m, 0.05f) << "right of who faces +Z";
  EXPECT_NEAR(hips.front().z(), 0.0f, 0.05f);
  // Still moves in the third round.
  std::set<float> places;
  for (std::size_t i = hips.size() - 20; i < hips.size(); ++i) places.insert(hips[i].x());
  EXPECT_GT(places.size(), 5u);
  SceneState scene = scene_at(now_);
  scene.guests.push_back(
      guest_at_ease("teacher", Eigen::Vector3f::Zero(), 0.0f));  // a guest who is called so
  teacher->join(pupil_, {}, scene);
  ASSERT_EQ(scene.guests.size(), 3u);
  EXPECT_EQ(scene.guests.back().id.view(), "teacher-2");
  EXPECT_GT(scene.guests.back().opacity, 0.2f);
  EXPECT_LT(scene.guests.back().opacity, 0.6f);
}

TEST_F(RecordedTeacherTest, AtHalfSpeedEachMomentComesAfterTwiceTheTime) {
  const auto fast = open(), slow = open();
  ASSERT_TRUE(fast && slow);
  const auto fast_hips = hips_over(*fast, {}, 1.0);
  TeacherChoices half;
  half.speed = 0.5;
  const auto slow_hips = hips_over(*slow, half, 2.0);
  double moved = 0.0;
  for (std::size_t i = 0; i < fast_hips.size(); ++i) {
    EXPECT_LT((slow_hips[2 * i] - fast_hips[i]).norm(), 1e-3f) << i;
    if (i > 0) moved += static_cast<double>((fast_hips[i] - fast_hips[i - 1]).norm());
  }
  EXPECT_GT(moved, 0.05) << "somebody dances";
}

TEST_F(RecordedTeacherTest, RefusesAFileThatIsNoRecording) {
  options_.file = folder_.path("none.lcm");
  auto none = RecordedTeacher::open(options_);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("none.lcm"), std::string::npos);
  options_.file = folder_.path("text.bvh");
  std::ofstream(options_.file) << "nothing";
  EXPECT_FALSE(RecordedTeacher::open(options_));
}

// A take of motion capture, packed.
TEST_F(RecordedTeacherTest, DancesATakeOfMotionCapture) {
  options_.file = DANCE_SOURCE_DIR "/../shared/data/mocap/cmu_60_01_salsa.bvh.xz";
  if (!std::filesystem::exists(options_.file)) GTEST_SKIP() << options_.file;
  const auto teacher = open();
  ASSERT_TRUE(teacher);
  const auto hips = hips_over(*teacher, {}, 1.0);
  EXPECT_GT((hips.back() - hips.front()).norm(), 0.02f);
}

}  // namespace
}  // namespace dance
