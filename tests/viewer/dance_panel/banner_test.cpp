// Which banner is shown, and what it says.
#include "viewer/dance_panel/banner.h"

#include <gtest/gtest.h>

#include "viewer/dance_panel/banner_watch.h"

namespace dance {
namespace {

const Texts kBannerTexts(Language::kEnglish);
constexpr MonoTime kBannerBegin = MonoTime::from_us(60'000'000);
GuestId guest_named(const char* name) { return *GuestId::parse(name); }

HouseLink link_with(HouseLinkState state, HouseLinkTrouble trouble = HouseLinkTrouble::kNone) {
  HouseLink link;
  link.time = kBannerBegin;
  link.state = state;
  link.trouble = trouble;
  return link;
}

// Everything is wrong that can be wrong at once.
BannerFacts all_wrong() {
  BannerFacts facts;
  facts.link = link_with(HouseLinkState::kLapsed);
  facts.link_down = Duration::s(9);
  facts.still = guest_named("alice");
  facts.still_for = Duration::s(6);
  facts.recording_trouble = "No space left on device";
  facts.slow_for = Duration::s(9);
  facts.pictures_hz = 12.0f;
  facts.lacks_microphone = true;
  facts.microphone_silent = Duration::s(60);
  facts.speaks_muted = Duration::s(3);
  facts.clock_jump = Duration::s(-7);
  return facts;
}

TEST(Banner, NothingIsWrongWhereNothingIsKnown) {
  EXPECT_TRUE(troubles_of({}).none());
  BannerFacts facts;
  facts.link = link_with(HouseLinkState::kConnected);
  EXPECT_TRUE(troubles_of(facts).none());
  facts.link = link_with(HouseLinkState::kConnecting);
  facts.link_down = Duration::s(1);
  EXPECT_TRUE(troubles_of(facts).none()) << "it has just begun";
}

TEST(Banner, TheMostUrgentIsShownAndThenTheNext) {
  BannerChoice choice;
  const BannerFacts facts = all_wrong();
  std::vector<BannerKind> shown;
  while (const auto kind = choice.choose(facts)) {
    shown.push_back(*kind);
    choice.close(*kind);
    ASSERT_LE(shown.size(), kBannerKinds);
  }
  EXPECT_EQ(shown, (std::vector{BannerKind::kServerSilent, BannerKind::kNoPoses,
                                BannerKind::kRecordingFailed, BannerKind::kNoMicrophone,
                                BannerKind::kMicrophoneSilent, BannerKind::kSpeaksMuted,
                                BannerKind::kClockJumped}));
}

TEST(Banner, OneThatWasClosedComesBackWithItsCause) {
  BannerChoice choice;
  BannerFacts facts;
  facts.speaks_muted = Duration::s(3);
  choice.close(*choice.choose(facts));
  EXPECT_FALSE(choice.choose(facts));
  facts.speaks_muted = Duration();
  EXPECT_FALSE(choice.choose(facts));
  facts.speaks_muted = Duration::s(3);
  EXPECT_EQ(choice.choose(facts), BannerKind::kSpeaksMuted);
}

TEST(Banner, TellsWhyTheServerHasNoSessionForThisHouse) {
  const auto first = [](HouseLinkState state, HouseLinkTrouble trouble) {
    BannerFacts facts;
    facts.link = link_with(state, trouble);
    facts.link_down = Duration::s(10);
    BannerChoice choice;
    return choice.choose(facts);
  };
  using State = HouseLinkState;
  using Trouble = HouseLinkTrouble;
  EXPECT_EQ(first(State::kConnecting, Trouble::kWrongKey), BannerKind::kKeyRefused);
  EXPECT_EQ(first(State::kLapsed, Trouble::kWrongKey), BannerKind::kKeyRefused);
  EXPECT_EQ(first(State::kConnecting, Trouble::kNotTrusted), BannerKind::kNotTrusted);
  EXPECT_EQ(first(State::kConnecting, Trouble::kServerKeyChanged), BannerKind::kServerKeyChanged);
  EXPECT_EQ(first(State::kConnecting, Trouble::kRemoved), BannerKind::kRemoved);
  EXPECT_EQ(first(State::kConnecting, Trouble::kRefused), BannerKind::kRefused);
  EXPECT_EQ(first(State::kLapsed, Trouble::kClosed), BannerKind::kRoomClosed);
  EXPECT_EQ(first(State::kLapsed, Trouble::kNone), BannerKind::kServerSilent);
  EXPECT_EQ(first(State::kConnecting, Trouble::kNoAnswer), BannerKind::kServerSilent);
  EXPECT_EQ(first(State::kConnecting, Trouble::kInterrupted), BannerKind::kServerSilent);
  EXPECT_EQ(first(State::kConnected, Trouble::kNone), std::nullopt);
  BannerFacts gone;
  gone.link = link_with(State::kConnected);
  gone.link_silent = Duration::s(6);
  BannerChoice choice;
  EXPECT_EQ(choice.choose(gone), BannerKind::kLinkGone) << "its program has ended";
}

TEST(Banner, HasWordsACureAndAButtonWhereOnePressMendsIt) {
  BannerFacts facts = all_wrong();
  facts.link->asks_again = facts.link->time + Duration::s(541);
  facts.link->refused = guest_named("dora");
  for (const LanguageName& language : kLanguages)
    for (std::size_t i = 0; i < kBannerKinds; ++i) {
      const Banner banner = banner_of(static_cast<BannerKind>(i), facts, Texts(language.language));
      EXPECT_FALSE(banner.what.empty()) << i;
      EXPECT_FALSE(banner.cure.empty()) << i;
      EXPECT_EQ((banner.what + banner.cure).find("{}"), std::string::npos) << banner.what;
    }
  EXPECT_EQ(banner_of(BannerKind::kNoPoses, facts, kBannerTexts).what,
            "alice is not seen: no movement for 6 s.");
  EXPECT_EQ(banner_of(BannerKind::kClockJumped, facts, kBannerTexts).what,
            "This computer's clock jumped by 7 s.");
  EXPECT_EQ(banner_of(BannerKind::kRemoved, facts, kBannerTexts).cure,
            "This house may come back in 10 min. Ask the host.");
  EXPECT_EQ(banner_of(BannerKind::kRemoved, facts, kBannerTexts).action, BannerAction::kLeave);
  EXPECT_EQ(banner_of(BannerKind::kRoomClosed, facts, kBannerTexts).what,
            "The room has been closed.");
  facts.host = guest_named("hanna");
  EXPECT_EQ(banner_of(BannerKind::kRoomClosed, facts, kBannerTexts).what,
            "hanna has closed the room.");
  const ShownNames::Named hanna{facts.host, *parse_shown_name("Hanna M\u00fcller")};
  facts.names = ShownNames({&hanna, 1}, {});
  EXPECT_EQ(banner_of(BannerKind::kRoomClosed, facts, Texts(Language::kGerman)).what,
            "Hanna M\u00fcller hat den Raum geschlossen.");
  EXPECT_EQ(banner_of(BannerKind::kRefused, facts, kBannerTexts).what,
            "The server does not let dora in.");
  EXPECT_EQ(banner_of(BannerKind::kNoSound, facts, kBannerTexts).what,
            "Your microphone cannot be reached: this computer's sound system does not answer.");
  EXPECT_EQ(banner_of(BannerKind::kSpeaksMuted, facts, kBannerTexts).action, BannerAction::kUnmute);
}

// The signals, as they come from bus and window.
struct Watched {
  void run(Duration duration) {
    for (const MonoTime end = now + duration; now < end; now += Duration::ms(100)) {
      if (link) board.on_link(*link, now);
      if (level) board.on_level(guest_named("alice"), *level, now);
      if (moves && (now - kBannerBegin).count_ms() % 1000 == 0) ++own.received;
      own.alive = moves;
      if ((now - kBannerBegin).count_ms() % 1000 == 0 && (moves || says_still))
        board.on_status(guest_named("alice"), own, now);
      records.take(board, now);
      watch.update(records, scene, drawing, (now - MonoTime()) + wall_ahead, now);
    }
  }
  std::optional<BannerKind> shown() { return choice.choose(watch.facts()); }

