#include "house/house_avatars.h"

namespace dance {
namespace {

constexpr std::size_t kMostGuests = 64;

}  // namespace

HouseAvatars::HouseAvatars(SignalPort& port, std::uint64_t clock_id)
    : port_(port), clock_id_(clock_id) {
  port_.subscribe<Avatar>({Where::kCapture, GuestId()},
                          [this](const Channel& channel, const Avatar& avatar, MonoTime) {
                            if (Known* known = known_of(channel.guest())) known->avatar = avatar;
                          });
  port_.subscribe<AvatarFile>({Where::kCapture, GuestId()},
                              [this](const Channel& channel, const AvatarFile& file, MonoTime) {
                                if (Known* known = known_of(channel.guest())) known->file = file;
                              });
}

HouseAvatars::Known* HouseAvatars::known_of(const GuestId& guest) {
  if (known_.size() >= kMostGuests && !known_.contains(guest)) return nullptr;
  return &known_[guest];
}

void HouseAvatars::choose(const GuestId& guest, const ChosenAvatar& chosen, MonoTime now) {
  known_[guest] = {chosen.avatar, chosen.file};
  publish_second(now);
}

void HouseAvatars::publish_second(MonoTime now) {
  const auto publish = [&](const GuestId& guest, auto& state) {
    if (!state) return;
    auto said = *state;
    said.time = now;
    said.clock_id = clock_id_;
    port_.publish(Where::kCapture, guest, said);
  };
  for (auto& [guest, known] : known_) {
    publish(guest, known.avatar);
    publish(guest, known.file);
  }
}

}  // namespace dance
