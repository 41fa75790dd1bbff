// Musical time from a house's beat to the other house's stage, through the programs: who plays says
// the beat, producers and the link put it on the poses, the tunnel carries it.
#include <cmath>

#include "core/base/beat.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

// The tunnel rounds to 1/1024 beat.
constexpr double kTunnelStep_beats = 0.5 / 1024 + 1e-9;
constexpr double kTempo_bpm = 182.0;

// A steady beat since `begin`: the first beat of the first bar.
Beat steady_beat(MonoTime begin, MonoTime now) {
  Beat beat;
  beat.time = now;
  beat.clock_id = this_clock_id();
  beat.tempo_bpm = kTempo_bpm;
  beat.beats_per_bar = 8;
  beat.confidence = 1.0f;
  beat.playing = true;
  beat.beat = std::ceil((now - begin).as_seconds() * kTempo_bpm / 60.0);
  beat.beat_time = begin + Duration::seconds(beat.beat * 60.0 / kTempo_bpm);
  return beat;
}

double beats_since(MonoTime begin, MonoTime t) {
  return (t - begin).as_seconds() * kTempo_bpm / 60.0;
}

std::unique_ptr<Bus> bus_of(const char* url) {
  auto bus = Bus::open(url);
  EXPECT_TRUE(bus) << bus.error().what;
  return bus ? std::move(*bus) : nullptr;
}

class MusicalTime : public BusPrograms {
 protected:
  void start_link(const char* bus, const std::string& guest) {
    start("dance-link",
          {"--server", "127.0.0.1:7456", "--guest", guest, "--bus", bus, "--bus-captures", guest});
  }
  std::string talk() { return text_of(folder_.path("talk")); }

  MonoTime begin_ = mono_now() - Duration::s(20);
};

TEST_F(MusicalTime, OfAPoseThatBearsNoneIsTheSendersBeatAtTheCaptureOverAnyTunnel) {
  start("dance-server", {"--port", "7456"});
  start_link(kBus, "alice");
  start_link(kOtherBus, "bob");
  const auto a = bus_of(kBus), b = bus_of(kOtherBus);
  ASSERT_TRUE(a && b);
  const GuestId alice = *GuestId::parse("alice");
  std::map<std::uint32_t, MonoTime> captured;
  std::map<std::uint32_t, double> heard_beats;
  b->subscribe<Pose>({Where::kGuest, alice}, [&](const Channel&, const Pose& pose, MonoTime) {
    heard_beats[pose.sequence] = pose.music_beats;
  });
  // Stands for a producer in another language: it knows nothing of the music.
  std::uint32_t sequence = 0;
  const auto tagged = [&] {
    return std::count_if(heard_beats.begin(), heard_beats.end(),
                         [](const auto& entry) { return !std::isnan(entry.second); });
  };
  ASSERT_TRUE(wait_for([&] {
    const MonoTime now = mono_now();
    a->publish(Channel::of_house(Signal::kBeat), steady_beat(begin_, now));
    Pose pose;
    pose.sequence = ++sequence;
    pose.clock_id = this_clock_id();
    pose.capture_time = now - Duration::ms(7);
    captured[sequence] = pose.capture_time;
    a->publish(Channel::of(Signal::kSkeleton, Where::kCapture, alice),
               TimedSkeleton{average_skeleton(), now, this_clock_id()});
    a->publish(Channel::of(Signal::kPose, Where::kCapture, alice), pose);
    a->drain(now);
    b->drain(now);
    return tagged() >= 30;
  })) << heard_beats.size()
      << " poses came\n"
      << talk();
  std::size_t compared = 0;
  for (const auto& [number, beats] : heard_beats) {
    if (std::isnan(beats)) continue;  // before the link had heard a beat
    // The bus rounds times to microseconds.
    EXPECT_NEAR(beats, beats_since(begin_, captured[number]), kTunnelStep_beats + 1e-5) << number;
    ++compared;
  }
  EXPECT_GE(compared, 30u);
  // In milliseconds, as a dancer would hear it.
  EXPECT_LT(kTunnelStep_beats * 60.0 / kTempo_bpm * 1e3, 1.0);
}

TEST_F(MusicalTime, IsOnWhatAProducerPublishesAndSurvivesTheStage) {
  std::ofstream(folder_.path("house.toml"))
      << "[house]\nbus = \"" << kBus << "\"\nguests = [\"alice\"]\n"
      << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
  start("dance-manager", {folder_.path("house.toml")});
  start("dance-replay", {DANCE_SOURCE_DIR "/tests/formats/bvh/data/cgspeed.bvh", "--bus", kBus});
  const auto bus = bus_of(kBus);
  ASSERT_TRUE(bus);
  int compared = 0;
  bus->subscribe<Pose>(Where::kStage, [&](const Channel&, const Pose& pose, MonoTime) {
    if (std::isnan(pose.music_beats)) return;
    EXPECT_NEAR(pose.music_beats, beats_since(begin_, pose.capture_time), 1e-5);
    ++compared;
  });
  EXPECT_TRUE(wait_for([&] {
    bus->publish(Channel::of_house(Signal::kBeat), steady_beat(begin_, mono_now()));
    bus->drain(mono_now());
    return compared >= 20;
  })) << compared
      << talk();
}

TEST_F(MusicalTime, IsShownByTopAndKeptByARecordingAtAnySpeed) {
  const auto bus = bus_of(kBus);
  ASSERT_TRUE(bus);
  const std::string log = folder_.path("beat.lcm");
  start("dance-record", {"-o", log, "--bus", kBus});
  ChildProcess& top = start("/bin/sh", {"-c", bin("dance-top") + " --once --bus " + quoted(kBus) +
                                                  " > " + folder_.path("table")});
  std::error_code error;
  EXPECT_TRUE(wait_for([&] {
    bus->publish(Channel::of_house(Signal::kBeat), steady_beat(begin_, mono_now()));
    return top.has_ended() && std::filesystem::file_size(log, error) > 4000 && !error;
  })) << talk();
  const std::string table = text_of(folder_.path("table"));
  EXPECT_NE(table.find("BEAT/local"), std::string::npos) << table;
  EXPECT_NE(table.find("beat_t"), std::string::npos) << table;
  end_all();

  const auto other = bus_of(kOtherBus);
  ASSERT_TRUE(other);
  std::vector<Beat> heard;
  other->subscribe<Beat>(
      Where::kLocal, [&](const Channel&, const Beat& beat, MonoTime) { heard.push_back(beat); });
  start("dance-replay", {log, "--bus", kOtherBus, "--speed", "2"});
  ASSERT_TRUE(wait_for([&] {
    other->drain(mono_now());
    return heard.size() >= 20;
  })) << talk();
  const Beat first = heard.front();
  EXPECT_EQ(first.clock_id, this_clock_id());
  EXPECT_NEAR(first.tempo_bpm, 2.0 * kTempo_bpm, 1e-9) << "twice as fast";
  for (const Beat& beat : heard) {
    if (beat.beat < first.beat) break;  // the next round
    EXPECT_NEAR(beat.beats_at(beat.time), first.beats_at(beat.time), 0.01);
  }
}

}  // namespace
}  // namespace dance