  DanceBoard board;
  DanceRecords records;
  BannerWatch watch;
  BannerChoice choice;
  SceneState scene;
  BannerWatch::Drawing drawing;
  std::optional<HouseLink> link = link_with(HouseLinkState::kConnected);
  std::optional<VoiceLevel> level;
  GuestStatus own;
  bool moves = true, says_still = false;
  Duration wall_ahead = Duration::s(1'700'000'000);
  MonoTime now = kBannerBegin;
};

TEST(BannerWatch, ACameraThatGivesNothingMore) {
  Watched house;
  house.run(Duration::s(20));
  EXPECT_EQ(house.shown(), std::nullopt);
  house.moves = false;
  house.run(Duration::s(3));
  EXPECT_EQ(house.shown(), std::nullopt) << "somebody ties a shoe";
  house.run(Duration::s(3));
  EXPECT_EQ(house.shown(), BannerKind::kNoPoses);
  house.moves = true;
  house.run(Duration::s(2));
  EXPECT_EQ(house.shown(), std::nullopt);
}

TEST(BannerWatch, AServerThatFallsSilentAndComesBack) {
  Watched house;
  house.run(Duration::s(2));
  house.link->state = HouseLinkState::kLapsed;
  house.run(Duration::s(2));
  EXPECT_EQ(house.shown(), std::nullopt) << "a short lapse";
  house.run(Duration::s(2));
  EXPECT_EQ(house.shown(), BannerKind::kServerSilent);
  house.link->state = HouseLinkState::kConnected;
  house.run(Duration::ms(200));
  EXPECT_EQ(house.shown(), std::nullopt);
  house.link.reset();  // its program has ended
  house.run(Duration::s(6));
  EXPECT_EQ(house.shown(), BannerKind::kLinkGone);
}

TEST(BannerWatch, AMicrophoneThatGivesNothing) {
  Watched house;
  house.scene.voices.push_back({guest_named("alice")});
  house.level = VoiceLevel{kBannerBegin, 1, -127, -127};
  house.run(Duration::s(15));
  EXPECT_EQ(house.shown(), std::nullopt);
  house.run(Duration::s(8));
  EXPECT_EQ(house.shown(), BannerKind::kMicrophoneSilent);
  house.level->level_dbfs = -62;  // a quiet room
  house.run(Duration::ms(300));
  EXPECT_EQ(house.shown(), std::nullopt);
  house.level->level_dbfs = -127;
  house.scene.voices[0].is_heard = false;  // muted, or the key is not held
  house.run(Duration::s(30));
  EXPECT_EQ(house.shown(), std::nullopt);
  house.scene.voices[0].has_microphone = false;
  house.run(Duration::ms(300));
  EXPECT_EQ(house.shown(), BannerKind::kNoMicrophone);
  house.scene.voices[0].has_loudspeaker = false;
  house.run(Duration::ms(300));
  EXPECT_EQ(house.shown(), BannerKind::kNoSound) << "no sound server answers";
}

TEST(BannerWatch, SomebodyWhoSpeaksAndIsMuted) {
  Watched house;
  house.scene.voices.push_back({guest_named("alice")});
  house.scene.voices[0].is_muted = true;
  house.scene.voices[0].is_heard = false;
  house.level = VoiceLevel{kBannerBegin, 1, -30, -60};
  house.run(Duration::s(5));
  EXPECT_EQ(house.shown(), std::nullopt) << "music in the room, which is taken out, is no speech";
  house.level->cleaned_dbfs = -20;
  house.run(Duration::s(2));
  EXPECT_EQ(house.shown(), BannerKind::kSpeaksMuted);
  house.level->cleaned_dbfs = -60;
  house.run(Duration::s(1));
  EXPECT_EQ(house.shown(), std::nullopt);
}

TEST(BannerWatch, AClockThatJumpsAndOneThatIsCorrected) {
  Watched house;
  house.run(Duration::s(3));
  for (int i = 0; i < 10; ++i) {
    house.wall_ahead += Duration::ms(20);
    house.run(Duration::s(1));
  }
  EXPECT_EQ(house.shown(), std::nullopt) << "20 ms a second are a correction";
  house.wall_ahead += Duration::s(90);
  house.run(Duration::ms(1100));
  EXPECT_EQ(house.shown(), BannerKind::kClockJumped);
  house.run(Duration::s(15));
  EXPECT_EQ(house.shown(), std::nullopt) << "it is over";
}

TEST(BannerWatch, CountsSlowDrawingOnlyWithoutAGraphicsCardAndAtTheSmallestScale) {
  Watched house;
  house.drawing = {true, false, false, 12.0f};
  house.run(Duration::s(9));
  EXPECT_EQ(house.watch.facts().slow_for, Duration()) << "fewer pixels may help";
  house.drawing.is_at_smallest_scale = true;
  house.run(Duration::s(6));
  EXPECT_GT(house.watch.facts().slow_for, Duration::s(5));
  house.drawing.is_software = false;
  house.run(Duration::s(1));
  EXPECT_EQ(house.watch.facts().slow_for, Duration());
}

TEST(SlowNote, IsShownOnceForFifteenSecondsOrUntilItIsClosed) {
  SlowNote note;
  bool was_shown = false;
  MonoTime now = kBannerBegin;
  EXPECT_FALSE(note.is_shown(Duration::s(3), was_shown, now)) << "it has just begun";
  EXPECT_TRUE(note.is_shown(Duration::s(6), was_shown, now));
  EXPECT_TRUE(was_shown);
  EXPECT_TRUE(note.is_shown(Duration(), was_shown, now + Duration::s(2))) << "time to read it";
  EXPECT_FALSE(note.is_shown(Duration::s(60), was_shown, now + SlowNote::kShown));
  SlowNote closed;
  was_shown = false;
  EXPECT_TRUE(closed.is_shown(Duration::s(6), was_shown, now));
  closed.close();
  EXPECT_FALSE(closed.is_shown(Duration::s(7), was_shown, now));
  SlowNote of_the_next_dance;
  EXPECT_FALSE(of_the_next_dance.is_shown(Duration::s(60), was_shown, now));
}

}  // namespace
}  // namespace dance
