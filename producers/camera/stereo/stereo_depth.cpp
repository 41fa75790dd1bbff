#include "producers/camera/stereo/stereo_depth.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/base/assert.h"

namespace dance {
namespace {

// Sizes of dancers over what the network takes them for: from a child to a tall man while unknown,
// and what a frame may differ by once known.
constexpr double kSmallest = 0.5;
constexpr double kTallest = 1.6;
constexpr double kKnownWithin = 0.2;
constexpr double kScaleFollows = 0.1;
// So many frames without a depth, and the dancer's size is looked for again.
constexpr int kMissesToForget = 10;

// Of the patches' weights, in a vote for the right distance.
constexpr double kLeastAgreement = 0.3;
constexpr int kVoteGap_px = 3;
// A second distance with this part of the votes makes the first doubtful.
constexpr double kRivalVotes = 0.9;

constexpr int kRefineWithin_px = 3;
constexpr float kLeastScore = 0.7f;
constexpr float kRivalScore = 0.05f;
constexpr int kBackWithin_px = 4;
// Of a sub-pixel match, on real and on rendered pictures.
constexpr double kMatchSpread_px = 0.3;

constexpr std::size_t kRowLooksPerFrame = 2;
constexpr std::uint64_t kRowLooksToJudge = 100;

void add_to(cv::Rect& box, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(std::clamp(p.x(), -1e6, 1e6)));
  const int y = static_cast<int>(std::floor(std::clamp(p.y(), -1e6, 1e6)));
  const cv::Rect one(x - 2, y - 2, 5, 5);
  box = box.empty() ? one : (box | one);
}

bool is_of_rig(const cv::Mat& picture, cv::Size size) {
  return picture.size() == size && (picture.type() == CV_8UC3 || picture.type() == CV_8UC1);
}

void to_grey(const cv::Mat& from, const cv::Rect& box, cv::Mat& grey) {
  if (box.empty()) return;
  cv::Mat part = grey(box);
  if (from.channels() == 1)
    from(box).copyTo(part);
  else
    cv::cvtColor(from(box), part, cv::COLOR_BGR2GRAY);
}

}  // namespace

StereoDepth::StereoDepth(const StereoRig& rig)
    : pair_(rig),
      depth_axis_(pair_.depth_axis_in_left().transpose()),
      left_grey_(rig.left.height_px, rig.left.width_px, CV_8UC1, cv::Scalar(0)),
      right_grey_(rig.left.height_px, rig.left.width_px, CV_8UC1, cv::Scalar(0)),
      curves_(kMostBodySamples) {}

float StereoDepth::Curve::at(double disparity_px) const {
  const double place = most_px - disparity_px;
  if (!(place >= 0.0) || place >= count - 1) return 0.0f;
  const auto i = static_cast<std::size_t>(place);
  const float part = static_cast<float>(place - static_cast<double>(i));
  return std::max(0.0f, scores[i]) * (1.0f - part) + std::max(0.0f, scores[i + 1]) * part;
}

// Skin at depth D = Z + s·(z − skin) along the sample's ray; X's depth of that is D · (axis · ray).
double StereoDepth::disparity_of(const BodySample& sample, double hips_m, double scale) const {
  const double depth_m = hips_m + scale * (sample.p_m.z() - sample.skin_m);
  const double along = depth_axis_.dot(sample.straight.homogeneous());
  return pair_.f_px() * pair_.baseline_m() / std::max(0.05, depth_m * along);
}

bool StereoDepth::find_ranges(const MonocularFit& one_eye) {
  const double low = scale_ > 0.0 ? scale_ * (1.0 - kKnownWithin) : kSmallest;
  const double high = scale_ > 0.0 ? scale_ * (1.0 + kKnownWithin) : kTallest;
  hips_range_ = {low * one_eye.p_CH_m.z(), high * one_eye.p_CH_m.z()};
  left_valid_ = right_valid_ = cv::Rect();
  const cv::Rect picture(0, 0, left_grey_.cols, left_grey_.rows);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const BodySample& sample = samples_[i];
    rectified_[i] = pair_.rectified(Side::kLeft, sample.raw_px);
    const int most =
        static_cast<int>(std::ceil(disparity_of(sample, hips_range_.nearest_m, low))) + 2;
    const int least =
        std::max(0, static_cast<int>(disparity_of(sample, hips_range_.farthest_m, high)) - 2);
    Curve& curve = curves_[i];
    curve.most_px = most;
    curve.count = std::min(most - least + 1, kMostStripColumns - kPatchSide_px);
    for (int side : {-1, 1}) {
      const double v = rectified_[i].y() + side * (kPatchRadius_px + 4);
      const double u = rectified_[i].x();
      for (double aside : {-1.0, 1.0})
        add_to(left_valid_, pair_.raw(Side::kLeft, {u + aside * (2.0 * kPatchRadius_px + 8), v}));
      add_to(right_valid_, pair_.raw(Side::kRight, {u - most - kPatchRadius_px - 2, v}));
      add_to(right_valid_,
             pair_.raw(Side::kRight, {u - most + curve.count + kPatchRadius_px + 10, v}));
    }
  }
  left_valid_ &= picture;
  right_valid_ &= picture;
  return !left_valid_.empty() && !right_valid_.empty();
}

