// OscMessage: one Open Sound Control message as it came: its address and its arguments.
//
// Units/frames: none; what the arguments mean their protocol says.
// Ownership:    texts are views of the packet, valid while it is.
// Threads:      plain value.
// Failure:      none; arguments beyond kMostOscArguments are left out.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/fixed_list.h"

namespace dance {

constexpr std::size_t kMostOscArguments = 16;  // the longest of VMC has 14

struct OscArgument {
  enum class Kind : std::uint8_t { kInt, kFloat, kDouble, kText, kOther };
  Kind kind = Kind::kOther;
  std::int32_t number = 0;
  float real = 0.0f;
  std::string_view text;
};

struct OscMessage {
  std::string_view address;
  FixedList<OscArgument, kMostOscArguments> arguments;
};

}  // namespace dance
