// CameraAdvice: what a dancer is told of how the camera sees her: what to mend, what matters most
// first, or that all is well. A rule's text is said once it has held for a second, and goes when
// it is mended; limits to begin and to end differ, so that no text flickers.
//
// Units/frames: times of the caller's clock, which only goes forward.
// Ownership:    plain values; allocates nothing. texts() is good until the next call.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <span>

#include "formats/camera_view/camera_view.h"
#include "producers/camera/advice/camera_rules.h"
#include "viewer/words/texts.h"

namespace dance {

class CameraAdvice {
 public:
  static constexpr std::size_t kMost = 3;  // at once: more is not read
  static constexpr Duration kHolds = Duration::ms(1000);
  static constexpr Duration kEnds = Duration::ms(300);

  // The camera's state, when it changes.
  void note(const CameraStatus& status);
  // What a new picture shows.
  void see(const CameraFacts& facts, MonoTime now);

  // Never empty.
  std::span<const Text> texts() const { return {texts_.data(), count_}; }
  bool is_good() const { return texts_[0] == Text::kCameraSeenWhole; }

 private:
  struct RuleState {
    bool is_met = false;  // by its own two limits
    bool is_said = false;
    MonoTime since;  // is_met is so since then
  };
  void choose();
  void say(Text text);
  bool is_hidden_by_another(Text text) const;
  bool is_said(Text text) const;

  std::array<RuleState, kCameraRules> rules_{};
  bool has_network_ = false;
  bool is_running_ = false;
  bool is_found_ = false;  // in the newest picture
  MonoTime running_since_;
  MonoTime now_;
  std::array<Text, kMost> texts_{Text::kCameraOpening};
  std::size_t count_ = 1;
};

// The text for a camera that does not run.
Text text_of(const CameraStatus& status);

}  // namespace dance
