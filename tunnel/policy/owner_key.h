// The key that brought a guest into a room: limits and turns count by it.
#pragma once

#include "core/base/guest_id.h"

namespace dance {

struct OwnerKey {
  GuestId name{};
  // Several people hold the key, so it does not tell one person from another.
  bool is_shared = false;

  bool operator==(const OwnerKey&) const = default;
};

}  // namespace dance
