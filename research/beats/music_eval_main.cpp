// dance music eval: the beat tracker on songs whose beats are known.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "producers/music/beats_file.h"
#include "research/beats/beat_model_file.h"
#include "research/beats/music_eval.h"

namespace dance {
namespace {

constexpr const char* kMusicEvalExamples = R"(Examples:
  dance music eval song.ogg --beats song.beats
  dance music eval *.ogg
  dance music eval a.ogg --beats a.beats b.wav --beats b.beats --json
  dance music eval *.ogg --model beats.model
  dance music eval song.ogg --speed 1.1 --noise -40
  dance music eval song.ogg --dancer lead.bvh --dancer follow.bvh
)";

struct MusicEvalWishes {
  std::vector<std::string> files;
  std::vector<std::string> beats;
  std::vector<std::string> dancers;
  std::string model;
  MusicEvalOptions options;
  bool tracker_only = false;
  bool json = false;
};

Result<void> run(MusicEvalWishes wishes) {
  if (!wishes.model.empty()) {
    DANCE_TRY(wishes.options.model, read_beat_model_file(wishes.model));
  }
  wishes.options.with_aubio = !wishes.tracker_only;
  wishes.options.check_causal = !wishes.tracker_only;
  if (!wishes.dancers.empty()) {
    DANCE_TRY(wishes.options.dancers, load_step_takes(wishes.dancers));
  }
  std::vector<SongEval> songs;
  for (std::size_t i = 0; i < wishes.files.size(); ++i) {
    const std::string beats =
        wishes.beats.empty() ? beats_path_beside(wishes.files[i]) : wishes.beats[i];
    wishes.options.couple = i;
    DANCE_TRY(SongEval song, evaluate_song(wishes.files[i], beats, wishes.options));
    songs.push_back(std::move(song));
  }
  const std::string text = wishes.json ? music_eval_json(songs) : music_eval_table(songs);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::MusicEvalWishes wishes;
  dance::CommandLine line("The beat tracker on songs whose beats are known, beside aubio.",
                          "dance music eval");
  line.add("AUDIO", wishes.files, "files of music: WAV, FLAC, Ogg, MP3").required();
  line.add("--beats", wishes.beats,
           "the true beats, once for each AUDIO in their order; without it, song.beats beside "
           "song.ogg")
      .one_each_time();
  line.add("--speed", wishes.options.speed, "plays faster or slower, as a record does")
      .range(0.5, 2.0);
  line.add("--gain", wishes.options.gain_db, "decibels louder").range(-60.0, 40.0);
  line.add("--noise", wishes.options.noise_db, "decibels of full scale of added white noise")
      .range(-200.0, 0.0);
  line.add("--start", wishes.options.start_s, "begins so many seconds into the file")
      .range(0.0, 3600.0);
  line.add("--steps", wishes.options.told_steps_weight,
           "each song once more, with the true tempo told as dancers who step on each beat would, "
           "of this weight")
      .range(0.0, 1.0);
  line.add("--dancer", wishes.dancers,
           "each song once more, with a couple of these takes that steps on each beat, as it is "
           "seen; once for each take, and all leads before all follows")
      .one_each_time();
  line.add("--model", wishes.model, "a model of dance music train, instead of the built in one");
  line.add_flag("--tracker-only", wishes.tracker_only,
                "without aubio and the look at causality: takes a third of the time");
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kMusicEvalExamples);
  line.finally([&]() -> dance::Result<void> {
    if (wishes.dancers.size() % 2 != 0)
      return dance::fail("--dancer wants couples: as many leads as follows");
    if (!wishes.beats.empty() && wishes.beats.size() != wishes.files.size())
      return dance::fail("--beats wants one .beats file for each AUDIO, in their order");
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
