#include "core/net/program_control.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "core/base/fnv1a.h"
#include "core/net/local_address.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr int kMostCommandsPerTurn = 16;
constexpr std::size_t kMostNumbered = 64;

}  // namespace

// A bus's URL is no file name: a hash of it is.
std::string control_path(std::string_view program, std::string_view bus_url) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%08x", folded(fnv1a(bus_url)));
  return local_socket_folder() + "/" + std::string(program) + "-" + text.data();
}

std::string control_path(std::string_view program, std::string_view bus_url, const GuestId& guest) {
  return control_path(std::string(program) + "-" + std::string(guest.view()), bus_url);
}

std::string numbered_control_path(const std::string& path, std::uint64_t number) {
  return path + "." + std::to_string(number);
}

namespace {

// Files of that name that `is_wanted` accepts; the bound is on these, so that others hide none.
std::vector<std::string> numbered_files(const std::string& path,
                                        bool (*is_wanted)(const std::string& file)) {
  namespace fs = std::filesystem;
  std::vector<std::string> paths;
  const std::string begin = path + ".";
  std::error_code error;  // no folder: nobody is there
  for (fs::directory_iterator entry(folder_of(path), error), end; !error && entry != end;
       entry.increment(error)) {
    std::string each = entry->path().string();
    if (each.starts_with(begin) && is_wanted(each)) paths.push_back(std::move(each));
    if (paths.size() == kMostNumbered) break;
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

std::vector<std::string> numbered_control_files(const std::string& path) {
  return numbered_files(path, [](const std::string&) { return true; });
}

std::vector<std::string> numbered_control_paths(const std::string& path) {
  return numbered_files(path, LocalDatagramSocket::is_served);
}

Result<std::unique_ptr<ProgramControl>> ProgramControl::open(const std::string& path,
                                                             OnCommand on_command, Poller& poller) {
  DANCE_TRY(auto socket, LocalDatagramSocket::bind(path));
  return std::unique_ptr<ProgramControl>(
      new ProgramControl(std::move(socket), std::move(on_command), poller));
}

ProgramControl::ProgramControl(std::unique_ptr<LocalDatagramSocket> socket, OnCommand on_command,
                               Poller& poller)
    : socket_(std::move(socket)), on_command_(std::move(on_command)), poller_(poller) {
  poller_.watch(socket_->fd(), [this](MonoTime now) {
    std::array<std::uint8_t, kMostBytes> bytes{};
    for (int i = 0; i < kMostCommandsPerTurn; ++i) {
      const std::ptrdiff_t size = socket_->receive(bytes);
      if (size < 0) return;
      if (size > static_cast<std::ptrdiff_t>(bytes.size())) continue;
      on_command_({reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(size)},
                  now);
    }
  });
}

ProgramControl::~ProgramControl() { poller_.unwatch(socket_->fd()); }

Result<Told> send_to_program(const std::string& path, std::string_view command) {
  if (command.size() > ProgramControl::kMostBytes) return fail("the command is too long");
  DANCE_TRY(auto sender, LocalDatagramSender::open(path));
  return sender->send({reinterpret_cast<const std::uint8_t*>(command.data()), command.size()},
                      mono_now());
}

Result<ToldAll> tell_programs(const std::string& path, std::string_view command) {
  ToldAll all;
  for (const std::string& each : numbered_control_paths(path)) {
    DANCE_TRY(const Told told, send_to_program(each, command));
    all.sent += told == Told::kSent ? 1 : 0;
    all.deaf += told == Told::kFull ? 1 : 0;
  }
  return all;
}

std::optional<double> share_after(std::string_view word, std::string_view command) {
  if (!command.starts_with(word) || !command.substr(word.size()).starts_with(' '))
    return std::nullopt;
  command.remove_prefix(word.size() + 1);
  double share = -1.0;
  const auto read = std::from_chars(command.data(), command.data() + command.size(), share);
  if (read.ec != std::errc() || read.ptr != command.data() + command.size()) return std::nullopt;
  if (!(share >= 0.0 && share <= 1.0)) return std::nullopt;
  return share;
}

}  // namespace dance
