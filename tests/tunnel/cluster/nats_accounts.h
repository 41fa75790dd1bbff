// An operator, accounts and users as NATS has them without passwords: Ed25519 keys, and JWTs that
// each level signs for the next. Written from the published formats of nkeys and of NATS's JWT 2.
//
// Units/frames: none.
// Ownership:    owns its keys.
// Threads:      none inside.
// Failure:      a call of OpenSSL that fails fails the test.
#pragma once

#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dance {

class NatsKey {
 public:
  enum class Role : std::uint8_t { kAccount = 0, kOperator = 14 << 3, kUser = 20 << 3 };

  explicit NatsKey(Role role) : role_(role), key_(EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519")) {
    EXPECT_TRUE(key_);
  }

  std::string name() const {
    std::array<unsigned char, 32> raw{};
    std::size_t size = raw.size();
    EXPECT_EQ(EVP_PKEY_get_raw_public_key(key_.get(), raw.data(), &size), 1);
    std::vector<unsigned char> bytes{static_cast<unsigned char>(role_)};
    bytes.insert(bytes.end(), raw.begin(), raw.end());
    return checked_base32(bytes);
  }
  std::string seed() const {
    constexpr unsigned char kSeed = 18 << 3;
    std::array<unsigned char, 32> raw{};
    std::size_t size = raw.size();
    EXPECT_EQ(EVP_PKEY_get_raw_private_key(key_.get(), raw.data(), &size), 1);
    const auto role = static_cast<unsigned char>(role_);
    std::vector<unsigned char> bytes{static_cast<unsigned char>(kSeed | role >> 5),
                                     static_cast<unsigned char>((role & 31) << 3)};
    bytes.insert(bytes.end(), raw.begin(), raw.end());
    return checked_base32(bytes);
  }
  // Says of `subject` what stands in `claims`.
  std::string jwt(const std::string& subject, const std::string& type,
                  nlohmann::json claims = nlohmann::json::object()) const {
    claims["type"] = type;
    claims["version"] = 2;
    const nlohmann::json head{{"typ", "JWT"}, {"alg", "ed25519-nkey"}};
    const nlohmann::json body{{"jti", "1"},   {"iat", 1},       {"iss", name()},
                              {"name", type}, {"sub", subject}, {"nats", claims}};
    const std::string text = base64(head.dump()) + "." + base64(body.dump());
    return text + "." + base64(signature(text));
  }

 private:
  struct Free {
    void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };

  std::string signature(const std::string& text) const {
    const std::unique_ptr<EVP_MD_CTX, Free> context(EVP_MD_CTX_new());
    std::array<unsigned char, 64> made{};
    std::size_t size = made.size();
    EXPECT_EQ(EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key_.get()), 1);
    EXPECT_EQ(EVP_DigestSign(context.get(), made.data(), &size,
                             reinterpret_cast<const unsigned char*>(text.data()), text.size()),
              1);
    return {made.begin(), made.begin() + static_cast<std::ptrdiff_t>(size)};
  }
  // For URLs, without padding.
  static std::string base64(const std::string& bytes) {
    std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
    const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
    text.resize(std::min(static_cast<std::size_t>(size), text.find('=')));
    for (char& c : text) c = c == '+' ? '-' : c == '/' ? '_' : c;
    return text;
  }
  // With CRC-16 (XMODEM) behind it, low byte first.
  static std::string checked_base32(std::vector<unsigned char> bytes) {
    unsigned crc = 0;
    for (const unsigned char byte : bytes) {
      crc ^= static_cast<unsigned>(byte) << 8;
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000u) != 0 ? crc << 1 ^ 0x1021u : crc << 1;
      crc &= 0xffffu;
    }
    bytes.push_back(static_cast<unsigned char>(crc & 255u));
    bytes.push_back(static_cast<unsigned char>(crc >> 8));
    std::string text;
    unsigned held = 0, bits = 0;
    for (const unsigned char byte : bytes) {
      held = held << 8 | byte;
      for (bits += 8; bits >= 5; bits -= 5) text += kDigits[held >> (bits - 5) & 31u];
    }
    if (bits > 0) text += kDigits[held << (5 - bits) & 31u];
    return text;
  }
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";

  Role role_;
  std::unique_ptr<EVP_PKEY, Free> key_;
};

}  // namespace dance
