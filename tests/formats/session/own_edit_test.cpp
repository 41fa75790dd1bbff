// Edits of a house file by the dance panel: the house reads the new values, and the rest of the
// file stays as it was.
#include "formats/session/own_edit.h"

#include <gtest/gtest.h>

#include "house/session.h"

namespace dance {
namespace {

constexpr const char* kOwnFile = R"(# Alice's house
[house]
guests = ["alice", "ann"]   # both of us
shown_names = ["ann=Ann"]
server = "example.org"

[[avatar]]
guest  = "ann"     # hers
name   = "teo"
height = 1.10      # tall
)";

HouseConfig read(const Result<std::string>& text) {
  if (!text) {
    ADD_FAILURE() << text.error().what;
    return {};
  }
  const auto house = parse_session(*text, "/h/s.toml");
  EXPECT_TRUE(house) << house.error().what << *text;
  return house ? *house : HouseConfig();
}

GuestId own(const char* name) { return *GuestId::parse(name); }

TEST(OwnEdit, KeepsTheNameOfTheFirstGuestAndThoseOfOthersInTheList) {
  const std::string text = kOwnFile;
  const auto first = set_own_name(text, "alice", "Alicia \"L\u00f3pez\"", "/h/s.toml");
  EXPECT_EQ(read(first).shown_names[own("alice")].view(), "Alicia \"L\u00f3pez\"");
  EXPECT_NE(first->find("shown_names = [\"ann=Ann\"]\n"), std::string::npos) << *first;
  EXPECT_NE(first->find("# both of us"), std::string::npos);
  const auto second = set_own_name(*first, "ann", "Annie", "/h/s.toml");
  EXPECT_EQ(read(second).shown_names[own("ann")].view(), "Annie");
  EXPECT_EQ(read(second).shown_names[own("alice")].view(), "Alicia \"L\u00f3pez\"");
  const auto none = set_own_name(*second, "alice", "", "/h/s.toml");
  EXPECT_FALSE(read(none).shown_names.contains(own("alice")));
  EXPECT_EQ(*set_own_name(*none, "ann", "Ann", "/h/s.toml"), text);
}

TEST(OwnEdit, KeepsAFigureAndLeavesItsNumbersAsTheyAreWritten) {
  const std::string text = kOwnFile;
  OwnFigure figure = *own_figure(text, "ann", "/h/s.toml");
  EXPECT_EQ(figure.what, "teo");
  EXPECT_EQ(figure.height, 1.1);
  figure.what = "/home/ann/my \"own\".vrm";
  const auto file = set_own_figure(text, "ann", figure, "/h/s.toml");
  ASSERT_EQ(read(file).avatars.size(), 1u);
  EXPECT_EQ(read(file).avatars[0].choice.what, figure.what);
  EXPECT_NE(file->find("height = 1.10      # tall"), std::string::npos) << *file;
  EXPECT_EQ(*own_figure(*file, "ann", "/h/s.toml"), figure);
  OwnFigure look;
  look.look = "dress-bun";
  look.colour = "#e04080";
  look.height = figure.height;
  const auto dressed = set_own_figure(*file, "ann", look, "/h/s.toml");
  EXPECT_EQ(read(dressed).avatars[0].choice.look, "dress-bun");
  EXPECT_EQ(read(dressed).avatars[0].choice.what, "");
  EXPECT_EQ(*own_figure(*dressed, "ann", "/h/s.toml"), look);
}

TEST(OwnEdit, AddsAFigureForAGuestWithoutOne) {
  const std::string text = kOwnFile;
  EXPECT_EQ(*set_own_figure(text, "alice", OwnFigure(), "/h/s.toml"), text);
  OwnFigure figure;
  figure.what = "me.vrm";
  EXPECT_FALSE(figure.is_file());
  figure.what = "./me.vrm";
  const auto added = set_own_figure(text, "alice", figure, "/h/s.toml");
  ASSERT_EQ(read(added).avatars.size(), 2u);
  EXPECT_EQ(own_figure(*added, "alice", "/h/s.toml")->what, "/h/./me.vrm");
  EXPECT_TRUE(added->starts_with(text));
}

TEST(OwnEdit, TurnsTheVoiceOffAndOnAndKeepsItsOtherKeys) {
  const std::string text = kOwnFile;
  const auto on = set_own_voice(text, true, "/h/s.toml");
  EXPECT_TRUE(read(on).voice && read(on).voice->enabled);
  const std::string with = text + "\n[voice]\nheadphones = true\n";
  const auto off = set_own_voice(with, false, "/h/s.toml");
  ASSERT_TRUE(read(off).voice);
  EXPECT_FALSE(read(off).voice->enabled);
  EXPECT_EQ(*set_own_voice(*off, true, "/h/s.toml"), with);
  EXPECT_FALSE(set_own_voice("[house]\nroom = \"salsa\"\n", true, "/h/s.toml"));
}

TEST(OwnEdit, RefusesAGuestOfAnotherHouse) {
  const std::string text = kOwnFile;
  const auto refused = set_own_name(text, "bob", "Bob", "/h/s.toml");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("'bob'"), std::string::npos);
  OwnFigure figure;
  figure.what = "teo";
  EXPECT_FALSE(set_own_figure(text, "bob", figure, "/h/s.toml"));
}

}  // namespace
}  // namespace dance
