#include "tunnel/nats/nats_bus.h"

#include <atomic>
#include <mutex>

#include "tunnel/nats/messages/nats_messages.h"
#include "tunnel/nats/nats_connection.h"
#include "tunnel/nats/values/nats_values.h"

namespace dance {
namespace {

constexpr Duration kFlush = Duration::ms(500);

// What the library's threads see of a bus. They may still be in a callback when it ends, and nobody
// can wait for that: so it stays for the process's life.
struct Shared {
  explicit Shared(WakeEvent wake) : inbox(std::move(wake)) {}

  NatsInbox inbox;
  std::mutex mutex;
  NatsValues* values = nullptr;
  std::atomic<std::uint64_t> reconnects{0};

  void renew_values() {
    const std::lock_guard lock(mutex);
    if (values != nullptr) values->renew();
  }
  void set_values(NatsValues* now) {
    const std::lock_guard lock(mutex);
    values = now;
  }
  static Shared& make(WakeEvent wake) {
    static auto& all = *new std::vector<std::unique_ptr<Shared>>;
    return *all.emplace_back(std::make_unique<Shared>(std::move(wake)));
  }
};

class ConnectedNatsBus final : public NatsBus {
 public:
  ConnectedNatsBus(Poller& poller, WakeEvent wake)
      : poller_(poller), shared_(Shared::make(std::move(wake))) {}
  ~ConnectedNatsBus() override {
    if (values_) poller_.unwatch(shared_.inbox.fd());
    shared_.set_values(nullptr);
    if (values_) values_->end();
    if (connection_) close_nats(connection_.get());
  }

  Result<void> open(const NatsOptions& options) {
    DANCE_TRY(connection_, connect_nats(options, {&ConnectedNatsBus::on_reconnected,
                                                  &ConnectedNatsBus::on_error, &shared_}));
    natsConnection* connection = connection_.get();
    DANCE_TRY(values_, NatsValues::open(connection, shared_.inbox, options));
    shared_.set_values(values_.get());
    poller_.watch(shared_.inbox.fd(), [this](MonoTime now) { on_readable(now); });
    if (options.only_values) return {};
    NatsMessages::Handlers on;
    on.on_message = [this](std::string_view subject, Bytes message, MonoTime now) {
      handlers_.on_message(subject, message, now);
    };
    on.after_batch = [this](MonoTime now) {
      if (after_) after_(now);
    };
    on.on_back = [this](MonoTime now) {
      shared_.reconnects.fetch_add(1, std::memory_order_relaxed);
      handlers_.on_back(now);
    };
    DANCE_TRY(messages_, NatsMessages::connect(options, poller_, std::move(on)));
    return {};
  }

  void set_handlers(Handlers handlers) override { handlers_ = std::move(handlers); }
  void set_after_batch(std::function<void(MonoTime)> work) override { after_ = std::move(work); }
  void publish(std::string_view subject, Bytes message) override {
    messages_->publish(subject, message);
  }
  void listen(std::string_view subject) override { messages_->listen(subject); }
  void end_listen(std::string_view subject) override { messages_->end_listen(subject); }
  void end_turn(MonoTime now) override {
    if (messages_) messages_->end_turn(now);
  }
  bool is_clear() const override { return messages_ && messages_->is_clear(); }
  void put(std::string_view key, Bytes value) override { values_->put(key, value); }
  void erase(std::string_view key) override { values_->erase(key); }
  void watch(std::string_view keys) override { values_->watch(keys); }
  void end_watch(std::string_view keys) override { values_->end_watch(keys); }
  void flush() override {
    if (messages_) messages_->flush(kFlush);
    values_->flush(std::chrono::milliseconds(kFlush.count_ms()));
  }

  Counters counters() const override {
    Counters counters;
    counters.dropped_in = shared_.inbox.dropped();
    if (messages_) {
      counters.dropped_in += messages_->counters().dropped_in;
      counters.dropped_out = messages_->counters().dropped_out + messages_->counters().refused;
    }
    counters.failed_values = values_->failed();
    counters.emptied = values_->emptied();
    counters.unwritten_values = values_->unwritten();
    counters.reconnects = shared_.reconnects.load(std::memory_order_relaxed);
    counters.is_connected =
        natsConnection_Status(connection_.get()) == NATS_CONN_STATUS_CONNECTED &&
        (!messages_ || messages_->is_connected());
    return counters;
  }

 private:
  // In the library's threads.
  static void on_reconnected(natsConnection*, void* closure) {
    auto& shared = *static_cast<Shared*>(closure);
    shared.reconnects.fetch_add(1, std::memory_order_relaxed);
    shared.renew_values();
    shared.inbox.push(NatsInbox::Kind::kBack, nullptr);
  }
  // Of what is watched something may have been missed; a slow consumer has lost messages, no more.
  static void on_error(natsConnection*, natsSubscription*, natsStatus status, void* closure) {
    if (status != NATS_SLOW_CONSUMER) static_cast<Shared*>(closure)->renew_values();
  }

  void on_readable(MonoTime now) {
    for (const NatsInbox::Item& item : shared_.inbox.take()) {
      natsMsg* message = item.message.get();
      if (item.kind != NatsInbox::Kind::kValue) {
        (item.kind == NatsInbox::Kind::kBack ? handlers_.on_back : handlers_.on_emptied)(now);
        continue;
      }
      const Bytes bytes(reinterpret_cast<const std::uint8_t*>(natsMsg_GetData(message)),
                        static_cast<std::size_t>(natsMsg_GetDataLength(message)));
      if (NatsValues::is_erased(message))
        handlers_.on_value(values_->key_of(message), std::nullopt, now);
      else
        handlers_.on_value(values_->key_of(message), bytes, now);
      if (NatsValues::is_last(message)) handlers_.on_all_read(values_->key_of(message), now);
    }
    if (shared_.inbox.take_missed_value()) values_->renew();
    if (after_) after_(now);
  }

  Poller& poller_;
  Shared& shared_;
  Handlers handlers_;
  std::function<void(MonoTime)> after_;
  NatsHandle<natsConnection> connection_;
  std::unique_ptr<NatsValues> values_;
  std::unique_ptr<NatsMessages> messages_;
};

}  // namespace

bool NatsBus::is_built() { return true; }

Result<std::unique_ptr<NatsBus>> NatsBus::connect(const NatsOptions& options, Poller& poller) {
  DANCE_TRY(WakeEvent wake, WakeEvent::create());
  auto bus = std::make_unique<ConnectedNatsBus>(poller, std::move(wake));
  if (auto opened = bus->open(options); !opened) return tl::make_unexpected(opened.error());
  return bus;
}

}  // namespace dance
