// Notifies a service manager (systemd, Type=notify) that the program is ready, stopping, or alive.
// Does nothing without one.
//
// Units/frames: none.
// Ownership:    owns its socket.
// Threads:      one; construct it before threads start, as it reads the environment.
// Failure:      none: lost notifications are not repeated, and nothing waits.
// Source:       sd_notify(3), the datagrams on $NOTIFY_SOCKET.
#pragma once

#include <string>
#include <string_view>

#include "core/base/time.h"

namespace dance {

class ServiceManager {
 public:
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  bool is_there() const { return fd_ >= 0; }
  // How often to send watchdog notifications, half of its timeout; nullopt = never.
  Duration alive_period() const { return alive_period_; }

  void say_ready() { say("READY=1"); }
  void say_stopping() { say("STOPPING=1"); }
  void say_alive() { say("WATCHDOG=1"); }

 private:
  void say(std::string_view words);

  int fd_ = -1;
  std::string address_;  // as in sockaddr_un
  Duration alive_period_;
};

}  // namespace dance
