// Names of files of music, by their endings.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

namespace dance {

inline bool has_music_ending(std::string name) {
  constexpr std::array<std::string_view, 7> kEndings = {".ogg", ".opus", ".flac", ".wav",
                                                        ".mp3", ".m4a",  ".aac"};
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(kEndings, [&](std::string_view it) { return name.ends_with(it); });
}

}  // namespace dance
