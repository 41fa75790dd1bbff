#include "formats/bvh/clip_file.h"

#include "core/program/whole_file.h"
#include "formats/bvh/rig/rig_canonical.h"

namespace dance {

namespace {

Result<Unpacked> read_part(const std::string& path, std::size_t most_bytes) {
  DANCE_TRY(std::string packed, read_whole_file(path, most_bytes));
  const bool is_packed = is_xz(packed);
  auto part = unpacked_part(std::move(packed), most_bytes);
  if (!part) return fail(path + ": " + part.error().what);
  if (part->bytes.empty() && !is_packed) return fail(path + ": empty; copy it again");
  if (!is_packed && path.ends_with(".xz"))
    return fail(path + ": no xz file inside; rename or pack it with xz");
  return part;
}

}  // namespace

Result<std::string> read_clip_text(const std::string& path, std::size_t most_bytes) {
  DANCE_TRY(Unpacked part, read_part(path, most_bytes));
  if (part.is_cut) return fail(path + ": " + kXzIsCut);
  return std::move(part.bytes);
}

Result<LoadedClip> load_clip(const std::string& path, const RetargetOptions& options) {
  DANCE_TRY(const Unpacked part, read_part(path, kLargestClipFile_bytes));
  const auto bvh = read_bvh(part.bytes);
  // Frames are missing because the text was cut.
  if (!bvh) return fail(path + ": " + (part.is_cut ? kXzIsCut : bvh.error().what));
  RetargetOptions own = options;
  if (is_canonical(*bvh) && !own.metres_per_unit && own.up == UpAxis::kGuess)
    own.puts_feet_on_floor = false;
  auto retargeted = retarget(*bvh, own);
  if (!retargeted) return fail(path + ": " + retargeted.error().what);
  std::string lost = bvh->lost;
  if (part.is_cut) lost = lost.empty() ? kXzIsCut : std::string(kXzIsCut) + "; " + lost;
  return LoadedClip{std::move(retargeted->clip), std::move(retargeted->notes), std::move(lost)};
}

}  // namespace dance
