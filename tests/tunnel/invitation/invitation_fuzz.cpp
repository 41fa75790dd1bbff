// Any text as an invitation, and as a house's file of those that it has opened: what is taken comes
// back from its own text, and what is not taken is said in one short line.
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/assert.h"
#include "tests/fuzz_target.h"
#include "tunnel/invitation/invitation.h"
#include "tunnel/invitation/opened_invitations.h"

namespace {

void read(std::string_view text) {
  const auto parsed = dance::parse_invitation(text);
  if (!parsed) {
    DANCE_ASSERT(!parsed.error().what.empty() && parsed.error().what.size() < 300);
    return;
  }
  DANCE_ASSERT(dance::is_invitation(text));
  DANCE_ASSERT(parsed->guest.is_set() && parsed->port != 0 && parsed->host.size() <= 253);
  const std::string canonical = dance::text_of(*parsed);
  const auto back = dance::parse_invitation(canonical);
  DANCE_ASSERT(back && *back == *parsed);
  DANCE_ASSERT(dance::text_of(*back) == canonical);
  // What a house keeps of it can be read too.
  DANCE_ASSERT(dance::HouseKey::parse(parsed->house_key().line()));
}

}  // namespace

DANCE_FUZZ_TARGET(invitation) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read(text);
  const auto opened = dance::OpenedInvitations::parse(text, "file");
  if (opened)
    DANCE_ASSERT(dance::OpenedInvitations::parse(opened->text(), "file")->text() == opened->text());
  return 0;
}
