#include "core/program/standard_output.h"

#include <cerrno>
#include <csignal>
#include <cstdio>

#include "core/base/text/errno_text.h"

namespace dance {

Result<void> write_to_stdout(std::string_view text) {
  // A pipe without a reader is an error to report, not the end of this program.
  struct sigaction ignored {};
  struct sigaction before {};
  ignored.sa_handler = SIG_IGN;
  const bool is_ignored = sigaction(SIGPIPE, &ignored, &before) == 0;
  errno = 0;
  const bool is_written =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  const int error = errno != 0 ? errno : EIO;
  if (is_ignored) sigaction(SIGPIPE, &before, nullptr);
  if (!is_written) return fail("stdout cannot be written: " + errno_text(error));
  return {};
}

}  // namespace dance
