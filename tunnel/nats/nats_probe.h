// What a NATS server lets this user do, tried for real, without leaving anything there: for the
// doctor.
//
// Units/frames: Durations.
// Ownership:    plain values.
// Threads:      any; waits for NATS, up to some seconds.
// Failure:      whatever fails is in the result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "tunnel/nats/nats_options.h"

namespace dance {

struct NatsProbe {
  struct Bucket {
    std::string name;
    bool is_there = false;
    int replicas = 0;          // NATS servers that shall keep each value
    int current_replicas = 0;  // and those that do now
    std::optional<Error> cannot_read;
    std::optional<Error> cannot_write;
  };

  std::optional<Error> no_connection;
  std::string server;   // that answered, printable
  Duration round_trip;  // the shortest of some
  std::optional<Error> no_jetstream;
  std::vector<Bucket> buckets;
};

NatsProbe probe_nats(const NatsOptions& options, const std::vector<std::string>& buckets);

}  // namespace dance
