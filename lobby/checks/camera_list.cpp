#include "lobby/checks/camera_list.h"

#include <array>
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
  std::unique_ptr<CameraList> list(new CameraList);
  DANCE_TRY(list->pipe_, ChildPipe::open());
  ChildProcess::Options how;
  how.program = program.empty() ? program_folder() + "/dance-capture" : program;
  how.arguments = {"--list", "--json"};
  how.output_fd = list->pipe_.child_fd();
  auto started = ChildProcess::start(how);
  list->pipe_.let_go();
  if (started)
    list->program_.emplace(std::move(*started));
  else
    list->end();
  return list;
}

void CameraList::end() {
  pipe_.close();
  auto parsed = parse_camera_list(said_);
  has_failed_ = !parsed;
  if (parsed) cameras_ = std::move(*parsed);
  said_.clear();
}

void CameraList::read() {
  std::array<char, 4096> bytes;
  while (pipe_.is_open()) {
    const auto count = pipe_.read(bytes);
    if (!count || said_.size() + *count > kMostBytes) return end();
    if (*count == 0) return;
    said_.append(bytes.data(), *count);
  }
}

}  // namespace dance
