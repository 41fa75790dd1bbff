// Opens an invitation in this house: makes a key, has the server take it in the place of the
// invitation's, and keeps it where `dance key` keeps keys. From then on the house joins as with any
// key, and whoever else has read the invitation does not. A house that ends half way, or a server
// that does, goes on where it was when the invitation is opened again; opened once more on the same
// machine it is known, and the server is not asked.
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
  // Where keys lie; "" = key_folder().
  std::string folder;
  std::int64_t now_s = 0;
  Duration patience = Duration::s(20);
  // Asks the server, as ask_to_bind() does; a test may ask another.
  std::function<Result<Binding>(const Invitation&, const PresharedKey& lasting, Duration patience)>
      ask;
};

enum class Opened : std::uint8_t { kNow, kBefore };
Result<Opened> open_invitation(const Invitation& invitation, const OpenInvitation& how);
// With this user's folder and clock.
Result<Opened> open_invitation(const Invitation& invitation);

Result<Binding> ask_to_bind(const Invitation& invitation, const PresharedKey& lasting,
                            Duration patience);

// What to say where a server did not bind.
std::string binding_line(Binding binding, const Invitation& invitation);

}  // namespace dance
