// dance music as a user runs it: the time it says without sound, the sound that is heard, two
// houses and who comes late.
#include "tests/apps/music/music_programs.h"

namespace dance {
namespace {

TEST_F(MusicPrograms, SayTheBeatsOfTheirListOnTime) {
  const auto beats_s = uneven_beats(12);
  const std::string song = make_song("song", beats_s, 4);
  BeatEar ear(kBus);
  const MonoTime begin = mono_now() + Duration::s(1);
  start("dance-music", {song, "--silent", "--bus", kBus, "--start", start_at(begin)});
  ASSERT_TRUE(wait_for([&] {
    ear.work();
    return children_.back().has_ended();
  })) << talk();
  ear.work();
  EXPECT_TRUE(children_.back().ended_well()) << talk();
  const auto times = ear.beat_times();
  ASSERT_GE(times.size(), beats_s.size()) << talk();
  for (std::size_t i = 0; i < beats_s.size(); ++i)
    EXPECT_NEAR((times.at(static_cast<int>(i)) - begin).as_seconds(), beats_s[i], 1e-4) << i;
  // At least as often as it promises, whatever this machine does besides: deadlines are absolute.
  const double length_s = beats_s.back() + 1.0;
  EXPECT_GE(ear.playing(), static_cast<std::size_t>(length_s * 5.0)) << "ten a second, or half";
  EXPECT_EQ(ear.said().back().playing, false) << "the end is said";
  for (const Beat& beat : ear.said()) EXPECT_EQ(beat.beats_per_bar, 4);
}

TEST_F(MusicPrograms, EndWithAWordWhenToldTo) {
  const std::string song = make_song("song", even_beats_at(0.5, 0.5, 100), 4);
  BeatEar ear(kBus);
  ChildProcess& music = start("dance-music", {song, "--silent", "--bus", kBus});
  ASSERT_TRUE(wait_for([&] {
    ear.work();
    return ear.playing() >= 5;
  })) << talk();
  music.ask_to_stop();
  ASSERT_TRUE(wait_for([&] { return music.has_ended(); }));
  ear.work();
  EXPECT_TRUE(music.ended_well()) << music.exit_text();
  EXPECT_FALSE(ear.said().back().playing);
  EXPECT_NE(talk().find("beats published"), std::string::npos) << talk();
}

TEST_F(MusicPrograms, GoOnCountingBarsWhenTheSongBeginsAgain) {
  const std::string song = make_song("song", even_beats_at(0.2, 0.4, 7), 4);  // 3.6 s
  BeatEar ear(kBus);
  start("dance-music", {song, "--silent", "--loop", "--bus", kBus});
  ASSERT_TRUE(wait_for([&] {
    ear.work();
    return !ear.said().empty() && ear.said().back().beat > 18.0;
  })) << talk();
  // A round holds 8.5 beats, which is three bars: the first beat of the second round is the 13th.
  const auto times = ear.beat_times();
  ASSERT_TRUE(times.contains(0) && times.contains(12)) << talk();
  EXPECT_NEAR((times.at(12) - times.at(0)).as_seconds(), 3.6, 1e-4);
}

TEST_F(MusicPrograms, ListenToAFileWithoutAListBeforeItBegins) {
  const std::string song = make_song("song", even_beats_at(0.4, 0.5, 20), 4);
  std::filesystem::remove(folder_.path("song.beats"));
  BeatEar ear(kBus);
  start("dance-music", {song, "--silent", "--bus", kBus});
  ASSERT_TRUE(wait_for([&] {
    ear.work();
    return ear.playing() >= 10;
  })) << talk();
  EXPECT_NEAR(ear.said().back().tempo_bpm, 120.0, 3.0);
  EXPECT_EQ(ear.said().back().beats_per_bar, 0) << "the bar is not known";
  EXPECT_NE(talk().find("finds the beats of"), std::string::npos) << talk();
}

TEST_F(MusicPrograms, NoticeASecondOneInTheHouse) {
  const std::string song = make_song("song", even_beats_at(0.5, 0.5, 100), 4);
  start("dance-music", {song, "--silent", "--bus", kBus});
  start("dance-music", {song, "--silent", "--bus", kBus});
  EXPECT_TRUE(wait_for([&] {
    const std::string said = talk();
    const std::size_t first = said.find("another program publishes beats");
    return first != std::string::npos;
  })) << talk();
}

TEST_F(MusicPrograms, SayWhatIsWrongAndTheCure) {
  const std::string song = make_song("song", even_beats_at(0.5, 0.5, 8), 4);
  const auto refused = [&](const std::string& arguments) {
    const Finished it =
        run(bin("dance-music") + " " + arguments + " --silent --bus " + quoted(kBus));
    EXPECT_EQ(it.exit_code, 1) << it.talk;
    return it.talk;
  };
  EXPECT_NE(refused("").find("name a file"), std::string::npos);
  EXPECT_NE(refused("/nowhere.ogg").find("/nowhere.ogg: no such file"), std::string::npos);
  EXPECT_NE(refused(song + " --start soon").find("--start 'soon'"), std::string::npos);
  std::ofstream(folder_.path("bad.beats")) << "0.5\t1\nhello\n";
  EXPECT_NE(refused(song + " --beats " + folder_.path("bad.beats")).find("bad.beats: line 2"),
            std::string::npos);
}

class MusicRoom : public MusicPrograms {
 protected:
  static constexpr const char* kServer = "127.0.0.1:7457";

