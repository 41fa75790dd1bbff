// BoardSource: a live house for a window under test, whose guests the test puts on its boards.
//
// Units/frames: as PictureSource.
// Ownership:    owns its boards.
// Threads:      the test's.
// Failure:      none.
#pragma once

#include "core/net/mono_clock.h"
#include "viewer/feed/picture_source.h"

namespace dance {

class BoardSource : public PictureSource {
 public:
  GuestBoard& board() override { return board_; }
  InstrumentBoard& instruments() override { return instruments_; }
  MonoTime begin() const override { return begin_; }
  MonoTime wait_until(MonoTime) override { return mono_now(); }
  bool is_over() const override { return false; }
  const std::string& name() const override { return name_; }
  void put(const SceneState& scene) {
    for (const SceneGuest& guest : scene.guests) {
      Pose pose = guest.pose;
      pose.sequence = ++sequence_;
      board_.on_skeleton(guest.id, guest.skeleton, mono_now());
      board_.on_pose(Where::kStage, guest.id, pose, mono_now());
    }
  }

 protected:
  std::uint32_t sequence() const { return sequence_; }

 private:
  GuestBoard board_{this_clock_id(), false};
  InstrumentBoard instruments_{this_clock_id()};
  MonoTime begin_ = mono_now();
  std::string name_ = "a test";
  std::uint32_t sequence_ = 0;
};

}  // namespace dance
