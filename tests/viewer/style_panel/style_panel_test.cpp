// What the style panel asks for, what it shows, and what it saves; without drawing.
#include "viewer/style_panel/style_panel.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/test_folder.h"
#include "tests/viewer/instruments/synthetic_line.h"

namespace dance {
namespace {

struct House {
  explicit House(bool is_live = true, std::unique_ptr<SessionFile> file = nullptr)
      : panel(records, board, std::move(file), is_live) {
    in_force.has = {false, true, true, true, true};
    in_force.route = 0;
  }
  // The manager tells what is in force.
  void tell(MonoTime now) {
    board.on_flow(guest_called("bob"), in_force);
    records.take(board);
    panel.follow(now);
  }

  InstrumentBoard board{kHouseClock};
  InstrumentRecords records;
  FlowSetting in_force;
  StylePanel panel;
};

TEST(StylePanel, ShowsWhatIsInForceWhoeverSetIt) {
  House house;
  house.in_force.lead = 0.25f;
  house.tell(at_ms(1000));
  EXPECT_EQ(house.panel.setting().lead, 0.25f);
  house.in_force.lead = 0.75f;  // dance style, another panel
  house.tell(at_ms(2000));
  EXPECT_EQ(house.panel.setting().lead, 0.75f);
  EXPECT_FALSE(house.board.take_asked_flow()) << "nothing was changed here";
}

TEST(StylePanel, AsksUntilItIsInForce) {
  House house;
  house.tell(at_ms(1000));
  FlowSetting wanted = house.panel.setting();
  wanted.lead = 0.5f;
  house.panel.change(wanted, at_ms(1010));
  house.tell(at_ms(1016));
  const auto asked = house.board.take_asked_flow();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->guest, guest_called("bob"));
  EXPECT_EQ(asked->what.lead, 0.5f);
  EXPECT_EQ(house.panel.setting().lead, 0.5f) << "the slider stays where it was put";
  house.tell(at_ms(1032));
  EXPECT_FALSE(house.board.take_asked_flow()) << "not with every picture";
  house.tell(at_ms(1300));
  EXPECT_TRUE(house.board.take_asked_flow()) << "the first one may be lost";
  house.in_force.lead = 0.5f;
  house.tell(at_ms(1316));
  house.tell(at_ms(1800));
  EXPECT_FALSE(house.board.take_asked_flow());
  EXPECT_TRUE(house.panel.note().empty());
}

TEST(StylePanel, GoesBackAndSaysSoWhereNobodyTakesIt) {
  House house;
  house.tell(at_ms(1000));
  FlowSetting wanted = house.panel.setting();
  wanted.lead = 0.5f;
  house.panel.change(wanted, at_ms(1010));
  for (double ms = 1016.0; ms < 3100.0; ms += 16.0) house.tell(at_ms(ms));
  EXPECT_EQ(house.panel.setting().lead, 1.0f);
  EXPECT_NE(house.panel.note().find("nobody takes it"), std::string::npos);
}

TEST(StylePanel, AsksForAnOwnStyleOnItsOwnChannel) {
  House house;
  house.in_force.own = true;
  house.tell(at_ms(1000));
  Style style;
  style.gain[0] = 1.5f;
  house.panel.change(style, at_ms(1010));
  house.tell(at_ms(1016));
  const auto asked = house.board.take_asked_style();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->what.gain[0], 1.5f);
  EXPECT_FALSE(house.board.take_asked_flow());
}

TEST(StylePanel, ChangesNothingOfARecording) {
  House house(false);
  house.tell(at_ms(1000));
  FlowSetting wanted = house.panel.setting();
  wanted.lead = 0.5f;
  house.panel.change(wanted, at_ms(1010));
  house.tell(at_ms(1016));
  EXPECT_FALSE(house.board.take_asked_flow());
}

