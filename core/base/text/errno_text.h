// The text of an errno value, with the cure where this program's user can do something about it.
//
// Threads: any.
#pragma once

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

namespace dance {

inline std::string errno_text(int error) {
  if (error == EMFILE)
    return "too many open files in this program; raise the limit with: ulimit -n 4096";
  if (error == ENFILE)
    return "too many open files on this machine; raise the limit with: sysctl -w "
           "fs.file-max=1000000";
  std::array<char, 128> text{};
  return strerror_r(error, text.data(), text.size());
}

}  // namespace dance
