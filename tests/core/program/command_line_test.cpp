// Errors of options that a program cannot use.
#include "core/program/command_line.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

std::string error_of(std::vector<std::string> words) {
  CommandLine line("Dances.", "dance test");
  double hz = 0.0;
  std::string where;
  line.add("--hz", hz, "rate").range(1.0, 60.0);
  line.add("--where", where, "which").one_of({"stage", "capture"});
  words.insert(words.begin(), "test");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  return line.parse(static_cast<int>(arguments.size()), arguments.data()) ==
                 CommandLine::Parsed::kWrong
             ? line.text()
             : "no error";
}

TEST(CommandLine, NamesTheOptionAndTheCure) {
  EXPECT_EQ(error_of({"--hz", "30"}), "no error");
  EXPECT_EQ(error_of({"--speed"}), "it takes no '--speed'");
  EXPECT_EQ(error_of({"a.bvh"}), "it takes no 'a.bvh'");
  EXPECT_EQ(error_of({"--hz"}), "--hz needs a value behind it");
  EXPECT_EQ(error_of({"--hz", "fast"}), "--hz: 'fast' is not 1 to 60");
  EXPECT_EQ(error_of({"--where", "here"}), "--where: 'here' is not stage or capture");
}

}  // namespace
}  // namespace dance
