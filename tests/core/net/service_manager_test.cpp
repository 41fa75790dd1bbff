// What a service manager hears, with a socket in the place of systemd's.
#include "core/net/service_manager.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

namespace dance {
namespace {

class ServiceManagerTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
    if (fd >= 0) ::close(fd);
    if (!name_.empty() && name_[0] == '/') ::unlink(name_.c_str());
  }
  void listen_at(const std::string& name) {
    name_ = name;
    fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    std::memcpy(at.sun_path, name.data(), name.size());
    if (name[0] == '@') at.sun_path[0] = '\0';
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&at), length), 0);
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  std::string heard() const {
    std::array<char, 256> text;
    const ssize_t n = ::recv(fd, text.data(), text.size(), 0);
    return n < 0 ? "" : std::string(text.data(), static_cast<std::size_t>(n));
  }

  int fd = -1;
  std::string name_;
};

TEST_F(ServiceManagerTest, WithoutOneNothingHappens) {
  ServiceManager manager;
  EXPECT_FALSE(manager.is_there());
  EXPECT_EQ(manager.alive_period(), Duration());
  manager.say_ready();
}

TEST_F(ServiceManagerTest, HearsOfBeginLifeAndEnd) {
  for (const std::string& name : {"/tmp/dance-notify-" + std::to_string(getpid()),
                                  "@dance-notify-" + std::to_string(getpid())}) {
    listen_at(name);
    ServiceManager manager;
    ASSERT_TRUE(manager.is_there());
    EXPECT_EQ(manager.alive_period(), Duration()) << "it asked for no signs of life";
    manager.say_ready();
    manager.say_alive();
    manager.say_stopping();
    EXPECT_EQ(heard(), "READY=1");
    EXPECT_EQ(heard(), "WATCHDOG=1");
    EXPECT_EQ(heard(), "STOPPING=1");
    TearDown();
    fd = -1;
  }
}

TEST_F(ServiceManagerTest, SaysItLivesTwiceAsOftenAsAskedFor) {
  listen_at("@dance-notify-" + std::to_string(getpid()));
  ::setenv("WATCHDOG_USEC", "30000000", 1);
  EXPECT_EQ(ServiceManager().alive_period(), Duration::s(15));
  ::setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  EXPECT_EQ(ServiceManager().alive_period(), Duration::s(15));
  ::setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(ServiceManager().alive_period(), Duration()) << "another program is meant";
  ::unsetenv("WATCHDOG_PID");
  for (const char* nonsense : {"", "-5", "soon", "99999999999999999999", "0"}) {
    ::setenv("WATCHDOG_USEC", nonsense, 1);
    EXPECT_EQ(ServiceManager().alive_period(), Duration()) << nonsense;
  }
}

TEST_F(ServiceManagerTest, AnAddressThatIsNoneIsNotUsed) {
  for (const std::string& name : {std::string("relative"), std::string(200, '/')}) {
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
    EXPECT_FALSE(ServiceManager().is_there()) << name;
  }
  ::setenv("NOTIFY_SOCKET", "/nowhere/at/all", 1);
  ServiceManager().say_ready();
}

}  // namespace
}  // namespace dance
