// StageRoster: turns a GuestBoard's updates into the scene to draw: guests who are present, those
// who fade out after silence or have come back, and those whose pose is new in this picture.
//
// Units/frames: MonoTime of this process.
// Ownership:    borrows the board.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none.
#pragma once

#include <span>
#include <vector>

#include "viewer/feed/guest_board.h"
#include "viewer/scene/scene.h"

namespace dance {

class StageRoster {
 public:
  explicit StageRoster(GuestBoard& board);

  // Reads the board's updates and fills scene.guests, sorted by id, scene.music, scene.voices,
  // scene.lines, scene.names, scene.recorders and scene.host.
  void update(MonoTime now, SceneState& scene);

  // The guests whose pose was new in the last update().
  struct Fresh {
    GuestId guest;
    Pose pose;
    MonoTime heard;
    MonoTime moment;  // as GuestNews
  };
  std::span<const Fresh> fresh() const { return fresh_; }

 private:
  void update_voices(MonoTime now, SceneState& scene);
  void update_lines(SceneState& scene);
  void update_profiles(MonoTime now, SceneState& scene);

  GuestBoard& board_;
  BeatClock music_;
  VoiceBoard::Voices voices_;
  std::vector<SceneLine> lines_;
  ProfileBoard::Profiles profiles_;
  ShownNames names_;
  std::vector<GuestId> named_beside_;  // the guests of the picture for which names_ was made
  std::vector<GuestNews> guests_;
  std::vector<Fresh> fresh_;
  std::uint32_t epoch_ = 0;  // of the board
};

}  // namespace dance
