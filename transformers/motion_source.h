// MotionSource: the second question of the stage: what is the pose of a moment? What came,
// interpolated; after the newest pose a prediction, where there is an extrapolator; and where poses
// stay away for longer than a prediction reaches, the continuation of the dance
// (transformers/conceal/concealment.h). With neither, the newest pose is repeated.
//
// Units/frames: moments are capture times, `now` is this house's clock.
// Ownership:    refers to the timeline, which must outlive it; owns the rest. Never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      at() needs a timeline with a pose.
#pragma once

#include <memory>

#include "transformers/conceal/concealment.h"
#include "transformers/partner/partner_guide.h"
#include "transformers/predict/extrapolator.h"
#include "transformers/prediction_lead.h"
#include "transformers/setting_slew.h"
#include "transformers/timeline.h"

namespace dance {

class MotionSource {
 public:
  enum class Kind { kDanced, kRepeated, kPredicted, kContinued };
  struct Parts {
    std::unique_ptr<Extrapolator> extrapolator;
    // The furthest that is predicted; beyond, the prediction stands.
    Duration reach = Duration::ms(300);
    std::unique_ptr<Concealment> concealment;
    // What dancers of this house tell of the prediction.
    std::unique_ptr<PartnerGuide> partner;
    // What was said of a moment that was danced is never said otherwise: where nothing corrects it.
    bool is_final = false;
  };
  MotionSource(DancerTimeline& timeline, Parts parts);

  // The timeline has taken its newest pose.
  void observe();
  void restart();
  void set_body();
  // Who dances here.
  void set_dancers(const PartnerTracks* dancers);
  // Once a picture, before at(): the moment that is shown at `now`.
  void set_shown(MonoTime moment, MonoTime now);
  // Whether what is predicted looks otherwise than in the picture before, as a partner danced on.
  bool has_partner_news() const { return parts_.partner && parts_.partner->has_news(); }
  const PartnerGuide* partner() const { return parts_.partner.get(); }
  // Once a picture, before at(): whether the dance has to be continued from here on. Returns true
  // where it begins now: moments after the newest pose look otherwise than before.
  bool begin_continuation(MonoTime moment, MonoTime now, const PredictionLead& lead = {});

  // The pose of a moment, past or to come; predicted with that lead. Nothing is smoothed from call
  // to call.
  Kind at(MonoTime moment, Pose& out, const PredictionLead& lead = {});
  // The same without the partner, for what is learned of predictions alone.
  Kind at_alone(MonoTime moment, Pose& out, const PredictionLead& lead = {});
  // Whether the next pose may change what at() says of a moment.
  bool is_open(MonoTime moment, Kind kind) const;

  bool predicts() const { return parts_.extrapolator != nullptr; }
  bool is_continuing() const { return parts_.concealment && parts_.concealment->is_running(); }
  bool conceals() const { return parts_.concealment != nullptr; }
  Duration reach() const { return parts_.reach; }
  // While dancing: how far is predicted from now on, come to gradually; and whether a longer gap is
  // carried over, from the next one on.
  void set(Duration reach, bool conceals);
  std::shared_ptr<Learner> learner() const;

 private:
  Kind at(MonoTime moment, const PredictionLead& lead, bool is_guided, Pose& out);
  void predict(MonoTime moment, const PredictionLead& lead, bool is_guided, Pose& out);

  DancerTimeline& timeline_;
  Parts parts_;
  Pose from_;  // as the extrapolator saw the newest pose
  bool has_from_ = false;
  SettingSlew reach_s_;
  bool may_conceal_ = true;
};

}  // namespace dance
