// Files of calibration: OpenCV's YAML or XML for one camera or two, and a ZED's own
// SN<serial>.conf.
//
// Units/frames: lengths in metres. Of one camera the keys are image_width, image_height,
//               camera_matrix and distortion_coefficients; of two image_width, image_height, M1,
//               D1, M2, D2, R and T, as OpenCV's own programs call them.
// Ownership:    plain values.
// Threads:      none inside; reads and writes files on the caller's thread.
// Failure:      an Error names the file, the key and the cure. A file is whole or not there: what
//               is saved is written beside it and then takes its name.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "producers/camera/stereo/stereo_rig.h"

namespace dance {

// For pictures of this size of one camera. The kind of file is detected by its content.
Result<Calibration> load_calibration(const std::string& path, int width_px, int height_px);

// What is in OpenCV's text, at the size that it was made with.
Result<Calibration> parse_opencv_calibration(std::string_view text, const std::string& name);

// rms_px is the reprojection error, kept in the file for its readers.
Result<void> save_calibration(const std::string& path, const Calibration& calibration,
                              double rms_px);

}  // namespace dance
