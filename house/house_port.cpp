#include "house/house_port.h"

#include <algorithm>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

// What a producer says; the rest of a capture is the guest's choice, made anywhere.
bool is_motion(Signal signal) {
  return signal == Signal::kPose || signal == Signal::kHands || signal == Signal::kSkeleton;
}

}  // namespace

bool HousePort::is_hosted(Signal signal, Where where, const GuestId& guest) const {
  if (where == Where::kStage) return true;
  if (where == Where::kGuest) return hosted_.has_link;
  return where == Where::kCapture && is_motion(signal) &&
         std::find(hosted_.producers.begin(), hosted_.producers.end(), guest) !=
             hosted_.producers.end();
}

void HousePort::send(const Channel& channel, const AnyMessage& message) {
  // The display is on the bus; what is hosted here may take its time over the stage.
  if (channel.where() == Where::kStage) bus_.send(channel, message);
  // A capture goes to the network before this house's own stage.
  if (channel.where() == Where::kCapture && inputs_ != nullptr)
    inputs_->receive_own(channel, message, mono_now());
  if (is_hosted(channel.signal(), channel.where(), channel.guest())) {
    const MonoTime now = mono_now();
    for (const auto& subscription : subscriptions_)
      if (subscription->signal() == channel.signal() && subscription->from().includes(channel))
        subscription->hear(channel, message, now);
  }
  if (channel.where() != Where::kStage) bus_.send(channel, message);
}

void HousePort::add(std::shared_ptr<Subscription> subscription) {
  const From& from = subscription->from();
  const Signal signal = subscription->signal();
  if (signal == Signal::kFlow && from.where == Where::kCapture && inputs_ != nullptr)
    return inputs_->add(std::move(subscription));
  subscriptions_.push_back(subscription);
  if (is_hosted(signal, from.where, from.guest)) return;
  if (from.where == Where::kCapture && is_motion(signal))
    subscription->leave_out(hosted_.producers);
  bus_.add(std::move(subscription));
}

}  // namespace dance
