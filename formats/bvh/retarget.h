// Retargeting: maps the motion of a capture file's figure onto the canonical skeleton with that
// dancer's bone lengths, so that every joint is where the file has it.
//
// Units/frames: from the file's units and axes to metres in W. Units are inferred from the figure's
//               height and the up axis from its stance; both are reported in `notes`. Places on the
//               floor stay as in the file, so that couples stay together.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      retarget() of a figure that is not human, or without motion, names what is wrong.
// Source:       R_WB(t) = R_WF · R_FJ(t) · R_FJ(ref)⁻¹ · R_WF⁻¹ · C_B, where C_B turns the
//               canonical T-pose's bone into the file's reference pose
//               (formats/bvh/rig/rig_reference.h).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pose/clip.h"
#include "formats/bvh/bvh.h"
#include "formats/bvh/rig/rig.h"

namespace dance {

enum class UpAxis : std::uint8_t { kGuess, kY, kZ };

struct RetargetOptions {
  std::optional<double> metres_per_unit;  // none: inferred
  std::optional<double> frame_hz;         // none: the file's
  UpAxis up = UpAxis::kGuess;
  bool puts_feet_on_floor = true;  // else heights stay as in the file
};

struct Retargeted {
  MotionClip clip;
  Rig rig;
  double metres_per_unit = 1.0;
  std::vector<std::string> notes;  // assumptions and oddities, one line each
};

Result<Retargeted> retarget(const Bvh& bvh, const RetargetOptions& options = {});

}  // namespace dance
