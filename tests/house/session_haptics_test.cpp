// [[haptics]] of a session file.
#include "house/session_haptics.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr const char* kDancersHouse = "[house]\nguest = \"alice\"\nserver = \"example.org:7400\"\n";

std::string haptics_error_of(const std::string& text) {
  const auto session = parse_session(text, "s.toml");
  return session ? "no error" : session.error().what;
}

TEST(SessionHaptics, SaysWhatGuestsFeelAndByWhat) {
  const std::string haptics = std::string(kDancersHouse) + "[[haptics]]\nguest = \"alice\"\n";
  const auto session = parse_session(
      haptics +
          "to = \"evdev\"\ndevice = \"Joy-Con\"\nlimit = 0.5\nlatency_ms = 15\non = false\n"
          "feel = [\"lead\", \"beats\"]\n"
          "[[haptics]]\nguest = \"alice\"\nto = \"osc\"\naddress = \"127.0.0.1:9001\"\n",
      "/home/alice/s.toml");
  ASSERT_TRUE(session) << session.error().what;
  ASSERT_EQ(session->haptics.size(), 2u);
  const HapticOptions& pad = session->haptics[0].options;
  EXPECT_EQ(pad.device, "Joy-Con");
  EXPECT_EQ(pad.player.limit, 0.5f);
  EXPECT_EQ(pad.player.latency, Duration::ms(15));
  EXPECT_FALSE(pad.player.is_on);
  EXPECT_FALSE(pad.maker.touch);
  EXPECT_EQ(pad.maker.beats, FeltBeats::kAll);
  EXPECT_EQ(session->haptics[1].to, "osc");
  EXPECT_TRUE(session->haptics[1].options.maker.touch);
  EXPECT_NE(haptics_error_of(haptics + "to = \"glove\"\n").find("bhaptics"), std::string::npos);
  EXPECT_NE(haptics_error_of(haptics + "to = \"osc\"\ndevice = \"x\"\n").find("address"),
            std::string::npos);
  EXPECT_NE(haptics_error_of(haptics + "to = \"osc\"\nfeel = [\"smell\"]\n").find("smell"),
            std::string::npos);
  EXPECT_NE(haptics_error_of(haptics + "to = \"osc\"\nlimit = 2\n").find("limit"),
            std::string::npos);
}

TEST(SessionHaptics, HapticsAreOfSomeBonesAndOfThoseWhoAreNamed) {
  const std::string haptics =
      std::string(kDancersHouse) + "[[haptics]]\nguest = \"alice\"\nto = \"evdev\"\n";
  const auto session =
      parse_session(haptics + "from = [\"bob\", \"eve\"]\nbones = [\"leftHand\"]\n", "s.toml");
  ASSERT_TRUE(session) << session.error().what;
  const HapticOptions& options = session->haptics[0].options;
  EXPECT_EQ(options.maker.from,
            (std::vector<GuestId>{*GuestId::parse("bob"), *GuestId::parse("eve")}));
  EXPECT_TRUE(options.maker.touch);
  EXPECT_EQ(options.player.bones, 1u << index_of(Bone::kLeftHand));
  EXPECT_NE(haptics_error_of(haptics + "bones = [\"left-hand\"]\n").find("leftHand"),
            std::string::npos);
  EXPECT_EQ(haptics_error_of(haptics + "from = [\"Not A Guest\"]\n").rfind("s.toml:", 0), 0u);
}

TEST(SessionHaptics, ExactHapticsAreAProgramThatIsToldAllThatTheSessionSays) {
  const auto session = parse_session(
      std::string(kDancersHouse) +
          "[[haptics]]\nguest = \"alice\"\nto = \"evdev\"\ndevice = \"-Joy-Con\"\nlimit = 0.5\n"
          "latency_ms = 15\non = false\nfeel = [\"lead\", \"beats\"]\nfrom = [\"bob\", \"eve\"]\n"
          "bones = [\"leftHand\"]\nrealtime = true\n",
      "s.toml");
  ASSERT_TRUE(session) << session.error().what;
  ASSERT_TRUE(session->haptics[0].realtime);
  const std::vector<std::string> expected{
      "--bus",          "memq://",           "--guest",
      "alice",          "--realtime",        "--quiet",
      "--to=evdev",     "--device=-Joy-Con", "--strength=1.0000",
      "--limit=0.5000", "--latency=15.000",  "--off",
      "--feel=lead",    "--feel=beats",      "--from=bob",
      "--from=eve",     "--bones=leftHand"};
  EXPECT_EQ(haptics_arguments(session->haptics[0], "memq://"), expected);
}

TEST(SessionHaptics, HapticsOfAGuestWhoDoesNotDanceHereAreAnErrorThatNamesThoseWhoDo) {
  const std::string zoe = "[[haptics]]\nguest = \"zoe\"\nto = \"evdev\"\n";
  const std::string error = haptics_error_of(kDancersHouse + zoe);
  EXPECT_EQ(error.rfind("s.toml:", 0), 0u) << error;
  EXPECT_NE(error.find("'zoe' does not dance in this house"), std::string::npos) << error;
  EXPECT_NE(error.find("alice"), std::string::npos) << error;
  // Who is produced here, or staged under another name, dances here.
  EXPECT_TRUE(parse_session(
      kDancersHouse + std::string("[[produce]]\nkind = \"salsa\"\nguest = \"zoe\"\n") + zoe,
      "s.toml"));
  EXPECT_TRUE(parse_session(kDancersHouse +
                                std::string("[[route]]\nfrom = \"POSE/capture/alice\"\n"
                                            "to = \"POSE/stage/zoe\"\n") +
                                zoe,
                            "s.toml"));
  // A house that names nobody may have a dancer from a program beside it.
  EXPECT_TRUE(parse_session("[house]\n" + zoe, "s.toml"));
}

}  // namespace
}  // namespace dance
