// dance band eval: the house band's beats, loudness and cost, style by style.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "producers/music/band/band_file.h"
#include "research/beats/loudness.h"
#include "research/beats/music_eval.h"
#include "testing/scratch_folder.h"

namespace dance {
namespace {

constexpr const char* kBandEvalExamples = R"(Examples:
  dance band eval
  dance band eval --style tango --seed 3 --seconds 120 --out /tmp/band
  dance band eval --own
)";

struct BandEvalOptions {
  std::vector<std::string> styles;
  int seed = 1;
  double seconds = 60.0;
  std::string out;
  bool own = false;
};

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Rendered {
  double load_percent = 0.0;  // of one core in real time
  double lufs = 0.0;
  float peak = 0.0f;
};

// Reads piece by piece, as a player does.
Rendered render(BandAudio& audio, std::int64_t frames) {
  std::vector<float> all;
  std::vector<float> piece(2 * 480);
  const double begin_s = processor_s();
  for (std::int64_t at = 0; at + 480 <= frames; at += 480) {
    audio.read_stereo(at, piece);
    all.insert(all.end(), piece.begin(), piece.end());
  }
  const double spent_s = processor_s() - begin_s;
  Rendered rendered{100.0 * spent_s * kBandRate_hz / static_cast<double>(frames),
                    loudness_lufs(all)};
  for (const float sample : all) rendered.peak = std::max(rendered.peak, std::abs(sample));
  return rendered;
}

Result<void> evaluate(BandStyle style, int tempo_bpm, const BandEvalOptions& options,
                      const BandSound& sound, const std::string& folder) {
  const BandSong song = band_song(style, static_cast<std::uint32_t>(options.seed), tempo_bpm);
  const auto score = std::make_shared<const BandScore>(BandScore::make(song));
  DANCE_TRY(const auto audio, BandAudio::make(score, sound));
  const int bars = std::min(
      score->bars(), score->bar_at(static_cast<std::int64_t>(options.seconds * kBandRate_hz)) + 1);
  const Rendered rendered = render(*audio, score->bar_begin_frame(bars));
  const std::string wav = fmt::format("{}/{}_{}.wav", folder, name_of(style), tempo_bpm);
  if (auto written = write_band_file(wav, *audio, {0, bars, 2}); !written) return written;
  MusicEvalOptions judged;
  judged.check_causal = false;
  DANCE_TRY(const SongEval eval,
            evaluate_song(wav, wav.substr(0, wav.size() - 3) + "beats", judged));
  const std::string aubio =
      eval.aubio ? fmt::format("{:8.3f}", eval.aubio->f_measure()) : std::string("       -");
  fmt::print("  {:<10}{:>5}{:>10.3f}{:>9.1f}{:>8.1f}{}{:>9.1f}{:>7.2f}{:>8.2f}\n", name_of(style),
             tempo_bpm, eval.score.f_measure(), eval.tempo_bpm, 1e3 * eval.score.mean_error_s,
             aubio, rendered.lufs, rendered.peak, rendered.load_percent);
  std::fflush(stdout);
  return {};
}

Result<void> run(const BandEvalOptions& options) {
  std::vector<BandStyle> styles;
  for (const std::string& name : options.styles) {
    const auto style = band_style_of(name);
    if (!style) return fail(name + ": no style of the band");
    styles.push_back(*style);
  }
  if (styles.empty())
    for (int i = 0; i < kBandStyles; ++i) styles.push_back(static_cast<BandStyle>(i));
  DANCE_TRY(const auto scratch, ScratchFolder::make());
  const std::string folder = options.out.empty() ? scratch->file("band") : options.out;
  std::filesystem::create_directories(folder);
  const BandSound sound = options.own ? BandSound{} : best_band_sound();
  fmt::print("  {}\n  {:<10}{:>5}{:>10}{:>9}{:>8}{:>8}{:>9}{:>7}{:>8}\n",
             sound.soundfont.empty() ? "own percussion" : sound.soundfont, "style", "BPM",
             "F tracker", "tracked", "mean ms", "F aubio", "LUFS", "peak", "% core");
  for (const BandStyle style : styles)
    for (const int percent : {80, 100, 120}) {
      const int tempo_bpm = usual_tempo_bpm(style) * percent / 100;
      if (auto done = evaluate(style, tempo_bpm, options, sound, folder); !done) return done;
    }
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::BandEvalOptions options;
  dance::CommandLine line("The house band's beats, loudness and cost, style by style.",
                          "dance band eval");
  line.add("--style", options.styles, "salsa, bachata, ...; once for each; without it all")
      .one_each_time();
  line.add("--seed", options.seed, "which songs").range(0, 1'000'000).shows_default();
  line.add("--seconds", options.seconds, "of each song").range(10.0, 300.0).shows_default();
  line.add("--out", options.out, "keeps the songs in this folder, to listen to");
  line.add_flag("--own", options.own, "the band's own percussion, not a soundfont");
  line.footer(dance::kBandEvalExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(options); });
}
