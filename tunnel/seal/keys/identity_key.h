// Identity keys. Each house and each server has a P-256 key pair and publishes only the public
// half. A session is authenticated by a secret that takes one of the two private keys to compute:
// the server proves its identity to the house with it, and the house to the server.
//
// An invitation, and the key of a room, is a key pair too (a grant), whose private half is in the
// text that its holders were sent. A session that a grant opens rests on both: on the grant, which
// opens the room, and on the house's identity, which nobody else who holds the grant has.
//
// Ownership: plain values; private keys are wiped when they go.
// Threads:   none inside.
// Failure:   parse() gives nullopt for what text() never writes; make() panics only where the
//            kernel has no random numbers.
// Source:    P-256 as in FIPS 186-5; points as in SEC 1, 2.3.3; key agreement as in NIST SP 800-56A
//            (static, ECC CDH), derivation with HKDF (RFC 5869, SHA-256).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tunnel/seal/keys/preshared_key.h"

namespace dance {

class PublicKey {
 public:
  static constexpr std::size_t kBytes = 33;  // a compressed point
  static constexpr std::size_t kTextLength = 44;

  PublicKey() = default;  // not set
  // Takes any x coordinate; is_on_curve() checks it, at the price of a square root.
  static std::optional<PublicKey> parse(std::string_view text);
  std::string text() const;

  bool is_set() const { return bytes_[0] != 0; }
  bool is_on_curve() const;
  const std::array<std::uint8_t, kBytes>& bytes() const { return bytes_; }
  bool operator==(const PublicKey&) const = default;

 private:
  friend class PrivateKey;
  std::array<std::uint8_t, kBytes> bytes_{};
};

class PrivateKey {
 public:
  static constexpr std::size_t kBytes = 32;
  static constexpr std::size_t kTextLength = 43;

  PrivateKey() = default;  // not set: only to be assigned to
  static PrivateKey make();
  static std::optional<PrivateKey> parse(std::string_view text);
  PrivateKey(const PrivateKey&) = default;
  PrivateKey& operator=(const PrivateKey&) = default;
  ~PrivateKey();
  // The text that a JSON Web Key has as "d".
  std::string text() const;

  PublicKey public_key() const;
  // Name of this key for files that must not contain it: kFingerprintLength hexadecimal digits.
  static constexpr std::size_t kFingerprintLength = 16;
  std::string fingerprint() const;
  bool operator==(const PrivateKey& o) const;

 private:
  friend bool shared_secret(const PrivateKey& own, const PublicKey& other,
                            std::span<std::uint8_t, 32> x);
  std::array<std::uint8_t, kBytes> bytes_{};
};

// ECDH: writes the x coordinate of the shared point; false where `other` is no point of the curve.
bool shared_secret(const PrivateKey& own, const PublicKey& other, std::span<std::uint8_t, 32> x);

// The key that authenticates a session between a house and a server, as the house computes it.
// `grant`: what lets it in, where that is not its own identity. nullopt: `server` is no point of
// the curve.
std::optional<PresharedKey> house_session_key(const PrivateKey& house,
                                              const std::optional<PrivateKey>& grant,
                                              const PublicKey& server);
// The same key, as the server computes it. `server_key`: the public half of `server`. `admitted`:
// the house's own key or that of a grant.
std::optional<PresharedKey> server_session_key(const PrivateKey& server,
                                               const PublicKey& server_key, const PublicKey& house,
                                               const PublicKey& admitted);

// The identity of a house in a handshake: NAME:KEY.
std::string identity_text(std::string_view name, const PublicKey& house);
struct NamedIdentity {
  std::string_view name;
  std::optional<PublicKey> house;  // nothing: the text has no key
};
NamedIdentity parse_identity(std::string_view text);

}  // namespace dance
