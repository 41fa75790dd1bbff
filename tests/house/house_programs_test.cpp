// A house that hears others through a server: what its session file and the command line say about
// that.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr const char* kHouseServer = "127.0.0.1:7445";

class HousePrograms : public BusPrograms {
 protected:
  void SetUp() override {
    start("dance-server", {"--port", "7445", "--bind", "127.0.0.1"});
    start("dance-link", {"--server", kHouseServer, "--room", "salsa", "--guest", "alice", "--guest",
                         "bob", "--bus", kBus});
    for (const char* guest : {"alice", "bob"})
      start("dance-salsa", {"--guest", guest, "--bus", kBus});
  }

  // Runs a house until it has heard enough of a guest; what it counted.
  nlohmann::json counted_when_heard(const char* guest, std::vector<std::string> arguments) {
    constexpr int kEnough = 60;
    auto ear = Bus::open(kOtherBus);
    if (!ear) return nullptr;
    int heard = 0;
    (*ear)->subscribe<Pose>({Where::kGuest, *GuestId::parse(guest)},
                            [&](const Channel&, const Pose&, MonoTime) { ++heard; });
    arguments.insert(arguments.end(), {"--bus", kOtherBus, "--no-view", "--json"});
    ChildProcess& house = start("dance-join", arguments);
    EXPECT_TRUE(wait_for([&] {
      (*ear)->drain(mono_now());
      return heard >= kEnough;
    })) << guest
        << " is not heard: " << text_of(folder_.path("talk"));
    house.ask_to_stop();
    EXPECT_TRUE(wait_for([&] { return house.has_ended(); }));
    EXPECT_TRUE(house.ended_well()) << house.exit_text();
    const std::string output = text_of(folder_.path("output"));
    const std::size_t last = output.rfind('{', output.rfind("\"offered\""));
    return last == std::string::npos ? nullptr
                                     : nlohmann::json::parse(output.substr(last), nullptr, false);
  }
  static std::uint64_t received(const nlohmann::json& counted, const std::string& guest) {
    for (const auto& one : counted["guests"])
      if (one["id"] == guest) return one["received"];
    return 0;
  }
};

TEST_F(HousePrograms, HearWhomTheSessionWantsAndTheCommandLineCountsMore) {
  const std::string session = folder_.path("house.toml");
  std::ofstream(session) << "[house]\nserver = \"" << kHouseServer
                         << "\"\nroom = \"salsa\"\nwant = [\"default=0\", \"bob=1\"]\n";
  // Whom a house does not want is not sent a pose of, from the first hello on: none, however long
  // it takes.
  const auto by_file = counted_when_heard("bob", {session});
  ASSERT_TRUE(by_file.is_object()) << by_file;
  EXPECT_GT(received(by_file, "bob"), 0u) << by_file;
  EXPECT_EQ(received(by_file, "alice"), 0u) << by_file;
  const auto by_option =
      counted_when_heard("alice", {session, "--want", "alice=1", "--want", "default=0"});
  ASSERT_TRUE(by_option.is_object()) << by_option;
  EXPECT_GT(received(by_option, "alice"), 0u) << by_option;
  EXPECT_EQ(received(by_option, "bob"), 0u) << by_option;
  // Without a file, the option alone.
  const auto without = counted_when_heard(
      "bob", {kHouseServer, "--room", "salsa", "--guest", "carol", "--want", "alice=0"});
  ASSERT_TRUE(without.is_object()) << without;
  EXPECT_GT(received(without, "bob"), 0u) << without;
}

// True if alice and bob face each other within a step on this stage for a whole second.
void expect_partners_on_stage(const char* bus) {
  struct Seen {
    Eigen::Vector3f p_WH_m = Eigen::Vector3f::Zero(), forward = Eigen::Vector3f::Zero();
    MonoTime at;
  };
  auto ear = Bus::open(bus);
  ASSERT_TRUE(ear) << ear.error().what;
  std::map<std::string, Seen> seen;
  (*ear)->subscribe<Pose>(Where::kStage, [&](const Channel& channel, const Pose& pose, MonoTime) {
    seen[std::string(channel.guest().view())] = {
        pose.p_WH_m, pose.R_PB[0] * Eigen::Vector3f::UnitZ(), mono_now()};
  });
  MonoTime since;
  float distance_m = 0.0f, facing = 0.0f;
  EXPECT_TRUE(wait_for([&] {
    const MonoTime now = mono_now();
    (*ear)->drain(now);
    const Seen &alice = seen["alice"], &bob = seen["bob"];
    distance_m = (alice.p_WH_m - bob.p_WH_m).norm();
    facing = alice.forward.dot(bob.forward);
    const bool are_shown = now - alice.at < Duration::s(1) && now - bob.at < Duration::s(1);
    const bool are_partners = are_shown && distance_m > 0.4f && distance_m < 1.3f && facing < 0.0f;
    if (!are_partners) since = MonoTime();
    if (are_partners && !since.is_set()) since = now;
    return are_partners && now - since > Duration::s(1);
  })) << bus
      << ": " << seen.size() << " dancers, " << distance_m << " m apart, facing " << facing;
}

