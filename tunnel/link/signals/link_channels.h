// Further channels of this house and of the others, as the house's rules let them pass.
//
// Units/frames: now is MonoTime of this house's clock.
// Ownership:    refers to the link's context and sender; the table of this house's channels is
//               reserved. Messages of a known channel never allocate.
// Threads:      none inside; one owner.
// Failure:      what no rule lets pass, or comes too fast, is dropped and counted by cause.
#pragma once

#include <string_view>
#include <vector>

#include "tunnel/link/signals/link_sender.h"

namespace dance {

// Of all guests of a house together.
constexpr std::size_t kMaxHouseChannels = 64;

class LinkChannels {
 public:
  LinkChannels(LinkContext& link, LinkSender& sender);

  // Of that guest; where none is set, of whom the rule says, or the house's first.
  void send(std::string_view name, wire::Bytes message, MonoTime now,
            const GuestId& guest = GuestId());
  void on_record(const wire::Record& record, MonoTime now);
  // False where it is to come again, as it comes too fast.
  bool on_state(RemoteGuest& remote, const wire::State& state, MonoTime now);
  // States that the server has not acknowledged, each handed to `add`.
  template <class Add>
  void each_due(MonoTime now, Add add) {
    for (Channel& channel : channels_)
      if (take_due(channel, now)) add(state_of(channel));
  }

 private:
  // One of this house.
  struct Channel {
    ForeignName name;
    const ChannelRule* rule = nullptr;
    TokenBucket changes;
    GuestId guest;  // whose it is; not set: the first one's
    // Whose it is at the server, once that guest has a slot there.
    bool is_bound = false;
    wire::Slot slot;
    std::uint8_t index = 0;
    ReplicatedState state;  // of class newest: its name
    std::uint32_t sent_version = 0;
    std::uint32_t sequence = 0;
  };

  void announce_streams();
  static void set_payload(Channel& channel, wire::Bytes message);
  static wire::State state_of(const Channel& channel);
  bool is_due(const Channel& channel) const;
  Channel* find_or_add(std::string_view name, const ChannelRule& rule);
  bool bind(Channel& channel);
  bool take_due(Channel& channel, MonoTime now);
  void send_record(Channel& channel, wire::Bytes message, MonoTime now);
  void deliver(RemoteGuest& remote, const RemoteChannel& channel, wire::Bytes message,
               MonoTime now);

  LinkContext& link_;
  LinkSender& sender_;
  std::vector<Channel> channels_;
};

}  // namespace dance
