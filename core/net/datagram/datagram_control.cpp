#include "core/net/datagram/datagram_control.h"

#include <netinet/in.h>

#include <cstring>
#include <ctime>

namespace dance {
namespace {

static_assert(kControlBytes >= CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(in6_pktinfo)));

// The kernel stamps with the wall clock: only the age of the stamp is taken over, and only while it
// is plausible (the wall clock may be set at any time).
MonoTime receive_time(const timespec& stamp, const ClockReadings& read) {
  const std::int64_t age_ns =
      read.wall_ns - (static_cast<std::int64_t>(stamp.tv_sec) * 1'000'000'000 + stamp.tv_nsec);
  const bool is_plausible = age_ns > 0 && age_ns < 100'000'000;
  return is_plausible ? read.mono - Duration::ns(age_ns) : read.mono;
}

template <class T>
T data_of(cmsghdr* part) {
  T data{};
  std::memcpy(&data, CMSG_DATA(part), sizeof data);
  return data;
}

template <class T>
void put_control(msghdr& header, int level, int type, const T& data) {
  header.msg_controllen = CMSG_SPACE(sizeof data);
  cmsghdr* part = CMSG_FIRSTHDR(&header);
  part->cmsg_level = level;
  part->cmsg_type = type;
  part->cmsg_len = CMSG_LEN(sizeof data);
  std::memcpy(CMSG_DATA(part), &data, sizeof data);
}

}  // namespace

void read_control(msghdr& header, const ClockReadings& read, Address& from, MonoTime& received) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_TIMESTAMPNS) {
      received = receive_time(data_of<timespec>(c), read);
    } else if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_PKTINFO) {
      sockaddr_in asked{};
      asked.sin_family = AF_INET;
      asked.sin_addr = data_of<in_pktinfo>(c).ipi_spec_dst;
      sockaddr_storage raw{};
      std::memcpy(&raw, &asked, sizeof asked);
      from = from.with_asked(Address::from_sockaddr(raw));
    } else if (c->cmsg_level == IPPROTO_IPV6 && c->cmsg_type == IPV6_PKTINFO) {
      sockaddr_in6 asked{};
      asked.sin6_family = AF_INET6;
      asked.sin6_addr = data_of<in6_pktinfo>(c).ipi6_addr;
      sockaddr_storage raw{};
      std::memcpy(&raw, &asked, sizeof asked);
      from = from.with_asked(Address::from_sockaddr(raw));
    }
  }
}

void set_source(const Address& to, Address::Family socket_family, char* control, msghdr& header) {
  if (!to.has_asked_ip()) return;
  header.msg_control = control;
  if (socket_family == Address::Family::kIpv4) {
    in_pktinfo source{};
    std::memcpy(&source.ipi_spec_dst, to.asked_ip().data(), sizeof source.ipi_spec_dst);
    return put_control(header, IPPROTO_IP, IP_PKTINFO, source);
  }
  // An IPv4 address in its IPv6 form, as to_sockaddr() writes the receiver's.
  sockaddr_storage raw{};
  const std::size_t size = to.family() == Address::Family::kIpv4 ? 4 : 16;
  Address::of(std::span(to.asked_ip()).first(size), 0).to_sockaddr(socket_family, raw);
  in6_pktinfo source{};
  std::memcpy(&source.ipi6_addr, &reinterpret_cast<const sockaddr_in6&>(raw).sin6_addr,
              sizeof source.ipi6_addr);
  put_control(header, IPPROTO_IPV6, IPV6_PKTINFO, source);
}

}  // namespace dance
