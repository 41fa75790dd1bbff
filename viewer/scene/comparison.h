// Comparison: one stage twice, as its remote dancers' poses came and as its routes show them, for a
// picture with two halves.
//
// Units/frames: as viewer/scene/scene.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      without a twin (core/base/raw_twin.h) beside its dancer there is nothing to
//               compare.
#pragma once

#include "viewer/scene/scene.h"

namespace dance {

struct Comparison {
  SceneState raw;    // twins in the places, clothes and names of their dancers
  SceneState shown;  // without twins
};

bool has_twins(const SceneState& scene);
Comparison compare(const SceneState& scene);
// For a picture without halves: dancers as the routes show them, once each.
void leave_out_twins(SceneState& scene);

}  // namespace dance
