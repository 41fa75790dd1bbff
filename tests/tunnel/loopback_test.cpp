// A server and two links with their real sockets, on this machine's loopback address.
#include "tests/tunnel/names/loopback.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/net/mono_clock.h"
#include "testing/line/lossy_proxy.h"
#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/link/link.h"
#include "tunnel/link/link_report.h"
#include "tunnel/link/room_question.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

TEST_F(LoopbackLinks, ALinkTriesEachAddressOfAServerAndReportsTheSilentOne) {
  const auto silent = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(silent);
  std::vector<Address> unanswered;
  LinkHandlers handlers;
  handlers.on_no_answer = [&](const Address& who) { unanswered.push_back(who); };
  LinkOptions of;
  of.room = guest("salsa");
  auto opened =
      Link::open({silent->local_address(), address}, link_key(), of, std::move(handlers), *poller);
  ASSERT_TRUE(opened);
  EXPECT_TRUE(turn_until([&] { return (*opened)->is_connected(); }));
  EXPECT_EQ(unanswered, std::vector{silent->local_address()});
}

TEST_F(LoopbackLinks, APoseGoesFromHouseToHouseWithItsJourneyStamped) {
  std::vector<Pose> heard;
  LinkHandlers handlers;
  handlers.on_pose = [&](const GuestId& id, const Pose& pose, MonoTime) {
    EXPECT_EQ(id, guest("alice"));
    heard.push_back(pose);
  };
  auto a = link("alice");
  auto b = link("bob", handlers);
  ASSERT_TRUE(turn_until(
      [&] { return a->is_connected() && b->is_connected() && !b->remote_stats().empty(); }));
  // Two clocks mapped by round trips are each off by half of one at most.
  const auto doubt = [](const Link& of) { return of.clock().shortest_round_trip() / 2; };
  Duration doubts;
  for (std::uint32_t i = 1; i <= 50; ++i) {
    const MonoTime now = mono_now();
    if (i == 33) doubts = doubt(*a) + doubt(*b);  // later round trips may be shorter
    a->send(guest("alice"), pose_number(i, now - Duration::us(100), this_clock_id()), now);
    ASSERT_TRUE(turn_until([&] { return heard.size() == i; })) << i;
  }
  EXPECT_EQ(heard.back().sequence, 50u);
  const Pose& pose = heard[32];  // one of those that bring the stamps of their way
  EXPECT_EQ(pose.clock_id, this_clock_id());
  for (const Hop hop : {Hop::kLinkSent, Hop::kServer, Hop::kLinkReceived})
    EXPECT_TRUE(pose.stamped(hop).is_set());
  EXPECT_LE(pose.stamped(Hop::kLinkSent) - pose.stamped(Hop::kLinkReceived),
            doubts + Duration::us(2));
  EXPECT_EQ(server->core().counters().records_out, 50u);
  const Stats stats = b->stats(mono_now());
  EXPECT_EQ(stats.forwarded, 50);
  EXPECT_EQ(stats.sessions, 1);
  EXPECT_NE(link_report_json(*b).find("\"id\":\"alice\",\"here\":true,\"received\":50,\"lost\":0"),
            std::string::npos);
}

TEST_F(LoopbackLinks, AServerListsTheGuestsOfARoomForAKeyWithoutAJoin) {
  auto a = link("alice");
  ASSERT_TRUE(turn_until([&] { return a->is_connected(); }));
  const std::vector<wire::RoomName> rooms{guest("tango"), guest("salsa")};
  const auto ask = [&](const LinkKey& with) {
    std::vector<RoomGuests> found;
    const std::atomic<bool> is_ended{false};
    std::atomic<bool> is_done{false};
    std::thread asking([&] {
      found = ask_who_is_there(address, with, rooms, Duration::s(30), is_ended);
      is_done = true;
    });
    EXPECT_TRUE(turn_until([&] { return is_done.load(); }));
    asking.join();
    return found;
  };
  const auto found = ask(link_key());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].state, RoomGuests::State::kKnown);
  EXPECT_EQ(found[0].count, 0u);
  EXPECT_EQ(found[1].state, RoomGuests::State::kKnown);
  ASSERT_EQ(found[1].names.size(), 1u);
  EXPECT_EQ(found[1].names[0], guest("alice"));
  EXPECT_EQ(server->core().session_count(), 1u);
  EXPECT_EQ(server->core().room_count(), 1u);
  EXPECT_TRUE(turn_until([&] { return server->door().peer_count() == 1; })) << "it has gone";
  LinkKey wrong = link_key();
  wrong.key = PresharedKey::make();
  EXPECT_EQ(ask(wrong)[1].state, RoomGuests::State::kRefused);
}

