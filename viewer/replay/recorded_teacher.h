// RecordedTeacher: a dancer of a recording as a transparent figure on a live stage to dance beside:
// looped, at half to full speed, mirrored on request. It is in this window's scene alone: nothing
// of it goes to the bus or the room.
//
// Units/frames: the scene's time; W.
// Ownership:    owns the recording, and the log that was made of it where it is of another kind.
// Threads:      the drawing thread; the recording is indexed in a thread of its own meanwhile.
// Failure:      open() names the file and the cure. note() says what goes wrong later; there is no
//               figure then.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "formats/recorded/recording_log.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/practice/teacher_place.h"
#include "viewer/replay/replay_source.h"

namespace dance {

class RecordedTeacher {
 public:
  static Result<std::unique_ptr<RecordedTeacher>> open(const TeacherOptions& options);

  // Adds the figure to the scene of a live house, whose time goes on from call to call.
  void join(const std::optional<GuestId>& pupil, const TeacherChoices& choices, SceneState& scene);
  std::string note() const { return source_->note(); }

 private:
  RecordedTeacher(RecordingLog log, const TeacherOptions& options);
  const SceneGuest* find() const;

  RecordingLog log_;
  ViewOptions view_;
  GuestId dancer_;  // not set: not chosen yet
  std::unique_ptr<ReplaySource> source_;
  std::optional<StageRoster> roster_;
  SceneState recorded_;
  TeacherPlace place_;
  bool was_over_ = false;
};

}  // namespace dance
