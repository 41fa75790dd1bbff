// `dance server --invite NAME`: makes an invitation, puts it into the server's keys, and prints its
// line, once; with --qr as a QR code too. A second one for the same guest takes the place of one
// that is still open; a guest who has a key keeps it, and gets none.
//
// Units/frames: seconds of UTC.
// Ownership:    plain values.
// Threads:      one.
// Failure:      says which name, address, time or file, and the cure. Nothing else shows the line.
#pragma once

#include <cstdint>
#include <string>

#include "tunnel/invitation/invitation.h"
#include "tunnel/server/program/key_store.h"

namespace dance {

struct InviteOptions {
  std::string valid_for = "24h";
  bool has_qr = false;  // in the terminal
  std::string qr_file;  // .svg
};

// 90m, 24h, 7d: from a minute to `most_days`. `option` stands in errors.
Result<std::int64_t> parse_validity_s(const std::string& option, const std::string& text,
                                      std::int64_t most_days);

// `entry`: name, kind, room, and when the key that comes of the invitation expires.
// `address`: HOST[:PORT] as guests reach the server; "" = this machine's address in its own
// network. `port`: where the address names none.
Result<void> run_invite_command(KeyEntry entry, const std::string& address, std::uint16_t port,
                                const InviteOptions& options, KeyStore& store);

}  // namespace dance
