// The house band as programs run it: two houses and a server.
#include "tests/apps/music/music_programs.h"

namespace dance {
namespace {

using BandPrograms = MusicPrograms;

// The room song that a house receives.
class SongReceiver {
 public:
  explicit SongReceiver(const char* url) {
    auto bus = Bus::open(url);
    EXPECT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    bus_->subscribe<RoomSong>(Where::kRoom,
                              [this](const Channel& channel, const RoomSong& song, MonoTime) {
                                setter_ = std::string(channel.guest().view());
                                song_ = song;
                              });
  }
  void work() { bus_->drain(mono_now()); }
  const std::optional<RoomSong>& song() const { return song_; }
  const std::string& setter() const { return setter_; }

 private:
  std::unique_ptr<Bus> bus_;
  std::optional<RoomSong> song_;
  std::string setter_;
};

double beats_apart_s(const Beat& a, const Beat& b) {
  const double beats = a.beat - b.beat;
  return (a.beat_time - b.beat_time).as_seconds() - beats * 60.0 / a.tempo_bpm;
}

TEST_F(BandPrograms, PlayTheSameSongInBothHousesThroughATempoChangeAndForALateJoiner) {
  start("dance-server", {"--port", "7457"});
  const auto link = [&](const char* bus, const char* guest) {
    start("dance-link", {"--server", "127.0.0.1:7457", "--guest", guest, "--bus", bus});
  };
  link(kBus, "alice");
  link(kOtherBus, "bob");
  BeatEar a(kBus), b(kOtherBus);
  SongReceiver song(kOtherBus);
  const auto band = [&](const char* bus, const char* guest) {
    start("dance-music",
          {"--band", "salsa", "--silent", "--follow", "--guest", guest, "--bus", bus});
  };
  band(kBus, "alice");
  ASSERT_TRUE(wait_for([&] {
    a.work();
    song.work();
    return song.song() && a.playing() > 20;
  })) << talk();
  EXPECT_EQ(song.setter(), "alice");
  band(kOtherBus, "bob");
  ASSERT_TRUE(wait_for([&] {
    a.work();
    b.work();
    return b.playing() > 20;
  })) << talk();
  EXPECT_NEAR(beats_apart_s(a.said().back(), b.said().back()), 0.0, 0.005);

  // Bob requests a slower tempo, and both houses play it.
  start("dance-music-set", {"slower", "--bus", kOtherBus});
  ASSERT_TRUE(wait_for([&] {
    a.work();
    b.work();
    song.work();
    return song.setter() == "bob" && a.said().back().tempo_bpm < 175.0 &&
           b.said().back().tempo_bpm < 175.0;
  })) << talk();
  EXPECT_NEAR(beats_apart_s(a.said().back(), b.said().back()), 0.0, 0.005);
}

TEST_F(BandPrograms, ReportAStyleThatTheBandDoesNotPlay) {
  ChildProcess& music = start("dance-music", {"--band", "polka", "--silent", "--bus", kBus});
  ASSERT_TRUE(wait_for([&] { return music.has_ended(); }));
  EXPECT_FALSE(music.ended_well());
  EXPECT_NE(talk().find("'polka'"), std::string::npos) << talk();
  EXPECT_NE(talk().find("cha-cha"), std::string::npos) << talk();
}

}  // namespace
}  // namespace dance
