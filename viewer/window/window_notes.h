// The lines at the bottom left of the window: what is shown, what is missing and how to get it, and
// with the figures how long a pose takes to the screen.
//
// Units/frames: ms.
// Ownership:    plain values.
// Threads:      none inside; the drawing thread.
// Failure:      none.
#pragma once

#include <optional>
#include <string>

#include "viewer/display/display_path.h"
#include "viewer/display/swap_meter.h"
#include "viewer/program/view_options.h"
#include "viewer/window/window_state.h"

namespace dance {

// What display and pictures do at present.
struct DisplayNews {
  double pictures_hz = 0.0;
  DisplayPath::Phase phase = DisplayPath::Phase::kLearning;
  Duration period;
  std::uint64_t missed = 0;
  DisplayMode mode = DisplayMode::kTearFree;
  bool is_late_latching = true;
  std::optional<SwapFigures> swap;
};

// "capture to swap 21.3 ms (p99 27.0): coming 9.8, waiting 3.1, drawing 7.6, swap 0.8".
std::string swap_words(const SwapFigures& figures);
std::string display_words(const DisplayNews& news);

// The lines, but those of the figures, of a stage.
void write_stage_notes(const ViewOptions& options, const std::string& house,
                       const std::string& view_words, bool focus_was_here, SceneState& scene);
void write_figure_notes(const DisplayNews& news, SceneState& scene);

}  // namespace dance
