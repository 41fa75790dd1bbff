// dance music make as a user starts it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

TEST(MusicMake, NamesTheSoundfontThatIsMissing) {
  const TestFolder folder("music-make");
  const Finished finished =
      run(bin("dance") + " music make " + folder.path("songs") + " --soundfont /nowhere/none.sf2");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.talk.find("/nowhere/none.sf2"), std::string::npos) << finished.talk;
}

TEST(MusicMake, RefusesWhatIsNoSoundfont) {
  const TestFolder folder("music-make");
  std::ofstream(folder.path("notes.sf2")) << "these are no instruments at all\n";
  const Finished finished = run(bin("dance") + " music make --soundfont " +
                                folder.path("notes.sf2") + " " + folder.path("songs"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.talk.find("is no SoundFont"), std::string::npos) << finished.talk;
}

TEST(MusicMake, NamesTheStylesWhereOneIsNotKnown) {
  const TestFolder folder("music-make");
  std::ofstream(folder.path("none.sf2")) << "RIFF0000sfbk";
  const Finished finished = run(bin("dance-music-make") + " --style polka --soundfont " +
                                folder.path("none.sf2") + " " + folder.path("songs"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.talk.find("polka"), std::string::npos) << finished.talk;
  EXPECT_NE(finished.talk.find("kizomba"), std::string::npos) << finished.talk;
}

TEST(MusicMake, MakesSongsThatCanBeLearntFrom) {
  const std::string soundfont = "/usr/share/sounds/sf2/TimGM6mb.sf2";
  if (!std::filesystem::exists(soundfont) || !std::filesystem::exists("/usr/bin/fluidsynth"))
    GTEST_SKIP() << "no instruments here: apt-get install fluidsynth timgm6mb-soundfont";
  const TestFolder folder("music-make");
  const Finished made =
      run(bin("dance-music-make") + " " + folder.path("songs") +
          " --of-each 1 --seconds 20 --style salsa --style tango --soundfont " + soundfont);
  ASSERT_EQ(made.exit_code, 0) << made.talk;
  EXPECT_NE(made.talk.find("2 songs"), std::string::npos) << made.talk;
  std::string songs;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path("songs")))
    if (entry.path().extension() == ".ogg" && entry.path().filename().string().starts_with("salsa"))
      songs += " " + entry.path().string();
  ASSERT_FALSE(songs.empty());
  const Finished trained = run(bin("dance-music-train") + songs + " --made" + songs + " -o " +
                               folder.path("own.model") + " --rounds 1 --patterns 1");
  EXPECT_EQ(trained.exit_code, 0) << trained.talk;
}

}  // namespace
}  // namespace dance
