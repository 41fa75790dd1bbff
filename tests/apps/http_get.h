// One page over plain TCP, as a scraper of metrics asks for it.
//
// Ownership: plain values.
// Threads:   any; waits up to five seconds.
// Failure:   who is not there, or does not answer, gives "".
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>

namespace dance {

// A connection that has asked; -1 where nobody is.
inline int http_ask(std::uint16_t port, const std::string& page) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval timeout{5, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::string request =
      "GET " + page + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 &&
      ::send(fd, request.data(), request.size(), MSG_NOSIGNAL) ==
          static_cast<ssize_t>(request.size()))
    return fd;
  ::close(fd);
  return -1;
}

// Head and body.
inline std::string http_get(std::uint16_t port, const std::string& page) {
  const int fd = http_ask(port, page);
  if (fd < 0) return "";
  std::string answer;
  std::array<char, 4096> chunk;
  for (ssize_t n; (n = ::recv(fd, chunk.data(), chunk.size(), 0)) > 0;)
    answer.append(chunk.data(), static_cast<std::size_t>(n));
  ::close(fd);
  return answer;
}

inline void http_ask_and_leave(std::uint16_t port, const std::string& page) {
  const int fd = http_ask(port, page);
  if (fd < 0) return;
  const linger at_once{1, 0};  // with a reset, so that the answer meets a closed door
  ::setsockopt(fd, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  ::close(fd);
}

}  // namespace dance
