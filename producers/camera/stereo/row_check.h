// Whether a rig's calibration fits what its cameras see: the same thing must lie in the same row of
// both, and farther left in the right one. Detects a wrong file, a bent rig and a maker's other
// convention of signs.
//
// Units/frames: rectified pixels (producers/camera/stereo/rectified_pair.h).
// Ownership:    plain values; allocates while it works.
// Threads:      none inside. Takes tenths of a second: for the start and for the doctor, not for
//               each frame.
// Failure:      a picture without texture gives few points; the rest is then meaningless
//               (kFewestRowPoints).
#pragma once

#include <opencv2/core/mat.hpp>

#include "producers/camera/stereo/stereo_rig.h"

namespace dance {

struct RowCheck {
  int points = 0;            // found again by both cameras
  double offset_px = 0.0;    // median: how far below its row the right camera sees them
  double residual_px = 0.0;  // median of what they are off, either way
};
constexpr int kFewestRowPoints = 20;
constexpr double kGoodRows_px = 0.7;

RowCheck check_rows(const cv::Mat& left, const cv::Mat& right, const StereoRig& rig);

// Makers write rotation and translation one way or the other. The reading of this rig whose rows
// fit best: itself, unless another fits clearly better.
enum class RigReading { kAsWritten, kTranslationOther, kRotationOther, kBothOther };
const char* text_of(RigReading reading);
StereoRig read_otherwise(const StereoRig& rig, RigReading reading);

struct SettledRig {
  StereoRig rig;
  RigReading reading = RigReading::kAsWritten;
  RowCheck rows;         // as it is read now
  bool is_sure = false;  // enough points, and they lie in their rows
};
SettledRig settle_signs(const cv::Mat& left, const cv::Mat& right, const StereoRig& rig);

}  // namespace dance
