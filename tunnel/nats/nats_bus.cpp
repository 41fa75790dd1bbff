#include "tunnel/nats/nats_bus.h"

#include <atomic>
#include <mutex>

#include "core/base/printable.h"
#include "tunnel/nats/nats_sender.h"
#include "tunnel/nats/nats_values.h"

namespace dance {
namespace {

constexpr std::int64_t kConnect_ms = 2000;
constexpr std::int64_t kPing_ms = 500;
constexpr int kUnansweredPings = 2;
constexpr std::int64_t kReconnect_ms = 100;
constexpr auto kFlush = std::chrono::milliseconds(500);

Error not_connected(natsStatus status, const NatsOptions& options) {
  const std::string at = shown_urls(options);
  const char* said = nats_GetLastError(nullptr);
  const std::string detail = said != nullptr ? printable(said) : natsStatus_GetText(status);
  if (status == NATS_CONNECTION_AUTH_FAILED || status == NATS_NOT_PERMITTED)
    return Error{"the NATS server at " + at + " does not let us in: " +
                 (options.credentials.empty() ? "give --cluster-credentials FILE"
                                              : printable(options.credentials) +
                                                    " is no credentials file of a user of it")};
  if (status == NATS_NO_SERVER)
    return Error{"no NATS server answers at " + at + ": is nats-server running there?"};
  return Error{"NATS at " + at + ": " + detail};
}

// The step of the options that failed first.
class Setting {
 public:
  void operator()(natsStatus status, std::string what) {
    if (failed_ || status == NATS_OK) return;
    const char* said = nats_GetLastError(nullptr);
    failed_ = Error{std::move(what) + ": " +
                    (said != nullptr ? printable(said) : natsStatus_GetText(status))};
  }
  const std::optional<Error>& failed() const { return failed_; }

 private:
  std::optional<Error> failed_;
};

// What the library's threads see of a bus. They may still be in a callback when it ends, and nobody
// can wait for that: so it stays for the process's life.
struct Shared {
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
  static Shared& make() {
    static auto& all = *new std::vector<std::unique_ptr<Shared>>;
    return *all.emplace_back(std::make_unique<Shared>());
  }
};

class ConnectedNatsBus final : public NatsBus {
 public:
  explicit ConnectedNatsBus(Poller& poller) : poller_(poller), shared_(Shared::make()) {}
  ~ConnectedNatsBus() override {
    if (sender_) poller_.unwatch(shared_.inbox.fd());
    shared_.set_values(nullptr);
    // What waits for an answer is told that there will be none.
    if (connection_) natsConnection_Close(connection_.get());
  }

  Result<void> open(const NatsOptions& options) {
    natsOptions* made = nullptr;
    if (natsOptions_Create(&made) != NATS_OK) return fail("NATS: no memory");
    const NatsHandle<natsOptions> of(made);
    if (const auto failed = set(made, options)) return tl::make_unexpected(*failed);
    natsConnection* connection = nullptr;
    const natsStatus status = natsConnection_Connect(&connection, made);
    if (status != NATS_OK) return tl::make_unexpected(not_connected(status, options));
    connection_.reset(connection);
    DANCE_TRY(values_, NatsValues::open(connection, shared_.inbox, options));
    sender_ = std::make_unique<NatsSender>(connection, shared_.inbox);
    shared_.set_values(values_.get());
    poller_.watch(shared_.inbox.fd(), [this](MonoTime now) { on_readable(now); });
    return {};
  }

  void set_handlers(Handlers handlers) override { handlers_ = std::move(handlers); }
  void set_after_batch(std::function<void(MonoTime)> work) override { after_ = std::move(work); }
  void publish(std::string_view subject, Bytes message) override {
    sender_->publish(subject, message);
  }
  void listen(std::string_view subject) override { sender_->listen(subject); }
  void end_listen(std::string_view subject) override { sender_->end_listen(subject); }
  void put(std::string_view key, Bytes value) override { values_->put(key, value); }
  void erase(std::string_view key) override { values_->erase(key); }
  void watch(std::string_view keys) override { values_->watch(keys); }
  void end_watch(std::string_view keys) override { values_->end_watch(keys); }
  void flush() override { values_->flush(kFlush); }

