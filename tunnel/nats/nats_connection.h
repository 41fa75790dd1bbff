// A connection to one of a cluster's NATS servers, and a bucket of values there.
//
// Units/frames: none.
// Ownership:    the caller owns what is returned; a bucket goes before its connection.
// Threads:      any; both wait. The library calls `on` from threads of its own.
// Failure:      one line that tells an unreachable server, a refusal and a store that is missing
//               apart, each with its cure.
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "tunnel/nats/nats_handles.h"
#include "tunnel/nats/nats_options.h"

namespace dance {

struct NatsCalls {
  natsConnectionHandler reconnected = nullptr;
  natsErrHandler error = nullptr;
  void* closure = nullptr;
};
Result<NatsHandle<natsConnection>> connect_nats(const NatsOptions& options, const NatsCalls& on);

struct NatsBucket {
  NatsHandle<jsCtx> stream;
  NatsHandle<kvStore> store;
  std::int64_t made_ns = 0;  // wall clock of NATS: tells a bucket from one that was made again
};
// Opens the bucket that the options name, or makes it. Waits for NATS servers that start.
Result<NatsBucket> open_nats_bucket(natsConnection* connection, const NatsOptions& options);
// The same, once: waits for NATS's answers only.
Result<NatsBucket> try_nats_bucket(natsConnection* connection, const NatsOptions& options);

}  // namespace dance
