#include "producers/music/beats_file.h"

#include <array>
#include <charconv>
#include <vector>

#include "core/base/take_line.h"
#include "core/program/whole_file.h"

namespace dance {
namespace {

constexpr std::size_t kMostBeatsFile_bytes = std::size_t{4} << 20;
constexpr std::size_t kLongestBeatQuote = 40;

tl::unexpected<Error> broken_beat_line(std::size_t line, const std::string& what,
                                       std::string_view text) {
  std::string quote(text.substr(0, kLongestBeatQuote));
  for (char& c : quote)
    if (c < ' ' || c > '~') c = ' ';
  return fail("line " + std::to_string(line) + ": " + what + ": '" + quote +
              "'; a beat is its seconds, a TAB, its position in the bar");
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

template <class T>
bool read_whole(std::string_view text, T& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && read.ec == std::errc() && read.ptr == text.data() + text.size();
}

}  // namespace

Result<BeatGrid> parse_beats(std::string_view text) {
  if (text.size() > kMostBeatsFile_bytes)
    return fail("more than 4 MiB; a list of beats is smaller");
  std::vector<GridBeat> beats;
  std::vector<std::size_t> lines;  // of each beat, for what is found wrong later
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view whole = take_line(text);
    const std::string_view line = trimmed(whole);
    if (line.empty() || line.starts_with('#')) continue;
    const std::size_t gap = line.find_first_of(" \t");
    GridBeat beat;
    if (!read_whole(line.substr(0, gap), beat.time_s))
      return broken_beat_line(number, "no time", whole);
    if (gap != std::string_view::npos && !read_whole(trimmed(line.substr(gap)), beat.position))
      return broken_beat_line(number, "no position in the bar", whole);
    if (beats.size() == BeatGrid::kMostBeats)
      return broken_beat_line(number, "more than 100000 beats", whole);
    beats.push_back(beat);
    lines.push_back(number);
    // What is wrong with a beat shows against the one before it.
    const std::size_t last = beats.size() - 1;
    if (last == 0) continue;
    const auto pair = BeatGrid::make(std::span(beats).subspan(last - 1));
    if (!pair) return broken_beat_line(number, pair.error().what, whole);
  }
  return BeatGrid::make(beats);
}

Result<BeatGrid> read_beats_file(const std::string& path) {
  DANCE_TRY(const std::string text, read_whole_file(path, kMostBeatsFile_bytes));
  auto grid = parse_beats(text);
  if (!grid) return fail(path + ": " + grid.error().what);
  return grid;
}

std::string beats_path_beside(const std::string& music_path) {
  const std::size_t slash = music_path.find_last_of('/');
  const std::size_t dot = music_path.find_last_of('.');
  const bool has_ending =
      dot != std::string::npos && dot > (slash == std::string::npos ? 0 : slash + 1);
  return music_path.substr(0, has_ending ? dot : std::string::npos) + ".beats";
}

}  // namespace dance