  Counters counters() const override {
    Counters counters;
    counters.dropped_in = shared_.inbox.dropped();
    counters.dropped_out = sender_->dropped();
    counters.failed_values = values_->failed();
    counters.unwritten_values = values_->unwritten();
    counters.reconnects = shared_.reconnects.load(std::memory_order_relaxed);
    counters.is_connected = natsConnection_Status(connection_.get()) == NATS_CONN_STATUS_CONNECTED;
    return counters;
  }

 private:
  std::optional<Error> set(natsOptions* made, const NatsOptions& options) {
    Setting check;
    std::vector<const char*> urls;
    for (const std::string& url : options.urls) urls.push_back(url.c_str());
    check(natsOptions_SetServers(made, urls.data(), static_cast<int>(urls.size())),
          "--cluster " + shown_urls(options));
    check(natsOptions_SetName(made, options.name.c_str()), "NATS client's name");
    // Its own messages would come back, and what is old would be sent after a break.
    check(natsOptions_SetNoEcho(made, true), "NATS");
    check(natsOptions_SetSendAsap(made, true), "NATS");
    check(natsOptions_SetTimeout(made, kConnect_ms), "NATS");
    check(natsOptions_SetPingInterval(made, kPing_ms), "NATS");
    check(natsOptions_SetMaxPingsOut(made, kUnansweredPings), "NATS");
    check(natsOptions_SetMaxReconnect(made, -1), "NATS");
    check(natsOptions_SetReconnectWait(made, kReconnect_ms), "NATS");
    check(natsOptions_SetReconnectJitter(made, kReconnect_ms, kReconnect_ms), "NATS");
    check(natsOptions_UseGlobalMessageDelivery(made, true), "NATS");
    if (!options.credentials.empty())
      check(natsOptions_SetUserCredentialsFromFiles(made, options.credentials.c_str(), nullptr),
            "--cluster-credentials " + printable(options.credentials));
    if (!options.authorities.empty())
      check(natsOptions_LoadCATrustedCertificates(made, options.authorities.c_str()),
            "--cluster-authorities " + printable(options.authorities));
    if (!options.certificate.empty())
      check(natsOptions_LoadCertificatesChain(made, options.certificate.c_str(),
                                              options.private_key.c_str()),
            "--cluster-certificate " + printable(options.certificate));
    check(natsOptions_SetReconnectedCB(made, &ConnectedNatsBus::on_reconnected, &shared_), "NATS");
    check(natsOptions_SetErrorHandler(made, &ConnectedNatsBus::on_error, &shared_), "NATS");
    return check.failed();
  }

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
      if (item.kind == NatsInbox::Kind::kBack) {
        handlers_.on_back(now);
        continue;
      }
      const Bytes bytes(reinterpret_cast<const std::uint8_t*>(natsMsg_GetData(message)),
                        static_cast<std::size_t>(natsMsg_GetDataLength(message)));
      if (item.kind == NatsInbox::Kind::kMessage)
        handlers_.on_message(natsMsg_GetSubject(message), bytes, now);
      else if (NatsValues::is_erased(message))
        handlers_.on_value(NatsValues::key_of(message), std::nullopt, now);
      else
        handlers_.on_value(NatsValues::key_of(message), bytes, now);
    }
    if (after_) after_(now);
  }

  Poller& poller_;
  Shared& shared_;
  Handlers handlers_;
  std::function<void(MonoTime)> after_;
  NatsHandle<natsConnection> connection_;
  std::unique_ptr<NatsValues> values_;
  std::unique_ptr<NatsSender> sender_;
};

}  // namespace

bool NatsBus::is_built() { return true; }

Result<std::unique_ptr<NatsBus>> NatsBus::connect(const NatsOptions& options, Poller& poller) {
  auto bus = std::make_unique<ConnectedNatsBus>(poller);
  if (auto opened = bus->open(options); !opened) return tl::make_unexpected(opened.error());
  return bus;
}

}  // namespace dance
