#include "producers/camera/stereo/row_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/base/median.h"
#include "producers/camera/stereo/row_strip.h"

namespace dance {
namespace {

constexpr int kMostPoints = 120;
constexpr int kRowReach_px = 24;
constexpr float kSureScore = 0.9f;
// Things nearer than this are not looked for.
constexpr double kNearest_m = 0.8;

cv::Mat grey_of(const cv::Mat& picture) {
  if (picture.channels() == 1) return picture;
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

// The row, relative to its own, in which the right camera has the patch; false where it has it in
// none for sure.
class RowFinder {
 public:
  RowFinder(const cv::Mat& left, const cv::Mat& right, const StereoRig& rig)
      : left_(left),
        right_(right),
        pair_(rig),
        all_(0, 0, left.cols, left.rows),
        scores_(kMostStripColumns) {
    const double most = pair_.f_px() * pair_.baseline_m() / kNearest_m;
    most_px_ = std::clamp(static_cast<int>(most), 16, kMostStripColumns - kPatchSide_px - 1);
  }

  bool find(const cv::Point2f& corner, double& offset_px) {
    const Eigen::Vector2d at = pair_.rectified(Side::kLeft, {corner.x, corner.y});
    strip_.sample(left_, all_, pair_, Side::kLeft, at.x() - kPatchRadius_px, at.y(), kPatchSide_px);
    if (!patch_.take(strip_, 0)) return false;
    std::array<float, 2 * kRowReach_px + 1> best;
    for (int row = -kRowReach_px; row <= kRowReach_px; ++row)
      best[static_cast<std::size_t>(row + kRowReach_px)] = best_in_row(at, row);
    const auto top =
        static_cast<std::size_t>(std::max_element(best.begin(), best.end()) - best.begin());
    if (best[top] < kSureScore || top == 0 || top + 1 == best.size()) return false;
    offset_px = static_cast<double>(top) - kRowReach_px +
                peak_offset(best[top - 1], best[top], best[top + 1]);
    return true;
  }

 private:
  float best_in_row(const Eigen::Vector2d& at, int row) {
    strip_.sample(right_, all_, pair_, Side::kRight, at.x() - most_px_ - kPatchRadius_px,
                  at.y() + row, most_px_ + kPatchSide_px);
    patch_.scores_along(strip_, scores_);
    return *std::max_element(scores_.begin(), scores_.begin() + most_px_ + 1);
  }

  const cv::Mat& left_;
  const cv::Mat& right_;
  RectifiedPair pair_;
  cv::Rect all_;
  RowStrip strip_;
  Patch patch_;
  std::vector<float> scores_;
  int most_px_;
};

}  // namespace

RowCheck check_rows(const cv::Mat& left, const cv::Mat& right, const StereoRig& rig) {
  const cv::Mat left_grey = grey_of(left);
  const cv::Mat right_grey = grey_of(right);
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(left_grey, corners, kMostPoints, 0.02, left_grey.cols / 24.0);
  RowFinder finder(left_grey, right_grey, rig);
  std::vector<double> offsets;
  for (const cv::Point2f& corner : corners) {
    double offset_px = 0.0;
    if (finder.find(corner, offset_px)) offsets.push_back(offset_px);
  }
  RowCheck out;
  out.points = static_cast<int>(offsets.size());
  out.offset_px = median_of<double>(offsets);
  for (double& offset : offsets) offset = std::abs(offset);
  out.residual_px = median_of<double>(offsets);
  return out;
}

const char* text_of(RigReading reading) {
  switch (reading) {
    case RigReading::kAsWritten:
      return "as written";
    case RigReading::kTranslationOther:
      return "with TY and TZ of the other sign";
    case RigReading::kRotationOther:
      return "with the rotation the other way round";
    case RigReading::kBothOther:
      return "with TY, TZ and the rotation the other way round";
  }
  return "";
}

StereoRig read_otherwise(const StereoRig& rig, RigReading reading) {
  StereoRig out = rig;
  if (reading == RigReading::kTranslationOther || reading == RigReading::kBothOther)
    out.p_RL_m.tail<2>() *= -1.0;
  if (reading == RigReading::kRotationOther || reading == RigReading::kBothOther)
    out.R_RL.transposeInPlace();
  return out;
}

SettledRig settle_signs(const cv::Mat& left, const cv::Mat& right, const StereoRig& rig) {
  SettledRig best{rig, RigReading::kAsWritten, check_rows(left, right, rig), false};
  // Another reading has to be better by more than chance, as the written one is the likely one.
  constexpr double kClearlyBetter = 0.6;
  if (best.rows.points < kFewestRowPoints || best.rows.residual_px > kGoodRows_px) {
    for (const RigReading reading :
         {RigReading::kTranslationOther, RigReading::kRotationOther, RigReading::kBothOther}) {
      const StereoRig other = read_otherwise(rig, reading);
      const RowCheck rows = check_rows(left, right, other);
      if (rows.points >= kFewestRowPoints && rows.points >= best.rows.points / 2 &&
          (best.rows.points < kFewestRowPoints ||
           rows.residual_px < kClearlyBetter * best.rows.residual_px))
        best = {other, reading, rows, false};
    }
  }
  best.is_sure = best.rows.points >= kFewestRowPoints && best.rows.residual_px <= kGoodRows_px;
  return best;
}

}  // namespace dance
