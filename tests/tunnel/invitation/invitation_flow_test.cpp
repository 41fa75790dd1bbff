// Invitations with the programs themselves: a server, houses of several users, and what each is
// told.
#include <sys/stat.h>

#include "core/program/child_process.h"
#include "tests/apps/bus_programs.h"
#include "tunnel/invitation/invitation.h"

namespace dance {
namespace {

constexpr const char* kPort = "7446";
constexpr const char* kServer = "127.0.0.1:7446";
// No server is there.
constexpr const char* kNobody = "127.0.0.1:7447";

class InvitationPrograms : public BusPrograms {
 protected:
  // What stands before a program that is run as another user would.
  std::string as(const std::string& user) {
    return "export XDG_CONFIG_HOME=" + folder_.path(user) + "; exec ";
  }
  ChildProcess& start_as(const std::string& user, const std::string& command) {
    return start("/bin/sh", {"-c", as(user) + command});
  }
  ChildProcess& start_server() {
    ChildProcess& server =
        start_as("operator", bin("dance-server") + " --port " + std::string(kPort));
    EXPECT_TRUE(wait_for([&] { return talk().find("hears on") != std::string::npos; })) << talk();
    return server;
  }
  Finished command_of(const std::string& user, const std::string& command) {
    return run("( " + as(user) + command + " )");
  }
  std::string link_for(const std::string& guest, const std::string& more = "",
                       const char* server = kServer) {
    const Finished made = command_of("operator", bin("dance-server") + " --invite " + guest +
                                                     " --address " + server + " " + more);
    EXPECT_EQ(made.exit_code, 0) << made.talk;
    const std::string link = made.output.substr(0, made.output.find('\n'));
    EXPECT_TRUE(parse_invitation(link)) << made.talk;
    // The line alone has the key.
    EXPECT_EQ(made.talk.find("key="), std::string::npos);
    return link;
  }
  static std::string join(const std::string& link, const char* bus) {
    return bin("dance-join") + " '" + link + "' --no-view --bus " + quoted(bus);
  }
  std::string talk() { return text_of(folder_.path("talk")); }
  Finished open_with_key_program(const std::string& user, const std::string& link) {
    return run("printf '%s' '" + link + "' | ( " + as(user) + bin("dance-key") + " )");
  }
};

TEST_F(InvitationPrograms, ALinkIsAllThatAGuestNeedsAndOfNoUseToAnother) {
  start_server();
  const std::string alice = link_for("alice", "--room salsa"), bob = link_for("bob");
  EXPECT_NE(alice.find("/salsa?"), std::string::npos);
  ChildProcess& house = start_as("alice", join(alice, kBus));
  start_as("bob", join(bob, kOtherBus) + " --room salsa");
  start("dance-salsa", {"--guest", "alice", "--bus", kBus});
  start("dance-salsa", {"--guest", "bob", "--bus", kOtherBus});
  expect_couple_on_stage(kBus);
  expect_couple_on_stage(kOtherBus);

  // Another user who has read the link is told, and alice dances on.
  const Finished thief = command_of("thief", join(alice, kBus));
  EXPECT_EQ(thief.exit_code, 1);
  EXPECT_NE(thief.talk.find("was used already"), std::string::npos) << thief.talk;
  EXPECT_NE(thief.talk.find("dance server --invite alice"), std::string::npos) << thief.talk;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("thief/dance/keys")));
  expect_couple_on_stage(kOtherBus);

  // The same link opened again on the same machine just joins.
  house.stop(Duration::s(5));
  start_as("alice", join(alice, kBus));
  EXPECT_TRUE(wait_for([&] { return talk().find("was opened here before") != std::string::npos; }));
  expect_couple_on_stage(kOtherBus);

  // And so does the key without the link; it opens the invitation's room alone.
  const Finished keys = command_of("alice", bin("dance-key") + " --list");
  EXPECT_EQ(keys.output, std::string("alice@") + kServer + "/salsa\n");
  // Nobody has said a key, and files are their owner's.
  for (const std::string& link : {alice, bob}) {
    const std::string key = parse_invitation(link)->key.text();
    EXPECT_EQ(talk().find(key), std::string::npos);
    EXPECT_EQ(text_of(folder_.path("alice/dance/keys")).find(key), std::string::npos);
  }
  for (const char* name : {"keys", "identity.key", "invitations", "invitations.lock"}) {
    struct stat about {};
    ASSERT_EQ(stat(folder_.path(std::string("alice/dance/") + name).c_str(), &about), 0) << name;
    EXPECT_EQ(about.st_mode & (S_IRWXG | S_IRWXO), 0u) << name;
  }
}

