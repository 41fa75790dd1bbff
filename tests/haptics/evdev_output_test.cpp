#include "haptics/evdev/evdev_output.h"

#include <gtest/gtest.h>
#include <linux/input.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <vector>

#include "haptics/evdev/evdev_devices.h"
#include "tests/haptics/haptic_notes.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

// Stands for the kernel: gives ids, and keeps what was asked.
struct KernelNotes {
  std::vector<ff_effect> uploads;
  std::vector<std::pair<int, int>> events;
  std::vector<int> removed;
  int next_id = 0;
  int error = 0;
  bool is_there = true;
};

class NotedFile final : public ForceFeedbackFile {
 public:
  explicit NotedFile(KernelNotes& notes) : notes_(notes) {}
  int upload(void* data) override {
    if (notes_.error != 0) {
      errno = notes_.error;
      return -1;
    }
    auto* const effect = static_cast<ff_effect*>(data);
    if (effect->id < 0) effect->id = static_cast<std::int16_t>(notes_.next_id++);
    notes_.uploads.push_back(*effect);
    return 0;
  }
  int remove(int id) override {
    notes_.removed.push_back(id);
    return 0;
  }
  int write_event(int code, int value) override {
    notes_.events.emplace_back(code, value);
    return 0;
  }
  bool is_there() override { return notes_.is_there; }

 private:
  KernelNotes& notes_;
};

MonoTime moment(int ms) { return MonoTime::from_us(1'000'000 + 1000 * ms); }

TEST(EvdevOutput, UploadsAndStartsAnEffectOfTheRightLengthAndStrength) {
  KernelNotes kernel;
  EvdevOutput output("pad", std::make_unique<NotedFile>(kernel), true, 16);
  Haptic haptic = some_haptic(moment(0));
  haptic.duration = Duration::ms(80);
  EXPECT_TRUE(output.play(haptic, moment(0)));
  ASSERT_EQ(kernel.uploads.size(), 1u);
  EXPECT_EQ(kernel.uploads[0].type, FF_RUMBLE);
  EXPECT_EQ(kernel.uploads[0].replay.length, 80);
  EXPECT_NEAR(kernel.uploads[0].u.rumble.weak_magnitude, 32768, 2);
  EXPECT_EQ(kernel.uploads[0].u.rumble.strong_magnitude, 0);
  ASSERT_EQ(kernel.events.size(), 1u);
  EXPECT_EQ(kernel.events[0], std::pair(0, 1));
  haptic.frequency_hz = 60.0f;
  haptic.attack = haptic.duration;  // a motor has no envelope: half of it
  EXPECT_TRUE(output.play(haptic, moment(10)));
  EXPECT_NEAR(kernel.uploads[1].u.rumble.strong_magnitude, 16384, 2);
}

TEST(EvdevOutput, PlaysWavesWithTheirEnvelopeWhereThereAreNoMotors) {
  KernelNotes kernel;
  EvdevOutput output("wheel", std::make_unique<NotedFile>(kernel), false, 16);
  Haptic haptic = some_haptic(moment(0));
  haptic.attack = Duration::ms(15);
  haptic.release = Duration::ms(25);
  haptic.frequency_hz = 100.0f;
  EXPECT_TRUE(output.play(haptic, moment(0)));
  const ff_periodic_effect& wave = kernel.uploads[0].u.periodic;
  EXPECT_EQ(kernel.uploads[0].type, FF_PERIODIC);
  EXPECT_EQ(wave.waveform, FF_SINE);
  EXPECT_EQ(wave.period, 10);
  EXPECT_NEAR(wave.magnitude, 16384, 2);
  EXPECT_EQ(wave.envelope.attack_length, 15);
  EXPECT_EQ(wave.envelope.fade_length, 25);
}

TEST(EvdevOutput, TakesNoMoreOfTheDevicesEffectsThanItHasAndGivesThemBack) {
  KernelNotes kernel;
  {
    EvdevOutput output("pad", std::make_unique<NotedFile>(kernel), true, 2);
    for (int i = 0; i < 50; ++i) EXPECT_TRUE(output.play(some_haptic(moment(i)), moment(i)));
    EXPECT_EQ(kernel.next_id, 2);
    kernel.events.clear();
  }
  EXPECT_EQ(kernel.removed.size(), 2u);
  for (const auto& [code, value] : kernel.events) EXPECT_EQ(value, 0);
}

