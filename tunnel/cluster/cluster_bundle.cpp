#include "tunnel/cluster/cluster_bundle.h"

#include <algorithm>
#include <utility>

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"

namespace dance::cluster {
namespace {

constexpr std::uint8_t kBundleType = 6;
constexpr std::size_t kLeastPart = 2;

bool begins_bundle(Bytes bytes) {
  return bytes.size() >= 2 && bytes[0] == kClusterVersion && bytes[1] == kBundleType;
}

}  // namespace

bool BundleWriter::try_add(const Message& message) {
  if (size_ + kPartHeader > buffer_.size()) return false;
  const auto room = std::span(buffer_).subspan(size_ + kPartHeader);
  const std::size_t size = build(message, room.first(std::min(room.size(), kMaxBytes)));
  if (size == 0) return false;
  ByteWriter header{std::span(buffer_).subspan(size_, kPartHeader)};
  header.u16(static_cast<std::uint16_t>(size));
  size_ += kPartHeader + size;
  ++parts_;
  return true;
}

Bytes BundleWriter::bytes() const {
  const Bytes all(buffer_.data(), size_);
  return parts_ == 1 ? all.subspan(kHeader + kPartHeader) : all;
}

void BundleWriter::clear() {
  buffer_[0] = kClusterVersion;
  buffer_[1] = kBundleType;
  size_ = kHeader;
  parts_ = 0;
}

BundleReader::BundleReader(Bytes bytes) : rest_(bytes), is_bundle_(begins_bundle(bytes)) {
  if (!is_bundle_) return;
  rest_ = bytes.subspan(2);
  is_good_ = !rest_.empty() && bytes.size() <= kMaxBundle;
}

std::optional<Bytes> BundleReader::next() {
  if (!is_good_ || rest_.empty()) return std::nullopt;
  if (!is_bundle_) return std::exchange(rest_, Bytes());
  ByteReader in(rest_);
  const Bytes part = in.bytes(in.u16());
  // None within another.
  if (!in.ok() || part.size() < kLeastPart || part.size() > kMaxBytes || begins_bundle(part)) {
    is_good_ = false;
    return std::nullopt;
  }
  rest_ = rest_.subspan(2 + part.size());
  return part;
}

}  // namespace dance::cluster
