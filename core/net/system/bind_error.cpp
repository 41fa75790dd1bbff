#include "core/net/system/bind_error.h"

#include <cerrno>

#include "core/base/text/errno_text.h"

namespace dance {

std::string bind_error(const Address& local, int error) {
  const std::string port = std::to_string(local.port());
  switch (error) {
    case EADDRINUSE:
      return "port " + port + " is taken (" + local.to_string() +
             "): stop the program that has it, or choose another port";
    case EADDRNOTAVAIL:
      return "address " + local.to_string() +
             " is not one of this machine's: bind to one that `ip address` lists, or to ::, "
             "which is all";
    case EACCES:
      return "port " + port + " is not allowed: choose one above 1023";
    case EAFNOSUPPORT:
      return "address " + local.to_string() +
             " cannot be bound, as IPv6 is switched off here: choose an IPv4 address";
    default:
      return "address " + local.to_string() + " cannot be bound: " + errno_text(error);
  }
}

}  // namespace dance
