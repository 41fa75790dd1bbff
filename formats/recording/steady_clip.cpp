#include "formats/recording/steady_clip.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/pose/interpolate.h"

namespace dance {
namespace {

// Times of poses on the same grid are rounded: the last pose of a take still fills its frame.
constexpr Duration kRounding = Duration::us(1);

Hands between(const Hands& a, const Hands& b, MonoTime t) {
  const Duration step = b.capture_time - a.capture_time;
  if (step <= Duration()) return b;  // of two clocks
  const auto fraction = static_cast<float>(
      std::clamp((t - a.capture_time).as_seconds() / step.as_seconds(), 0.0, 1.0));
  return interpolate(a, b, fraction);
}

}  // namespace

SteadyClip::SteadyClip(double hz, std::size_t most_frames) : most_frames_(most_frames) {
  DANCE_ASSERT(hz > 0.0, hz);
  clip_.frame_hz = hz;
  clip_.skeleton = average_skeleton();
}

void SteadyClip::set_skeleton(const Skeleton& skeleton) {
  clip_.skeleton = skeleton;
  has_skeleton_ = true;
}

void SteadyClip::begin_grid(const Pose& pose) {
  // Hands that came just before their pose are of the new stretch.
  std::size_t first_hands = hands_.size();
  while (first_hands > 0 && hands_[first_hands - 1].clock_id == pose.clock_id &&
         hands_[first_hands - 1].capture_time <= pose.capture_time &&
         pose.capture_time - hands_[first_hands - 1].capture_time <= kLongestGap)
    --first_hands;
  if (!stretches_.empty()) first_hands = std::max(first_hands, stretches_.back().first_hands);
  stretches_.push_back({clip_.frames.size(), first_hands});
  grid_start_ = pose.capture_time;
  grid_index_ = 1;
  add_frame(pose);
}

void SteadyClip::add_frame(const Pose& pose) {
  if (clip_.frames.size() < most_frames_)
    clip_.frames.push_back(pose);
  else
    ++counters_.beyond_bound;
}

void SteadyClip::add(const Pose& pose) {
  if (!previous_) {
    begin_grid(pose);
  } else if (pose.clock_id != previous_->clock_id ||
             pose.capture_time - previous_->capture_time > kLongestGap) {
    // Another clock, or a long silence: the pause is cut out.
    ++counters_.gaps;
    begin_grid(pose);
  } else if (pose.capture_time <= previous_->capture_time) {
    ++counters_.not_newer;
    return;
  } else {
    // Frame k stands at start + k/hz, between the pose before it and this one.
    const double step_s = (pose.capture_time - previous_->capture_time).as_seconds();
    for (;; ++grid_index_) {
      const MonoTime t =
          grid_start_ + Duration::seconds(static_cast<double>(grid_index_) / clip_.frame_hz);
      if (t > pose.capture_time + kRounding) break;
      const double fraction = std::min(1.0, (t - previous_->capture_time).as_seconds() / step_s);
      add_frame(interpolate(*previous_, pose, static_cast<float>(fraction)));
    }
  }
  previous_ = pose;
}

void SteadyClip::add(const Hands& hands) {
  if (hands_.size() >= most_frames_) {
    ++counters_.beyond_bound;
    return;
  }
  const bool is_same_clock = !hands_.empty() && hands_.back().clock_id == hands.clock_id;
  if (is_same_clock && hands.capture_time <= hands_.back().capture_time) {
    ++counters_.not_newer;
    return;
  }
  hands_.push_back(hands);
}

MotionClip SteadyClip::with_hands() const {
  MotionClip clip = clip_;
  if (hands_.empty()) return clip;
  clip.hands.reserve(clip.frames.size());
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    const bool is_last = s + 1 == stretches_.size();
    const std::size_t end_frame = is_last ? clip.frames.size() : stretches_[s + 1].first_frame;
    const std::size_t end_hands = is_last ? hands_.size() : stretches_[s + 1].first_hands;
    std::size_t next = stretches_[s].first_hands;
    for (std::size_t f = stretches_[s].first_frame; f < end_frame; ++f) {
      const MonoTime t = clip.frames[f].capture_time;
      while (next < end_hands && hands_[next].capture_time < t) ++next;
      const bool has_before = next > stretches_[s].first_hands;
      const bool has_after = next < end_hands;
      if (has_before && has_after)
        clip.hands.push_back(between(hands_[next - 1], hands_[next], t));
      else if (has_before || has_after)
        clip.hands.push_back(hands_[has_after ? next : next - 1]);
      else  // a stretch without hands: as they were
        clip.hands.push_back(clip.hands.empty() ? hands_.front() : clip.hands.back());
    }
  }
  return clip;
}

}  // namespace dance
