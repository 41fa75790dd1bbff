#include "house/session_window.h"

#include <algorithm>
#include <filesystem>

#include "producers/music/band/band_song.h"
#include "viewer/scene/place.h"

namespace dance {
namespace {

constexpr std::size_t kMostServerBytes = 262;  // a host name, and a port

bool is_server_name(std::string_view text) {
  return !text.empty() && text.size() <= kMostServerBytes &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

bool is_language(const std::string& code) {
  return code.empty() || code == "en" || code == "es" || code == "de";
}

std::string window_file(TomlReader& reader, const char* key, const std::string& folder) {
  const std::string file = reader.string_or(key, "");
  return file.empty() ? file : (std::filesystem::path(folder) / file).string();
}

}  // namespace

std::optional<KnownRoom> KnownRoom::parse(std::string_view text) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos || !GuestId::parse(text.substr(0, at)) ||
      !is_server_name(text.substr(at + 1)))
    return std::nullopt;
  return KnownRoom{std::string(text.substr(0, at)), std::string(text.substr(at + 1))};
}

WindowChoices read_window(TomlReader& reader, const std::string& folder) {
  WindowChoices window;
  window.language = reader.string_or("language", "");
  if (!is_language(window.language)) reader.complain("language", "is en, es or de");
  for (const std::string& text : reader.strings("rooms", "[\"salsa@dance.example.org\"]")) {
    const auto room = KnownRoom::parse(text);
    if (!room)
      reader.complain("rooms", "'" + text + "' is no ROOM@HOST or ROOM@HOST:PORT");
    else if (std::find(window.rooms.begin(), window.rooms.end(), *room) == window.rooms.end())
      window.rooms.push_back(*room);
  }
  if (window.rooms.size() > WindowChoices::kMostRooms)
    reader.complain("rooms", "are at most " + std::to_string(WindowChoices::kMostRooms));
  window.partner = reader.string_or("partner", window.partner);
  if (window.partner.empty()) reader.complain("partner", "is lead, follow or a file");
  if (window.partner != "lead" && window.partner != "follow")
    window.partner = (std::filesystem::path(folder) / window.partner).string();
  window.band = reader.string_or("band", window.band);
  if (window.band != kNoBand && !band_style_of(window.band))
    reader.complain("band", "is one of: " + band_style_names() + ", none");
  window.music = window_file(reader, "music", folder);
  window.mirror = reader.bool_or("mirror", window.mirror);
  window.teacher = window_file(reader, "teacher", folder);
  window.place = reader.string_or("place", window.place);
  if (!parse_place(window.place)) reader.complain("place", "is one of: " + std::string(kPlaceList));
  window.letters = reader.number_or("letters", window.letters, WindowChoices::kSmallestLetters,
                                    WindowChoices::kLargestLetters);
  window.width_px = static_cast<int>(reader.integer_or(
      "width", window.width_px, WindowChoices::kLeastWidth_px, WindowChoices::kMost_px));
  window.height_px = static_cast<int>(reader.integer_or(
      "height", window.height_px, WindowChoices::kLeastHeight_px, WindowChoices::kMost_px));
  reader.finish();
  return window;
}

}  // namespace dance
