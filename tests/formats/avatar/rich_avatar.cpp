#include "tests/formats/avatar/rich_avatar.h"

#include "tests/formats/picture/packed_pictures.h"

namespace dance::test {
namespace {

using nlohmann::json;

ToolNames with_fingers() {
  ToolNames names;
  names.fingers = {"%Thumb#", "%Index#", "", "", ""};
  names.of_head = {"leftEye", "rightEye"};
  return names;
}

json morphing_square(TinyAvatar& avatar) {
  json primitive = avatar.square();
  const int move = avatar.add_floats({0.01f, 0, 0, 0, 0, 0, 0, 0.02f, 0, 0, 0, 0}, "VEC3");
  const int sparse = avatar.add_accessor(-1, 5126, "VEC3", 4);
  const std::uint16_t which[] = {2};
  const float instead[] = {0, -0.02f, 0};
  const int indices = avatar.add_view({reinterpret_cast<const std::uint8_t*>(which), 2});
  const int values = avatar.add_view({reinterpret_cast<const std::uint8_t*>(instead), 12});
  avatar.json["accessors"][static_cast<std::size_t>(sparse)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}}}};
  primitive["targets"] = {{{"POSITION", move}, {"NORMAL", move}}, {{"POSITION", sparse}}};
  return primitive;
}

// Bytes for normals, shorts for places, a strip, a second set of joints.
json quantized_strip(TinyAvatar& avatar) {
  json primitive = avatar.square();
  const std::vector<std::uint16_t> places{0, 1, 0, 0, 1, 1, 0, 0, 1, 2, 0, 0, 0, 2, 0, 0};
  const int view =
      avatar.add_view({reinterpret_cast<const std::uint8_t*>(places.data()), places.size() * 2}, 8);
  primitive["attributes"]["POSITION"] = avatar.add_accessor(view, 5123, "VEC3", 4);
  const Bytes normals{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0};
  primitive["attributes"]["NORMAL"] =
      avatar.add_accessor(avatar.add_view(normals, 4), 5120, "VEC3", 4, 0, true);
  primitive["attributes"]["JOINTS_1"] =
      avatar.add_integers<std::uint16_t>({1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4}, "VEC4");
  primitive["attributes"]["WEIGHTS_1"] = avatar.add_integers<std::uint8_t>(
      {9, 8, 7, 6, 9, 8, 7, 6, 9, 8, 7, 6, 9, 8, 7, 6}, "VEC4", true);
  primitive["mode"] = 5;
  primitive["indices"] = avatar.add_integers<std::uint8_t>({0, 1, 3, 2}, "SCALAR");
  return primitive;
}

struct Rich {
  TinyAvatar avatar{with_fingers()};
  int face = 0;
  std::array<int, 3> hair{};
};

Rich rich(bool faces_back) {
  Rich out;
  out.avatar = TinyAvatar(with_fingers(), faces_back);
  TinyAvatar& avatar = out.avatar;
  int above = avatar.node("head");
  for (std::size_t h = 0; h < 3; ++h)
    out.hair[h] = above = avatar.add_node("hair" + std::to_string(h), above,
                                          {0, 1.6f - 0.1f * static_cast<float>(h), -0.1f});
  json face = morphing_square(avatar);
  json body = quantized_strip(avatar);
  face["material"] = 0;
  body["material"] = 1;
  out.face = avatar.add_mesh({face, body});
  avatar.json["meshes"][0]["extras"]["targetNames"] = {"smile", "blink"};
  json hat = avatar.square();
  hat["material"] = 2;
  hat["attributes"].erase("NORMAL");
  avatar.add_mesh(hat, false, avatar.node("head"));
  const auto textured = [&](const Bytes& bytes, const std::string& mime) {
    return json{{"pbrMetallicRoughness",
                 {{"baseColorTexture", {{"index", avatar.add_picture(bytes, mime)}}}}}};
  };
  avatar.json["materials"] = {textured(png(3, 2), "image/png"), textured(jpeg(8, 8), "image/jpeg"),
                              textured(webp(3, 3), "image/webp")};
  auto& webp_texture = avatar.json["textures"][2];
  webp_texture["extensions"]["EXT_texture_webp"]["source"] = webp_texture["source"];
  avatar.json["materials"][1]["alphaMode"] = "MASK";
  avatar.json["materials"][2]["extensions"]["KHR_materials_unlit"] = json::object();
  avatar.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
             ["KHR_texture_transform"] = {{"offset", {0.5, 0}}, {"scale", {0.5, 1}}};
  return out;
}

}  // namespace