void StereoDepth::make_grey(const cv::Mat& left, const cv::Mat& right) {
  to_grey(left, left_valid_, left_grey_);
  to_grey(right, right_valid_, right_grey_);
}

void StereoDepth::search(std::size_t i) {
  Curve& curve = curves_[i];
  const double u = rectified_[i].x();
  const double v = rectified_[i].y();
  std::fill_n(curve.scores.begin(), curve.count, kNoScore);
  left_strip_.sample(left_grey_, left_valid_, pair_, Side::kLeft, u - kPatchRadius_px, v,
                     kPatchSide_px);
  SampleMatch& match = matches_[i];
  if (!patch_.take(left_strip_, 0)) {
    match.how = left_strip_.is_inside(0) ? SampleMatch::How::kFlat : SampleMatch::How::kOutside;
    return;
  }
  match.how = SampleMatch::How::kPoor;
  strip_.sample(right_grey_, right_valid_, pair_, Side::kRight, u - curve.most_px - kPatchRadius_px,
                v, curve.count + kPatchSide_px - 1);
  patch_.scores_along(strip_, curve.scores);
}

// One unknown, the hips' distance, in steps of half a pixel: how well all patches fit where it puts
// them.
bool StereoDepth::agree(const MonocularFit& one_eye, double& hips_m) const {
  const double fb = pair_.f_px() * pair_.baseline_m();
  const double first = fb / hips_range_.farthest_m;
  const double last = fb / hips_range_.nearest_m;
  const auto votes_at = [&](double disparity_px) {
    const double z = fb / disparity_px;
    double votes = 0.0;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      votes +=
          samples_[i].weight * curves_[i].at(disparity_of(samples_[i], z, z / one_eye.p_CH_m.z()));
    return votes;
  };
  double best = 0.0;
  double best_px = first;
  for (double d = first; d <= last; d += 0.5) {
    const double votes = votes_at(d);
    if (votes > best) {
      best = votes;
      best_px = d;
    }
  }
  double total = 0.0;
  for (std::size_t i = 0; i < samples_.size(); ++i)
    if (matches_[i].how == SampleMatch::How::kPoor) total += samples_[i].weight;
  if (total <= 0.0 || best < kLeastAgreement * total) return false;
  double rival = 0.0;
  for (double d = first; d <= last; d += 0.5)
    if (std::abs(d - best_px) > kVoteGap_px) rival = std::max(rival, votes_at(d));
  hips_m = fb / best_px;
  return rival < kRivalVotes * best;
}

void StereoDepth::refine(std::size_t i, double expected_px) {
  SampleMatch& match = matches_[i];
  if (match.how != SampleMatch::How::kPoor) return;
  const Curve& curve = curves_[i];
  const int middle = curve.most_px - static_cast<int>(std::lround(expected_px));
  const int from = std::max(1, middle - kRefineWithin_px);
  const int to = std::min(curve.count - 2, middle + kRefineWithin_px);
  int best = -1;
  const auto score = [&](int place) { return curve.scores[static_cast<std::size_t>(place)]; };
  const auto is_peak = [&](int place) {
    return score(place) >= score(place - 1) && score(place) > score(place + 1);
  };
  for (int place = from; place <= to; ++place)
    if (is_peak(place) && (best < 0 || score(place) > score(best))) best = place;
  if (best < 0 || score(best) < kLeastScore || score(best - 1) <= kNoScore ||
      score(best + 1) <= kNoScore)
    return;
  match.score = score(best);
  for (int place = from; place <= to; ++place)
    if (place != best && is_peak(place) && score(place) > score(best) - kRivalScore) {
      match.how = SampleMatch::How::kAmbiguous;
      return;
    }
  match.disparity_px =
      curve.most_px - (best + peak_offset(score(best - 1), score(best), score(best + 1)));
  // Consistency check: the right patch has to match the left one it came from.
  const double u = rectified_[i].x();
  const double v = rectified_[i].y();
  match.how = SampleMatch::How::kOneSided;
  strip_.sample(right_grey_, right_valid_, pair_, Side::kRight,
                u - match.disparity_px - kPatchRadius_px, v, kPatchSide_px);
  left_strip_.sample(left_grey_, left_valid_, pair_, Side::kLeft,
                     u - kBackWithin_px - kPatchRadius_px, v, kPatchSide_px + 2 * kBackWithin_px);
  if (!patch_.take(strip_, 0)) return;
  patch_.scores_along(left_strip_, back_scores_);
  const auto* top =
      std::max_element(back_scores_.begin(), back_scores_.begin() + 2 * kBackWithin_px + 1);
  if (std::abs(top - back_scores_.begin() - kBackWithin_px) <= 1)
    match.how = SampleMatch::How::kMatched;
}

