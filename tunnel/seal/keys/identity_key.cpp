#include "tunnel/seal/keys/identity_key.h"

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/crypto.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/kdf.h>
#include <openssl/obj_mac.h>
#include <openssl/params.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/base/assert.h"
#include "tunnel/seal/keys/base64url.h"

namespace dance {
namespace {

struct PointFree {
  void operator()(EC_POINT* point) const { EC_POINT_clear_free(point); }
};
using Point = std::unique_ptr<EC_POINT, PointFree>;
struct NumberFree {
  void operator()(BIGNUM* number) const { BN_clear_free(number); }
};
using Number = std::unique_ptr<BIGNUM, NumberFree>;
struct ContextFree {
  void operator()(BN_CTX* context) const { BN_CTX_free(context); }
};
using NumberContext = std::unique_ptr<BN_CTX, ContextFree>;
struct DerivationFree {
  void operator()(EVP_KDF_CTX* derivation) const { EVP_KDF_CTX_free(derivation); }
};
using Derivation = std::unique_ptr<EVP_KDF_CTX, DerivationFree>;

const EC_GROUP* curve() {
  static const EC_GROUP* const group = EC_GROUP_new_by_curve_name(NID_X9_62_prime256v1);
  DANCE_ASSERT(group != nullptr);
  return group;
}

Number to_bignum(const std::array<std::uint8_t, PrivateKey::kBytes>& bytes) {
  Number number(BN_secure_new());
  DANCE_ASSERT(number && BN_bin2bn(bytes.data(), static_cast<int>(bytes.size()), number.get()));
  BN_set_flags(number.get(), BN_FLG_CONSTTIME);
  return number;
}

bool is_scalar(const BIGNUM* number) {
  return !BN_is_zero(number) && BN_cmp(number, EC_GROUP_get0_order(curve())) < 0;
}

// nullptr: no point of the curve.
Point decode_point(const PublicKey& key, BN_CTX* context) {
  Point point(EC_POINT_new(curve()));
  if (!point || !key.is_set() ||
      EC_POINT_oct2point(curve(), point.get(), key.bytes().data(), key.bytes().size(), context) !=
          1 ||
      EC_POINT_is_at_infinity(curve(), point.get()) == 1)
    return nullptr;
  return point;
}

OSSL_PARAM octets(const char* name, std::span<const std::uint8_t> bytes) {
  return OSSL_PARAM_construct_octet_string(name, const_cast<std::uint8_t*>(bytes.data()),
                                           bytes.size());
}

PresharedKey session_key(std::span<const std::uint8_t> secret, const PublicKey& server,
                         const PublicKey& house, const PublicKey& admitted) {
  static EVP_KDF* const hkdf = EVP_KDF_fetch(nullptr, OSSL_KDF_NAME_HKDF, nullptr);
  constexpr std::array<std::uint8_t, 20> kSalt{'d', 'a', 'n', 'c', 'e', 'g', 'r', 'a', 'p', 'h',
                                               ' ', 's', 'e', 's', 's', 'i', 'o', 'n', ' ', '1'};
  std::vector<std::uint8_t> info;
  for (const PublicKey* key : {&server, &house, &admitted})
    info.insert(info.end(), key->bytes().begin(), key->bytes().end());
  std::string digest = "SHA256";
  const std::array parameters{
      OSSL_PARAM_construct_utf8_string(OSSL_KDF_PARAM_DIGEST, digest.data(), 0),
      octets(OSSL_KDF_PARAM_KEY, secret), octets(OSSL_KDF_PARAM_SALT, kSalt),
      octets(OSSL_KDF_PARAM_INFO, info), OSSL_PARAM_construct_end()};
  const Derivation derivation(EVP_KDF_CTX_new(hkdf));
  std::array<std::uint8_t, PresharedKey::kBytes> derived{};
  DANCE_ASSERT(derivation && EVP_KDF_derive(derivation.get(), derived.data(), derived.size(),
                                            parameters.data()) == 1);
  const PresharedKey key = PresharedKey::of(derived);
  OPENSSL_cleanse(derived.data(), derived.size());
  return key;
}

}  // namespace

std::optional<PublicKey> PublicKey::parse(std::string_view text) {
  PublicKey key;
  if (!decode_base64url(text, key.bytes_)) return std::nullopt;
  if (key.bytes_[0] != 2 && key.bytes_[0] != 3) return std::nullopt;
  return key;
}

std::string PublicKey::text() const { return base64url(bytes_); }

bool PublicKey::is_on_curve() const {
  const NumberContext context(BN_CTX_new());
  return decode_point(*this, context.get()) != nullptr;
}

PrivateKey::~PrivateKey() { OPENSSL_cleanse(bytes_.data(), bytes_.size()); }

PrivateKey PrivateKey::make() {
  const Number number(BN_secure_new());
  PrivateKey key;
  do {
    const int done = BN_priv_rand_range(number.get(), EC_GROUP_get0_order(curve()));
    DANCE_ASSERT(done == 1, done);
  } while (BN_is_zero(number.get()));
  BN_bn2binpad(number.get(), key.bytes_.data(), static_cast<int>(kBytes));
  return key;
}

std::optional<PrivateKey> PrivateKey::parse(std::string_view text) {
  PrivateKey key;
  if (!decode_base64url(text, key.bytes_) || !is_scalar(to_bignum(key.bytes_).get()))
    return std::nullopt;
  return key;
}

std::string PrivateKey::text() const { return base64url(bytes_); }

PublicKey PrivateKey::public_key() const {
  const NumberContext context(BN_CTX_secure_new());
  const Number number = to_bignum(bytes_);
  const Point point(EC_POINT_new(curve()));
  PublicKey key;
  const bool is_done =
      point &&
      EC_POINT_mul(curve(), point.get(), number.get(), nullptr, nullptr, context.get()) == 1 &&
      EC_POINT_point2oct(curve(), point.get(), POINT_CONVERSION_COMPRESSED, key.bytes_.data(),
                         key.bytes_.size(), context.get()) == PublicKey::kBytes;
  DANCE_ASSERT(is_done);
  return key;
}

std::string PrivateKey::fingerprint() const {
  // The label keeps these digits different from those of any other use of the key.
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

bool PrivateKey::operator==(const PrivateKey& o) const {
  return CRYPTO_memcmp(bytes_.data(), o.bytes_.data(), kBytes) == 0;
}

bool shared_secret(const PrivateKey& own, const PublicKey& other, std::span<std::uint8_t, 32> x) {
  const NumberContext context(BN_CTX_secure_new());
  const Number number = to_bignum(own.bytes_), product_x(BN_secure_new());
  const Point point = decode_point(other, context.get()), product(EC_POINT_new(curve()));
  return point && product &&
         EC_POINT_mul(curve(), product.get(), nullptr, point.get(), number.get(), context.get()) ==
             1 &&
         EC_POINT_get_affine_coordinates(curve(), product.get(), product_x.get(), nullptr,
                                         context.get()) == 1 &&
         BN_bn2binpad(product_x.get(), x.data(), static_cast<int>(x.size())) > 0;
}

namespace {

// Holds one or two shared secrets, and wipes them when it ends.
struct Secrets {
  std::array<std::uint8_t, 64> bytes{};
  std::size_t size = 0;
  Secrets() = default;
  Secrets(const Secrets&) = delete;
  Secrets& operator=(const Secrets&) = delete;
  ~Secrets() { OPENSSL_cleanse(bytes.data(), bytes.size()); }
  bool add(const PrivateKey& own, const PublicKey& other) {
    size += 32;
    return shared_secret(own, other, std::span(bytes).subspan(size - 32).first<32>());
  }
  std::span<const std::uint8_t> whole() const { return {bytes.data(), size}; }
};

}  // namespace

std::optional<PresharedKey> house_session_key(const PrivateKey& house,
                                              const std::optional<PrivateKey>& grant,
                                              const PublicKey& server) {
  Secrets secrets;
  if (!secrets.add(house, server) || (grant && !secrets.add(*grant, server))) return std::nullopt;
  const PublicKey own = house.public_key();
  return session_key(secrets.whole(), server, own, grant ? grant->public_key() : own);
}

std::optional<PresharedKey> server_session_key(const PrivateKey& server,
                                               const PublicKey& server_key, const PublicKey& house,
                                               const PublicKey& admitted) {
  Secrets secrets;
  if (!secrets.add(server, house) || (admitted != house && !secrets.add(server, admitted)))
    return std::nullopt;
  return session_key(secrets.whole(), server_key, house, admitted);
}

std::string identity_text(std::string_view name, const PublicKey& house) {
  return std::string(name) + ":" + house.text();
}

NamedIdentity parse_identity(std::string_view text) {
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos) return {text, std::nullopt};
  if (const auto key = PublicKey::parse(text.substr(colon + 1)))
    return {text.substr(0, colon), key};
  return {text, std::nullopt};
}

}  // namespace dance
