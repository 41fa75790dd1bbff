// The servers that let a house in, one line for each:
//   dance-key:alice@dance.example.org:7400/salsa#<server's public key>
//   dance-key:salsa@dance.example.org:7400/salsa#<server's public key>.<private key of a grant>
// The house proves its identity with its own key; a line with a grant, as of a room that several
// houses share, lets in whoever has the line. Server and room may be missing: then it is for every
// server with that key, or for every room. A file of such lines is where `dance key` keeps them.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      parse functions say what is wrong with a line and never what its key is.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "tunnel/seal/keys/identity_key.h"

namespace dance {

struct HouseKey {
  GuestId name;        // whom the server knows it by
  std::string server;  // HOST:PORT as the user gave it; "" = any
  GuestId room;        // not set = any
  PublicKey server_key;
  std::optional<PrivateKey> grant;  // nothing: the server knows this house's own key

  static Result<HouseKey> parse(std::string_view line);
  std::string line() const;
  // The line without its key.
  std::string title() const;
  // Whether it is used for this server (HOST:PORT, or HOST for the usual port). A line without a
  // port is used for all ports of its host.
  bool concerns(std::string_view of_server) const;
};

class HouseKeys {
 public:
  static constexpr std::size_t kMost = 1000;

  // `name` stands in errors.
  static Result<HouseKeys> parse(std::string_view text, const std::string& name);
  std::string text() const;

  // Replaces the line of the same name, server and room.
  void put(const HouseKey& key);
  bool remove(std::string_view title);
  // Trusts another key of this server (HOST or HOST:PORT) in all lines that concern it; returns
  // their titles.
  std::vector<std::string> trust(std::string_view server, const PublicKey& server_key);
  // A line that concerns this server and has another key of it; nullptr: none.
  const HouseKey* find_other(std::string_view server, const PublicKey& server_key) const;
  // The one to show a server (HOST:PORT): a key of that server before one of any, one that opens
  // the room only before one of all rooms, one in whose name the first guest can go before another.
  // nullptr: none.
  const HouseKey* find(std::string_view server, const GuestId& room, const GuestId& guest) const;
  const std::vector<HouseKey>& keys() const { return keys_; }

 private:
  std::vector<HouseKey> keys_;
};

// HOST:PORT of HOST or HOST:PORT, letters small, so that two ways to write it are one.
std::string server_name_of(std::string_view server, std::uint16_t default_port);
// HOST alone, as a certificate names it.
std::string host_of(std::string_view server);

}  // namespace dance
