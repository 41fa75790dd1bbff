#include "formats/clip/file_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "core/base/guest_id.h"

namespace dance {
namespace {

struct End {
  std::string_view end;
  FileKind kind;
  bool can_be_written;
};
constexpr std::array kEnds{
    End{".lcm", FileKind::kLcm, true},   End{".bvh", FileKind::kBvh, true},
    End{".glb", FileKind::kGlb, true},   End{".mcap", FileKind::kMcap, true},
    End{".csv", FileKind::kCsv, true},   End{".bvh.xz", FileKind::kBvh, false},
    End{".vrma", FileKind::kGlb, false}, End{".gltf", FileKind::kGlb, false},
    End{".vrm", FileKind::kGlb, false},
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return text;
}

Result<FileKind> kind_of(const std::string& path, bool is_output) {
  const std::string name = lower(path);
  std::string known;
  for (const End& end : kEnds) {
    if (is_output && !end.can_be_written) continue;
    if (name.ends_with(end.end)) return end.kind;
    known += (known.empty() ? "" : " ") + std::string(end.end);
  }
  return fail(path + ": its name does not end in what can be " +
              (is_output ? "written: " : "read: ") + known);
}

}  // namespace

Result<FileKind> input_kind(const std::string& path) { return kind_of(path, false); }
Result<FileKind> output_kind(const std::string& path) { return kind_of(path, true); }

std::string guest_name_of(std::string name) {
  name = lower(std::filesystem::path(name).filename().string());
  for (const End& end : kEnds)
    if (name.size() > end.end.size() && name.ends_with(end.end)) {
      name.resize(name.size() - end.end.size());
      break;
    }
  std::string id;
  for (const char c : name) {
    const bool is_allowed = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_allowed)
      id += c;
    else if (!id.empty() && id.back() != '-')
      id += '-';
  }
  if (id.size() > kMaxGuestIdLength) id.resize(kMaxGuestIdLength);
  while (!id.empty() && id.back() == '-') id.pop_back();
  return id.empty() ? "dancer" : id;
}

}  // namespace dance
