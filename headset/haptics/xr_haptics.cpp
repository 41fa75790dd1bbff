#include "headset/haptics/xr_haptics.h"

#include <fmt/format.h>

namespace dance {
namespace {

bool is_of(Bone bone, Bone first, Bone last) {
  return index_of(bone) >= index_of(first) && index_of(bone) <= index_of(last);
}

// A controller has one strength for all of a buzz: that whose energy is the envelope's, whose sides
// are straight.
float level_of(const Haptic& haptic) {
  const double whole = haptic.duration.as_seconds();
  const double sides = (haptic.attack + haptic.release).as_seconds();
  return haptic.amplitude * static_cast<float>(1.0 - 0.5 * sides / whole);
}

}  // namespace

bool XrHaptics::play(const Haptic& haptic, MonoTime) {
  const bool is_left = is_of(haptic.bone, Bone::kLeftShoulder, Bone::kLeftHand);
  const bool is_right = is_of(haptic.bone, Bone::kRightShoulder, Bone::kRightHand);
  const float level = level_of(haptic);
  bool is_felt = false;
  for (const XrHand hand : {XrHand::kLeft, XrHand::kRight}) {
    if (hand == XrHand::kLeft ? is_right : is_left) continue;
    is_felt = input_.vibrate(hand, level, haptic.duration, haptic.frequency_hz) || is_felt;
  }
  ++(is_felt ? played_ : refused_);
  return is_felt;
}

void XrHaptics::stop() {
  for (const XrHand hand : {XrHand::kLeft, XrHand::kRight}) input_.stop(hand);
}

std::string XrHaptics::summary() const {
  return fmt::format("{}: {} felt, {} not taken", name(), played_, refused_);
}

}  // namespace dance