DepthHint StereoDepth::hint(const cv::Mat& left, const cv::Mat& right, const BodyLandmarks& body) {
  matches_.clear();
  samples_.clear();
  if (!body.found) return {};
  ++counters_.asked;
  // A camera that comes back may come back with another size.
  if (!is_of_rig(left, left_grey_.size()) || !is_of_rig(right, left_grey_.size())) {
    ++counters_.other_size;
    return {};
  }
  if (body.is_new || ++misses_ > kMissesToForget) scale_ = 0.0;
  take_body_samples(pair_.rig().left, body, samples_);
  const auto one_eye = fit_monocular(samples_);
  if (!one_eye || !find_ranges(*one_eye)) {
    ++counters_.too_few_points;
    return {};
  }
  make_grey(left, right);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const bool has_room = matches_.try_push({i});
    DANCE_ASSERT(has_room);
    search(i);
  }
  double hips_m = 0.0;
  if (!agree(*one_eye, hips_m)) {
    ++counters_.disagreed;
    return {};
  }
  FixedList<SampleDepth, kMostBodySamples> depths;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    refine(i, disparity_of(samples_[i], hips_m, hips_m / one_eye->p_CH_m.z()));
    const SampleMatch& match = matches_[i];
    if (match.how != SampleMatch::How::kMatched) continue;
    const double depth_m = pair_.p_L_m(rectified_[i], match.disparity_px).z();
    const bool has_room =
        depths.try_push({i, depth_m, depth_m / match.disparity_px * kMatchSpread_px});
    DANCE_ASSERT(has_room);
  }
  const auto found = fit_depth(samples_, {depths.begin(), depths.end()}, *one_eye,
                               pair_.f_px() * pair_.baseline_m());
  if (!found) {
    ++counters_.too_few;
    return {};
  }
  ++counters_.hinted;
  misses_ = 0;
  scale_ = scale_ > 0.0 ? scale_ + kScaleFollows * (found->scale - scale_) : found->scale;
  for (std::size_t n = 0; n < kRowLooksPerFrame && !samples_.empty(); ++n)
    look_at_rows(next_row_look_++ % samples_.size());
  return *found;
}

// How well the matched patch fits in the rows above and below: the top of that is where the right
// camera really has it.
void StereoDepth::look_at_rows(std::size_t i) {
  constexpr int kReach_px = 3;
  const SampleMatch& match = matches_[i];
  if (match.how != SampleMatch::How::kMatched) return;
  const double u = rectified_[i].x();
  const double v = rectified_[i].y();
  left_strip_.sample(left_grey_, left_valid_, pair_, Side::kLeft, u - kPatchRadius_px, v,
                     kPatchSide_px);
  if (!patch_.take(left_strip_, 0)) return;
  std::array<float, 2 * kReach_px + 1> scores;
  for (int row = -kReach_px; row <= kReach_px; ++row) {
    strip_.sample(right_grey_, right_valid_, pair_, Side::kRight,
                  u - match.disparity_px - kPatchRadius_px, v + row, kPatchSide_px);
    patch_.scores_along(strip_, back_scores_);
    scores[static_cast<std::size_t>(row + kReach_px)] = back_scores_[0];
  }
  const auto top =
      static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  if (top == 0 || top + 1 == scores.size()) return;
  const double offset_px = static_cast<double>(top) - kReach_px +
                           peak_offset(scores[top - 1], scores[top], scores[top + 1]);
  ++row_looks_;
  row_offset_px_ += (offset_px - row_offset_px_) /
                    std::min<double>(static_cast<double>(row_looks_), kRowLooksToJudge);
}

std::string StereoDepth::trouble() const {
  constexpr double kBadRows_px = 1.5;
  if (row_looks_ >= kRowLooksToJudge && std::abs(row_offset_px_) > kBadRows_px)
    return fmt::format(
        "the right camera sees everything {:.1f} rows {} where its calibration puts it: "
        "the rig was bent or the file is another's; calibrate with dance capture "
        "--calibrate",
        std::abs(row_offset_px_), row_offset_px_ > 0.0 ? "below" : "above");
  if (counters_.other_size > 0)
    return fmt::format(
        "the calibration is for pictures of {} x {} a camera, and others come: choose "
        "that size with --size",
        left_grey_.cols, left_grey_.rows);
  if (counters_.asked >= 200 && counters_.hinted * 10 < counters_.asked)
    return "the two pictures hardly match: are left and right swapped, a lens covered, or "
           "the "
           "calibration of another camera? dance capture --calibrate makes a new one";
  return {};
}

}  // namespace dance
