#include "producers/camera/stereo/row_strip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "producers/camera/lens.h"
#include "testing/camera/drawn_rig.h"
#include "testing/camera/stereo_dancer.h"
#include "tests/producers/camera/files/written_pictures.h"
#include "tests/producers/camera/stereo/opencv_doc.h"

namespace dance {
namespace {

TEST(Lens, UndistortingUndoesDistorting) {
  const StereoRig rig = drawn_rig();
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d straight(random.uniform(-0.9, 0.9), random.uniform(-0.5, 0.5));
    EXPECT_LT((undistorted(rig.left, pixel_of(rig.left, straight)) - straight).norm(), 1e-6);
  }
}

TEST(RectifiedPair, APointLiesInTheSameRowOfBothEyes) {
  const StereoRig rig = drawn_rig();
  const RectifiedPair pair(rig);
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p_L(random.uniform(-1.5, 1.5), random.uniform(-1.0, 1.0),
                              random.uniform(2.0, 6.0));
    const Eigen::Vector3d p_R = rig.R_RL * p_L + rig.p_RL_m;
    const Eigen::Vector2d left =
        pair.rectified(Side::kLeft, pixel_of(rig.left, p_L.head<2>() / p_L.z()));
    const Eigen::Vector2d right =
        pair.rectified(Side::kRight, pixel_of(rig.right, p_R.head<2>() / p_R.z()));
    EXPECT_NEAR(left.y(), right.y(), 1e-4);
    EXPECT_GT(left.x() - right.x(), 0.0);
    EXPECT_LT((pair.p_L_m(left, left.x() - right.x()) - p_L).norm(), 1e-4);
    // And back to the raw picture.
    EXPECT_LT((pair.rectified(Side::kLeft, pair.raw(Side::kLeft, left)) - left).norm(), 1e-4);
  }
}

// Pictures that are in rows already: pixels of X are pixels.
StereoRig straight_rig(cv::Size size) {
  StereoRig rig;
  rig.left = {size.width,       size.height,       1000.0, 1000.0,
              0.5 * size.width, 0.5 * size.height, {},     true};
  rig.right = rig.left;
  rig.p_RL_m = {-0.1, 0.0, 0.0};
  return rig;
}

TEST(RowStrip, ShowsWhatThePictureHas) {
  cv::Mat grey(100, 200, CV_8UC1);
  for (int v = 0; v < grey.rows; ++v)
    for (int u = 0; u < grey.cols; ++u)
      grey.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(u + v / 2);
  const RectifiedPair pair(straight_rig(grey.size()));
  RowStrip strip;
  strip.sample(grey, {0, 0, 200, 100}, pair, Side::kLeft, 50.25, 40.0, 33);
  for (int c = 0; c < 33; ++c)
    EXPECT_NEAR(strip.row(kPatchRadius_px)[c], 50.25f + static_cast<float>(c) + 20.0f, 1e-3f);
  EXPECT_TRUE(strip.is_inside(0));
  EXPECT_TRUE(strip.is_inside(33 - kPatchSide_px));
  EXPECT_FALSE(strip.is_inside(34 - kPatchSide_px));
  strip.sample(grey, {0, 0, 200, 100}, pair, Side::kLeft, 180.0, 40.0, 60);
  EXPECT_FALSE(strip.is_inside(20));
  strip.sample(grey, {0, 0, 200, 100}, pair, Side::kLeft, 50.0, 97.0, 33);
  EXPECT_FALSE(strip.is_inside(0));
}

TEST(RowStrip, AFlatPatchIsNoPatch) {
  const cv::Mat grey(100, 200, CV_8UC1, cv::Scalar(120));
  const RectifiedPair pair(straight_rig(grey.size()));
  RowStrip strip;
  strip.sample(grey, {0, 0, 200, 100}, pair, Side::kLeft, 50.0, 40.0, kPatchSide_px);
  Patch patch;
  EXPECT_FALSE(patch.take(strip, 0));
}

