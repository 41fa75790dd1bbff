#include "tunnel/nats/values/nats_values.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace dance {
namespace {

// The NATS server that reads for us may be another than the one we speak with, and die: missing two
// of these says so, and the watch begins anew. Well before a dead server's guests are forgotten.
constexpr std::int64_t kHeartbeat_ns = 1'000'000'000;
constexpr std::size_t kMostUnwritten = 65'536;
// Longer than an answer takes where there is one.
constexpr auto kEnd = std::chrono::milliseconds(500);
constexpr auto kRetry = std::chrono::milliseconds(100);

}  // namespace

Result<std::unique_ptr<NatsValues>> NatsValues::open(natsConnection* connection, NatsInbox& inbox,
                                                     const NatsOptions& options) {
  DANCE_TRY(NatsBucket bucket, open_nats_bucket(connection, options));
  return std::unique_ptr<NatsValues>(new NatsValues(connection, std::move(bucket), options, inbox));
}

NatsValues::NatsValues(natsConnection* connection, NatsBucket bucket, NatsOptions options,
                       NatsInbox& inbox)
    : connection_(connection),
      bucket_(std::move(bucket)),
      options_(std::move(options)),
      stream_name_("KV_" + options_.bucket),
      subject_prefix_("$KV." + options_.bucket + "."),
      inbox_(inbox),
      thread_([this] { run(); }) {}

NatsValues::~NatsValues() {
  end();
  thread_.join();
}

void NatsValues::end() {
  std::unique_lock lock(mutex_);
  ends_ = true;
  changed_.notify_all();
  changed_.wait_for(lock, kEnd, [this] { return has_ended_; });
}

void NatsValues::put(std::string_view key, std::span<const std::uint8_t> value) {
  write(key, std::vector<std::uint8_t>(value.begin(), value.end()));
}

void NatsValues::erase(std::string_view key) { write(key, std::nullopt); }

// Bounded also while NATS is away for long: what stands is written again when it is back.
void NatsValues::write(std::string_view key, Value value) {
  const std::lock_guard lock(mutex_);
  if (unwritten_.size() >= kMostUnwritten && !unwritten_.contains(std::string(key))) {
    failed_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  unwritten_[std::string(key)] = std::move(value);
  changed_.notify_all();
}

void NatsValues::watch(std::string_view keys) {
  const std::lock_guard lock(mutex_);
  watched_.insert(std::string(keys));
  to_watch_.insert(std::string(keys));
  changed_.notify_all();
}

void NatsValues::end_watch(std::string_view keys) {
  const std::lock_guard lock(mutex_);
  watched_.erase(std::string(keys));
  to_watch_.insert(std::string(keys));
  changed_.notify_all();
}

void NatsValues::renew() {
  const std::lock_guard lock(mutex_);
  renews_ = true;
  changed_.notify_all();
}

std::size_t NatsValues::unwritten() const {
  const std::lock_guard lock(mutex_);
  return unwritten_.size();
}

void NatsValues::flush(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, longest, [this] { return unwritten_.empty() && !is_writing_; });
}

std::string_view NatsValues::key_of(natsMsg* message) const {
  std::string_view subject = natsMsg_GetSubject(message);
  if (!subject.starts_with(subject_prefix_)) return {};
  subject.remove_prefix(subject_prefix_.size());
  return subject;
}

bool NatsValues::is_erased(natsMsg* message) {
  const char* operation = nullptr;
  return natsMsgHeader_Get(message, "KV-Operation", &operation) == NATS_OK &&
         (std::strcmp(operation, "DEL") == 0 || std::strcmp(operation, "PURGE") == 0);
}

bool NatsValues::is_last(natsMsg* message) {
  jsMsgMetaData* about = nullptr;
  if (natsMsg_GetMetaData(&about, message) != NATS_OK) return false;
  const bool is_last = about->NumPending == 0;
  jsMsgMetaData_Destroy(about);
  return is_last;
}