TEST_F(InvitationPrograms, AClickedLinkIsOpenedInATerminalOnlyWhenItIsConfirmed) {
  start_server();
  const std::string link = link_for("alice", "--room salsa");
  const std::string house = folder_.path("alice/dancegraph/house.toml");
  std::filesystem::create_directories(folder_.path("alice/dancegraph"));
  std::ofstream(house) << "[house]\nguest = \"ann\"\n";
  for (const char* answer : {"n", ""}) {
    const Finished joined = run(std::string("echo ") + answer + " | ( " + as("alice") +
                                join(link, kBus) + " --confirm )");
    EXPECT_EQ(joined.exit_code, 1) << joined.talk;
    EXPECT_NE(joined.talk.find(std::string("Join salsa on ") + kServer + " as alice?"),
              std::string::npos)
        << joined.talk;
    EXPECT_FALSE(std::filesystem::exists(folder_.path("alice/dance/invitations")));
  }
  std::ofstream(folder_.path("answer")) << "y\n";
  start_as("alice", join(link, kBus) + " --confirm <" + folder_.path("answer"));
  EXPECT_TRUE(wait_for([&] { return talk().find("in room 'salsa'") != std::string::npos; }))
      << talk();
  EXPECT_EQ(text_of(house), "[house]\nguest = \"ann\"\n") << "dance join writes no house file";
}

TEST_F(InvitationPrograms, EachTroubleIsOneLineWithItsCure) {
  start_server();
  const auto says = [&](const std::string& link, const std::string& part, const std::string& cure) {
    const Finished joined = command_of("alice", join(link, kBus));
    EXPECT_EQ(joined.exit_code, 1);
    EXPECT_NE(joined.talk.find(part), std::string::npos) << joined.talk;
    EXPECT_NE(joined.talk.find(cure), std::string::npos) << joined.talk;
    EXPECT_EQ(std::count(joined.talk.begin(), joined.talk.end(), '\n'), 1) << joined.talk;
    EXPECT_EQ(joined.talk.find("key="), std::string::npos) << joined.talk;
  };
  // The server reads its keys again after each change; a change that it has not read has no effect.
  const auto has_read_keys = [&](std::size_t times) {
    std::size_t count = 0;
    const std::string printed = talk();
    for (std::size_t at = 0; (at = printed.find(" keys now", at)) != std::string::npos; ++at)
      ++count;
    return count >= times;
  };
  const std::string link = link_for("alice");
  ASSERT_TRUE(wait_for([&] { return has_read_keys(1); })) << talk();
  says(link.substr(0, link.size() - 1), "wrong or missing character", "copy all of it");
  says("dance://" + std::string(kServer), "ends after the server", "copy all of it");

  // A newer invitation of the same guest takes its place.
  const std::string newer = link_for("alice");
  const Finished listed = command_of("operator", bin("dance-server") + " --list-keys");
  EXPECT_NE(listed.output.find("alice"), std::string::npos);
  EXPECT_NE(listed.output.find("invited, until 20"), std::string::npos) << listed.output;
  ASSERT_TRUE(wait_for([&] { return has_read_keys(2); })) << talk();
  says(link, "does not know the invitation", "ask for another");

  // Its time is over by the house's clock.
  Invitation old = *parse_invitation(newer);
  old.until_s -= 30 * 24 * 3600;
  says(text_of(old), "was good until", "ask the server's keeper");

  // A server that made no such invitation, as one that was guessed.
  Invitation guessed = *parse_invitation(newer);
  guessed.key = PrivateKey::make();
  says(text_of(guessed), "does not know the invitation", "another server made it");

  const Finished removed = command_of("operator", bin("dance-server") + " --remove-key alice");
  EXPECT_EQ(removed.exit_code, 0) << removed.talk;
  ASSERT_TRUE(wait_for([&] { return has_read_keys(3); })) << talk();
  says(newer, "was revoked", "dance server --invite alice");
  EXPECT_FALSE(std::filesystem::exists(folder_.path("alice/dance/keys")));
}

