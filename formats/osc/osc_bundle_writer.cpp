#include "formats/osc/osc_bundle_writer.h"

#include <oscpack/osc/OscOutboundPacketStream.h>

#include <array>
#include <cstring>

namespace dance {
namespace {

constexpr std::size_t kBundleHead_bytes = 16;

// A text with its NUL, filled up to a multiple of four.
std::size_t padded_bytes(std::size_t characters) { return (characters + 4) & ~std::size_t{3}; }

std::size_t bytes_of(const char* address, std::initializer_list<OscValue> values) {
  std::size_t bytes = 4 + padded_bytes(std::strlen(address)) + padded_bytes(1 + values.size());
  for (const OscValue& value : values)
    bytes += value.kind == OscValue::Kind::kText ? padded_bytes(std::strlen(value.text)) : 4;
  return bytes;
}

}  // namespace

struct OscBundleWriter::Buffer {
  alignas(8) std::array<char, kMostPacketBytes> bytes{};
  osc::OutboundPacketStream stream{bytes.data(), bytes.size()};
};

OscBundleWriter::OscBundleWriter(OscPacketSink& sink)
    : sink_(sink), buffer_(std::make_unique<Buffer>()) {}

OscBundleWriter::~OscBundleWriter() = default;

void OscBundleWriter::add(const char* address, std::initializer_list<OscValue> values) {
  const std::size_t bytes = bytes_of(address, values);
  if (kBundleHead_bytes + bytes > kMostPacketBytes) {
    ++left_out_;
    return;
  }
  osc::OutboundPacketStream& stream = buffer_->stream;
  if (stream.IsBundleInProgress() && stream.Size() + bytes > kMostPacketBytes) flush();
  if (!stream.IsBundleInProgress()) stream << osc::BeginBundleImmediate;
  stream << osc::BeginMessage(address);
  for (const OscValue& value : values) {
    switch (value.kind) {
      case OscValue::Kind::kInt:
        stream << static_cast<osc::int32>(value.number);
        break;
      case OscValue::Kind::kFloat:
        stream << value.real;
        break;
      case OscValue::Kind::kText:
        stream << value.text;
        break;
    }
  }
  stream << osc::EndMessage;
}

void OscBundleWriter::flush() {
  osc::OutboundPacketStream& stream = buffer_->stream;
  if (!stream.IsBundleInProgress()) return;
  stream << osc::EndBundle;
  sink_.on_packet({reinterpret_cast<const std::uint8_t*>(stream.Data()), stream.Size()});
  stream.Clear();
}

}  // namespace dance
