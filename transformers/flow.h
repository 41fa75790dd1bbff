// Flow: from the poses that came of one guest to the pose on the stage. Four questions, asked in
// one direction, once a picture:
//   1. Which moment?              PlayoutClock: live, hold, rhythm
//   2. What is its pose?          MotionSource: what came, a prediction, the continuation
//   3. Is it a body?              Finish: corrections without a pop, joint limits, standing feet
//   4. How shall it look?         PoseFilters, in order: stylize
// Finish stands before the filters, as it holds feet where the dancer was seen to stand; a filter
// keeps joint limits by itself. The words of a session file fill the slots; the table of words is
// in flow_words.cpp.
//
// Units/frames: `now` is this house's clock. A pose's capture_time says which moment of the dance
//               it shows.
// Ownership:    owns its parts; allocates only in make().
// Threads:      none inside; one owner. Pure: no I/O, no clock of its own. What is too slow for the
//               pose path is in learner(), which another thread may run.
// Failure:      make() names the word that it does not know and the ones it does, or the order that
//               would be right. sample() is false while there is nothing to show.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/motion/finish.h"
#include "core/signal/flow_setting.h"
#include "core/signal/playout.h"
#include "transformers/motion_source.h"
#include "transformers/playout/playout_clock.h"
#include "transformers/style/pose_filter.h"
#include "transformers/timeline.h"

namespace dance {

struct PredictModel;

// What parts may be made with and no word can say, as nothing here reads files.
struct FlowParts {
  std::shared_ptr<const PredictModel> predict_model;  // null: the built-in one
};

class Flow {
 public:
  struct Counters {
    std::uint64_t refused = 0;   // poses that were not newer, styles that are none
    std::uint64_t restarts = 0;  // the source began again: a producer came back, a replay looped
    std::uint64_t starved = 0;   // pictures that had to repeat what was shown before
  };
  // The slots, filled. Without a finish, what the source says is shown as it is.
  struct Slots {
    std::unique_ptr<PlayoutClock> clock;
    MotionSource::Parts source;
    std::size_t poses = 0;  // that the timeline keeps
    bool has_finish = false;
    Duration half_life = Inertializer::kHalfLife;  // of corrections
    // Corrections die away from the next picture on, which is smoother; else from the one on that
    // was wrong, which is nearer to the dance.
    bool corrects_from_now = false;
    std::vector<std::unique_ptr<PoseFilter>> filters;
    FlowSetting setting;  // that these were made with
    bool holds_hands = false;
  };

  // Hands poses through as they come.
  Flow() = default;
  explicit Flow(Slots slots);
  static Result<Flow> make(const std::vector<std::string>& words, const FlowParts& parts = {});

  bool is_pass_through() const { return clock_ == nullptr; }
  // The word hold-hands: arms reach for the hands they hold, where several dancers are known
  // (transformers/touch/stage_holds.h), so not here.
  bool holds_hands() const { return holds_hands_; }
  // A pose has arrived from the route's source.
  void observe(const Pose& pose, MonoTime now);
  // The music that this house hears.
  void hear(const Beat& beat);
  // The dancer's proportions, and how the dance is to be shown.
  void set_body(const Skeleton& skeleton);
  void set_style(const Style& style);
  // The dancers of this house, of whom one may be the partner; they must outlive the flow.
  void set_dancers(const PartnerTracks* dancers);
  const PartnerGuide* partner() const { return source_ ? source_->partner() : nullptr; }
  // What a person at this stage wants: come to gradually, while dancing. Words that do not stand in
  // the route stay away.
  void set(const FlowSetting& setting);
  // Where the words stand: which route of the session file, and whether it is of own dancers.
  void place(std::int32_t route, bool is_own) {
    setting_.route = route;
    setting_.own = is_own;
  }
  // What is in force, or is being come to.
  const FlowSetting& setting() const { return setting_; }
  // The pose to show at `now`.
  bool sample(MonoTime now, Pose& out);

  // What learns beside the pose path, if anything; see transformers/predict/learner.h.
  std::shared_ptr<Learner> learner() const { return source_ ? source_->learner() : nullptr; }
  // How long after the last pose of a dancer there is something of them to show. 0: no longer than
  // any silence.
  Duration longest_silence() const;
  Counters counters() const;
  // What was shown last, and why; its stamps are the caller's.
  Playout playout(MonoTime now) const;

  const PlayoutClock* clock() const { return clock_.get(); }
  bool is_continuing() const { return source_ && source_->is_continuing(); }

 private:
  void correct(const PlayoutClock::Choice& choice, MonoTime now, bool continues_from_here);
  void foresee_feet(MonoTime moment);

  std::unique_ptr<DancerTimeline> timeline_;
  std::unique_ptr<PlayoutClock> clock_;
  std::unique_ptr<MotionSource> source_;
  std::unique_ptr<Finish> finish_;
  std::vector<std::unique_ptr<PoseFilter>> filters_;

  // The picture before: as the source gave it, and the moment that was to be shown.
  Pose shown_;
  MonoTime shown_moment_, shown_at_;
  MonoTime shown_capture_;  // the moment that was shown
  bool corrects_from_now_ = false;
  bool has_shown_ = false, is_shown_open_ = false, is_shown_repeated_ = false, has_news_ = false;
  std::uint64_t starved_ = 0;
  FlowSetting setting_;
  bool holds_hands_ = false;
};

}  // namespace dance
