// The words for a dancer's timing, the same under a stage and beside a plot.
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
// Of what is newer than what has come: "predicted as of now", "predicted as of 70 ms ago".
std::string prediction_words(double age_ms);
// Whether what is shown is newer than the newest that has come.
bool is_predicted(double shown_age_ms, double come_age_ms);

}  // namespace dance
