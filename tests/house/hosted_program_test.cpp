// Programs that a house runs beside itself: /bin/sh in their place.
#include "house/program/hosted_program.h"

#include <gtest/gtest.h>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "house/voice/house_voice.h"
#include "house/voice/voice_sign.h"
#include "tests/core/bus/port_double.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

int count_of(const std::string& text, const std::string& words) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at) ++count;
  return count;
}

class HostedProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto poller = Poller::create();
    ASSERT_TRUE(poller);
    poller_ = std::move(*poller);
    options_.path = "/bin/sh";
    options_.name = "dance try";
    options_.without = "without tries";
    options_.pause = options_.look = Duration::ms(5);
    options_.arguments = [this] {
      ++starts_;
      return std::vector<std::string>{"-c", script_};
    };
    options_.works = [this](pid_t, MonoTime) {
      ++asked_;
      return works_;
    };
    static const bool kTalks = (talk::begin("house"), true);  // once in a process
    ASSERT_TRUE(kTalks);
    ::testing::internal::CaptureStderr();
  }
  void open() { program_ = std::make_unique<HostedProgram>(options_, *poller_); }
  // False where it does not come; how long it takes depends on the machine.
  template <class Done>
  bool turn_until(Done done) {
    const MonoTime end = mono_now() + Duration::s(60);
    while (!done() && mono_now() < end) poller_->run_once(Duration::ms(20));
    return done();
  }
  // Ends the program.
  std::string said() {
    program_.reset();
    return ::testing::internal::GetCapturedStderr();
  }

  HostedProgram::Options options_;
  std::string script_ = "echo no device >&2; exit 1";
  int starts_ = 0, asked_ = 0;
  bool works_ = false;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<HostedProgram> program_;
};

TEST_F(HostedProgramTest, WhatItCannotHaveIsSaidOnceAndThatItWorksAgainWithAllItSaysThen) {
  const TestFolder folder("hosted-program");
  const std::string has_said = folder.path("has-said");
  int works = 0;
  options_.works = [&](pid_t, MonoTime) {
    works += std::filesystem::exists(has_said) ? 1 : 0;
    return works > 0;
  };
  open();
  ASSERT_TRUE(turn_until([&] { return starts_ == 4; }));
  script_ = "echo no device >&2; echo it rumbles >&2; touch '" + has_said + "'; exec sleep 100";
  ASSERT_TRUE(turn_until([&] { return works > 0; }));
  const std::string text = said();
  EXPECT_EQ(count_of(text, "no device\n"), 1) << text;
  EXPECT_EQ(count_of(text, "the house goes on without tries, and starts it again"), 1) << text;
  EXPECT_EQ(count_of(text, "it rumbles\n"), 1) << text;
  EXPECT_EQ(count_of(text, "dance try works again"), 1) << text;
}

TEST_F(HostedProgramTest, EndsAndStartsOnRequest) {
  options_.starts = false;
  script_ = "exec sleep 100";
  pid_t running = 0;
  options_.works = [&](pid_t program, MonoTime) {
    running = program;
    return false;
  };
  open();
  EXPECT_EQ(starts_, 0);
  program_->set_wanted(true);
  program_->set_wanted(true);
  ASSERT_TRUE(turn_until([&] { return running > 0; }));
  const pid_t first = running;
  program_->set_wanted(false);
  ASSERT_TRUE(turn_until([&] { return !send_signal(first, 0); }));
  EXPECT_EQ(starts_, 1);
  // Wanted again while the old one still ends: another one is started after its end.
  program_->set_wanted(true);
  ASSERT_TRUE(turn_until([&] { return running != first; }));
  const pid_t second = running;
  program_->set_wanted(false);
  program_->set_wanted(true);
  ASSERT_TRUE(turn_until([&] { return running != second; }));
  EXPECT_FALSE(send_signal(second, 0));
  EXPECT_EQ(starts_, 3);
  EXPECT_EQ(said(), "") << "nothing failed";
}

