// Messages and channel names as a stranger on the bus might send them: whatever decodes must encode
// again.
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "core/bus/channel.h"
#include "core/bus/encode.h"
#include "tests/fuzz_target.h"

namespace {

template <class T>
void try_decode(const std::uint8_t* data, std::size_t size) {
  T value;
  if (dance::decode(data, size, value) != dance::Decoded::kFine) return;
  dance::MessageBuffer buffer;
  DANCE_ASSERT(dance::encode(value, buffer) == size, size);
  T again;
  DANCE_ASSERT(dance::decode(buffer.data(), size, again) == dance::Decoded::kFine);
}

}  // namespace

DANCE_FUZZ_TARGET(bus_decode) {
  dance::for_each_message_type([&]<class Message>() { try_decode<Message>(data, size); });
  const std::string_view name(reinterpret_cast<const char*>(data), size);
  if (const auto channel = dance::Channel::parse(name)) DANCE_ASSERT(channel->view() == name);
  return 0;
}