// Between a link and its server. Once it tampers, all that the server says comes twice, and damaged
// before.
class Tamperer {
 public:
  Tamperer(UdpSocket to_link, UdpSocket to_server, Poller& poller)
      : to_link_(std::move(to_link)), to_server_(std::move(to_server)), poller_(poller) {
    poller_.watch(to_link_.fd(), [this](MonoTime) {
      for (const UdpSocket::Datagram& datagram : to_link_.receive()) {
        link_ = datagram.from;
        to_server_.send_now({}, datagram.bytes);
      }
    });
    poller_.watch(to_server_.fd(), [this](MonoTime) {
      for (const UdpSocket::Datagram& datagram : to_server_.receive()) {
        std::vector<std::uint8_t> damaged(datagram.bytes.begin(), datagram.bytes.end());
        damaged.back() ^= 1;
        if (tampers) to_link_.send_now(link_, damaged);
        to_link_.send_now(link_, datagram.bytes);
        if (tampers) to_link_.send_now(link_, datagram.bytes);
      }
    });
  }
  ~Tamperer() {
    poller_.unwatch(to_link_.fd());
    poller_.unwatch(to_server_.fd());
  }
  Tamperer(const Tamperer&) = delete;
  Tamperer& operator=(const Tamperer&) = delete;
  Address address() const { return to_link_.local_address(); }

  bool tampers = false;

 private:
  UdpSocket to_link_;
  UdpSocket to_server_;
  Poller& poller_;
  Address link_;
};

TEST_F(LoopbackLinks, ALinkReportsDatagramsThatItsSealRefused) {
  auto to_link = UdpSocket::bind(Address::loopback(0));
  auto to_server = UdpSocket::connect(address);
  ASSERT_TRUE(to_link && to_server);
  Tamperer between(std::move(*to_link), std::move(*to_server), *poller);
  address = between.address();
  auto a = link("alice");
  ASSERT_TRUE(turn_until([&] { return a->is_connected(); }));
  const SealClientCounters& seal = a->seal_counters();
  EXPECT_GE(seal.sessions, 1u);
  const SealClientCounters before = seal;
  between.tampers = true;
  ASSERT_TRUE(turn_until(
      [&] { return seal.forged >= before.forged + 3 && seal.replayed >= before.replayed + 3; }));
  EXPECT_TRUE(turn_until([&] { return a->is_connected(); })) << "it is none the worse for that";
  const auto report = nlohmann::json::parse(link_report_json(*a));
  EXPECT_EQ(report["forged"], seal.forged);
  EXPECT_EQ(report["replayed"], seal.replayed);
  EXPECT_EQ(report["handshakes_begun"], seal.tries);
  EXPECT_EQ(report["handshakes_done"], seal.sessions);
  const auto rejected = static_cast<std::int64_t>(a->counters().rejected_datagrams + seal.forged);
  EXPECT_EQ(a->stats(mono_now()).rejected_datagrams, rejected);
}

TEST(SealTroubleText, SaysNothingWhereThereWasNoneAndElseEachThing) {
  SealClientCounters seal;
  seal.tries = seal.sessions = 1;
  EXPECT_EQ(seal_trouble_text(seal), "");
  seal.forged = 3;
  EXPECT_EQ(seal_trouble_text(seal), ", 3 datagrams forged or damaged");
  seal.tries = 5;
  seal.sessions = 2;
  seal.replayed = 7;
  EXPECT_EQ(
      seal_trouble_text(seal),
      ", 5 handshakes begun, 2 done, 3 datagrams forged or damaged, 7 came twice or far too late");
  seal = {};
  seal.tries = 4;
  EXPECT_EQ(seal_trouble_text(seal), ", 4 handshakes begun, 0 done");
}