TEST_F(InvitationPrograms, TheKeyProgramOpensOneThatIsPasted) {
  start_server();
  const std::string link = link_for("anna", "--role listener --room salsa");
  ASSERT_TRUE(wait_for([&] { return talk().find("1 keys now") != std::string::npos; })) << talk();
  const Finished opened = open_with_key_program("anna", link);
  EXPECT_EQ(opened.exit_code, 0) << opened.talk;
  EXPECT_NE(opened.talk.find(std::string("dance join ") + kServer + " --room salsa"),
            std::string::npos)
      << opened.talk;
  // A listener joins without a guest.
  start_as("anna", join(link, kBus));
  EXPECT_TRUE(wait_for([&] { return talk().find("in room 'salsa'") != std::string::npos; }))
      << talk();
  const Finished again = open_with_key_program("other", link);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.talk.find("was used already"), std::string::npos) << again.talk;
}

TEST_F(InvitationPrograms, AServerThatIsStartedAnewKnowsWhoHasCome) {
  ChildProcess& server = start_server();
  const std::string link = link_for("alice");
  ASSERT_TRUE(wait_for([&] { return talk().find("1 keys now") != std::string::npos; })) << talk();
  const Finished opened = open_with_key_program("alice", link);
  ASSERT_EQ(opened.exit_code, 0) << opened.talk;
  server.kill_now();
  std::filesystem::remove(folder_.path("talk"));
  start_server();
  start_as("alice", join(link, kBus));
  EXPECT_TRUE(wait_for([&] { return talk().find("in room 'dance'") != std::string::npos; }))
      << talk();
  EXPECT_EQ(command_of("thief", join(link, kOtherBus)).exit_code, 1);
}

TEST_F(InvitationPrograms, AServerWithAnotherKeyIsNotJoinedUntilItsKeyIsTrusted) {
  ChildProcess& server = start_server();
  const std::string link = link_for("alice", "--room salsa");
  ASSERT_TRUE(wait_for([&] { return talk().find("1 keys now") != std::string::npos; })) << talk();
  ASSERT_EQ(open_with_key_program("alice", link).exit_code, 0);
  server.stop(Duration::s(5));
  // The server's disk is lost, but for its list of guests; or another machine takes its place.
  std::filesystem::remove(folder_.path("operator/dance/server-identity.key"));
  start_server();
  start_as("alice", join(link, kBus));
  EXPECT_TRUE(wait_for([&] { return talk().find("has another key") != std::string::npos; }))
      << talk();
  EXPECT_EQ(talk().find("in room 'salsa'"), std::string::npos) << talk();
  const Finished listed = command_of("operator", bin("dance-server") + " --list-keys");
  const std::size_t at = listed.talk.find("public key is ");
  ASSERT_NE(at, std::string::npos) << listed.talk;
  const std::string key = listed.talk.substr(at + 14, PublicKey::kTextLength);
  const Finished wrong =
      command_of("alice", bin("dance-key") + " --trust " + kServer + "=" + key.substr(1));
  EXPECT_EQ(wrong.exit_code, 1);
  const Finished trusted =
      command_of("alice", bin("dance-key") + " --trust " + kServer + "=" + key);
  ASSERT_EQ(trusted.exit_code, 0) << trusted.talk;
  start_as("alice", bin("dance-join") + " " + kServer + " --guest alice --room salsa --no-view " +
                        "--bus " + quoted(kOtherBus));
  EXPECT_TRUE(wait_for([&] { return talk().find("in room 'salsa'") != std::string::npos; }))
      << talk();
}

TEST_F(InvitationPrograms, NewGuestWithAPublicKeyPrintsALineWithoutSecrets) {
  start_server();
  const Finished shown = command_of("alice", bin("dance-key") + " --public");
  ASSERT_EQ(shown.exit_code, 0) << shown.talk;
  const std::string house = shown.output.substr(0, PublicKey::kTextLength);
  const std::string add = bin("dance-server") + " --new-guest alice --address " + kServer;
  EXPECT_EQ(command_of("operator", add + " --public-key " + house.substr(1)).exit_code, 1);
  const Finished made = command_of("operator", add + " --public-key " + house);
  ASSERT_EQ(made.exit_code, 0) << made.talk;
  // The line has the server's key, and no secret.
  const auto line = HouseKey::parse(made.output);
  ASSERT_TRUE(line) << made.output;
  EXPECT_FALSE(line->grant);
  ASSERT_EQ(open_with_key_program("alice", made.output).exit_code, 0);
  ASSERT_EQ(open_with_key_program("thief", made.output).exit_code, 0) << "it is no secret";
  ASSERT_TRUE(wait_for([&] { return talk().find("1 keys now") != std::string::npos; })) << talk();
  const std::string join_as =
      bin("dance-join") + " " + kServer + " --guest alice --room salsa --no-view --bus ";
  start_as("thief", join_as + quoted(kOtherBus));
  EXPECT_TRUE(wait_for([&] {
    return talk().find("does not know this house's key") != std::string::npos;
  })) << talk();
  EXPECT_EQ(talk().find("in room 'salsa'"), std::string::npos);
  start_as("alice", join_as + quoted(kBus));
  EXPECT_TRUE(wait_for([&] { return talk().find("in room 'salsa'") != std::string::npos; }))
      << talk();
}

