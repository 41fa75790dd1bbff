// Values by key, which last: a JetStream key-value bucket. Writing and reading wait for NATS in a
// thread of its own; of a key that is written again meanwhile only the newest value goes out.
//
// Units/frames: none.
// Ownership:    copies what is written; connection and inbox must outlive it, and the connection be
//               closed before it goes.
// Threads:      all calls from one thread, renew() from any.
// Failure:      open() says what is missing. What cannot be written is written again until it is. A
//               bucket that NATS has lost is made again, and the inbox gets kEmptied.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/result.h"
#include "tunnel/nats/nats_connection.h"
#include "tunnel/nats/values/nats_inbox.h"

namespace dance {

class NatsValues {
 public:
  // Makes the bucket where there is none.
  static Result<std::unique_ptr<NatsValues>> open(natsConnection* connection, NatsInbox& inbox,
                                                  const NatsOptions& options);
  ~NatsValues();
  NatsValues(const NatsValues&) = delete;
  NatsValues& operator=(const NatsValues&) = delete;

  void put(std::string_view key, std::span<const std::uint8_t> value);
  void erase(std::string_view key);
  // All that match come into the inbox, now and on each change.
  void watch(std::string_view keys);
  void end_watch(std::string_view keys);
  // The connection is another, or values were missed: all that is watched comes anew.
  void renew();
  // The key in a message of the inbox, and whether it was erased.
  std::string_view key_of(natsMsg* message) const;
  static bool is_erased(natsMsg* message);
  // None of its watch waits behind it.
  static bool is_last(natsMsg* message);

  // Nothing is asked of NATS any more, and what was asked is answered, where NATS answers: so that
  // the connection can be closed, which comes before this is destroyed.
  void end();
  // Waits until all is written, or so long: at the end of a program.
  void flush(std::chrono::milliseconds longest);
  std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }
  std::size_t unwritten() const;
  // Number of times that the bucket was found to be a new one: NATS came back with an empty disk.
  std::uint64_t emptied() const { return emptied_.load(std::memory_order_relaxed); }

 private:
  using Value = std::optional<std::vector<std::uint8_t>>;  // none: erase

  NatsValues(natsConnection* connection, NatsBucket bucket, NatsOptions options, NatsInbox& inbox);
  void write(std::string_view key, Value value);
  void run();
  void write_one(std::unique_lock<std::mutex>& lock);
  void watch_one(std::unique_lock<std::mutex>& lock);
  void find_bucket(std::unique_lock<std::mutex>& lock);
  NatsHandle<natsSubscription> subscribe(const std::string& keys);
  void end_subscription(const std::string& keys);

  natsConnection* connection_;
  NatsBucket bucket_;  // the thread's, from open() on
  NatsOptions options_;
  std::string stream_name_;
  std::string subject_prefix_;
  NatsInbox& inbox_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Value> unwritten_;
  std::string last_tried_;  // keys take turns, so that one that fails holds up no other
  std::set<std::string> watched_;
  std::set<std::string> to_watch_;
  bool is_writing_ = false;
  bool renews_ = false;
  bool ends_ = false;
  bool has_ended_ = false;
  std::atomic<std::uint64_t> failed_{0};
  std::atomic<std::uint64_t> emptied_{0};
  std::map<std::string, NatsHandle<natsSubscription>> subscriptions_;  // the thread's
  std::vector<NatsHandle<natsSubscription>> ended_;  // that the reading thread may still use
  std::thread thread_;
};

}  // namespace dance
