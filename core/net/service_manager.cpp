#include "core/net/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace dance {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before threads start
  return value != nullptr ? std::string_view(value) : std::string_view();
}

std::int64_t number_or_zero(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

}  // namespace

ServiceManager::ServiceManager() {
  address_ = environment("NOTIFY_SOCKET");
  if (address_.empty() || (address_[0] != '/' && address_[0] != '@') ||
      address_.size() >= sizeof(sockaddr_un::sun_path))
    return;
  if (address_[0] == '@') address_[0] = '\0';  // Linux's abstract names
  fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  // A parent's watchdog is not ours.
  const std::int64_t pid = number_or_zero(environment("WATCHDOG_PID"));
  constexpr std::int64_t kHour_us = 3'600'000'000;
  if (pid == 0 || pid == ::getpid())
    alive_period_ = Duration::us(
        std::clamp<std::int64_t>(number_or_zero(environment("WATCHDOG_USEC")), 0, kHour_us) / 2);
}

ServiceManager::~ServiceManager() {
  if (fd_ >= 0) ::close(fd_);
}

void ServiceManager::say(std::string_view words) {
  if (fd_ < 0) return;
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  std::memcpy(to.sun_path, address_.data(), address_.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size() +
                                             (address_[0] == '/' ? 1 : 0));
  [[maybe_unused]] const ssize_t sent =
      ::sendto(fd_, words.data(), words.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&to), length);
}

}  // namespace dance
