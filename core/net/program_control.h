// Commands to a running program from another terminal, a foot switch's script or a viewer: one line
// of text in a datagram, between processes of one user.
//
// Units/frames: lines of kMostBytes at most.
// Ownership:    ProgramControl owns its socket file; the poller must outlive it.
// Threads:      the poller's.
// Failure:      open() names a path that another program serves; send_to_program() reports whether
//               a program received the command.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "core/net/local_datagram.h"
#include "core/net/poller.h"

namespace dance {

class ProgramControl {
 public:
  static constexpr std::size_t kMostBytes = 64;
  using OnCommand = std::function<void(std::string_view command, MonoTime now)>;

  static Result<std::unique_ptr<ProgramControl>> open(const std::string& path, OnCommand on_command,
                                                      Poller& poller);
  ~ProgramControl();
  ProgramControl(const ProgramControl&) = delete;
  ProgramControl& operator=(const ProgramControl&) = delete;

 private:
  ProgramControl(std::unique_ptr<LocalDatagramSocket> socket, OnCommand on_command, Poller& poller);

  std::unique_ptr<LocalDatagramSocket> socket_;
  OnCommand on_command_;
  Poller& poller_;
};

// Path for the `program` that serves one guest on the bus with this LCM URL.
std::string control_path(std::string_view program, std::string_view bus_url, const GuestId& guest);
// Path for a program that serves all guests of the bus.
std::string control_path(std::string_view program, std::string_view bus_url);
// Path for one of several such programs: `path` with a number.
std::string numbered_control_path(const std::string& path, std::uint64_t number);
// The files at these paths, including those that killed programs left.
std::vector<std::string> numbered_control_files(const std::string& path);
// The files whose programs listen; removes those that killed programs left.
std::vector<std::string> numbered_control_paths(const std::string& path);

using Told = LocalDatagramSender::Sent;
Result<Told> send_to_program(const std::string& path, std::string_view command);
// Sends to all of numbered_control_paths(): how many received it, and how many do not listen.
struct ToldAll {
  int sent = 0;
  int deaf = 0;
};
Result<ToldAll> tell_programs(const std::string& path, std::string_view command);
// "limit 0.4" after the word "limit": a number from 0 to 1; nullopt for any other line.
std::optional<double> share_after(std::string_view word, std::string_view command);

}  // namespace dance
