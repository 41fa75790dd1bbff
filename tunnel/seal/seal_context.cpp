#include "tunnel/seal/seal_context.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <cstring>

#include "core/base/assert.h"
#include "tunnel/seal/seal_format.h"

namespace dance {
namespace {

constexpr const char* kKeyCiphers = "ECDHE-PSK-CHACHA20-POLY1305";
constexpr const char* kCertificateCiphers =
    "ECDHE-ECDSA-CHACHA20-POLY1305:ECDHE-RSA-CHACHA20-POLY1305";
constexpr std::size_t kMaxCookie = 64;

SealContext& context_of(SSL* ssl) {
  return *static_cast<SealContext*>(SSL_CTX_get_app_data(SSL_get_SSL_CTX(ssl)));
}

unsigned int give_key(const PresharedKey& key, unsigned char* out, unsigned int room) {
  if (room < PresharedKey::kBytes) return 0;
  std::copy(key.bytes().begin(), key.bytes().end(), out);
  return PresharedKey::kBytes;
}

unsigned int on_server_key(SSL* ssl, const char* identity, unsigned char* out, unsigned int room) {
  const auto key = context_of(ssl).find_key(ssl, identity);
  // Who asks for a name that we do not know learns no more than who has the wrong key.
  return give_key(key ? *key : PresharedKey::make(), out, room);
}

unsigned int on_link_key(SSL* ssl, const char* server_key, char* identity,
                         unsigned int identity_room, unsigned char* out, unsigned int room) {
  SealContext& context = context_of(ssl);
  if (!context.check_server_key(server_key != nullptr ? server_key : "")) return 0;
  if (context.identity().size() + 1 > identity_room) return 0;
  std::memcpy(identity, context.identity().c_str(), context.identity().size() + 1);
  return give_key(context.key(), out, room);
}

int on_make_cookie(SSL* ssl, unsigned char* cookie, unsigned int* size) {
  *size = static_cast<unsigned int>(context_of(ssl).cookies().make(ssl, cookie));
  DANCE_ASSERT(*size <= kMaxCookie, *size);
  return *size > 0 ? 1 : 0;
}

int on_check_cookie(SSL* ssl, const unsigned char* cookie, unsigned int size) {
  return context_of(ssl).cookies().check(ssl, cookie, size) ? 1 : 0;
}

std::string last_reason() {
  const unsigned long error = ERR_peek_last_error();
  const char* reason = ERR_reason_error_string(error);
  ERR_clear_error();
  return reason != nullptr ? reason : "no reason given";
}

Result<void> set_ciphers(SSL_CTX* context, const std::string& ciphers) {
  if (SSL_CTX_set_cipher_list(context, ciphers.c_str()) != 1)
    return fail("OpenSSL has none of the ciphers " + ciphers + ": install Debian's libssl3");
  return {};
}

// If the authorities' file has revocation lists too, each certificate of a chain must be covered by
// one that is not out of date.
void check_revocation(SSL_CTX* context) {
  X509_STORE* store = SSL_CTX_get_cert_store(context);
  const STACK_OF(X509_OBJECT)* objects = X509_STORE_get0_objects(store);
  for (int i = 0; i < sk_X509_OBJECT_num(objects); ++i)
    if (X509_OBJECT_get_type(sk_X509_OBJECT_value(objects, i)) == X509_LU_CRL) {
      X509_STORE_set_flags(store, X509_V_FLAG_CRL_CHECK | X509_V_FLAG_CRL_CHECK_ALL);
      return;
    }
}

}  // namespace

SealContext::SealContext(bool is_server)
    : context_(SSL_CTX_new(is_server ? DTLS_server_method() : DTLS_client_method())) {
  DANCE_ASSERT(context_ != nullptr);
  SSL_CTX_set_app_data(context_, this);
  SSL_CTX_set_min_proto_version(context_, DTLS1_2_VERSION);
  SSL_CTX_set_max_proto_version(context_, DTLS1_2_VERSION);
  SSL_CTX_set_options(context_, SSL_OP_NO_QUERY_MTU | SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_TICKET |
                                    SSL_OP_NO_COMPRESSION);
  SSL_CTX_set_session_cache_mode(context_, SSL_SESS_CACHE_OFF);
}

SealContext::~SealContext() { SSL_CTX_free(context_); }

Result<std::unique_ptr<SealContext>> SealContext::for_server(
    const PublicKey& server_key, FindKey find_key, Cookies cookies,
    const std::optional<SealCertificates>& certificates) {
  auto made = std::unique_ptr<SealContext>(new SealContext(true));
  made->find_key_ = std::move(find_key);
  made->cookies_ = std::move(cookies);
  SSL_CTX* context = made->context_;
  SSL_CTX_set_options(context, SSL_OP_COOKIE_EXCHANGE | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_cookie_generate_cb(context, on_make_cookie);
  SSL_CTX_set_cookie_verify_cb(context, on_check_cookie);
  SSL_CTX_set_psk_server_callback(context, on_server_key);
  const int hinted = SSL_CTX_use_psk_identity_hint(context, server_key.text().c_str());
  DANCE_ASSERT(hinted == 1, hinted);
  std::string ciphers = kKeyCiphers;
  if (certificates) {
    if (auto used = made->use(*certificates); !used) return tl::make_unexpected(used.error());
    ciphers += std::string(":") + kCertificateCiphers;
    SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
  }
  if (auto set = set_ciphers(context, ciphers); !set) return tl::make_unexpected(set.error());
  return made;
}

Result<std::unique_ptr<SealContext>> SealContext::for_link(std::string identity,
                                                           const PresharedKey& key,
                                                           const PublicKey& server) {
  auto made = std::unique_ptr<SealContext>(new SealContext(false));
  made->identity_ = std::move(identity);
  made->key_ = key;
  made->server_key_ = server;
  SSL_CTX_set_psk_client_callback(made->context_, on_link_key);
  if (auto set = set_ciphers(made->context_, kKeyCiphers); !set)
    return tl::make_unexpected(set.error());
  return made;
}

Result<std::unique_ptr<SealContext>> SealContext::for_link(const SealCertificates& certificates,
                                                           const std::string& server_name) {
  auto made = std::unique_ptr<SealContext>(new SealContext(false));
  if (auto used = made->use(certificates); !used) return tl::make_unexpected(used.error());
  if (auto set = set_ciphers(made->context_, kCertificateCiphers); !set)
    return tl::make_unexpected(set.error());
  SSL_CTX_set_verify(made->context_, SSL_VERIFY_PEER, nullptr);
  X509_VERIFY_PARAM* check = SSL_CTX_get0_param(made->context_);
  // A number is an address, which certificates list apart from names.
  if (X509_VERIFY_PARAM_set1_ip_asc(check, server_name.c_str()) != 1 &&
      X509_VERIFY_PARAM_set1_host(check, server_name.c_str(), 0) != 1)
    return fail("'" + server_name + "' is no name that a certificate could bear");
  ERR_clear_error();
  return made;
}

bool SealContext::check_server_key(std::string_view text) {
  if (!server_key_.is_set() || PublicKey::parse(text) == server_key_) return true;
  has_key_mismatch_ = true;
  return false;
}

Result<void> SealContext::use(const SealCertificates& certificates) {
  ERR_clear_error();
  if (SSL_CTX_use_certificate_chain_file(context_, certificates.chain.c_str()) != 1)
    return fail("certificate " + certificates.chain + ": " + last_reason() +
                "; a PEM file with the certificate first is wanted");
  if (SSL_CTX_use_PrivateKey_file(context_, certificates.private_key.c_str(), SSL_FILETYPE_PEM) !=
          1 ||
      SSL_CTX_check_private_key(context_) != 1)
    return fail("private key " + certificates.private_key + ": " + last_reason() +
                "; the PEM file that belongs to " + certificates.chain + " is wanted");
  const bool is_trust_there =
      certificates.authorities.empty()
          ? SSL_CTX_set_default_verify_paths(context_) == 1
          : SSL_CTX_load_verify_locations(context_, certificates.authorities.c_str(), nullptr) == 1;
  if (!is_trust_there)
    return fail("authorities " + certificates.authorities + ": " + last_reason() +
                "; a PEM file of certificates is wanted");
  check_revocation(context_);
  return {};
}

}  // namespace dance
