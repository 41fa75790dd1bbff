// A house opens an invitation, with a server that answers from its file, or does not: whatever ends
// when, the house gets in with one key, and nobody else does.
#include "tunnel/invitation/open_invitation.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/test_folder.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/seal/keys/utc_text.h"
#include "tunnel/server/program/key_store.h"

namespace dance {
namespace {

class OpenedInAHouse : public ::testing::Test {
 protected:
  void SetUp() override {
    invitation_.host = "dance.example.org";
    invitation_.room = *GuestId::parse("salsa");
    invitation_.guest = *GuestId::parse("alice");
    invitation_.server_key = *server_->claim_server_key();
    invitation_.key = PrivateKey::make();
    invitation_.until_s = utc_now_s() / 60 * 60 + 3600;
    KeyEntry entry;
    entry.name = invitation_.guest;
    entry.room = invitation_.room;
    entry.has_key = false;
    entry.invitation =
        InvitationKey{invitation_.key.public_key(), invitation_.until_s, InvitationState::kOpen};
    ASSERT_TRUE(*server_->invite(entry));
  }
  OpenInvitation house(const std::string& name) {
    OpenInvitation how;
    how.folder = folder_.path(name);
    how.now_s = utc_now_s();
    how.ask = [this](const Invitation&, const PrivateKey& house, Duration) {
      ++asked_;
      return server_->bind("alice", house.public_key());
    };
    return how;
  }
  std::string keys_of(const std::string& name) {
    return read_secret(folder_.path(name + "/keys"))->value_or("");
  }
  bool is_let_in(const std::string& name) {
    const auto ring = server_->read();
    const KeyEntry* entry = ring->find("alice");
    const auto keys = HouseKeys::parse(keys_of(name), "keys");
    const HouseKey* key = keys->find("dance.example.org:7400", invitation_.room, invitation_.guest);
    return entry != nullptr && key != nullptr && key->server_key == *server_->claim_server_key() &&
           house_identity(folder_.path(name))->public_key() == entry->key;
  }

  TestFolder folder_{"open-invitation"};
  std::unique_ptr<KeyStore> server_ = file_key_store(folder_.path("server/server-keys"));
  Invitation invitation_;
  int asked_ = 0;
};

TEST_F(OpenedInAHouse, TheKeyIsKeptAndTheInvitationIsNot) {
  const auto opened = open_invitation(invitation_, house("alice"));
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_EQ(*opened, Opened::kNow);
  EXPECT_TRUE(is_let_in("alice"));
  const std::string invitations = *read_secret(folder_.path("alice/invitations")).value();
  EXPECT_EQ((keys_of("alice") + invitations).find(invitation_.key.text()), std::string::npos);
  EXPECT_EQ(invitations.find("dance-key:"), std::string::npos) << invitations;
}

TEST_F(OpenedInAHouse, TwiceOnTheSameMachineItAsksOnce) {
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  OpenInvitation again = house("alice");
  again.now_s = invitation_.until_s + 86'400;  // its key is good for longer
  const auto opened = open_invitation(invitation_, again);
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_EQ(*opened, Opened::kBefore);
  EXPECT_EQ(asked_, 1);
}

TEST_F(OpenedInAHouse, IsKnownOnlyWithTheKeyThatTheServerAccepted) {
  const std::string folder = folder_.path("alice");
  EXPECT_FALSE(*was_opened_before(invitation_, folder));
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  EXPECT_TRUE(*was_opened_before(invitation_, folder));
  Invitation other = invitation_;
  other.key = PrivateKey::make();
  EXPECT_FALSE(*was_opened_before(other, folder)) << "a link that anybody could have made";
  other = invitation_;
  other.host = "stranger.example.org";
  EXPECT_FALSE(*was_opened_before(other, folder));
  EXPECT_FALSE(*was_opened_before(invitation_, folder_.path("bob")));
}

TEST_F(OpenedInAHouse, StopsAtAnInvitationThatNamesAnotherKeyOfAKnownServer) {
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  Invitation forged = invitation_;
  forged.key = PrivateKey::make();
  forged.room = *GuestId::parse("tango");
  forged.server_key = PrivateKey::make().public_key();
  const auto opened = open_invitation(forged, house("alice"));
  ASSERT_FALSE(opened);
  EXPECT_EQ(asked_, 1) << "nothing is sent to a server that may be another one";
  EXPECT_NE(opened.error().what.find("another key of dance.example.org:7400"), std::string::npos)
      << opened.error().what;
  EXPECT_NE(opened.error().what.find("dance key --trust dance.example.org:7400=" +
                                     forged.server_key.text()),
            std::string::npos)
      << opened.error().what;
  EXPECT_FALSE(*was_opened_before(forged, folder_.path("alice")));
  EXPECT_TRUE(*names_other_server_key(forged, folder_.path("alice")));
  EXPECT_FALSE(*names_other_server_key(invitation_, folder_.path("alice")));
  EXPECT_FALSE(*names_other_server_key(forged, folder_.path("bob"))) << "it knows no server";
  // A line without a port is used for all ports of its host.
  HouseKey portless = invitation_.house_key();
  portless.server = invitation_.host;
  ASSERT_TRUE(write_secret(folder_.path("carol/keys"), portless.line() + "\n"));
  EXPECT_FALSE(open_invitation(forged, house("carol")));
  EXPECT_EQ(asked_, 1);
  // Once the user has confirmed the change, all lines of this server have the new key.
  OpenInvitation confirmed = house("alice");
  confirmed.trusts_new_key = true;
  ASSERT_TRUE(open_invitation(forged, confirmed));
  const auto keys = HouseKeys::parse(keys_of("alice"), "keys");
  ASSERT_EQ(keys->keys().size(), 2u);
  for (const HouseKey& key : keys->keys()) EXPECT_EQ(key.server_key, forged.server_key);
  forged = invitation_;
  forged.server_key = PrivateKey::make().public_key();
  EXPECT_FALSE(*was_opened_before(forged, folder_.path("alice")));
}

TEST_F(OpenedInAHouse, AnotherHouseIsRefusedAndTold) {
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  const auto opened = open_invitation(invitation_, house("thief"));
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("was used already"), std::string::npos) << opened.error().what;
  EXPECT_NE(opened.error().what.find("dance server --invite alice"), std::string::npos);
  EXPECT_EQ(keys_of("thief"), "");
  EXPECT_TRUE(is_let_in("alice"));
}

TEST_F(OpenedInAHouse, AnAnswerThatIsLostLocksNobodyOut) {
  OpenInvitation lossy = house("alice");
  lossy.ask = [&](const Invitation&, const PrivateKey& house, Duration) -> Result<Binding> {
    EXPECT_EQ(*server_->bind("alice", house.public_key()), Binding::kBound);
    return fail("the server does not answer");
  };
  ASSERT_FALSE(open_invitation(invitation_, lossy));
  EXPECT_EQ(keys_of("alice"), "");
  // Another house cannot use the pause, and this one is let in; also when the invitation's time is
  // over by then.
  EXPECT_FALSE(open_invitation(invitation_, house("thief")));
  OpenInvitation later = house("alice");
  later.now_s = invitation_.until_s + 60;
  const auto opened = open_invitation(invitation_, later);
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_TRUE(is_let_in("alice"));
}

TEST_F(OpenedInAHouse, AHouseThatEndsBeforeItHasKeptTheKeyGoesOn) {
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  // As the disk was between the server's answer and the key that is kept.
  ASSERT_TRUE(write_secret(folder_.path("alice/keys"), ""));
  ASSERT_TRUE(
      write_secret(folder_.path("alice/invitations"),
                   invitation_.key.fingerprint() + " pending " + invitation_.title() + "\n"));
  EXPECT_FALSE(is_let_in("alice"));
  const auto opened = open_invitation(invitation_, house("alice"));
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_TRUE(is_let_in("alice"));
  // And where the key was kept and that it was opened was not.
  ASSERT_TRUE(
      write_secret(folder_.path("alice/invitations"),
                   invitation_.key.fingerprint() + " pending " + invitation_.title() + "\n"));
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  EXPECT_TRUE(is_let_in("alice"));
}

TEST_F(OpenedInAHouse, AForgedRefusalLocksNobodyOut) {
  // The answer is lost, and then somebody on the way refuses the handshake.
  OpenInvitation lossy = house("alice");
  lossy.ask = [&](const Invitation&, const PrivateKey& house, Duration) -> Result<Binding> {
    EXPECT_EQ(*server_->bind("alice", house.public_key()), Binding::kBound);
    return Binding::kUnknown;
  };
  const auto refused = open_invitation(invitation_, lossy);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("does not know"), std::string::npos);
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  EXPECT_TRUE(is_let_in("alice"));
}

