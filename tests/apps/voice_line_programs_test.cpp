// A voice from one house's bus to the others', through the programs as people run them, sealed;
// into a packed recording there, and out of it again.
#include <map>
#include <nlohmann/json.hpp>

#include "core/bus/encode.h"
#include "core/control/house_publisher.h"
#include "formats/log/log_file.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr const char* kDeafBus = "udpm://239.255.76.67:7745?ttl=0";

Voice voice_of_alice(std::uint32_t sequence, MonoTime now) {
  Voice voice;
  voice.capture_time = now - Duration::ms(12);
  voice.clock_id = this_clock_id();
  voice.sequence = sequence;
  voice.level_dbfs = -18;
  std::array<std::uint8_t, 60> packet;
  for (std::size_t i = 0; i < packet.size(); ++i)
    packet[i] = static_cast<std::uint8_t>(sequence + i);
  EXPECT_TRUE(voice.set_packet(packet));
  return voice;
}

// What is heard of alice on a bus.
struct VoiceReceiver {
  explicit VoiceReceiver(const char* url) {
    auto opened = Bus::open(url);
    EXPECT_TRUE(opened) << opened.error().what;
    bus = std::move(*opened);
    bus->subscribe<Voice>(Where::kGuest,
                          [this](const Channel& channel, const Voice& voice, MonoTime now) {
                            if (channel.guest().view() != "alice") return;
                            voices.insert_or_assign(voice.sequence, voice);
                            newest_age = now - voice.capture_time;
                          });
    bus->subscribe<Pose>(Where::kGuest, [this](const Channel&, const Pose&, MonoTime) { ++poses; });
  }
  std::unique_ptr<Bus> bus;
  std::map<std::uint32_t, Voice> voices;
  Duration newest_age;
  int poses = 0;
};

class VoiceLinePrograms : public BusPrograms {
 protected:
  void start_link(const char* bus, const std::string& guest,
                  const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"--server", "127.0.0.1:7456", "--guest", guest, "--bus",
                                       bus,        "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto child = ChildProcess::start(
        {bin("dance-link"), arguments, folder_.path(guest + ".json"), folder_.path("talk")});
    ASSERT_TRUE(child) << child.error().what;
    children_.push_back(std::move(*child));
  }
  // alice dances and speaks.
  void perform(Bus& bus) {
    const MonoTime now = mono_now();
    if (now < next_) return;
    next_ = now + kVoiceFrame;
    bus.publish(Where::kCapture, alice_, voice_of_alice(++spoken_, now));
    Pose pose;
    pose.sequence = spoken_;
    pose.capture_time = now;
    pose.clock_id = this_clock_id();
    if (spoken_ % 2 == 0) bus.publish(Where::kCapture, alice_, pose);
  }

  GuestId alice_ = *GuestId::parse("alice");
  std::uint32_t spoken_ = 0;
  MonoTime next_;
};

