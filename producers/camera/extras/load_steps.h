// LoadSteps: how much is looked for beside the body, so that each picture is done before the next
// one comes. The body is seen in every picture; hands and face are seen more seldom where the
// machine cannot do more.
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
};
constexpr int kLoadStepCount = 4;
// As people read it.
std::string_view text_of(LoadStep step);

class LoadSteps {
 public:
  // A picture took `busy` of the `period` since the one before. True where the step is another now.
  bool add(Duration busy, Duration period, MonoTime now);
  LoadStep step() const { return step_; }

 private:
  void take(LoadStep step, MonoTime now);

  LoadStep step_ = LoadStep::kAll;
  double load_ = 0.0;  // of one core, mean of about a second
  MonoTime since_;     // of this step
  MonoTime light_since_;
  Duration patience_;      // before more is tried again
  bool is_tried_ = false;  // this step is one up
};

}  // namespace dance