class TwoHouses : public BusPrograms {
 protected:
  // How often it has been said that there is another house.
  int said() const {
    const std::string talk = text_of(folder_.path("talk"));
    const std::string line = "another house is open on " + std::string(kBus);
    int times = 0;
    for (std::size_t at = talk.find(line); at != std::string::npos; at = talk.find(line, at + 1))
      ++times;
    return times;
  }
};

TEST_F(TwoHouses, OnOneBusBothSaySoOnce) {
  open_house();
  auto ear = Bus::open(kBus);
  ASSERT_TRUE(ear) << ear.error().what;
  int seconds = 0;
  (*ear)->subscribe<Stats>(Where::kProgram,
                           [&](const Channel&, const Stats&, MonoTime) { ++seconds; });
  const auto wait_for_seconds = [&](int more) {
    const int until = seconds + more;
    return wait_for([&] {
      (*ear)->drain(mono_now());
      return seconds >= until;
    });
  };
  ASSERT_TRUE(wait_for_seconds(2));
  EXPECT_EQ(said(), 0) << "it is not another house to itself";
  start("dance-manager", {"--bus", kBus});
  EXPECT_TRUE(wait_for([&] { return said() >= 2; })) << text_of(folder_.path("talk"));
  ASSERT_TRUE(wait_for_seconds(4));  // of both together
  EXPECT_EQ(said(), 2) << text_of(folder_.path("talk"));
  // A third is told of, too, and then there is an end of it.
  start("dance-manager", {"--bus", kBus});
  EXPECT_TRUE(wait_for([&] { return said() >= 3; })) << text_of(folder_.path("talk"));
  ASSERT_TRUE(wait_for_seconds(6));
  const int times = said();
  ASSERT_TRUE(wait_for_seconds(9));
  EXPECT_EQ(said(), times) << text_of(folder_.path("talk"));
}

TEST_F(TwoHouses, WithUntouchedSettingsAreACoupleOnBothStages) {
  start("dance-server", {"--port", "7445", "--bind", "127.0.0.1"});
  for (const auto& [guest, bus] : {std::pair("alice", kBus), {"bob", kOtherBus}}) {
    const std::string session = folder_.path(std::string(guest) + ".toml");
    std::ofstream(session) << "[house]\nserver = \"" << kHouseServer
                           << "\"\nroom = \"salsa\"\nguest = \"" << guest
                           << "\"\n[[produce]]\nkind = \"salsa\"\nguest = \"" << guest << "\"\n";
    start("dance-join", {session, "--bus", bus, "--no-view"});
  }
  expect_partners_on_stage(kBus);
  expect_partners_on_stage(kOtherBus);
}

TEST_F(HousePrograms, ARefusalThatStaysIsSaidOnce) {
  ASSERT_TRUE(wait_for([&] {
    return text_of(folder_.path("talk")).find("in room 'salsa'") != std::string::npos;
  })) << text_of(folder_.path("talk"));
  start("dance-join",
        {kHouseServer, "--room", "salsa", "--guest", "alice", "--bus", kOtherBus, "--no-view"});
  const auto refusals = [&] {
    const Finished status = run(bin("dance-status --port 7445 --once --json"));
    const auto all = nlohmann::json::parse(status.output, nullptr, false);
    return all.is_object() ? all["rejects"].value("refused", 0) : 0;
  };
  EXPECT_TRUE(wait_for([&] { return refusals() >= 4; }));
  const std::string talk = text_of(folder_.path("talk"));
  const std::string line = "guest 'alice' is in room 'salsa' already";
  EXPECT_NE(talk.find(line), std::string::npos) << talk;
  EXPECT_EQ(talk.find(line), talk.rfind(line)) << talk;
}

TEST_F(HousePrograms, AWishThatIsNoneIsOneLineThatNamesIt) {
  const std::string session = folder_.path("house.toml");
  std::ofstream(session) << "[house]\nroom = \"salsa\"\nwant = [\"bob\"]\n";
  const std::string deaf = folder_.path("deaf.toml");
  std::ofstream(deaf) << "[house]\nroom = \"salsa\"\nhear = [\"bob=2\"]\n";
  for (const auto& [arguments, start_of_line] :
       {std::pair<std::string, std::string>{
            "dance-join " + session, "dance join: " + session + ":3:8: [house] want: 'bob': write"},
        {"dance-manager " + session,
         "dance manager: " + session + ":3:8: [house] want: 'bob': write"},
        {"dance-join host --want bob", "dance join: --want 'bob': write"},
        {"dance-link --want bob", "dance link: --want 'bob': write"},
        {"dance-join host --hear bob", "dance join: --hear 'bob': write"},
        {"dance-join " + deaf, "dance join: " + deaf + ":3:8: [house] hear: 'bob=2': write"},
        {"dance-link --hear bob=2", "dance link: --hear 'bob=2': write"}}) {
    const Finished refused = run(bin(arguments));
    EXPECT_EQ(refused.exit_code, 1) << refused.talk;
    EXPECT_EQ(refused.talk.rfind(start_of_line, 0), 0u) << refused.talk;
    EXPECT_EQ(std::count(refused.talk.begin(), refused.talk.end(), '\n'), 1) << refused.talk;
  }
}

}  // namespace
}  // namespace dance
