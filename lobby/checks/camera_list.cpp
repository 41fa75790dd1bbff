#include "lobby/checks/camera_list.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>

#include "core/base/printable.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr std::size_t kMostBytes = 256 * 1024;
constexpr std::size_t kMostCameras = 64;
constexpr std::size_t kLongestText = 300;

// A camera's name anybody may have written.
std::string text_in(const nlohmann::json& object, const char* key) {
  const auto it = object.find(key);
  if (it == object.end() || !it->is_string()) return "";
  return printable(it->get_ref<const std::string&>().substr(0, kLongestText));
}

}  // namespace

std::optional<std::vector<ListedCamera>> parse_camera_list(std::string_view json) {
  const auto list = nlohmann::json::parse(json, nullptr, false);
  if (list.is_discarded() || !list.is_array()) return std::nullopt;
  std::vector<ListedCamera> cameras;
  for (const auto& entry : list) {
    if (!entry.is_object() || cameras.size() == kMostCameras) return std::nullopt;
    ListedCamera camera{text_in(entry, "device"), text_in(entry, "name"), text_in(entry, "mode"),
                        text_in(entry, "trouble")};
    if (!camera.device.starts_with("/dev/")) return std::nullopt;
    if (camera.name.empty()) camera.name = camera.device;
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

Result<std::unique_ptr<CameraList>> CameraList::start(const std::string& program) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return fail("no pipe for the list of cameras: is the system out of files?");
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  std::unique_ptr<CameraList> list(new CameraList);
  list->fd_ = ends[0];
  ChildProcess::Options how;
  how.program = program.empty() ? program_folder() + "/dance-capture" : program;
  how.arguments = {"--list", "--json"};
  how.output_fd = ends[1];
  auto started = ChildProcess::start(how);
  ::close(ends[1]);
  if (started)
    list->program_.emplace(std::move(*started));
  else
    list->end();
  return list;
}

CameraList::~CameraList() {
  if (fd_ >= 0) ::close(fd_);
}

void CameraList::end() {
  ::close(fd_);
  fd_ = -1;
  auto parsed = parse_camera_list(said_);
  has_failed_ = !parsed;
  if (parsed) cameras_ = std::move(*parsed);
  said_.clear();
}

void CameraList::read() {
  std::array<char, 4096> bytes;
  while (fd_ >= 0) {
    const ssize_t count = ::read(fd_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (count <= 0 || said_.size() + static_cast<std::size_t>(count) > kMostBytes) return end();
    said_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace dance
