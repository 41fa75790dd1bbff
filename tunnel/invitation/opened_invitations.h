// The invitations that this house has opened, in a file beside its keys: while one is being opened
// the key that the house has made for itself, so that a house that ends half way comes in with that
// key and no other; and of each that was opened under which title its key is kept.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      parse() names the line and the cure, and never shows a key.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "tunnel/seal/house_keys.h"

namespace dance {

class OpenedInvitations {
 public:
  // Older ones make room.
  static constexpr std::size_t kMost = 200;

  // `name` stands in errors.
  static Result<OpenedInvitations> parse(std::string_view text, const std::string& name);
  std::string text() const;

  // `invitation` is the fingerprint of its key.
  std::optional<HouseKey> pending(std::string_view invitation) const;
  bool is_done(std::string_view invitation) const;
  void begin(const std::string& invitation, const HouseKey& key);
  void end(const std::string& invitation, const HouseKey& key);
  void forget(std::string_view invitation);

 private:
  struct Row {
    std::string invitation;
    std::string title;
    std::optional<HouseKey> pending;
  };
  const Row* find(std::string_view invitation) const;
  void put(Row row);

  std::vector<Row> rows_;  // the oldest first
};

}  // namespace dance
