// The calibration file of a ZED stereo camera, SN<serial>.conf, read without its maker's software:
// an INI with the sections LEFT_CAM_<size>, RIGHT_CAM_<size> and STEREO, sizes 2K, FHD, HD, VGA
// (and FHD1200, SVGA of later models).
//
// Units/frames: millimetres, radians and pixels in the file. The right camera lies at (Baseline,
//               TY, TZ) of the left one's axes; RX, CV and RZ are a Rodrigues vector, of OpenCV's R
//               from left to right.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an Error names file, section and key, and the cure. Accepts text of any content up
//               to kMostZedIni_bytes.
// Source:       the layout as Stereolabs' open capture library reads it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "producers/camera/stereo/stereo_rig.h"

namespace dance {

constexpr std::size_t kMostZedIni_bytes = 64u << 10;

// True for text that has a section of a ZED's file: whether it is a good one, parse_zed_ini() says.
bool looks_like_zed_ini(std::string_view text);

// The rig at the given size of one camera's picture: the section of that size, else the nearest of
// the same shape, scaled. `name` stands in errors.
Result<StereoRig> parse_zed_ini(std::string_view text, const std::string& name, int width_px,
                                int height_px);

}  // namespace dance
