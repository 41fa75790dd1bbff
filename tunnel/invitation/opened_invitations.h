// The invitations that this house has opened, in a file beside its keys: of each the fingerprint of
// its key, whether the server has accepted this house, and the title of the server's line among the
// keys.
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
#include "tunnel/seal/keys/house_keys.h"

namespace dance {

class OpenedInvitations {
 public:
  // Older ones make room.
  static constexpr std::size_t kMost = 200;

  // `name` stands in errors.
  static Result<OpenedInvitations> parse(std::string_view text, const std::string& name);
  std::string text() const;

  // `invitation` is the fingerprint of its key. Pending: the server may have accepted this house,
  // and its answer has not arrived.
  bool is_pending(std::string_view invitation) const;
  bool is_done(std::string_view invitation) const;
  void begin(const std::string& invitation, const HouseKey& key);
  void end(const std::string& invitation, const HouseKey& key);
  void forget(std::string_view invitation);

 private:
  struct Row {
    std::string invitation;
    std::string title;
    bool is_pending = false;
  };
  const Row* find(std::string_view invitation) const;
  void put(Row row);

  std::vector<Row> rows_;  // the oldest first
};

}  // namespace dance
