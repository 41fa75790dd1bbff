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

// What all made songs count together, where all recorded ones count 1: each of them is one of many,
// and simpler.
constexpr float kMadeWeight = 1.5f;
// A recorded song teaches at these speeds: there are few, and a style is danced to at more tempi
// than one.
constexpr std::array kSpeeds{1.0, 0.88, 0.94, 1.06, 1.13};
// Beside the song as it is, so many others of how it may have been mastered.
constexpr std::size_t kStudios = 2;

struct Songs {
  std::vector<TrainingSong> recorded;  // each in all its ways, one after another
  std::vector<TrainingSong> made;
};

// Of a file that is heard in several ways, which one.
using WayOf = HeardAs (*)(const std::string& name, std::size_t file, std::size_t way,
                          std::uint64_t seed);

HeardAs way_of_recorded(const std::string& name, std::size_t, std::size_t way, std::uint64_t seed) {
  return {.speed = kSpeeds[way % kSpeeds.size()],
          .studio = way < kSpeeds.size() ? 0 : studio_of(name, way, seed)};
}

// There are many: each is heard in one way, every other one as a studio mastered it.
HeardAs way_of_made(const std::string& name, std::size_t file, std::size_t way,
                    std::uint64_t seed) {
  return {.speed = 1.0, .studio = file % 2 == 0 ? 0 : studio_of(name, way, seed)};
}

// All of them count `weight` together.
Result<std::vector<TrainingSong>> load_songs(const std::vector<std::string>& files, float weight,
                                             std::size_t ways, WayOf way_of, std::uint64_t seed) {
  std::vector<Result<TrainingSong>> loaded(files.size() * ways, fail("was not loaded"));
  in_two_threads(loaded.size(), [&](std::size_t i) {
    const std::string& file = files[i / ways];
    const std::string name = std::filesystem::path(file).filename().string();
    loaded[i] =
        load_training_song(file, beats_path_beside(file), way_of(name, i / ways, i % ways, seed));
  });
  std::vector<TrainingSong> songs;
  for (Result<TrainingSong>& song : loaded) {
    if (!song) return tl::make_unexpected(song.error());
    song->weight = weight / static_cast<float>(loaded.size());
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
  DANCE_TRY(songs.recorded, load_songs(wishes.files, 1.0f, kSpeeds.size() * (1 + kStudios),
                                       way_of_recorded, wishes.training.seed));
  DANCE_TRY(songs.made, load_songs(wishes.made, kMadeWeight, 1, way_of_made, wishes.training.seed));
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
  line.add("--made", wishes.made, "songs of dance music make: they are never held out");
  line.add("--rounds", wishes.training.rounds,
           "batches of 32 parts of songs, of 20 s, that the network is taught")
      .range(1, 100000)
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
