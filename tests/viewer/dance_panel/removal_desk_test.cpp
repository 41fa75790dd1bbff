// From the button that removes a guest to the words about it.
#include "viewer/dance_panel/removal_desk.h"

#include <gtest/gtest.h>

#include "tests/viewer/instruments/synthetic_line.h"

namespace dance {
namespace {

const Texts kRemovalTexts(Language::kEnglish);

struct Desk {
  void run(Duration duration) {
    for (const MonoTime end = now + duration; now < end; now += Duration::ms(16)) {
      desk.follow(link, board, now);
      while (const auto asked = board.take_asked()) {
        ++asks;
        guest = asked->guest;
        number = asked->what;
      }
    }
  }
  void answer(RemovalVerdict verdict) {
    link.emplace();
    link->link.removal = number;
    link->link.verdict = verdict;
    link->at = now;
  }
  std::string words() const { return desk.words(ShownNames(), kRemovalTexts, now); }

  RemovalDesk desk;
  DanceBoard board;
  std::optional<DanceBoard::HeardLink> link;
  MonoTime now = at_ms(50'000.0);
  int asks = 0;
  GuestId guest;
  std::int32_t number = 0;
};

TEST(RemovalDesk, AsksUntilTheLinkHasHeardItAndTellsWhatBecameOfIt) {
  Desk desk;
  EXPECT_EQ(desk.words(), "");
  desk.desk.remove(guest_called("bob"), desk.now);
  desk.run(Duration::ms(500));
  EXPECT_EQ(desk.asks, 3);
  EXPECT_EQ(desk.guest, guest_called("bob"));
  EXPECT_NE(desk.number, 0);
  EXPECT_EQ(desk.words(), "The server is asked to remove bob.");
  desk.answer(RemovalVerdict::kAsked);
  desk.run(Duration::ms(500));
  EXPECT_EQ(desk.asks, 3) << "the link has it";
  desk.answer(RemovalVerdict::kDone);
  desk.run(Duration::ms(100));
  EXPECT_EQ(desk.words(), "bob was removed for 10 minutes.");
  desk.run(Duration::s(9));
  EXPECT_EQ(desk.words(), "") << "told long enough";
}

TEST(RemovalDesk, SaysSoWhereNoLinkHearsIt) {
  Desk desk;
  desk.desk.remove(guest_called("bob"), desk.now);
  desk.run(Duration::s(3));
  EXPECT_EQ(desk.words(), "Your connection did not accept the request.");
  EXPECT_LE(desk.asks, 11);
}

TEST(RemovalDesk, AnotherWishHasAnotherNumber) {
  Desk desk;
  desk.desk.remove(guest_called("bob"), desk.now);
  desk.run(Duration::ms(20));
  const std::int32_t first = desk.number;
  desk.answer(RemovalVerdict::kNotAllowed);
  desk.desk.remove(guest_called("bob"), desk.now);
  desk.run(Duration::ms(20));
  EXPECT_NE(desk.number, first);
  EXPECT_EQ(desk.words(), "The server is asked to remove bob.") << "not the old answer";
}

TEST(RemovalDesk, HasWordsForEachAnswer) {
  for (int verdict = 0; verdict <= static_cast<int>(RemovalVerdict::kOwnGuest); ++verdict) {
    Desk desk;
    desk.desk.remove(guest_called("bob"), desk.now);
    desk.run(Duration::ms(20));
    desk.answer(static_cast<RemovalVerdict>(verdict));
    desk.run(Duration::ms(20));
    EXPECT_FALSE(desk.words().empty()) << verdict;
    EXPECT_EQ(desk.words().find("{}"), std::string::npos) << verdict;
  }
}

}  // namespace
}  // namespace dance
