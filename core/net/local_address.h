// Where the sockets of this user's programs are on this machine: files in a folder that nobody else
// can enter.
//
// Ownership: none.
// Threads:   any.
// Failure:   a path too long for a socket, and a folder that is another user's, are named with the
//            cure.
#pragma once

#include <sys/un.h>

#include <string>

#include "core/base/result.h"
#include "core/base/text/errno_text.h"

namespace dance {

// The folder of this user's sockets: $XDG_RUNTIME_DIR/dance, or /tmp/dance-UID where that is not
// set.
std::string local_socket_folder();

Result<sockaddr_un> unix_address(const std::string& path);
// In /tmp another user may have made it: then it is not used.
Result<void> make_private_folder(const std::string& folder);
// Whether it is there, this user's and closed to others.
bool is_private_folder(const std::string& folder);
// "/a/b" of "/a/b/c".
std::string folder_of(const std::string& path);
bool is_socket(const std::string& path);

}  // namespace dance
