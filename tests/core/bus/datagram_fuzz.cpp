// Datagrams of the bus from anybody. A message that is accepted has a valid name, and is the same
// once it is written and read again; a fragment has at most a name.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/assert.h"
#include "core/bus/channel.h"
#include "core/bus/datagram.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(bus_datagram) {
  using dance::BusDatagram;
  const BusDatagram datagram = dance::parse_datagram({data, size});
  DANCE_ASSERT(datagram.name.empty() || dance::is_channel_name(datagram.name));
  if (datagram.kind != BusDatagram::Kind::kMessage) {
    DANCE_ASSERT(datagram.data.empty());
    DANCE_ASSERT(datagram.name.empty() || datagram.kind == BusDatagram::Kind::kFragment);
    return 0;
  }
  DANCE_ASSERT(!datagram.name.empty());
  const dance::DatagramHeader header(7, datagram.name);
  DANCE_ASSERT(header.size + datagram.data.size() == size, header.size, size);
  std::vector<std::uint8_t> again(header.bytes.begin(),
                                  header.bytes.begin() + static_cast<std::ptrdiff_t>(header.size));
  again.insert(again.end(), datagram.data.begin(), datagram.data.end());
  const BusDatagram read = dance::parse_datagram(again);
  DANCE_ASSERT(read.kind == BusDatagram::Kind::kMessage && read.name == datagram.name);
  DANCE_ASSERT(std::ranges::equal(read.data, datagram.data));
  if (const auto channel = dance::Channel::parse(datagram.name))
    DANCE_ASSERT(channel->view() == datagram.name);
  return 0;
}
