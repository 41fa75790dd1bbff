// [[produce]] of kind headset of a session file.
#include <gtest/gtest.h>

#include "house/headset/hosted_headset.h"
#include "house/session.h"

namespace dance {
namespace {

const std::string kHeadsetHouse =
    "[house]\nguest = \"alice\"\n[[produce]]\nkind = \"headset\"\nguest = \"alice\"\n";

std::string headset_error_of(const std::string& lines) {
  const auto session = parse_session(kHeadsetHouse + lines, "s.toml");
  return session ? "no error" : session.error().what;
}

TEST(SessionHeadset, SaysWhoDancesWithItAndIsAllElseAsTheProgramHasIt) {
  const auto session = parse_session(kHeadsetHouse, "s.toml");
  ASSERT_TRUE(session) << session.error().what;
  ASSERT_EQ(session->headsets.size(), 1u);
  EXPECT_EQ(session->headsets[0].guest.view(), "alice");
  EXPECT_TRUE(session->producers.empty());
  const std::vector<std::string> expected{"--bus", "memq://", "--guest", "alice"};
  EXPECT_EQ(headset_arguments(session->headsets[0], "memq://"), expected);
}

TEST(SessionHeadset, ItsWordsAreThoseOfTheProgram) {
  const auto session =
      parse_session(kHeadsetHouse +
                        "at = \"-1,1.2,180\"\nbody = \"rules\"\ntracking_only = true\n"
                        "window = false\nhaptics = false\ntags = false\npersonal_space = 0\n"
                        "floor = 5\nscale = 0.75\n",
                    "s.toml");
  ASSERT_TRUE(session) << session.error().what;
  ASSERT_EQ(session->headsets.size(), 1u);
  const auto words = headset_arguments(session->headsets[0], "memq://");
  const auto has = [&](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  for (const char* word : {"--at=-1,1.2,180", "--body=rules", "--tracking-only", "--no-mirror",
                           "--no-haptics", "--no-tags"})
    EXPECT_TRUE(has(word)) << word;
  const auto value_of = [&](const std::string& option) {
    for (const std::string& word : words)
      if (word.starts_with(option + "=")) return std::stod(word.substr(option.size() + 1));
    return -1.0;
  };
  EXPECT_EQ(value_of("--personal-space"), 0.0);
  EXPECT_EQ(value_of("--floor"), 5.0);
  EXPECT_EQ(value_of("--scale"), 0.75);
}

TEST(SessionHeadset, WhatIsWrongNamesThePlaceTheKeyAndWhatItMayBe) {
  struct Wrong {
    const char* line;
    const char* key;
    const char* cure;
  };
  for (const Wrong& it :
       {Wrong{"body = \"magic\"\n", "body", "auto, rules or learned"},
        Wrong{"scale = 3\n", "scale", "2"}, Wrong{"scale = 0.1\n", "scale", "0.25"},
        Wrong{"personal_space = 4\n", "personal_space", "3"},
        Wrong{"personal_space = -1\n", "personal_space", "0"}, Wrong{"floor = 1\n", "floor", "1.5"},
        Wrong{"window = 1\n", "window", "true"}, Wrong{"hapitcs = true\n", "hapitcs", ""},
        Wrong{"at = \"here\"\n", "at", "X,Z"}}) {
    const std::string error = headset_error_of(it.line);
    EXPECT_EQ(error.rfind("s.toml:", 0), 0u) << it.line << error;
    EXPECT_NE(error.find(it.key), std::string::npos) << it.line << error;
    EXPECT_NE(error.find(it.cure), std::string::npos) << it.line << error;
  }
  const std::string nobody = [] {
    const auto session =
        parse_session("[house]\nguest = \"alice\"\n[[produce]]\nkind = \"headset\"\n", "s.toml");
    return session ? "no error" : session.error().what;
  }();
  EXPECT_NE(nobody.find("guest"), std::string::npos) << nobody;
}

}  // namespace
}  // namespace dance
