#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "research/beats/music_eval.h"

namespace dance {
namespace {

// What the songs of one kind come to.
struct GenreSum {
  int songs = 0;
  int wrong_songs = 0;
  double f = 0.0;
  double worst_f = 1.0;
  double tempo_off = 0.0;
  BeatLevel level;
  int stepped_songs = 0;
  int stepped_wrong_songs = 0;
  double stepped_f = 0.0;
  double stepped_worst_f = 1.0;
  int aubio_songs = 0;
  int aubio_wrong_songs = 0;
  double aubio_f = 0.0;

  void add(const SongEval& song) {
    ++songs;
    wrong_songs += song.level.wrong() > kWrongLevelShare;
    f += song.score.f_measure();
    worst_f = std::min(worst_f, song.score.f_measure());
    tempo_off += song.tempo_error_percent;
    level.half += song.level.half;
    level.twice += song.level.twice;
    level.off_beat += song.level.off_beat;
    if (song.with_steps) {
      const double stepped = song.with_steps->f_measure();
      ++stepped_songs;
      stepped_wrong_songs += song.level_with_steps.wrong() > kWrongLevelShare;
      stepped_f += stepped;
      stepped_worst_f = std::min(stepped_worst_f, stepped);
    }
    if (!song.aubio) return;
    ++aubio_songs;
    aubio_wrong_songs += song.aubio_level.wrong() > kWrongLevelShare;
    aubio_f += song.aubio->f_measure();
  }
};

std::string row_of(const std::string& name, const GenreSum& sum) {
  const double n = sum.songs;
  const bool has_aubio = sum.aubio_songs == sum.songs;
  const bool is_stepped = sum.stepped_songs == sum.songs;
  return fmt::format(
      "  {:<12} {:>5} {:>6.3f} {:>6.3f} {:>7.2f}% {:>5.1f}% {:>5.1f}% {:>5.1f}% {:>6} {:>8} "
      "{:>6} {:>6} {:>8} {:>9}\n",
      name, sum.songs, sum.f / n, sum.worst_f, sum.tempo_off / n, 100.0 * sum.level.half / n,
      100.0 * sum.level.twice / n, 100.0 * sum.level.off_beat / n, sum.wrong_songs,
      is_stepped ? fmt::format("{:.3f}", sum.stepped_f / n) : "-",
      is_stepped ? fmt::format("{:.3f}", sum.stepped_worst_f) : "-",
      is_stepped ? std::to_string(sum.stepped_wrong_songs) : "-",
      has_aubio ? fmt::format("{:.3f}", sum.aubio_f / n) : "-",
      has_aubio ? std::to_string(sum.aubio_wrong_songs) : "-");
}

}  // namespace

std::string genre_of_beats_file(const std::string& path) {
  constexpr std::string_view kGenre = "# genre: ";
  std::ifstream file(path);
  for (std::string line; std::getline(file, line) && line.starts_with('#');)
    if (line.starts_with(kGenre)) return line.substr(kGenre.size());
  return "";
}

std::string music_eval_genres(const std::vector<SongEval>& songs) {
  std::map<std::string, GenreSum> genres;
  GenreSum recorded;
  GenreSum all;
  for (const SongEval& song : songs) {
    (song.genre.empty() ? recorded : genres[song.genre]).add(song);
    if (!song.genre.empty()) all.add(song);
  }
  if (genres.empty()) return "";
  std::string out = fmt::format(
      "\n  {:<12} {:>5} {:>6} {:>6} {:>8} {:>6} {:>6} {:>6} {:>6} {:>8} {:>6} {:>6} {:>8} {:>9}\n",
      "genre", "songs", "F", "worst", "off by", "half", "double", "off", "wrong", "F steps",
      "worst", "wrong", "F aubio", "its wrong");
  for (const auto& [name, sum] : genres) out += row_of(name, sum);
  if (genres.size() > 1) out += row_of("all", all);
  if (recorded.songs > 0) out += row_of("no genre", recorded);
  out += fmt::format(
      "\n  half, double, off: share of the time at half or double of the tempo, or between the "
      "beats; wrong: songs with\n  more than {:.0f} % of their time there; F steps, and behind it "
      "worst and wrong: with the dancers' steps\n",
      100.0 * kWrongLevelShare);
  return out;
}

}  // namespace dance
