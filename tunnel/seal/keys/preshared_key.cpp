#include "tunnel/seal/keys/preshared_key.h"

#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <algorithm>

#include "core/base/assert.h"
#include "tunnel/seal/keys/base64url.h"

namespace dance {

PresharedKey::~PresharedKey() { OPENSSL_cleanse(bytes_.data(), bytes_.size()); }

PresharedKey PresharedKey::make() {
  PresharedKey key;
  const int done = RAND_priv_bytes(key.bytes_.data(), static_cast<int>(kBytes));
  DANCE_ASSERT(done == 1, done);
  return key;
}

PresharedKey PresharedKey::of(std::span<const std::uint8_t, kBytes> bytes) {
  PresharedKey key;
  std::copy(bytes.begin(), bytes.end(), key.bytes_.begin());
  return key;
}

std::optional<PresharedKey> PresharedKey::parse(std::string_view text) {
  PresharedKey key;
  if (!decode_base64url(text, key.bytes_)) return std::nullopt;
  return key;
}

std::string PresharedKey::text() const { return base64url(bytes_); }

bool PresharedKey::operator==(const PresharedKey& o) const {
  return CRYPTO_memcmp(bytes_.data(), o.bytes_.data(), kBytes) == 0;
}

}  // namespace dance
