#include "research/outside_program.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

class OutsidePrograms : public testing::Test {
 protected:
  OutsideProgram shell(const std::string& script) const {
    return {.name = "sh",
            .package = "dash",
            .arguments = {"-c", script},
            .output_file = folder_.path("output"),
            .talk_file = folder_.path("talk")};
  }

  TestFolder folder_{"outside-program"};
};

TEST_F(OutsidePrograms, RunToTheirEndIntoTheirFile) {
  const auto ran = run_outside_program(shell("echo salsa"));
  ASSERT_TRUE(ran) << ran.error().what;
  std::ifstream file(folder_.path("output"));
  std::string output;
  std::getline(file, output);
  EXPECT_EQ(output, "salsa");
}

TEST_F(OutsidePrograms, HaveTheLastWordInTheError) {
  const auto ran = run_outside_program(shell("echo begins >&2; echo no space left >&2; exit 3"));
  ASSERT_FALSE(ran);
  EXPECT_EQ(ran.error().what, "sh: ended with exit 3: no space left");
  EXPECT_EQ(run_outside_program(shell("exit 4")).error().what, "sh: ended with exit 4");
}

TEST_F(OutsidePrograms, ThatAreMissingAreNamedWithTheirPackage) {
  OutsideProgram missing = shell("");
  missing.name = "no-such-program";
  missing.package = "some-package";
  EXPECT_EQ(run_outside_program(missing).error().what,
            "no-such-program is not installed: apt-get install some-package");
}

}  // namespace
}  // namespace dance
