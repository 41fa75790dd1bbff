// Comparison: one stage twice, as its dancers' poses came and as its routes show them, for a
// picture with two halves. What came is a raw twin (core/base/raw_twin.h) where the house has one,
// else the pose that arrived in this house beside the one on its stage.
//
// Units/frames: as viewer/scene/scene.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a dancer of whom only one of the two is known is alike in both halves.
#pragma once

#include "viewer/scene/scene.h"

namespace dance {

struct Comparison {
  SceneState raw;    // twins in the places, clothes and names of their dancers
  SceneState shown;  // without twins
  bool is_of_twins = false;
};

bool has_twins(const SceneState& scene);
// Twins, or a guest of whom both poses are known.
bool can_compare(const SceneState& scene);
Comparison compare(const SceneState& scene);
// Into what an earlier picture has left, so that nothing is allocated for the same guests.
void compare(const SceneState& scene, Comparison& comparison);
// For a picture without halves: dancers as the routes show them, once each.
void leave_out_twins(SceneState& scene);

}  // namespace dance