// An end without an error is for good, until a person asks again.
TEST_F(HostedProgramTest, StartsAgainOnRequestAfterAnEndForGood) {
  script_ = "exit 0";
  open();
  ASSERT_TRUE(turn_until([&] { return program_->has_finished(); }));
  program_->set_wanted(false);
  program_->set_wanted(true);
  EXPECT_TRUE(turn_until([&] { return starts_ == 2; }));
  said();
}

TEST_F(HostedProgramTest, AfterItHasWorkedAFailureIsNews) {
  const TestFolder folder("hosted-program");
  const std::string works = folder.path("works"), ends = folder.path("ends");
  const std::string fails = script_;
  int worked = 0;
  options_.works = [&](pid_t, MonoTime) {
    const bool is_there = std::filesystem::exists(works);
    worked += is_there ? 1 : 0;
    return is_there;
  };
  open();
  ASSERT_TRUE(turn_until([&] { return starts_ == 2; }));
  // Works until it is told to end, then ends as the others did.
  script_ = "touch '" + works + "'; until test -e '" + ends + "'; do sleep 0.01; done; rm '" +
            works + "'; " + fails;
  ASSERT_TRUE(turn_until([&] { return worked == 1; }));
  script_ = fails;
  const int before = starts_;
  std::ofstream(ends) << "\n";
  ASSERT_TRUE(turn_until([&] { return starts_ == before + 3; }));
  const std::string text = said();
  EXPECT_EQ(count_of(text, "dance try works again"), 1) << text;
  EXPECT_EQ(count_of(text, "no device\n"), 2) << text;
  EXPECT_EQ(count_of(text, "starts it again"), 2) << text;
}

TEST_F(HostedProgramTest, ThatItRunsIsNoSignThatItWorks) {
  open();
  ASSERT_TRUE(turn_until([&] { return starts_ == 2; }));
  script_ = "exec sleep 100";  // a sound server that hangs
  asked_ = 0;
  ASSERT_TRUE(turn_until([&] { return asked_ > 50; }));
  const std::string text = said();
  EXPECT_EQ(count_of(text, "works again"), 0) << text;
}

TEST_F(HostedProgramTest, IsStartedLaterWhereItCouldNotBeStarted) {
  const TestFolder folder("hosted-program");
  options_.path = folder.path("dance-try");
  open();
  ASSERT_TRUE(turn_until([&] { return starts_ == 3; }));
  std::filesystem::create_symlink("/bin/sh", options_.path);
  script_ = "exec sleep 100";
  works_ = true;
  asked_ = 0;
  ASSERT_TRUE(turn_until([&] { return asked_ > 0; }));
  const std::string text = said();
  EXPECT_EQ(count_of(text, "starts it again"), 1) << text;
  EXPECT_EQ(count_of(text, "dance try works again"), 1) << text;
}

TEST_F(HostedProgramTest, OneThatDiedIsStartedAgainSooner) {
  options_.pause = Duration::s(1000);
  options_.first_pause = Duration::ms(5);
  script_ = "kill -9 $$";
  open();
  ASSERT_TRUE(turn_until([&] { return starts_ == 4; }));
  const std::string text = said();
  EXPECT_GE(count_of(text, "dance try ended by signal 9; the house goes on without tries"), 3)
      << text;
}

TEST_F(HostedProgramTest, WrongUseAndAnEndWithoutErrorAreForGood) {
  for (const char* script : {"exit 2", "exit 0"}) {
    script_ = script;
    starts_ = 0;
    open();
    // What ends is seen within a few looks; then nothing starts it.
    int looks = 0;
    const Poller::TimerId timer =
        poller_->add_timer(mono_now() + Duration::ms(5), [&](MonoTime now) {
          ++looks;
          return now + Duration::ms(5);
        });
    ASSERT_TRUE(turn_until([&] { return looks > 100; }));
    poller_->remove_timer(timer);
    EXPECT_EQ(starts_, 1) << script;
    program_.reset();
  }
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(count_of(text, "starts it again"), 0) << text;
}

