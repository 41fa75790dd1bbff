// Texts on a dancer and the beat, for stage and plot.
//
// Units/frames: ms; positive is behind the beat, or before now.
// Ownership:    returns new texts.
// Threads:      any.
// Failure:      none.
#pragma once

#include <string>

namespace dance {

// "38 ms behind the beat", "on the beat".
std::string beat_words(double behind_ms);
// Of a predicted pose: "a guess of now", "a guess of 70 ms ago".
std::string guess_words(double age_ms);
// Whether the shown moment is newer than the newest pose.
bool is_guess(double shown_age_ms, double come_age_ms);

}  // namespace dance
