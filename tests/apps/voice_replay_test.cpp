// What two guests said, recorded in the house of one of them, is heard again when dance replay
// plays it: both sides, by that guest and by another one.
#include <map>

#include "testing/voice/voice_stream.h"
#include "tests/apps/voice_programs.h"

namespace dance {
namespace {

constexpr int kEnough = 400;  // frames of each voice

// Voices of a bus as they come: when each frame was captured.
struct Witness {
  explicit Witness(SignalPort& bus) {
    for (const Where where : {Where::kCapture, Where::kGuest})
      bus.subscribe<Voice>(where, [this](const Channel& channel, const Voice& voice, MonoTime) {
        captured[std::string(channel.guest().view())].emplace(voice.sequence, voice.capture_time);
      });
    bus.subscribe<VoiceState>(Where::kCapture,
                              [this](const Channel& channel, const VoiceState& state, MonoTime) {
                                states[std::string(channel.guest().view())] = state;
                              });
    bus.subscribe<VoiceLevel>(
        Where::kCapture, [this](const Channel& channel, const VoiceLevel& level, MonoTime) {
          auto& [softest, loudest] =
              levels.try_emplace(std::string(channel.guest().view()), 0, -127).first->second;
          softest = std::min(softest, level.level_dbfs);
          loudest = std::max(loudest, level.level_dbfs);
        });
  }
  std::map<std::string, std::map<std::uint32_t, MonoTime>> captured;
  std::map<std::string, VoiceState> states;
  std::map<std::string, std::pair<int, int>> levels;  // softest and loudest of the microphone
};

class VoiceReplay : public VoicePrograms {
 protected:
  std::unique_ptr<Bus> open_bus() {
    auto bus = Bus::open(kBus);
    EXPECT_TRUE(bus) << bus.error().what;
    return bus ? std::move(*bus) : nullptr;
  }
  ChildProcess& start_voice(const std::string& guest) {
    return start("dance-voice",
                 {"--guest", guest, "--bus", kBus, "--microphone", "mouth-a.monitor",
                  "--loudspeaker", "ear-a", "--no-echo-cancellation", "--no-cleaning"});
  }
  // alice says the first, bob, who is in another house, the second; recorded in alice's house.
  void record() {
    Witness witness(*ear_);
    ChildProcess& voice = start_voice("alice");
    ChildProcess& recorder = start("dance-record", {"-o", log_, "--bus", kBus});
    ASSERT_TRUE(work_until([&] {
      return witness.states.contains("alice") && std::filesystem::exists(log_);
    })) << talk();
    EXPECT_TRUE(witness.states["alice"].is_heard);
    EXPECT_TRUE(witness.states["alice"].has_microphone);
    const auto mouth = rooms_->listen("mouth-a"), ear = rooms_->listen("ear-a");
    ASSERT_TRUE(mouth && ear);
    const auto speech = make_speech(6.0, 0, folder_.path("speech.wav"));
    ASSERT_TRUE(speech) << speech.error().what;
    said_begin_ = mono_now();
    ASSERT_TRUE(rooms_->play("mouth-a", *speech));
    ASSERT_TRUE(work_until([&] { return witness.captured["alice"].size() > kEnough; })) << talk();
    EXPECT_EQ(witness.levels["alice"].first, kSilence_dbfs) << "a mouth that said nothing yet";
    EXPECT_GT(witness.levels["alice"].second, -40) << "speech, as a window shows it";
    said_ = rooms_->heard(*mouth, said_begin_, mono_now() - said_begin_);
    // The own voice is not played while it is live.
    double own = 0.0;
    for (const float sample : rooms_->heard(*ear, said_begin_, mono_now() - said_begin_))
      own += static_cast<double>(sample * sample);
    EXPECT_LT(own, 1e-6);
    const auto other = make_speech(6.0, 1, folder_.path("speech.wav"));
    ASSERT_TRUE(other) << other.error().what;
    const auto sent = encode_voice(*other, {});
    ASSERT_TRUE(sent) << sent.error().what;
    bob_said_ = *other;
    bob_begin_ = mono_now();
    std::size_t next = 0;
    ASSERT_TRUE(work_until([&] {
      while (next < sent->packets.size() && next < kEnough) {
        Voice packet = sent->packets[next];
        packet.capture_time = bob_begin_ + (packet.capture_time - kVoiceBegin);
        if (packet.capture_time > mono_now()) return false;
        packet.clock_id = this_clock_id();
        ear_->publish(Where::kGuest, *GuestId::parse("bob"), packet);
        ++next;
      }
      return witness.captured["bob"].size() > kEnough / 2 && next >= kEnough;
    })) << talk();
    recorder.stop(Duration::s(5));
    voice.stop(Duration::s(5));
    live_ = witness.captured;
  }
  // Of what was said, how much the ear heard again, where a frame's new capture time tells when.
  void expect_again(Witness& witness, std::size_t ear, const std::string& guest,
                    const std::vector<float>& said, MonoTime begin) {
    for (const auto& [sequence, captured] : witness.captured[guest]) {
      const auto live = live_[guest].find(sequence);
      if (live == live_[guest].end()) continue;
      const MonoTime again = begin + (captured - live->second);
      const Duration length = mono_now() - again;
      const MatchFigures figures =
          figures_of(match_sound(said, rooms_->heard(ear, again, length), -100.0, 600.0));
      std::printf("%s: %zu of %zu pieces are heard again, %.0f ms later (median)\n", guest.c_str(),
                  figures.fitting, figures.pieces, figures.median_ms);
      EXPECT_GE(figures.fitting, 4u) << talk();
      return;
    }
    ADD_FAILURE() << "nothing of " << guest << " was played again " << talk();
  }
  void expect_both_again_by(const std::string& listener) {
    ear_ = open_bus();
    ASSERT_TRUE(ear_);
    Witness witness(*ear_);
    ChildProcess& voice = start_voice(listener);
    ASSERT_TRUE(work_until([&] { return witness.states.contains(listener); })) << talk();
    // By then it knows who else speaks here.
    const MonoTime settled = mono_now() + Duration::s(3);
    ASSERT_TRUE(work_until([&] { return mono_now() > settled; }));
    const auto ear = rooms_->listen("ear-a");
    ASSERT_TRUE(ear);
    witness.captured.clear();
    ChildProcess& replay = start("dance-replay", {log_, "--once", "--bus", kBus});
    ASSERT_TRUE(work_until([&] { return replay.has_ended(); })) << talk();
    const MonoTime played_out = mono_now() + Duration::ms(500);
    ASSERT_TRUE(work_until([&] { return mono_now() > played_out; }));
    expect_again(witness, *ear, "alice", said_, said_begin_);
    expect_again(witness, *ear, "bob", bob_said_, bob_begin_);
    voice.stop(Duration::s(5));
  }

  std::string log_ = folder_.path("talk.lcm");
  std::vector<float> said_, bob_said_;
  MonoTime said_begin_, bob_begin_;
  std::map<std::string, std::map<std::uint32_t, MonoTime>> live_;
};

TEST_F(VoiceReplay, BothSidesAreHeardAgain) {
  open_rooms();
  ear_ = open_bus();
  ASSERT_TRUE(ear_);
  record();
  if (HasFatalFailure()) return;
  expect_both_again_by("alice");
  expect_both_again_by("carl");
}

}  // namespace
}  // namespace dance