TEST(RowStrip, BrightnessAndContrastOfTheOtherEyeDoNotMatter) {
  cv::Mat left(100, 400, CV_8UC1);
  cv::Mat right(100, 400, CV_8UC1);
  for (int v = 0; v < 100; ++v)
    for (int u = 0; u < 400; ++u) {
      const double x = 100.0 + 30.0 * pattern_at({0.01 * u, 0.01 * v, 0.0}, 0.05, 1);
      const double shifted = 100.0 + 30.0 * pattern_at({0.01 * (u + 31.3), 0.01 * v, 0.0}, 0.05, 1);
      left.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(x);
      right.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(0.6 * shifted + 40.0);
    }
  const RectifiedPair pair(straight_rig(left.size()));
  RowStrip strip;
  strip.sample(left, {0, 0, 400, 100}, pair, Side::kLeft, 200.0, 50.0, kPatchSide_px);
  Patch patch;
  ASSERT_TRUE(patch.take(strip, 0));
  strip.sample(right, {0, 0, 400, 100}, pair, Side::kRight, 200.0 - 60.0, 50.0, 60 + kPatchSide_px);
  std::array<float, kMostStripColumns> scores;
  patch.scores_along(strip, scores);
  const auto top = static_cast<std::size_t>(std::max_element(scores.begin(), scores.begin() + 60) -
                                            scores.begin());
  const double disparity = 60.0 - (static_cast<double>(top) +
                                   peak_offset(scores[top - 1], scores[top], scores[top + 1]));
  EXPECT_NEAR(disparity, 31.3, 0.15);
  EXPECT_GT(scores[top], 0.97f);
}

TEST(RowStrip, AgreesWithTheTruthOfARealPair) {
  const std::string folder = opencv_doc_folder();
  if (folder.empty()) GTEST_SKIP() << kNoOpencvDoc;
  const cv::Mat left = grey_picture(folder + "/aloeL.jpg");
  const cv::Mat right = grey_picture(folder + "/aloeR.jpg");
  const cv::Mat truth = grey_picture(folder + "/aloeGT.png");
  ASSERT_FALSE(left.empty() || right.empty() || truth.empty());
  const RectifiedPair pair(straight_rig(left.size()));
  const cv::Rect all(0, 0, left.cols, left.rows);
  RowStrip in_left;
  RowStrip in_right;
  Patch patch;
  std::vector<float> scores(kMostStripColumns);
  constexpr int kMost_px = 255;
  std::vector<double> errors;
  int asked = 0;
  for (int v = 20; v < left.rows - 20; v += 17)
    for (int u = 300; u < left.cols - 20; u += 19) {
      const int known = truth.at<std::uint8_t>(v, u);
      if (known == 0) continue;
      ++asked;
      in_left.sample(left, all, pair, Side::kLeft, u - kPatchRadius_px, v, kPatchSide_px);
      if (!patch.take(in_left, 0)) continue;
      in_right.sample(right, all, pair, Side::kRight, u - kMost_px - kPatchRadius_px, v,
                      kMost_px + kPatchSide_px);
      patch.scores_along(in_right, scores);
      const auto top = static_cast<std::size_t>(
          std::max_element(scores.begin(), scores.begin() + kMost_px) - scores.begin());
      if (scores[top] < 0.7f || top == 0) continue;
      errors.push_back(std::abs(
          kMost_px -
          (static_cast<double>(top) + peak_offset(scores[top - 1], scores[top], scores[top + 1])) -
          known));
    }
  ASSERT_GT(asked, 1000);
  std::sort(errors.begin(), errors.end());
  const auto within = [&](double px) {
    return static_cast<double>(std::lower_bound(errors.begin(), errors.end(), px) -
                               errors.begin()) /
           static_cast<double>(errors.size());
  };
  std::printf(
      "[ measured ] %zu of %d patches matched: %.1f %% within 1 px, %.1f %% within 2 px, median "
      "%.2f px\n",
      errors.size(), asked, 100.0 * within(1.0), 100.0 * within(2.0), errors[errors.size() / 2]);
  EXPECT_GT(static_cast<double>(errors.size()), 0.7 * asked);
  EXPECT_GT(within(2.0), 0.8);
  // The truth itself is in whole pixels.
  EXPECT_LT(errors[errors.size() / 2], 0.6);
}

}  // namespace
}  // namespace dance
