#include "producers/camera/advice/camera_advice.h"

#include <algorithm>

namespace dance {
namespace {

bool is_met_now(const CameraRule& rule, bool was_met, std::optional<float> measure) {
  if (!measure) return false;
  if (rule.begins > rule.ends) return was_met ? *measure > rule.ends : *measure >= rule.begins;
  return was_met ? *measure < rule.ends : *measure <= rule.begins;
}

}  // namespace

Text text_of(const CameraStatus& status) {
  switch (status.state) {
    case CameraState::kUnplugged:
      return Text::kCameraUnplugged;
    case CameraState::kSilent:
      return Text::kCameraSilent;
    case CameraState::kFailed:
      if (status.cause == CameraCause::kInUse) return Text::kCameraInUse;
      if (status.cause == CameraCause::kAbsent) return Text::kCameraNone;
      if (status.cause == CameraCause::kNoPermission) return Text::kCameraNoPermission;
      return Text::kCameraFailed;
    default:
      return Text::kCameraOpening;
  }
}

void CameraAdvice::note(const CameraStatus& status) {
  has_network_ = status.has_network;
  const bool is_running = status.state == CameraState::kRunning;
  if (is_running && is_running_) return;
  is_running_ = is_running;
  rules_ = {};
  running_since_ = {};
  texts_[0] = is_running ? Text::kCameraOpening : text_of(status);
  count_ = 1;
}

void CameraAdvice::see(const CameraFacts& facts, MonoTime now) {
  if (!is_running_) return;
  if (!running_since_.is_set()) running_since_ = now;
  now_ = now;
  is_found_ = facts.body.is_found;
  const CameraSight sight{facts, body_in_frame(facts.body), has_network_};
  const std::span<const CameraRule> rules = camera_rules();
  for (std::size_t i = 0; i < rules.size(); ++i) {
    RuleState& state = rules_[i];
    const bool is_met = is_met_now(rules[i], state.is_met, rules[i].measure(sight));
    if (is_met != state.is_met || !state.since.is_set()) {
      state.is_met = is_met;
      state.since = now;
    }
    const Duration lasts = now - state.since;
    if (is_met && lasts >= kHolds) state.is_said = true;
    if (!is_met && lasts >= kEnds) state.is_said = false;
  }
  choose();
}

bool CameraAdvice::is_said(Text text) const {
  const std::span<const CameraRule> rules = camera_rules();
  for (std::size_t i = 0; i < rules.size(); ++i)
    if (rules[i].text == text) return rules_[i].is_said;
  return false;
}

// Two texts for one trouble are one too many.
bool CameraAdvice::is_hidden_by_another(Text text) const {
  switch (text) {
    case Text::kCameraTooDark:
    case Text::kCameraNobody:
    case Text::kCameraNoNetwork:
      return is_said(Text::kCameraLensCovered);
    case Text::kCameraFeetCutOff:
      return is_said(Text::kCameraHeadCutOff);
    case Text::kCameraHandsCutOff:
    case Text::kCameraLegsHidden:
      return is_said(Text::kCameraHeadCutOff) || is_said(Text::kCameraFeetCutOff);
    default:
      return false;
  }
}

void CameraAdvice::say(Text text) {
  if (count_ < texts_.size()) texts_[count_++] = text;
}

void CameraAdvice::choose() {
  const Text before = texts_[0];
  count_ = 0;
  const std::span<const CameraRule> rules = camera_rules();
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const Text text = rules[i].text;
    if (!rules_[i].is_said || is_hidden_by_another(text)) continue;
    // Where both ends are cut off, tilting the camera mends neither.
    const bool is_too_near = text == Text::kCameraHeadCutOff && is_said(Text::kCameraFeetCutOff);
    say(is_too_near ? Text::kCameraStepBack : text);
  }
  if (count_ > 0) return;
  const bool is_any_met =
      std::any_of(rules_.begin(), rules_.end(), [](const RuleState& r) { return r.is_met; });
  const bool is_fine = is_found_ && !is_any_met && now_ - running_since_ >= kEnds;
  // Until it is known what is so now, what was said last stays.
  say(is_fine ? Text::kCameraSeenWhole : before);
}

}  // namespace dance