TEST_F(OpenedInAHouse, AServerThatEndsBeforeItHasWrittenTakesItLater) {
  OpenInvitation silent = house("alice");
  silent.ask = [](const Invitation&, const PrivateKey&, Duration) -> Result<Binding> {
    return fail("the server does not answer");
  };
  ASSERT_FALSE(open_invitation(invitation_, silent));
  silent.ask = [](const Invitation&, const PrivateKey&, Duration) -> Result<Binding> {
    return Binding::kNotKept;
  };
  const auto not_kept = open_invitation(invitation_, silent);
  ASSERT_FALSE(not_kept);
  EXPECT_NE(not_kept.error().what.find("could not write its keys"), std::string::npos);
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  EXPECT_TRUE(is_let_in("alice"));
}

TEST_F(OpenedInAHouse, WhatIsOverIsSaidWithoutAskingTheServer) {
  OpenInvitation late = house("alice");
  late.now_s = invitation_.until_s;
  const auto opened = open_invitation(invitation_, late);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("was good until"), std::string::npos);
  EXPECT_NE(opened.error().what.find("ask the server's keeper"), std::string::npos);
  EXPECT_EQ(asked_, 0);
}

TEST_F(OpenedInAHouse, RevokedIsSaid) {
  ASSERT_TRUE(*server_->remove("alice"));
  const auto opened = open_invitation(invitation_, house("alice"));
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("was revoked"), std::string::npos);
  EXPECT_EQ(keys_of("alice"), "");
}

TEST_F(OpenedInAHouse, NoLineShowsAKey) {
  for (int i = 0; i < static_cast<int>(Binding::kCount); ++i) {
    const std::string line = binding_line(static_cast<Binding>(i), invitation_);
    EXPECT_EQ(line.find(invitation_.key.text().substr(0, 12)), std::string::npos);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_NE(line.find("dance.example.org:7400"), std::string::npos) << line;
  }
}

TEST_F(OpenedInAHouse, OtherKeysStay) {
  HouseKeys before;
  Invitation other = invitation_;
  other.host = "other.example.org";
  before.put(other.house_key());
  ASSERT_TRUE(write_secret(folder_.path("alice/keys"), before.text()));
  ASSERT_TRUE(open_invitation(invitation_, house("alice")));
  const auto keys = HouseKeys::parse(keys_of("alice"), "keys");
  ASSERT_TRUE(keys);
  EXPECT_EQ(keys->keys().size(), 2u);
  EXPECT_NE(keys_of("alice").find(before.keys()[0].line()), std::string::npos);
}

}  // namespace
}  // namespace dance
