// The dances on which it is judged what an audience sees: recorded takes from all sides, before a
// network that takes backs for fronts, with the legs out of the picture, and persons who stand
// still.
//
// Units/frames: as shown_eval.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>
#include <vector>

#include "research/capture/shown_eval.h"
#include "research/codec_takes.h"

namespace dance {

// One row of the table: several scenes, with the corrections of what is shown and without.
struct ShownRow {
  std::string name;
  ShownFigures truth, before, now;
  int flipped = 0;  // frames in which the network took a back for a front
};

// Without what corrects the shown pose last: as it was before there was any.
SolverOptions without_corrections(SolverOptions options);

// The dancer turned about the vertical.
std::vector<Pose> turned_poses(const std::vector<Pose>& poses, double angle_rad);
// A person who stands still: arms hanging, bent, spread, raised.
constexpr std::size_t kStillPostures = 4;
Pose still_posture(std::size_t which);

struct ShownScenes {
  int sides = 4;  // from which each take is seen
  std::size_t postures = kStillPostures;
};
std::vector<ShownRow> shown_rows(const std::vector<CodecTake>& takes, const SceneCamera& camera,
                                 const SolverOptions& options, const ShownScenes& scenes = {});
// Landmarks of a real network.
ShownRow shown_row(const std::string& name, std::span<const BodyLandmarks> landmarks, double hz,
                   const Pinhole& camera, const SolverOptions& options);

std::string shown_table(const std::vector<ShownRow>& rows);

}  // namespace dance
