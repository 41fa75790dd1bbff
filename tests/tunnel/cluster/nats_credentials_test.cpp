// Users without passwords: --cluster-credentials names a file with a JWT and a seed, as a real NATS
// server with an operator and accounts wants them.
#include <fstream>

#include "tests/tunnel/cluster/nats_accounts.h"
#include "tests/tunnel/cluster/nats_cluster.h"
#include "tests/tunnel/cluster/nats_says.h"

namespace dance {
namespace {

class NatsCredentialsTest : public NatsCluster {
 protected:
  void start_nats_with_accounts() {
    const nlohmann::json limits{{"subs", -1},         {"data", -1},    {"payload", -1},
                                {"imports", -1},      {"exports", -1}, {"wildcards", true},
                                {"conn", -1},         {"leaf", -1},    {"mem_storage", -1},
                                {"disk_storage", -1}, {"streams", -1}, {"consumer", -1}};
    const auto account_jwt = [&](const NatsKey& account, bool stores) {
      nlohmann::json of = limits;
      if (!stores)
        for (const char* name : {"mem_storage", "disk_storage", "streams", "consumer"})
          of[name] = 0;
      return operator_.jwt(account.name(), "account", {{"limits", of}});
    };
    std::ofstream out(folder_.path("accounts.conf"));
    out << "operator: " << operator_.jwt(operator_.name(), "operator") << "\n"
        << "system_account: " << system_.name() << "\nresolver: MEMORY\nresolver_preload: {\n"
        << "  " << system_.name() << ": " << account_jwt(system_, false) << "\n"
        << "  " << dance_.name() << ": " << account_jwt(dance_, true) << "\n}\n";
    out.close();
    start_nats(0, 1, {"-c", folder_.path("accounts.conf")});
  }
  static std::string user_of(const NatsKey& account, const NatsKey& user) {
    return account.jwt(user.name(), "user", {{"subs", -1}, {"data", -1}, {"payload", -1}});
  }
  // As `nsc generate creds` writes it.
  std::string file_of(const std::string& name, const std::string& jwt, const std::string& seed) {
    std::ofstream out(folder_.path(name));
    std::filesystem::permissions(folder_.path(name), std::filesystem::perms::owner_read |
                                                         std::filesystem::perms::owner_write);
    out << "-----BEGIN NATS USER JWT-----\n"
        << jwt << "\n------END NATS USER JWT------\n\n"
        << "************************* IMPORTANT *************************\n"
        << "NKEY Seed printed below can be used to sign and prove identity.\n\n"
        << "-----BEGIN USER NKEY SEED-----\n"
        << seed << "\n------END USER NKEY SEED------\n";
    return folder_.path(name);
  }
  NatsOptions options(const std::string& credentials) const {
    NatsOptions of;
    of.urls = {url_of(0)};
    of.credentials = credentials;
    return of;
  }

  NatsKey operator_{NatsKey::Role::kOperator};
  NatsKey system_{NatsKey::Role::kAccount}, dance_{NatsKey::Role::kAccount};
  NatsKey server_{NatsKey::Role::kUser};
};

TEST_F(NatsCredentialsTest, AUserOfAnAccountIsLetInForMessagesAndValues) {
  start_nats_with_accounts();
  const NatsOptions of = options(file_of("server.creds", user_of(dance_, server_), server_.seed()));
  EXPECT_EQ(messages_say(of), "connected");
  EXPECT_EQ(values_say(of, *poller), "connected");
}

TEST_F(NatsCredentialsTest, EveryOtherIsOneLineThatNamesWhatIsWrong) {
  start_nats_with_accounts();
  const NatsKey stranger(NatsKey::Role::kAccount), other(NatsKey::Role::kUser);
  const std::string jwt = user_of(dance_, server_);
  for (const NatsOptions& of :
       {options(""), options(file_of("a", user_of(stranger, server_), server_.seed())),
        options(file_of("b", jwt, other.seed()))})
    for (const std::string& said : {messages_say(of), values_say(of, *poller)}) {
      EXPECT_NE(said.find("127.0.0.1"), std::string::npos) << said;
      EXPECT_NE(said.find("does not let"), std::string::npos) << said;
      EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
  for (const NatsOptions& of :
       {options(folder_.path("missing")), options(file_of("c", jwt, "SUAAAA")),
        options(file_of("d", "", ""))})
    for (const std::string& said : {messages_say(of), values_say(of, *poller)})
      EXPECT_NE(said.find("--cluster-credentials"), std::string::npos) << said;
}

// The whole of it: two servers of one room, each with its file.
TEST_F(NatsCredentialsTest, ServersOfOneRoomMeetByThem) {
  start_nats_with_accounts();
  const std::string file = file_of("server.creds", user_of(dance_, server_), server_.seed());
  for (std::size_t i = 0; i < 2; ++i) start_server(i, urls(), {"--cluster-credentials", file});
  add_guest("alice", 0);
  add_guest("bob", 1);
  EXPECT_TRUE(all_hear_all(20)) << all_talk();
}

}  // namespace
}  // namespace dance
