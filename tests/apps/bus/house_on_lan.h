// A house on a machine of a LAN with a stranger in it: its programs run as a user runs them, on the
// default bus, and a dancer dances there.
//
// Ownership: programs and files end with the fixture.
// Failure:   what does not come up in time fails the test, with what the programs printed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "core/bus/bus.h"
#include "formats/log/log_file.h"
#include "tests/lan_hosts.h"

namespace dance {

constexpr int kBusPort = 7667;  // of kDefaultBusUrl

// The number of messages of each channel in a log.
inline std::map<std::string, int> count_log_of(const std::string& path) {
  std::map<std::string, int> counts;
  auto log = LogReader::open(path);
  if (!log) {
    ADD_FAILURE() << log.error().what;
    return counts;
  }
  while (const auto event = log->next()) ++counts[std::string(event->channel)];
  return counts;
}

class HouseOnLan : public ::testing::Test {
 protected:
  // A program on the house's machine, until the test ends. What it prints goes to NAME.out and
  // NAME.txt of the folder.
  ChildProcess& start(const std::string& program, const std::vector<std::string>& arguments) {
    const bool is_ours = program.starts_with("dance-");
    return children_.emplace_back(lan_.machine.start(is_ours ? bin(program) : program, arguments,
                                                     folder_.path(program + ".out"),
                                                     folder_.path(program + ".txt")));
  }
  std::string output_of(const std::string& program) const {
    return text_of(folder_.path(program + ".out"));
  }
  std::string talk_of(const std::string& program) const {
    return text_of(folder_.path(program + ".txt"));
  }

  // `dance join` with a dancer from another program, and `dance listen` to its stage.
  void open_house() {
    std::ofstream(folder_.path("house.toml"))
        << "[house]\nguests = [\"bob\"]\n"
        << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
    start("dance-join", {folder_.path("house.toml"), "--no-view"});
    start("dance-salsa", {"--guest", "bob"});
    start("dance-listen", {"--to", "csv"});
    ASSERT_TRUE(is_dance_going_on()) << talk_of("dance-join") << talk_of("dance-listen");
  }
  // Poses that the listener received from now on.
  bool is_dance_going_on() {
    const std::size_t before = poses_of("bob");
    return wait_for([&] { return poses_of("bob") > before + 5 || !all_run(); }) && all_run();
  }
  std::size_t poses_of(const std::string& guest) const {
    const std::string lines = output_of("dance-listen"), word = "," + guest + ",";
    std::size_t count = 0;
    for (std::size_t at = 0; (at = lines.find(word, at)) != std::string::npos; ++at) ++count;
    return count;
  }
  bool all_run() {
    return std::none_of(children_.begin(), children_.end(),
                        [](ChildProcess& child) { return child.has_ended(); });
  }

  Lan lan_;
  TestFolder folder_{"house-on-lan"};
  std::deque<ChildProcess> children_;  // references to them hold
};

}  // namespace dance
