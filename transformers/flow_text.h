// The words of a route as people write them, from the settings of a flow: what flow_words.cpp
// reads. Settings that are as usual are left out.
//
// Units/frames: as docs/prediction.md, docs/rhythm.md and docs/style.md say; two decimals.
// Ownership:    returns new texts.
// Threads:      any.
// Failure:      none: a text that cannot be read is replaced.
#pragma once

#include <string>
#include <string_view>

#include "core/signal/flow_setting.h"

namespace dance {

// `old` is what stands there: it stays where it says the same, as do arguments that no setting has.
std::string word_text(FlowWord word, const FlowSetting& setting, std::string_view old);
// "preset=cuban head=1.2 mix=0.5"; "preset=as-danced" where there is nothing to say.
std::string style_text(const Style& style, double usual_mix);

}  // namespace dance
