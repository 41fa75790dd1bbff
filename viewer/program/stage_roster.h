// StageRoster: turns a GuestBoard's news into the scene to draw: which guests are present, fading
// out after silence, or back, and whose pose is new in this picture.
//
// Units/frames: MonoTime of this process.
// Ownership:    borrows the board.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none.
#pragma once

#include <span>
#include <vector>

#include "viewer/draw/scene.h"
#include "viewer/program/guest_board.h"

namespace dance {

class StageRoster {
 public:
  explicit StageRoster(GuestBoard& board);

  // Takes what is new and fills scene.guests, sorted by name, and scene.music.
  void update(MonoTime now, SceneState& scene);

  // The guests whose pose was new in the last update().
  struct Fresh {
    GuestId guest;
    Pose pose;
    MonoTime heard;
  };
  std::span<const Fresh> fresh() const { return fresh_; }
  // A count that changes whenever a guest comes or goes.
  int arrivals() const { return arrivals_; }

 private:
  struct Entry {
    GuestNews news;
    bool is_shown = false;
  };
  GuestBoard& board_;
  BeatClock music_;
  std::vector<Entry> entries_;
  std::vector<Fresh> fresh_;
  int arrivals_ = 0;
};

}  // namespace dance