void NatsValues::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock,
                  [this] { return ends_ || renews_ || !to_watch_.empty() || !unwritten_.empty(); });
    if (ends_) {
      has_ended_ = true;
      changed_.notify_all();
      return;
    }
    if (std::exchange(renews_, false)) {
      find_bucket(lock);
      to_watch_.insert(watched_.begin(), watched_.end());
    }
    if (!to_watch_.empty())
      watch_one(lock);
    else if (!unwritten_.empty())
      write_one(lock);
  }
}

// After a break, and where NATS refuses: NATS may have come back without the bucket, or with one
// that another server has made since. Its values are gone then, and their owners write them again.
void NatsValues::find_bucket(std::unique_lock<std::mutex>& lock) {
  if (ends_) return;
  lock.unlock();
  auto found = try_nats_bucket(connection_, options_);
  lock.lock();
  if (!found || found->made_ns == bucket_.made_ns) return;
  bucket_.store = std::move(found->store);
  bucket_.made_ns = found->made_ns;
  emptied_.fetch_add(1, std::memory_order_relaxed);
  to_watch_.insert(watched_.begin(), watched_.end());
  inbox_.push(NatsInbox::Kind::kEmptied, nullptr);
}

void NatsValues::write_one(std::unique_lock<std::mutex>& lock) {
  auto next = unwritten_.upper_bound(last_tried_);
  if (next == unwritten_.end()) next = unwritten_.begin();
  const std::string key = last_tried_ = next->first;
  const Value value = std::move(next->second);
  unwritten_.erase(next);
  is_writing_ = true;
  lock.unlock();
  std::uint64_t revision = 0;
  const natsStatus status = value ? kvStore_Put(&revision, bucket_.store.get(), key.c_str(),
                                                value->data(), static_cast<int>(value->size()))
                                  : kvStore_Delete(bucket_.store.get(), key.c_str());
  lock.lock();
  is_writing_ = false;
  if (status == NATS_OK) {
    if (unwritten_.empty()) changed_.notify_all();
    return;
  }
  failed_.fetch_add(1, std::memory_order_relaxed);
  unwritten_.emplace(key, value);  // unless there is a newer one
  find_bucket(lock);
  changed_.wait_for(lock, kRetry, [this] { return ends_; });
}

void NatsValues::watch_one(std::unique_lock<std::mutex>& lock) {
  const std::string keys = *to_watch_.begin();
  to_watch_.erase(to_watch_.begin());
  const bool is_wanted = watched_.contains(keys);
  lock.unlock();
  end_subscription(keys);
  NatsHandle<natsSubscription> subscription;
  if (is_wanted) subscription = subscribe(keys);
  lock.lock();
  if (subscription) {
    subscriptions_[keys] = std::move(subscription);
  } else if (is_wanted) {
    failed_.fetch_add(1, std::memory_order_relaxed);
    to_watch_.insert(keys);
    find_bucket(lock);
    changed_.wait_for(lock, kRetry, [this] { return ends_; });
  }
}

void NatsValues::end_subscription(const std::string& keys) {
  const auto of = subscriptions_.find(keys);
  if (of != subscriptions_.end()) {
    natsSubscription_Unsubscribe(of->second.get());
    ended_.push_back(std::move(of->second));
    subscriptions_.erase(of);
  }
  if (!ended_.empty() && reader_has_passed(connection_)) ended_.clear();
}

NatsHandle<natsSubscription> NatsValues::subscribe(const std::string& keys) {
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Ordered = true;
  options.Stream = stream_name_.c_str();
  options.Config.DeliverPolicy = js_DeliverLastPerSubject;
  options.Config.Heartbeat = kHeartbeat_ns;
  const auto on_value = [](natsConnection*, natsSubscription*, natsMsg* message, void* inbox) {
    static_cast<NatsInbox*>(inbox)->push(NatsInbox::Kind::kValue, NatsHandle<natsMsg>(message));
  };
  natsSubscription* subscription = nullptr;
  const std::string subject = subject_prefix_ + keys;
  if (js_Subscribe(&subscription, bucket_.stream.get(), subject.c_str(), on_value, &inbox_, nullptr,
                   &options, nullptr) != NATS_OK)
    return nullptr;
  return NatsHandle<natsSubscription>(subscription);
}

}  // namespace dance
