#include "tunnel/server/program/invite_command.h"

#include <unistd.h>

#include <charconv>

#include "core/net/machine_addresses.h"
#include "core/net/udp_socket.h"
#include "core/program/standard_output.h"
#include "core/program/talk.h"
#include "tunnel/invitation/qr_code.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/seal/keys/utc_text.h"
#include "tunnel/server/program/secret_delivery.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

static_assert(kInvitationPort == kDefaultServerPort);
constexpr std::int64_t kShortest_s = 60, kDay_s = 24 * 3600, kMostDays = 90;

// The address that this machine would speak to others from; nothing is sent.
Result<std::string> own_address() {
  for (const char* far : {"192.0.2.1:7400", "[2001:db8::1]:7400"}) {
    const auto address = Address::resolve(far);
    if (!address) continue;
    const auto socket = UdpSocket::connect(*address);
    if (!socket) continue;
    const std::string text = socket->local_address().with_port(1).to_string();
    return text.substr(0, text.rfind(':'));
  }
  // Guests of this network reach the server even if it has no default route.
  for (const std::string& address : machine_addresses())
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
  return fail(
      "this machine has no address in a network: say with --address HOST how guests reach its "
      "server");
}

// The caller sets the keys of the invitation.
Result<Invitation> invitation_of(const KeyEntry& entry, const std::string& address,
                                 std::uint16_t port, std::int64_t until_s) {
  Invitation made;
  std::string server = address;
  if (server.empty()) {
    DANCE_TRY(server, own_address());
  }
  if (auto set = set_server(made, server); !set) return fail("--address " + set.error().what);
  const bool names_port = server_name_of(server, 0) == made.server();
  if (!names_port) made.port = port;
  made.room = entry.room;
  made.guest = entry.name;
  made.role = entry.kind;
  made.until_s = until_s;
  return made;
}

Result<void> check_qr_file(const std::string& path) {
  if (!path.empty() && !path.ends_with(".svg"))
    return fail("--qr '" + path + "': a file that ends with .svg is wanted");
  return {};
}

}  // namespace

Result<std::int64_t> parse_validity_s(const std::string& option, const std::string& text,
                                      std::int64_t most_days) {
  std::int64_t count = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), count);
  const bool has_one_letter = read.ec == std::errc() && read.ptr + 1 == text.data() + text.size();
  const char unit = has_one_letter ? *read.ptr : '\0';
  const std::int64_t unit_s = unit == 'm' ? 60 : unit == 'h' ? 3600 : unit == 'd' ? kDay_s : 0;
  if (unit_s == 0 || count < 1 || count > most_days * kDay_s / unit_s ||
      count * unit_s < kShortest_s)
    return fail(option + " '" + text + "': write how long, 90m, 24h or 7d, up to " +
                std::to_string(most_days) + "d");
  return count * unit_s;
}

Result<void> run_invite_command(KeyEntry entry, const std::string& address, std::uint16_t port,
                                const InviteOptions& options, KeyStore& store) {
  DANCE_TRY(const std::int64_t valid_s, parse_validity_s("--for", options.valid_for, kMostDays));
  if (auto checked = check_qr_file(options.qr_file); !checked) return checked;
  const std::int64_t until_s = (utc_now_s() + valid_s) / 60 * 60;
  if (entry.until_s && *entry.until_s < until_s)
    return fail("--key-for is shorter than --for: the key would expire before the invitation");
  entry.has_key = false;
  DANCE_TRY(Invitation invitation, invitation_of(entry, address, port, until_s));
  DANCE_TRY(invitation.server_key, store.claim_server_key());
  invitation.key = PrivateKey::make();
  entry.invitation = InvitationKey{invitation.key.public_key(), until_s, InvitationState::kOpen};
  const std::string line = text_of(invitation);
  // It must be one that the other side can read.
  if (const auto back = parse_invitation(line); !back || !(*back == invitation))
    return fail("--address '" + address + "' is no HOST or HOST:PORT");
  std::string picture, drawn;
  if (options.has_qr || !options.qr_file.empty()) {
    DANCE_TRY(const QrCode code, make_qr_code(line));
    drawn = qr_text(code, isatty(STDOUT_FILENO) != 0);
    picture = qr_svg(code);
  }
  DANCE_TRY(const KeyRing before, store.read());
  const KeyEntry* known = before.find_invitation(entry.name.view());
  DANCE_TRY(const bool is_invited, store.invite(entry));
  if (!is_invited)
    return fail("'" + std::string(entry.name.view()) + "' has a key already in " + store.name() +
                ", and needs no invitation; --remove-key takes it away, and another device can "
                "be invited as " +
                std::string(entry.name.view().substr(0, kMaxGuestIdLength - 2)) + "-2");
  Result<void> written;
  if (!options.qr_file.empty()) written = write_secret(options.qr_file, picture);
  if (written) written = write_to_stdout(line + "\n" + (options.has_qr ? "\n" + drawn : ""));
  if (auto kept = keep_or_revoke(written, entry.name.c_str(), store); !kept) return kept;
  if (known != nullptr && known->is_invited())
    talk::info("the invitation that {} had before opens nothing any more", entry.name.view());
  if (address.empty())
    talk::info(
        "{} is this machine's address in its own network; for guests elsewhere say how they "
        "reach it with --address",
        invitation.host);
  talk::info("good once, until {}; send it to {} alone, who opens it with: dance join 'dance://…'",
             utc_shown(until_s), entry.name.view());
  return {};
}

}  // namespace dance
