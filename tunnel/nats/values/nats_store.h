// A bucket of values that a command reads and writes while it waits.
//
// Units/frames: keys as NATS takes them; values are bytes.
// Ownership:    owns its connection.
// Threads:      one; each call waits for NATS, up to a few seconds.
// Failure:      each says what NATS refused. Reading takes at most kMost values, each of at most
//               kMostBytes; what is longer comes cut off, so that who checks it refuses it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "tunnel/nats/nats_options.h"

namespace dance {

class NatsStore {
 public:
  static constexpr std::size_t kMost = 20'000;
  static constexpr std::size_t kMostBytes = 4096;

  static Result<std::unique_ptr<NatsStore>> connect(const NatsOptions& options);
  virtual ~NatsStore() = default;

  virtual Result<std::map<std::string, std::string>> read_all() = 0;
  // False where there is a value already, also one written meanwhile by another server.
  virtual Result<bool> add(std::string_view key, std::string_view value) = 0;
  virtual Result<void> erase(std::string_view key) = 0;
};

}  // namespace dance
