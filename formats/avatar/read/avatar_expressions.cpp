#include "formats/avatar/read/avatar_expressions.h"

#include <algorithm>

#include "formats/gltf/glb_json.h"
#include "formats/gltf/glb_text.h"

namespace dance {
namespace {

using tinygltf::Value;

struct Renamed {
  std::string_view before;
  std::string_view now;
};
constexpr Renamed kVrm0Names[] = {
    {"joy", "happy"},
    {"angry", "angry"},
    {"sorrow", "sad"},
    {"fun", "relaxed"},
    {"surprised", "surprised"},
    {"a", "aa"},
    {"i", "ih"},
    {"u", "ou"},
    {"e", "ee"},
    {"o", "oh"},
    {"blink", "blink"},
    {"blink_l", "blinkLeft"},
    {"blink_r", "blinkRight"},
    {"lookup", "lookUp"},
    {"lookdown", "lookDown"},
    {"lookleft", "lookLeft"},
    {"lookright", "lookRight"},
    {"neutral", "neutral"},
};
constexpr std::size_t kMostBinds = 256;

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::string vrm1_name(const Value* group) {
  const std::string name = text_of(member(group, "name"));
  for (const std::string& known : {lower(text_of(member(group, "presetName"))), lower(name)})
    for (const Renamed& renamed : kVrm0Names)
      if (renamed.before == known) return std::string(renamed.now);
  return plain_name(name);
}

class ExpressionReader {
 public:
  ExpressionReader(AvatarSource& source, const std::vector<MeshMorphs>& morphs)
      : source_(source), morphs_(morphs) {}

  void read_vrm1() {
    const Value* all = member(extension_of(source_.file.extensions, "VRMC_vrm"), "expressions");
    for (const char* kind : {"preset", "custom"}) {
      const Value* named = member(all, kind);
      if (!named || !named->IsObject()) continue;
      for (const std::string& name : named->Keys()) {
        AvatarExpression expression;
        expression.name = plain_name(name);
        const Value* binds = member(member(named, name.c_str()), "morphTargetBinds");
        for (std::size_t b = 0; b < length_of(binds); ++b) {
          const Value* bind = item(binds, b);
          const auto node = index_in(member(bind, "node"), source_.scene.nodes.size());
          if (node)
            add_bind(
                bind, 1.0f, [&](const MeshMorphs& m) { return m.node == *node; }, expression);
        }
        add(std::move(expression));
      }
    }
  }

  void read_vrm0() {
    const Value* groups =
        member(member(extension_of(source_.file.extensions, "VRM"), "blendShapeMaster"),
               "blendShapeGroups");
    for (std::size_t g = 0; g < length_of(groups); ++g) {
      AvatarExpression expression;
      expression.name = vrm1_name(item(groups, g));
      const Value* binds = member(item(groups, g), "binds");
      for (std::size_t b = 0; b < length_of(binds); ++b) {
        const Value* bind = item(binds, b);
        const auto mesh = index_in(member(bind, "mesh"), source_.file.meshes.size());
        if (mesh)
          add_bind(
              bind, 0.01f, [&](const MeshMorphs& m) { return m.mesh == *mesh; }, expression);
      }
      add(std::move(expression));
    }
  }

  // Faces made for ARKit name their eyelids so.
  void add_blinks() {
    constexpr std::string_view kLeft[] = {"eyeblinkleft", "eyeblink_l", "eye_blink_left"};
    constexpr std::string_view kRight[] = {"eyeblinkright", "eyeblink_r", "eye_blink_right"};
    AvatarExpression left{"blinkLeft", {}};
    AvatarExpression right{"blinkRight", {}};
    for (std::size_t m = 0; m < source_.model.morphs.size(); ++m) {
      const std::string name = lower(source_.model.morphs[m].name);
      if (std::ranges::find(kLeft, name) != std::end(kLeft))
        left.binds.push_back({static_cast<std::uint32_t>(m), 1.0f});
      if (std::ranges::find(kRight, name) != std::end(kRight))
        right.binds.push_back({static_cast<std::uint32_t>(m), 1.0f});
    }
    AvatarExpression both{"blink", left.binds};
    both.binds.insert(both.binds.end(), right.binds.begin(), right.binds.end());
    for (AvatarExpression* expression : {&both, &left, &right})
      if (!has(expression->name)) add(std::move(*expression));
  }

  bool has(const std::string& name) const {
    return std::ranges::any_of(source_.model.expressions,
                               [&](const auto& known) { return known.name == name; });
  }

 private:
  template <class IsIt>
  void add_bind(const Value* bind, float unit, const IsIt& is_it, AvatarExpression& expression) {
    // Read once: many nodes may share a mesh.
    const auto index = index_in(member(bind, "index"), source_.limits.morphs);
    if (!index) return;
    const float weight =
        std::clamp(unit * float_of(member(bind, "weight"), 1.0f / unit, -1e3f, 1e3f), 0.0f, 1.0f);
    for (const MeshMorphs& of_mesh : morphs_) {
      if (expression.binds.size() >= kMostBinds) return;
      if (is_it(of_mesh) && static_cast<std::uint32_t>(*index) < of_mesh.count)
        expression.binds.push_back({of_mesh.first + static_cast<std::uint32_t>(*index), weight});
    }
  }

  void add(AvatarExpression expression) {
    if (expression.name.empty() || expression.binds.empty() || has(expression.name)) return;
    if (source_.model.expressions.size() >= source_.limits.expressions)
      return source_.note("more than " + std::to_string(source_.limits.expressions) +
                          " expressions; the rest is left out");
    source_.model.expressions.push_back(std::move(expression));
  }

  AvatarSource& source_;
  const std::vector<MeshMorphs>& morphs_;
};

}  // namespace

void read_expressions(AvatarSource& source, const std::vector<MeshMorphs>& morphs) {
  ExpressionReader reader(source, morphs);
  reader.read_vrm1();
  reader.read_vrm0();
  reader.add_blinks();
}

}  // namespace dance
