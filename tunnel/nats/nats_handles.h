// The NATS client library's objects, owned.
//
// Ownership: each unique_ptr owns its object.
// Threads:   as the library says.
// Failure:   none.
#pragma once

#include <nats/nats.h>

#include <memory>

namespace dance {

struct NatsDeleter {
  void operator()(natsOptions* it) const { natsOptions_Destroy(it); }
  void operator()(natsConnection* it) const { natsConnection_Destroy(it); }
  void operator()(natsSubscription* it) const { natsSubscription_Destroy(it); }
  void operator()(natsMsg* it) const { natsMsg_Destroy(it); }
  void operator()(jsCtx* it) const { jsCtx_Destroy(it); }
  void operator()(kvStore* it) const { kvStore_Destroy(it); }
};
template <class T>
using NatsHandle = std::unique_ptr<T, NatsDeleter>;

}  // namespace dance
