// Edits of a session's text: the words of one route, and the style of one guest. Only the text of
// the values that change is replaced; comments, order and everything else stay as they are.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an error names the file, the place and what is wrong there; the text is read again
//               before it is returned, so that what comes out is TOML and holds the new values.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dance {

// A session file has no more.
inline constexpr std::size_t kMaxSessionBytes = 1 << 20;

// A transformer's word in `through`, told by its first word: "predict lead=0.8" is for "predict".
struct WordEdit {
  std::string word;
  std::string text;
};

// [[style]] of a guest of this house.
struct StyleEdit {
  std::string guest;
  std::string words;  // "hips=1.5 mix=1"
};

// A route as it is written.
struct RouteText {
  std::string from, to;
  std::vector<std::string> through;
  double rate_hz = 0.0;
};

// The routes of a session that has none: own dancers straight to the stage, remote ones predicted,
// carried over lapses, on the beat and in their style.
std::vector<RouteText> usual_routes();

struct SessionEdit {
  std::size_t route = 0;  // which [[route]] of the file, from 0
  std::vector<WordEdit> words;
  std::optional<StyleEdit> style;
};

// `name` stands in errors.
Result<std::string> edit_session(std::string_view text, const SessionEdit& edit,
                                 const std::string& name);
// The words of a route as they stand; empty where there are none.
Result<std::vector<std::string>> route_words(std::string_view text, std::size_t route,
                                             const std::string& name);
// The words of [[style]] of that guest; none where there are none.
Result<std::optional<std::string>> style_words(std::string_view text, std::string_view guest,
                                               const std::string& name);

// How loud this house's music is, 0 to 1: in [music] where the file has that, else in [window], for
// the song that is practised to. 1 where nothing is said.
Result<double> music_volume(std::string_view text, const std::string& name);
// An error where the file has neither table.
Result<std::string> set_music_volume(std::string_view text, double volume, const std::string& name);

}  // namespace dance