TEST(EvdevOutput, SaysThatADeviceWasPulledOut) {
  KernelNotes kernel;
  EvdevOutput output("pad", std::make_unique<NotedFile>(kernel), true, 4);
  kernel.error = EAGAIN;
  EXPECT_FALSE(output.play(some_haptic(moment(0)), moment(0)));
  EXPECT_EQ(output.summary(), "pad");
  kernel.error = ENODEV;
  EXPECT_FALSE(output.play(some_haptic(moment(0)), moment(0)));
  EXPECT_NE(output.summary().find("pulled out"), std::string::npos);
  EXPECT_FALSE(output.play(some_haptic(moment(0)), moment(0)));
  output.work(moment(1));
}

TEST(EvdevOutput, NoticesThatADeviceWasPulledOutWhileNothingIsPlayed) {
  KernelNotes kernel;
  EvdevOutput output("pad", std::make_unique<NotedFile>(kernel), true, 4);
  output.work(moment(0));
  EXPECT_TRUE(output.is_there());
  kernel.is_there = false;
  output.work(moment(1000));
  EXPECT_FALSE(output.is_there());
  EXPECT_EQ(output.summary(), "pad, pulled out, was pulled out 1 times");
}

TEST(EvdevOutput, KeepsToTheLimitInSum) {
  KernelNotes kernel;
  EvdevOutput output("pad", std::make_unique<NotedFile>(kernel), true, 4);
  output.set_limit(0.6f);
  Haptic haptic = some_haptic(moment(0));
  const auto play = [&](float amplitude, int ms) {
    haptic.amplitude = amplitude;
    EXPECT_TRUE(output.play(haptic, moment(ms)));
    return kernel.uploads.back().u.rumble.weak_magnitude / 65535.0f;
  };
  EXPECT_NEAR(play(0.4f, 0), 0.4f, 0.01f);
  EXPECT_NEAR(play(0.3f, 1), 0.2f, 0.01f);  // what is left
  EXPECT_EQ(play(0.3f, 2), play(0.1f, 3));  // nothing is left, and nothing is said to the kernel
  EXPECT_EQ(kernel.uploads.size(), 2u);
  kernel.events.clear();
  EXPECT_NEAR(play(0.6f, 4), 0.6f, 0.01f);  // a stronger one ends those before it
  EXPECT_EQ(std::count_if(kernel.events.begin(), kernel.events.end(),
                          [](const auto& event) { return event.second == 0; }),
            2);
  EXPECT_NEAR(play(0.3f, 5000), 0.3f, 0.01f);  // later all of it is there again
}

TEST(EvdevOutput, OneThatIsNotThereYetTakesNothingAndSaysSo) {
  const auto output = EvdevOutput::later("a name that no device has");
  output->work(moment(0));
  EXPECT_FALSE(output->play(some_haptic(moment(0)), moment(0)));
  EXPECT_EQ(output->summary(), "a name that no device has, not found yet");
}

TEST(EvdevDevices, TheKernelTellsWhichMayRumbleWithoutOpeningThem) {
  TestFolder folder("evdev-classes");
  const auto say = [&](const std::string& event, const char* text) {
    std::filesystem::create_directories(folder.path(event + "/device/capabilities"));
    std::ofstream(folder.path(event + "/device/capabilities/ff")) << text;
    return may_rumble(event, folder.path(""));
  };
  EXPECT_FALSE(say("event0", "0\n"));
  EXPECT_FALSE(say("event1", "0 0\n"));
  EXPECT_TRUE(say("event2", "107030000 0\n"));
  EXPECT_TRUE(may_rumble("event3", folder.path("")));
}

TEST(EvdevDevices, AFolderWithoutDevicesHasNone) {
  TestFolder folder("evdev");
  EXPECT_TRUE(list_evdev_devices(folder.path("none")).empty());
  EXPECT_TRUE(list_evdev_devices("/dev/null").empty());
  const auto opened = EvdevOutput::open("a name that no device has");
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("dance haptics list"), std::string::npos);
}

}  // namespace
}  // namespace dance