// A port that keeps what is published.
class KeepingPort final : public SignalPort {
 public:
  const Counters& counters() const override { return counters_; }
  void send(const Channel& channel, const AnyMessage&) override {
    published_.emplace_back(channel.view());
  }
  void add(std::shared_ptr<Subscription>) override {}

  std::vector<std::string> published_;

 private:
  Counters counters_;
};

TEST(HouseVoice, ReportsAVoiceWithoutSoundWhileItsProgramHasNone) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  KeepingPort port;
  HostedVoice hosted;
  hosted.guest = *GuestId::parse("alice");
  ::testing::internal::CaptureStderr();  // there is no dance-voice beside this test
  {
    const HouseVoice voice(hosted, "memq://", port, **poller);
    const MonoTime end = mono_now() + Duration::s(60);
    while (port.published_.empty() && mono_now() < end) (*poller)->run_once(Duration::ms(50));
  }
  ::testing::internal::GetCapturedStderr();
  ASSERT_FALSE(port.published_.empty());
  EXPECT_EQ(port.published_[0], "VOICE_STATE/capture/alice");
}

// A window turns on a voice that the house file does not enable, and off again.
TEST(HouseVoice, IsTurnedOnAndOffByAWindowAndThenHearsNobody) {
  constexpr const char* kVoiceBus = "udpm://239.255.76.67:7755?ttl=0";
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  PortDouble port;
  std::vector<VoiceState> states;
  HostedVoice hosted;
  hosted.guest = *GuestId::parse("alice");
  hosted.enabled = false;
  port.subscribe<VoiceState>(
      {Where::kCapture, hosted.guest},
      [&](const Channel&, const VoiceState& state, MonoTime) { states.push_back(state); });
  ::testing::internal::CaptureStderr();
  {
    const HouseVoice voice(hosted, kVoiceBus, port, **poller);
    EXPECT_TRUE(send_voice_switch(kVoiceBus, hosted.guest, false)) << "it is off: nothing changes";
    EXPECT_TRUE(send_voice_switch(kVoiceBus, hosted.guest, true));
    EXPECT_TRUE(send_voice_switch(kVoiceBus, hosted.guest, false));
    const MonoTime end = mono_now() + Duration::s(60);
    while (states.empty() && mono_now() < end) (*poller)->run_once(Duration::ms(50));
  }
  const std::string said = ::testing::internal::GetCapturedStderr();
  ASSERT_EQ(states.size(), 1u) << said;
  EXPECT_TRUE(states[0].is_muted && states[0].is_deafened);
  EXPECT_FALSE(states[0].is_heard);
  EXPECT_TRUE(states[0].has_microphone && states[0].has_loudspeaker) << "no device is missing";
}

TEST(VoiceSign, IsAStateOfThisMachineWithADeviceOfAProgramThatDidNotEndSoon) {
  constexpr std::uint64_t kHere = 5;
  const MonoTime start = MonoTime() + Duration::s(100);
  const MonoTime later = start + Duration::s(12);
  VoiceState state;
  state.clock_id = kHere;
  VoiceSign sign(kHere);
  EXPECT_FALSE(sign.works_since(start)) << "however long it runs";
  sign.see(state, start - Duration::s(1));
  EXPECT_FALSE(sign.works_since(start)) << "of the program before";
  sign.see(state, start + Duration::ms(50));
  EXPECT_FALSE(sign.works_since(start)) << "of another program, for which this one ends";
  state.clock_id = kHere + 1;
  sign.see(state, later);
  state.clock_id = kHere;
  state.has_microphone = state.has_loudspeaker = false;
  sign.see(state, later);
  EXPECT_FALSE(sign.works_since(start));
  state.has_loudspeaker = true;
  sign.see(state, later);
  EXPECT_TRUE(sign.works_since(start));
}

}  // namespace
}  // namespace dance
