#include "core/control/house_inputs.h"

#include <algorithm>
#include <utility>

#include "core/bus/voice.h"

namespace dance {
namespace {

constexpr std::size_t kMostSeen = 64;

bool is_motion(Signal signal) {
  return signal == Signal::kPose || signal == Signal::kHands || signal == Signal::kSkeleton;
}

bool is_one_of(const std::vector<GuestId>& guests, const GuestId& guest) {
  return std::find(guests.begin(), guests.end(), guest) != guests.end();
}

}  // namespace

// Passes a bus subscription only the captures that is_from_bus() allows.
class HouseInputs::BusGate final : public Subscription {
 public:
  BusGate(HouseInputs& inputs, std::shared_ptr<Subscription> to)
      : Subscription(to->signal(), to->from()), inputs_(inputs), to_(std::move(to)) {}
  void take(const Arrival& arrival, SignalCounters& counters) override {
    const auto channel = Channel::parse(arrival.name);
    if (!channel)
      ++counters.unknown;
    else if (inputs_.is_from_bus(channel->signal(), channel->guest()))
      to_->take(arrival, counters);
    else
      inputs_.note_refused(*channel);
  }
  void hear(const Channel&, const AnyMessage&, MonoTime) override {}
  void deliver(MonoTime now) override { to_->deliver(now); }

 private:
  HouseInputs& inputs_;
  std::shared_ptr<Subscription> to_;
};

HouseInputs::HouseInputs(SignalPort& port, SignalPort& bus, Options options, Poller& poller)
    : port_(port), bus_(bus), options_(std::move(options)) {
  auto socket = HouseSocket::open(
      options_.bus_url,
      [this](const Channel& channel, const Arrival& arrival) {
        take_from_socket(channel, arrival);
      },
      poller);
  if (socket)
    socket_ = std::move(*socket);
  else
    problem_ = socket.error().what;
}

HouseInputs::~HouseInputs() = default;

void HouseInputs::add(std::shared_ptr<Subscription> subscription) {
  const Signal signal = subscription->signal();
  const From& from = subscription->from();
  if (!goes_to_house(signal, from.where)) return port_.add(std::move(subscription));
  subscriptions_.push_back(subscription);
  if (from.where != Where::kCapture) return;
  const bool takes_any =
      from.guest.is_set() ? is_from_bus(signal, from.guest) : !options_.from_bus.empty();
  // Subscribes to poses in any case, to report those that are not accepted.
  if (takes_any || signal == Signal::kPose)
    bus_.add(std::make_shared<BusGate>(*this, std::move(subscription)));
}

bool HouseInputs::is_hosted(Signal signal, const GuestId& guest) const {
  return is_motion(signal) && is_one_of(options_.hosted, guest);
}

bool HouseInputs::is_from_bus(Signal signal, const GuestId& guest) const {
  return is_one_of(options_.from_bus, guest) && !is_hosted(signal, guest);
}

// Skips captures that are accepted from the bus: they are published there too, and would arrive
// twice.
void HouseInputs::receive_own(const Channel& channel, const AnyMessage& message, MonoTime now) {
  if (!goes_to_house(channel.signal(), channel.where())) return;
  if (is_from_bus(channel.signal(), channel.guest())) return;
  note_received(channel);
  for (const auto& subscription : subscriptions_)
    if (subscription->signal() == channel.signal() && subscription->from().includes(channel))
      subscription->hear(channel, message, now);
}

void HouseInputs::take_from_socket(const Channel& channel, const Arrival& arrival) {
  const Signal signal = channel.signal();
  if (is_hosted(signal, channel.guest()) || is_from_bus(signal, channel.guest())) return;
  note_received(channel);
  for (const auto& subscription : subscriptions_) {
    if (subscription->signal() != signal || !subscription->from().includes(channel)) continue;
    subscription->take(arrival, counters_);
    subscription->deliver(arrival.now);
  }
}

HouseInputs::Seen* HouseInputs::seen_of(const GuestId& guest) {
  for (Seen& seen : seen_)
    if (seen.guest == guest) return &seen;
  if (seen_.size() == kMostSeen) return nullptr;
  seen_.push_back({guest});
  return &seen_.back();
}

void HouseInputs::note_received(const Channel& channel) {
  if (channel.signal() != Signal::kPose) return;
  if (Seen* seen = seen_of(channel.guest())) seen->refused = 0;
}

// Poses that also arrive over the socket or from this process are not reported.
void HouseInputs::note_refused(const Channel& channel) {
  if (channel.signal() != Signal::kPose) return;
  Seen* seen = seen_of(channel.guest());
  if (seen == nullptr) return;
  if (++seen->refused < kReportedEach) return;
  refused_ += seen->refused;
  seen->refused = 0;
  if (options_.on_refused) options_.on_refused(channel.guest());
}

std::string refused_poses_line(const GuestId& guest) {
  const std::string name(guest.view());
  return "poses of " + name +
         " on the bus are not sent to the room, because any user of this machine can publish "
         "there; to send them, start with --bus-captures " +
         name + ", or write bus_captures = [\"" + name + "\"] under [house] in the house file";
}

std::string no_house_socket_line(const std::string& problem) {
  return "other programs (camera, window, dance voice) cannot reach this house, as its socket "
         "cannot be opened: " +
         problem;
}

}  // namespace dance
