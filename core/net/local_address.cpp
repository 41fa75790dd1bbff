#include "core/net/local_address.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace dance {

std::string local_socket_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");  // NOLINT(concurrency-mt-unsafe)
  if (runtime != nullptr && *runtime == '/') return std::string(runtime) + "/dance";
  return "/tmp/dance-" + std::to_string(::geteuid());
}

Result<sockaddr_un> unix_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    return fail("'" + path +
                "' is too long for a socket's path: set XDG_RUNTIME_DIR to a shorter "
                "folder");
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

Result<void> make_private_folder(const std::string& folder) {
  const bool is_made = ::mkdir(folder.c_str(), 0700) == 0;
  if (!is_made && errno != EEXIST)
    return fail("folder " + folder + " cannot be made: " + errno_text(errno));
  struct stat found {};
  if (::lstat(folder.c_str(), &found) != 0)
    return fail("folder " + folder + ": " + errno_text(errno));
  if (!S_ISDIR(found.st_mode) || found.st_uid != ::geteuid())
    return fail(folder + " is not this user's folder: remove it, or set XDG_RUNTIME_DIR");
  if ((found.st_mode & 0077) != 0 && ::chmod(folder.c_str(), 0700) != 0)
    return fail("folder " + folder + " cannot be closed to others: " + errno_text(errno));
  return {};
}

bool is_private_folder(const std::string& folder) {
  struct stat found {};
  return ::lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) &&
         found.st_uid == ::geteuid() && (found.st_mode & 0077) == 0;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

bool is_socket(const std::string& path) {
  struct stat found {};
  return ::lstat(path.c_str(), &found) == 0 && S_ISSOCK(found.st_mode);
}

}  // namespace dance
