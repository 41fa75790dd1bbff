#include "tunnel/link/link_key.h"

#include "core/net/address.h"
#include "tunnel/seal/key_files.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

Result<HouseKeys> load_house_keys(const std::string& path) {
  DANCE_TRY(const auto text, read_secret(path));
  return text ? HouseKeys::parse(*text, path) : HouseKeys();
}

}  // namespace

Result<std::unique_ptr<SealContext>> LinkKey::context() const {
  return certificates ? SealContext::for_link(*certificates, server)
                      : SealContext::for_link(name, key);
}

Result<LinkKey> choose_link_key(const std::string& server, const wire::RoomName& room,
                                const GuestId& first_guest, const LinkKeySource& source) {
  LinkKey chosen;
  chosen.server = host_of(server);
  const SealCertificates& certificates = source.certificates;
  if (!certificates.chain.empty() || !certificates.private_key.empty()) {
    if (certificates.chain.empty() || certificates.private_key.empty())
      return fail("a certificate and its private key belong together: give both");
    chosen.certificates = certificates;
    return chosen;
  }
  std::string path = source.key_file;
  if (path.empty()) {
    DANCE_TRY(const std::string folder, key_folder());
    path = folder + "/keys";
  }
  DANCE_TRY(const HouseKeys keys, load_house_keys(path));
  const std::string name = server_name_of(server, kDefaultServerPort);
  const HouseKey* key = keys.find(name, room, first_guest);
  // A key that says no server is for one elsewhere: on this machine there is a better one.
  const auto own = Address::resolve(server, kDefaultServerPort);
  const bool is_here = own && own->is_loopback() && source.key_file.empty();
  if (key != nullptr && !(is_here && key->server.empty())) {
    chosen.name = std::string(key->name.view());
    chosen.key = key->key;
    return chosen;
  }
  if (!own) return tl::make_unexpected(own.error());
  if (is_here) {
    chosen.name = kLocalKeyName;
    DANCE_TRY(chosen.key, local_key());
    return chosen;
  }
  return fail(
      "there is no key for " + name + " and room '" + std::string(room.view()) + "' in " + path +
      "; ask the server's keeper for an invitation (dance server --invite NAME), and open it "
      "with: dance join LINK");
}

}  // namespace dance
