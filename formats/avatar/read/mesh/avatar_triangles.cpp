#include "formats/avatar/read/mesh/avatar_triangles.h"

#include <algorithm>
#include <numeric>

#include "formats/gltf/glb_accessor.h"

namespace dance {
namespace {

// Triangles of which two corners are one are left out: strips are joined with them.
void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::vector<std::uint32_t>& out) {
  if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
}

std::vector<std::uint32_t> listed(const std::vector<std::uint32_t>& corners, int mode) {
  std::vector<std::uint32_t> out;
  out.reserve(mode == TINYGLTF_MODE_TRIANGLES ? corners.size() : 3 * corners.size());
  if (mode == TINYGLTF_MODE_TRIANGLES)
    for (std::size_t i = 2; i < corners.size(); i += 3)
      add(corners[i - 2], corners[i - 1], corners[i], out);
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
    for (std::size_t i = 2; i < corners.size(); ++i)
      add(corners[i - 2], corners[i - 1 + i % 2], corners[i - i % 2], out);
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
    for (std::size_t i = 2; i < corners.size(); ++i)
      add(corners[0], corners[i - 1], corners[i], out);
  return out;
}

}  // namespace

Result<std::vector<std::uint32_t>> read_triangles(AvatarSource& source,
                                                  const tinygltf::Primitive& primitive,
                                                  std::size_t vertices, std::size_t& left) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    source.note("points and lines are not drawn");
    return std::vector<std::uint32_t>{};
  }
  const bool is_list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  const std::size_t most_corners = is_list ? 3 * left + 2 : left + 2;
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    if (element_count(source.file, primitive.indices) > most_corners)
      return fail("more than " + std::to_string(source.limits.triangles) +
                  " triangles; export a simpler mesh");
    DANCE_TRY(corners, read_integers(source.file, primitive.indices, 1, most_corners));
    if (*std::max_element(corners.begin(), corners.end()) >= vertices)
      return fail("a triangle has a vertex that is not in the file");
  } else {
    corners.resize(std::min(vertices, most_corners));
    std::iota(corners.begin(), corners.end(), 0u);
  }
  left -= std::min(left, is_list ? corners.size() / 3 + 1 : corners.size());
  return listed(corners, primitive.mode);
}

}  // namespace dance
