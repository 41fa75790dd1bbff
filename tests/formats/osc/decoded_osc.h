// What oscpack, without any code of ours, reads in a packet: for tests of what we write.
//
// Units/frames: none.
// Ownership:    copies.
// Threads:      none inside.
// Failure:      a packet that cannot be read ends the test with oscpack's exception.
#pragma once

#include <oscpack/osc/OscReceivedElements.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/osc/osc_bundle_writer.h"

namespace dance {

struct DecodedOsc {
  std::string address;
  std::string types;
  std::vector<float> floats;
  std::vector<int> ints;
  std::vector<std::string> texts;
};

inline void decode_message(const osc::ReceivedMessage& message, std::vector<DecodedOsc>& all) {
  DecodedOsc decoded;
  decoded.address = message.AddressPattern();
  if (message.ArgumentCount() > 0) decoded.types = message.TypeTags();
  for (auto a = message.ArgumentsBegin(); a != message.ArgumentsEnd(); ++a) {
    if (a->IsFloat()) decoded.floats.push_back(a->AsFloat());
    if (a->IsInt32()) decoded.ints.push_back(a->AsInt32());
    if (a->IsString()) decoded.texts.emplace_back(a->AsString());
  }
  all.push_back(decoded);
}

inline std::vector<DecodedOsc> decode_osc(std::span<const std::uint8_t> packet) {
  std::vector<DecodedOsc> all;
  const osc::ReceivedPacket received(reinterpret_cast<const char*>(packet.data()), packet.size());
  const osc::ReceivedBundle bundle(received);
  for (auto e = bundle.ElementsBegin(); e != bundle.ElementsEnd(); ++e)
    decode_message(osc::ReceivedMessage(*e), all);
  return all;
}

// Keeps the packets that a writer hands over.
class KeptPackets : public OscPacketSink {
 public:
  void on_packet(std::span<const std::uint8_t> packet) override {
    packets.emplace_back(packet.begin(), packet.end());
  }
  std::vector<DecodedOsc> decoded() const {
    std::vector<DecodedOsc> all;
    for (const auto& packet : packets)
      for (auto& message : decode_osc(packet)) all.push_back(std::move(message));
    return all;
  }
  std::vector<std::vector<std::uint8_t>> packets;
};

}  // namespace dance
