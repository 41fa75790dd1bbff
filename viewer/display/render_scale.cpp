#include "viewer/display/render_scale.h"

#include <algorithm>

namespace dance {
namespace {

constexpr double kNewest = 0.2;  // share of the newest picture in the mean
// The first pictures of a scale are not measured, because its textures are made then.
constexpr Duration kSettles = Duration::ms(300);

// True if the condition has held for `duration`; `since` is the time at which it began to hold.
bool has_lasted(bool holds, MonoTime& since, Duration duration, MonoTime now) {
  if (!holds) since = MonoTime();
  if (holds && !since.is_set()) since = now;
  return holds && now - since >= duration;
}

}  // namespace

void RenderScale::change(std::size_t step, MonoTime now) {
  const bool rises = step < step_;
  // A larger scale proved too slow: the next try waits longer.
  if (!rises && has_risen_) rises_after_ = std::min(rises_after_ + rises_after_, kLongestWait);
  has_risen_ = rises;
  step_ = step;
  changed_ = now;
  slow_since_ = good_since_ = MonoTime();
  mean_ = Duration();
}

void RenderScale::on_picture(Duration drawing, MonoTime now) {
  if (!changed_.is_set()) changed_ = now;
  if (now - changed_ < kSettles) return;
  mean_ = mean_ == Duration() ? drawing
                              : Duration::seconds((1.0 - kNewest) * mean_.as_seconds() +
                                                  kNewest * drawing.as_seconds());
  if (has_lasted(mean_ > kTooSlow && !is_smallest(), slow_since_, kFallsAfter, now))
    return change(step_ + 1, now);
  if (step_ == 0) return;
  const double larger = static_cast<double>(kScales[step_ - 1] / kScales[step_]);
  const bool would_do = mean_.as_seconds() * larger * larger < kGood.as_seconds();
  if (has_lasted(would_do, good_since_, rises_after_, now)) change(step_ - 1, now);
}

}  // namespace dance
