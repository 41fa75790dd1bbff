// Datagrams at a server's door and at a house that waits for its answers: beside a session that
// stands, a handshake under way and strangers.
//
// The input is a list of datagrams: a byte that says where to and where from, a length, bytes.
// Bytes that stand where an id belongs are replaced by one that means something, as nobody guesses
// those.
#include "tests/fuzz_target.h"
#include "tests/tunnel/seal/sealed_street.h"

namespace {

struct Scene {
  Scene() {
    street.run(dance::Duration::ms(20));
    if (house.sealed != 1) std::abort();
    house.client->send({}, std::vector<std::uint8_t>{1});
    street.run(dance::Duration::ms(5));
    // A second one stays half way.
    street.on_passing = [](dance::SealedStreet::Passing& passing) {
      return !passing.to_server ||
             dance::seal::cookie_of(dance::seal::parse(passing.bytes)->body).has_value();
    };
    half.client->tick(street.now);
    street.run(dance::Duration::ms(10));
    half_id = dance::seal::parse(street.sent.back().bytes)->id;
  }
  const dance::GuestKey alice = dance::key_of("alice");
  dance::SealedStreet street{{alice}};
  dance::SealedStreet::House& house = street.add_house("alice", alice.own);
  dance::SealedStreet::House& half = street.add_house("alice", alice.own);
  std::uint64_t half_id = 0;
};

void play(Scene& scene, std::uint8_t how, std::vector<std::uint8_t> bytes) {
  auto& street = scene.street;
  const std::uint64_t ids[] = {street.heard.at(0).peer, scene.half_id, 0x1230, 0};
  const auto id = ids[how & 3];
  if (id != 0 && bytes.size() >= dance::seal::kIdBytes)
    dance::seal::write_opening(id, static_cast<dance::seal::Form>(bytes[0] % 3), bytes);
  const dance::Address from[] = {scene.house.address, scene.half.address,
                                 dance::Address::loopback(9), dance::Address::loopback(10)};
  if (how & 64)
    scene.house.client->receive(bytes, street.now, street.now);
  else if (how & 128)
    scene.half.client->receive(bytes, street.now, street.now);
  else
    street.inject(from[how >> 2 & 3], std::move(bytes));
}

}  // namespace

DANCE_FUZZ_TARGET(seal_datagram) {
  Scene scene;
  std::size_t at = 0;
  while (at + 2 < size) {
    const std::uint8_t how = data[at];
    const std::size_t length = std::min<std::size_t>(data[at + 1] * 2u, size - at - 2);
    play(scene, how, {data + at + 2, data + at + 2 + length});
    at += 2 + length;
  }
  scene.street.on_passing = {};
  scene.street.passing.clear();
  // Whatever came, who was in stays in, and who could come can still come.
  scene.house.heard.clear();
  scene.street.heard.clear();
  scene.house.address = dance::Address::loopback(77);
  scene.house.client->send({}, std::vector<std::uint8_t>{42});
  scene.street.run(dance::Duration::ms(10));
  if (scene.street.heard.size() != 1) std::abort();
  return 0;
}
