#include "producers/camera/stereo/stereo_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

class SideBySide : public StereoSource {
 public:
  explicit SideBySide(std::unique_ptr<FrameSource> both)
      : both_(std::move(both)), format_(both_->format()) {
    format_.width_px /= 2;
  }

  FrameState next(Duration timeout, StereoFrame& out) override {
    Frame frame;
    const FrameState state = both_->next(timeout, frame);
    if (state != FrameState::kFrame) return state;
    out.left = out.right = frame;
    StereoViews views = split_side_by_side(frame.image);
    out.left.image = std::move(views.left);
    out.right.image = std::move(views.right);
    return state;
  }
  const FrameFormat& format() const override { return format_; }
  FrameCounters counters() const override { return both_->counters(); }
  const std::string& name() const override { return both_->name(); }

 private:
  std::unique_ptr<FrameSource> both_;
  FrameFormat format_;
};

// Where drivers report no rate; half its period still separates frames.
constexpr double kAssumedHz = 30.0;
// At 10 ms `dance capture stereo eval` finds depth half as exact as at 0.
constexpr double kGoodSkew_ms = 5.0;
constexpr std::uint64_t kPairsToJudge = 60;

class Paired : public StereoSource {
 public:
  Paired(std::unique_ptr<FrameSource> left, std::unique_ptr<FrameSource> right)
      : cameras_{std::move(left), std::move(right)}, format_(cameras_[0]->format()) {
    format_.hz = std::min(cameras_[0]->format().hz, cameras_[1]->format().hz);
    half_frame_ = Duration::seconds(0.5 / (format_.hz > 0.0 ? format_.hz : kAssumedHz));
    name_ = cameras_[0]->name() + " and " + cameras_[1]->name();
  }

  // Holds the newest of each side; while they are no pair the older is dropped and that side read
  // again. The left one is enough to dance: while the right one is unplugged its pictures go on
  // alone.
  FrameState next(Duration timeout, StereoFrame& out) override {
    const MonoTime deadline = mono_now() + timeout;
    if (is_right_gone_) look_for_right();
    for (int asked = 0; asked < kMostAsked; ++asked) {
      if (is_right_gone_ && has_[0]) return give_left(out);
      int older = -1;
      if (!has_[0] || !has_[1]) {
        older = has_[0] ? 1 : 0;
      } else {
        const Duration skew = held_[1].capture_time - held_[0].capture_time;
        if (skew <= half_frame_ && -skew <= half_frame_) return give(skew, out);
        older = skew > Duration() ? 0 : 1;
        has_[older] = false;
        ++unpaired_;
      }
      const Duration left_over = std::max(Duration(), deadline - mono_now());
      const FrameState state = cameras_[static_cast<std::size_t>(older)]->next(
          left_over, held_[static_cast<std::size_t>(older)]);
      if (state == FrameState::kFrame) {
        has_[older] = true;
        continue;
      }
      if (older == 1 && (state == FrameState::kGone || state == FrameState::kBack)) {
        is_right_gone_ = state == FrameState::kGone;
        continue;
      }
      if (state != FrameState::kNone) reset();
      return state;
    }
    return FrameState::kNone;
  }

  const FrameFormat& format() const override { return format_; }
  FrameCounters counters() const override {
    FrameCounters sum = cameras_[0]->counters();
    const FrameCounters& other = cameras_[1]->counters();
    sum.taken = pairs_ + alone_;
    sum.outrun += other.outrun;
    sum.lost += other.lost;
    sum.damaged += other.damaged;
    sum.unplugged += other.unplugged;
    return sum;
  }
  const std::string& name() const override { return name_; }
  std::uint64_t unpaired() const override { return unpaired_; }

  std::string trouble() const override {
    if (is_right_gone_)
      return fmt::format(
          "{} is gone: {} goes on alone, without depth; plug it in again, it is looked for",
          cameras_[1]->name(), cameras_[0]->name());
    if (pairs_ < kPairsToJudge || mean_skew_ms_ < kGoodSkew_ms) return {};
    return fmt::format(
        "{} take their pictures {:.1f} ms apart: a dancer who moves sideways seems nearer or "
        "farther by that; use a camera that delivers both views in one picture, or two that "
        "a wire triggers",
        name_, mean_skew_ms_);
  }

 private:
  // Bounds a call when two cameras of very different rates find no pair.
  static constexpr int kMostAsked = 16;

  FrameState give(Duration skew, StereoFrame& out) {
    out.left = held_[0];
    out.right = held_[1];
    out.left.fetched = out.right.fetched = std::max(held_[0].fetched, held_[1].fetched);
    has_[0] = has_[1] = false;
    ++pairs_;
    const double steps = static_cast<double>(std::min(pairs_, kPairsToJudge));
    mean_skew_ms_ += (std::abs(skew.as_ms()) - mean_skew_ms_) / steps;
    return FrameState::kFrame;
  }
  FrameState give_left(StereoFrame& out) {
    out.left = held_[0];
    out.right = Frame();
    has_[0] = false;
    ++alone_;
    ++unpaired_;
    return FrameState::kFrame;
  }
  // Does not wait: the left one's picture comes first.
  void look_for_right() {
    const FrameState state = cameras_[1]->next(Duration(), held_[1]);
    has_[1] = state == FrameState::kFrame;
    is_right_gone_ = !has_[1] && state != FrameState::kBack;
  }
  void reset() {
    for (int side = 0; side < 2; ++side) {
      if (has_[side]) ++unpaired_;
      has_[side] = false;
    }
  }

  std::array<std::unique_ptr<FrameSource>, 2> cameras_;
  FrameFormat format_;
  std::string name_;
  Duration half_frame_;
  std::array<Frame, 2> held_;
  bool has_[2] = {false, false};
  bool is_right_gone_ = false;
  std::uint64_t pairs_ = 0;
  std::uint64_t alone_ = 0;  // of the left side while the right one was gone
  std::uint64_t unpaired_ = 0;
  double mean_skew_ms_ = 0.0;
};

}  // namespace

StereoViews split_side_by_side(const cv::Mat& both) {
  const int half = both.cols / 2;
  return {both.colRange(0, half), both.colRange(half, 2 * half)};
}

Result<std::unique_ptr<StereoSource>> make_side_by_side(std::unique_ptr<FrameSource> both) {
  const FrameFormat& format = both->format();
  // Two pictures side by side are wider than any single one: 4:3 cameras make 8:3.
  if (format.width_px % 2 != 0 || format.width_px < 2 * format.height_px)
    return fail(
        fmt::format("{} gives {} x {}, which is no two pictures side by side; choose such a "
                    "size with --size (a ZED: 2560x720, 1344x376)",
                    both->name(), format.width_px, format.height_px));
  return std::make_unique<SideBySide>(std::move(both));
}

Result<std::unique_ptr<StereoSource>> make_paired(std::unique_ptr<FrameSource> left,
                                                  std::unique_ptr<FrameSource> right) {
  const FrameFormat& a = left->format();
  const FrameFormat& b = right->format();
  if (a.width_px != b.width_px || a.height_px != b.height_px)
    return fail(fmt::format("{} gives {} x {} and {} {} x {}; choose one size for both with --size",
                            left->name(), a.width_px, a.height_px, right->name(), b.width_px,
                            b.height_px));
  return std::make_unique<Paired>(std::move(left), std::move(right));
}

}  // namespace dance
