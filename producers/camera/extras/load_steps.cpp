#include "producers/camera/extras/load_steps.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr double kMeanOf_s = 1.0;
constexpr double kTooMuch = 0.88;
// The next step up costs about half as much again.
constexpr double kLight = 0.55;
constexpr double kFits = 0.8;
// A step is kept for so long before it is judged.
constexpr Duration kJudged = Duration::ms(1500);
constexpr Duration kFirstPatience = Duration::s(10);
constexpr Duration kMostPatience = Duration::s(160);

}  // namespace

std::string_view text_of(LoadStep step) {
  switch (step) {
    case LoadStep::kAll:
      return "hands and face are looked for in every picture";
    case LoadStep::kAlternating:
      return "left and right hand are looked for by turns";
    case LoadStep::kOneInTurn:
      return "hands and face are looked for by turns, in every second picture";
    case LoadStep::kBodyOnly:
      return "only bodies are seen";
    case LoadStep::kDancersByTurns:
      return "dancers are seen by turns, one in each picture";
  }
  return "";
}

void LoadSteps::take(LoadStep step, MonoTime now) {
  step_ = step;
  since_ = light_since_ = now;
  load_ = 0.0;
}

// Below this load the next step up is tried: where dancers are seen by turns, all of them together
// cost as many times as much.
double LoadSteps::light() const {
  return step_ == LoadStep::kDancersByTurns ? kFits / static_cast<double>(dancers_) : kLight;
}

bool LoadSteps::add(Duration busy, Duration period, MonoTime now) {
  if (!since_.is_set()) {
    take(first_, now);
    patience_ = kFirstPatience;
  }
  if (period <= Duration{} || busy < Duration{}) return false;
  const double share = std::min(2.0, busy.as_seconds() / period.as_seconds());
  load_ += (1.0 - std::exp(-period.as_seconds() / kMeanOf_s)) * (share - load_);
  if (load_ > light()) light_since_ = now;
  if (now - since_ < kJudged) return false;
  const int step = static_cast<int>(step_);
  if (load_ > kTooMuch && step_ < last_) {
    // More was tried too early.
    if (is_tried_ && now - since_ < kFirstPatience)
      patience_ = std::min(kMostPatience, patience_ * 2);
    take(static_cast<LoadStep>(step + 1), now);
    is_tried_ = false;
    return true;
  }
  if (step_ > first_ && now - light_since_ > patience_) {
    take(static_cast<LoadStep>(step - 1), now);
    is_tried_ = true;
    return true;
  }
  return false;
}

}  // namespace dance
