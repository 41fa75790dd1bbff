#include "tunnel/server/program/secret_delivery.h"

namespace dance {

Result<void> keep_or_revoke(const Result<void>& delivered, const std::string& name,
                            KeyStore& store) {
  if (delivered) return {};
  const std::string what =
      "what '" + name + "' was to get is not written (" + delivered.error().what + ")";
  if (const auto removed = store.remove(name); !removed)
    return fail(what + ", and is not revoked (" + removed.error().what +
                "); revoke it with --remove-key " + name);
  return fail(what + ", and is revoked; make room, or write elsewhere, and run the command again");
}

}  // namespace dance
