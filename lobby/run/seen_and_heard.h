// SeenAndHeard: camera and sound before the dance, as the You screen shows them: looks at the
// camera while that screen is open, and listens while the sound is tested.
//
// Units/frames: none.
// Ownership:    owns the checks; each ends when it is no longer shown.
// Threads:      the drawing thread; nothing waits but the end of the camera's program.
// Failure:      becomes advice in the model.
#pragma once

#include <memory>
#include <string>

#include "lobby/checks/camera_check.h"
#include "lobby/checks/camera_list.h"
#include "lobby/checks/sound_check.h"
#include "lobby/run/lobby_painter.h"

namespace dance {

class SeenAndHeard {
 public:
  // Which cameras there are; the answer comes later.
  void look_for_cameras(LobbyModel& model);
  // Begins and ends what the model shows, and takes what has come; true where that is new.
  bool look(LobbyModel& model, LobbyPainter& painter, MonoTime now);
  // Lets go of camera and sound, for a house that wants them.
  void stop(LobbyModel& model);
  void play_count_in();
  bool is_busy() const { return camera_ || sound_ || cameras_; }

 private:
  void begin_and_end(LobbyModel& model);
  bool take_cameras(LobbyModel& model);
  bool take_picture(LobbyModel& model, LobbyPainter& painter, MonoTime now);
  bool take_sound(LobbyModel& model, MonoTime now);

  std::unique_ptr<CameraList> cameras_;  // while it is asked
  std::unique_ptr<CameraCheck> camera_;
  std::string camera_device_;
  std::unique_ptr<SoundCheck> sound_;
  SoundChoice sound_choice_;
};

}  // namespace dance
