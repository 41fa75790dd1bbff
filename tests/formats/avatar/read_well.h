// Reads an avatar that is well made; what is not is a failed test.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   an expectation that fails, and an empty model.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/avatar/avatar_reader.h"
#include "tests/formats/avatar/tiny_avatar.h"

namespace dance::test {

inline ReadAvatar read_well(const TinyAvatar& avatar, const AvatarLimits& limits = {}) {
  auto read = read_avatar(avatar.glb(), limits, "file.glb");
  EXPECT_TRUE(read) << (read ? "" : read.error().what);
  if (!read) return {};
  EXPECT_TRUE(is_sound(read->model));
  return std::move(*read);
}

inline AvatarModel model_of(const TinyAvatar& avatar, std::vector<std::string>* notes = nullptr) {
  ReadAvatar read = read_well(avatar);
  if (notes) *notes = read.notes;
  return std::move(read.model);
}

inline std::string name_of_node(const AvatarModel& model, int node) {
  return node < 0 ? "" : model.nodes.at(static_cast<std::size_t>(node)).name;
}

}  // namespace dance::test
