// The rules by which a dancer is told what to mend before the camera: one table, each with what it
// measures, and where it begins and ends to be said.
//
// Units/frames: as formats/camera_view/camera_view.h.
// Ownership:    constants.
// Threads:      any; pure.
// Failure:      a measure that means nothing, as of feet where nobody is seen, is none.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "formats/camera_view/body_in_frame.h"
#include "formats/camera_view/camera_view.h"
#include "viewer/words/texts.h"

namespace dance {

struct CameraSight {
  CameraFacts facts;
  BodyInFrame body;
  bool has_network = false;
};

struct CameraRule {
  Text text;
  std::optional<float> (*measure)(const CameraSight& sight);
  // Said once the measure has reached `begins`, until it is back at `ends`; above where begins is
  // the larger of the two, below where it is the smaller.
  float begins;
  float ends;
};

constexpr std::size_t kCameraRules = 14;
// What matters more comes first.
std::span<const CameraRule, kCameraRules> camera_rules();

}  // namespace dance