// A server's files admit its guests and let nobody else take their names.
TEST_F(InvitationPrograms, AServersFilesHoldNoPrivateKeyOfAGuest) {
  start_server();
  const std::string invitation = link_for("alice");
  const Finished guest = command_of(
      "operator", bin("dance-server") + " --new-guest bob --address " + std::string(kServer));
  ASSERT_EQ(guest.exit_code, 0) << guest.talk;
  ASSERT_EQ(open_with_key_program("alice", invitation).exit_code, 0);
  const std::string identity = text_of(folder_.path("alice/dance/identity.key"));
  ASSERT_FALSE(identity.empty());
  for (const auto& file :
       std::filesystem::recursive_directory_iterator(folder_.path("operator/dance"))) {
    if (!file.is_regular_file()) continue;
    const std::string text = text_of(file.path());
    for (const std::string& secret :
         {parse_invitation(invitation)->key.text(), HouseKey::parse(guest.output)->grant->text(),
          identity.substr(0, PrivateKey::kTextLength)})
      EXPECT_EQ(text.find(secret), std::string::npos) << file.path();
  }
}

TEST_F(InvitationPrograms, InvitingSaysWhatCannotBe) {
  const auto says = [&](const std::string& options, const std::string& part) {
    const Finished made =
        command_of("operator", bin("dance-server") + " --invite alice " + options);
    EXPECT_EQ(made.exit_code, 1) << options;
    EXPECT_EQ(made.output, "");
    EXPECT_NE(made.talk.find(part), std::string::npos) << made.talk;
  };
  says("--address 'no name'", "is no HOST or HOST:PORT");
  says("--address dance.example.org --for tomorrow", "write how long, 90m, 24h or 7d");
  says("--address dance.example.org --room Salsa", "a room's name is");
  says("--address dance.example.org --qr-file code.bmp", "ends with .svg is wanted");
  says("--address dance.example.org --cluster nats://127.0.0.1:1", "--new-guest alice");
  const Finished key =
      command_of("operator", bin("dance-server") + " --new-guest alice --address " + kNobody);
  ASSERT_EQ(key.exit_code, 0) << key.talk;
  says("--address dance.example.org", "'alice' has a key already");
}

// An empty name once ran the server in the place of the command.
TEST_F(InvitationPrograms, AnEmptyNameIsAnErrorThatSaysSo) {
  for (const char* command : {"--invite", "--new-guest", "--new-room-key", "--remove-key"}) {
    const Finished refused =
        command_of("operator", "timeout 20 " + bin("dance-server") + " " + command + " ''");
    EXPECT_NE(refused.exit_code, 0) << command;
    EXPECT_NE(refused.exit_code, 124) << command << " ran a server";
    EXPECT_NE(refused.talk.find(command), std::string::npos) << refused.talk;
  }
}

TEST_F(InvitationPrograms, ASecretThatCannotBeWrittenIsRevoked) {
  const std::string server = bin("dance-server");
  const auto names = [&] { return command_of("operator", server + " --list-keys").output; };
  for (const std::string& command :
       {std::string("--new-guest carol"), std::string("--new-room-key carol"),
        "--invite carol --address " + std::string(kNobody)}) {
    for (const char* out : {">/dev/full", ">&-"}) {
      const Finished lost = command_of("operator", server + " " + command + " " + out);
      EXPECT_EQ(lost.exit_code, 1) << command << out;
      EXPECT_NE(lost.talk.find("'carol' was to get is not written"), std::string::npos)
          << lost.talk;
      EXPECT_NE(lost.talk.find("is revoked"), std::string::npos) << lost.talk;
      EXPECT_EQ(names().find("carol"), std::string::npos) << command << out;
    }
  }
  const Finished shown = command_of("operator", server + " --new-guest carol");
  EXPECT_EQ(shown.exit_code, 0) << shown.talk;
  EXPECT_FALSE(shown.output.empty());
  EXPECT_NE(names().find("carol"), std::string::npos);
}

}  // namespace
}  // namespace dance
