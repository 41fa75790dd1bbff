#include "apps/status/status_source.h"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/base/take_line.h"
#include "core/net/local_socket.h"
#include "tunnel/server/program/audit_keeper.h"
#include "tunnel/server/program/server_watch.h"

namespace dance {
namespace {

constexpr Duration kAnswerTimeout = Duration::s(2);

std::string file_text(const char* path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::optional<uid_t> owner_now(std::uint16_t port) {
  if (const auto owner = owner_of_udp_port(file_text("/proc/net/udp"), port)) return owner;
  return owner_of_udp_port(file_text("/proc/net/udp6"), port);
}

// Where a server of this user, of the port's owner, or of systemd's unit has its socket.
std::vector<std::string> folders_to_ask(std::optional<uid_t> owner) {
  std::vector<std::string> folders{local_socket_folder(), fmt::format("/tmp/dance-{}", ::geteuid()),
                                   fmt::format("/run/user/{}/dance", ::geteuid())};
  if (owner && *owner != ::geteuid()) {
    folders.push_back(fmt::format("/tmp/dance-{}", *owner));
    folders.push_back(fmt::format("/run/user/{}/dance", *owner));
  }
  folders.emplace_back("/run/dance-server/dance");
  return folders;
}

}  // namespace

// Rows like `  12: 0100007F:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000 …`.
std::optional<uid_t> owner_of_udp_port(std::string_view table, std::uint16_t port) {
  const std::string wanted = fmt::format("{:04X}", port);
  while (!table.empty()) {
    const std::string_view row = take_line(table);
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < row.size();) {
      at = row.find_first_not_of(' ', at);
      if (at == std::string_view::npos) break;
      const std::size_t end = std::min(row.find(' ', at), row.size());
      words.push_back(row.substr(at, end - at));
      at = end;
    }
    constexpr std::size_t kLocal = 1, kOwner = 7;
    if (words.size() <= kOwner) continue;
    const std::size_t colon = words[kLocal].rfind(':');
    if (colon == std::string_view::npos || words[kLocal].substr(colon + 1) != wanted) continue;
    uid_t owner = 0;
    const std::string_view text = words[kOwner];
    if (std::from_chars(text.data(), text.data() + text.size(), owner).ec == std::errc())
      return owner;
  }
  return std::nullopt;
}

namespace {

struct SocketText {
  std::string text;
  std::string path;
};

// Asks the server on this port through its socket of this name.
Result<SocketText> read_server_socket(std::uint16_t port, const std::string& socket_name) {
  const std::optional<uid_t> owner = owner_now(port);
  bool is_others = owner && *owner != ::geteuid();
  for (const std::string& folder : folders_to_ask(owner)) {
    const std::string path = folder + "/" + socket_name;
    auto text = read_local_text(path, kAnswerTimeout);
    if (text) return SocketText{std::move(*text), path};
    switch (text.error().trouble) {
      case LocalTrouble::kNobody:
        continue;
      case LocalTrouble::kNotYours:
        is_others = true;
        continue;
      case LocalTrouble::kSilent:
        return fail(
            fmt::format("the server on port {} does not answer ({}): try again; if it "
                        "stays so, start it anew",
                        port, text.error().reason));
      case LocalTrouble::kOther:
        return fail(path + ": " + text.error().reason);
    }
  }
  if (is_others && owner)
    return fail(
        fmt::format("the program on port {} is not yours but that of user {}: ask as that "
                    "user, or as root",
                    port, *owner));
  if (is_others)
    return fail(
        fmt::format("there is a server for port {}, but it is not yours: ask as its user, "
                    "or as root",
                    port));
  if (owner)
    return fail(
        fmt::format("a program on port {} has no status socket: it is no `dance server`, "
                    "or one with another XDG_RUNTIME_DIR",
                    port));
  return fail(
      fmt::format("no server on port {} of this machine: start one with `dance server "
                  "--port {}`, or name another --port",
                  port, port));
}

}  // namespace

Result<nlohmann::ordered_json> ask_server(std::uint16_t port) {
  DANCE_TRY(const SocketText answer, read_server_socket(port, status_socket_name(port)));
  auto status = nlohmann::ordered_json::parse(answer.text, nullptr, false);
  if (status.is_object()) return status;
  return fail(answer.path +
              " does not answer with a server's status: is the server of another version? use the "
              "`dance` that started it");
}

Result<std::string> ask_server_log(std::uint16_t port) {
  DANCE_TRY(SocketText answer, read_server_socket(port, audit_socket_name(port)));
  return std::move(answer.text);
}

}  // namespace dance
