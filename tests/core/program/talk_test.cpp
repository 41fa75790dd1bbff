// Tests how messages and errors on standard error show texts from outside.
#include "core/program/talk.h"

#include <gtest/gtest.h>

#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kHostile = "x\x1b[2J\nforged line\u202etxt\x9b";

void expect_one_plain_line(const std::string& printed) {
  EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << printed;
  EXPECT_EQ(printed.find('\x1b'), std::string::npos);
  EXPECT_EQ(printed.find("\u202e"), std::string::npos);
  EXPECT_NE(printed.find("x?[2J?forged line?txt?"), std::string::npos) << printed;
}

TEST(TalkText, HoldsNoControlCharactersOfItsParts) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  talk::warn("the file {} is damaged", kHostile);
  const std::string printed =
      ::testing::internal::GetCapturedStderr() + ::testing::internal::GetCapturedStdout();
  expect_one_plain_line(printed);
}

TEST(ProgramError, HoldsNoControlCharactersOfItsParts) {
  CommandLine line("", "dance error");
  std::string name = "test";
  char* words = name.data();
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run_program(line, 1, &words,
                        []() -> Result<void> { return fail(std::string(kHostile) + ": bad"); }),
            1);
  expect_one_plain_line(::testing::internal::GetCapturedStderr());
}

TEST(ProgramError, OfWrongUseHoldsNoControlCharactersOfTheArgument) {
  CommandLine line("", "dance argument");
  std::string name = "test", wrong = std::string("--") + kHostile;
  std::array<char*, 2> words{name.data(), wrong.data()};
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run_program(line, 2, words.data(), []() -> Result<void> { return {}; }), 2);
  expect_one_plain_line(::testing::internal::GetCapturedStderr());
}

}  // namespace
}  // namespace dance
