// dance music with a sound server: what is heard, and when; a microphone; a server that goes away.
#include "producers/music/loudspeaker.h"
#include "tests/apps/music/music_programs.h"
#include "tests/apps/sound_server.h"

namespace dance {
namespace {

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

TEST_F(MusicSound, IsAsLoudAsItIsToldWhileItPlays) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  SoundServer sound(folder_);
  ASSERT_TRUE(sound.is_open()) << text_of(folder_.path("pulse/talk"));
  ASSERT_TRUE(sound.listen());
  const std::string song = make_song("song", even_beats_at(0.2, 0.2, 600), 4);
  const std::string set = bin("dance-music-set") + " --bus '" + kBus + "' --volume ";
  BeatEar ear(kBus);
  start("dance-music", {song, "--bus", kBus});
  const auto hears = [&](std::size_t clicks) {
    return wait_for([&] {
      ear.work();
      sound.work();
      return sound.clicks().size() >= clicks;
    });
  };
  ASSERT_TRUE(hears(3)) << talk();
  ASSERT_EQ(run(set + "0").exit_code, 0);
  // What the sound server had already is heard yet.
  EXPECT_TRUE(wait_for([&] {
    const std::size_t clicks = sound.clicks().size(), beats = ear.said().size();
    return wait_for([&] {
             ear.work();
             sound.work();
             return ear.said().size() >= beats + 15;
           }) &&
           sound.clicks().size() == clicks;
  })) << "the beat goes on, and nothing is heard";
  const std::size_t clicks = sound.clicks().size();
  ASSERT_EQ(run(set + "0.9").exit_code, 0);
  EXPECT_TRUE(hears(clicks + 3));
  children_.back().stop(Duration::s(5));
  const Finished nobody = run(set + "0.5");
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_NE(nobody.talk.find("no music is played on this bus"), std::string::npos) << nobody.talk;
}

TEST_F(MusicSound, TheLoudspeakerIsToldWithItsLatency) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  SoundServer sound(folder_);
  ASSERT_TRUE(sound.is_open()) << text_of(folder_.path("pulse/talk"));
  const auto loudspeaker = default_loudspeaker("test");
  ASSERT_TRUE(loudspeaker) << loudspeaker.error().what;
  EXPECT_EQ(loudspeaker->name, "dance");
  EXPECT_FALSE(loudspeaker->description.empty());
  EXPECT_TRUE(loudspeaker->leads_nowhere) << "a null sink";
  EXPECT_FALSE(loudspeaker->is_muted);
  EXPECT_GT(loudspeaker->latency, Duration());
  EXPECT_LT(loudspeaker->latency, Duration::s(2));
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
  EXPECT_NE(talk().find("the connection to the sound server is lost"), std::string::npos) << talk();
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

}  // namespace
}  // namespace dance
