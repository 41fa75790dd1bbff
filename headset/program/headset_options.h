// What `dance headset` is told.
//
// Units/frames: metres, degrees, Hz.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      parse_spot() names what is wrong.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "headset/capture/headset_capture.h"

namespace dance {

struct HeadsetOptions {
  HeadsetCaptureOptions capture;
  bool tracking_only = false;
  bool is_mirrored = true;  // a window on the desk shows it
  float scale = 1.0f;       // of the pictures, times what the headset recommends
  float personal_space_m = 0.25f;
  float floor_m = 8.0f;
  bool tags = true;
  std::string place = "plain";  // like dance view --place; a stage without walls is calmer
  // Plainly: without antialiasing and mirror images, as where there is no graphics card.
  enum class Quality : std::uint8_t { kAuto, kLow, kHigh };
  Quality quality = Quality::kAuto;
  std::string language;  // "" = the system's
  std::vector<std::string> avatars;
  double seconds = 0.0;  // 0 = until told to stop
};

// "X,Z" or "X,Z,HEADING": metres, and degrees to the left of +Z.
Result<XrSpot> parse_spot(const std::string& text);

}  // namespace dance