TEST_F(VoiceLinePrograms, AVoiceIsHeardRecordedAndPlayedAgain) {
  start("dance-server", {"--port", "7456"});
  start_link(kBus, "alice", {"--bus-captures", "alice"});
  start_link(kOtherBus, "bob");
  start_link(kDeafBus, "carl", {"--hear", "alice=0"});
  const std::string log = folder_.path("talk.lcm"), plain = folder_.path("plain.lcm");
  ChildProcess& recorder =
      start("dance-record", {"--packed", "-o", log, "--bus", std::string(kOtherBus)});
  VoiceReceiver a(kBus), b(kOtherBus), deaf(kDeafBus);
  EXPECT_TRUE(wait_for([&] {
    perform(*a.bus);
    for (VoiceReceiver* ear : {&a, &b, &deaf}) ear->bus->drain(mono_now());
    std::error_code none;
    return b.voices.size() >= 100 && deaf.poses >= 100 && std::filesystem::exists(log, none) &&
           std::filesystem::file_size(log, none) > 20'000;
  })) << b.voices.size()
      << " " << deaf.poses << " " << text_of(folder_.path("talk"));
  EXPECT_TRUE(deaf.voices.empty());
  EXPECT_TRUE(a.voices.empty());
  for (const auto& [sequence, voice] : b.voices) {
    EXPECT_EQ(voice.data, voice_of_alice(sequence, mono_now()).data) << sequence;
    EXPECT_EQ(voice.level_dbfs, -18);
    EXPECT_EQ(voice.clock_id, this_clock_id());
  }
  EXPECT_GT(b.newest_age, Duration::ms(11));
  EXPECT_LT(b.newest_age, Duration::s(5));
  // bob's player mutes her, and requests her again, over the house's socket.
  const auto poller = Poller::create();
  ASSERT_TRUE(poller);
  HousePublisher player(*b.bus, kOtherBus, **poller);
  ASSERT_EQ(player.houses().house_count(), 1u);
  const auto heard_while = [&](bool hears_others) {
    HearingWish wish;
    wish.clock_id = this_clock_id();
    std::size_t newest = 0;
    const int poses = b.poses;
    EXPECT_TRUE(wait_for([&] {
      wish.time = mono_now();
      // Who plays voices to another guest of this house mutes everybody all the time.
      for (const bool is_bob : {true, false}) {
        wish.listener = *GuestId::parse(is_bob ? "bob" : "bea");
        wish.hears_others = is_bob && hears_others;
        player.publish(Channel::of_house(Signal::kHearing), wish);
      }
      perform(*a.bus);
      b.bus->drain(mono_now());
      // What was under way when it was said.
      if (b.poses < poses + 6) newest = b.voices.size();
      return b.poses > poses + 20;
    }));
    return b.voices.size() - newest;
  };
  EXPECT_EQ(heard_while(false), 0u);
  EXPECT_GT(heard_while(true), 5u);
  recorder.stop(Duration::s(5));
  end_all();
  const auto report = nlohmann::json::parse(text_of(folder_.path("bob.json")), nullptr, false);
  ASSERT_TRUE(report.is_object());
  EXPECT_GE(report["voices_delivered"], 100);
  EXPECT_EQ(report["forged"], 0);
  const auto of_deaf = nlohmann::json::parse(text_of(folder_.path("carl.json")), nullptr, false);
  EXPECT_LE(of_deaf["voice_bytes_in"], 20'000) << "no more than before the server knew";

  // What is no pose passes through a packed log as it is.
  ASSERT_EQ(run(bin("dance-unpack") + " " + log + " -o " + plain).exit_code, 0);
  auto reader = LogReader::open(plain);
  ASSERT_TRUE(reader) << reader.error().what;
  std::size_t recorded = 0;
  while (const auto event = reader->next()) {
    Voice voice;
    if (event->channel != "VOICE/guest/alice") continue;
    ASSERT_EQ(decode(event->data.data(), event->data.size(), voice), Decoded::kFine);
    EXPECT_EQ(voice.data, voice_of_alice(voice.sequence, mono_now()).data);
    ++recorded;
  }
  EXPECT_GT(recorded, 20u);
  const Finished convert =
      run(bin("dance-convert") + " " + log + " " + folder_.path("take.bvh") + " --guest alice");
  EXPECT_EQ(convert.exit_code, 0) << convert.talk;

  VoiceReceiver again(kDeafBus);
  start("dance-replay", {log, "--bus", std::string(kDeafBus)});
  EXPECT_TRUE(wait_for([&] {
    again.bus->drain(mono_now());
    return again.voices.size() > 20 && again.poses > 5;
  })) << again.voices.size()
      << text_of(folder_.path("talk"));
  for (const auto& [sequence, voice] : again.voices)
    EXPECT_EQ(voice.data, voice_of_alice(sequence, mono_now()).data) << sequence;
  EXPECT_LT(again.newest_age, Duration::s(5)) << "stamped anew";
}

}  // namespace
}  // namespace dance
