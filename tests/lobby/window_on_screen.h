// A window of the lobby on a virtual display, its programs, and what is on the screen.
//
// Units/frames: pixels of the screen; colours 0xRRGGBB.
// Ownership:    owns the window's program, which ends with it.
// Threads:      one.
// Failure:      a test that uses it fails.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/program/child_process.h"
#include "tests/apps/run_program.h"

namespace dance {

// An X window dump of 32 bits a pixel, as Xvfb leaves it in a file.
class ScreenDump {
 public:
  explicit ScreenDump(const std::string& path) : dump_(text_of(path)) {}

  int width_px() const { return static_cast<int>(number(4UL * 4)); }
  int height_px() const { return static_cast<int>(number(4UL * 5)); }
  unsigned int pixel(int x, int y) const {
    const std::size_t header = number(0) + 12UL * number(4UL * 19);
    const std::size_t at = header + static_cast<std::size_t>(y) * number(4UL * 12) + 4UL * x;
    return at + 3 >= dump_.size() ? 0 : byte(at + 2) << 16 | byte(at + 1) << 8 | byte(at);
  }
  const std::string& bytes() const { return dump_; }

 private:
  unsigned int byte(std::size_t at) const {
    return static_cast<unsigned int>(static_cast<unsigned char>(at < dump_.size() ? dump_[at] : 0));
  }
  unsigned int number(std::size_t at) const {
    return byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
  }

  std::string dump_;
};

class LobbyOnScreen {
 public:
  static constexpr unsigned int kAccent = 0xff8b66, kRow = 0x2e313d;

  // Its settings are in `config`, its left edge is at `x`.
  LobbyOnScreen(const TestFolder& folder, const std::string& name, int x = 0)
      : screen_(folder.path("Xvfb_screen0")),
        config_(folder.path(name)),
        talk_(folder.path(name + "-talk")),
        x_(x) {}

  std::string settings() const { return config_ + "/dancegraph/house.toml"; }
  void put_settings(const std::string& text) const {
    std::filesystem::create_directories(config_ + "/dancegraph");
    std::ofstream(settings()) << text;
  }
  void start(std::vector<std::string> arguments = {}) {
    setenv("XDG_CONFIG_HOME", config_.c_str(), 1);
    auto started = ChildProcess::start({bin("dance-lobby"), std::move(arguments), "", talk_});
    ASSERT_TRUE(started) << started.error().what;
    lobby_ = std::make_unique<ChildProcess>(std::move(*started));
  }
  ChildProcess& program() { return *lobby_; }
  bool is_started() const { return lobby_ != nullptr; }
  std::string talk() const { return text_of(talk_); }

  ScreenDump screen() const { return ScreenDump(screen_); }
  unsigned int pixel(int x, int y) const { return screen().pixel(x_ + x, y); }
  // The list of screens at the left has a colour of its own.
  bool shows_lobby() const { return pixel(5, 400) == 0x0e1015 && pixel(230, 600) == 0x0e1015; }
  // An error banner is at the top: it is dark red.
  bool shows_error_banner() const {
    const ScreenDump dump = screen();
    for (int x = 320; x < 330; ++x) {
      const unsigned int colour = dump.pixel(x_ + x, 28);
      if (colour >> 16 < 0x50 || colour >> 16 > 0x58 || (colour >> 8 & 0xff) > 0x30) return false;
    }
    return true;
  }
  // Where a button that is to be seen first begins in this column, below y; -1 = nowhere.
  int accent_below(int x, int y) const {
    const ScreenDump dump = screen();
    for (; y < dump.height_px(); ++y)
      if (dump.pixel(x_ + x, y) == kAccent) return y;
    return -1;
  }
  // The middles of fields and plain buttons in this column, from the top.
  std::vector<int> row_middles(int x, int from_y = 0) const {
    constexpr int kLeast_px = 20;
    const ScreenDump dump = screen();
    std::vector<int> middles;
    for (int y = from_y, begin = from_y; y <= dump.height_px(); ++y) {
      if (y < dump.height_px() && dump.pixel(x_ + x, y) == kRow) continue;
      if (y - begin >= kLeast_px) middles.push_back((begin + y) / 2);
      begin = y + 1;
    }
    return middles;
  }
  // The end of the lowest row of a list in this column; -1 = there is none.
  int lowest_row(int x) const {
    const ScreenDump dump = screen();
    for (int y = dump.height_px() - 1; y >= 0; --y)
      if (dump.pixel(x_ + x, y) == kRow) return y;
    return -1;
  }
  std::vector<pid_t> children(const std::string& program) const {
    std::vector<pid_t> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      std::string status;  // a process may end meanwhile
      std::ifstream file(entry.path().string() + "/stat");
      std::getline(file, status);
      const std::size_t open = status.find('('), close = status.rfind(") ");
      if (close == std::string::npos || status.substr(open + 1, close - open - 1) != program)
        continue;
      const bool is_zombie = status[close + 2] == 'Z';
      if (!is_zombie && std::stoi(status.substr(close + 4)) == lobby_->pid())
        found.push_back(std::stoi(name));
    }
    return found;
  }
  bool dances() const { return children("dance-join").size() == 1 && !shows_lobby(); }
  bool is_back() const { return children("dance-join").empty() && shows_lobby(); }

 private:
  std::string screen_, config_, talk_;
  int x_;
  std::unique_ptr<ChildProcess> lobby_;
};

}  // namespace dance
