#include "transformers/tempo/room_steps.h"

#include <gtest/gtest.h>

#include <string>

#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

using Whose = RoomSteps::Whose;
constexpr double kRoomPoses_hz = 60.0;
constexpr int kPosesAPass = 15;

GuestId dancer_named(const std::string& name) { return *GuestId::parse(name); }

SalsaDancer salsa_at(double tempo_bpm, SalsaRole role = SalsaRole::kLead, std::uint64_t seed = 5) {
  SalsaStyle style;
  style.tempo_bpm = tempo_bpm;
  style.role = role;
  style.seed = seed;
  return SalsaDancer(style);
}

// A room in which time goes by: poses sixty times a second, and what is said four times.
class Room {
 public:
  explicit Room(double music_bpm = 0.0) : music_bpm_(music_bpm) {}

  struct Guest {
    GuestId guest;
    Whose whose;
    SalsaDancer* dancer;
    double music_bpm = 0.0;  // of musical time on its poses
  };
  std::optional<Steps> dance(std::vector<Guest> guests, double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * kRoomPoses_hz); ++i) {
      const double s = tick_++ / kRoomPoses_hz;
      now_ = MonoTime() + Duration::seconds(1.0 + s);
      for (Guest& guest : guests) {
        guest.dancer->dance_at(Duration::seconds(s), pose_);
        pose_.capture_time = now_;
        pose_.clock_id = 1;
        pose_.music_beats = guest.music_bpm > 0.0 ? s * guest.music_bpm / 60.0 : kNoMusic;
        steps_.observe(guest.whose, guest.guest, pose_, now_);
      }
      if (music_bpm_ > 0.0 && tick_ % kPosesAPass == 0) hear(s);
      if (tick_ % kPosesAPass == 0) said_ = steps_.pass(now_);
    }
    return said_;
  }
  RoomSteps& steps() { return steps_; }
  MonoTime now() const { return now_; }

 private:
  void hear(double s) {
    Beat beat;
    beat.time = beat.beat_time = now_;
    beat.tempo_bpm = music_bpm_;
    beat.beat = s * music_bpm_ / 60.0;
    beat.playing = true;
    steps_.hear(beat);
  }

  double music_bpm_;
  RoomSteps steps_;
  std::optional<Steps> said_;
  Pose pose_;
  MonoTime now_;
  int tick_ = 0;
};

TEST(RoomSteps, AreThoseOfTheDancersAtWhicheverLevelTheMusicIsHeard) {
  for (const double bpm : {76.0, 84.0, 92.0, 100.0, 106.0, 150.0, 176.0, 204.0})
    for (const SalsaRole role : {SalsaRole::kLead, SalsaRole::kFollow}) {
      std::optional<Steps> first;
      for (const double heard : {1.0, 2.0, 0.5}) {
        SalsaDancer dancer = salsa_at(bpm, role);
        Room room(heard * bpm);
        const auto said = room.dance({{dancer_named("alice"), Whose::kOwn, &dancer}}, 30.0);
        ASSERT_TRUE(said) << bpm;
        EXPECT_NEAR(said->tempo_bpm, bpm, 0.05 * bpm);
        EXPECT_GT(said->weight, 0.4f) << bpm;
        EXPECT_EQ(said->dancers, 1);
        EXPECT_FALSE(said->is_remote);
        if (!first) first = said;
        EXPECT_EQ(said->tempo_bpm, first->tempo_bpm)
            << "who told the tempo may be wrong by an octave";
        EXPECT_EQ(said->weight, first->weight);
      }
    }
}

TEST(RoomSteps, SayNothingOfAMusicToWhichNobodySteps) {
  for (const double bpm : {92.0, 130.0, 180.0})
    for (const double ratio : {1.22, 1.41, 0.8}) {
      SalsaDancer dancer = salsa_at(bpm);
      Room room(ratio * bpm);
      const auto said = room.dance({{dancer_named("alice"), Whose::kOwn, &dancer}}, 30.0);
      EXPECT_FALSE(said) << bpm << " to " << ratio * bpm << ": " << said->tempo_bpm;
    }
}

// A tracker that is wrong puts its beats on the poses, and would hear of them again.
TEST(RoomSteps, DoNotHangOnTheMusicalTimeThatPosesCarry) {
  std::optional<Steps> said[2];
  for (const bool is_tagged : {false, true}) {
    SalsaDancer dancer = salsa_at(90.0);
    Room room;
    said[is_tagged] =
        room.dance({{dancer_named("alice"), Whose::kOwn, &dancer, is_tagged ? 180.0 : 0.0}}, 25.0);
    ASSERT_TRUE(said[is_tagged]);
  }
  EXPECT_EQ(said[0]->tempo_bpm, said[1]->tempo_bpm);
  EXPECT_EQ(said[0]->weight, said[1]->weight);
}

