// Tests with the programs of two houses and a server: the shown name of one house's guest arrives
// at the other house, in the server's status and in a recording.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/control/house_publisher.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr const char* kNamesServer = "127.0.0.1:7449";

class HouseNames : public BusPrograms {
 protected:
  void SetUp() override { start("dance-server", {"--port", "7449", "--bind", "127.0.0.1"}); }
  ChildProcess& join(const char* guest, const char* bus, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{kNamesServer, "--room", "salsa", "--guest",
                                       guest,        "--bus",  bus,     "--no-view"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start("dance-join", arguments);
  }
  // Waits for a name of alice on the other house's bus.
  bool is_named(std::string_view name) {
    auto ear = Bus::open(kOtherBus);
    if (!ear) return false;
    std::string heard;
    (*ear)->subscribe<Profile>({Where::kGuest, *GuestId::parse("alice")},
                               [&](const Channel&, const Profile& profile, MonoTime) {
                                 heard = profile.shown_name.view();
                               });
    return wait_for([&] {
      (*ear)->drain(mono_now());
      return heard == name;
    });
  }
};

TEST_F(HouseNames, ArriveAtTheOtherHouseAndInTheServersStatus) {
  join("bob", kOtherBus);
  ChildProcess& alice = join("alice", kBus, {"--shown-name", "Alicia L\u00f3pez"});
  ASSERT_TRUE(is_named("Alicia L\u00f3pez")) << text_of(folder_.path("talk"));
  const Finished status = run_until(
      bin("dance-status") + " --once --json --port 7449",
      [](const Finished& it) { return it.output.find("shown_name") != std::string::npos; });
  EXPECT_NE(status.output.find("\"name\":\"alice\",\"shown_name\":\"Alicia L\u00f3pez\""),
            std::string::npos)
      << status.output << status.talk;
  // The guest joins again with another name under the same key; the other house receives it.
  alice.ask_to_stop();
  ASSERT_TRUE(wait_for([&] { return alice.has_ended(); }));
  join("alice", kBus, {"--shown-name", "Ali"});
  ASSERT_TRUE(is_named("Ali")) << text_of(folder_.path("talk"));
}

// The test publishes the reports of a window that records.
TEST_F(HouseNames, HaveARecordingSignWhileAWindowOfTheHouseRecords) {
  join("bob", kOtherBus);
  join("alice", kBus);
  auto poller = Poller::create();
  auto window = Bus::open(kBus), ear = Bus::open(kOtherBus);
  ASSERT_TRUE(poller && window && ear);
  HousePublisher port(**window, kBus, **poller);
  bool is_told = false;
  (*ear)->subscribe<Profile>(
      {Where::kGuest, *GuestId::parse("alice")},
      [&](const Channel&, const Profile& profile, MonoTime) { is_told = profile.is_recording; });
  const auto turn_until = [&](bool records) {
    return wait_for([&] {
      port.publish(Channel::of_house(Signal::kRecording),
                   RecordingState{mono_now(), this_clock_id(), 11, records});
      (*poller)->run_once(Duration::ms(20));
      (*ear)->drain(mono_now());
      return is_told == records;
    });
  };
  EXPECT_TRUE(turn_until(true)) << text_of(folder_.path("talk"));
  EXPECT_TRUE(turn_until(false));
}

TEST_F(HouseNames, AreInARecording) {
  join("alice", kBus, {"--shown-name", "Alicia L\u00f3pez"});
  const std::string log = folder_.path("evening.lcm");
  const Finished recorded =
      run_until("rm -f " + log + "; " + bin("dance-record") + " --bus " + quoted(kBus) +
                    " --seconds 3 -o " + log,
                [&](const Finished&) {
                  return text_of(log).find("PROFILE/capture/alice") != std::string::npos;
                });
  EXPECT_NE(text_of(log).find("Alicia L\u00f3pez"), std::string::npos) << recorded.talk;
}

TEST_F(HouseNames, RefuseAnInvalidName) {
  const Finished refused = run(bin("dance-join") + " " + kNamesServer +
                               " --guest alice --no-view --shown-name \"$(printf 'A\\033[2J')\"");
  EXPECT_EQ(refused.exit_code, 1) << refused.output;
  EXPECT_NE(refused.talk.find("--shown-name 'A?[2J'"), std::string::npos) << refused.talk;
  EXPECT_EQ(refused.talk.find('\033'), std::string::npos);
}

}  // namespace
}  // namespace dance
