#include "lobby/checks/camera_check.h"

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
  std::unique_ptr<CameraCheck> check(new CameraCheck);
  DANCE_TRY(check->pipe_, ChildPipe::open());
  ChildProcess::Options how;
  how.program = options.program.empty() ? program_folder() + "/dance-capture" : options.program;
  how.arguments = {"--check", "--loop", "--model", options.model};
  // No device is taken for an option.
  if (!options.device.empty()) how.arguments.insert(how.arguments.end(), {"--", options.device});
  how.output_fd = check->pipe_.child_fd();
  auto program = ChildProcess::start(how);
  check->pipe_.let_go();
  if (program)
    check->program_.emplace(std::move(*program));
  else
    check->end(Text::kCameraNotBuilt);
  return check;
}

void CameraCheck::end(Text why) {
  instead_ = why;
  pipe_.close();
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
  if (!pipe_.is_open()) return;
  if (!last_heard_.is_set()) last_heard_ = now;
  read_all(now);
  if (pipe_.is_open()) look_for_stall(now);
}

void CameraCheck::look_for_stall(MonoTime now) {
  const CameraState state = reader_.status().state;
  const bool has_to_tell = state == CameraState::kOpening || state == CameraState::kRunning;
  instead_.reset();
  if (has_to_tell && now - last_heard_ > kHangs) instead_ = Text::kCameraSilent;
}

void CameraCheck::read_all(MonoTime now) {
  for (std::size_t turn = 0; pipe_.is_open() && turn < kMostReads; ++turn) {
    const auto count = pipe_.read(reader_.room());
    if (!count) return note_end();
    if (*count == 0) return;
    last_heard_ = now;
    reader_.add(*count);
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