TEST(StylePanel, SavesWhatIsInForceAndKeepsComments) {
  const TestFolder folder("style-panel");
  const std::string path = folder.path("session.toml");
  std::ofstream(path) << "# mine\n[[route]]\nthrough = [\"predict\", \"bridge\", \"rhythm\", "
                         "\"stylize\"] # all\n";
  House house(true, std::make_unique<SessionFile>(*SessionFile::open(path)));
  house.in_force.lead = 0.8f;
  house.in_force.on[index_of(FlowWord::kBridge)] = false;
  house.in_force.gain[0] = 1.5f;
  house.tell(at_ms(1000));
  house.panel.save();
  EXPECT_EQ(text_of(path),
            "# mine\n[[route]]\nthrough = [\"predict lead=0.8\", \"bridge on=0\", \"rhythm\", "
            "\"stylize hips=1.5\"] # all\n");
  EXPECT_NE(house.panel.note().find("saved in"), std::string::npos) << house.panel.note();
}

// A session file of this test's own.
struct OwnSession {
  explicit OwnSession(const std::string& text) { std::ofstream(path()) << text; }
  std::string path() const { return folder.path("session.toml"); }
  std::unique_ptr<SessionFile> open() const {
    return std::make_unique<SessionFile>(*SessionFile::open(path()));
  }

  TestFolder folder{"style-panel-own"};
};

// A house with two dancers of its own, and what stands in its session file.
struct OwnHouse : OwnSession, House {
  explicit OwnHouse(const std::string& text = "# mine\n[[route]]\nthrough = []\n")
      : OwnSession(text), House(true, open()) {
    in_force.own = true;
    in_force.has = {};
  }
  void tell_of(const char* name, const Style& style) {
    FlowSetting setting = in_force;
    setting.guest_gain = style.gain;
    setting.guest_periodic = style.periodic;
    setting.guest_dynamic = style.dynamic;
    board.on_flow(guest_called(name), setting);
    records.take(board);
  }
  std::string saved() {
    panel.save();
    return text_of(path());
  }
};

TEST(StylePanel, SavesAnOwnStyleAfterOtherGuestsWereLookedAt) {
  OwnHouse house;
  Style hips;
  hips.gain[0] = 1.5f;
  house.tell_of("alice", Style());
  house.tell_of("bob", Style());
  house.panel.open(true);
  house.panel.choose(guest_called("alice"));
  house.panel.follow(at_ms(1000));
  house.panel.change(hips, at_ms(1010));
  house.tell_of("alice", hips);
  house.panel.follow(at_ms(1100));
  for (const double ms : {1200.0, 1300.0}) {  // to bob and back
    house.panel.on_key({.key = 258});
    house.panel.follow(at_ms(ms));
  }
  EXPECT_NE(house.saved().find("[[style]]\nguest = \"alice\"\nwords = \"hips=1.5\""),
            std::string::npos)
      << house.saved();
}

TEST(StylePanel, SavesAnOwnStyleThatWasNotSetInThePanelAndThatItIsGone) {
  OwnHouse house;
  Style arms;
  arms.gain[static_cast<std::size_t>(BodyZone::kArms)] = 0.5f;
  house.panel.choose(guest_called("alice"));
  house.tell_of("alice", arms);  // dance style
  house.panel.follow(at_ms(1000));
  EXPECT_NE(house.saved().find("words = \"arms=0.5\""), std::string::npos);
  house.tell_of("alice", Style());
  house.panel.follow(at_ms(2000));
  EXPECT_NE(house.saved().find("words = \"preset=as-danced\""), std::string::npos);
}

TEST(StylePanel, LeavesTheFileAsItIsWhereItSaysWhatIsInForce) {
  const std::string text = "[[style]]\nguest = \"alice\"\nwords = \"hips=1.50  mix=1\" # so\n";
  OwnHouse house(text);
  house.in_force.guest_gain[0] = 1.5f;
  for (const char* name : {"alice", "bob"}) {
    FlowSetting setting = house.in_force;
    if (*name == 'b') setting.guest_gain[0] = 1.0f;
    house.board.on_flow(guest_called(name), setting);
    house.records.take(house.board);
    house.panel.choose(guest_called(name));
    house.panel.follow(at_ms(1000));
    EXPECT_EQ(house.saved(), text);
    EXPECT_NE(house.panel.note().find("saved in"), std::string::npos) << house.panel.note();
  }
}

}  // namespace
}  // namespace dance
