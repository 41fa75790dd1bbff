#include "core/bus/bus.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <vector>

#include "core/base/assert.h"
#include "core/base/printable.h"
#include "core/bus/bus_socket.h"
#include "core/bus/datagram.h"

namespace dance {
namespace {

// The names of the channels that a subscription receives: one, or all with a beginning.
struct Names {
  std::string text;
  bool is_beginning;
  bool includes(std::string_view name) const {
    return is_beginning ? name.starts_with(text) : name == text;
  }
};

Names names_of(Signal signal, const From& from) {
  const std::string word = std::string(signal_name(signal)) + "/";
  if (from.where == Where::kLocal) return {word + "local", false};
  if (from.where == Where::kProgram) return {word, true};
  const std::string place = word + std::string(where_name(from.where)) + "/";
  if (from.guest.is_set()) return {place + std::string(from.guest.view()), false};
  return {place, true};
}

Names names_of(const ChannelPattern& pattern) {
  const std::string_view text = pattern.text();
  if (!pattern.is_prefix()) return {std::string(text), false};
  return {std::string(text.substr(0, text.size() - 1)), true};
}

// Passes on every channel, undecoded.
class AllChannels final : public Listener {
 public:
  explicit AllChannels(Bus::RawHandler handler) : handler_(std::move(handler)) {}
  void take(const Arrival& arrival, SignalCounters&) override {
    handler_(arrival.name, arrival.data, arrival.size, arrival.now);
  }

 private:
  Bus::RawHandler handler_;
};

// Passes on the channels of a pattern, undecoded.
class PatternSubscription final : public Listener {
 public:
  PatternSubscription(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
                      Bus::RawHandler handler)
      : pattern_(pattern),
        delivery_(delivery),
        max_bytes_(max_bytes),
        handler_(std::move(handler)) {}

  void take(const Arrival& arrival, SignalCounters& counters) override {
    // The socket filters by beginning only: a message of another house's guest may arrive here too.
    if (!pattern_.matches(arrival.name)) return;
    if (arrival.size > max_bytes_) {
      ++counters.oversized;
      return;
    }
    if (delivery_ == Delivery::kEvery) {
      ++counters.received;
      handler_(arrival.name, arrival.data, arrival.size, arrival.now);
      return;
    }
    auto* slot = newest_.find(arrival.name);
    Name name;
    if (!slot && name.assign(arrival.name))
      slot = &newest_.add(
          name, [this] { return Bytes(max_bytes_); },
          [&](const Name& other, const Bytes& message) {
            handler_(other.view(), message.bytes.data(), message.size, arrival.now);
          });
    DANCE_ASSERT(slot != nullptr, arrival.name.size());
    ++counters.received;
    if (slot->is_fresh) ++counters.superseded;
    slot->message.size = arrival.size;
    if (arrival.size > 0) std::memcpy(slot->message.bytes.data(), arrival.data, arrival.size);
    slot->is_fresh = true;
  }

  void deliver(MonoTime now) override {
    newest_.deliver([&](const Name& name, const Bytes& message) {
      handler_(name.view(), message.bytes.data(), message.size, now);
    });
  }

 private:
  using Name = FixedString<kMaxChannelLength>;
  struct Bytes {
    explicit Bytes(std::size_t max_bytes) : bytes(max_bytes) {}
    std::vector<std::uint8_t> bytes;
    std::size_t size = 0;
  };

