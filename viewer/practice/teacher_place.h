// TeacherPlace: where a recorded dancer stands beside the pupil, and how a mirror shows it.
//
// Units/frames: W, metres. The place is that of the first recorded pose that was shown: there the
//               teacher faces as the pupil did when the place was chosen. It then stays in the
//               room, as a turn of the pupil must not swing the teacher round.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      without a pupil the teacher stands where it was recorded.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "core/base/guest_id.h"
#include "viewer/scene/scene.h"

namespace dance {

// Settings of the teacher that a person changes while practising.
struct TeacherChoices {
  static constexpr double kSlowest = 0.5, kFastest = 1.0, kStep = 0.1;

  double speed = 1.0;
  bool is_mirrored = false;
  bool is_over = false;  // in the pupil's own place; else to the pupil's right
  bool operator==(const TeacherChoices&) const = default;
};
// Changes the speed by N steps of kStep, within the bounds.
double changed_speed(double speed, int steps);

// A recording to dance beside.
struct TeacherOptions {
  std::string file;  // of any kind that `dance view` shows; "" = none
  GuestId dancer;    // not set: the first of the recording
  TeacherChoices choices;
};

class TeacherPlace {
 public:
  static constexpr float kBeside_m = 1.1f;

  bool has_pupil() const { return has_pupil_; }
  // The first pose that is shown of the recording.
  void begin(const SceneGuest& recorded);
  bool has_begun() const { return has_begun_; }
  void put_beside(const SceneGuest& pupil, bool is_over);
  // Moves the figure from where it was recorded.
  void apply(SceneGuest& figure, bool is_mirrored) const;

 private:
  Eigen::Vector3f p_WFrom_m_ = Eigen::Vector3f::Zero(), p_WTo_m_ = Eigen::Vector3f::Zero();
  float from_rad_ = 0.0f, to_rad_ = 0.0f;
  bool has_begun_ = false, has_pupil_ = false;
};

// The figure in the mirror x = 0: left limbs move as right ones did.
void mirror_figure(SceneGuest& figure);

}  // namespace dance
