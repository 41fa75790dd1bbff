// Certificates in the stead of keys.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/apps/run_program.h"
#include "tests/tunnel/seal/paper.h"
#include "tests/tunnel/seal/sealed_street.h"

namespace dance {
namespace {

class SealCertificate : public ::testing::Test {
 protected:
  void SetUp() override {
    ours = std::make_unique<Authority>(folder, "ours");
    ours->sign("server", "DNS:dance.example.org,IP:192.0.2.1");
    ours->sign("alice", "");
    street.certificates = of("server");
    street.certificates->authorities = ours->file;
    street.start_server();
  }
  SealCertificates of(const std::string& name) const {
    return {folder + "/" + name + ".pem", folder + "/" + name + ".key", ours->file};
  }
  SealedStreet::House& house(const SealCertificates& paper, const std::string& server) {
    auto context = SealContext::for_link(paper, server);
    EXPECT_TRUE(context) << context.error().what;
    return street.add_house(std::move(*context));
  }

  const TestFolder own{"papers"};
  const std::string folder = own.path();
  std::unique_ptr<Authority> ours;
  const GuestKey bob = key_of("bob");
  SealedStreet street{{bob}};
};

TEST_F(SealCertificate, LetsInUnderItsCommonNameBesideKeys) {
  auto& a = house(of("alice"), "dance.example.org");
  auto& numbered = house(of("alice"), "192.0.2.1");
  auto& b = street.add_house("bob", bob.own);
  street.run(Duration::ms(50));
  EXPECT_EQ(a.sealed, 1);
  EXPECT_EQ(numbered.sealed, 1);
  EXPECT_EQ(b.sealed, 1);
  EXPECT_EQ(a.client->cipher(), "ECDHE-ECDSA-CHACHA20-POLY1305");
  street.say(a, "hello");
  street.run(Duration::ms(5));
  ASSERT_EQ(street.heard.size(), 1u);
  EXPECT_EQ(street.heard[0].name, "alice");
  // No datagram of a handshake is longer than a path carries, however long the papers.
  for (const auto& passed : street.sent) EXPECT_LE(passed.bytes.size(), seal::kMaxSealed);
}

TEST_F(SealCertificate, OfAServerOfAnotherNameIsNotTrusted) {
  auto& a = house(of("alice"), "dance.example.com");
  street.run(Duration::ms(50));
  EXPECT_EQ(a.sealed, 0);
  ASSERT_FALSE(a.troubles.empty());
  EXPECT_EQ(a.troubles[0], SealTrouble::kNotTrusted);
  EXPECT_EQ(street.server->peer_count(), 0u);
}

TEST_F(SealCertificate, OfAnotherAuthorityLetsNobodyIn) {
  Authority theirs(folder, "theirs");
  theirs.sign("mallory", "");
  auto& m =
      house({folder + "/mallory.pem", folder + "/mallory.key", ours->file}, "dance.example.org");
  street.run(Duration::ms(50));
  EXPECT_EQ(m.sealed, 0);
  EXPECT_EQ(street.server->peer_count(), 0u);
  EXPECT_EQ(street.server->counters().of(SealReject::kNoAgreement), 1u);
  // And a server that another authority signed is not the one.
  auto& a = house({folder + "/alice.pem", folder + "/alice.key", theirs.file}, "dance.example.org");
  street.run(Duration::ms(50));
  EXPECT_EQ(a.sealed, 0);
}

TEST_F(SealCertificate, RevokedOnesAndExpiredListsAreRefused) {
  ours->sign("carol", "");
  const auto sealed = [&](const std::string& name) {
    auto& there = house(of(name), "dance.example.org");
    street.run(Duration::ms(50));
    return there.sealed;
  };
  street.certificates->authorities = ours->write_revocations("alice", 3600);
  street.start_server();
  EXPECT_EQ(sealed("alice"), 0);
  EXPECT_EQ(sealed("carol"), 1);
  // A link reads such a file too: a server's certificate can be revoked.
  SealCertificates of_link = of("carol");
  of_link.authorities = ours->write_revocations("server", 3600);
  auto& wary = house(of_link, "dance.example.org");
  street.run(Duration::ms(50));
  EXPECT_EQ(wary.sealed, 0);
  // A list that is out of date lacks the certificates that were revoked since.
  street.certificates->authorities = ours->write_revocations("", -60);
  street.start_server();
  EXPECT_EQ(sealed("carol"), 0);
}

TEST_F(SealCertificate, WithoutAGuestsNameLetsNobodyIn) {
  ours->sign("Not A Name", "");
  auto& a = house(of("Not A Name"), "dance.example.org");
  street.run(Duration::ms(50));
  EXPECT_EQ(street.server->counters().of(SealReject::kUnknownName), 1u);
  street.say(a, "hello");
  street.run(Duration::ms(5));
  EXPECT_TRUE(street.heard.empty());
}

TEST_F(SealCertificate, BadFilesAreNamed) {
  const auto says = [](const Result<std::unique_ptr<SealContext>>& made, const std::string& part) {
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().what.find(part), std::string::npos) << made.error().what;
  };
  SealCertificates paper = of("nobody");
  says(SealContext::for_link(paper, "x.org"), "certificate " + folder + "/nobody.pem");
  paper = of("alice");
  paper.private_key = folder + "/server.key";
  says(SealContext::for_link(paper, "x.org"), "private key " + folder + "/server.key");
  paper = of("alice");
  std::ofstream(folder + "/garbage.pem") << "-----BEGIN CERTIFICATE-----\nAAAA\n";
  paper.authorities = folder + "/garbage.pem";
  says(SealContext::for_link(paper, "x.org"), "authorities " + folder + "/garbage.pem");
}

}  // namespace
}  // namespace dance
