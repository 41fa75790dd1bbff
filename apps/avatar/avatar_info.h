// dance avatar info: what is in an avatar's file, and whether it can dance here.
//
// Threads: call from main.
// Failure: exit code 1 where the file cannot be read or cannot dance, with cause and cure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "formats/avatar/avatar_model.h"

namespace dance {

// What a dancer asks of an avatar.
struct AvatarFacts {
  std::string name;
  std::string kind;  // "VRM 1.0", "VRM 0.x", "glTF"
  std::string licence;
  std::size_t file_bytes = 0;
  double height_m = 0.0;
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::size_t parts = 0;
  std::size_t materials = 0;
  std::size_t toon_materials = 0;
  std::vector<std::string> pictures;  // "256 x 256"
  std::size_t bones = 0;
  std::vector<std::string> missing_bones;
  std::size_t finger_bones = 0;
  bool has_eyes = false;
  std::vector<std::string> expressions;
  std::size_t springs = 0;
  std::size_t spring_joints = 0;
  std::size_t colliders = 0;
  std::vector<std::string> notes;
};

Result<AvatarFacts> avatar_facts(std::span<const std::uint8_t> file, const std::string& name);
std::string text_of(const AvatarFacts& facts);
std::string json_of(const AvatarFacts& facts);

int avatar_info_main(int argc, char** argv);

}  // namespace dance
