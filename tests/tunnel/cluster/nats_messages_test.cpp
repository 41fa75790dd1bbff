// Messages over a real NATS server, in one process: all of a turn arrive in order, a NATS server
// that does not read holds up nobody, and another takes its place.
#include "tunnel/nats/messages/nats_messages.h"

#include "core/program/child_process.h"
#include "tests/tunnel/cluster/nats_cluster.h"
#include "tests/tunnel/cluster/nats_peer.h"
#include "tests/tunnel/seal/paper.h"

namespace dance {
namespace {

struct Talker {
  Talker(const NatsOptions& options, Poller& poller) {
    NatsMessages::Handlers on;
    on.on_message = [this](std::string_view subject, NatsMessages::Bytes bytes, MonoTime) {
      heard[std::string(subject)].emplace_back(bytes.begin(), bytes.end());
    };
    on.after_batch = [](MonoTime) {};
    on.on_back = [this](MonoTime) { ++backs; };
    auto made = NatsMessages::connect(options, poller, std::move(on));
    EXPECT_TRUE(made) << made.error().what;
    messages = std::move(*made);
  }
  void say(const char* subject, std::string_view text) {
    messages->publish(subject, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

  std::map<std::string, std::vector<std::string>> heard;
  int backs = 0;
  std::unique_ptr<NatsMessages> messages;
};

class NatsMessagesTest : public NatsCluster {
 protected:
  NatsOptions options() const {
    NatsOptions of;
    of.urls = nats_urls(urls());
    return of;
  }
  bool turn_until(const std::function<bool()>& holds, Duration longest = Duration::s(30)) {
    for (const MonoTime end = mono_now() + longest; !holds() && mono_now() < end;)
      poller->run_once(Duration::ms(5));
    return holds();
  }
};

TEST_F(NatsMessagesTest, AllOfATurnComeInOrderAndNotToWhoSaidThem) {
  start_nats(0, 1);
  Talker alice(options(), *poller), bob(options(), *poller);
  for (Talker* one : {&alice, &bob}) one->messages->listen("dance.1.test");
  bob.messages->end_turn(mono_now());
  alice.messages->end_turn(mono_now());
  ASSERT_TRUE(turn_until([&] {
    alice.say("dance.1.test", "hello");
    alice.messages->end_turn(mono_now());
    return bob.heard.contains("dance.1.test");
  }));
  bob.heard.clear();
  std::vector<std::string> said;
  for (int i = 0; i < 100; ++i) {
    said.push_back("number " + std::to_string(i) + std::string(static_cast<std::size_t>(i), '.'));
    alice.say("dance.1.test", said.back());
  }
  alice.messages->end_turn(mono_now());
  EXPECT_TRUE(turn_until([&] {
    const auto& heard = bob.heard["dance.1.test"];
    return !heard.empty() && heard.back() == said.back();
  }));
  std::erase(bob.heard["dance.1.test"], "hello");
  EXPECT_EQ(bob.heard["dance.1.test"], said);
  EXPECT_FALSE(alice.heard.contains("dance.1.test"));
  // Whom it hears no more.
  bob.messages->end_listen("dance.1.test");
  bob.messages->listen("dance.1.end");
  bob.messages->end_turn(mono_now());
  bob.heard.clear();
  ASSERT_TRUE(turn_until([&] {
    alice.say("dance.1.end", "end");
    alice.messages->end_turn(mono_now());
    return bob.heard.contains("dance.1.end");
  }));
  bob.heard.clear();
  alice.say("dance.1.test", "too late");
  alice.say("dance.1.end", "end");
  alice.messages->end_turn(mono_now());
  EXPECT_TRUE(turn_until([&] { return bob.heard.contains("dance.1.end"); }));
  EXPECT_FALSE(bob.heard.contains("dance.1.test"));
}

TEST_F(NatsMessagesTest, WhoIsBehindTakesTheNewestOfEachSubject) {
  start_nats(0, 1);
  auto hers = Poller::create();
  ASSERT_TRUE(hers);
  Talker alice(options(), **hers), bob(options(), *poller);
  bob.messages->listen("dance.1.much");
  bob.messages->listen("dance.1.seldom");
  bob.messages->end_turn(mono_now());
  ASSERT_TRUE(turn_until([&] {
    alice.say("dance.1.seldom", "first");
    alice.messages->end_turn(mono_now());
    (*hers)->run_once(Duration::ms(1));
    return bob.heard.contains("dance.1.seldom");
  }));
  // Bob takes nothing meanwhile.
  const std::string text(500, 'x');
  for (int i = 0; i < 1000; ++i) {
    if (i == 10) alice.say("dance.1.seldom", "second");
    alice.say("dance.1.much", std::to_string(i) + text);
    alice.messages->end_turn(mono_now());
    for (int k = 0; k < 5000 && !alice.messages->is_clear(); ++k)
      (*hers)->run_once(Duration::ms(1));
  }
  alice.messages->flush(Duration::s(5));
  ASSERT_EQ(alice.messages->counters().dropped_out, 0u);
  EXPECT_TRUE(turn_until([&] {
    const auto& heard = bob.heard["dance.1.much"];
    return !heard.empty() && heard.back() == "999" + text;
  }));
  EXPECT_GT(bob.messages->counters().dropped_in, 0u);
  EXPECT_EQ(bob.heard["dance.1.much"].size() + bob.messages->counters().dropped_in, 1000u);
  EXPECT_EQ(bob.heard["dance.1.seldom"].back(), "second") << "of which there were few";
}

// A guest's link that changes its mind all the time costs NATS nothing, and nobody's poses.
TEST_F(NatsMessagesTest, TogglingASubjectSaysNothingAndHoldsUpNoMessage) {
  start_nats(0, 1);
  Talker alice(options(), *poller), bob(options(), *poller);
  bob.messages->listen("dance.1.kept");
  bob.messages->listen("dance.1.toggled");
  bob.messages->end_turn(mono_now());
  const auto passes = [&](const char* subject) {
    return turn_until([&] {
      alice.say(subject, "hello");
      alice.messages->end_turn(mono_now());
      return bob.heard.contains(subject);
    });
  };
  ASSERT_TRUE(passes("dance.1.kept"));
  const auto said = bob.messages->counters().interests_said;
  EXPECT_EQ(said, 2u);
  for (int i = 0; i < 100'000; ++i) {  // many times what may wait
    bob.messages->end_listen("dance.1.toggled");
    bob.messages->listen("dance.1.toggled");
    if (i % 1000 != 0) continue;
    bob.say("dance.1.bobs", "pose");
    bob.messages->end_turn(mono_now());
  }
  EXPECT_EQ(bob.messages->counters().dropped_out, 0u);
  EXPECT_EQ(bob.messages->counters().interests_said, said);
  bob.heard.clear();
  EXPECT_TRUE(passes("dance.1.toggled"));
  // Its end is said in the end, once.
  bob.messages->end_listen("dance.1.toggled");
  EXPECT_TRUE(turn_until([&] { return bob.messages->counters().interests_said > said; }));
  bob.heard.clear();
  EXPECT_TRUE(passes("dance.1.kept"));
  EXPECT_EQ(bob.messages->counters().interests_said, said + 1);
  EXPECT_FALSE(bob.heard.contains("dance.1.toggled"));
}

// More than goes out in a turn, again at another NATS server, and each is heard.
TEST_F(NatsMessagesTest, ManySubjectsAreToldTurnByTurn) {
  start_nats(0, 1);
  Talker alice(options(), *poller), bob(options(), *poller);
  constexpr int kMany = 3000;
  const auto subject = [](int i) { return "dance.1.guest-with-a-name." + std::to_string(i); };
  for (int i = 0; i < kMany; ++i) bob.messages->listen(subject(i));
  bob.messages->end_turn(mono_now());
  EXPECT_LT(bob.messages->counters().interests_said, static_cast<std::uint64_t>(kMany));
  const auto all_heard = [&] {
    for (int i = 0; i < kMany; ++i) {
      if (bob.heard.contains(subject(i))) continue;
      alice.say(subject(i).c_str(), "hello");
      if (i % 500 == 499) alice.messages->end_turn(mono_now());
    }
    alice.messages->end_turn(mono_now());
    return bob.heard.size() == kMany;
  };
  EXPECT_TRUE(turn_until(all_heard));
  EXPECT_EQ(bob.messages->counters().interests_said, static_cast<std::uint64_t>(kMany));
  kill_now(nats_[0]);
  start_nats(0, 1);
  ASSERT_TRUE(turn_until([&] { return alice.backs > 0 && bob.backs > 0; }));
  bob.heard.clear();
  EXPECT_TRUE(turn_until(all_heard));
  EXPECT_EQ(bob.messages->counters().refused, 0u);
}

// OpenSSL takes whole records from the socket, of which a turn reads a part: for the rest no poller
// wakes, and this peer sends nothing more.
TEST_F(NatsMessagesTest, WhatTlsHasTakenFromTheSocketIsRead) {
  Authority ours(folder_.path(), "ours");
  ours.sign("peer", "IP:127.0.0.1");
  constexpr std::size_t kMessages = 136;  // somewhat more than four times 32 kB
  SilentAfterBurst peer(folder_.path("peer.pem"), folder_.path("peer.key"), kMessages);
  NatsOptions of;
  of.urls = {peer.url};
  of.authorities = ours.file;
  Talker bob(of, *poller);
  ASSERT_TRUE(bob.messages);
  bob.messages->listen("dance.1.test");
  bob.messages->end_turn(mono_now());
  ASSERT_TRUE(wait_for([&] { return peer.has_sent.load(); }));
  EXPECT_TRUE(turn_until([&] {
    return bob.heard["dance.1.test"].size() + bob.messages->counters().dropped_in == kMessages ||
           !bob.messages->is_connected();
  }));
  EXPECT_EQ(bob.heard["dance.1.test"].size() + bob.messages->counters().dropped_in, kMessages);
}

TEST_F(NatsMessagesTest, ItShowsItsPasswordOrToken) {
  start_nats(0, 1, {"--user", "me", "--pass", "secret"});
  start_nats(1, 1, {"--auth", "token"});
  const std::string first = url_of(0).substr(7), second = url_of(1).substr(7);
  const auto connects = [&](const std::string& url) {
    NatsOptions of;
    of.urls = {url};
    const auto made = NatsMessages::connect(of, *poller, {});
    return made ? std::string() : made.error().what;
  };
  EXPECT_EQ(connects("nats://me:secret@" + first), "");
  EXPECT_EQ(connects("nats://token@" + second), "");
  for (const std::string& url :
       {"nats://" + first, "nats://me:wrong@" + first, "nats://other@" + second}) {
    const std::string what = connects(url);
    EXPECT_NE(what.find("does not let us in"), std::string::npos) << what;
    EXPECT_EQ(what.find("wrong"), std::string::npos) << "no password is said";
  }
  EXPECT_NE(connects("tls://" + first).find("no TLS"), std::string::npos) << "it has none";
  EXPECT_NE(connects("nats://127.0.0.1:1").find("127.0.0.1:1"), std::string::npos);
}

TEST_F(NatsMessagesTest, AServerThatDoesNotReadHoldsUpNothingAndIsLeft) {
  start_nats(0, 2);
  NatsOptions hers = options();
  hers.urls.push_back(url_of(1));
  Talker alice(hers, *poller);  // at the only one that there is
  start_nats(1, 2);
  NatsOptions his = options();
  his.urls = {url_of(1)};
  Talker bob(his, *poller);
  for (Talker* one : {&alice, &bob}) {
    one->messages->listen("dance.1.test");
    one->messages->end_turn(mono_now());
  }
  const auto passes = [&] {
    alice.say("dance.1.test", "now");
    bob.say("dance.1.test", "now");
    for (Talker* one : {&alice, &bob}) one->messages->end_turn(mono_now());
    return alice.heard.contains("dance.1.test") && bob.heard.contains("dance.1.test");
  };
  ASSERT_TRUE(turn_until(passes));
  ASSERT_TRUE(nats_[0]->send_signal(SIGSTOP));
  // Far more than any buffer takes; every call returns at once, or this never ends.
  const std::string much(8000, 'x');
  for (int i = 0; i < 4000; ++i) {
    alice.say("dance.1.flood", much);
    alice.messages->end_turn(mono_now());
  }
  EXPECT_GT(alice.messages->counters().dropped_out, 0u);
  EXPECT_FALSE(alice.messages->is_clear());
  EXPECT_TRUE(turn_until([&] { return alice.backs > 0; }));
  alice.heard.clear();
  bob.heard.clear();
  EXPECT_TRUE(turn_until(passes)) << "through the other";
  ASSERT_TRUE(nats_[0]->send_signal(SIGCONT));
}

}  // namespace
}  // namespace dance
