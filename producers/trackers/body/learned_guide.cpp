#include "producers/trackers/body/learned_guide.h"

#include <algorithm>
#include <utility>

namespace dance {
namespace {

const Duration kNetStep = Duration::period_of_hz(TrackerRow::kStep_hz);
constexpr int kMostStepsAtOnce = 30;

BonePlaces between(const BonePlaces& a, const BonePlaces& b, MonoTime time) {
  BonePlaces out = b;
  const double whole = (b.time - a.time).as_seconds();
  const auto part = static_cast<float>(
      whole > 0.0 ? std::clamp((time - a.time).as_seconds() / whole, 0.0, 1.0) : 1.0);
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((a.presence & b.presence) >> i & 1u) {
      out.places[i].p_W_m = a.places[i].p_W_m + part * (b.places[i].p_W_m - a.places[i].p_W_m);
      out.places[i].R_W = a.places[i].R_W.slerp(part, b.places[i].R_W);
    }
  }
  out.time = time;
  return out;
}

}  // namespace

LearnedGuide::LearnedGuide(std::shared_ptr<const TrackerModel> model) : model_(std::move(model)) {}

void LearnedGuide::reset() {
  state_.clear();
  began_ = false;
}

void LearnedGuide::step(const BonePlaces& bones, float height_m) {
  const TrackerView view(bones.of(TrackedPoint::kHead), height_m);
  write_inputs(view, at_step_, bones, static_cast<float>(kNetStep.as_seconds()), inputs_);
  model_->net.step(inputs_, state_);
  said_before_ = said_;
  said_ = state_.outputs;
  at_step_ = bones;
  step_time_ = bones.time;
}

void LearnedGuide::guess(const Skeleton& skeleton, const BonePlaces& bones, float,
                         BodyGuess& guess) {
  const float height_m = standing_height_m(skeleton);
  if (!began_) {
    at_step_ = newest_ = bones;
    step(bones, height_m);
    said_before_ = said_;
    began_ = true;
  }
  for (int i = 0; i < kMostStepsAtOnce && bones.time - step_time_ >= kNetStep; ++i)
    step(between(newest_, bones, step_time_ + kNetStep), height_m);
  newest_ = bones;
  const auto part = static_cast<float>(
      std::clamp((bones.time - step_time_).as_seconds() / kNetStep.as_seconds(), 0.0, 1.0));
  TrackerRow::Outputs row;
  for (std::size_t i = 0; i < row.size(); ++i)
    row[i] = said_before_[i] + part * (said_[i] - said_before_[i]);
  const Place& head = bones.of(TrackedPoint::kHead);
  read_outputs(TrackerView(head, height_m), row, head.R_W, guess);
}

}  // namespace dance
