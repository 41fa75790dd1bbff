// StereoDepth: a dancer's distance from two cameras: patches around the landmarks in the left
// picture are matched in the right one. All patches vote together for one distance of the hips,
// then each is matched near it, and the hint is a robust mean.
//
// Units/frames: landmarks in pixels of the raw left picture; pictures blue green red, or grey, of
//               the rig's size; the hint as producers/camera/depth_hint.h.
// Ownership:    buffers inside, of the rig's size; nothing is allocated after the first call.
//               Pictures are read during the call.
// Threads:      none inside; one owner.
// Failure:      hint().joints is 0 where too few patches match; counted. trouble() reports when the
//               rig is the cause.
// Source:       zero-mean normalised cross-correlation; consensus as a plane sweep over the one
//               unknown.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "producers/camera/stereo/depth_fit.h"
#include "producers/camera/stereo/row_strip.h"

namespace dance {

struct StereoDepthCounters {
  std::uint64_t asked = 0;           // with a dancer
  std::uint64_t hinted = 0;          // got a depth
  std::uint64_t too_few_points = 0;  // too few points to start the search
  std::uint64_t disagreed = 0;       // no distance that the patches agree on
  std::uint64_t other_size = 0;      // pictures that are not the rig's
  std::uint64_t too_few = 0;         // agreed on, but too few matched well
};

// What became of one sample.
struct SampleMatch {
  enum class How { kMatched, kOutside, kFlat, kPoor, kAmbiguous, kOneSided };
  std::size_t sample = 0;
  How how = How::kOutside;
  double disparity_px = 0.0;
  float score = kNoScore;
};

class StereoDepth {
 public:
  explicit StereoDepth(const StereoRig& rig);

  DepthHint hint(const cv::Mat& left, const cv::Mat& right, const BodyLandmarks& body);

  const StereoDepthCounters& counters() const { return counters_; }
  // Of the last call.
  std::span<const SampleMatch> matches() const { return {matches_.begin(), matches_.end()}; }
  const BodySamples& samples() const { return samples_; }
  // By how much the right camera's rows lie below the left one's where they should be the same: a
  // good calibration is within one.
  double row_offset_px() const { return row_offset_px_; }
  // "" as long as all is well, else one line with the cure, once there is enough to judge by.
  std::string trouble() const;

 private:
  struct Range {
    double nearest_m;
    double farthest_m;
  };
  struct Curve {
    int most_px = 0;  // disparity of scores[0]
    int count = 0;
    std::array<float, kMostStripColumns> scores;
    float at(double disparity_px) const;
  };

  bool find_ranges(const MonocularFit& one_eye);
  void make_grey(const cv::Mat& left, const cv::Mat& right);
  void search(std::size_t i);
  bool agree(const MonocularFit& one_eye, double& hips_m) const;
  void refine(std::size_t i, double expected_px);
  void look_at_rows(std::size_t i);
  double disparity_of(const BodySample& sample, double hips_m, double scale) const;

  RectifiedPair pair_;
  Eigen::RowVector3d depth_axis_;  // X's z in L
  cv::Mat left_grey_;
  cv::Mat right_grey_;
  cv::Rect left_valid_;
  cv::Rect right_valid_;
  BodySamples samples_;
  Range hips_range_{};
  std::vector<Curve> curves_;
  std::array<Eigen::Vector2d, kMostBodySamples> rectified_;
  FixedList<SampleMatch, kMostBodySamples> matches_;
  RowStrip strip_;
  RowStrip left_strip_;
  Patch patch_;
  std::array<float, kMostStripColumns> back_scores_;

  double scale_ = 0.0;  // of this dancer; 0 while it is not known
  int misses_ = 0;
  std::size_t next_row_look_ = 0;
  double row_offset_px_ = 0.0;
  std::uint64_t row_looks_ = 0;
  StereoDepthCounters counters_;
};

}  // namespace dance
