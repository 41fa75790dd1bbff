// FlowSetting: how a stage shows one guest: which transformers stand in the guest's route, which of
// them are used, and with what settings. Asked for by a panel, and said by the manager as it is.
//
// Units/frames: as lcmtypes/flow_t.lcm says.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for what is not finite or out of range.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/signal/style.h"

namespace dance {

// The words of a route, in the order in which they stand there.
enum class FlowWord : std::uint8_t { kHold, kPredict, kBridge, kRhythm, kStylize };
constexpr std::size_t kFlowWords = 5;
constexpr std::array<std::string_view, kFlowWords> kFlowWordNames{"hold", "predict", "bridge",
                                                                  "rhythm", "stylize"};
constexpr std::size_t index_of(FlowWord word) { return static_cast<std::size_t>(word); }

// The part of the motion that does not come again with the bar of which a route shows more, where
// it does not say.
constexpr float kUsualDynamic = 0.5f;

struct FlowSetting {
  MonoTime time;
  std::uint64_t clock_id = 0;
  std::array<bool, kFlowWords> has{};
  std::array<bool, kFlowWords> on{true, true, true, true, true};
  bool own = false;
  std::int32_t route = -1;
  float hold_ms = -1.0f;
  float lead = 1.0f;
  float reach_ms = 300.0f;
  float rhythm_beats = -1.0f;
  float rhythm_count = 1.0f;
  float rhythm_strength = 1.0f;
  float rhythm_error_mm = 60.0f;
  std::array<float, kBodyZones> gain{1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
  float periodic = 1.0f;
  float dynamic = kUsualDynamic;
  std::array<float, kBodyZones> guest_gain{1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
  float guest_periodic = 1.0f;
  float guest_dynamic = 1.0f;

  bool has_word(FlowWord word) const { return has[index_of(word)]; }
  bool is_on(FlowWord word) const { return has[index_of(word)] && on[index_of(word)]; }
};

bool is_valid(const FlowSetting& setting);
// That what a person sets is the same; who said it, and when, is not looked at.
bool is_same_setting(const FlowSetting& a, const FlowSetting& b);

}  // namespace dance