  void SetUp() override {
    start("dance-server", {"--port", "7457"});
    link(kBus, "alice");
  }
  void link(const char* bus, const std::string& guest, const std::string& server = kServer) {
    start("dance-link", {"--server", server, "--guest", guest, "--bus", bus});
  }
  // Alice begins a song, bob joins in its middle: how far apart the same beats are, by number.
  std::vector<double> apart_of_two_houses_s(BeatEar& a, BeatEar& b, std::size_t beats) {
    const std::string song = make_song("song", uneven_beats(200), 8);
    start("dance-music", {song, "--silent", "--bus", kBus, "--guest", "alice"});
    EXPECT_TRUE(wait_for([&] {
      a.work();
      return a.playing() >= 20;
    })) << talk();
    start("dance-music", {song, "--silent", "--bus", kOtherBus, "--guest", "bob", "--follow"});
    EXPECT_TRUE(wait_for([&] {
      a.work();
      b.work();
      return b.playing() >= 13 * beats;
    })) << talk();
    std::vector<double> off_s;
    const auto a_times = a.beat_times(), b_times = b.beat_times();
    for (const auto& [number, time] : b_times)
      if (a_times.contains(number))
        off_s.push_back(std::abs((time - a_times.at(number)).as_seconds()));
    EXPECT_GE(off_s.size(), beats / 2) << "the same beats by number: the right bar";
    return off_s;
  }
  // The two houses stand at the same beat of the same bar, as far as each says.
  static double apart_s(const Beat& a, const Beat& b) {
    const MonoTime t = std::max(a.time, b.time);
    return (a.beats_at(t) - b.beats_at(t)) * 60.0 / a.tempo_bpm;
  }
};

TEST_F(MusicRoom, BothHousesHearTheSameBeatAndWhoComesLateTheRightBar) {
  link(kOtherBus, "bob");
  BeatEar a(kBus), b(kOtherBus);
  const auto off_s = apart_of_two_houses_s(a, b, 6);
  std::printf("two houses' beats apart by %.2f ms (median of %zu)\n", median(off_s) * 1e3,
              off_s.size());
  EXPECT_LT(median(off_s), 0.010);
  EXPECT_EQ(a.said().back().beats_per_bar, 8);
  EXPECT_EQ(b.said().back().beats_per_bar, 8);

  // A third house has not the song.
  constexpr const char* kThirdBus = "udpm://239.255.76.67:7744?ttl=0";
  link(kThirdBus, "carol");
  BeatEar c(kThirdBus);
  start("dance-music", {"--follow", "--bus", kThirdBus});
  ASSERT_TRUE(wait_for([&] {
    a.work();
    c.work();
    return c.playing() >= 30;
  })) << talk();
  EXPECT_NEAR(apart_s(a.said().back(), c.said().back()), 0.0, 0.06);
}

TEST_F(MusicRoom, BothHousesHearTheSameBeatOverABadLine) {
  const std::string bad = "delay=60ms jitter=15ms loss=2% seed=3";
  start("dance-lossy", {"--listen", "127.0.0.1:7458", "--to", kServer, "--link", bad});
  link(kOtherBus, "bob", "127.0.0.1:7458");
  BeatEar a(kBus), b(kOtherBus);
  const auto off_s = apart_of_two_houses_s(a, b, 8);
  std::printf("over a line with %s: apart by %.2f ms (median of %zu)\n", bad.c_str(),
              median(off_s) * 1e3, off_s.size());
  EXPECT_LT(median(off_s), 0.010);
}

TEST_F(MusicRoom, TheOneWhoIsOverruledSaysSoAndAFollowerGoesAlong) {
  const std::string waltz = make_song("waltz", even_beats_at(0.5, 0.6, 300), 3);
  const std::string tango = make_song("tango", even_beats_at(0.5, 0.5, 300), 4);
  link(kOtherBus, "bob");
  BeatEar a(kBus);
  start("dance-music", {waltz, "--silent", "--bus", kBus, "--guest", "alice", "--follow"});
  ASSERT_TRUE(wait_for([&] {
    a.work();
    return a.playing() >= 10;
  })) << talk();
  EXPECT_NE(talk().find("the room has no music: begins 'waltz'"), std::string::npos) << talk();
  start("dance-music", {tango, "--silent", "--bus", kOtherBus, "--guest", "bob"});
  EXPECT_TRUE(wait_for([&] {
    a.work();
    return talk().find("the room plays 'tango'") != std::string::npos && a.said().back().playing &&
           a.said().back().beats_per_bar == 4;
  })) << talk();
}

TEST_F(MusicRoom, AHouseWithMusicInItsSessionDancesToTheRooms) {
  const std::string song = make_song("song", even_beats_at(0.5, 0.4, 400), 4);
  start("dance-music", {song, "--silent", "--bus", kBus, "--guest", "alice"});
  link(kOtherBus, "bob");
  constexpr const char* kHouseBus = "udpm://239.255.76.67:7745?ttl=0";
  std::ofstream(folder_.path("house.toml"))
      << "[house]\nguest = \"dora\"\nserver = \"127.0.0.1:7457\"\nview = false\nbus = \""
      << kHouseBus << "\"\n[music]\nfile = \"song.wav\"\nsilent = true\n"
      << "[[produce]]\nkind = \"replay\"\nguest = \"dora\"\nfile = \"" << DANCE_SOURCE_DIR
      << "/tests/formats/bvh/data/cgspeed.bvh\"\n";
  start("dance-join", {folder_.path("house.toml")});
  BeatEar a(kBus), d(kHouseBus);
  auto other = Bus::open(kOtherBus);
  ASSERT_TRUE(other);
  // The room's own line, which carries dora's poses to bob's house.
  std::vector<double> off_beats;
  std::optional<Beat> heard;
  (*other)->subscribe<Pose>(
      {Where::kGuest, *GuestId::parse("dora")}, [&](const Channel&, const Pose& pose, MonoTime) {
        if (heard && !std::isnan(pose.music_beats))
          off_beats.push_back(std::abs(pose.music_beats - heard->beats_at(pose.capture_time)));
      });
  ASSERT_TRUE(wait_for([&] {
    a.work();
    d.work();
    if (!a.said().empty() && a.said().back().playing) heard = a.said().back();
    (*other)->drain(mono_now());
    return off_beats.size() >= 60 && d.playing() >= 20;
  })) << talk();
  EXPECT_NEAR(apart_s(a.said().back(), d.said().back()), 0.0, 0.010);
  // In beats of 0.4 s: 10 ms between the houses and as much for the capture's time through two
  // clocks' mapping.
  EXPECT_LT(median(off_beats), 0.05);
}

}  // namespace
}  // namespace dance
