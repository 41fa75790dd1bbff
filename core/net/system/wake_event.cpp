#include "core/net/system/wake_event.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include "core/base/text/errno_text.h"

namespace dance {

Result<WakeEvent> WakeEvent::create() {
  const int fd = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (fd < 0) return fail("no event descriptor: " + errno_text(errno));
  return WakeEvent(fd);
}

WakeEvent::~WakeEvent() {
  if (fd_ >= 0) ::close(fd_);
}

void WakeEvent::signal() const { ::eventfd_write(fd_, 1); }

bool WakeEvent::clear() const {
  eventfd_t count = 0;
  return ::eventfd_read(fd_, &count) == 0;
}

}  // namespace dance
