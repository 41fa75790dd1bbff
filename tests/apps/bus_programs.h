// A bus in the network of a flow test, the programs that a test starts on it, and what it asks of
// them.
//
// Ownership: the fixture's programs and files end with the test.
// Threads:   one.
// Failure:   what does not come up in time fails the test, with what the programs said.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "tests/apps/run_program.h"

namespace dance {

constexpr const char* kBus = "udpm://239.255.76.67:7742?ttl=0";
constexpr const char* kOtherBus = "udpm://239.255.76.67:7743?ttl=0";

inline std::string quoted(const char* bus) { return std::string("'") + bus + "'"; }

class BusPrograms : public ::testing::Test {
 protected:
  // Runs until the test ends.
  ChildProcess& start(const std::string& program, std::vector<std::string> arguments) {
    const bool is_ours = program.starts_with("dance-");
    auto child = ChildProcess::start({is_ours ? bin(program) : program, std::move(arguments),
                                      folder_.path("output"), folder_.path("talk")});
    if (!child) ADD_FAILURE() << child.error().what;
    return children_.emplace_back(std::move(*child));
  }

  // A house with a synthetic couple in it, on its stage.
  void open_house(const char* bus = kBus) {
    std::ofstream(folder_.path("house.toml"))
        << "[house]\nbus = \"" << bus << "\"\nguests = [\"alice\", \"bob\"]\n"
        << "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\nrole = \"lead\"\n"
        << "[[produce]]\nkind = \"salsa\"\nguest = \"bob\"\nrole = \"follow\"\n"
        << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
    start("dance-manager", {folder_.path("house.toml")});
    auto ear = Bus::open(bus);
    ASSERT_TRUE(ear) << ear.error().what;
    std::set<std::string> heard;
    (*ear)->subscribe<Pose>(Where::kStage, [&](const Channel& channel, const Pose&, MonoTime) {
      heard.emplace(channel.guest().view());
    });
    ASSERT_TRUE(wait_for([&] {
      (*ear)->drain(mono_now());
      return heard.size() == 2;
    })) << "the house did not open: "
        << text_of(folder_.path("talk"));
  }

  // LCM's own player, again and again until the test ends.
  void play_over_and_over(const std::string& log, const char* bus) {
    start("/bin/sh", {"-c", "trap 'kill $!; exit' TERM\nwhile :; do lcm-logplayer --lcm-url=" +
                                quoted(bus) + " " + log + " & wait $! || sleep 0.1; done"});
  }

  void end_all() {
    for (ChildProcess& child : children_) child.stop(Duration::s(5));
    children_.clear();
  }

  TestFolder folder_{"bus-programs"};
  std::deque<ChildProcess> children_;  // references to them hold
};

inline int lines_of(const Finished& heard, const std::string& guest) {
  int lines = 0;
  for (std::size_t at = 0;
       (at = heard.output.find("," + guest + ",", at + 1)) != std::string::npos;)
    ++lines;
  return lines;
}

// dance-listen hears both of them dance.
inline void expect_couple_on_stage(const char* bus) {
  constexpr int kDance = 5;  // lines: one or two could be of a show that is over
  const Finished heard = run_until(
      bin("dance-listen") + " --to csv --seconds 2 --bus " + quoted(bus), [](const Finished& it) {
        return lines_of(it, "alice") > kDance && lines_of(it, "bob") > kDance;
      });
  EXPECT_EQ(heard.exit_code, 0) << heard.talk;
  EXPECT_GT(lines_of(heard, "alice"), kDance) << heard.output.substr(0, 500) << heard.talk;
  EXPECT_GT(lines_of(heard, "bob"), kDance) << heard.output.substr(0, 500) << heard.talk;
}

inline bool has_all(const std::string& text, const std::vector<const char*>& words) {
  return std::all_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

}  // namespace dance
