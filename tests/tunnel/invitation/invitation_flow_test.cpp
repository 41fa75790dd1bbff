// Invitations with the programs themselves: a server, houses of several users, and what each is
// told.
#include <sys/stat.h>

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
  for (const char* name : {"keys", "invitations", "invitations.lock"}) {
    struct stat about {};
    ASSERT_EQ(stat(folder_.path(std::string("alice/dance/") + name).c_str(), &about), 0) << name;
    EXPECT_EQ(about.st_mode & (S_IRWXG | S_IRWXO), 0u) << name;
  }
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
  const std::string link = link_for("alice");
  says(link.substr(0, link.size() - 1), "wrong or missing character", "copy all of it");
  says("dance://" + std::string(kServer), "ends after the server", "copy all of it");

  // A newer invitation of the same guest takes its place.
  const std::string newer = link_for("alice");
  const Finished listed = command_of("operator", bin("dance-server") + " --list-keys");
  EXPECT_NE(listed.output.find("alice"), std::string::npos);
  EXPECT_NE(listed.output.find("invited, until 20"), std::string::npos) << listed.output;
  const auto server_knows = [&](std::size_t times) {
    std::size_t count = 0;
    const std::string said = talk();
    for (std::size_t at = 0; (at = said.find(" keys now", at)) != std::string::npos; ++at) ++count;
    return count >= times;
  };
  ASSERT_TRUE(wait_for([&] { return server_knows(1); })) << talk();
  says(link, "does not know the invitation", "ask for another");

  // Its time is over by the house's clock.
  Invitation old = *parse_invitation(newer);
  old.until_s -= 30 * 24 * 3600;
  says(text_of(old), "was good until", "ask the server's keeper");

  // A server that made no such invitation, as one that was guessed.
  Invitation guessed = *parse_invitation(newer);
  guessed.key = PresharedKey::make();
  says(text_of(guessed), "does not know the invitation", "another server made it");

  const Finished removed = command_of("operator", bin("dance-server") + " --remove-key alice");
  EXPECT_EQ(removed.exit_code, 0) << removed.talk;
  ASSERT_TRUE(wait_for([&] { return server_knows(2); })) << talk();
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
  kill(server.pid(), SIGKILL);
  ASSERT_TRUE(wait_for([&] { return server.has_ended(); }));
  std::filesystem::remove(folder_.path("talk"));
  start_server();
  start_as("alice", join(link, kBus));
  EXPECT_TRUE(wait_for([&] { return talk().find("in room 'dance'") != std::string::npos; }))
      << talk();
  EXPECT_EQ(command_of("thief", join(link, kOtherBus)).exit_code, 1);
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

}  // namespace
}  // namespace dance
