#include "bench/view/bench_avatar.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "formats/avatar/avatar_reader.h"

namespace dance {

Result<std::shared_ptr<const AvatarModel>> read_bench_avatar(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail("--avatar " + file + " cannot be read; name a .glb or .vrm file");
  const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  auto read = read_avatar(bytes, {}, file);
  if (!read) return fail("--avatar " + file + ": " + read.error().what);
  return std::make_shared<const AvatarModel>(std::move(read->model));
}

}  // namespace dance
