#include "bench/path/bus_flood.h"

#include <sys/socket.h>

#include <string>
#include <thread>
#include <vector>

#include "bench/path/bare_hops.h"
#include "core/base/pacer.h"
#include "core/base/random.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr double kBurstsHz = 1000.0;

std::string hostile_datagram(std::uint32_t number, Random& random) {
  std::string noise(64 + random.below(1200), 'x');
  for (std::size_t i = 0; i < 32; ++i) noise[i] = static_cast<char>(random.below(256));
  const std::string sequence("\0\0\0\1", 4), nul(1, '\0');
  switch (number % 6) {
    case 0:  // offset and size wrap around to a number below the size of the message
      return "LC03" + sequence + std::string("\0\0\1\0\xff\xff\xff\0\0\0\0\1", 12) +
             "POSE/stage/alice" + nul + std::string(256, 'x');
    case 1:
      return "LC02" + sequence + "\x1b[31mEVI";
    case 2:
      return noise;
    case 3:
      return "LC02" + sequence + "EVIL/" + std::to_string(number) + nul + noise;
    case 4:
      return "LC02" + sequence + "POSE/capture/alice" + nul + noise;
    default:
      return "LC02" + sequence + "POSE/stage/evil-" + std::to_string(number % 1000) + nul + noise;
  }
}

}  // namespace

Error flood_buses(std::span<const std::uint16_t> ports, double rate_hz) {
  std::vector<int> sockets;
  for (const std::uint16_t port : ports) {
    sockets.push_back(open_group_sender(port));
    if (sockets.back() < 0) return {"the flood's socket cannot be opened"};
  }
  Random random(41);
  const MonoTime begin = mono_now();
  Pacer pacer(begin, kBurstsHz);
  for (std::uint32_t number = 0;;) {
    const double due = rate_hz * (mono_now() - begin).as_seconds();
    while (number < due) {
      const std::string datagram = hostile_datagram(number, random);
      // A datagram that the kernel refuses is not sent again.
      [[maybe_unused]] const auto sent =
          send(sockets[number / 6 % sockets.size()], datagram.data(), datagram.size(), 0);
      ++number;
    }
    const MonoTime now = mono_now();
    pacer.advance(now);
    if (pacer.deadline() > now)
      std::this_thread::sleep_for(std::chrono::nanoseconds((pacer.deadline() - now).count_ns()));
  }
}

}  // namespace dance
