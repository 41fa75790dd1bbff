// Identity keys: texts, points, and the secrets that two sides agree on.
#include "tunnel/seal/keys/identity_key.h"

#include <gtest/gtest.h>

#include "tunnel/seal/keys/base64url.h"

namespace dance {
namespace {

std::vector<std::uint8_t> bytes_of_hex(std::string_view hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  return bytes;
}

std::string fmt_hex(std::uint8_t byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  return {kDigits[byte >> 4], kDigits[byte & 15]};
}

TEST(Base64url, DecodesOnlyWhatItEncodes) {
  EXPECT_EQ(base64url({}), "");
  const std::vector<std::uint8_t> bytes{0xfb, 0xff, 0x00, 0x10};
  EXPECT_EQ(base64url(bytes), "-_8AEA");
  std::vector<std::uint8_t> back(bytes.size());
  ASSERT_TRUE(decode_base64url("-_8AEA", back));
  EXPECT_EQ(back, bytes);
  for (const char* wrong : {"-_8AEB", "-_8AE", "-_8AEA=", "+/8AEA", "-_8AE ", "-_8AEAA"})
    EXPECT_FALSE(decode_base64url(wrong, back)) << wrong;
}

TEST(PrivateKey, ParsesOnlyItsOwnText) {
  for (int i = 0; i < 50; ++i) {
    const PrivateKey key = PrivateKey::make();
    const std::string text = key.text();
    ASSERT_EQ(text.size(), PrivateKey::kTextLength);
    ASSERT_TRUE(PrivateKey::parse(text));
    EXPECT_TRUE(*PrivateKey::parse(text) == key);
    EXPECT_FALSE(PrivateKey::parse(text.substr(1)));
    EXPECT_FALSE(PrivateKey::parse(text + "A"));
  }
  EXPECT_FALSE(PrivateKey::parse(std::string(43, 'A'))) << "zero";
  EXPECT_FALSE(PrivateKey::parse(std::string(42, '_') + "8")) << "above the order of the curve";
}

TEST(PublicKey, IsAPointOfTheCurve) {
  // The scalar 1 gives the base point (FIPS 186-5, P-256).
  const auto base = PrivateKey::parse(std::string(42, 'A') + "E")->public_key();
  EXPECT_EQ(base.text(), base64url(bytes_of_hex("036b17d1f2e12c4247f8bce6e563a440f2"
                                                "77037d812deb33a0f4a13945d898c296")));
  EXPECT_TRUE(base.is_on_curve());
  const auto back = PublicKey::parse(base.text());
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, base);
  EXPECT_FALSE(PublicKey::parse(std::string(44, 'A'))) << "no form of a point";
  EXPECT_FALSE(PublicKey::parse(base.text().substr(1)));
  // About every second x is on the curve; the others let nobody in.
  int off = 0;
  for (char c = 'A'; c <= 'Z'; ++c) {
    std::string text = base.text();
    text[20] = c;
    const auto key = PublicKey::parse(text);
    ASSERT_TRUE(key);
    if (key->is_on_curve()) continue;
    ++off;
    const PrivateKey own = PrivateKey::make();
    EXPECT_FALSE(house_session_key(own, std::nullopt, *key));
    EXPECT_FALSE(server_session_key(own, own.public_key(), *key, *key));
    EXPECT_FALSE(server_session_key(own, own.public_key(), own.public_key(), *key));
  }
  EXPECT_GT(off, 3);
  EXPECT_FALSE(PublicKey().is_set());
  EXPECT_FALSE(PublicKey().is_on_curve());
  EXPECT_FALSE(house_session_key(PrivateKey::make(), std::nullopt, PublicKey()));
}

// First case of P-256 in NIST's test vectors for ECC CDH (SP 800-56A).
TEST(IdentityKey, MatchesTheTestVectorOfNist) {
  const auto own = PrivateKey::parse(
      base64url(bytes_of_hex("7d7dc5f71eb29ddaf80d6214632eeae03d9058af1fb6d22ed80badb62bc1a534")));
  const auto other = PublicKey::parse(base64url(
      bytes_of_hex("02700c48f77f56584c5cc632ca65640db91b6bacce3a4df6b42ce7cc838833d287")));
  ASSERT_TRUE(own && other);
  // The other's y is odd or even; both points have one x in the product.
  std::array<std::uint8_t, 32> secret{};
  ASSERT_TRUE(shared_secret(*own, *other, secret));
  EXPECT_EQ(std::vector<std::uint8_t>(secret.begin(), secret.end()),
            bytes_of_hex("46fc62106420ff012e54a434fbdd2d25ccc5852060561e68040dd7778997bd7b"));
  EXPECT_EQ(own->public_key().text().substr(2),
            base64url(bytes_of_hex("02ead218590119e8876b29146ff89ca617"
                                   "70c4edbbf97d38ce385ed281d8a6b230"))
                .substr(2));
}

// Computed by another program, from docs/wire-format.md.
TEST(IdentityKey, DerivesTheKeyThatTheWireFormatDefines) {
  const auto scalar = [](char last) { return *PrivateKey::parse(std::string(42, 'A') + last); };
  const PrivateKey house = scalar('E'), server = scalar('I'), grant = scalar('M');  // 1, 2, 3
  const auto hex = [](const std::optional<PresharedKey>& key) {
    std::string text;
    for (const std::uint8_t byte : key.value().bytes()) text += fmt_hex(byte);
    return text;
  };
  EXPECT_EQ(hex(house_session_key(house, std::nullopt, server.public_key())),
            "f8967e2a2f277b63fb910360d5c33282cc6782492e7d4b6d98a7f4ca67706e45");
  EXPECT_EQ(hex(house_session_key(house, grant, server.public_key())),
            "bcb0aef13641039ec7e9a30a9baa2b2f69cac94fd02aa3e419de2fe6eea8ed29");
}

TEST(IdentityKey, HouseAndServerComputeOneKeyAndNobodyElseDoes) {
  const PrivateKey house = PrivateKey::make(), server = PrivateKey::make(),
                   grant = PrivateKey::make(), other = PrivateKey::make();
  const auto own = house_session_key(house, std::nullopt, server.public_key());
  ASSERT_TRUE(own);
  EXPECT_TRUE(*own == *server_session_key(server, server.public_key(), house.public_key(),
                                          house.public_key()));
  const auto granted = house_session_key(house, grant, server.public_key());
  ASSERT_TRUE(granted);
  EXPECT_TRUE(*granted == *server_session_key(server, server.public_key(), house.public_key(),
                                              grant.public_key()));
  EXPECT_FALSE(*own == *granted);
  // Another holder of the grant, another server, and a server that knows all public keys.
  EXPECT_FALSE(*granted == *house_session_key(other, grant, server.public_key()));
  EXPECT_FALSE(*granted == *house_session_key(house, other, server.public_key()));
  EXPECT_FALSE(*granted == *server_session_key(other, other.public_key(), house.public_key(),
                                               grant.public_key()));
  EXPECT_FALSE(*granted == *server_session_key(grant, grant.public_key(), house.public_key(),
                                               server.public_key()));
  EXPECT_FALSE(*own == *server_session_key(other, other.public_key(), house.public_key(),
                                           house.public_key()));
}

TEST(IdentityKey, SplitsATextIntoNameAndKey) {
  const PublicKey key = PrivateKey::make().public_key();
  const std::string text = identity_text("invited:alice", key);
  const NamedIdentity named = parse_identity(text);
  EXPECT_EQ(named.name, "invited:alice");
  EXPECT_EQ(named.house, key);
  for (const std::string& without :
       {std::string("local"), std::string(), "alice:" + key.text() + "A", std::string("alice:"),
        key.text()}) {
    EXPECT_EQ(parse_identity(without).name, without);
    EXPECT_FALSE(parse_identity(without).house);
  }
}

}  // namespace
}  // namespace dance
