// A server and links with their real sockets, on this machine's loopback address.
//
// Ownership: the fixture's poller and server end with the test.
// Failure:   what cannot be opened fails the test.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "core/net/mono_clock.h"
#include "tests/tunnel/seal/guest_key.h"
#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/link/link.h"
#include "tunnel/server/server.h"

namespace dance {

class LoopbackLinks : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller = std::move(*made);
    KeyRing ring;
    ASSERT_TRUE(ring.add(key));
    options.keys = std::make_shared<const KeyRing>(std::move(ring));
    auto opened = Server::open(Address::loopback(0), options, *poller);
    ASSERT_TRUE(opened) << opened.error().what;
    server = std::move(*opened);
    address = server->local_address();
  }

  std::unique_ptr<Link> link(const char* name, LinkHandlers handlers = {}) {
    LinkOptions of;
    of.room = guest("salsa");
    EXPECT_TRUE(of.guests.try_push(guest(name)));
    auto opened = Link::open({address}, link_key(), of, std::move(handlers), *poller);
    EXPECT_TRUE(opened);
    return std::move(*opened);
  }

  // Turns until it is so; the time only ends a test that has failed.
  bool turn_until(const std::function<bool()>& is_so) {
    const MonoTime given_up = mono_now() + Duration::s(30);
    bool so = is_so();
    for (; !so && mono_now() < given_up; so = is_so()) poller->run_once(Duration::ms(5));
    return so;
  }

  LinkKey link_key() const { return link_key_of(key, options.identity.public_key()); }

  GuestKey key = key_of("any", KeyKind::kRoom);
  ServerOptions options;
  std::unique_ptr<Poller> poller;
  std::unique_ptr<Server> server;
  Address address;
};

}  // namespace dance
