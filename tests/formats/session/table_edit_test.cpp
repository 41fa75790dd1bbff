// Single values of a session's text: what is edited has the value, and all else stays as written.
#include "formats/session/table_edit.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr const char* kText = R"(# Frühling: "quotes" [[brackets]]
[house]
guest  = "alice"   # me
want   = [
  "bob=1",  # all of him ]
  'default=4',
]
server = "example.org"

# the dancer
[[produce]]
kind = "salsa"  # no camera here
guest = "alice"

# another
[[produce]]
kind = "replay"
guest = "ann"
file = "größer # ann.bvh"
)";

const TablePlace kHouse{"house", std::nullopt};

std::string set(const TablePlace& place, const char* key, const std::string& value) {
  const auto edited = set_value(kText, place, key, value, "s.toml");
  EXPECT_TRUE(edited) << edited.error().what;
  return edited.value_or("");
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kText;
  return text.replace(text.find(from), from.size(), to);
}

TEST(TableEdit, ReplacesAValueAndKeepsTheCommentBehindIt) {
  EXPECT_EQ(set(kHouse, "guest", "\"bob\""), replaced("\"alice\"   #", "\"bob\"   #"));
  EXPECT_EQ(set({"produce", 1}, "file", "\"x\""), replaced("\"größer # ann.bvh\"", "\"x\""));
}

TEST(TableEdit, ReplacesAListOverSeveralLines) {
  const std::string list = "[\n  \"bob=1\",  # all of him ]\n  'default=4',\n]";
  EXPECT_EQ(set(kHouse, "want", "[]"), replaced(list, "[]"));
}

TEST(TableEdit, AddsAKeyAtTheEndOfItsTable) {
  EXPECT_EQ(set(kHouse, "room", "\"salsa\""),
            replaced("server = \"example.org\"\n", "server = \"example.org\"\nroom = \"salsa\"\n"));
  EXPECT_EQ(set({"produce", 0}, "role", "\"lead\""),
            replaced("guest = \"alice\"\n", "guest = \"alice\"\nrole = \"lead\"\n"));
}

TEST(TableEdit, AddsATableWhereThereIsNone) {
  const auto edited = set_value("[house]\nguest = \"alice\"", {"window", std::nullopt}, "mirror",
                                "false", "s.toml");
  ASSERT_TRUE(edited);
  EXPECT_EQ(*edited, "[house]\nguest = \"alice\"\n\n[window]\nmirror = false\n");
}

TEST(TableEdit, TakesALineAway) {
  const auto edited = remove_value(kText, kHouse, "server", "s.toml");
  ASSERT_TRUE(edited);
  EXPECT_EQ(*edited, replaced("server = \"example.org\"\n", ""));
  EXPECT_EQ(*remove_value(kText, kHouse, "room", "s.toml"), kText) << "there is none";
}

TEST(TableEdit, TakesATableAwayAndLeavesTheCommentOfTheNextOne) {
  const auto edited = remove_table(kText, {"produce", 0}, "s.toml");
  ASSERT_TRUE(edited);
  EXPECT_EQ(*edited, replaced("[[produce]]\nkind = \"salsa\"  # no camera here\nguest = "
                              "\"alice\"\n\n",
                              ""));
  const auto last = remove_table(kText, {"produce", 1}, "s.toml");
  ASSERT_TRUE(last);
  EXPECT_TRUE(last->ends_with("# another\n")) << *last;
}

TEST(TableEdit, TellsTheTextsOfEachTable) {
  const auto tables = texts_of_tables(kText, "produce", "s.toml");
  ASSERT_TRUE(tables);
  ASSERT_EQ(tables->size(), 2u);
  EXPECT_EQ((*tables)[1].at("file"), "größer # ann.bvh");
  EXPECT_TRUE(texts_of_tables(kText, "avatar", "s.toml")->empty());
}

TEST(TableEdit, RefusesATableWithinALineAndWhatIsNoToml) {
  const auto edited = set_value("house = { guest = \"a\" }\n", kHouse, "room", "\"b\"", "s.toml");
  ASSERT_FALSE(edited);
  EXPECT_NE(edited.error().what.find("s.toml:1:"), std::string::npos);
  EXPECT_NE(edited.error().what.find("on a line of its own"), std::string::npos);
  EXPECT_FALSE(set_value("[house\n", kHouse, "room", "\"b\"", "s.toml"));
}

TEST(TableEdit, WritesTextsThatReadBack) {
  for (const std::string& text : {std::string("a\"b\\c"), std::string("tab\there"),
                                  std::string("line\nend\x7f"), std::string("größer")}) {
    const auto edited = set_value(kText, {"produce", 1}, "file", toml_text(text), "s.toml");
    ASSERT_TRUE(edited) << text;
    EXPECT_EQ((*texts_of_tables(*edited, "produce", "s.toml"))[1].at("file"), text);
  }
}

}  // namespace
}  // namespace dance
