#include "producers/music/room/band_program.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/bus/voice.h"
#include "core/net/mono_clock.h"
#include "tests/core/bus/port_double.h"

namespace dance {
namespace {

// Keeps the time, and records its volume and pauses.
class RecordingPlayer : public SilentPlayer {
 public:
  void set_volume(double volume) override { volume_ = volume; }
  void pause() override {
    is_paused_ = true;
    SilentPlayer::pause();
  }
  double volume_ = -1.0;
  bool is_paused_ = false;
};

class BandProgramTest : public ::testing::Test {
 protected:
  BandProgramTest() {
    auto poller = Poller::create();
    EXPECT_TRUE(poller);
    poller_ = std::move(*poller);
    port_.subscribe<Beat>(Where::kLocal,
                          [this](const Channel&, const Beat& beat, MonoTime) { beat_ = beat; });
    port_.subscribe<RoomSong>(Where::kCapture, [this](const Channel&, const RoomSong& song,
                                                      MonoTime) { requested_ = song; });
  }
  void open(bool follows) {
    BandRoom::Options options;
    options.guest = *GuestId::parse("ann");
    options.follows = follows;
    options.seed = 3;
    options.clock_id = this_clock_id();
    program_ = std::make_unique<BandProgram>(options, 0.5, port_, *poller_);
    auto player = std::make_unique<RecordingPlayer>();
    player_ = player.get();
    program_->set_player(std::move(player));
  }
  void after(Duration time, std::function<void()> what) {
    poller_->add_timer(mono_now() + time, [what = std::move(what)](MonoTime) {
      what();
      return MonoTime();
    });
  }
  // Once: a poller that was stopped does not go on.
  void run(Duration time) {
    after(time, [this] { poller_->stop(); });
    poller_->run();
  }

  PortDouble port_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<BandProgram> program_;
  RecordingPlayer* player_ = nullptr;
  std::optional<Beat> beat_;
  std::optional<RoomSong> requested_;
};

TEST_F(BandProgramTest, PublishesItsSongAndTheBeatsOfTheScore) {
  open(false);
  run(Duration::ms(900));
  ASSERT_TRUE(requested_);
  EXPECT_EQ(requested_->seed, 3u);
  ASSERT_TRUE(beat_);
  EXPECT_TRUE(beat_->playing);
  EXPECT_EQ(beat_->beats_per_bar, 4);
  const double s = (beat_->beat_time - requested_->start_time).as_seconds();
  EXPECT_NEAR(program_->set()->beat_at(s), beat_->beat, 0.01);
}

TEST_F(BandProgramTest, IsSofterWhileAnotherHouseSpeaks) {
  open(false);
  double before = 0.0;
  after(Duration::ms(50), [&] {
    before = player_->volume_;
    Voice voice;
    voice.level_dbfs = -20;
    voice.capture_time = port_.now = mono_now();
    const std::uint8_t packet[] = {1, 2, 3};
    ASSERT_TRUE(voice.set_packet(packet));
    port_.publish(Where::kGuest, *GuestId::parse("bob"), voice);
  });
  run(Duration::ms(100));
  EXPECT_EQ(before, 0.5);
  EXPECT_GT(player_->volume_, 0.0);
  EXPECT_LT(player_->volume_, 0.5);
}

TEST_F(BandProgramTest, AppliesCommandsForVolumeAndPause) {
  open(false);
  after(Duration::ms(100), [&] {
    MusicCommand command;
    command.volume = 0.1;
    program_->apply(command);
    program_->apply({MusicCommand::What::kPause});
  });
  run(Duration::ms(300));
  EXPECT_EQ(player_->volume_, 0.1);
  EXPECT_TRUE(player_->is_paused_);
  ASSERT_TRUE(requested_);
  EXPECT_FALSE(requested_->playing);
  ASSERT_TRUE(beat_);
  EXPECT_FALSE(beat_->playing);
}

}  // namespace
}  // namespace dance
