// NameLookup: resolves a name in a thread of its own, as a resolver may be silent for half a minute
// and cannot be cancelled.
//
// Ownership: owns its descriptor; a look-up that is running when the object ends is abandoned with
//            its thread, which keeps what it needs.
// Threads:   one owner; `resolve` runs in the look-up's thread, one at a time for each object.
// Failure:   as the resolver's; a thread that cannot be started is a failed look-up.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/net/address.h"

namespace dance {

class NameLookup {
 public:
  using Addresses = Result<std::vector<Address>>;
  using Resolve = std::function<Addresses()>;

  static Result<std::unique_ptr<NameLookup>> create(Resolve resolve);
  ~NameLookup();
  NameLookup(const NameLookup&) = delete;
  NameLookup& operator=(const NameLookup&) = delete;

  // Does nothing while one is running or its answer is not taken.
  void begin();
  bool is_running() const { return is_running_; }
  // Readable when there is an answer.
  int fd() const;
  // The answer of the look-up that was begun, once.
  std::optional<Addresses> take();

 private:
  struct Shared;
  explicit NameLookup(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}
  std::shared_ptr<Shared> shared_;
  bool is_running_ = false;
};

// The answer of this machine's resolver for a name.
struct ResolverAnswer {
  enum class Outcome : std::uint8_t {
    kFound,
    kUnknown,   // the resolver answers that there is no such name
    kNoAnswer,  // no nameserver can be reached
    kSilent,    // no answer within the time
  };
  std::string name;
  Outcome outcome = Outcome::kSilent;
  std::string reason;  // of the system, where there is no address
  Duration took;
};
// After `timeout` the waiting thread is left behind until the resolver gives up.
ResolverAnswer look_up_name(const std::string& name, Duration timeout);

}  // namespace dance
