#include "core/bus/bus.h"

#include <lcm/lcm.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <vector>

#include "core/bus/channel_filter.h"
#include "core/bus/encode.h"
#include "core/bus/multicast_route.h"

namespace dance {
namespace {

// LCM's own queue per subscription: more than a turn can ever leave pending (64 guests, 10 s at 60
// Hz would not fit, but a process that sleeps for 10 s has lost them anyway). Its default of 30
// loses poses at the first stall of 30 guests.
constexpr int kLcmQueueCapacity = 4096;
// Messages handled in one turn before the other descriptors get theirs.
constexpr int kMessagesPerTurn = 8192;
// Channels a kNewest subscription keeps a slot for; more are counted as unknown.
constexpr std::size_t kMaxSlots = 256;

std::int64_t max_receive_buffer_bytes() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::int64_t bytes = 212'992;  // stock Debian
  file >> bytes;
  return std::min<std::int64_t>(bytes, 4 << 20);
}

std::string channel_pattern(Signal signal, Where where, const GuestId& guest) {
  return std::string(signal_name(signal)) + "/" + std::string(where_name(where)) + "/" +
         (guest.is_set() ? std::string(guest.view()) : "[a-z0-9-]+");
}

// Two that begin at once would be taken for each other.
std::mutex one_bus_at_a_time;

class Subscription {
 public:
  virtual ~Subscription() = default;
  virtual void take(const lcm_recv_buf_t* bytes, const char* name) = 0;
  virtual void deliver(MonoTime now) = 0;
  MonoTime now;
};

void on_lcm_message(const lcm_recv_buf_t* bytes, const char* name, void* subscription) {
  static_cast<Subscription*>(subscription)->take(bytes, name);
}

// A subscription to one signal whose messages become a T. kWire is the type that decode() fills; it
// is handed on as is.
template <class T>
class TypedSubscription : public Subscription {
 public:
  TypedSubscription(Delivery delivery, Bus::Handler<T> handler, Bus::Counters& counters)
      : delivery_(delivery), handler_(std::move(handler)), counters_(counters) {}

  void take(const lcm_recv_buf_t* bytes, const char* name) override {
    const auto channel = Channel::parse(name);
    if (!channel) {
      ++counters_.unknown;
      return;
    }
    if (delivery_ == Delivery::kEvery) {
      if (is_decoded(bytes, scratch_)) handler_(*channel, scratch_, now);
      return;
    }
    Slot* slot = slot_of(*channel);
    if (!slot) {
      ++counters_.unknown;
      return;
    }
    if (!is_decoded(bytes, scratch_)) return;
    if (slot->fresh) ++counters_.superseded;
    slot->message = scratch_;
    slot->fresh = true;
  }

  void deliver(MonoTime turn) override {
    for (Slot& slot : slots_)
      if (slot.fresh) {
        slot.fresh = false;
        handler_(slot.channel, slot.message, turn);
      }
  }

 private:
  struct Slot {
    Channel channel;
    T message;
    bool fresh = false;
  };

  Slot* slot_of(const Channel& channel) {
    for (Slot& slot : slots_)
      if (slot.channel == channel) return &slot;
    if (slots_.size() == kMaxSlots) return nullptr;
    slots_.push_back({channel, T(), false});
    return &slots_.back();
  }

  bool is_decoded(const lcm_recv_buf_t* bytes, T& message) {
    switch (decode(bytes->data, bytes->data_size, message)) {
      case Decoded::kFine:
        ++counters_.received;
        return true;
      case Decoded::kUndecodable:
        ++counters_.undecodable;
        return false;
      case Decoded::kInvalid:
        ++counters_.invalid;
        return false;
    }
    return false;
  }

  Delivery delivery_;
  Bus::Handler<T> handler_;
  Bus::Counters& counters_;
  std::vector<Slot> slots_;
  T scratch_;
};

class RawSubscription : public Subscription {
 public:
  explicit RawSubscription(Bus::RawHandler handler) : handler_(std::move(handler)) {}
  void take(const lcm_recv_buf_t* bytes, const char* name) override {
    handler_(name, bytes->data, bytes->data_size, now);
  }
  void deliver(MonoTime) override {}

