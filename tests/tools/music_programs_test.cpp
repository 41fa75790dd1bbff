// dance music as a user runs it: the time it says without sound, the sound that is heard, two houses and who comes late.
#include <cmath>
#include <map>

#include "core/base/beat.h"
#include "tests/producers_music/wav_file.h"
#include "tests/tools/bus_programs.h"
#ifdef DANCE_HAVE_SOUND
#include "tests/tools/sound_server.h"
#endif

namespace dance {
namespace {

constexpr int kRate_hz = 44100;

// Beats of a band that sways, which no single tempo fits.
std::vector<double> uneven_beats(int count) {
  std::vector<double> times_s;
  double at_s = 0.25;
  for (int i = 0; i < count; ++i) {
    times_s.push_back(at_s);
    at_s += 0.5 + 0.04 * std::sin(1.7 * i);
  }
  return times_s;
}

std::vector<double> even_beats_at(double first_s, double period_s, int count) {
  std::vector<double> times_s;
  for (int i = 0; i < count; ++i) times_s.push_back(first_s + i * period_s);
  return times_s;
}

// All that was said on a house's BEAT/local.
class BeatEar {
 public:
  explicit BeatEar(const char* url) {
    auto bus = Bus::open(url);
    EXPECT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    bus_->on_beat([this](const Channel&, const Beat& beat, MonoTime) { said_.push_back(beat); });
  }
  void work() { bus_->drain(mono_now()); }
  const std::vector<Beat>& said() const { return said_; }
  std::size_t playing() const {
    return static_cast<std::size_t>(
        std::count_if(said_.begin(), said_.end(), [](const Beat& beat) { return beat.playing; }));
  }
  // When each beat was to be heard, as it was said last.
  std::map<int, MonoTime> beat_times() const {
    std::map<int, MonoTime> times;
    for (const Beat& beat : said_)
      if (beat.playing) times[static_cast<int>(beat.beat)] = beat.beat_time;
    return times;
  }

