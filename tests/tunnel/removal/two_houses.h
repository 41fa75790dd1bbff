// Two houses with buses, links and keys of their own, and a server: what a window says on one bus,
// and what the other hears of it.
//
// Ownership: each house owns its buses and its link; the poller must outlive it.
// Threads:   none inside.
// Failure:   a test that uses it fails.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "core/control/house_inputs.h"
#include "core/control/house_publisher.h"
#include "core/net/mono_clock.h"
#include "tests/tunnel/seal/guest_key.h"
#include "tunnel/link/link_bus.h"
#include "tunnel/server/server.h"

namespace dance {

inline GuestId named(const char* name) { return *GuestId::parse(name); }

// As dance link puts them together; the bus is heard as a viewer hears it.
struct BusHouse {
  BusHouse(const std::string& url, const GuestKey& key, const PublicKey& server_key,
           const Address& server, Poller& poller) {
    auto opened = Bus::open(url);
    EXPECT_TRUE(opened) << opened.error().what;
    bus = std::move(*opened);
    HouseInputs::Options taken;
    taken.bus_url = url;
    inputs = std::make_unique<HouseInputs>(*bus, *bus, std::move(taken), poller);
    captures = std::make_unique<Captures>(*inputs, this_clock_id());
    link_bus = std::make_unique<LinkBus>(*bus, *captures, this_clock_id());
    LinkHandlers handlers = link_bus->handlers();
    handlers.on_refused = [this](const wire::RefusalNotice& refusal, MonoTime) {
      line = refusal_line(refusal, named("salsa"));
    };
    link_bus->tell_status(handlers);
    LinkOptions options;
    options.room = named("salsa");
    EXPECT_TRUE(options.guests.try_push(key.name));
    LinkBus::add_own_rules(options.channels);
    auto made =
        Link::open({server}, link_key_of(key, server_key), options, std::move(handlers), poller);
    EXPECT_TRUE(made) << made.error().what;
    link = std::move(*made);
    link_bus->attach(*link);
    link_bus->follow_hearing({});
    link_bus->follow_interest({});
    link_bus->follow_removals();
    link_bus->send_signals_of(key.name);
    auto viewer_bus = Bus::open(url);
    EXPECT_TRUE(viewer_bus) << viewer_bus.error().what;
    viewer = std::move(*viewer_bus);
    port = std::make_unique<HousePublisher>(*viewer, url, poller);
    viewer->subscribe<HouseLink>(
        Where::kLocal, [this](const Channel&, const HouseLink& told, MonoTime) { status = told; });
    for (Bus* of : {bus.get(), viewer.get()})
      poller.watch(of->fd(), [of](MonoTime now) { of->drain(now); });
    poller.add_timer(mono_now(), [this](MonoTime now) {
      link_bus->publish_second(now);
      return now + Duration::ms(200);
    });
  }
  void ask(const Removal& removal) { port->publish(Channel::of_house(Signal::kRemoval), removal); }

  std::unique_ptr<Bus> bus, viewer;
  std::unique_ptr<HousePublisher> port;  // of the viewer
  std::unique_ptr<HouseInputs> inputs;
  std::unique_ptr<Captures> captures;
  std::unique_ptr<LinkBus> link_bus;
  std::unique_ptr<Link> link;
  HouseLink status;
  std::string line;
};

class RemovalHouses : public testing::Test {
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
    const PublicKey server_key = options.identity.public_key();
    host_ = std::make_unique<BusHouse>("udpm://239.255.76.67:17667?ttl=0", host_key_, server_key,
                                       server_->local_address(), *poller_);
    bob_ = std::make_unique<BusHouse>("udpm://239.255.76.67:17668?ttl=0", guest_key_, server_key,
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

  GuestKey host_key_ = key_of("hanna", KeyKind::kHost);
  GuestKey guest_key_ = key_of("bob", KeyKind::kGuest);
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<BusHouse> host_, bob_;
};

}  // namespace dance
