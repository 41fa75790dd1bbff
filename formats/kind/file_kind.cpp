#include "formats/kind/file_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "core/base/guest_id.h"
#include "formats/kind/file_content.h"

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

// The kind by the end of the name.
Result<FileKind> kind_of(const std::string& path, bool is_output) {
  const std::string name = lower(path);
  std::string known;
  for (const End& end : kEnds) {
    if (is_output && !end.can_be_written) continue;
    if (name.ends_with(end.end)) return end.kind;
    known += (known.empty() ? "" : " ") + std::string(end.end);
  }
  return fail(path +
              (is_output ? ": its name does not end in what can be written: "
                         : ": is none of the kinds that can be read: ") +
              known);
}

// The kind of a file whose content does not tell.
Result<FileKind> kind_by_name(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status))
    return fail(path + ": is a folder, not a recorded dance; name a file in it");
  auto kind = kind_of(path, false);
  if (kind || std::filesystem::is_regular_file(status)) return kind;
  if (!std::filesystem::exists(status)) return fail(path + ": no such file");
  return FileKind::kLcm;  // a pipe: only logs are read as they come
}

}  // namespace

Result<FileKind> input_kind(const std::string& path) {
  const FileContent content = content_of_file(path);
  switch (content) {
    case FileContent::kLcmLog:
      return FileKind::kLcm;
    case FileContent::kBvh:
      return FileKind::kBvh;
    case FileContent::kGlb:
    case FileContent::kGltf:
      return FileKind::kGlb;
    case FileContent::kMcap:
      return FileKind::kMcap;
    case FileContent::kTable:
      return FileKind::kCsv;
    case FileContent::kUnknown:
    case FileContent::kEmpty:
      return kind_by_name(path);
    default:
      return fail(path + ": " + wrong_content(content, "a recorded dance"));
  }
}
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
