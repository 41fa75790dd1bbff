// From REMOVAL/local on a host's bus to HOUSE_LINK/local on the bus of the house that is removed:
// two houses with buses, links and keys of their own, and a server.
#include <gtest/gtest.h>

#include <functional>

#include "core/net/mono_clock.h"
#include "tunnel/link/link_bus.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

GuestId named(const char* name) { return *GuestId::parse(name); }

KeyEntry key_of(const char* name, KeyKind kind) {
  KeyEntry key;
  key.name = named(name);
  key.kind = kind;
  key.key = PresharedKey::make();
  return key;
}

// As dance link puts them together; the bus is heard as a viewer hears it.
struct BusHouse {
  BusHouse(const std::string& url, const KeyEntry& key, const Address& server, Poller& poller) {
    auto opened = Bus::open(url);
    EXPECT_TRUE(opened) << opened.error().what;
    bus = std::move(*opened);
    captures = std::make_unique<Captures>(*bus, this_clock_id());
    link_bus = std::make_unique<LinkBus>(*bus, *captures, this_clock_id());
    LinkHandlers handlers = link_bus->handlers();
    handlers.on_refused = [this](const wire::RefusalNotice& refusal, MonoTime) {
      line = refusal_line(refusal, named("salsa"));
    };
    link_bus->tell_status(handlers);
    LinkOptions options;
    options.room = named("salsa");
    EXPECT_TRUE(options.guests.try_push(key.name));
    LinkKey link_key;
    link_key.name = std::string(key.name.view());
    link_key.key = key.key;
    auto made = Link::open({server}, link_key, options, std::move(handlers), poller);
    EXPECT_TRUE(made) << made.error().what;
    link = std::move(*made);
    link_bus->attach(*link);
    link_bus->follow_removals();
    auto viewer_bus = Bus::open(url);
    EXPECT_TRUE(viewer_bus) << viewer_bus.error().what;
    viewer = std::move(*viewer_bus);
    viewer->subscribe<HouseLink>(
        Where::kLocal, [this](const Channel&, const HouseLink& told, MonoTime) { status = told; });
    for (Bus* of : {bus.get(), viewer.get()})
      poller.watch(of->fd(), [of](MonoTime now) { of->drain(now); });
    poller.add_timer(mono_now(), [this](MonoTime now) {
      link_bus->publish_second(now);
      return now + Duration::ms(200);
    });
  }
  void ask(const Removal& removal) {
    viewer->publish(Channel::of_house(Signal::kRemoval), removal);
  }

  std::unique_ptr<Bus> bus, viewer;
  std::unique_ptr<Captures> captures;
  std::unique_ptr<LinkBus> link_bus;
  std::unique_ptr<Link> link;
  HouseLink status;
  std::string line;
};

class RemovalBus : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller_ = std::move(*made);
    KeyRing ring;
    ASSERT_TRUE(ring.add(host_key_) && ring.add(guest_key_));
    ServerOptions options;
    options.keys = std::make_shared<const KeyRing>(std::move(ring));
    auto opened = Server::open(Address::loopback(0), options, *poller_);
    ASSERT_TRUE(opened) << opened.error().what;
    server_ = std::move(*opened);
    host_ = std::make_unique<BusHouse>("udpm://239.255.76.67:17667?ttl=0", host_key_,
                                       server_->local_address(), *poller_);
    bob_ = std::make_unique<BusHouse>("udpm://239.255.76.67:17668?ttl=0", guest_key_,
                                      server_->local_address(), *poller_);
    ASSERT_TRUE(turn_until([&] {
      return host_->status.state == HouseLinkState::kConnected && host_->status.may_remove &&
             bob_->status.state == HouseLinkState::kConnected;
    }));
  }
  // The time only ends a test that has failed.
  bool turn_until(const std::function<bool()>& is_so) {
    const MonoTime given_up = mono_now() + Duration::s(30);
    while (!is_so() && mono_now() < given_up) poller_->run_once(Duration::ms(5));
    return is_so();
  }

  KeyEntry host_key_ = key_of("hanna", KeyKind::kHost);
  KeyEntry guest_key_ = key_of("bob", KeyKind::kGuest);
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<BusHouse> host_, bob_;
};

TEST_F(RemovalBus, AHostsWindowRemovesAGuestAndBothHousesAreTold) {
  EXPECT_FALSE(bob_->status.may_remove);
  host_->ask({mono_now(), this_clock_id(), 5, named("bob")});
  ASSERT_TRUE(turn_until([&] { return host_->status.verdict == RemovalVerdict::kDone; }));
  EXPECT_EQ(host_->status.removal, 5);
  ASSERT_TRUE(turn_until([&] { return bob_->status.trouble == HouseLinkTrouble::kRemoved; }));
  EXPECT_EQ(bob_->status.state, HouseLinkState::kConnecting);
  EXPECT_GT(bob_->status.asks_again - mono_now(), Duration::s(560));
  EXPECT_EQ(bob_->line,
            "a host has removed this house from room 'salsa': it asks again in 10 minutes, and no "
            "earlier; ask the host");
  EXPECT_EQ(server_->core().guest_count(), 1u);
}

TEST_F(RemovalBus, WhatARecordingOrAGuestSaysRemovesNobody) {
  host_->ask({mono_now(), this_clock_id() + 1, 6, named("bob")});  // of another house's clock
  host_->ask({mono_now() - Duration::s(60), this_clock_id(), 7, named("bob")});
  bob_->ask({mono_now(), this_clock_id(), 8, named("hanna")});
  ASSERT_TRUE(turn_until([&] { return bob_->status.verdict == RemovalVerdict::kNotAllowed; }));
  host_->ask({mono_now(), this_clock_id(), 9, named("nobody")});
  ASSERT_TRUE(turn_until([&] { return host_->status.verdict == RemovalVerdict::kNoSuchGuest; }));
  EXPECT_EQ(host_->status.removal, 9) << "the others were not obeyed";
  EXPECT_EQ(server_->core().guest_count(), 2u);
}

}  // namespace
}  // namespace dance
