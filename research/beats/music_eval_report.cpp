#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/program/figures.h"
#include "research/beats/music_eval.h"

namespace dance {
namespace {

template <class Of>
double mean_over(const std::vector<SongEval>& songs, Of of) {
  double sum = 0.0;
  for (const SongEval& song : songs) sum += of(song);
  return songs.empty() ? 0.0 : sum / static_cast<double>(songs.size());
}

bool all_have_aubio(const std::vector<SongEval>& songs) {
  return std::all_of(songs.begin(), songs.end(), [](const SongEval& s) { return s.aubio; });
}

std::optional<bool> all_causal(const std::vector<SongEval>& songs) {
  if (std::any_of(songs.begin(), songs.end(), [](const SongEval& s) { return !s.causal; }))
    return std::nullopt;
  return std::all_of(songs.begin(), songs.end(), [](const SongEval& s) { return *s.causal; });
}

nlohmann::ordered_json causal_json(std::optional<bool> causal) {
  return causal ? nlohmann::ordered_json(*causal) : nlohmann::ordered_json(nullptr);
}

bool all_have_steps(const std::vector<SongEval>& songs) {
  return std::all_of(songs.begin(), songs.end(), [](const SongEval& s) { return s.with_steps; });
}
double steps_f(const SongEval& song) {
  return song.with_steps ? song.with_steps->f_measure() : 0.0;
}
double aubio_f(const SongEval& song) { return song.aubio ? song.aubio->f_measure() : 0.0; }

nlohmann::ordered_json score_json(const BeatScore& score) {
  return {{"f_measure", rounded(score.f_measure(), 1e4)},
          {"mean_error_ms", rounded(score.mean_error_s * 1e3, 1e2)},
          {"sd_error_ms", rounded(score.sd_error_s * 1e3, 1e2)}};
}

nlohmann::ordered_json level_json(const BeatLevel& level) {
  return {{"half", rounded(level.half, 1e4)},
          {"double", rounded(level.twice, 1e4)},
          {"off_beat", rounded(level.off_beat, 1e4)}};
}

nlohmann::ordered_json song_json(const SongEval& song) {
  nlohmann::ordered_json out{{"file", song.name}};
  if (!song.genre.empty()) out["genre"] = song.genre;
  out["f_measure"] = rounded(song.score.f_measure(), 1e4);
  out["level_errors"] = level_json(song.level);
  out["tempo_bpm"] = rounded(song.tempo_bpm, 1e2);
  out["tempo_error_percent"] = rounded(song.tempo_error_percent, 1e2);
  out["mean_error_ms"] = rounded(song.score.mean_error_s * 1e3, 1e2);
  out["sd_error_ms"] = rounded(song.score.sd_error_s * 1e3, 1e2);
  out["causal"] = causal_json(song.causal);
  out["us_per_hop"] = rounded(song.us_per_hop, 10.0);
  if (song.with_steps) {
    out["with_steps"] = score_json(*song.with_steps);
    out["with_steps"]["level_errors"] = level_json(song.level_with_steps);
  }
  if (song.aubio) {
    out["baseline_aubio"] = score_json(*song.aubio);
    out["baseline_aubio"]["level_errors"] = level_json(song.aubio_level);
  } else {
    out["baseline_aubio"] = nullptr;
  }
  return out;
}

}  // namespace

std::string music_eval_table(const std::vector<SongEval>& songs) {
  std::string out =
      fmt::format("  {:<32} {:>6} {:>9} {:>8} {:>9} {:>8} {:>7} {:>8} {:>8}\n", "song", "F",
                  "tempo BPM", "off by", "mean ms", "sd ms", "causal", "F steps", "F aubio");
  const auto row = [&](const std::string& name, double f, const std::string& tempo, double off,
                       double mean_ms, double sd_ms, std::optional<bool> causal,
                       const std::string& steps, const std::string& aubio) {
    out += fmt::format("  {:<32} {:>6.3f} {:>9} {:>7.2f}% {:>+9.1f} {:>8.1f} {:>7} {:>8} {:>8}\n",
                       name, f, tempo, off, mean_ms, sd_ms,
                       !causal   ? "-"
                       : *causal ? "yes"
                                 : "NO",
                       steps, aubio);
  };
  for (const SongEval& song : songs)
    row(song.name, song.score.f_measure(), fmt::format("{:.1f}", song.tempo_bpm),
        song.tempo_error_percent, song.score.mean_error_s * 1e3, song.score.sd_error_s * 1e3,
        song.causal, song.with_steps ? fmt::format("{:.3f}", song.with_steps->f_measure()) : "-",
        song.aubio ? fmt::format("{:.3f}", song.aubio->f_measure()) : "-");
  if (songs.size() > 1)
    row("mean", mean_over(songs, [](const SongEval& s) { return s.score.f_measure(); }), "",
        mean_over(songs, [](const SongEval& s) { return s.tempo_error_percent; }),
        mean_over(songs, [](const SongEval& s) { return s.score.mean_error_s * 1e3; }),
        mean_over(songs, [](const SongEval& s) { return s.score.sd_error_s * 1e3; }),
        all_causal(songs),
        all_have_steps(songs) ? fmt::format("{:.3f}", mean_over(songs, steps_f)) : "-",
        all_have_aubio(songs) ? fmt::format("{:.3f}", mean_over(songs, aubio_f)) : "-");
  out += fmt::format(
      "\n  beats within 70 ms, first 5 s left out; {:.0f} us of one core a hop of 10 ms\n",
      mean_over(songs, [](const SongEval& s) { return s.us_per_hop; }));
  out += music_eval_genres(songs);
  for (const SongEval& song : songs)
    if (!song.aubio) {
      out += "  " + song.aubio_missing + "\n";
      break;
    }
  return out;
}

std::string music_eval_json(const std::vector<SongEval>& songs) {
  nlohmann::ordered_json report;
  if (songs.size() == 1) {
    report = song_json(songs.front());
  } else {
    report["f_measure"] =
        rounded(mean_over(songs, [](const SongEval& s) { return s.score.f_measure(); }), 1e4);
    report["tempo_bpm"] =
        rounded(mean_over(songs, [](const SongEval& s) { return s.tempo_bpm; }), 1e2);
    report["tempo_error_percent"] =
        rounded(mean_over(songs, [](const SongEval& s) { return s.tempo_error_percent; }), 1e2);
    report["mean_error_ms"] = rounded(
        mean_over(songs, [](const SongEval& s) { return s.score.mean_error_s; }) * 1e3, 1e2);
    report["sd_error_ms"] =
        rounded(mean_over(songs, [](const SongEval& s) { return s.score.sd_error_s; }) * 1e3, 1e2);
    report["causal"] = causal_json(all_causal(songs));
    if (all_have_aubio(songs))
      report["baseline_aubio"] = {{"f_measure", rounded(mean_over(songs, aubio_f), 1e4)}};
    else
      report["baseline_aubio"] = nullptr;
    for (const SongEval& song : songs) report["files"].push_back(song_json(song));
  }
  for (const SongEval& song : songs)
    if (!song.aubio) report["baseline_aubio_missing"] = song.aubio_missing;
  return report.dump(2) + "\n";
}

}  // namespace dance
