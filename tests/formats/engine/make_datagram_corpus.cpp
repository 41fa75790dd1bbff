// Writes valid datagrams of the way back into the folder that is named: what datagram_fuzz reads.

#include <fstream>
#include <string>

#include "formats/engine/datagram.h"

namespace {

template <class Value>
void write(const std::string& path, const Value& value) {
  dance::engine::DatagramBuffer buffer;
  const auto bytes = dance::engine::encode(7, value, buffer);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  dance::Pose pose;
  pose.capture_time = dance::MonoTime::from_ns(123'456'789);
  write(folder + "/pose.bin", pose);
  dance::Hands hands;
  hands.capture_time = pose.capture_time;
  hands.presence = 0x7fff;
  write(folder + "/hands.bin", hands);
  write(folder + "/skeleton.bin", dance::average_skeleton());
  return 0;
}
