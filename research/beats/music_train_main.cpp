// dance music train: makes the beat tracker's model from songs whose beats are known, or says how
// good one is on songs that it was not made from.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "core/program/whole_file.h"
#include "producers/music/beats_file.h"
#include "research/beats/beat_model_file.h"
#include "research/beats/music_eval.h"
#include "research/beats/music_training.h"
#include "research/in_two_threads.h"

namespace dance {
namespace {

constexpr const char* kMusicTrainExamples = R"(Examples:
  dance music train songs/*.ogg -o beats.model
  dance music eval other/*.ogg --model beats.model
  dance music train songs/*.ogg --made made/*.ogg -o beats.model
  dance music train songs/*.ogg --made made/*.ogg --hold-out 5
)";

struct MusicTrainWishes {
  std::vector<std::string> files;
  std::vector<std::string> made;
  std::string out = "beats.model";
  int hold_out = 0;
  MusicTraining training;
};

// A made song teaches less than a recorded one: it is one of many, and simpler.
constexpr float kMadeWeight = 0.2f;
// A recorded song teaches at these speeds: there are few, and a style is danced to at more tempi
// than one.
constexpr std::array kSpeeds{1.0, 0.88, 1.13};
// Beside the song as it is, so many others of how it may have been mastered.
constexpr std::size_t kStudios = 2;
constexpr std::size_t kMadeStudios = 1;  // of a made song, of which there are many

struct Songs {
  std::vector<TrainingSong> recorded;  // each in all its ways, one after another
  std::vector<TrainingSong> made;
};

Result<std::vector<TrainingSong>> load_songs(const std::vector<std::string>& files, float weight,
                                             std::span<const double> speeds, std::size_t studios,
                                             std::uint64_t seed) {
  const std::size_t ways = speeds.size() * (1 + studios);
  std::vector<Result<TrainingSong>> loaded(files.size() * ways, fail("was not loaded"));
  in_two_threads(loaded.size(), [&](std::size_t i) {
    const std::string& file = files[i / ways];
    const std::size_t way = i % ways;
    const HeardAs heard_as{
        .speed = speeds[way % speeds.size()],
        .studio = way < speeds.size()
                      ? 0
                      : studio_of(std::filesystem::path(file).filename().string(), way, seed)};
    loaded[i] = load_training_song(file, beats_path_beside(file), heard_as);
  });
  std::vector<TrainingSong> songs;
  for (Result<TrainingSong>& song : loaded) {
    if (!song) return tl::make_unexpected(song.error());
    // A song's ways weigh as much together as one at each speed would.
    song->weight = weight / static_cast<float>(1 + studios);
    songs.push_back(std::move(*song));
  }
  return songs;
}

// From songs of every part but one; from all of them where nothing is held out.
Result<BeatModel> train_without(const Songs& songs, const MusicTrainWishes& wishes,
                                std::size_t without) {
  std::vector<const TrainingSong*> chosen;
  const auto parts = static_cast<std::size_t>(std::max(1, wishes.hold_out));
  for (std::size_t i = 0; i < songs.recorded.size(); ++i)
    if (i / (kSpeeds.size() * (1 + kStudios)) % parts != without || wishes.hold_out == 0)
      chosen.push_back(&songs.recorded[i]);
  for (const TrainingSong& song : songs.made) chosen.push_back(&song);
  return train_beats(chosen, wishes.training);
}

// Each song tracked by a model that was made without it.
Result<std::vector<SongEval>> hold_out(const Songs& songs, const MusicTrainWishes& wishes) {
  const auto parts = static_cast<std::size_t>(wishes.hold_out);
  std::vector<Result<SongEval>> evals(wishes.files.size(), fail("was not tracked"));
  in_two_threads(parts, [&](std::size_t part) {
    const auto model = train_without(songs, wishes, part);
    for (std::size_t i = part; i < evals.size(); i += parts) {
      if (!model) {
        evals[i] = tl::make_unexpected(model.error());
        continue;
      }
      MusicEvalOptions options;
      options.with_aubio = false;
      options.check_causal = false;
      options.model = std::make_shared<BeatModel>(*model);
      evals[i] = evaluate_song(wishes.files[i], beats_path_beside(wishes.files[i]), options);
    }
  });
  std::vector<SongEval> whole;
  for (auto& eval : evals) {
    if (!eval) return tl::make_unexpected(eval.error());
    whole.push_back(std::move(*eval));
  }
  return whole;
}

Result<void> run(MusicTrainWishes wishes) {
  if (wishes.hold_out == 0)
    if (auto possible = try_whole_file(wishes.out); !possible) return possible;
  Songs songs;
  DANCE_TRY(songs.recorded,
            load_songs(wishes.files, 1.0f, kSpeeds, kStudios, wishes.training.seed));
  DANCE_TRY(songs.made, load_songs(wishes.made, kMadeWeight, std::array{1.0}, kMadeStudios,
                                   wishes.training.seed));
  if (wishes.hold_out > 0) {
    DANCE_TRY(const std::vector<SongEval> evals, hold_out(songs, wishes));
    const std::string text = music_eval_table(evals);
    std::fwrite(text.data(), 1, text.size(), stdout);
    return {};
  }
  wishes.training.tell = [](const std::string& line) { talk::info("{}", line); };
  DANCE_TRY(const BeatModel model, train_without(songs, wishes, 0));
  if (auto written = write_beat_model_file(model, wishes.out); !written) return written;
  DANCE_TRY(const auto read, read_beat_model_file(wishes.out));
  talk::info("{}: model {:08x}, {} patterns from {} songs", wishes.out, read->name,
             read->patterns.size(), wishes.files.size() + wishes.made.size());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::MusicTrainWishes wishes;
  dance::CommandLine line("makes the beat tracker's model from songs whose beats are known",
                          "dance music train");
  line.add("AUDIO", wishes.files, "files of music, each with its .beats file beside it").required();
  line.add("-o,--out", wishes.out, "where the model goes").shows_default();
  line.add("--made", wishes.made,
           "songs of dance music make: they count a quarter each, and are never held out");
  line.add("--rounds", wishes.training.rounds, "how often the network sees each moment")
      .range(1, 100)
      .shows_default();
  line.add("--patterns", wishes.training.patterns, "how many kinds of bars there are")
      .range(1, 32)
      .shows_default();
  line.add("--seed", wishes.training.seed, "another number begins elsewhere, in other studios")
      .range(1, 1000000)
      .shows_default();
  line.add("--hold-out", wishes.hold_out,
           "makes no model, but tracks each of so many parts of the songs with one made from the "
           "others")
      .range(2, 100);
  line.footer(dance::kMusicTrainExamples);
  line.finally([&]() -> dance::Result<void> {
    if (wishes.hold_out > static_cast<int>(wishes.files.size()))
      return dance::fail("--hold-out wants at least as many songs as parts");
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
