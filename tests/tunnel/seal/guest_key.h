// A guest for tests: the entry in a server's keys, the private key of the guest's house, and the
// key with which the guest's link opens a session.
#pragma once

#include <string_view>

#include "tunnel/link/link_key.h"
#include "tunnel/seal/keys/key_ring.h"

namespace dance {

struct GuestKey : KeyEntry {
  PrivateKey own = PrivateKey::make();
};

inline GuestKey key_of(std::string_view name, KeyKind kind = KeyKind::kGuest) {
  GuestKey made;
  made.name = *GuestId::parse(name);
  made.kind = kind;
  made.key = made.own.public_key();
  return made;
}

// The house has the private key as a grant, and an identity of its own.
inline LinkKey link_key_of(const GuestKey& guest, const PublicKey& server) {
  return *LinkKey::of({guest.name, "", GuestId(), server, guest.own}, PrivateKey::make());
}

}  // namespace dance
