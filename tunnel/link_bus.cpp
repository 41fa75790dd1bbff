#include "tunnel/link_bus.h"

namespace dance {

LinkHandlers LinkBus::handlers() {
  LinkHandlers handlers;
  handlers.on_pose = [this](const GuestId& guest, const Pose& pose, MonoTime) {
    bus_.publish(Channel::of(Signal::kPose, Where::kGuest, guest), pose);
  };
  handlers.on_hands = [this](const GuestId& guest, const Hands& hands, MonoTime) {
    bus_.publish(Channel::of(Signal::kHands, Where::kGuest, guest), hands);
  };
  handlers.on_skeleton = [this](const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
    skeletons_.insert_or_assign(guest, skeleton);
    bus_.publish(Channel::of(Signal::kSkeleton, Where::kGuest, guest), {skeleton, now, clock_id_});
  };
  return handlers;
}

void LinkBus::send_captures_of(const GuestId& guest) {
  bus_.on_pose(Where::kCapture, guest, Delivery::kEvery,
               [this](const Channel& channel, const Pose& pose, MonoTime now) {
                 link_->send(channel.guest(), pose, now);
               });
  bus_.on_hands(Where::kCapture, guest, Delivery::kEvery,
                [this](const Channel& channel, const Hands& hands, MonoTime now) {
                  link_->send(channel.guest(), hands, now);
                });
  bus_.on_skeleton(Where::kCapture, guest,
                   [this](const Channel& channel, const TimedSkeleton& timed, MonoTime now) {
                     link_->send(channel.guest(), timed.skeleton, now);
                   });
}

void LinkBus::publish_second(MonoTime now) {
  for (const auto& [guest, skeleton] : skeletons_)
    bus_.publish(Channel::of(Signal::kSkeleton, Where::kGuest, guest), {skeleton, now, clock_id_});
  if (link_ != nullptr)
    bus_.publish(Channel::of_program(Signal::kStats, "link"), link_->stats(now));
}

}  // namespace dance
