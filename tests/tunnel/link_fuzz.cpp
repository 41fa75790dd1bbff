// Datagrams at a link, as if its server had sent them.
#include "tests/tunnel/datagram_script.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dance::FuzzScene scene;
  scene.play({data, size}, [&](int peer, dance::wire::Bytes datagram) {
    auto& house = peer == 1 ? *scene.b : *scene.a;
    house.link->receive(datagram, scene.tunnel.time_in(house), scene.tunnel.time_in(house));
  });
  return 0;
}
