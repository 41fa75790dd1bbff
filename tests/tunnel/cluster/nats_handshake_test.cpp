// How a connection to NATS begins: in TLS where that is wanted, whatever the server says, and with
// an end, whatever it does.
#include <dlfcn.h>
#include <pthread.h>

#include "tests/tunnel/cluster/nats_cluster.h"
#include "tests/tunnel/cluster/nats_peer.h"
#include "tests/tunnel/cluster/nats_says.h"
#include "tests/tunnel/seal/paper.h"

namespace dance {
namespace {

class NatsHandshakeTest : public NatsCluster {
 protected:
  void start_tls_nats(const std::string& name) {
    start_nats(0, 1,
               {"--tls", "--tlscert", folder_.path(name + ".pem"), "--tlskey",
                folder_.path(name + ".key")});
  }
  NatsOptions options(const std::string& scheme, const std::string& authorities) const {
    NatsOptions of;
    of.urls = {scheme + url_of(0).substr(4)};
    of.authorities = authorities;
    return of;
  }
};

TEST_F(NatsHandshakeTest, WhereTlsIsWantedAServerWithoutItIsNotSpokenWith) {
  Authority ours(folder_.path(), "ours");
  start_nats(0, 1);
  EXPECT_EQ(messages_say(options("nats", "")), "connected");
  EXPECT_EQ(values_say(options("nats", ""), *poller), "connected");
  for (const NatsOptions& of : {options("nats", ours.file), options("tls", "")}) {
    for (const std::string& said : {messages_say(of), values_say(of, *poller)})
      EXPECT_NE(said.find("no TLS: the server offers none"), std::string::npos) << said;
  }
}

TEST_F(NatsHandshakeTest, AServerShowsWhoItIsAlsoWhereItsUrlDoesNotAskForTls) {
  Authority ours(folder_.path(), "ours"), theirs(folder_.path(), "theirs");
  ours.sign("nats", "IP:127.0.0.1");
  ours.sign("elsewhere", "IP:127.0.0.9");
  start_tls_nats("nats");
  for (const char* scheme : {"nats", "tls"}) {
    EXPECT_EQ(messages_say(options(scheme, ours.file)), "connected");
    EXPECT_EQ(values_say(options(scheme, ours.file), *poller), "connected");
    const NatsOptions wrong = options(scheme, theirs.file);
    for (const std::string& said : {messages_say(wrong), values_say(wrong, *poller)})
      EXPECT_NE(said.find("no TLS"), std::string::npos) << said;
  }
  kill_now(nats_[0]);
  start_tls_nats("elsewhere");
  const NatsOptions other = options("nats", ours.file);
  for (const std::string& said : {messages_say(other), values_say(other, *poller)})
    EXPECT_NE(said.find("no TLS"), std::string::npos) << said;
}

TEST_F(NatsHandshakeTest, APeerThatNeverComesToAnEndIsLeft) {
  // By its bytes, or by the time.
  for (const std::size_t lines_at_once : {1000u, 1u}) {
    Chatterer peer(lines_at_once);
    NatsOptions of;
    of.urls = {peer.url};
    const std::string said = messages_say(of);
    EXPECT_NE(said.find(lines_at_once > 1 ? "is no NATS server" : "does not answer"),
              std::string::npos)
        << said;
  }
}

TEST_F(NatsHandshakeTest, WhatIsBeingTriedEndsWithWhoAskedForIt) {
  Chatterer peer(1);
  NatsOptions of;
  of.urls = {peer.url};
  {
    NatsConnector connector(of, *WakeEvent::create());
    connector.ask();
    ASSERT_TRUE(wait_for([&] { return peer.lines > 3; }));
  }
  EXPECT_GT(peer.lines, 3);
}

// nats_connection.cpp says why: a fault of the library would end the process.
TEST(NatsLibrary, CallsOursToDetachAThreadThatItMayNotHave) {
  void* called = dlsym(RTLD_DEFAULT, "natsThread_Detach");
  ASSERT_NE(called, nullptr);
  Dl_info where{};
  ASSERT_NE(dladdr(called, &where), 0);
  EXPECT_EQ(std::string(where.dli_fname).find("libnats"), std::string::npos) << where.dli_fname;
  reinterpret_cast<void (*)(pthread_t*)>(called)(nullptr);
}

}  // namespace
}  // namespace dance
