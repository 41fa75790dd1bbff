// dance avatar: makes a file, says what is in it, and refuses what is none with cause and cure.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

using nlohmann::json;

std::string avatar(const std::string& arguments) { return bin("dance-avatar") + " " + arguments; }

TEST(AvatarProgram, MakesAFileAndSaysWhatIsInIt) {
  const TestFolder folder("avatar");
  const std::string file = folder.path("me.vrm");
  const Finished make =
      run(avatar("make --look teo --name me --height 1.92 --hair bun --out " + file));
  ASSERT_EQ(make.exit_code, 0) << make.talk;
  EXPECT_TRUE(is_private(file));
  EXPECT_NE(make.output.find("triangles"), std::string::npos) << make.output;
  const Finished info = run(avatar("info --json " + file));
  ASSERT_EQ(info.exit_code, 0) << info.talk;
  const json facts = json::parse(info.output, nullptr, false);
  ASSERT_TRUE(facts.is_object()) << info.output;
  EXPECT_EQ(facts["kind"], "VRM 1.0");
  EXPECT_EQ(facts["bones"], 22);
  EXPECT_EQ(facts["finger_bones"], 30);
  EXPECT_EQ(facts["has_eyes"], true);
  EXPECT_EQ(facts["pictures"].size(), 2u);
  const auto expressions = facts["expressions"].get<std::set<std::string>>();
  for (const char* name : {"blink", "aa", "happy"}) EXPECT_TRUE(expressions.contains(name)) << name;
  // The two ends of the sash, and the two locks beside the face that come with a bun.
  EXPECT_EQ(facts["springs"], 4);
  EXPECT_EQ(facts["colliders"], 7);
  EXPECT_NE(facts["licence"].get<std::string>().find("publicdomain/zero"), std::string::npos);
  EXPECT_NEAR(facts["height_m"].get<double>(), 1.92, 0.06);
  EXPECT_EQ(facts["bytes"].get<std::size_t>(), std::filesystem::file_size(file));
  const Finished text = run(avatar("info " + file));
  EXPECT_NE(text.output.find("It can dance here."), std::string::npos) << text.output;
}

TEST(AvatarProgram, TheSameOptionsMakeTheSameFile) {
  const TestFolder folder("avatar-same");
  for (const char* name : {"a.vrm", "b.vrm"})
    ASSERT_EQ(run(avatar("make --guest alice --out " + folder.path(name))).exit_code, 0);
  EXPECT_EQ(bytes_in(folder.path("a.vrm")), bytes_in(folder.path("b.vrm")));
  ASSERT_EQ(run(avatar("make --guest bob --out " + folder.path("c.vrm"))).exit_code, 0);
  EXPECT_NE(bytes_in(folder.path("a.vrm")), bytes_in(folder.path("c.vrm")));
}

TEST(AvatarProgram, WrongUseIsTwo) {
  for (const char* wrong :
       {"", "dance", "make", "make --out x.vrm --look nobody", "make --out x.vrm --skin red",
        "make --out x.vrm --look teo --guest alice", "make --out x.vrm --height 9", "info"}) {
    const Finished finished = run(avatar(wrong));
    EXPECT_EQ(finished.exit_code, 2) << wrong;
    EXPECT_FALSE(finished.talk.empty()) << wrong;
  }
}

TEST(AvatarProgram, WhatCannotDanceIsOneAndNamesTheFile) {
  const TestFolder folder("avatar-wrong");
  std::ofstream(folder.path("text.vrm")) << "no avatar";
  std::ofstream(folder.path("empty.glb"));
  // A figure without a body: valid glTF, no bones.
  std::ofstream(folder.path("bare.gltf")) << R"({"asset":{"version":"2.0"},"nodes":[{}],)"
                                          << R"("scenes":[{"nodes":[0]}],"scene":0})";
  for (const char* name : {"text.vrm", "empty.glb", "bare.gltf", "absent.vrm"}) {
    const Finished finished = run(avatar("info " + folder.path(name)));
    EXPECT_EQ(finished.exit_code, 1) << name;
    EXPECT_NE(finished.talk.find(name), std::string::npos) << finished.talk;
  }
  // A shipped one, cut off.
  const auto whole = bytes_in(DANCE_SOURCE_DIR "/data/avatars/teo.vrm");
  ASSERT_GT(whole.size(), 1000u);
  std::ofstream cut(folder.path("cut.vrm"), std::ios::binary);
  cut.write(reinterpret_cast<const char*>(whole.data()),
            static_cast<std::streamsize>(whole.size() / 2));
  cut.close();
  EXPECT_EQ(run(avatar("info " + folder.path("cut.vrm"))).exit_code, 1);
  EXPECT_EQ(run(avatar("make --out " + folder.path("no/such/folder/x.vrm"))).exit_code, 1);
}

TEST(AvatarProgram, HelpNamesEveryAction) {
  const Finished help = run(avatar("--help"));
  EXPECT_EQ(help.exit_code, 0);
  for (const char* word : {"dance avatar make", "dance avatar info"})
    EXPECT_NE(help.output.find(word), std::string::npos) << word;
  for (const char* action : {"make", "info"})
    EXPECT_EQ(run(avatar(std::string(action) + " --help")).exit_code, 0) << action;
}

}  // namespace
}  // namespace dance
