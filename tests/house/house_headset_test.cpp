// A house whose dancer wears a headset: lines of its session file, and dance join --headset.
#include <gtest/gtest.h>

#include "tests/headset/headset_programs.h"
#include "tests/virtual_display.h"

namespace dance {
namespace {

class HouseHeadsetTest : public HeadsetPrograms {
 protected:
  std::string house() const {
    return "[house]\nbus = \"" + std::string(kBus) + "\"\nguests = [\"alice\", \"bob\"]\n" +
           "[[produce]]\nkind = \"salsa\"\nguest = \"bob\"\nrole = \"lead\"\n" +
           "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
  }
  ChildProcess& open(const std::string& session, std::vector<std::string> more) {
    const std::string file = folder_.path("house.toml");
    std::ofstream(file) << session;
    more.insert(more.begin(), file);
    return start("dance-join", std::move(more));
  }
};

constexpr const char* kTracking =
    "[[produce]]\nkind = \"headset\"\nguest = \"alice\"\ntracking_only = true\n";

TEST_F(HouseHeadsetTest, HasItsDancerOnTheStageAndGoesOnWhenTheRuntimeEnds) {
  write_script("at 5 exit\n");
  ChildProcess& join = open(house() + kTracking, {"--no-view"});
  ASSERT_TRUE(until([&] { return staged_["alice"].poses > 50; })) << talk();
  EXPECT_GT(staged_["bob"].poses, 0);
  ASSERT_TRUE(until([&] { return said("the headset's runtime has ended the session") == 1; }))
      << talk();
  const int before = staged_["alice"].poses, bob = staged_["bob"].poses;
  ASSERT_TRUE(until([&] { return staged_["alice"].poses > before + 50; })) << talk();
  EXPECT_GT(staged_["bob"].poses, bob);
  EXPECT_FALSE(join.has_ended());
}

TEST_F(HouseHeadsetTest, GoesOnWithoutTheHeadsetAndHasItOnceItIsThere) {
  write_script("no system until 4\n");
  ChildProcess& join = open(house() + kTracking, {"--no-view"});
  ASSERT_TRUE(until([&] { return said("asleep or not connected") == 1; })) << talk();
  const int before = staged_["bob"].poses;
  ASSERT_TRUE(until([&] { return staged_["bob"].poses > before + 30; })) << talk();
  ASSERT_TRUE(until([&] { return staged_["alice"].poses > 30; })) << talk();
  EXPECT_EQ(said("asleep or not connected"), 1) << talk();
  join.stop(Duration::s(60));
  EXPECT_TRUE(join.ended_well()) << join.exit_text() << talk();
  EXPECT_TRUE(until([&] { return has_recorded("session EXITING"); })) << "it ends with the house";
}

TEST_F(HouseHeadsetTest, JoiningWithOneTakesThePlaceOfWhatProducedTheDancer) {
  const VirtualDisplay display;
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  set("DISPLAY", display.display());
  ::unsetenv("WAYLAND_DISPLAY");  // NOLINT(concurrency-mt-unsafe)
  // A tall dancer: nobody else's head is so high.
  write_script("refresh 30\nsize 160 176\nat 0 pose head 0 1.85 0 0 0 0 1\n");
  ChildProcess& join =
      open(house() + "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\nrole = \"follow\"\n",
           {"--alone", "--headset"});
  static_cast<void>(join);
  ASSERT_TRUE(until([&] { return count_of(record(), "layers 1") > 10; })) << talk() << record();
  ASSERT_TRUE(until([&] { return staged_["alice"].poses > 50; })) << talk();
  EXPECT_GT(staged_["bob"].poses, 0) << talk();
  // A synthetic dancer would dance.
  float least = 1e9f, most = -1e9f;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(hears_more(1));
    least = std::min(least, newest("alice").p_WH_m.x());
    most = std::max(most, newest("alice").p_WH_m.x());
  }
  EXPECT_LT(most - least, 0.02f);
}

TEST_F(HouseHeadsetTest, JoiningWithOneAndWithoutADancerAsksWho) {
  const Finished refused = run(bin("dance-join") + " example.org --headset");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.talk.find("--headset: who dances? name the guest with --guest"),
            std::string::npos)
      << refused.talk;
  EXPECT_EQ(count_of(refused.talk, "\n"), 1) << refused.talk;
}

}  // namespace
}  // namespace dance