TinyAvatar rich_vrm1() {
  Rich made = rich(false);
  TinyAvatar& avatar = made.avatar;
  json& vrm = avatar.json["extensions"]["VRMC_vrm"];
  vrm["specVersion"] = "1.0";
  vrm["meta"] = {{"name", "Ann"}, {"authors", {"Somebody"}}, {"allowRedistribution", true}};
  for (const BoneInfo& bone : kBones)
    if (bone.name != "upperChest")
      vrm["humanoid"]["humanBones"][std::string(bone.name)]["node"] =
          avatar.node(std::string(bone.name));
  vrm["humanoid"]["humanBones"]["leftThumbMetacarpal"]["node"] = avatar.node("leftThumb1");
  vrm["humanoid"]["humanBones"]["leftEye"]["node"] = avatar.node("leftEye");
  vrm["expressions"]["preset"]["happy"]["morphTargetBinds"] = {
      {{"node", made.face}, {"index", 0}, {"weight", 1.0}}};
  vrm["firstPerson"]["meshAnnotations"] = {{{"node", made.face}, {"type", "thirdPersonOnly"}}};
  avatar.json["materials"][1]["extensions"]["VRMC_materials_mtoon"] = {
      {"shadeColorFactor", {0.5, 0.4, 0.4}}, {"shadingToonyFactor", 0.8}};
  json& springs = avatar.json["extensions"]["VRMC_springBone"];
  springs["colliders"] = {
      {{"node", avatar.node("head")}, {"shape", {{"sphere", {{"radius", 0.1}}}}}},
      {{"node", avatar.node("chest")},
       {"shape", {{"capsule", {{"radius", 0.1}, {"tail", {0, 0.2, 0}}}}}}}};
  springs["colliderGroups"] = {{{"colliders", {0, 1}}}};
  springs["springs"] = {{{"colliderGroups", {0}},
                         {"joints",
                          {{{"node", made.hair[0]}, {"hitRadius", 0.02}, {"stiffness", 1.0}},
                           {{"node", made.hair[1]}, {"gravityPower", 0.2}},
                           {{"node", made.hair[2]}}}}}};
  return avatar;
}

TinyAvatar rich_vrm0() {
  Rich made = rich(true);
  TinyAvatar& avatar = made.avatar;
  json& vrm = avatar.json["extensions"]["VRM"];
  vrm["meta"] = {{"title", "Ann"}, {"author", "Somebody"}, {"licenseName", "CC0"}};
  for (const BoneInfo& bone : kBones)
    if (bone.name != "upperChest")
      vrm["humanoid"]["humanBones"].push_back(
          {{"bone", bone.name}, {"node", avatar.node(std::string(bone.name))}});
  vrm["humanoid"]["humanBones"].push_back(
      {{"bone", "leftThumbProximal"}, {"node", avatar.node("leftThumb1")}});
  vrm["blendShapeMaster"]["blendShapeGroups"] = {
      {{"name", "Joy"},
       {"presetName", "joy"},
       {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 100}}}}}};
  vrm["firstPerson"]["meshAnnotations"] = {{{"mesh", 0}, {"firstPersonFlag", "Both"}}};
  vrm["materialProperties"] = {
      {{"shader", "VRM/MToon"},
       {"floatProperties", {{"_ShadeToony", 0.8}, {"_BlendMode", 1}, {"_Cutoff", 0.4}}},
       {"vectorProperties",
        {{"_Color", {1, 0.5, 0.5, 1}},
         {"_ShadeColor", {0.5, 0.4, 0.4, 1}},
         {"_MainTex", {0, 0, 1, 1}}}},
       {"textureProperties", {{"_MainTex", 0}}}}};
  vrm["secondaryAnimation"]["colliderGroups"] = {
      {{"node", avatar.node("head")},
       {"colliders", {{{"offset", {{"x", 0}, {"y", 0.1}, {"z", 0.05}}}, {"radius", 0.1}}}}}};
  vrm["secondaryAnimation"]["boneGroups"] = {{{"stiffiness", 1.5},
                                              {"gravityDir", {{"x", 0}, {"y", -1}, {"z", 0}}},
                                              {"center", -1},
                                              {"bones", {made.hair[0]}},
                                              {"colliderGroups", {0}}}};
  return avatar;
}

TinyAvatar plain_glb() {
  ToolNames names;
  names.left = "Left";
  names.right = "Right";
  names.trunk = {"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2"};
  names.neck = {"mixamorig:Neck", "mixamorig:Head"};
  for (std::string* name : {&names.shoulder, &names.hand, &names.foot})
    *name = "mixamorig:" + *name;
  names.upper_arm = "mixamorig:%Arm";
  names.lower_arm = "mixamorig:%ForeArm";
  names.thigh = "mixamorig:%UpLeg";
  names.shin = "mixamorig:%Leg";
  names.toes = "mixamorig:%ToeBase";
  TinyAvatar avatar(names);
  json square = avatar.square();
  square["attributes"] = {{"POSITION", square["attributes"]["POSITION"]}};
  avatar.add_mesh(square, false, avatar.node("mixamorig:Hips"));
  return avatar;
}

}  // namespace dance::test
