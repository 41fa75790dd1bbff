// The keys that a house has been given, one line for each server that let it in:
//   dance-key:alice@dance.example.org:7400/salsa#<key>
// Server and room may be missing: then it is for every server, or every room. A file of such lines
// is where `dance key` keeps them.
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
#include "tunnel/seal/preshared_key.h"

namespace dance {

struct HouseKey {
  GuestId name;        // whom the server knows it by
  std::string server;  // HOST:PORT as it was told; "" = any
  GuestId room;        // not set = any
  PresharedKey key;

  static Result<HouseKey> parse(std::string_view line);
  std::string line() const;
  // The line without its key.
  std::string title() const;
};

class HouseKeys {
 public:
  static constexpr std::size_t kMost = 1000;

  // `name` stands in errors.
  static Result<HouseKeys> parse(std::string_view text, const std::string& name);
  std::string text() const;

  // Replaces the one of the same name, server and room.
  void put(const HouseKey& key);
  bool remove(std::string_view title);
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
