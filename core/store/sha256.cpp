#include "core/store/sha256.h"

#include <openssl/evp.h>

#include "core/base/assert.h"

namespace dance {

struct Sha256::Context {
  EVP_MD_CTX* digest = EVP_MD_CTX_new();
  ~Context() { EVP_MD_CTX_free(digest); }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  const int begun = EVP_DigestInit_ex(context_->digest, EVP_sha256(), nullptr);
  DANCE_ASSERT(begun == 1);
}

Sha256::~Sha256() = default;

void Sha256::add(std::span<const std::uint8_t> bytes) {
  const int added = EVP_DigestUpdate(context_->digest, bytes.data(), bytes.size());
  DANCE_ASSERT(added == 1);
}

FileHash Sha256::finish() {
  FileHash hash;
  unsigned size = 0;
  const int finished = EVP_DigestFinal_ex(context_->digest, hash.bytes.data(), &size);
  DANCE_ASSERT(finished == 1 && size == hash.bytes.size(), size);
  return hash;
}

FileHash sha256_of(std::span<const std::uint8_t> bytes) {
  Sha256 sha256;
  sha256.add(bytes);
  return sha256.finish();
}

}  // namespace dance
