// Haptic: something for a dancer to feel, where on the body, how strong, and when.
//
// Units/frames: as lcmtypes/haptic_t.lcm says; amplitude 0 to 1 of what the device has.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for an unknown source or bone, and for what is out of range.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/time.h"
#include "core/pose/bone.h"

namespace dance {

enum class HapticSource : std::uint8_t { kTouch, kHold, kBeat, kLead };
constexpr std::size_t kHapticSources = 4;

struct Haptic {
  static constexpr Duration kShortest = Duration::ms(1);
  static constexpr Duration kLongest = Duration::s(5);
  static constexpr Duration kFarthest = Duration::s(10);
  static constexpr float kMostFrequency_hz = 1000.0f;

  MonoTime time;
  std::uint64_t clock_id = 0;
  std::uint64_t maker = 0;
  std::uint32_t number = 0;
  MonoTime play_time;
  Duration duration = Duration::ms(100);
  Duration attack, release;
  HapticSource source = HapticSource::kTouch;
  Bone bone = Bone::kHips;
  float amplitude = 0.0f;
  float frequency_hz = 0.0f;  // 0: the device's own

  // The envelope, `since` the begin: 0 … amplitude.
  float amplitude_at(Duration since) const {
    if (since < Duration() || since >= duration) return 0.0f;
    double share = 1.0;
    if (since < attack) share = since.as_seconds() / attack.as_seconds();
    const Duration left = duration - since;
    if (left < release) share = std::min(share, left.as_seconds() / release.as_seconds());
    return amplitude * static_cast<float>(share);
  }
};

inline bool is_valid(const Haptic& haptic) {
  const Duration until = haptic.play_time - haptic.time;
  const bool is_device_rate = haptic.frequency_hz == 0.0f;
  return haptic.source <= HapticSource::kLead && index_of(haptic.bone) < kBoneCount &&
         haptic.amplitude >= 0.0f && haptic.amplitude <= 1.0f &&
         haptic.duration >= Haptic::kShortest && haptic.duration <= Haptic::kLongest &&
         haptic.attack >= Duration() && haptic.attack <= haptic.duration &&
         haptic.release >= Duration() && haptic.release <= haptic.duration - haptic.attack &&
         until <= Haptic::kFarthest && until >= -Haptic::kFarthest &&
         (is_device_rate ||
          (haptic.frequency_hz >= 1.0f && haptic.frequency_hz <= Haptic::kMostFrequency_hz));
}

}  // namespace dance