 private:
  Bus::RawHandler handler_;
};

// Channels of a pattern, undecoded: the regex may take in more than the pattern.
class PatternSubscription : public Subscription {
 public:
  PatternSubscription(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
                      Bus::RawHandler handler, Bus::Counters& counters)
      : pattern_(pattern),
        delivery_(delivery),
        max_bytes_(max_bytes),
        handler_(std::move(handler)),
        counters_(counters) {}

  void take(const lcm_recv_buf_t* bytes, const char* name) override {
    if (!pattern_.matches(name)) return;  // another subscriber's, or what came from another house
    if (bytes->data_size > max_bytes_) {
      ++counters_.oversized;
      return;
    }
    if (delivery_ == Delivery::kEvery) {
      ++counters_.received;
      handler_(name, bytes->data, bytes->data_size, now);
      return;
    }
    Slot* slot = slot_of(name);
    if (!slot) {
      ++counters_.unknown;
      return;
    }
    ++counters_.received;
    if (slot->fresh) ++counters_.superseded;
    slot->size = bytes->data_size;
    if (slot->size > 0) std::memcpy(slot->bytes.data(), bytes->data, slot->size);
    slot->fresh = true;
  }

  void deliver(MonoTime turn) override {
    for (Slot& slot : slots_)
      if (slot.fresh) {
        slot.fresh = false;
        handler_(slot.name.view(), slot.bytes.data(), slot.size, turn);
      }
  }

 private:
  struct Slot {
    FixedString<kMaxChannelLength> name;
    std::vector<std::uint8_t> bytes;  // max_bytes_ of them
    std::size_t size = 0;
    bool fresh = false;
  };

  Slot* slot_of(std::string_view name) {
    for (Slot& slot : slots_)
      if (slot.name == name) return &slot;
    Slot slot;
    if (slots_.size() == kMaxSlots || !slot.name.assign(name)) return nullptr;
    slot.bytes.resize(max_bytes_);
    slots_.push_back(std::move(slot));
    return &slots_.back();
  }

  ChannelPattern pattern_;
  Delivery delivery_;
  std::size_t max_bytes_;
  Bus::RawHandler handler_;
  Bus::Counters& counters_;
  std::vector<Slot> slots_;
};

}  // namespace

