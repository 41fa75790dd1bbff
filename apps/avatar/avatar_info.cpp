#include "apps/avatar/avatar_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/base/text/plain_text.h"
#include "core/program/confinement.h"
#include "core/program/program.h"
#include "core/program/whole_file.h"
#include "formats/avatar/avatar_reader.h"

namespace dance {
namespace {

constexpr const char* kInfoExamples = R"(Examples:
  dance avatar info me.vrm
  dance avatar info me.vrm --json
Exit code 0: it can dance here. 1: it cannot, and a line says why and what helps.
)";

// The extensions' names stand in the JSON, which comes first in every such file.
std::string kind_of(std::span<const std::uint8_t> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.find("\"VRMC_vrm\"") != text.npos) return "VRM 1.0";
  if (text.find("\"VRM\"") != text.npos) return "VRM 0.x";
  return "glTF";
}

// From the lowest to the highest vertex at rest.
double height_of(const AvatarModel& model) {
  std::vector<Eigen::Affine3f> rest;
  for (const AvatarNode& node : model.nodes) {
    Eigen::Affine3f local = Eigen::Affine3f::Identity();
    local.translate(node.translation_m).rotate(node.rotation).scale(node.scale);
    rest.push_back(node.parent < 0 ? local : rest[static_cast<std::size_t>(node.parent)] * local);
  }
  float low = 0.0f;
  float high = 0.0f;
  bool is_first = true;
  for (const AvatarVertex& vertex : model.vertices) {
    float y = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
      const AvatarJoint& joint = model.joints[vertex.joints[k]];
      const Eigen::Vector3f place =
          rest[static_cast<std::size_t>(joint.node)] * (joint.node_from_mesh * vertex.place_m);
      y += static_cast<float>(vertex.weights[k]) / 255.0f * place.y();
    }
    low = is_first ? y : std::min(low, y);
    high = is_first ? y : std::max(high, y);
    is_first = false;
  }
  return static_cast<double>(high - low);
}

std::string listed(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : ", ") + word;
  return line.empty() ? "none" : line;
}

struct InfoOptions {
  std::string file;
  bool json = false;
};

Result<void> info(const InfoOptions& options) {
  DANCE_TRY(const std::string bytes, read_whole_file(options.file, AvatarLimits{}.file_bytes));
  const std::span<const std::uint8_t> file(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                           bytes.size());
  const std::string name = options.file.substr(options.file.rfind('/') + 1);
  auto facts = run_confined([&] { return avatar_facts(file, name); });
  if (!facts) return fail(options.file + ": " + facts.error().what);
  std::fputs((options.json ? json_of(*facts) : text_of(*facts)).c_str(), stdout);
  return {};
}

}  // namespace

Result<AvatarFacts> avatar_facts(std::span<const std::uint8_t> file, const std::string& name) {
  DANCE_TRY(const ReadAvatar read, read_avatar(file, {}, name));
  const AvatarModel& model = read.model;
  AvatarFacts facts;
  facts.name = plain_text(model.name);
  facts.kind = kind_of(file);
  facts.licence = plain_text(model.licence);
  facts.file_bytes = file.size();
  facts.height_m = height_of(model);
  facts.triangles = model.triangles.size() / 3;
  facts.vertices = model.vertices.size();
  facts.parts = model.parts.size();
  facts.materials = model.materials.size();
  for (const AvatarMaterial& material : model.materials)
    facts.toon_materials += material.shading == Shading::kToon ? 1 : 0;
  for (const AvatarPicture& picture : model.pictures)
    facts.pictures.push_back(fmt::format("{} x {}", picture.width_px, picture.height_px));
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    if (model.bones[b] >= 0)
      ++facts.bones;
    else
      facts.missing_bones.emplace_back(kBones[b].name);
  }
  for (const int finger : model.fingers) facts.finger_bones += finger >= 0 ? 1 : 0;
  facts.has_eyes = model.eyes[0] >= 0 && model.eyes[1] >= 0;
  for (const AvatarExpression& expression : model.expressions)
    facts.expressions.push_back(plain_text(expression.name));
  facts.springs = model.springs.size();
  for (const AvatarSpring& spring : model.springs) facts.spring_joints += spring.joints.size();
  facts.colliders = model.colliders.size();
  for (const std::string& note : read.notes) facts.notes.push_back(plain_text(note));
  return facts;
}

std::string text_of(const AvatarFacts& facts) {
  std::string out = fmt::format("{}: {}, {:.0f} kB, {:.2f} m tall\n", facts.name, facts.kind,
                                static_cast<double>(facts.file_bytes) / 1000.0, facts.height_m);
  const auto row = [&](std::string_view what, const std::string& text) {
    out += fmt::format("  {:<12} {}\n", what, text);
  };
  row("licence", facts.licence.empty() ? "the file tells none" : facts.licence);
  row("surface", fmt::format("{} triangles, {} vertices, {} parts", facts.triangles, facts.vertices,
                             facts.parts));
  row("materials", fmt::format("{}, {} of them toon", facts.materials, facts.toon_materials));
  row("pictures", listed(facts.pictures));
  row("bones",
      fmt::format("{} of {}, {} of {} of the fingers, {}", facts.bones, kBoneCount,
                  facts.finger_bones, kFingerBoneCount, facts.has_eyes ? "both eyes" : "no eyes"));
  if (!facts.missing_bones.empty()) row("missing", listed(facts.missing_bones));
  row("expressions", listed(facts.expressions));
  row("springs", fmt::format("{} chains of {} joints, {} colliders", facts.springs,
                             facts.spring_joints, facts.colliders));
  for (const std::string& note : facts.notes) row("note", note);
  return out + "It can dance here.\n";
}

std::string json_of(const AvatarFacts& facts) {
  const nlohmann::ordered_json report{{"name", facts.name},
                                      {"kind", facts.kind},
                                      {"licence", facts.licence},
                                      {"bytes", facts.file_bytes},
                                      {"height_m", std::round(facts.height_m * 1000.0) / 1000.0},
                                      {"triangles", facts.triangles},
                                      {"vertices", facts.vertices},
                                      {"parts", facts.parts},
                                      {"materials", facts.materials},
                                      {"toon_materials", facts.toon_materials},
                                      {"pictures", facts.pictures},
                                      {"bones", facts.bones},
                                      {"missing_bones", facts.missing_bones},
                                      {"finger_bones", facts.finger_bones},
                                      {"has_eyes", facts.has_eyes},
                                      {"expressions", facts.expressions},
                                      {"springs", facts.springs},
                                      {"spring_joints", facts.spring_joints},
                                      {"colliders", facts.colliders},
                                      {"notes", facts.notes}};
  return report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

int avatar_info_main(int argc, char** argv) {
  InfoOptions options;
  CommandLine line("What is in an avatar's file, and whether it can dance here.",
                   "dance avatar info");
  line.add("FILE", options.file, ".vrm or .glb").required();
  line.add_flag("--json", options.json, "as JSON on stdout");
  line.footer(kInfoExamples);
  return run_program(line, argc, argv, [&] { return info(options); });
}

}  // namespace dance
