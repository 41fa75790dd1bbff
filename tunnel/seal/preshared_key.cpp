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

PresharedKey PresharedKey::of(std::span<const std::uint8_t, kBytes> bytes) {
  PresharedKey key;
  std::copy(bytes.begin(), bytes.end(), key.bytes_.begin());
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

std::string PresharedKey::fingerprint() const {
  // With a label of its own: no other use of the key gives the same digits.
  constexpr std::string_view kLabel = "dance key fingerprint";
  std::array<unsigned char, kLabel.size() + kBytes> labelled;
  std::copy(kLabel.begin(), kLabel.end(), labelled.begin());
  std::copy(bytes_.begin(), bytes_.end(), labelled.begin() + kLabel.size());
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash;
  const int done =
      EVP_Digest(labelled.data(), labelled.size(), hash.data(), nullptr, EVP_sha256(), nullptr);
  DANCE_ASSERT(done == 1, done);
  OPENSSL_cleanse(labelled.data(), labelled.size());
  std::string text;
  for (std::size_t i = 0; i < kFingerprintLength / 2; ++i) {
    text += "0123456789abcdef"[hash[i] >> 4];
    text += "0123456789abcdef"[hash[i] & 15];
  }
  return text;
}

bool PresharedKey::operator==(const PresharedKey& o) const {
  return CRYPTO_memcmp(bytes_.data(), o.bytes_.data(), kBytes) == 0;
}

}  // namespace dance
