#include "producers/camera/check/newest_record.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace dance {

NewestRecord::NewestRecord(int fd)
    : fd_(fd),
      view_(std::make_unique<Waiting>()),
      status_(std::make_unique<Waiting>()),
      going_(std::make_unique<Waiting>()) {
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
  // A whole view at once, where the system lets a pipe be so large.
  ::fcntl(fd, F_SETPIPE_SZ, static_cast<int>(2 * kMostCameraRecord_bytes));
}

void NewestRecord::put(const CameraFacts& facts, const PreviewPicture& picture) {
  if (view_->size > 0) ++left_out_;
  view_->size = write_camera_view(facts, picture, view_->buffer).size();
  flush();
}

void NewestRecord::put(const CameraStatus& status) {
  status_->size = write_camera_status(status, status_->buffer).size();
  flush();
}

bool NewestRecord::begin_next() {
  for (auto* next : {&status_, &view_}) {
    if ((*next)->size == 0) continue;
    std::swap(*next, going_);
    rest_ = std::span(going_->buffer).first(going_->size);
    (*next)->size = 0;
    return true;
  }
  return false;
}

void NewestRecord::flush() {
  while (!is_closed_ && (!rest_.empty() || begin_next())) {
    const ssize_t written = ::write(fd_, rest_.data(), rest_.size());
    if (written > 0) {
      rest_ = rest_.subspan(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      return;
    } else if (errno != EINTR) {
      is_closed_ = true;
    }
  }
}

}  // namespace dance
