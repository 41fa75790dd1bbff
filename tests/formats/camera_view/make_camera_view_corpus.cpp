// Writes streams of `dance capture --check` into the folder that is named: what camera_view_fuzz
// reads, of which the first byte is the length of the pieces.

#include <fstream>
#include <initializer_list>
#include <memory>
#include <string>

#include "formats/camera_view/camera_view_writer.h"
#include "tests/formats/camera_view/drawn_view.h"

namespace {

using namespace dance;

void write(const std::string& path, char piece, std::initializer_list<std::string> records) {
  std::ofstream file(path, std::ios::binary);
  file.put(piece);
  for (const std::string& record : records) file << record;
}

template <class Bytes>
std::string text_of(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const auto buffer = std::make_unique<CameraRecordBuffer>();
  const auto rgb = drawn_rgb(8, 6, 1);
  const std::string view = text_of(write_camera_view(good_facts(), {8, 6, rgb}, *buffer));
  CameraStatus failed = running_status();
  failed.state = CameraState::kFailed;
  failed.cause = CameraCause::kInUse;
  (void)failed.words.assign("/dev/video0: in use");
  const std::string status = text_of(write_camera_status(failed, *buffer));
  write(folder + "/view.bin", 1, {view});
  write(folder + "/status.bin", 0, {status});
  write(folder + "/both.bin", 9, {status, view, status});
  return 0;
}
