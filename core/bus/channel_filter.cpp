#include "core/bus/channel_filter.h"

#include <dirent.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <memory>

#include "core/bus/channel.h"

namespace dance {
namespace {

// Of what the kernel shows a filter: a UDP header, LCM's magic and sequence, the name.
constexpr std::uint32_t kMagicAt = 8;
constexpr std::uint32_t kNameAt = 16;
constexpr std::uint32_t kShortMessage =
    0x4c433032;  // "LC02"; parts of longer messages have no name and are let through
// Reading beyond a datagram's end would drop it: one so short that a name might end there is let
// through.
constexpr std::uint32_t kSureToHoldAName = kNameAt + kMaxChannelLength + 1;
constexpr std::uint32_t kPass = 0xffffffff;
constexpr std::uint32_t kDrop = 0;

std::uint32_t word_of(std::string_view bytes) {
  std::uint32_t word = 0;
  for (const char byte : bytes) word = word << 8 | static_cast<unsigned char>(byte);
  return word;
}

// How the kernel loads so many bytes.
std::uint16_t load_of(std::size_t size) {
  return BPF_LD | BPF_ABS | (size == 4 ? BPF_W : size == 2 ? BPF_H : BPF_B);
}

// Passes what begins so, and goes on behind itself with everything else.
void append_beginning(std::string_view beginning, std::vector<sock_filter>& program) {
  std::vector<sock_filter> tests;
  for (std::size_t at = 0; at < beginning.size();) {
    const std::size_t left = beginning.size() - at;
    const std::size_t size = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    tests.push_back(BPF_STMT(load_of(size), kNameAt + static_cast<std::uint32_t>(at)));
    tests.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, word_of(beginning.substr(at, size)), 0, 0));
    at += size;
  }
  tests.push_back(BPF_STMT(BPF_RET | BPF_K, kPass));
  // At most 2 * 18 instructions: a jump reaches 255.
  for (std::size_t i = 1; i < tests.size(); i += 2)
    tests[i].jf = static_cast<std::uint8_t>(tests.size() - 1 - i);
  program.insert(program.end(), tests.begin(), tests.end());
}

std::vector<sock_filter> program_of(const std::vector<std::string>& beginnings) {
  std::vector<sock_filter> program{
      BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0),
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kSureToHoldAName, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, kPass),
      BPF_STMT(load_of(4), kMagicAt),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kShortMessage, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, kPass),
  };
  for (const std::string& beginning : beginnings) append_beginning(beginning, program);
  program.push_back(BPF_STMT(BPF_RET | BPF_K, kDrop));
  return program;
}

bool is_udp_socket_on(int fd, int port) {
  int type = 0;
  socklen_t size = sizeof type;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) return false;
  sockaddr_in address{};
  size = sizeof address;
  return getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         address.sin_family == AF_INET && ntohs(address.sin_port) == port;
}

}  // namespace

std::string_view plain_beginning(std::string_view regex) {
  if (regex.find('|') != std::string_view::npos) return {};
  const std::size_t end = std::min(regex.find_first_of("\\^$.[](){}*+?"), regex.size());
  // A character that may be there or not.
  const bool is_last_counted = end < regex.size() && end > 0 &&
                               std::string_view("{*?").find(regex[end]) != std::string_view::npos;
  return regex.substr(0, is_last_counted ? end - 1 : end);
}

std::vector<int> udp_sockets_on(int port) {
  std::vector<int> sockets;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/fd"), closedir);
  if (!folder) return sockets;
  while (const dirent* entry = readdir(folder.get())) {  // NOLINT(concurrency-mt-unsafe): ours
    const std::string_view name = entry->d_name;
    int fd = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), fd);
    if (error == std::errc() && is_udp_socket_on(fd, port)) sockets.push_back(fd);
  }
  std::sort(sockets.begin(), sockets.end());
  return sockets;
}

void ChannelFilter::insert(std::string beginning) {
  for (const std::string& wider : beginnings_)
    if (beginning.starts_with(wider)) return;
  std::erase_if(beginnings_, [&](const std::string& b) { return b.starts_with(beginning); });
  beginnings_.push_back(std::move(beginning));
}

void ChannelFilter::want(std::string_view regex) {
  insert(std::string(plain_beginning(regex).substr(0, kMaxChannelLength)));
  while (beginnings_.size() > kMostBeginnings) {
    const auto longest =
        std::max_element(beginnings_.begin(), beginnings_.end(),
                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
    std::string shorter = std::move(*longest);
    beginnings_.erase(longest);
    // To the slash before its last character; without one, everything is let through.
    const std::size_t slash =
        shorter.size() < 2 ? std::string::npos : shorter.rfind('/', shorter.size() - 2);
    shorter.resize(slash == std::string::npos ? 0 : slash + 1);
    insert(std::move(shorter));
  }
}

bool ChannelFilter::attach(int socket_fd) const {
  const auto detach = [&] {
    const int unread = 0;  // the kernel looks for a number here, and refuses without
    return setsockopt(socket_fd, SOL_SOCKET, SO_DETACH_FILTER, &unread, sizeof unread) == 0 ||
           errno == ENOENT;
  };
  if (beginnings_.size() == 1 && beginnings_[0].empty()) return detach();
  std::vector<sock_filter> program = program_of(beginnings_);
  const sock_fprog code{static_cast<unsigned short>(program.size()), program.data()};
  const auto attach = [&] {
    return setsockopt(socket_fd, SOL_SOCKET, SO_ATTACH_FILTER, &code, sizeof code) == 0;
  };
  // Where there is no room for two, the last one stays; it keeps back what is wanted since.
  return attach() || (detach() && attach());
}

}  // namespace dance
