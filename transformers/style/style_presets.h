// Styles as people write them: "preset=cuban hips=1.5 mix=0.5", in a session file and in `dance
// style`; and those that have a name.
//
// Units/frames: gains as core/signal/style.h; mix is what of the motion that does not come
//               again with the bar follows them.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      read_style() names what is wrong and what there is.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/signal/style.h"

namespace dance {

// Where a session file does not say: all of it shows more, and a sensor's noise too.
constexpr double kUsualMix = 0.5;
// What may be asked for in words.
constexpr double kMostSpokenGain = 3.0;

std::optional<Style> find_style_preset(std::string_view name);
std::span<const std::string_view> style_preset_list();
// "calm, subtle, …"
std::string style_preset_names();

// `who` is named in errors; usual_mix is Style::dynamic where none is written.
Result<Style> read_style(std::string_view who, std::span<const std::string_view> words,
                         double usual_mix);

}  // namespace dance
