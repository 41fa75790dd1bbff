// A couple on a stage as a house shows it, and who holds whom there: what `dance touch eval`
// judges.
//
// Units/frames: metres, seconds. Truth: palms of the recording within kTruth_m of each other.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      takes shorter than the warm-up have an empty stage.
#pragma once

#include <string>
#include <vector>

#include "research/predict/couple_takes.h"
#include "transformers/flow.h"
#include "transformers/touch/palm_hold.h"

namespace dance {

constexpr float kTruth_m = 0.08f;
// The first dancer's palm k / 2 and the second's k % 2.
constexpr std::size_t kHandPairs = 4;

struct TouchLine {
  Duration delay = Duration::ms(60);
  Duration jitter = Duration::ms(15);
  double loss_percent = 1.0;
  double noise_deg = 0.5;
  std::uint64_t seed = 0;  // of noise, jitter and losses
  std::vector<std::string> through{"predict", "bridge"};
  FlowParts parts;
  Duration warm_up = Duration::s(4);
  PalmHold::Limits limits;
};

// Of one way to recognise holds on one stage.
struct HoldFigures {
  std::size_t true_frames = 0;   // pairs of palms × pictures within kTruth_m in the recording
  std::size_t found_frames = 0;  // of these, reported
  std::size_t held_frames = 0;   // reported
  std::size_t apart_frames = 0;  // of these, over twice kTruth_m apart in the recording
  std::size_t holds = 0;         // reported, from begin to end
  std::size_t false_holds = 0;   // of these, without any true frame within them
  std::size_t far_holds = 0;     // of these, never within 1.5 times kTruth_m
  std::size_t true_holds = 0;    // in the recording
  std::size_t breaks = 0;        // ends of a reported hold within a true one
  double seconds = 0.0;
  double found() const;
  double apart() const;
  double per_minute(std::size_t count) const;
  HoldFigures& operator+=(const HoldFigures& more);
};

// What a stage shows at one moment, and what was danced then.
struct ShownMoment {
  std::array<Pose, 2> danced, shown;
  MonoTime at;
};
using ShownStage = std::vector<ShownMoment>;
using PalmGaps = std::array<float, kHandPairs>;

std::vector<Pose> through_codec(const PredictTake& take);
ShownStage captured_stage(const CoupleTake& couple, const std::array<std::vector<Pose>, 2>& poses,
                          Duration warm_up);
// The first dancer is here, the second comes over the line and through the route.
ShownStage streamed_stage(const CoupleTake& couple, const TouchLine& how);

std::array<Eigen::Vector3f, 2> palms_of(const Skeleton& skeleton, const Pose& pose);
PalmGaps gaps_of(const CoupleTake& couple, const std::array<Pose, 2>& poses);

// Counts what one way reports, pair of palms by pair.
class HoldCount {
 public:
  void add(const std::array<bool, kHandPairs>& reported, const PalmGaps& danced);
  HoldFigures figures(double seconds);

 private:
  void end(std::size_t k);
  HoldFigures figures_;
  PalmGaps nearest_m_{};
  std::array<bool, kHandPairs> was_{}, was_true_{}, has_truth_{};
};

// The holds that a stage reports, and those of the threshold kTruth_m on what is shown.
HoldFigures holds_on(const CoupleTake& couple, const ShownStage& stage,
                     const PalmHold::Limits& limits);
HoldFigures near_on(const CoupleTake& couple, const ShownStage& stage);

}  // namespace dance
