// What all sealed sessions of a server, or of a link, have in common: DTLS 1.2 of OpenSSL with
// ephemeral keys (X25519 or P-256) and ChaCha20-Poly1305, authenticated by a key that both sides
// derive from their identity keys (identity_key.h), or by certificates.
//
// Units/frames: none.
// Ownership:    owns the SSL_CTX; channels made from it hold it too.
// Threads:      none inside; one owner.
// Failure:      make_…() names the file that OpenSSL refused and its reason.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/result.h"
#include "tunnel/seal/keys/identity_key.h"

struct ssl_ctx_st;
struct ssl_st;

namespace dance {

// PEM files. A server shows its chain and asks links for theirs where it has `authorities`; a link
// checks the server's against `authorities` (empty = the system's) and the server's name. A file of
// authorities may hold their revocation lists (CRLs): then certificates without a valid list, and
// revoked ones, are refused.
struct SealCertificates {
  std::string chain;
  std::string private_key;
  std::string authorities;
};

class SealContext {
 public:
  // Called in handshakes with what the other side calls itself; nullopt: nobody of that name.
  using FindKey = std::function<std::optional<PresharedKey>(ssl_st*, std::string_view identity)>;
  // Whether a cookie is the one that this handshake was given, and the one to give.
  struct Cookies {
    std::function<std::size_t(ssl_st*, std::uint8_t* out)> make;  // at most 64 bytes
    std::function<bool(ssl_st*, const std::uint8_t* cookie, std::size_t size)> check;
  };

  // `server_key`: the key that the server claims; a handshake proves it.
  static Result<std::unique_ptr<SealContext>> for_server(
      const PublicKey& server_key, FindKey find_key, Cookies cookies,
      const std::optional<SealCertificates>& certificates);
  // `server`: the key that the server must name; not set: any, as on the house's own machine.
  static Result<std::unique_ptr<SealContext>> for_link(std::string identity,
                                                       const PresharedKey& key,
                                                       const PublicKey& server);
  static Result<std::unique_ptr<SealContext>> for_link(const SealCertificates& certificates,
                                                       const std::string& server_name);
  ~SealContext();
  SealContext(const SealContext&) = delete;
  SealContext& operator=(const SealContext&) = delete;

  ssl_ctx_st* get() const { return context_; }

  // OpenSSL's side of the calls above.
  std::optional<PresharedKey> find_key(ssl_st* ssl, std::string_view identity) const {
    return find_key_(ssl, identity);
  }
  const Cookies& cookies() const { return cookies_; }
  const std::string& identity() const { return identity_; }
  const PresharedKey& key() const { return key_; }
  // Whether the key that a server names is the one that this house knows. If not, the link sends no
  // identity.
  bool check_server_key(std::string_view text);
  // True once after a server named another key.
  bool take_key_mismatch() { return std::exchange(has_key_mismatch_, false); }

 private:
  explicit SealContext(bool is_server);
  Result<void> use(const SealCertificates& certificates);

  ssl_ctx_st* context_;
  FindKey find_key_;
  Cookies cookies_;
  std::string identity_;
  PresharedKey key_;
  PublicKey server_key_;
  bool has_key_mismatch_ = false;
};

}  // namespace dance