 private:
  std::unique_ptr<Bus> bus_;
  std::vector<Beat> said_;
};

double median(std::vector<double> values) {
  if (values.empty()) return 1e9;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

class MusicPrograms : public BusPrograms {
 protected:
  std::string make_song(const std::string& name, const std::vector<double>& beats_s, int bar) {
    const double length_s = beats_s.back() + 1.0;
    write_wav(folder_.path(name + ".wav"), click_track(beats_s, length_s, kRate_hz), 1, kRate_hz);
    std::ofstream list(folder_.path(name + ".beats"));
    list.precision(9);
    for (std::size_t i = 0; i < beats_s.size(); ++i)
      list << beats_s[i] << "\t" << static_cast<int>(i) % bar + 1 << "\n";
    return folder_.path(name + ".wav");
  }
  static std::string start_at(MonoTime t) { return std::to_string(t.since_zero_us()); }
  std::string talk() { return text_of(folder_.path("talk")); }
};

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
  EXPECT_NE(talk().find("beats said"), std::string::npos) << talk();
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
  EXPECT_NE(talk().find("listens for the beats of"), std::string::npos) << talk();
}

TEST_F(MusicPrograms, NoticeASecondOneInTheHouse) {
  const std::string song = make_song("song", even_beats_at(0.5, 0.5, 100), 4);
  start("dance-music", {song, "--silent", "--bus", kBus});
  start("dance-music", {song, "--silent", "--bus", kBus});
  EXPECT_TRUE(wait_for([&] {
    const std::string said = talk();
    const std::size_t first = said.find("another program says the beat");
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
      << "/tests/core_pose/data/cgspeed.bvh\"\n";
  start("dance-join", {folder_.path("house.toml")});
  BeatEar a(kBus), d(kHouseBus);
  auto other = Bus::open(kOtherBus);
  ASSERT_TRUE(other);
  // The room's own line, which carries dora's poses to bob's house.
  std::vector<double> off_beats;
  std::optional<Beat> heard;
  (*other)->on_pose(
      Where::kGuest, *GuestId::parse("dora"), Delivery::kEvery,
      [&](const Channel&, const Pose& pose, MonoTime) {
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
  // In beats of 0.4 s: 10 ms between the houses and as much for the capture's time through two clocks' mapping.
  EXPECT_LT(median(off_beats), 0.05);
}

#ifdef DANCE_HAVE_SOUND
class MusicSound : public MusicPrograms {
 protected:
  // Clicks are heard when the song has them and when the beats were said to be.
  void expect_clicks_on_the_beat(Duration trim) {
    SoundServer sound(folder_);
    ASSERT_TRUE(sound.is_open()) << text_of(folder_.path("pulse/talk"));
    ASSERT_TRUE(sound.listen());
    const auto beats_s = uneven_beats(12);
    const std::string song = make_song("song", beats_s, 4);
    BeatEar ear(kBus);
    const MonoTime begin = mono_now() + Duration::s(3);
    start("dance-music", {song, "--bus", kBus, "--start", start_at(begin), "--trim",
                          std::to_string(trim.count_ms()) + "ms"});
    ASSERT_TRUE(wait_for([&] {
      ear.work();
      sound.work();
      return children_.back().has_ended();
    })) << talk();
    const auto clicks = sound.clicks();
    ASSERT_GE(clicks.size(), beats_s.size() / 2) << talk();
    const auto said = ear.beat_times();
    std::vector<double> off_song_s, off_said_s;
    for (const MonoTime click : clicks) {
      // What the monitor has, the loudspeaker plays by so much later.
      const double at_s = (click + trim - begin).as_seconds();
      const auto nearest = std::min_element(
          beats_s.begin(), beats_s.end(),
          [&](double x, double y) { return std::abs(x - at_s) < std::abs(y - at_s); });
      off_song_s.push_back(std::abs(*nearest - at_s));
      const auto told = said.find(static_cast<int>(nearest - beats_s.begin()));
      if (told == said.end()) continue;
      off_said_s.push_back(std::abs((click + trim - told->second).as_seconds()));
    }
    EXPECT_GE(off_said_s.size(), beats_s.size() / 2);
    RecordProperty("off_song_us", static_cast<int>(median(off_song_s) * 1e6));
    std::printf(
        "clicks off the song's time by %.2f ms, off what was said by %.2f ms (medians of %zu)\n",
        median(off_song_s) * 1e3, median(off_said_s) * 1e3, clicks.size());
    EXPECT_LT(median(off_song_s), 0.020);
    EXPECT_LT(median(off_said_s), 0.020);
  }
};

TEST_F(MusicSound, ClicksAreHeardWhenTheBeatWasSaidToBe) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  expect_clicks_on_the_beat(Duration());
}

TEST_F(MusicSound, ALateLoudspeakerIsPlayedEarlierBySoMuch) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  expect_clicks_on_the_beat(Duration::ms(150));
}

TEST_F(MusicSound, WithoutItsSoundServerTheTimeGoesOn) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  auto sound = std::make_unique<SoundServer>(folder_);
  ASSERT_TRUE(sound->is_open()) << text_of(folder_.path("pulse/talk"));
  const std::string song = make_song("song", even_beats_at(0.5, 0.5, 100), 4);
  BeatEar ear(kBus);
  start("dance-music", {song, "--bus", kBus});
  const auto hears = [&](std::size_t beats) {
    return wait_for([&] {
      ear.work();
      return ear.playing() >= beats;
    });
  };
  ASSERT_TRUE(hears(20)) << talk();
  const Beat before = ear.said().back();
  sound.reset();
  ASSERT_TRUE(hears(60)) << talk();
  EXPECT_NE(talk().find("the sound server has gone"), std::string::npos) << talk();
  const Beat after = ear.said().back();
  EXPECT_NEAR(after.beats_at(after.time), before.beats_at(after.time), 0.05);
}

TEST_F(MusicSound, AMicrophoneHearsTheBeatThatIsPlayed) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  SoundServer sound(folder_);
  ASSERT_TRUE(sound.is_open()) << text_of(folder_.path("pulse/talk"));
  const std::string song = make_song("song", even_beats_at(0.4, 0.5, 200), 4);
  BeatEar played(kBus), heard(kOtherBus);
  start("dance-music", {song, "--bus", kBus});
  start("dance-music", {"--microphone", "--source", "dance.monitor", "--bus", kOtherBus});
  constexpr std::size_t kLocked = 150;  // some twelve seconds
  ASSERT_TRUE(wait_for([&] {
    played.work();
    heard.work();
    return heard.playing() >= kLocked + 50;
  })) << heard.playing()
      << talk();
  const auto times = played.beat_times();
  std::vector<double> off_s;
  for (std::size_t i = kLocked; i < heard.said().size(); ++i) {
    const Beat& beat = heard.said()[i];
    EXPECT_NEAR(beat.tempo_bpm, 120.0, 4.0);
    double nearest_s = 1.0;
    for (const auto& [number, time] : times)
      nearest_s = std::min(nearest_s, std::abs((beat.beat_time - time).as_seconds()));
    off_s.push_back(nearest_s);
  }
  std::printf("a microphone's beats off what was played by %.1f ms (median of %zu)\n",
              median(off_s) * 1e3, off_s.size());
  EXPECT_LT(median(off_s), 0.030);
}

TEST_F(MusicSound, WithoutASoundServerTheTimeIsKeptAndThatIsSaid) {
  ::setenv("PULSE_SERVER", "unix:/nowhere", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  const std::string song = make_song("song", even_beats_at(0.5, 0.5, 100), 4);
  BeatEar ear(kBus);
  start("dance-music", {song, "--bus", kBus});
  EXPECT_TRUE(wait_for([&] {
    ear.work();
    return ear.playing() >= 3;
  })) << talk();
  EXPECT_NE(talk().find("no sound server"), std::string::npos) << talk();
  EXPECT_NE(talk().find("keeps the time without sound"), std::string::npos) << talk();
}
#endif

}  // namespace
}  // namespace dance
