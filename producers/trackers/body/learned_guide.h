// LearnedGuide: a whole body by a network that was trained on dances (net/tracker_net.h). The
// network runs at a rate of its own, whatever the devices' is, and says what will be a step later;
// between two steps the body is interpolated.
//
// Units/frames: W, metres.
// Ownership:    shares the model; never allocates after it was made.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <memory>

#include "producers/trackers/net/tracker_model.h"

namespace dance {

class LearnedGuide : public BodyGuide {
 public:
  explicit LearnedGuide(std::shared_ptr<const TrackerModel> model);

  void reset() override;
  void guess(const Skeleton& skeleton, const BonePlaces& bones, float seconds,
             BodyGuess& guess) override;

 private:
  void step(const BonePlaces& bones, float height_m);

  std::shared_ptr<const TrackerModel> model_;
  TrackerNet::State state_;
  TrackerRow::Inputs inputs_{};
  TrackerRow::Outputs said_before_{}, said_{};  // for step_time_, and a step later
  BonePlaces newest_, at_step_;
  MonoTime step_time_;
  bool began_ = false;
};

}  // namespace dance
