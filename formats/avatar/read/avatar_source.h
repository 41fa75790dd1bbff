// What the parts of the avatar reader share: the checked file, and what may yet be taken of it.
//
// Units/frames: indices of nodes are the file's, unless they are in the AvatarModel.
// Ownership:    refers to the file's model, its scene, the limits and the model that is made.
// Threads:      none inside.
// Failure:      take_bytes() and look_at() say what there is too much of, go_on() that the reading
//               was stopped.
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "formats/avatar/avatar_reader.h"
#include "formats/gltf/glb_scene.h"

namespace dance {

struct AvatarSource {
  const tinygltf::Model& file;
  const GlbScene& scene;
  const AvatarLimits& limits;
  AvatarModel& model;
  std::vector<std::string>& notes;
  std::vector<int> node_of;   // the model's node of each of the file's
  Eigen::Quaterniond turned;  // by which the file's figure was turned to face +Z
  std::size_t numbers_left;
  std::size_t bytes_left;
  std::size_t morph_moves_left;
  std::size_t looks_left;
  const AvatarStop& stop;

  int model_node(int file_node) const { return node_of[static_cast<std::size_t>(file_node)]; }

  Result<void> go_on() const {
    if (stop && stop()) return fail("its reading was stopped");
    return {};
  }

  Result<void> look_at(std::size_t things) {
    if (things > looks_left)
      return fail("its nodes have more than " + std::to_string(limits.looks) +
                  " primitives, attributes and joints to look at; join its meshes");
    looks_left -= things;
    return go_on();
  }

  Result<void> take_bytes(std::size_t bytes) {
    if (bytes > bytes_left)
      return fail("an avatar of more than " + std::to_string(limits.bytes >> 20) +
                  " MiB; make its meshes or pictures smaller");
    bytes_left -= bytes;
    return {};
  }

  // Each note once: a stranger's file could cause the same one thousands of times.
  void note(const std::string& line) {
    constexpr std::size_t kMostNotes = 32;
    for (const std::string& known : notes)
      if (known == line) return;
    if (notes.size() < kMostNotes) notes.push_back(line);
  }
};

}  // namespace dance
