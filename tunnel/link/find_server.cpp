#include "tunnel/link/find_server.h"

#include <optional>
#include <utility>

#include "core/net/names/name_lookup.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr Duration kResolverWait = Duration::s(3);
constexpr Duration kResolverTimeout = Duration::s(60);

std::string silent_line(const std::string& server) {
  return "host '" + server +
         "' is not resolved yet: the name server does not answer; check the network";
}

}  // namespace

std::function<Result<std::vector<Address>>()> look_up_of(const std::string& server) {
  if (Address::is_numeric(server)) return {};
  return [server] { return Address::resolve_all(server, kDefaultServerPort); };
}

Result<FoundServer> find_server(const std::string& server,
                                const std::function<Result<std::vector<Address>>()>& look_up,
                                const wire::RoomName& room, const GuestId& first_guest,
                                const LinkKeySource& source, Poller& poller) {
  FoundServer found;
  if (!look_up) {
    DANCE_TRY(found.key, choose_link_key(server, room, first_guest, source));
    DANCE_TRY(found.addresses, Address::resolve_all(server, kDefaultServerPort));
    return found;
  }
  DANCE_TRY(const auto lookup, NameLookup::create(look_up));
  lookup->begin();
  std::optional<NameLookup::Addresses> answer;
  if (poller.wait_for(lookup->fd(), kResolverWait)) answer = lookup->take();
  if (answer && *answer) {
    found.addresses = std::move(**answer);
    DANCE_TRY(found.key, choose_link_key(server, room, first_guest, source));
    return found;
  }
  DANCE_TRY(auto key, find_link_key(server, Address(), room, first_guest, source));
  // The name may be this machine's: its server has a key that is found by its address.
  if (!key && !answer && poller.wait_for(lookup->fd(), kResolverTimeout)) answer = lookup->take();
  if (poller.is_stopped()) return fail("stopped before host '" + server + "' was resolved");
  if (answer && *answer) {
    found.addresses = std::move(**answer);
    DANCE_TRY(found.key, choose_link_key(server, room, first_guest, source));
    return found;
  }
  found.why = answer ? answer->error().what : silent_line(server);
  if (!key) return fail(found.why);
  found.key = std::move(*key);
  return found;
}

}  // namespace dance
