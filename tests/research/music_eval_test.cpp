// dance music eval as a user starts it, on a song that the test writes.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/research/song_on_disk.h"

namespace dance {
namespace {

TEST(MusicEval, SaysWhatTheContractSays) {
  const SongOnDisk song;
  const Finished finished = run(bin("dance") + " music eval " + song.folder.path("song.wav") +
                                " --beats " + song.folder.path("song.beats") + " --json");
  ASSERT_EQ(finished.exit_code, 0) << finished.talk;
  const auto report = nlohmann::json::parse(finished.output);
  EXPECT_GE(report["f_measure"].get<double>(), 0.95);
  EXPECT_NEAR(report["tempo_bpm"].get<double>(), 148.0, 2.0);
  EXPECT_LE(report["tempo_error_percent"].get<double>(), 2.0);
  EXPECT_LE(std::abs(report["mean_error_ms"].get<double>()), 15.0);
  EXPECT_LE(report["sd_error_ms"].get<double>(), 15.0);
  EXPECT_TRUE(report["causal"].get<bool>());
  // Where aubio is not there, the report says so.
  if (report["baseline_aubio"].is_null())
    EXPECT_FALSE(report["baseline_aubio_missing"].get<std::string>().empty());
  else
    EXPECT_TRUE(report["baseline_aubio"].contains("f_measure"));
}

TEST(MusicEval, TakesSeveralSongsAndMeansThem) {
  const SongOnDisk song;
  const std::string audio = song.folder.path("song.wav");
  const std::string beats = song.folder.path("song.beats");
  const Finished finished = run(bin("dance-music-eval") + " " + audio + " --beats " + beats + " " +
                                audio + " --beats " + beats + " --json --speed 1.05");
  ASSERT_EQ(finished.exit_code, 0) << finished.talk;
  const auto report = nlohmann::json::parse(finished.output);
  ASSERT_EQ(report["files"].size(), 2u);
  EXPECT_EQ(report["f_measure"], report["files"][0]["f_measure"]);
  EXPECT_NEAR(report["tempo_bpm"].get<double>(), 148.0 * 1.05, 3.0);
}

TEST(MusicEval, SaysByGenreHowOftenTheLevelIsWrong) {
  const SongOnDisk song;
  const std::string audio = song.folder.path("song.wav");
  const auto with_genre = [&](const std::string& name, const std::string& genre, int every) {
    std::ofstream file(song.folder.path(name));
    file << "# made: for a test\n# genre: " << genre << "\n";
    const auto beats = DrumMusic::steady(14.0, 148.0);
    for (std::size_t i = 0; i < beats.size(); i += static_cast<std::size_t>(every))
      file << beats[i] << "\n";
    return song.folder.path(name);
  };
  // The second list claims that each other beat is one.
  const std::string lists = audio + " --beats " + with_genre("right.beats", "cumbia", 1) + " " +
                            audio + " --beats " + with_genre("wrong.beats", "kizomba", 2);
  const Finished table = run(bin("dance-music-eval") + " " + lists + " --tracker-only");
  ASSERT_EQ(table.exit_code, 0) << table.talk;
  EXPECT_NE(table.output.find("\n  cumbia "), std::string::npos) << table.output;
  EXPECT_NE(table.output.find("\n  kizomba "), std::string::npos) << table.output;
  const Finished finished = run(bin("dance-music-eval") + " " + lists + " --tracker-only --json");
  ASSERT_EQ(finished.exit_code, 0) << finished.talk;
  const auto report = nlohmann::json::parse(finished.output);
  EXPECT_EQ(report["files"][0]["genre"], "cumbia");
  EXPECT_EQ(report["files"][0]["level_errors"]["double"].get<double>(), 0.0);
  EXPECT_GT(report["files"][1]["level_errors"]["double"].get<double>(), 0.9);
  EXPECT_TRUE(report["files"][0]["causal"].is_null()) << "not asked for";
}

TEST(MusicEval, HearsASongOnceMoreWithTheTempoOfDancersTold) {
  const SongOnDisk song;
  const std::string audio = song.folder.path("song.wav");
  const std::string asked = bin("dance-music-eval") + " " + audio + " --beats " +
                            song.folder.path("song.beats") + " --tracker-only --json";
  const Finished finished = run(asked + " --steps 1");
  ASSERT_EQ(finished.exit_code, 0) << finished.talk;
  const auto report = nlohmann::json::parse(finished.output);
  EXPECT_GE(report["with_steps"]["f_measure"].get<double>(), 0.95);
  const auto alone = nlohmann::json::parse(run(asked).output);
  EXPECT_FALSE(alone.contains("with_steps"));
  EXPECT_EQ(alone["f_measure"], report["f_measure"]) << "the first time nobody is seen";
  EXPECT_EQ(run(bin("dance-music-eval") + " " + audio + " --steps 2").exit_code, 2);
}

TEST(MusicEval, SeesRealCouplesStepToASong) {
  const std::string takes = DANCE_SOURCE_DIR "/../shared/data/mocap/";
  if (!std::filesystem::exists(takes + "cmu_60_03_salsa.bvh.xz"))
    GTEST_SKIP() << "no real takes beside this tree";
  const SongOnDisk song;
  const std::string asked = bin("dance-music-eval") + " " + song.folder.path("song.wav") +
                            " --beats " + song.folder.path("song.beats") +
                            " --tracker-only --json --dancer " + takes + "cmu_60_03_salsa.bvh.xz";
  const Finished finished = run(asked + " --dancer " + takes + "cmu_61_03_salsa.bvh.xz");
  ASSERT_EQ(finished.exit_code, 0) << finished.talk;
  const auto report = nlohmann::json::parse(finished.output);
  EXPECT_GE(report["with_steps"]["f_measure"].get<double>(), 0.95);
  EXPECT_EQ(run(asked).exit_code, 2) << "a partner is missing";
}

TEST(MusicEval, NamesWhatIsMissing) {
  const SongOnDisk song;
  const std::string audio = song.folder.path("song.wav");
  const Finished none = run(bin("dance-music-eval") + " " + song.folder.path("none.ogg"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.talk.find("none.ogg"), std::string::npos);
  const Finished few =
      run(bin("dance-music-eval") + " " + audio + " " + audio + " --beats x.beats");
  EXPECT_EQ(few.exit_code, 2);
  EXPECT_NE(few.talk.find("--beats"), std::string::npos);
}

}  // namespace
}  // namespace dance
