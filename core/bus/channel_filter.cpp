#include "core/bus/channel_filter.h"

#include <linux/filter.h>
#include <linux/if_packet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/bus/datagram.h"

namespace dance {
namespace {

using Program = std::vector<sock_filter>;

// A filter of a UDP socket sees the UDP header (8 bytes), then the datagram.
constexpr std::uint32_t kMagicAt = 8;
constexpr std::uint32_t kNameAt = 16;
constexpr std::uint32_t kPass = 0xffffffff;
constexpr std::uint32_t kDrop = 0;

std::uint32_t word_of(std::string_view bytes) {
  std::uint32_t word = 0;
  for (const char byte : bytes) word = word << 8 | static_cast<unsigned char>(byte);
  return word;
}

// The instruction that loads this many bytes (1, 2 or 4).
std::uint16_t load_of(std::size_t size) {
  return BPF_LD | BPF_ABS | (size == 4 ? BPF_W : size == 2 ? BPF_H : BPF_B);
}

std::uint32_t extra(int which) { return static_cast<std::uint32_t>(SKF_AD_OFF + which); }

// Drops what another machine sent. Programs that send over the default device, as LCM's own do
// without a route over lo, arrive here as copies that the kernel looped back: it marks those.
void append_this_machine_only(Program& program) {
  program.insert(program.end(), {BPF_STMT(load_of(4), extra(SKF_AD_IFINDEX)),
                                 BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kLoopbackIndex, 3, 0),
                                 BPF_STMT(load_of(4), extra(SKF_AD_PKTTYPE)),
                                 BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, PACKET_LOOPBACK, 1, 0),
                                 BPF_STMT(BPF_RET | BPF_K, kDrop)});
}

// Passes names with this beginning; others go on to the instruction behind.
void append_beginning(std::string_view beginning, Program& program) {
  Program tests;
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

// A load beyond a datagram's end drops it. Beginnings stand shortest first, so a datagram that is
// too short for one is too short for all behind it.
Program program_of(ChannelFilter::Reach reach, std::span<const std::string> beginnings) {
  Program program;
  if (beginnings.empty()) return {BPF_STMT(BPF_RET | BPF_K, kDrop)};
  if (reach == ChannelFilter::Reach::kThisMachine) append_this_machine_only(program);
  const bool is_everything = beginnings[0].empty();
  program.push_back(BPF_STMT(load_of(4), kMagicAt));
  if (is_everything)
    program.insert(program.end(),
                   {BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kFragmentMagic, 2, 0),
                    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kShortMessageMagic, 1, 0),
                    BPF_STMT(BPF_RET | BPF_K, kDrop), BPF_STMT(BPF_RET | BPF_K, kPass)});
  else
    program.insert(program.end(), {BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kShortMessageMagic, 1, 0),
                                   BPF_STMT(BPF_RET | BPF_K, kDrop)});
  if (is_everything) return program;
  for (const std::string& beginning : beginnings) append_beginning(beginning, program);
  program.push_back(BPF_STMT(BPF_RET | BPF_K, kDrop));
  return program;
}

bool attach_program(int socket_fd, Program& program) {
  const sock_fprog code{static_cast<unsigned short>(program.size()), program.data()};
  return setsockopt(socket_fd, SOL_SOCKET, SO_ATTACH_FILTER, &code, sizeof code) == 0;
}

// Whether one socket has room for both programs at once, tried on a socket of its own.
bool fit_together(Program& one, Program& other) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  const bool fit = attach_program(fd, one) && attach_program(fd, other);
  close(fd);
  return fit;
}

}  // namespace

void ChannelFilter::insert(std::string beginning) {
  for (const std::string& wider : beginnings_)
    if (beginning.starts_with(wider)) return;
  std::erase_if(beginnings_, [&](const std::string& b) { return b.starts_with(beginning); });
  const auto longer =
      std::find_if(beginnings_.begin(), beginnings_.end(),
                   [&](const std::string& b) { return b.size() > beginning.size(); });
  beginnings_.insert(longer, std::move(beginning));
}

void ChannelFilter::want(std::string_view beginning) {
  insert(std::string(beginning.substr(0, kMaxChannelLength)));
  while (beginnings_.size() > kMostBeginnings) {
    std::string shorter = std::move(beginnings_.back());
    beginnings_.pop_back();
    // Cuts at the slash before the last character; without one, everything passes.
    const std::size_t slash =
        shorter.size() < 2 ? std::string::npos : shorter.rfind('/', shorter.size() - 2);
    shorter.resize(slash == std::string::npos ? 0 : slash + 1);
    insert(std::move(shorter));
  }
}

// The kernel holds the old and the new program at once while it replaces one. A full program is
// therefore attached only where the shortest fits beside it, so that the next change can go through
// the shortest again.
bool ChannelFilter::attach(int socket_fd) const {
  const std::string all[] = {""};
  Program shortest = program_of(reach_, all), full = program_of(reach_, beginnings_);
  const bool has_room = fit_together(full, shortest);
  if (!attach_program(socket_fd, shortest)) return false;
  return !has_room || attach_program(socket_fd, full);
}

bool drop_everything(int socket_fd) {
  Program program{BPF_STMT(BPF_RET | BPF_K, kDrop)};
  return attach_program(socket_fd, program);
}

}  // namespace dance
