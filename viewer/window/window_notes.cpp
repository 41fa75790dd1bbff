#include "viewer/window/window_notes.h"

#include <fmt/format.h>

#include "viewer/words/texts.h"

namespace dance {

std::string swap_words(const SwapFigures& figures) {
  return fmt::format(
      "capture to swap {:.1f} ms (p99 {:.1f}): coming {:.1f}, waiting {:.1f}, drawing {:.1f}, "
      "swap {:.1f}",
      figures.p50_ms, figures.p99_ms, figures.coming_ms, figures.waiting_ms, figures.drawing_ms,
      figures.swapping_ms);
}

std::string display_words(const DisplayNews& news) {
  std::string words = fmt::format(
      "{:.0f} pictures/s, display {:.1f} Hz, {}", news.pictures_hz, 1.0 / news.period.as_seconds(),
      news.mode == DisplayMode::kTearFree ? "tear-free" : "low latency");
  if (!news.is_late_latching) return words;
  if (news.phase == DisplayPath::Phase::kLatched)
    words += fmt::format(", poses taken late ({} missed)", news.missed);
  if (news.phase == DisplayPath::Phase::kLearning) words += ", learning the display's turns";
  if (news.phase == DisplayPath::Phase::kOwnPace) words += ", the driver does not wait";
  return words;
}

void write_stage_notes(const ViewOptions& options, const std::string& house,
                       const std::string& view_words, bool focus_was_here, SceneState& scene) {
  if (scene.guests.empty() && !options.log.empty())
    scene.notes.push_back("nobody is on the stage at this moment of " + house);
  else if (scene.guests.empty() && !options.session.empty())
    scene.notes.emplace_back(Texts(options.language)[Text::kStageEmpty]);
  else if (scene.guests.empty())  // shown from a terminal
    scene.notes.push_back("nobody is on the stage of " + house +
                          " yet; bring dancers with: dance salsa, or dance replay FILE");
  else if (options.focus && !focus_was_here)
    scene.notes.push_back("--focus " + std::string(options.focus->view()) +
                          ": not here yet; until then everybody is shown");
  if (!view_words.empty() && !scene.guests.empty()) scene.notes.push_back(view_words);
}

void write_figure_notes(const DisplayNews& news, SceneState& scene) {
  if (news.swap) scene.notes.push_back(swap_words(*news.swap));
  scene.notes.push_back(display_words(news));
}

}  // namespace dance
