#include "formats/clip/dancers_file.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/program/whole_file.h"
#include "formats/bvh/clip_file.h"
#include "formats/kind/file_content.h"
#include "formats/kind/file_kind.h"

namespace dance {
namespace {

// What the caller says is taken, the rest is as glTF has it.
RetargetOptions as_gltf(const RetargetOptions& options) {
  RetargetOptions as = gltf_retarget_options();
  if (options.metres_per_unit) as.metres_per_unit = options.metres_per_unit;
  if (options.up != UpAxis::kGuess) as.up = options.up;
  as.frame_hz = options.frame_hz;
  return as;
}

Result<FileKind> dancers_kind(const std::string& path) {
  constexpr std::string_view kWanted = "a BVH or glTF file";
  if (auto checked =
          check_content(path, {FileContent::kBvh, FileContent::kGlb, FileContent::kGltf}, kWanted);
      !checked)
    return tl::make_unexpected(checked.error());
  // Content of no known kind is read as BVH, whose reader names the line at fault.
  return input_kind(path).value_or(FileKind::kBvh) == FileKind::kGlb ? FileKind::kGlb
                                                                     : FileKind::kBvh;
}

}  // namespace

Result<std::vector<NamedClip>> load_dancers(const std::string& path,
                                            const RetargetOptions& options) {
  std::vector<NamedClip> dancers;
  DANCE_TRY(const FileKind kind, dancers_kind(path));
  if (kind == FileKind::kBvh) {
    DANCE_TRY(LoadedClip loaded, load_clip(path, options));
    dancers.push_back(
        {"", std::move(loaded.clip), std::move(loaded.notes), std::move(loaded.lost)});
    return dancers;
  }
  const GlbLimits limits;
  DANCE_TRY(const std::string bytes, read_whole_file(path, limits.file_bytes));
  auto clips = read_glb({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, limits,
                        as_gltf(options));
  if (!clips) return fail(path + ": " + clips.error().what);
  return clips;
}

Result<NamedClip> load_dancer(const std::string& path, std::string_view name,
                              const RetargetOptions& options) {
  DANCE_TRY(std::vector<NamedClip> dancers, load_dancers(path, options));
  if (dancers.size() == 1) return std::move(dancers.front());
  const auto found = std::find_if(dancers.begin(), dancers.end(),
                                  [&](const NamedClip& dancer) { return dancer.name == name; });
  if (found != dancers.end()) return std::move(*found);
  std::string names;
  for (const NamedClip& dancer : dancers) names += (names.empty() ? "" : ", ") + dancer.name;
  return fail(path + ": several dance in it, and none is called " + std::string(name) +
              "; there are " + names);
}

}  // namespace dance
