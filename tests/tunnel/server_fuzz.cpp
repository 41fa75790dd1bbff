// Datagrams at a server: of its two links, and of peers without a session yet, of whom one's key
// opens one room for one name.
#include "tests/fuzz_target.h"
#include "tests/tunnel/datagram_script.h"

DANCE_FUZZ_TARGET(server_datagram) {
  dance::FuzzScene scene;
  const auto alice = *dance::GuestId::parse("alice");
  const auto salsa = *dance::wire::RoomName::parse("salsa");
  // A host: it may remove guests, and set what all share.
  const dance::PeerId third = scene.tunnel.add_peer({.role = dance::Role::kHost, .any_name = true});
  const dance::PeerId fourth = scene.tunnel.add_peer({.name = alice, .room = salsa});
  scene.play({data, size}, [&](int peer, dance::wire::Bytes datagram) {
    const dance::PeerId peers[] = {scene.a->peer, scene.b->peer, third, fourth};
    scene.tunnel.inject(peers[peer], datagram);
  });
  return 0;
}
