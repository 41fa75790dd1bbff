#include "tunnel/server/program/invited_guests.h"

#include "core/program/talk.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {

void read_keys_again(ServerKeys& keys, Server& server) {
  const auto has_changed = keys.read_again();
  if (!has_changed) return talk::warn("{}; the keys stay as they were", has_changed.error().what);
  if (!*has_changed) return;
  server.set_keys(keys.ring());
  talk::info("{} keys now", keys.guest_count());
}

InvitedGuests::InvitedGuests(ServerKeys& keys, WakeEvent wake, Poller& poller)
    : keys_(keys),
      keeper_(file_key_store(keys.path()), std::move(wake), poller,
              [this](const InvitationKeeper::Kept& kept) { on_kept(kept); }) {}

void InvitedGuests::on_binding(PeerId peer, const KeyEntry& entry, const PublicKey& house) {
  const auto settled = keys_.ring()->settled_binding(entry.name.view(), house, utc_now_s());
  if (settled) return server_->answer_binding(peer, *settled);
  keeper_.bind(peer, entry.name, house);
}

void InvitedGuests::on_kept(const InvitationKeeper::Kept& kept) {
  if (!kept.binding)
    talk::warn("{} comes with an invitation, and cannot be let in: {}", kept.guest.view(),
               kept.binding.error().what);
  // The house comes with its key as soon as it has the answer.
  read_keys_again(keys_, *server_);
  const Binding binding = kept.binding.value_or(Binding::kNotKept);
  if (binding == Binding::kBound)
    talk::info("{} has opened the invitation, which opens nothing any more", kept.guest.view());
  server_->answer_binding(kept.peer, binding);
}

}  // namespace dance
