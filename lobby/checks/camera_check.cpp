#include "lobby/checks/camera_check.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/program/program.h"

namespace dance {
namespace {

// In one turn: some views more than come in a turn of a window.
constexpr std::size_t kMostReads = 64;
// Without a word from the program, which opens a camera or has ten views a second to tell.
constexpr Duration kHangs = Duration::s(6);

}  // namespace

Result<std::unique_ptr<CameraCheck>> CameraCheck::start(const Options& options) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return fail("no pipe for the camera's program: is the system out of files?");
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  std::unique_ptr<CameraCheck> check(new CameraCheck(ends[0]));
  ChildProcess::Options how;
  how.program = options.program.empty() ? program_folder() + "/dance-capture" : options.program;
  how.arguments = {"--check", "--loop", "--model", options.model};
  // No device is taken for an option.
  if (!options.device.empty()) how.arguments.insert(how.arguments.end(), {"--", options.device});
  how.output_fd = ends[1];
  auto program = ChildProcess::start(how);
  ::close(ends[1]);
  if (program)
    check->program_.emplace(std::move(*program));
  else
    check->end(Text::kCameraNotBuilt);
  return check;
}

CameraCheck::~CameraCheck() {
  if (fd_ >= 0) ::close(fd_);
}

void CameraCheck::end(Text why) {
  instead_ = why;
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

// Its reader is gone, or it has ended itself.
void CameraCheck::note_end() {
  switch (reader_.fault()) {
    case CameraViewReader::Fault::kOtherVersion:
      return end(Text::kCameraOtherVersion);
    case CameraViewReader::Fault::kForeign:
    case CameraViewReader::Fault::kNone:
      return end(Text::kCameraEnded);
  }
}

void CameraCheck::read(MonoTime now) {
  if (fd_ < 0) return;
  if (!last_heard_.is_set()) last_heard_ = now;
  read_all(now);
  if (fd_ >= 0) look_for_stall(now);
}

void CameraCheck::look_for_stall(MonoTime now) {
  const CameraState state = reader_.status().state;
  const bool has_to_tell = state == CameraState::kOpening || state == CameraState::kRunning;
  instead_.reset();
  if (has_to_tell && now - last_heard_ > kHangs) instead_ = Text::kCameraSilent;
}

void CameraCheck::read_all(MonoTime now) {
  for (std::size_t turn = 0; fd_ >= 0 && turn < kMostReads; ++turn) {
    const std::span<std::uint8_t> room = reader_.room();
    const ssize_t count = ::read(fd_, room.data(), room.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (count <= 0) return note_end();
    last_heard_ = now;
    reader_.add(static_cast<std::size_t>(count));
    if (reader_.fault() != CameraViewReader::Fault::kNone) return note_end();
    if (reader_.take_status()) advice_.note(reader_.status());
    if (!reader_.take_view()) continue;
    has_picture_ = true;
    advice_.see(reader_.facts(), now);
  }
}

bool CameraCheck::take(PreviewPicture& out) {
  if (!std::exchange(has_picture_, false)) return false;
  out = reader_.picture();
  return true;
}

std::span<const Text> CameraCheck::advice() const {
  if (instead_) return {&*instead_, 1};
  return advice_.texts();
}

}  // namespace dance
