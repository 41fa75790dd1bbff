#include "producers/natnet/natnet_place.h"

namespace dance {
namespace {

Result<void> read_word(const std::string& name, const std::string& value, NatNetPlace& place) {
  if (name == "interface") {
    DANCE_TRY(place.interface, Address::resolve(value, kNatNetDataPort));
    if (place.interface.family() != Address::Family::kIpv4)
      return fail("interface=" + value + ": an IPv4 address of this machine, as 192.168.1.20");
    return {};
  }
  if (name == "server") {
    DANCE_TRY(place.server, Address::resolve(value, kNatNetCommandPort));
    return {};
  }
  if (name == "version") {
    place.version = parse_natnet_version(value);
    if (!place.version) return fail("version=" + value + ": 3.0, 3.1, 4.0 or 4.1");
    return {};
  }
  if (name == "up" && (value == "y" || value == "z")) {
    place.z_is_up = value == "z";
    return {};
  }
  return fail("'" + name + "=" + value +
              "': known are interface=ADDRESS, server=HOST, version=3.1 and up=z");
}

}  // namespace

Result<NatNetPlace> parse_natnet_place(const std::string& text) {
  const std::string given = text.empty() ? kUsualNatNetPlace : text;
  NatNetPlace place;
  const std::size_t mark = given.find('?');
  DANCE_TRY(place.listen, Address::resolve(given.substr(0, mark), kNatNetDataPort));
  for (std::size_t at = mark; at != std::string::npos && at < given.size();) {
    const std::size_t end = given.find('&', at + 1);
    const std::string word = given.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      return fail("'" + word + "' in '" + given + "': a word and its value, as server=192.168.1.5");
    if (auto read = read_word(word.substr(0, equals), word.substr(equals + 1), place); !read)
      return tl::make_unexpected(read.error());
    at = end;
  }
  if (place.interface.is_set() && !place.listen.is_multicast())
    return fail("interface= belongs to a multicast group, as 239.255.42.99:1511, not to " +
                place.listen.to_string());
  return place;
}

}  // namespace dance