TEST(RoomSteps, OfADancerWhomAProgramMovesToTheMusicAreNotCounted) {
  SalsaDancer dancer = salsa_at(180.0);
  Room room;
  std::optional<Steps> said;
  for (int second = 0; second < 25; ++second) {
    room.steps().tell(dancer_named("alice"), Steps(), room.now());
    said = room.dance({{dancer_named("alice"), Whose::kOwn, &dancer}}, 1.0);
  }
  EXPECT_FALSE(said);
  // A producer that says no more is not believed for ever.
  EXPECT_TRUE(room.dance({{dancer_named("alice"), Whose::kOwn, &dancer}}, 15.0));
}

TEST(RoomSteps, AreWhatAProducerSaysThatKnowsThem) {
  SalsaDancer dancer = salsa_at(180.0);
  Steps told;
  told.tempo_bpm = 90.0;
  told.weight = 1.0f;
  Room room;
  std::optional<Steps> said;
  for (int second = 0; second < 15; ++second) {
    room.steps().tell(dancer_named("alice"), told, room.now());
    said = room.dance({{dancer_named("alice"), Whose::kOwn, &dancer}}, 1.0);
  }
  ASSERT_TRUE(said);
  EXPECT_NEAR(said->tempo_bpm, 90.0, 3.0);
}

TEST(RoomSteps, AreOfOthersOnlyWhereNobodyDancesHere) {
  SalsaDancer here = salsa_at(100.0), away = salsa_at(180.0);
  Room room;
  const Room::Guest own{dancer_named("alice"), Whose::kOwn, &here};
  const Room::Guest remote{dancer_named("bob"), Whose::kRemote, &away};
  auto said = room.dance({own, remote}, 25.0);
  ASSERT_TRUE(said);
  EXPECT_FALSE(said->is_remote);
  EXPECT_NEAR(said->tempo_bpm, 100.0, 5.0);
  said = room.dance({remote}, 10.0);
  ASSERT_TRUE(said);
  EXPECT_TRUE(said->is_remote);
  EXPECT_NEAR(said->tempo_bpm, 180.0, 9.0);
}

TEST(RoomSteps, AreNotSaidWhenNobodyDances) {
  SalsaDancer dancer = salsa_at(120.0);
  Room room;
  EXPECT_FALSE(room.dance({}, 2.0));
  EXPECT_FALSE(room.dance({{dancer_named("alice"), Whose::kOwn, &dancer}}, 4.0));
  EXPECT_TRUE(room.dance({{dancer_named("alice"), Whose::kOwn, &dancer}}, 20.0));
  EXPECT_FALSE(room.dance({}, 4.0 + RoomSteps::kSilence.as_seconds()));
}

TEST(RoomSteps, OfPeopleWhoStandAreNotKnown) {
  Room room;
  SalsaStyle style;
  style.tempo_bpm = 120.0;
  SalsaDancer dancer(style);
  Pose pose;
  dancer.dance_at(Duration(), pose);
  pose.clock_id = 1;
  RoomSteps steps;
  for (int i = 0; i < 60 * 30; ++i) {
    const MonoTime now = MonoTime() + Duration::seconds(1.0 + i / kRoomPoses_hz);
    pose.capture_time = now;
    steps.observe(Whose::kOwn, dancer_named("alice"), pose, now);
    if (i % kPosesAPass == 0) {
      EXPECT_FALSE(steps.pass(now));
    }
  }
}

TEST(RoomSteps, OfADancerHereFindAPlaceAmongManyGuests) {
  SalsaDancer here = salsa_at(100.0), away = salsa_at(180.0);
  std::vector<Room::Guest> guests;
  for (std::size_t i = 0; i < RoomSteps::kMostDancers + 4; ++i)
    guests.push_back({dancer_named("guest-" + std::to_string(i)), Whose::kRemote, &away});
  Room room;
  room.dance(guests, 1.0);
  guests.push_back({dancer_named("alice"), Whose::kOwn, &here});
  const auto said = room.dance(guests, 20.0);
  ASSERT_TRUE(said);
  EXPECT_FALSE(said->is_remote);
  EXPECT_NEAR(said->tempo_bpm, 100.0, 5.0);
}

TEST(RoomSteps, AllocateNothing) {
  SalsaDancer dancer = salsa_at(120.0);
  const GuestId alice = dancer_named("alice");
  RoomSteps steps;
  Pose pose;
  dancer.dance_at(Duration(), pose);
  const AllocationGuard guard;
  for (int i = 0; i < 60 * 12; ++i) {
    const MonoTime now = MonoTime() + Duration::seconds(1.0 + i / kRoomPoses_hz);
    dancer.dance_at(Duration::seconds(i / kRoomPoses_hz), pose);
    pose.capture_time = now;
    steps.observe(Whose::kOwn, alice, pose, now);
    steps.pass(now);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
