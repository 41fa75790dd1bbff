#include "formats/osc/osc_reader.h"

#include <oscpack/osc/OscReceivedElements.h>

namespace dance {
namespace {

constexpr std::size_t kLargestPacket_bytes = 65'536;
constexpr std::size_t kBundleBegin_bytes = 16;

// One packet's messages, counted down so that a packet of very many costs a bounded time.
class Walk {
 public:
  Walk(OscMessageSink& sink, std::uint64_t& messages) : sink_(sink), messages_(messages) {}

  // No deeper than was looked at.
  bool bundle(const osc::ReceivedBundle& bundle) {
    for (auto element = bundle.ElementsBegin(); element != bundle.ElementsEnd(); ++element) {
      const bool is_read = element->IsBundle() ? this->bundle(osc::ReceivedBundle(*element))
                                               : message(osc::ReceivedMessage(*element));
      if (!is_read) return false;
    }
    return true;
  }

  bool message(const osc::ReceivedMessage& received) {
    if (++seen_ > OscReader::kMostMessages) return false;
    message_.address = received.AddressPattern();
    message_.arguments.clear();
    for (auto a = received.ArgumentsBegin(); a != received.ArgumentsEnd(); ++a)
      if (!message_.arguments.try_push(argument_of(*a))) break;
    ++messages_;
    sink_.on_message(message_);
    return true;
  }

 private:
  static OscArgument argument_of(const osc::ReceivedMessageArgument& received) {
    OscArgument argument;
    if (received.IsInt32()) {
      argument.kind = OscArgument::Kind::kInt;
      argument.number = received.AsInt32Unchecked();
    } else if (received.IsFloat()) {
      argument.kind = OscArgument::Kind::kFloat;
      argument.real = received.AsFloatUnchecked();
    } else if (received.IsString()) {
      argument.kind = OscArgument::Kind::kText;
      argument.text = received.AsStringUnchecked();
    }
    return argument;
  }

  OscMessageSink& sink_;
  std::uint64_t& messages_;
  OscMessage message_;
  int seen_ = 0;
};

std::size_t big_endian_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::size_t{bytes[at]} << 24 | std::size_t{bytes[at + 1]} << 16 |
         std::size_t{bytes[at + 2]} << 8 | std::size_t{bytes[at + 3]};
}

// Whether the elements of bundles lie within each other. oscpack 1.1.0 adds an element's size in 32
// bits: one of -4 bytes ends where it begins, and reading never ends. So sizes are looked at first.
bool has_sound_elements(std::span<const std::uint8_t> element, int depth) {
  if (element.empty() || element.size() % 4 != 0) return false;
  if (element[0] == '/') return true;
  if (element[0] != '#' || element.size() < kBundleBegin_bytes || depth > OscReader::kMostDepth)
    return false;
  for (std::size_t at = kBundleBegin_bytes; at < element.size();) {
    const std::size_t bytes = big_endian_at(element, at);
    at += 4;
    if (bytes > element.size() - at || !has_sound_elements(element.subspan(at, bytes), depth + 1))
      return false;
    at += bytes;
  }
  return true;
}

bool can_be_osc(std::span<const std::uint8_t> packet) {
  return packet.size() <= kLargestPacket_bytes && has_sound_elements(packet, 1);
}

}  // namespace

bool OscReader::read(std::span<const std::uint8_t> packet, OscMessageSink& sink) {
  ++counters_.packets;
  bool is_read = false;
  if (can_be_osc(packet)) {
    Walk walk(sink, counters_.messages);
    // oscpack reports damage by exception.
    try {
      const osc::ReceivedPacket received(reinterpret_cast<const char*>(packet.data()),
                                         packet.size());
      is_read = received.IsBundle() ? walk.bundle(osc::ReceivedBundle(received))
                                    : walk.message(osc::ReceivedMessage(received));
    } catch (const osc::Exception&) {
      is_read = false;
    }
  }
  if (!is_read) ++counters_.damaged;
  return is_read;
}

}  // namespace dance
