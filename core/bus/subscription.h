// Subscriptions of a SignalPort: what is subscribed to, and how a message becomes a T and reaches
// its handler, every one of them or the newest of each channel.
//
// Units/frames: stamps in the house's clock.
// Ownership:    a subscription keeps its handler, and one message per channel where only the newest
//               is wanted; nothing is allocated once every channel has been heard once.
// Threads:      none inside.
// Failure:      what cannot be handed on is counted, by cause.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/bus/encode.h"

namespace dance {

enum class Delivery {
  kEvery,   // every message, in order
  kNewest,  // of each channel only the newest of a turn; the others are counted as superseded
};

struct SignalCounters {
  std::uint64_t received = 0;     // messages decoded
  std::uint64_t superseded = 0;   // kNewest: a newer one was already there
  std::uint64_t undecodable = 0;  // another type or version on our channel
  std::uint64_t invalid = 0;      // decoded, but not finite, not unit, out of range
  std::uint64_t unknown = 0;      // on a channel that we subscribed to but cannot parse
  std::uint64_t publish_failed = 0;
  std::uint64_t oversized = 0;  // undecoded and longer than its subscriber takes
  std::uint64_t malformed = 0;  // datagrams that are not of LCM's protocol
  std::uint64_t fragments = 0;  // refused: parts of messages longer than a datagram

  // Counts messages whose content kept them from every handler.
  std::uint64_t refused() const {
    return undecodable + invalid + unknown + oversized + malformed + fragments;
  }
};

// Which channels of a signal: <SIGNAL>/<where>/<guest>, of all guests where guest is not set.
struct From {
  From(Where at, const GuestId& of = GuestId()) : where(at), guest(of) {}  // NOLINT: a bare Where
  bool includes(const Channel& channel) const {
    return channel.where() == where && (!guest.is_set() || channel.guest() == guest);
  }
  Where where;
  GuestId guest;
};

// A message of any type, where it lies.
class AnyMessage {
 public:
  template <BusMessage T>
  explicit AnyMessage(const T& message)
      : message_(&message), type_(&kTypeOf<T>), encode_([](const void* m, MessageBuffer& buffer) {
          return MessageTraits<T>::encode(*static_cast<const T*>(m), buffer);
        }) {}
  std::size_t encode(MessageBuffer& buffer) const { return encode_(message_, buffer); }
  // nullptr where it is of another type.
  template <BusMessage T>
  const T* maybe() const {
    return type_ == &kTypeOf<T> ? static_cast<const T*>(message_) : nullptr;
  }

 private:
  template <class T>
  static constexpr char kTypeOf = 0;  // its address stands for the type

  const void* message_;
  const char* type_;
  std::size_t (*encode_)(const void*, MessageBuffer&);
};

// A message as it came over the bus.
struct Arrival {
  std::string_view name;
  const void* data;
  std::size_t size;
  MonoTime now;
};

// The newest message of each channel in a turn. Where more channels are in use than it holds, a new
// one takes the place of the one that was silent longest, so that made-up channels cannot keep out
// those that publish steadily.
template <class Key, class Message>
class NewestSlots {
 public:
  static constexpr std::size_t kMaxSlots = 256;

  struct Slot {
    Key key;
    Message message;
    bool is_fresh = false;
    std::uint64_t last_use = 0;
  };
  // nullptr where the channel has no slot.
  template <class Name>
  Slot* find(const Name& name) {
    for (Slot& slot : slots_)
      if (slot.key == name) {
        slot.last_use = ++uses_;
        return &slot;
      }
    return nullptr;
  }
  // A slot for a channel that has none. When all are in use it takes the one that was silent
  // longest, and delivers that one's message first if it is still waiting.
  template <class MakeMessage, class Deliver>
  Slot& add(Key key, const MakeMessage& make_message, const Deliver& to) {
    if (slots_.size() < kMaxSlots)
      return slots_.emplace_back(Slot{std::move(key), make_message(), false, ++uses_});
    Slot& oldest =
        *std::min_element(slots_.begin(), slots_.end(),
                          [](const Slot& a, const Slot& b) { return a.last_use < b.last_use; });
    if (std::exchange(oldest.is_fresh, false)) to(oldest.key, oldest.message);
    oldest.key = std::move(key);
    oldest.last_use = ++uses_;
    return oldest;
  }
  template <class Deliver>
  void deliver(const Deliver& to) {
    for (Slot& slot : slots_)
      if (std::exchange(slot.is_fresh, false)) to(slot.key, slot.message);
  }

 private:
  std::vector<Slot> slots_;
  std::uint64_t uses_ = 0;
};

// Whatever a bus hands its messages to.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void take(const Arrival& arrival, SignalCounters& counters) = 0;
  // The end of a turn: what was kept of it.
  virtual void deliver(MonoTime) {}
};

// A subscription to one signal.
class Subscription : public Listener {
 public:
  Subscription(Signal signal, const From& from) : signal_(signal), from_(from) {}
  Signal signal() const { return signal_; }
  const From& from() const { return from_; }
  // What comes of these guests over the bus is passed over: they are heard another way.
  void leave_out(std::vector<GuestId> guests) { left_out_ = std::move(guests); }
  bool is_left_out(const GuestId& guest) const {
    for (const GuestId& other : left_out_)
      if (other == guest) return true;
    return false;
  }
  // A message of this process, past the bus.
  virtual void hear(const Channel& channel, const AnyMessage& message, MonoTime now) = 0;

 private:
  Signal signal_;
  From from_;
  std::vector<GuestId> left_out_;
};

template <BusMessage T>
class TypedSubscription final : public Subscription {
 public:
  using Handler = std::function<void(const Channel& channel, const T& message, MonoTime now)>;
  TypedSubscription(const From& from, Handler handler, Delivery delivery)
      : Subscription(MessageTraits<T>::kSignal, from),
        delivery_(delivery),
        handler_(std::move(handler)) {}

  void take(const Arrival& arrival, SignalCounters& counters) override {
    const auto channel = Channel::parse(arrival.name);
    if (!channel) {
      ++counters.unknown;
      return;
    }
    if (is_left_out(channel->guest())) return;
    if (delivery_ == Delivery::kEvery) {
      if (is_decoded(arrival, counters)) handler_(*channel, scratch_, arrival.now);
      return;
    }
    if (!is_decoded(arrival, counters)) return;
    auto* slot = newest_.find(*channel);
    if (!slot)
      slot = &newest_.add(
          *channel, [] { return T(); },
          [&](const Channel& other, const T& message) { handler_(other, message, arrival.now); });
    if (slot->is_fresh) ++counters.superseded;
    slot->message = scratch_;
    slot->is_fresh = true;
  }

  void hear(const Channel& channel, const AnyMessage& message, MonoTime now) override {
    if (const T* ours = message.maybe<T>()) handler_(channel, *ours, now);
  }

  void deliver(MonoTime now) override {
    newest_.deliver(
        [&](const Channel& channel, const T& message) { handler_(channel, message, now); });
  }

 private:
  bool is_decoded(const Arrival& arrival, SignalCounters& counters) {
    const Decoded outcome = decode(arrival.data, arrival.size, scratch_);
    ++(outcome == Decoded::kFine      ? counters.received
       : outcome == Decoded::kInvalid ? counters.invalid
                                      : counters.undecodable);
    return outcome == Decoded::kFine;
  }

  Delivery delivery_;
  Handler handler_;
  NewestSlots<Channel, T> newest_;
  T scratch_;
};

}  // namespace dance