TEST_F(LoopbackLinks, AServerStartedAgainOnItsPortGetsItsLinksBack) {
  auto a = link("alice");
  ASSERT_TRUE(turn_until([&] { return a->is_connected(); }));
  server->send_goodbye();
  server.reset();
  ASSERT_TRUE(turn_until([&] { return !a->is_connected(); }));
  auto again = Server::open(address, options, *poller);
  ASSERT_TRUE(again) << again.error().what;
  ASSERT_TRUE(turn_until([&] { return a->is_connected(); }));
  EXPECT_EQ(a->counters().reconnects, 1u);
  EXPECT_GE(a->seal_counters().sessions, 2u) << "a new server, a new seal";
}

TEST_F(LoopbackLinks, ALinkThatEndsSaysGoodbye) {
  auto a = link("alice");
  auto b = link("bob");
  ASSERT_TRUE(turn_until([&] { return a->remote_stats().size() == 1; }));
  b.reset();
  ASSERT_TRUE(turn_until([&] { return !a->remote_stats().at(0).is_here; }));
  EXPECT_EQ(server->core().counters().goodbyes, 1u);
}

TEST_F(LoopbackLinks, SessionsSurviveALineThatLosesAThird) {
  auto proxy = LossyProxy::open(Address::loopback(0), address,
                                *load_line({.link = "loss=33% dup=5% delay=1ms seed=5"}), *poller);
  ASSERT_TRUE(proxy);
  address = (*proxy)->local_address();
  std::uint32_t last = 0;
  std::size_t heard = 0;
  LinkHandlers handlers;
  handlers.on_pose = [&](const GuestId&, const Pose& pose, MonoTime) {
    EXPECT_GT(pose.sequence, last) << "never an older one after a newer one";
    last = pose.sequence;
    ++heard;
  };
  auto a = link("alice");
  auto b = link("bob", handlers);
  ASSERT_TRUE(turn_until([&] { return !b->remote_stats().empty() && a->is_connected(); }));
  std::uint32_t sent = 0;
  MonoTime due = mono_now();
  ASSERT_TRUE(turn_until([&] {
    const MonoTime now = mono_now();
    if (now >= due) {  // a server takes so many poses a second from a guest
      a->send(guest("alice"), pose_number(++sent, now, this_clock_id()), now);
      due = now + Duration::ms(8);
    }
    return heard >= 40;
  }));
  const auto stats = b->remote_stats();
  ASSERT_EQ(stats.size(), 1u);
  EXPECT_GT(stats[0].lost, 0u);
  // Some refer to what was lost. One that the server keeps may fail, be said again, and then
  // decode; none goes without a trace.
  const std::uint64_t failed =
      stats[0].reference_missing + stats[0].skeleton_missing + stats[0].invalid;
  EXPECT_LE(stats[0].received, heard + failed);
  EXPECT_GE(stats[0].received, heard);
}

TEST_F(LoopbackLinks, ARoomsKeyDoesNotOpenANameWithItsOwnKey) {
  KeyEntry carol = key;
  carol.name = *GuestId::parse("carol");
  carol.kind = KeyKind::kGuest;
  KeyRing ring;
  ASSERT_TRUE(ring.add(key) && ring.add(carol));
  server->set_keys(std::make_shared<const KeyRing>(std::move(ring)));
  std::vector<wire::Refusal> refusals;
  LinkHandlers handlers;
  handlers.on_refused = [&](const wire::RefusalNotice& refusal, MonoTime) {
    refusals.push_back(refusal.cause);
  };
  auto stranger = link("carol", handlers);
  ASSERT_TRUE(turn_until([&] { return !refusals.empty(); }));
  EXPECT_EQ(refusals[0], wire::Refusal::kNotAllowedName);
  auto other = link("dave");
  EXPECT_TRUE(turn_until([&] { return other->is_connected(); }));
}

TEST_F(LoopbackLinks, GuestsOfARevokedKeyLeaveTheRoomAtOnce) {
  auto a = link("alice");
  ASSERT_TRUE(turn_until([&] { return a->is_connected(); }));
  auto none = std::make_shared<const KeyRing>();
  server->set_keys(none);
  EXPECT_EQ(server->core().session_count(), 0u);
  EXPECT_EQ(server->door().peer_count(), 0u);
  ASSERT_TRUE(turn_until([&] { return !a->is_connected(); }));
}

TEST_F(LoopbackLinks, ATakenPortIsNamed) {
  const auto second = Server::open(address, options, *poller);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("is taken"), std::string::npos);
}

}  // namespace
}  // namespace dance
