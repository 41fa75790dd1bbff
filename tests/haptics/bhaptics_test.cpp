// The WebSocket of bHaptics against a server of another library, which stands for the player.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "haptics/bhaptics/bhaptics_frame.h"
#include "haptics/bhaptics/bhaptics_output.h"
#include "tests/apps/run_program.h"
#include "tests/haptics/haptic_notes.h"

namespace dance {
namespace {

using Json = nlohmann::json;
constexpr const char* kPython = "/usr/bin/python3";

class BhapticsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run(std::string(kPython) + " -c 'import websockets'").exit_code != 0)
      GTEST_SKIP() << "python3-websockets is not installed";
  }
  void start_player() {
    auto child =
        ChildProcess::start({kPython,
                             {DANCE_SOURCE_DIR "/tests/haptics/websocket_player.py", "15999"},
                             folder_.path("heard"),
                             folder_.path("talk")});
    ASSERT_TRUE(child) << child.error().what;
    player_ = std::make_unique<ChildProcess>(std::move(*child));
    ASSERT_TRUE(wait_for([&] { return heard().find("ready") != std::string::npos; }))
        << text_of(folder_.path("talk"));
  }
  std::string heard() const { return text_of(folder_.path("heard")); }
  // So that an order is not late however slow this machine is.
  static MonoTime in_time() { return mono_now() + Duration::s(60); }
  // Plays until one is taken.
  bool play(HapticOutput& output, const Haptic& haptic) {
    return wait_for([&] { return output.play(haptic, in_time()); });
  }

  TestFolder folder_{"bhaptics"};
  std::unique_ptr<ChildProcess> player_;
};

TEST(BhapticsFrame, SaysWhichMotorHowStrongAndHowLong) {
  Haptic haptic = some_haptic(MonoTime());
  haptic.duration = Duration::ms(120);
  const Json frame = Json::parse(bhaptics_frame(haptic))["Submit"][0];
  EXPECT_EQ(frame["Type"], "frame");
  EXPECT_EQ(frame["Frame"]["Position"], "HandL");
  EXPECT_EQ(frame["Frame"]["DurationMillis"], 120);
  EXPECT_EQ(frame["Frame"]["DotPoints"][0]["Intensity"], 50);
  EXPECT_EQ(Json::parse(bhaptics_stop())["Submit"][0]["Type"], "turnOffAll");
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    EXPECT_GE(bhaptics_place(static_cast<Bone>(b)).motor, 0);
    EXPECT_LT(bhaptics_place(static_cast<Bone>(b)).motor, 20);
  }
}

TEST_F(BhapticsTest, ReachesThePlayerAndFindsItAgain) {
  auto output = BhapticsOutput::later("127.0.0.1:15999");
  ASSERT_TRUE(output);
  EXPECT_FALSE(output->play(some_haptic(mono_now()), mono_now()));  // nobody is there
  start_player();
  EXPECT_FALSE(output->is_there());
  ASSERT_TRUE(play(*output, some_haptic(mono_now())));
  EXPECT_TRUE(output->is_there());
  ASSERT_TRUE(wait_for([&] { return heard().find("HandL") != std::string::npos; })) << heard();
  for (int i = 0; i < 20; ++i) {
    Haptic haptic = some_haptic(mono_now());
    haptic.bone = Bone::kRightHand;
    haptic.duration = Duration::ms(100 + i);
    output->play(haptic, in_time());
    // As after a stall of the connection.
    haptic.bone = Bone::kHead;
    output->play(haptic, mono_now() - Duration::s(1));
  }
  ASSERT_TRUE(wait_for([&] { return heard().find("\"DurationMillis\":119") != std::string::npos; }))
      << heard();
  std::istringstream lines(heard());
  int frames = 0;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("{")) {
      EXPECT_TRUE(Json::parse(line).contains("Submit"));
      ++frames;
    }
  EXPECT_EQ(frames, 21);
  EXPECT_NE(output->summary().find("20 left out after a stall"), std::string::npos)
      << output->summary();
  player_->stop(Duration::s(5));
  EXPECT_TRUE(wait_for([&] { return !output->play(some_haptic(mono_now()), mono_now()); }));
  EXPECT_FALSE(output->is_there());
  start_player();
  EXPECT_TRUE(play(*output, some_haptic(mono_now())));
  output->stop();
  EXPECT_TRUE(wait_for([&] { return heard().find("turnOffAll") != std::string::npos; })) << heard();
}

TEST_F(BhapticsTest, OpensWhereAPlayerIsAndSaysWhereNoneIs) {
  start_player();
  // Until it answers in time, however slow this machine is.
  std::unique_ptr<HapticOutput> there;
  ASSERT_TRUE(wait_for([&] {
    auto opened = BhapticsOutput::open("127.0.0.1:15999");
    if (opened) there = std::move(*opened);
    return there != nullptr;
  }));
  player_->stop(Duration::s(5));
  EXPECT_TRUE(wait_for([&] { return !there->is_there(); }));
  const auto gone = BhapticsOutput::open("127.0.0.1:15999");
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().what.find("no bHaptics Player at 127.0.0.1:15999"), std::string::npos);
  EXPECT_FALSE(BhapticsOutput::open("an address that is none:x"));
}

// As "localhost" is [::1] first, where a player that listens on 127.0.0.1 refuses; a mute one takes
// the connection, and never answers.
TEST_F(BhapticsTest, OfANameWithSeveralAddressesEachIsTried) {
  start_player();
  const Address nobody = Address::loopback(15998), player = Address::loopback(15999);
  const int mute = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_storage raw{};
  socklen_t size = Address::loopback(0).to_sockaddr(Address::Family::kIpv4, raw);
  ASSERT_EQ(::bind(mute, reinterpret_cast<const sockaddr*>(&raw), size), 0);
  ASSERT_EQ(::listen(mute, 64), 0);
  ASSERT_EQ(::getsockname(mute, reinterpret_cast<sockaddr*>(&raw), &size), 0);
  const std::vector<Address> all{nobody, Address::from_sockaddr(raw), player};
  EXPECT_TRUE(
      wait_for([&] { return BhapticsOutput::open("several", [&] { return all; }).has_value(); }));
  const auto none = BhapticsOutput::open("several", [&] {
    return std::vector<Address>{all[0], all[1]};
  });
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("no bHaptics Player at several"), std::string::npos);
  ::close(mute);
}

TEST(BhapticsLater, ANameThatIsNoneIsNoReasonNotToEnd) {
  const auto output = BhapticsOutput::later("an address that is none:x");
  ASSERT_TRUE(output);
  EXPECT_NE(output->summary().find("not found"), std::string::npos);
  EXPECT_FALSE(output->play(some_haptic(mono_now()), mono_now()));
}

}  // namespace
}  // namespace dance
