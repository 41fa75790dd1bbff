#include "tunnel/seal/preshared_key.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::size_t kPaddedLength = 44;  // the 43 characters and a '='

}  // namespace

PresharedKey::~PresharedKey() { OPENSSL_cleanse(bytes_.data(), bytes_.size()); }

PresharedKey PresharedKey::make() {
  PresharedKey key;
  const int done = RAND_priv_bytes(key.bytes_.data(), static_cast<int>(kBytes));
  DANCE_ASSERT(done == 1, done);
  return key;
}

std::optional<PresharedKey> PresharedKey::parse(std::string_view text) {
  if (text.size() != kTextLength) return std::nullopt;
  std::array<unsigned char, kPaddedLength> padded;
  padded.back() = '=';
  for (std::size_t i = 0; i < kTextLength; ++i) {
    const char c = text[i];
    const bool is_alphanumeric =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!is_alphanumeric && c != '-' && c != '_') return std::nullopt;
    padded[i] = static_cast<unsigned char>(c == '-' ? '+' : c == '_' ? '/' : c);
  }
  std::array<unsigned char, kBytes + 1> raw;  // the decoder writes the padding too
  const int size = EVP_DecodeBlock(raw.data(), padded.data(), static_cast<int>(padded.size()));
  if (size != static_cast<int>(raw.size())) return std::nullopt;
  PresharedKey key;
  std::copy_n(raw.begin(), kBytes, key.bytes_.begin());
  OPENSSL_cleanse(raw.data(), raw.size());
  // One text for one key: the last character has two bits that must be 0.
  if (key.text() != text) return std::nullopt;
  return key;
}

std::string PresharedKey::text() const {
  std::array<unsigned char, kPaddedLength + 1> padded;
  EVP_EncodeBlock(padded.data(), bytes_.data(), static_cast<int>(kBytes));
  std::string text(padded.begin(), padded.begin() + kTextLength);
  for (char& c : text) c = c == '+' ? '-' : c == '/' ? '_' : c;
  OPENSSL_cleanse(padded.data(), padded.size());
  return text;
}

bool PresharedKey::operator==(const PresharedKey& o) const {
  return CRYPTO_memcmp(bytes_.data(), o.bytes_.data(), kBytes) == 0;
}

}  // namespace dance
