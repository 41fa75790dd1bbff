#include "core/bus/bus.h"

#include <lcm/lcm.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <vector>

#include "core/bus/channel_filter.h"
#include "core/bus/multicast_route.h"

namespace dance {
namespace {

// LCM's own queue per subscription: more than a turn can ever leave pending (64 guests, 10 s at 60
// Hz would not fit, but a process that sleeps for 10 s has lost them anyway). Its default of 30
// loses poses at the first stall of 30 guests.
constexpr int kLcmQueueCapacity = 4096;
// Messages handled in one turn before the other descriptors get theirs.
constexpr int kMessagesPerTurn = 8192;

std::int64_t max_receive_buffer_bytes() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::int64_t bytes = 212'992;  // stock Debian
  file >> bytes;
  return std::min<std::int64_t>(bytes, 4 << 20);
}

// Of the names of channels, as LCM takes it.
std::string regex_of(Signal signal, const From& from) {
  constexpr const char* kAnyName = "[a-z0-9-]+";
  const std::string name = std::string(signal_name(signal)) + "/";
  if (from.where == Where::kLocal) return name + "local";
  if (from.where == Where::kProgram) return name + kAnyName;
  return name + std::string(where_name(from.where)) + "/" +
         (from.guest.is_set() ? std::string(from.guest.view()) : kAnyName);
}

// Two that begin at once would be taken for each other.
std::mutex one_bus_at_a_time;

// Every channel, undecoded.
class AllChannels final : public Listener {
 public:
  explicit AllChannels(Bus::RawHandler handler) : handler_(std::move(handler)) {}
  void take(const Arrival& arrival, SignalCounters&) override {
    handler_(arrival.name, arrival.data, arrival.size, arrival.now);
  }

 private:
  Bus::RawHandler handler_;
};

// Channels of a pattern, undecoded: the regex may take in more than the pattern.
class PatternSubscription final : public Listener {
 public:
  PatternSubscription(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
                      Bus::RawHandler handler)
      : pattern_(pattern),
        delivery_(delivery),
        max_bytes_(max_bytes),
        handler_(std::move(handler)) {}

  void take(const Arrival& arrival, SignalCounters& counters) override {
    // Another subscriber's, or what came from another house.
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
    if (!slot && name.assign(arrival.name)) slot = newest_.add(name, Bytes(max_bytes_));
    if (!slot) {
      ++counters.unknown;
      return;
    }
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

}  // namespace

struct Bus::Impl {
  // What LCM calls back.
  struct Listening {
    Impl& bus;
    std::shared_ptr<Listener> listener;
  };

  lcm_t* lcm = nullptr;
  int port = 0;
  bool is_hearing = false;
  int socket = -1;  // LCM's, by which it hears; -1: not yet, or not found
  ChannelFilter filter;
  std::string url;
  Counters counters;
  std::vector<std::unique_ptr<Listening>> listeners;
  MonoTime now;  // of the turn that is being drained

  ~Impl() {
    if (lcm) lcm_destroy(lcm);
  }
  // LCM makes the socket that it hears by when something first needs it, and does not tell it.
  template <class Need>
  auto with_socket(Need need) {
    if (is_hearing) return need();
    const std::scoped_lock lock(one_bus_at_a_time);
    const std::vector<int> before = udp_sockets_on(port);
    const auto got = need();
    for (const int fd : udp_sockets_on(port))
      if (std::find(before.begin(), before.end(), fd) == before.end()) socket = fd;
    is_hearing = true;
    if (socket >= 0) filter.attach(socket);
    return got;
  }
  static void on_message(const lcm_recv_buf_t* bytes, const char* name, void* listening) {
    const auto& [bus, listener] = *static_cast<Listening*>(listening);
    listener->take({name, bytes->data, bytes->data_size, bus.now}, bus.counters);
  }
  void listen(const std::string& regex, std::shared_ptr<Listener> listener) {
    filter.want(regex);
    listeners.push_back(std::make_unique<Listening>(Listening{*this, std::move(listener)}));
    lcm_subscription_t* handle = with_socket(
        [&] { return lcm_subscribe(lcm, regex.c_str(), on_message, listeners.back().get()); });
    if (handle) lcm_subscription_set_queue_capacity(handle, kLcmQueueCapacity);
    if (socket >= 0) filter.attach(socket);
  }
  int fd() {
    return with_socket([&] { return lcm_get_fileno(lcm); });
  }
  void publish_bytes(const char* channel, const void* data, std::size_t size) {
    if (lcm_publish(lcm, channel, data, static_cast<unsigned>(size)) != 0)
      ++counters.publish_failed;
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
  std::string url = bus_url_or_default(given_url);
  DANCE_TRY(const BusAddress address, parse_udpm_url(url));
  if (multicast_device(address.group).empty())
    return fail("bus " + url + ": this machine has no route for multicast; add one with: " +
                std::string(kMulticastCure));
  auto impl = std::make_unique<Impl>();
  impl->url = url;
  impl->port = address.port;
  if (url.find("recv_buf_size=") == std::string::npos)
    url += (url.find('?') == std::string::npos ? "?" : "&") + std::string("recv_buf_size=") +
           std::to_string(max_receive_buffer_bytes());
  impl->lcm = lcm_create(url.c_str());
  if (!impl->lcm)
    return fail("bus " + impl->url + ": LCM could not open it; `dance doctor` says why");
  return std::unique_ptr<Bus>(new Bus(std::move(impl)));
}

Bus::Bus(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Bus::~Bus() = default;

void Bus::send(const Channel& channel, const AnyMessage& message) {
  MessageBuffer buffer;
  const std::size_t size = message.encode(buffer);
  impl_->publish_bytes(channel.c_str(), buffer.data(), size);
}

void Bus::publish_raw(const char* channel, const void* data, std::size_t size) {
  impl_->publish_bytes(channel, data, size);
}

void Bus::add(std::shared_ptr<Subscription> subscription) {
  const std::string regex = regex_of(subscription->signal(), subscription->from());
  impl_->listen(regex, std::move(subscription));
}

void Bus::on_anything(RawHandler handler) {
  impl_->listen(".*", std::make_shared<AllChannels>(std::move(handler)));
}

void Bus::on_raw(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
                 RawHandler handler) {
  impl_->listen(pattern.regex(), std::make_shared<PatternSubscription>(pattern, delivery, max_bytes,
                                                                       std::move(handler)));
}

int Bus::fd() const { return impl_->fd(); }

void Bus::drain(MonoTime now) {
  impl_->now = now;
  for (int i = 0; i < kMessagesPerTurn; ++i)
    if (lcm_handle_timeout(impl_->lcm, 0) <= 0) break;
  for (const auto& listening : impl_->listeners) listening->listener->deliver(now);
}

const Bus::Counters& Bus::counters() const { return impl_->counters; }
const std::string& Bus::url() const { return impl_->url; }

}  // namespace dance
