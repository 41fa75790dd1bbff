#include "producers/replay/clip_dancer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/assert.h"
#include "core/base/smooth_step.h"
#include "core/pose/interpolate.h"

namespace dance {

ClipDancer::ClipDancer(std::shared_ptr<const MotionClip> clip, const ClipDancerOptions& options)
    : clip_(std::move(clip)), options_(options) {
  DANCE_ASSERT(clip_ && !clip_->frames.empty());
  DANCE_ASSERT(options_.speed > 0.0 && std::isfinite(options_.speed), options_.speed);
  DANCE_ASSERT(clip_->hands.empty() || clip_->hands.size() == clip_->frames.size());
  last_ = Duration::seconds(static_cast<double>(clip_->frames.size() - 1) / clip_->frame_hz);
  // A clip too short for the cross-fade uses half of it.
  crossing_ = std::min(options_.crossing, last_ / 2);
  round_ = last_ - crossing_;
  walking_back_ = std::min(options_.walking_back, round_ / 2);
  Pose end;
  sample_clip(*clip_, round_, ClipEnd::kHold, end);
  way_back_m_ = clip_->frames.front().p_WH_m - end.p_WH_m;
  way_back_m_.y() = 0.0f;
  const double heading_rad = options_.placement.heading_deg * std::numbers::pi / 180.0;
  R_heading_ = Eigen::AngleAxisf(static_cast<float>(heading_rad), Eigen::Vector3f::UnitY());
}

ClipDancer::Moment ClipDancer::moment_of(Duration t) const {
  const Duration at = Duration::seconds(std::max(0.0, t.as_seconds()) * options_.speed);
  Moment moment;
  if (options_.end == ClipEnd::kHold || round_ <= Duration()) {
    moment.at = std::min(at, last_);
    return moment;
  }
  const std::int64_t rounds = at.count_ns() / round_.count_ns();
  moment.at = at - round_ * rounds;
  if (rounds > 0 && moment.at < crossing_) {
    moment.ending = round_ + moment.at;
    moment.crossed =
        smooth_step(static_cast<float>(moment.at.as_seconds() / crossing_.as_seconds()));
  }
  return moment;
}

float ClipDancer::walked_back(Duration at) const {
  if (options_.end == ClipEnd::kHold || walking_back_ <= Duration()) return 0.0f;
  const Duration begin = round_ - walking_back_;
  return smooth_step(static_cast<float>((at - begin).as_seconds() / walking_back_.as_seconds()));
}

void ClipDancer::sample(Duration at, Pose& out) const {
  sample_clip(*clip_, at, ClipEnd::kHold, out);
  out.p_WH_m += walked_back(at) * way_back_m_;
}

void ClipDancer::dance_at(Duration t, Pose& out) {
  const Moment moment = moment_of(t);
  sample(moment.at, out);
  if (moment.crossed < 1.0f) {
    Pose ending;
    sample(moment.ending, ending);
    const Pose between = interpolate(ending, out, moment.crossed);
    out.R_PB = between.R_PB;
    out.p_WH_m = between.p_WH_m;
  }
  const Eigen::Vector3f origin(static_cast<float>(options_.placement.x_m), 0.0f,
                               static_cast<float>(options_.placement.z_m));
  out.p_WH_m = origin + R_heading_ * out.p_WH_m;
  out.R_PB[0] = (R_heading_ * out.R_PB[0]).normalized();
}

bool ClipDancer::hands_at(Duration t, Hands& out) {
  if (clip_->hands.empty()) return false;
  const auto hands_then = [this](Duration at) {
    const double position = std::max(0.0, at.as_seconds() * clip_->frame_hz);
    const std::size_t first = std::min(static_cast<std::size_t>(position), clip_->hands.size() - 1);
    const std::size_t second = std::min(first + 1, clip_->hands.size() - 1);
    return interpolate(clip_->hands[first], clip_->hands[second],
                       static_cast<float>(position - static_cast<double>(first)));
  };
  const Moment moment = moment_of(t);
  out = hands_then(moment.at);
  if (moment.crossed < 1.0f) out = interpolate(hands_then(moment.ending), out, moment.crossed);
  return true;
}

bool ClipDancer::is_over(Duration t) const {
  return options_.end == ClipEnd::kHold && t.as_seconds() * options_.speed > last_.as_seconds();
}

}  // namespace dance
