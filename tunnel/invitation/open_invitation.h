// Opens an invitation in this house: the server proves its key and binds the guest to the identity
// of this house, and the server's line is kept where `dance key` keeps keys. From then on the house
// joins with its own identity, and whoever else has read the invitation does not. A house that ends
// half way, or a server that does, goes on where it was when the invitation is opened again; opened
// once more on the same machine it is known, and the server is not asked.
//
// Units/frames: seconds of UTC.
// Ownership:    plain values.
// Threads:      any; it waits for the server, `patience` at most, and for another program of this
//               user that opens an invitation.
// Failure:      one line that says what is wrong with the invitation or the way to its server, and
//               the cure.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/time.h"
#include "tunnel/invitation/invitation.h"

namespace dance {

struct OpenInvitation {
  // The folder of the identity and the keys; "" = key_folder().
  std::string folder;
  // The user has confirmed that the server's key is another one than this house knows.
  bool trusts_new_key = false;
  std::int64_t now_s = 0;
  Duration patience = Duration::s(20);
  // Asks the server, as ask_to_bind() does; a test may ask another.
  std::function<Result<Binding>(const Invitation&, const PrivateKey& house, Duration patience)> ask;
};

enum class Opened : std::uint8_t { kNow, kBefore };
Result<Opened> open_invitation(const Invitation& invitation, const OpenInvitation& how);
// With this user's folder and clock.
Result<Opened> open_invitation(const Invitation& invitation, bool trusts_new_key = false);

// Whether this house knows another key of the server than the invitation names. Reads files, and
// asks no server.
Result<bool> names_other_server_key(const Invitation& invitation, std::string folder = "");

// Whether this user has opened the invitation before and still trusts the same key of its server:
// no other server can complete a handshake. Reads files, and asks no server.
Result<bool> was_opened_before(const Invitation& invitation, std::string folder = "");

Result<Binding> ask_to_bind(const Invitation& invitation, const PrivateKey& house,
                            Duration patience);

// What to say where a server did not bind.
std::string binding_line(Binding binding, const Invitation& invitation);

}  // namespace dance