  ChannelPattern pattern_;
  Delivery delivery_;
  std::size_t max_bytes_;
  Bus::RawHandler handler_;
  NewestSlots<Name, Bytes> newest_;
};

// A program may have several buses; a change is printed once.
void print_network_change(const std::string& url, const std::string& change) {
  static std::mutex mutex;
  static std::string last;
  const std::lock_guard lock(mutex);
  const std::string line = "bus " + printable(url) + ": " + change;
  if (line == last) return;
  last = line;
  std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace

struct Bus::Impl {
  struct Listening {
    Names names;
    std::shared_ptr<Listener> listener;
  };

  BusSocket socket;
  std::string url;
  Counters counters;
  std::vector<Listening> listeners;
  RefusedHandler on_refused;
  int turns_until_check = 0;

  void listen(Names names, std::shared_ptr<Listener> listener) {
    // First, so that a message which arrives at once finds its listener.
    listeners.push_back({names, std::move(listener)});
    socket.want(names.text);
  }
  void take(std::span<const std::uint8_t> bytes, MonoTime now) {
    const BusDatagram datagram = parse_datagram(bytes);
    switch (datagram.kind) {
      case BusDatagram::Kind::kMalformed:
        ++counters.malformed;
        return;
      case BusDatagram::Kind::kFragment:
        ++counters.fragments;
        if (on_refused && !datagram.name.empty()) on_refused(datagram.name);
        return;
      case BusDatagram::Kind::kMessage:
        break;
    }
    const Arrival arrival{datagram.name, datagram.data.data(), datagram.data.size(), now};
    // The loop uses an index, because a handler may subscribe.
    for (std::size_t i = 0; i < listeners.size(); ++i)
      if (listeners[i].names.includes(arrival.name)) listeners[i].listener->take(arrival, counters);
  }
  // In a turn without messages the descriptor was readable because of a network report. While
  // every turn has messages, reports are read every 1024 turns.
  void follow_network(bool is_quiet) {
    constexpr int kTurnsBetweenChecks = 1024;
    if (!is_quiet && --turns_until_check > 0) return;
    turns_until_check = kTurnsBetweenChecks;
    const std::string change = socket.follow_network();
    if (!change.empty()) print_network_change(url, change);
  }
  void publish_bytes(std::string_view channel, const void* data, std::size_t size) {
    if (!socket.send(channel, data, size)) ++counters.publish_failed;
  }
};

std::string bus_url_or_default(const std::string& given) {
  if (!given.empty()) return given;
  for (const char* name : {"DANCE_BUS_URL", "LCM_DEFAULT_URL"}) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): read at start
    if (value && *value) return value;
  }
  return kDefaultBusUrl;
}

Result<std::unique_ptr<Bus>> Bus::open(const std::string& given_url) {
  const std::string url = bus_url_or_default(given_url);
  DANCE_TRY(const BusAddress address, parse_udpm_url(url));
  auto socket = BusSocket::open(address);
  if (!socket) return fail("bus " + printable(url) + ": " + socket.error().what);
  static std::once_flag once;
  if (address.ttl > 0)
    std::call_once(once, [&] {
      std::fprintf(stderr,
                   "bus %s: ttl=%d opens it to the network: any host there can see the dancers and "
                   "publish as them\n",
                   printable(url).c_str(), address.ttl);
    });
  return std::unique_ptr<Bus>(
      new Bus(std::make_unique<Impl>(Impl{std::move(*socket), url, {}, {}, {}, 0})));
}

Bus::Bus(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Bus::~Bus() = default;

void Bus::send(const Channel& channel, const AnyMessage& message) {
  MessageBuffer buffer;
  const std::size_t size = message.encode(buffer);
  impl_->publish_bytes(channel.view(), buffer.data(), size);
}

void Bus::publish_raw(const char* channel, const void* data, std::size_t size) {
  impl_->publish_bytes(channel, data, size);
}

void Bus::add(std::shared_ptr<Subscription> subscription) {
  Names names = names_of(subscription->signal(), subscription->from());
  impl_->listen(std::move(names), std::move(subscription));
}

void Bus::on_anything(RawHandler handler) {
  impl_->listen({"", true}, std::make_shared<AllChannels>(std::move(handler)));
}

void Bus::on_refused(RefusedHandler handler) { impl_->on_refused = std::move(handler); }

void Bus::on_raw(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
                 RawHandler handler) {
  impl_->listen(names_of(pattern), std::make_shared<PatternSubscription>(
                                       pattern, delivery, max_bytes, std::move(handler)));
}

int Bus::fd() const { return impl_->socket.fd(); }

void Bus::drain(MonoTime now) {
  std::size_t handled = 0;
  while (handled < kMessagesPerTurn) {
    const auto batch = impl_->socket.receive();
    for (const auto bytes : batch) impl_->take(bytes, now);
    handled += batch.size();
    if (batch.size() < BusSocket::kBatch) break;
  }
  for (std::size_t i = 0; i < impl_->listeners.size(); ++i)
    impl_->listeners[i].listener->deliver(now);
  impl_->follow_network(handled == 0);
}

const Bus::Counters& Bus::counters() const { return impl_->counters; }
const std::string& Bus::url() const { return impl_->url; }

}  // namespace dance
