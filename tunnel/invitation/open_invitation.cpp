#include "tunnel/invitation/open_invitation.h"

#include "tunnel/invitation/opened_invitations.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

constexpr const char* kKeysFile = "/keys";
constexpr const char* kOpenedFile = "/invitations";
constexpr const char* kLockFile = "/invitations.lock";

Result<HouseKeys> read_house_keys(const std::string& path) {
  DANCE_TRY(const auto text, read_secret(path));
  return text ? HouseKeys::parse(*text, path) : HouseKeys();
}

bool has_line(const HouseKeys& keys, const HouseKey& wanted) {
  for (const HouseKey& key : keys.keys())
    if (key.title() == wanted.title()) return key.server_key == wanted.server_key;
  return false;
}

std::string other_key_line(const HouseKey& known, const Invitation& invitation) {
  return "the invitation names another key of " + invitation.server() +
         " than the one that this house knows (" + known.server_key.text() +
         "). If its keeper confirms that the server's key is now " + invitation.server_key.text() +
         ", run: dance key --trust " + invitation.server() + "=" + invitation.server_key.text();
}

// `dance key` may be writing at the same time.
Result<void> keep_key(const std::string& path, const HouseKey& key, bool trusts_new_key) {
  DANCE_TRY(const FileLock lock, FileLock::of_folder(path));
  DANCE_TRY(HouseKeys keys, read_house_keys(path));
  if (trusts_new_key) keys.trust(key.server, key.server_key);
  keys.put(key);
  return write_secret(path, keys.text());
}

std::string expired_line(const Invitation& invitation, std::int64_t now_s) {
  return "the invitation of " + invitation.title() + " was good until " +
         utc_shown(invitation.until_s) + ", and it is " + utc_shown(now_s) +
         " by this machine's clock: ask the server's keeper for another";
}

}  // namespace

Result<Opened> open_invitation(const Invitation& invitation, const OpenInvitation& how) {
  std::string folder = how.folder;
  if (folder.empty()) {
    DANCE_TRY(folder, key_folder());
  }
  const std::string keys_path = folder + kKeysFile, opened_path = folder + kOpenedFile;
  // Only one program at a time may open an invitation.
  DANCE_TRY(const FileLock lock, FileLock::of_file(folder + kLockFile));
  OpenedInvitations opened;
  DANCE_TRY(const auto text, read_secret(opened_path));
  if (text) {
    DANCE_TRY(opened, OpenedInvitations::parse(*text, opened_path));
  }
  const std::string id = invitation.key.fingerprint();
  DANCE_TRY(const HouseKeys keys, read_house_keys(keys_path));
  const HouseKey key = invitation.house_key();
  if (opened.is_done(id) && has_line(keys, key)) return Opened::kBefore;
  // A server whose key has changed may be another server: the user decides.
  const HouseKey* const known = keys.find_other(invitation.server(), invitation.server_key);
  if (known != nullptr && !how.trusts_new_key) return fail(other_key_line(*known, invitation));
  DANCE_TRY(const PrivateKey house, house_identity(folder));
  if (!opened.is_pending(id)) {  // otherwise the server may have accepted this house already
    if (how.now_s >= invitation.until_s) return fail(expired_line(invitation, how.now_s));
    opened.begin(id, key);
    if (auto written = write_secret(opened_path, opened.text()); !written)
      return tl::make_unexpected(written.error());
  }
  const auto ask = how.ask ? how.ask : ask_to_bind;
  DANCE_TRY(const Binding binding, ask(invitation, house, how.patience));
  if (binding != Binding::kBound) {
    // A server that could not keep the key now may have kept it all the same. And that it does not
    // know the invitation is said before either side has proved who it is: by anybody on the way.
    if (binding != Binding::kNotKept && binding != Binding::kUnknown) {
      opened.forget(id);
      if (auto written = write_secret(opened_path, opened.text()); !written)
        return tl::make_unexpected(written.error());
    }
    return fail(binding_line(binding, invitation));
  }
  // In this order: a program that ends between the two asks again.
  if (auto kept = keep_key(keys_path, key, how.trusts_new_key); !kept)
    return tl::make_unexpected(kept.error());
  opened.end(id, key);
  if (auto written = write_secret(opened_path, opened.text()); !written)
    return tl::make_unexpected(written.error());
  return Opened::kNow;
}

Result<Opened> open_invitation(const Invitation& invitation, bool trusts_new_key) {
  OpenInvitation how;
  how.now_s = utc_now_s();
  how.trusts_new_key = trusts_new_key;
  return open_invitation(invitation, how);
}

Result<bool> names_other_server_key(const Invitation& invitation, std::string folder) {
  if (folder.empty()) {
    DANCE_TRY(folder, key_folder());
  }
  DANCE_TRY(const HouseKeys keys, read_house_keys(folder + kKeysFile));
  return keys.find_other(invitation.server(), invitation.server_key) != nullptr;
}

Result<bool> was_opened_before(const Invitation& invitation, std::string folder) {
  if (folder.empty()) {
    DANCE_TRY(folder, key_folder());
  }
  DANCE_TRY(const auto text, read_secret(folder + kOpenedFile));
  if (!text) return false;
  DANCE_TRY(const auto opened, OpenedInvitations::parse(*text, folder + kOpenedFile));
  DANCE_TRY(const HouseKeys keys, read_house_keys(folder + kKeysFile));
  return opened.is_done(invitation.key.fingerprint()) && has_line(keys, invitation.house_key());
}

std::string binding_line(Binding binding, const Invitation& invitation) {
  const std::string which = "the invitation of " + invitation.title();
  const std::string guest(invitation.guest.view());
  const std::string another =
      ": ask the server's keeper for another (dance server --invite " + guest + ")";
  switch (binding) {
    case Binding::kBound:
      return which + " is opened";
    case Binding::kUsed:
      return which + " was used already, by another house or another user" + another +
             ", and say so if it was none of yours";
    case Binding::kRevoked:
      return which + " was revoked" + another;
    case Binding::kExpired:
      return which + " was good until " + utc_shown(invitation.until_s) + " by the server's clock" +
             another;
    case Binding::kNotKept:
      return "the server " + invitation.server() +
             " could not write its keys: its keeper finds the reason in its messages; then open "
             "the invitation again";
    case Binding::kNotHere:
      return "the server " + invitation.server() +
             " is one of a cluster, which takes no invitations: ask its keeper for a key (dance "
             "server --new-guest " +
             guest + "), and paste it into: dance key";
    case Binding::kUnknown:
    case Binding::kCount:
      break;
  }
  return "the server " + invitation.server() + " does not know " + which +
         ": a newer one has taken its place, its key was removed long ago, or another server made "
         "it; ask for another (dance server --invite " +
         guest + ")";
}

}  // namespace dance
