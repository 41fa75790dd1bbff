// dance music make: makes songs whose beats are known, for the beat tracker to learn from.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "core/program/whole_file.h"
#include "research/beats/make/song_maker.h"
#include "research/outside_program.h"
#include "testing/scratch_folder.h"

namespace dance {
namespace {

constexpr const char* kMusicMakeExamples = R"(Examples:
  dance music make songs
  dance music make songs --of-each 2 --seed 7 --soundfont /usr/share/sounds/sf2/TimGM6mb.sf2
  dance music make kept --kept-back --style salsa --style cumbia
)";

struct MusicMakeWishes {
  std::string folder;
  std::vector<std::string> soundfonts{"/usr/share/sounds/sf2/FluidR3_GM.sf2",
                                      "/usr/share/sounds/sf2/TimGM6mb.sf2"};
  std::vector<std::string> styles;  // none: all
  bool is_kept_back = false;
  bool is_mixed = false;
  int of_each = 5;
  int seed = 1;
  double seconds = 60.0;

  SongUse use() const {
    return is_kept_back ? SongUse::kKeptBack : is_mixed ? SongUse::kMixed : SongUse::kTaught;
  }
};

// fluidsynth ends well whatever it was given, and plays another font or none.
bool is_soundfont(const std::string& path) {
  std::string head(12, '\0');
  std::ifstream(path, std::ios::binary)
      .read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.substr(0, 4) == "RIFF" && head.substr(8) == "sfbk";
}

Result<void> render(const MadeSong& song, const SongStyle& style, const std::string& stem,
                    const std::string& soundfont) {
  DANCE_TRY(const auto scratch, ScratchFolder::make());
  const std::string midi = scratch->file("song.mid");
  if (auto ok = write_whole_file(midi, write_midi(song)); !ok) return ok;
  const std::string ogg = stem + ".ogg";
  std::error_code error;
  std::filesystem::remove(ogg, error);
  if (auto ok = run_outside_program({.name = "fluidsynth",
                                     .package = "fluidsynth",
                                     .arguments = {"-ni", "-q", "-g", "0.5", "-r", "44100", "-T",
                                                   "oga", "-F", ogg, soundfont, midi},
                                     .output_file = scratch->file("out"),
                                     .talk_file = scratch->file("talk")});
      !ok)
    return ok;
  if (const auto size = std::filesystem::file_size(ogg, error); error || size == 0)
    return fail(ogg + ": fluidsynth wrote nothing; is there room, and may one write there?");
  std::string beats = "# made: the beats are exact\n# genre: " + style.name + "\n";
  for (std::size_t i = 0; i < song.beats_s.size(); ++i)
    beats += fmt::format("{:.4f}\t{}\n", song.beats_s[i], i % 4 + 1);
  return write_whole_file(stem + ".beats", beats);
}

Result<std::vector<const SongStyle*>> styles_of(const MusicMakeWishes& wishes) {
  std::vector<const SongStyle*> styles;
  const std::vector<SongStyle>& all = song_styles();
  for (const SongStyle& style : all)
    if (wishes.styles.empty()) styles.push_back(&style);
  for (const std::string& name : wishes.styles) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const SongStyle& style) { return style.name == name; });
    if (found == all.end()) {
      std::string names;
      for (const SongStyle& style : all) names += " " + style.name;
      return fail("there is no style " + name + "; there are" + names);
    }
    styles.push_back(&*found);
  }
  return styles;
}

Result<void> run(const MusicMakeWishes& wishes) {
  for (const std::string& soundfont : wishes.soundfonts) {
    if (!std::filesystem::exists(soundfont))
      return fail(soundfont +
                  ": no such file: apt-get install fluid-soundfont-gm timgm6mb-soundfont, "
                  "or name another with --soundfont");
    if (!is_soundfont(soundfont))
      return fail(soundfont + ": is no SoundFont; name an .sf2 file with --soundfont");
  }
  DANCE_TRY(const std::vector<const SongStyle*> styles, styles_of(wishes));
  std::error_code error;
  std::filesystem::create_directories(wishes.folder, error);
  if (error) return fail(wishes.folder + ": cannot be made, " + error.message());
  std::uint64_t number = 0;
  for (int turn = 0; turn < wishes.of_each; ++turn)
    for (std::size_t i = 0; i < styles.size(); ++i) {
      const SongStyle& style = *styles[i];
      const auto seed = static_cast<std::uint64_t>(wishes.seed) * 1'000'000 + number;
      const MadeSong song = make_song(style, wishes.seconds, seed, wishes.use());
      const std::string stem =
          fmt::format("{}/{}_{}_{:.0f}", wishes.folder, style.name, turn + 1, song.tempo_bpm);
      // Each style is played on each of them in turn.
      const std::size_t font = (i + static_cast<std::size_t>(turn)) % wishes.soundfonts.size();
      if (auto ok = render(song, style, stem, wishes.soundfonts[font]); !ok) return ok;
      ++number;
    }
  talk::info("{}: {} songs", wishes.folder, number);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::MusicMakeWishes wishes;
  dance::CommandLine line("makes songs whose beats are known, for the beat tracker to learn from",
                          "dance music make");
  line.add("FOLDER", wishes.folder, "where the songs go, each with its .beats file").required();
  line.add("--style", wishes.styles, "songs of this style only, once for each").one_each_time();
  line.add_flag("--kept-back", wishes.is_kept_back,
                "to judge by: rows and instruments that others never have, and mixed ones seldom");
  line.add_flag("--mixed", wishes.is_mixed,
                "half of the songs borrow rows, drums and instruments from other styles");
  line.add("--of-each", wishes.of_each, "songs of each style").range(1, 100).shows_default();
  line.add("--seconds", wishes.seconds, "how long each is").range(20.0, 600.0).shows_default();
  line.add("--seed", wishes.seed, "another number makes other songs")
      .range(0, 1000000)
      .shows_default();
  line.add("--soundfont", wishes.soundfonts, "the instruments, taken in turn").one_each_time();
  line.footer(dance::kMusicMakeExamples);
  line.finally([&]() -> dance::Result<void> {
    if (wishes.is_mixed && wishes.is_kept_back)
      return dance::fail("--kept-back and --mixed exclude each other: what borrows keeps nothing");
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
