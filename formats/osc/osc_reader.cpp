#include "formats/osc/osc_reader.h"

#include <oscpack/osc/OscReceivedElements.h>

#include "formats/osc/osc_bounds.h"

namespace dance {
namespace {

constexpr std::size_t kLargestPacket_bytes = 65'536;

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
    } else if (received.IsDouble()) {
      argument.kind = OscArgument::Kind::kDouble;
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

bool can_be_osc(std::span<const std::uint8_t> packet) {
  return packet.size() <= kLargestPacket_bytes && has_sound_bounds(packet, OscReader::kMostDepth);
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
