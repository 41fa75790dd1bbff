// Several messages of one subject as one: what a turn has for a server, or of a guest, costs NATS
// and the receiver as little as a single message. docs/wire-format.md says it byte by byte.
//
// Units/frames: bytes, as in cluster_format.h.
// Ownership:    BundleWriter owns its buffer; BundleReader is a view of the caller's bytes.
// Threads:      none inside.
// Failure:      try_add() is false where there is no room; next() ends at the first part that is
//               none, and is_good() says so. Nothing here allocates.
#pragma once

#include <array>

#include "tunnel/cluster/cluster_format.h"

namespace dance::cluster {

class BundleWriter {
 public:
  BundleWriter() { clear(); }
  bool is_empty() const { return parts_ == 0; }
  bool try_add(const Message& message);
  // A single message goes as it is.
  Bytes bytes() const;
  void clear();

 private:
  static constexpr std::size_t kHeader = 2, kPartHeader = 2;
  std::array<std::uint8_t, kMaxBundle> buffer_;
  std::size_t size_ = kHeader;
  std::size_t parts_ = 0;
};

// The messages in a bundle; a message that is none is its own only part.
class BundleReader {
 public:
  explicit BundleReader(Bytes bytes);
  std::optional<Bytes> next();
  bool is_good() const { return is_good_; }

 private:
  Bytes rest_;
  bool is_bundle_;
  bool is_good_ = true;
};

}  // namespace dance::cluster
