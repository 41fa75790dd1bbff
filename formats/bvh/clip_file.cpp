#include "formats/bvh/clip_file.h"

#include "core/program/whole_file.h"

namespace dance {

Result<std::string> read_clip_text(const std::string& path, std::size_t most_bytes) {
  DANCE_TRY(std::string packed, read_whole_file(path, most_bytes));
  const bool is_packed = is_xz(packed);
  auto bytes = unpacked(std::move(packed), most_bytes);
  if (!bytes) return fail(path + ": " + bytes.error().what);
  if (bytes->empty() && !is_packed) return fail(path + ": empty; copy it again");
  if (!is_packed && path.ends_with(".xz"))
    return fail(path + ": no xz file inside; rename or pack it with xz");
  return bytes;
}

Result<LoadedClip> load_clip(const std::string& path, const RetargetOptions& options) {
  DANCE_TRY(const std::string text, read_clip_text(path));
  const auto bvh = read_bvh(text);
  if (!bvh) return fail(path + ": " + bvh.error().what);
  auto retargeted = retarget(*bvh, options);
  if (!retargeted) return fail(path + ": " + retargeted.error().what);
  return LoadedClip{std::move(retargeted->clip), std::move(retargeted->notes)};
}

}  // namespace dance
