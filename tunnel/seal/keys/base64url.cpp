#include "tunnel/seal/keys/base64url.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <algorithm>
#include <vector>

namespace dance {

std::string base64url(std::span<const std::uint8_t> bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                  static_cast<int>(bytes.size()));
  text.resize((bytes.size() * 4 + 2) / 3);
  std::replace(text.begin(), text.end(), '+', '-');
  std::replace(text.begin(), text.end(), '/', '_');
  return text;
}

bool decode_base64url(std::string_view text, std::span<std::uint8_t> out) {
  if (text.size() != (out.size() * 4 + 2) / 3) return false;
  for (const char c : text) {
    const bool is_alphanumeric =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!is_alphanumeric && c != '-' && c != '_') return false;
  }
  std::vector<unsigned char> padded((text.size() + 3) / 4 * 4, '=');
  std::transform(text.begin(), text.end(), padded.begin(), [](char c) {
    return static_cast<unsigned char>(c == '-' ? '+' : c == '_' ? '/' : c);
  });
  std::vector<unsigned char> raw(padded.size() / 4 * 3);  // the decoder writes the padding too
  const int size = EVP_DecodeBlock(raw.data(), padded.data(), static_cast<int>(padded.size()));
  const bool is_whole = size == static_cast<int>(raw.size());
  if (is_whole) std::copy_n(raw.begin(), out.size(), out.begin());
  OPENSSL_cleanse(raw.data(), raw.size());
  OPENSSL_cleanse(padded.data(), padded.size());
  // A byte string has only one text: the unused bits of the last character must be 0.
  std::string again = is_whole ? base64url(out) : std::string();
  const bool is_canonical = is_whole && again == text;
  OPENSSL_cleanse(again.data(), again.size());
  return is_canonical;
}

}  // namespace dance
