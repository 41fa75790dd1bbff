#include "tunnel/link/link_key.h"

#include "tunnel/seal/keys/key_files.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

Result<HouseKeys> load_house_keys(const std::string& path) {
  DANCE_TRY(const auto text, read_secret(path));
  return text ? HouseKeys::parse(*text, path) : HouseKeys();
}

Result<std::string> path_of_keys(const LinkKeySource& source) {
  if (!source.key_file.empty()) return source.key_file;
  DANCE_TRY(const std::string folder, key_folder());
  return folder + "/keys";
}

}  // namespace

Result<std::unique_ptr<SealContext>> LinkKey::context() const {
  return certificates ? SealContext::for_link(*certificates, server)
                      : SealContext::for_link(identity, key, server_key);
}

Result<LinkKey> LinkKey::of(const HouseKey& key, const PrivateKey& house) {
  const auto session_key = house_session_key(house, key.grant, key.server_key);
  if (!session_key)
    return fail("the key of " + key.title() +
                " names no key that a server could have: remove it with dance key --remove, and "
                "ask for another");
  LinkKey made;
  made.identity = identity_text(key.name.view(), house.public_key());
  made.key = *session_key;
  made.server_key = key.server_key;
  made.server = host_of(key.server);
  return made;
}

Result<std::optional<LinkKey>> find_link_key(const std::string& server, const Address& at,
                                             const wire::RoomName& room, const GuestId& first_guest,
                                             const LinkKeySource& source) {
  LinkKey chosen;
  chosen.server = host_of(server);
  const SealCertificates& certificates = source.certificates;
  if (!certificates.chain.empty() || !certificates.private_key.empty()) {
    if (certificates.chain.empty() || certificates.private_key.empty())
      return fail("a certificate and its private key belong together: give both");
    chosen.certificates = certificates;
    return std::optional(std::move(chosen));
  }
  DANCE_TRY(const std::string path, path_of_keys(source));
  DANCE_TRY(const HouseKeys keys, load_house_keys(path));
  const HouseKey* key = keys.find(server_name_of(server, kDefaultServerPort), room, first_guest);
  // A key that says no server is for one elsewhere: on this machine there is a better one.
  const bool is_here = at.is_set() && at.is_loopback() && source.key_file.empty();
  if (key != nullptr && !(is_here && key->server.empty())) {
    DANCE_TRY(const PrivateKey house, house_identity());
    DANCE_TRY(LinkKey own, LinkKey::of(*key, house));
    return std::optional(std::move(own));
  }
  if (!is_here) return std::optional<LinkKey>();
  chosen.identity = kLocalKeyName;
  DANCE_TRY(chosen.key, local_key());
  return std::optional(std::move(chosen));
}

Result<LinkKey> choose_link_key(const std::string& server, const wire::RoomName& room,
                                const GuestId& first_guest, const LinkKeySource& source) {
  const auto own = Address::resolve(server, kDefaultServerPort);
  DANCE_TRY(std::optional<LinkKey> found,
            find_link_key(server, own.value_or(Address()), room, first_guest, source));
  if (found) return std::move(*found);
  if (!own) return tl::make_unexpected(own.error());
  DANCE_TRY(const std::string path, path_of_keys(source));
  return fail("there is no key for " + server_name_of(server, kDefaultServerPort) + " and room '" +
              std::string(room.view()) + "' in " + path +
              "; ask the server's keeper for an invitation (dance server --invite NAME), and open "
              "it with: dance join LINK");
}

}  // namespace dance
