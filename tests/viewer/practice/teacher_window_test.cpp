// The teacher in the window of a live house.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "core/net/mono_clock.h"
#include "tests/test_folder.h"
#include "tests/viewer/board_source.h"
#include "tests/viewer/driver_memory.h"
#include "tests/viewer/replay/recorded_night.h"
#include "tests/viewer/test_scene.h"
#include "tests/virtual_display.h"
#include "viewer/window/window_run.h"

namespace dance {
namespace {

// Notes who is reported as shown: that is all that a window publishes of a scene.
class PractisingHouse final : public BoardSource {
 public:
  StepScoreBoard* step_scores() override { return &scores_; }
  void report_shown(std::span<const StageRoster::Fresh> fresh, MonoTime) override {
    for (const StageRoster::Fresh& it : fresh) has_told_of_teacher_ |= it.guest != pupil_;
  }
  void put_pupil() {
    SceneState scene;
    scene.guests.push_back(guest_at_ease("alice", Eigen::Vector3f::Zero(), 0.0f));
    put(scene);
    Pose pose = scene.guests.front().pose;
    pose.clock_id = this_clock_id();
    pose.capture_time = mono_now();
    scores_.on_pose(pupil_, pose, mono_now());
  }
  bool has_told_of_teacher() const { return has_told_of_teacher_; }

 private:
  GuestId pupil_ = *GuestId::parse("alice");
  StepScoreBoard scores_{this_clock_id()};
  bool has_told_of_teacher_ = false;
};

TEST(TeacherWindow, ShowsTheRecordedDancerBesideThePupilAndPublishesNothingOfIt) {
  const VirtualDisplay display;
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  setenv("DISPLAY", display.display().c_str(), 1);
  const TestFolder folder("teacher-window");
  ViewOptions options;
  options.size = {480, 360};
  options.quality = QualityWish::kLow;
  options.hud = false;
  options.teacher.file = folder.path("night.lcm");
  write_recorded_night(options.teacher.file, 3.0, false);
  PractisingHouse house;
  auto run = WindowRun::create(options, house);
  if (!run) GTEST_SKIP() << run.error().what;
  keep_drivers_loaded();
  const SceneGuest* teacher = nullptr;
  for (int i = 0; i < 3000 && teacher == nullptr; ++i) {
    house.put_pupil();
    const auto turned = (*run)->turn();
    ASSERT_TRUE(turned) << turned.error().what;
    for (const SceneGuest& guest : (*run)->scene().guests)
      if (guest.id.view() == "teacher") teacher = &guest;
  }
  ASSERT_NE(teacher, nullptr);
  EXPECT_NEAR(teacher->pose.p_WH_m.x(), -TeacherPlace::kBeside_m, 0.1f);
  EXPECT_LT(teacher->opacity, 0.6f);
  EXPECT_TRUE(teacher->avatar) << "it is dressed as others are";
  EXPECT_FALSE(house.has_told_of_teacher());
}

}  // namespace
}  // namespace dance
