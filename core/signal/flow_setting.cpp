#include "core/signal/flow_setting.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// False for what is not a number, too.
bool is_within(float value, float low, float high) { return value >= low && value <= high; }

bool are_gains(const std::array<float, kBodyZones>& gains) {
  return std::all_of(gains.begin(), gains.end(),
                     [](float gain) { return is_within(gain, 0.0f, kMostStyleGain); });
}

bool is_same(float a, float b) { return std::abs(a - b) < 1e-4f * std::max(1.0f, std::abs(a)); }

}  // namespace

bool is_valid(const FlowSetting& s) {
  return are_gains(s.gain) && are_gains(s.guest_gain) &&
         is_within(s.periodic, 0.0f, kMostStyleGain) &&
         is_within(s.dynamic, 0.0f, kMostStyleGain) &&
         is_within(s.guest_periodic, 0.0f, kMostStyleGain) &&
         is_within(s.guest_dynamic, 0.0f, kMostStyleGain) && is_within(s.hold_ms, -1.0f, 2000.0f) &&
         is_within(s.lead, 0.0f, 1.5f) && is_within(s.reach_ms, 0.0f, 1000.0f) &&
         is_within(s.rhythm_beats, -1.0f, 8.0f) && is_within(s.rhythm_count, 1.0f, 8.0f) &&
         is_within(s.rhythm_strength, 0.0f, 1.0f) && is_within(s.rhythm_error_mm, 1.0f, 1000.0f) &&
         s.route >= -1 && s.route < 1024;
}

bool is_same_setting(const FlowSetting& a, const FlowSetting& b) {
  return a.on == b.on && is_same(a.hold_ms, b.hold_ms) && is_same(a.lead, b.lead) &&
         is_same(a.reach_ms, b.reach_ms) && is_same(a.rhythm_beats, b.rhythm_beats) &&
         is_same(a.rhythm_count, b.rhythm_count) && is_same(a.rhythm_strength, b.rhythm_strength) &&
         is_same(a.rhythm_error_mm, b.rhythm_error_mm) &&
         std::equal(a.gain.begin(), a.gain.end(), b.gain.begin(), is_same) &&
         is_same(a.periodic, b.periodic) && is_same(a.dynamic, b.dynamic);
}

}  // namespace dance
