// LoadSteps: how much is looked for in a picture, so that each is done before the next one comes.
// Hands and face are seen more seldom where the machine cannot do more, and at last several dancers
// by turns.
//
// Units/frames: times of one clock.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/time.h"

namespace dance {

enum class LoadStep : std::uint8_t {
  kAll,          // both hands and the face in every picture
  kAlternating,  // one hand in every picture, left and right by turns, and the face in every second
  kOneInTurn,    // a hand or the face in every second picture
  kBodyOnly,
  kDancersByTurns,  // of several dancers one in each picture
};
// As people read it.
std::string_view text_of(LoadStep step);

class LoadSteps {
 public:
  // From the first to the last of them, as there is something to leave out.
  explicit LoadSteps(LoadStep first = LoadStep::kAll, LoadStep last = LoadStep::kBodyOnly,
                     std::size_t dancers = 1)
      : first_(first), last_(last), dancers_(dancers), step_(first) {}
  // A picture took `busy` of the `period` since the one before. True where the step is another now.
  bool add(Duration busy, Duration period, MonoTime now);
  LoadStep step() const { return step_; }

 private:
  void take(LoadStep step, MonoTime now);

  double light() const;

  LoadStep first_, last_;
  std::size_t dancers_;
  LoadStep step_;
  double load_ = 0.0;  // of one core, mean of about a second
  MonoTime since_;     // of this step
  MonoTime light_since_;
  Duration patience_;      // before more is tried again
  bool is_tried_ = false;  // this step is one up
};

}  // namespace dance
