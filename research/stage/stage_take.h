// A recorded couple, and the avatars they wear, as `dance stage eval` measures them.
//
// Units/frames: poses in W, 1/hz apart, both dancers' frames of the same moments.
// Ownership:    plain values.
// Threads:      none inside; reads files on the caller's thread.
// Failure:      an Error names the file and the cure.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pose/clip.h"
#include "viewer/scene/scene.h"

namespace dance {

struct StageDancer {
  std::string name;
  MotionClip clip;
};

struct StageTake {
  double hz = 60.0;
  std::vector<StageDancer> dancers;
  std::size_t frames() const;
};

// Each file holds one dancer or several: BVH (also packed with xz), glTF, or a log.
Result<StageTake> load_stage_take(std::span<const std::string> files, double hz);

// Recordings whose hands meet: palms of two dancers that come within join_m of each other are
// brought together, nearer the nearer they are, by the dancers' own arms. Motion capture that was
// put onto other bodies than the dancers' holds hands at 20 cm.
void join_hands(StageTake& take, float join_m);

// "mannequin": the dancer's own; "mannequin:1.1": one of an average body 1.1 m tall; else a file.
Result<std::shared_ptr<const AvatarModel>> load_stage_avatar(const std::string& name,
                                                             const Skeleton& dancer);

// The moment `frame`, everybody in an avatar.
struct StageWear {
  std::vector<std::shared_ptr<const AvatarModel>> avatars;  // of each dancer
  FigureSize size = FigureSize::kDancers;
  float height_scale = 1.0f;
};
SceneState scene_of(const StageTake& take, const StageWear& wear, std::size_t frame);

}  // namespace dance
