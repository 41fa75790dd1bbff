// Links to a server that has a name: unknown at the start, with another address later, or with a
// resolver that is silent.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "testing/line/lossy_proxy.h"
#include "tests/tunnel/names/loopback.h"

namespace dance {
namespace {

using NamedLink = LoopbackLinks;

// The address that a name has, as the look-up's thread reads it; port 0: the name is unknown.
class NamedServer {
 public:
  explicit NamedServer(std::uint16_t port) : port_(port) {}
  void move_to(std::uint16_t port) { port_ = port; }
  std::function<Result<std::vector<Address>>()> look_up() {
    return [this]() -> Result<std::vector<Address>> {
      ++count_;
      const std::uint16_t port = port_;
      if (port == 0) return fail("host 'dance.example.org' is unknown");
      return std::vector{Address::loopback(port)};
    };
  }
  int count() const { return count_; }

 private:
  std::atomic<std::uint16_t> port_;
  std::atomic<int> count_ = 0;
};

TEST_F(NamedLink, ALinkConnectsOnceAnUnknownNameIsResolved) {
  NamedServer named(0);
  LinkOptions of;
  of.room = guest("salsa");
  of.look_up = named.look_up();
  std::vector<std::string> unknown;
  std::vector<Address> found;
  LinkHandlers handlers;
  handlers.on_unknown_name = [&](const std::string& why) { unknown.push_back(why); };
  handlers.on_new_address = [&](const Address& at) { found.push_back(at); };
  auto opened = Link::open({}, link_key(), of, std::move(handlers), *poller);
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_FALSE((*opened)->server().is_set());
  ASSERT_TRUE(turn_until([&] { return !unknown.empty(); }));
  EXPECT_EQ(unknown[0], "host 'dance.example.org' is unknown");
  // A pose that the house publishes meanwhile is dropped without harm.
  (*opened)->send(guest("alice"), Pose(), mono_now());
  named.move_to(address.port());
  EXPECT_TRUE(turn_until([&] { return (*opened)->is_connected(); }));
  EXPECT_EQ(found, std::vector{address});
}

TEST_F(NamedLink, ALinkFollowsTheNameOfASilentServerToItsNewAddress) {
  NamedServer named(address.port());
  LinkOptions of;
  of.room = guest("salsa");
  of.look_up = named.look_up();
  auto opened = Link::open({address}, link_key(), of, {}, *poller);
  ASSERT_TRUE(opened);
  ASSERT_TRUE(turn_until([&] { return (*opened)->is_connected(); }));
  EXPECT_EQ(named.count(), 0) << "nothing is looked up while the server answers";
  auto elsewhere = Server::open(Address::loopback(0), options, *poller);
  ASSERT_TRUE(elsewhere);
  const Address moved = (*elsewhere)->local_address();
  named.move_to(moved.port());
  server.reset();
  ASSERT_TRUE(turn_until([&] { return !(*opened)->is_connected(); }));
  EXPECT_TRUE(turn_until([&] { return (*opened)->is_connected(); }));
  EXPECT_EQ((*opened)->server(), moved);
}

// A session that the server still has goes on when the server has moved: behind another address of
// a proxy, as behind a router with a new address.
TEST_F(NamedLink, ALinkJoinsAgainWhenTheServersAddressChanges) {
  auto first = LossyProxy::open(Address::loopback(0), address, {}, *poller);
  auto second = LossyProxy::open(Address::loopback(0), address, {}, *poller);
  ASSERT_TRUE(first && second);
  NamedServer named((*first)->local_address().port());
  LinkOptions of;
  of.room = guest("salsa");
  of.look_up = named.look_up();
  auto opened = Link::open({(*first)->local_address()}, link_key(), of, {}, *poller);
  ASSERT_TRUE(opened);
  ASSERT_TRUE(turn_until([&] { return (*opened)->is_connected(); }));
  named.move_to((*second)->local_address().port());
  first->reset();
  ASSERT_TRUE(turn_until([&] { return (*opened)->server() == (*second)->local_address(); }));
  EXPECT_TRUE(turn_until([&] { return (*opened)->is_connected(); }));
}

TEST_F(NamedLink, ASilentResolverDelaysNeitherALinkNorItsEnd) {
  const auto silent = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(silent);
  const auto release = std::make_shared<std::promise<void>>();
  const auto released = std::make_shared<std::shared_future<void>>(release->get_future());
  std::atomic<bool> has_begun = false;
  LinkOptions of;
  of.room = guest("salsa");
  of.look_up = [&has_begun, released]() -> Result<std::vector<Address>> {
    has_begun = true;
    released->wait();
    return fail("the name server does not answer");
  };
  auto opened = Link::open({silent->local_address(), address}, link_key(), of, {}, *poller);
  ASSERT_TRUE(opened);
  ASSERT_TRUE(turn_until([&] { return has_begun.load(); }));
  EXPECT_TRUE(turn_until([&] { return (*opened)->is_connected(); }));
  opened->reset();
  release->set_value();
}

}  // namespace
}  // namespace dance
