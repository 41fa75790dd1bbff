// The devices of a voice with a real sound server: streams that go while answers are on their way,
// and a server that goes and comes back.
#include "voice/device/voice_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/net/mono_clock.h"
#include "testing/voice/sound_rooms.h"
#include "tests/apps/sound_server.h"

namespace dance {
namespace {

TEST(DeviceTroubles, ReportsEachErrorAndEachRecoveryOnce) {
  DeviceTroubles troubles;
  EXPECT_EQ(troubles.take(), "");
  for (int look = 0; look < 3; ++look) {
    troubles.add(VoiceDevice::kLoudspeaker, "no loudspeaker");
    troubles.add(VoiceDevice::kMicrophone, "no microphone");
    EXPECT_EQ(troubles.take(), look == 0 ? "no loudspeaker; no microphone" : "");
  }
  EXPECT_EQ(troubles.take_recoveries(), "");
  troubles.clear(VoiceDevice::kMicrophone);
  troubles.clear(VoiceDevice::kReference);
  EXPECT_EQ(troubles.take_recoveries(), "the microphone works again");
  EXPECT_EQ(troubles.take_recoveries(), "");
  troubles.add(VoiceDevice::kLoudspeaker, "no loudspeaker");
  troubles.add(VoiceDevice::kMicrophone, "no microphone");
  EXPECT_EQ(troubles.take(), "no microphone") << "it had come back";
}

class VoiceDevicesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
    sound_ = std::make_unique<SoundServer>(folder_);
    ASSERT_TRUE(sound_->is_open());
  }
  TestFolder folder_{"voice-devices"};
  std::unique_ptr<SoundServer> sound_;
};

TEST_F(VoiceDevicesTest, StreamsGoWhileAnswersOfTheServerAreOnTheirWay) {
  auto server = PulseServer::connect("test");
  ASSERT_TRUE(server) << server.error().what;
  PulseOutputOptions to;
  to.sink = "dance";
  to.ahead = Duration::ms(20);
  int after_the_end = 0;
  const std::array<float, 960> quiet{};
  for (int round = 0; round < 10; ++round) {
    bool is_over = false;
    int answers = 0, heard = 0;
    const auto count = [&](int& of) { ++(is_over ? after_the_end : of); };
    auto output = PulseOutput::open(**server, to, [&](MonoTime, double) { count(answers); });
    ASSERT_TRUE(output) << output.error().what;
    auto input = PulseInput::open(**server, {"dance.monitor"}, [&](auto) { count(heard); });
    ASSERT_TRUE(input) << input.error().what;
    // Streams that live are answered, however often they ask; once is enough to see it, as an idle
    // sink takes two seconds to begin.
    const auto ask = [&] {
      if ((*output)->wanted_frames() >= quiet.size() / 2) (*output)->write(quiet);
      (*output)->request_timing();
      (*input)->request_timing();
    };
    ASSERT_TRUE((*server)->iterate_until(
        [&] {
          ask();
          return round > 0 || (answers > 3 && heard > 3);
        },
        Duration::s(30)));
    ask();
    output->reset();
    input->reset();
    is_over = true;
    // As many turns as bring the answers that were asked for.
    for (int turn = 0; turn < 20; ++turn) {
      (*server)->iterate();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  EXPECT_EQ(after_the_end, 0);
}

TEST_F(VoiceDevicesTest, ReportsASoundServerThatIsGoneAndThatItWorksAgain) {
  VoiceDeviceOptions options;
  options.microphone = "dance.monitor";
  options.loudspeaker = "dance";
  VoiceDeviceHandlers handlers;
  int frames = 0;
  handlers.on_microphone = [&](auto, MonoTime, Duration) { ++frames; };
  handlers.on_reference = [](auto) {};
  handlers.fill = [](auto, MonoTime, MonoTime) {};
  auto devices = VoiceDevices::open(options, handlers);
  ASSERT_TRUE(devices) << devices.error().what;
  const auto work = [&] { (*devices)->work(mono_now()); };
  EXPECT_TRUE(wait_for([&] {
    work();
    return frames > 10;
  }));
  EXPECT_EQ((*devices)->take_errors(), "");
  sound_.reset();
  std::vector<std::string> said;
  EXPECT_TRUE(wait_for([&] {
    work();
    if (auto trouble = (*devices)->take_errors(); !trouble.empty()) said.push_back(trouble);
    return !said.empty();
  }));
  EXPECT_FALSE((*devices)->has_microphone() || (*devices)->has_loudspeaker());
  EXPECT_NE(said.at(0).find("no sound server"), std::string::npos) << said.at(0);

  sound_ = std::make_unique<SoundServer>(folder_);
  ASSERT_TRUE(sound_->is_open());
  std::string recoveries;
  EXPECT_TRUE(wait_for([&] {
    work();
    recoveries += (*devices)->take_recoveries();
    return (*devices)->has_microphone() && (*devices)->has_loudspeaker();
  }));
  EXPECT_EQ(recoveries, "the sound server works again");
}

// What another sink plays, as the room's music, comes as the reference where it is named, and what
// the loudspeaker plays where none is.
TEST(VoiceReference, IsOfTheSinkThatIsNamed) {
  if (!SoundRooms::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  const TestFolder folder("voice-reference");
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  auto rooms = SoundRooms::open(folder.path(), {"ear", "music", "mouth"});
  ASSERT_TRUE(rooms) << rooms.error().what;
  std::vector<float> tone(48'000 * 20);
  for (std::size_t i = 0; i < tone.size(); ++i)
    tone[i] = 0.3f * std::sin(0.05f * static_cast<float>(i % 12'566));
  ASSERT_TRUE((*rooms)->play("music", tone));
  double loudest = 0.0;
  int frames = 0;
  VoiceDeviceHandlers handlers;
  handlers.on_microphone = [](auto, MonoTime, Duration) {};
  handlers.on_reference = [&](std::span<const float, kVoiceFrameSamples> frame) {
    double power = 0.0;
    for (const float sample : frame) power += static_cast<double>(sample * sample);
    loudest = std::max(loudest, power);
    ++frames;
  };
  handlers.fill = [](std::span<float>, MonoTime, MonoTime) {};
  const auto heard_with = [&](const std::string& reference, std::string* trouble) {
    loudest = 0.0;
    frames = 0;
    VoiceDeviceOptions options;
    options.microphone = "mouth.monitor";
    options.loudspeaker = "ear";
    options.reference = reference;
    auto devices = VoiceDevices::open(options, handlers);
    EXPECT_TRUE(devices) << devices.error().what;
    if (trouble != nullptr) *trouble = (*devices)->take_errors();
    if (trouble != nullptr) return;
    EXPECT_TRUE(wait_for([&] {
      (*rooms)->work(mono_now());
      (*devices)->work(mono_now());
      return frames > 50 && (reference.empty() || loudest > 1.0);
    })) << frames
        << " frames, " << loudest;
  };
  heard_with("music", nullptr);
  EXPECT_GT(loudest, 1.0);
  heard_with("", nullptr);
  EXPECT_LT(loudest, 1e-6) << "the loudspeaker plays nothing";
  std::string trouble;
  heard_with("cellar", &trouble);
  EXPECT_NE(trouble.find("no echo is taken out: what cellar plays"), std::string::npos) << trouble;
  EXPECT_NE(trouble.find("pactl list short sinks"), std::string::npos) << trouble;
}

}  // namespace
}  // namespace dance
