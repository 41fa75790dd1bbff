// What joins the servers of a cluster: messages by subject, of which some may be lost, and values
// by key, which last. NatsBus is the real one.
//
// Units/frames: subjects, keys and bytes as in tunnel/cluster/cluster_format.h.
// Ownership:    what is passed is copied or sent before the call returns.
// Threads:      all calls and handlers in the owner's thread; no call waits for the network.
// Failure:      what cannot be sent now is counted; values are written again until they are.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/time.h"

namespace dance {

class ClusterBus {
 public:
  using Bytes = std::span<const std::uint8_t>;
  struct Handlers {
    std::function<void(std::string_view subject, Bytes message, MonoTime now)> on_message;
    // No bytes: the key was erased. After watch() all keys that are there come first.
    std::function<void(std::string_view key, std::optional<Bytes> value, MonoTime now)> on_value;
    // No further value of the same watch() is waiting: all present values have arrived.
    std::function<void(std::string_view key, MonoTime now)> on_all_read;
    // The connection is back: values that others wrote meanwhile arrive, values written here stay.
    std::function<void(MonoTime now)> on_back;
    // NATS restarted with an empty disk and lost all values. Values that peers write again arrive.
    std::function<void(MonoTime now)> on_emptied;
  };

  virtual ~ClusterBus() = default;
  virtual void set_handlers(Handlers handlers) = 0;

  virtual void publish(std::string_view subject, Bytes message) = 0;
  virtual void listen(std::string_view subject) = 0;
  virtual void end_listen(std::string_view subject) = 0;
  // What was published in this turn of the owner goes out, if it has not.
  virtual void end_turn(MonoTime) {}
  // Whether all that was published in earlier turns has gone out.
  virtual bool is_clear() const { return true; }

  virtual void put(std::string_view key, Bytes value) = 0;
  virtual void erase(std::string_view key) = 0;
  // Keys that match, with '>' for all that begins so.
  virtual void watch(std::string_view keys) = 0;
  virtual void end_watch(std::string_view keys) = 0;
};

}  // namespace dance
