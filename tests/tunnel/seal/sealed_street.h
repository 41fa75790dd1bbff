// A door and houses with a street between them and no sockets: what passes can be looked at, lost,
// changed, doubled and sent from elsewhere.
//
// Units/frames: now() moves only when the test moves it; OpenSSL's own timers are real.
// Ownership:    owns everything.
// Threads:      none.
// Failure:      aborts where OpenSSL cannot be set up.
#pragma once

#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/tunnel/seal/guest_key.h"
#include "tunnel/seal/seal_client.h"
#include "tunnel/seal/seal_server.h"

namespace dance {

class SealedStreet {
 public:
  struct Passing {
    bool to_server = false;
    Address peer;
    std::vector<std::uint8_t> bytes;
  };
  struct House {
    Address address;
    std::unique_ptr<DatagramSink> sink;
    std::unique_ptr<SealClient> client;
    std::vector<std::string> heard;
    int sealed = 0;
    std::vector<SealTrouble> troubles;
    bool is_cut = false;
  };
  struct Heard {
    std::uint64_t peer;
    std::string name;
    std::string text;
  };

  explicit SealedStreet(std::vector<KeyEntry> entries, const SealLimits& of = {}) : limits(of) {
    set_keys(std::move(entries));
    start_server();
  }

  // What its ends still say is nobody's business: the test may have ended before.
  ~SealedStreet() { on_passing = {}; }
  SealedStreet(const SealedStreet&) = delete;
  SealedStreet& operator=(const SealedStreet&) = delete;

  void set_keys(std::vector<KeyEntry> entries) {
    KeyRing ring;
    for (const KeyEntry& entry : entries)
      if (!ring.add(entry)) std::abort();
    keys = std::make_shared<const KeyRing>(std::move(ring));
    if (server) server->set_keys(keys);
  }

  void start_server() {
    SealServer::Handlers handlers;
    handlers.on_datagram = [this](std::uint64_t peer, const KeyEntry& key, seal::Bytes plain,
                                  MonoTime, MonoTime) {
      heard.push_back(
          {peer, std::string(key.name.view()), std::string(plain.begin(), plain.end())});
    };
    handlers.on_end = [this](std::uint64_t peer) { ended.push_back(peer); };
    auto made = SealServer::make(
        limits, identity, keys, certificates, [this] { return random.next_u64(); },
        std::move(handlers), server_sink);
    if (!made) std::abort();
    server = std::move(*made);
  }

  // Adds a house that authenticates with its own key and, if given, with a grant's.
  House& add_house(const std::string& name, const PrivateKey& house,
                   const std::optional<PrivateKey>& grant = std::nullopt) {
    const auto key = house_session_key(house, grant, identity.public_key());
    if (!key) std::abort();
    return add_house(identity_text(name, house.public_key()), *key, identity.public_key());
  }
  House& add_house(const std::string& identity_of_house, const PresharedKey& key,
                   const PublicKey& server_key) {
    auto context = SealContext::for_link(identity_of_house, key, server_key);
    if (!context) std::abort();
    return add_house(std::move(*context));
  }

  House& add_house(std::unique_ptr<SealContext> context) {
    houses.push_back(std::make_unique<House>());
    House& house = *houses.back();
    house.address = Address::loopback(static_cast<std::uint16_t>(10'000 + houses.size()));
    SealClient::Handlers handlers;
    handlers.on_sealed = [&house](MonoTime) { ++house.sealed; };
    handlers.on_datagram = [&house](seal::Bytes plain, MonoTime, MonoTime) {
      house.heard.emplace_back(plain.begin(), plain.end());
    };
    handlers.on_trouble = [&house](SealTrouble trouble, MonoTime) {
      house.troubles.push_back(trouble);
    };
    house.sink = std::make_unique<HouseSink>(*this, house);
    house.client = std::make_unique<SealClient>(
        std::move(context), [this] { return random.next_u64(); }, std::move(handlers), *house.sink);
    return house;
  }

  // Lets all that is on the way arrive, and time pass.
  void run(Duration duration) {
    const MonoTime end = now + duration;
    do {
      for (auto& house : houses)
        if (now >= house->client->next_deadline()) house->client->tick(now);
      if (server) server->tick(now);
      while (!passing.empty()) {
        const Passing next = std::move(passing.front());
        passing.pop_front();
        deliver(next);
      }
      now += Duration::ms(5);
    } while (now < end);
  }

  void deliver(const Passing& next) {
    if (next.to_server) {
      if (server) server->receive(next.peer, next.bytes, now, now);
      return;
    }
    for (auto& house : houses)
      if (house->address == next.peer && !house->is_cut)
        house->client->receive(next.bytes, now, now);
  }

  void inject(const Address& from, std::vector<std::uint8_t> bytes) {
    server->receive(from, bytes, now, now);
  }
  void say(House& house, std::string_view text) {
    house.client->send({}, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  void answer(std::uint64_t peer, std::string_view text) {
    server->send(peer, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  std::size_t bytes_to(const Address& address) const {
    std::size_t sum = 0;
    for (const Passing& p : sent)
      if (!p.to_server && p.peer == address) sum += p.bytes.size();
    return sum;
  }

  SealLimits limits;
  PrivateKey identity = PrivateKey::make();
  Random random{7};
  MonoTime now = MonoTime::from_us(1'000'000'000);
  std::optional<SealCertificates> certificates;
  std::shared_ptr<const KeyRing> keys;
  std::vector<Heard> heard;
  std::vector<std::uint64_t> ended;
  std::vector<Passing> sent;  // all that ever left
  std::deque<Passing> passing;
  // Return false to lose it.
  std::function<bool(Passing&)> on_passing;
  std::vector<std::unique_ptr<House>> houses;

 private:
  void post(Passing next) {
    sent.push_back(next);
    if (!on_passing || on_passing(next)) passing.push_back(std::move(next));
  }
  class ServerSink final : public DatagramSink {
   public:
    explicit ServerSink(SealedStreet& street) : street_(street) {}
    void send(const Address& to, std::span<const std::uint8_t> bytes) override {
      street_.post({false, to, {bytes.begin(), bytes.end()}});
    }

   private:
    SealedStreet& street_;
  };
  class HouseSink final : public DatagramSink {
   public:
    HouseSink(SealedStreet& street, House& house) : street_(street), house_(house) {}
    void send(const Address&, std::span<const std::uint8_t> bytes) override {
      if (!house_.is_cut) street_.post({true, house_.address, {bytes.begin(), bytes.end()}});
    }

   private:
    SealedStreet& street_;
    House& house_;
  };
  ServerSink server_sink{*this};

 public:
  std::unique_ptr<SealServer> server;
};

}  // namespace dance
