// The NATS client library's objects, owned.
//
// Ownership: each unique_ptr owns its object. The library's (3.4.1) reading thread goes on using a
//            subscription, or a watcher's, that is destroyed meanwhile: what ended is kept until
//            reader_has_passed(), or until its connection was closed by close_nats().
// Threads:   as the library says.
// Failure:   none.
#pragma once

#include <nats/nats.h>

#include <memory>

namespace dance {

// Waits for an answer from the server, 0.3 s at most: the reading thread uses no subscription
// any more that had been unsubscribed before the call. False where none came.
bool reader_has_passed(natsConnection* connection);
// Ends its threads. What waits for an answer in another thread is told that there will be none.
void close_nats(natsConnection* connection);

struct NatsDeleter {
  void operator()(natsOptions* it) const { natsOptions_Destroy(it); }
  void operator()(natsConnection* it) const {
    close_nats(it);
    natsConnection_Destroy(it);
  }
  void operator()(natsSubscription* it) const { natsSubscription_Destroy(it); }
  void operator()(natsMsg* it) const { natsMsg_Destroy(it); }
  void operator()(jsCtx* it) const { jsCtx_Destroy(it); }
  void operator()(kvStore* it) const { kvStore_Destroy(it); }
  void operator()(kvWatcher* it) const { kvWatcher_Destroy(it); }
  void operator()(kvEntry* it) const { kvEntry_Destroy(it); }
};
template <class T>
using NatsHandle = std::unique_ptr<T, NatsDeleter>;

}  // namespace dance