struct Bus::Impl {
  lcm_t* lcm = nullptr;
  int port = 0;
  bool is_hearing = false;
  int socket = -1;  // LCM's, by which it hears; -1: not yet, or not found
  ChannelFilter filter;
  std::string url;
  Counters counters;
  std::vector<std::unique_ptr<Subscription>> subscriptions;

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
  void subscribe(const std::string& pattern, std::unique_ptr<Subscription> subscription) {
    filter.want(pattern);
    const auto add = [&] {
      return lcm_subscribe(lcm, pattern.c_str(), on_lcm_message, subscription.get());
    };
    lcm_subscription_t* handle = with_socket(add);
    if (handle) lcm_subscription_set_queue_capacity(handle, kLcmQueueCapacity);
    subscriptions.push_back(std::move(subscription));
    if (socket >= 0) filter.attach(socket);
  }
  int fd() {
    return with_socket([&] { return lcm_get_fileno(lcm); });
  }
  template <class T>
  void subscribe_typed(const std::string& pattern, Delivery delivery, Handler<T> handler) {
    subscribe(pattern,
              std::make_unique<TypedSubscription<T>>(delivery, std::move(handler), counters));
  }
  template <class T>
  void publish(const Channel& channel, const T& message) {
    MessageBuffer buffer;
    const std::size_t size = encode(message, buffer);
    publish_bytes(channel.c_str(), buffer.data(), size);
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

void Bus::publish(const Channel& channel, const Pose& pose) { impl_->publish(channel, pose); }
void Bus::publish(const Channel& channel, const Hands& hands) { impl_->publish(channel, hands); }
void Bus::publish(const Channel& channel, const TimedSkeleton& skeleton) {
  impl_->publish(channel, skeleton);
}
void Bus::publish(const Channel& channel, const GuestStatus& status) {
  impl_->publish(channel, status);
}
void Bus::publish(const Channel& channel, const Stats& stats) { impl_->publish(channel, stats); }
void Bus::publish(const Channel& channel, const StageTime& stage_time) {
  impl_->publish(channel, stage_time);
}
void Bus::publish(const Channel& channel, const Music& music) { impl_->publish(channel, music); }
void Bus::publish(const Channel& channel, const Scene& scene) { impl_->publish(channel, scene); }
void Bus::publish(const Channel& channel, const Avatar& avatar) { impl_->publish(channel, avatar); }
void Bus::publish(const Channel& channel, const Style& style) { impl_->publish(channel, style); }
void Bus::publish(const Channel& channel, const Placement& placement) {
  impl_->publish(channel, placement);
}
void Bus::publish(const Channel& channel, const Beat& beat) { impl_->publish(channel, beat); }
void Bus::publish_raw(const char* channel, const void* data, std::size_t size) {
  impl_->publish_bytes(channel, data, size);
}

void Bus::on_pose(Where where, const GuestId& guest, Delivery delivery, Handler<Pose> handler) {
  impl_->subscribe_typed<Pose>(channel_pattern(Signal::kPose, where, guest), delivery,
                               std::move(handler));
}
void Bus::on_hands(Where where, const GuestId& guest, Delivery delivery, Handler<Hands> handler) {
  impl_->subscribe_typed<Hands>(channel_pattern(Signal::kHands, where, guest), delivery,
                                std::move(handler));
}
void Bus::on_skeleton(Where where, const GuestId& guest, Handler<TimedSkeleton> handler) {
  impl_->subscribe_typed<TimedSkeleton>(channel_pattern(Signal::kSkeleton, where, guest),
                                        Delivery::kEvery, std::move(handler));
}
void Bus::on_guest_status(Handler<GuestStatus> handler) {
  impl_->subscribe_typed<GuestStatus>("GUEST/stage/[a-z0-9-]+", Delivery::kEvery,
                                      std::move(handler));
}
void Bus::on_stats(Handler<Stats> handler) {
  impl_->subscribe_typed<Stats>("STATS/[a-z0-9-]+", Delivery::kEvery, std::move(handler));
}
void Bus::on_stage_time(Handler<StageTime> handler) {
  impl_->subscribe_typed<StageTime>("STAGE_TIME/view/[a-z0-9-]+", Delivery::kEvery,
                                    std::move(handler));
}
void Bus::on_music(Where where, const GuestId& guest, Handler<Music> handler) {
  impl_->subscribe_typed<Music>(channel_pattern(Signal::kMusic, where, guest), Delivery::kEvery,
                                std::move(handler));
}
void Bus::on_scene(Where where, const GuestId& guest, Handler<Scene> handler) {
  impl_->subscribe_typed<Scene>(channel_pattern(Signal::kScene, where, guest), Delivery::kEvery,
                                std::move(handler));
}
void Bus::on_avatar(Where where, const GuestId& guest, Handler<Avatar> handler) {
  impl_->subscribe_typed<Avatar>(channel_pattern(Signal::kAvatar, where, guest), Delivery::kEvery,
                                 std::move(handler));
}
void Bus::on_style(Where where, const GuestId& guest, Handler<Style> handler) {
  impl_->subscribe_typed<Style>(channel_pattern(Signal::kStyle, where, guest), Delivery::kEvery,
                                std::move(handler));
}
void Bus::on_beat(Handler<Beat> handler) {
  impl_->subscribe_typed<Beat>("BEAT/local", Delivery::kEvery, std::move(handler));
}
void Bus::on_placement(Where where, const GuestId& guest, Handler<Placement> handler) {
  impl_->subscribe_typed<Placement>(channel_pattern(Signal::kPlacement, where, guest),
                                    Delivery::kEvery, std::move(handler));
}
void Bus::on_anything(RawHandler handler) {
  impl_->subscribe(".*", std::make_unique<RawSubscription>(std::move(handler)));
}

void Bus::on_raw(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
                 RawHandler handler) {
  impl_->subscribe(pattern.regex(),
                   std::make_unique<PatternSubscription>(pattern, delivery, max_bytes,
                                                         std::move(handler), impl_->counters));
}

int Bus::fd() const { return impl_->fd(); }

void Bus::drain(MonoTime now) {
  for (auto& subscription : impl_->subscriptions) subscription->now = now;
  for (int i = 0; i < kMessagesPerTurn; ++i)
    if (lcm_handle_timeout(impl_->lcm, 0) <= 0) break;
  for (auto& subscription : impl_->subscriptions) subscription->deliver(now);
}

const Bus::Counters& Bus::counters() const { return impl_->counters; }
const std::string& Bus::url() const { return impl_->url; }

}  // namespace dance
