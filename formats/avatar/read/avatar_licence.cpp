#include "formats/avatar/read/avatar_licence.h"

#include "formats/gltf/glb_json.h"
#include "formats/gltf/glb_text.h"

namespace dance {
namespace {

using tinygltf::Value;

constexpr std::size_t kLongestText = 200;
constexpr std::size_t kLongestLicence = 1000;

void add(const char* what, const std::string& text, std::string& licence) {
  const std::string plain = plain_line(text, kLongestText);
  if (plain.empty()) return;
  licence += (licence.empty() ? "" : "; ") + std::string(what) + plain;
}

void add(const char* what, const Value* value, std::string& licence) {
  add(what, text_of(value), licence);
}

void read_vrm1(const Value* meta, AvatarModel& model) {
  model.name = plain_name(text_of(member(meta, "name")));
  const Value* authors = member(meta, "authors");
  for (std::size_t a = 0; a < std::min<std::size_t>(length_of(authors), 4); ++a)
    add("by ", item(authors, a), model.licence);
  add("", member(meta, "copyrightInformation"), model.licence);
  add("licence ", member(meta, "licenseUrl"), model.licence);
  add("", member(meta, "otherLicenseUrl"), model.licence);
  add("of others: ", member(meta, "thirdPartyLicenses"), model.licence);
  add("worn by ", member(meta, "avatarPermission"), model.licence);
  add("commercial use: ", member(meta, "commercialUsage"), model.licence);
  add("credit: ", member(meta, "creditNotation"), model.licence);
  add("modification: ", member(meta, "modification"), model.licence);
  if (member(meta, "allowRedistribution"))
    add("redistribution: ",
        std::string(is_true(member(meta, "allowRedistribution")) ? "allowed" : "not allowed"),
        model.licence);
}

void read_vrm0(const Value* meta, AvatarModel& model) {
  model.name = plain_name(text_of(member(meta, "title")));
  add("by ", member(meta, "author"), model.licence);
  add("licence ", member(meta, "licenseName"), model.licence);
  add("", member(meta, "otherLicenseUrl"), model.licence);
  add("worn by ", member(meta, "allowedUserName"), model.licence);
  add("commercial use: ", member(meta, "commercialUssageName"), model.licence);  // as VRM spells it
}

}  // namespace

void read_licence(AvatarSource& source, std::string_view file_name) {
  AvatarModel& model = source.model;
  const auto& extensions = source.file.extensions;
  if (const Value* meta = member(extension_of(extensions, "VRMC_vrm"), "meta"))
    read_vrm1(meta, model);
  else if (const Value* old = member(extension_of(extensions, "VRM"), "meta"))
    read_vrm0(old, model);
  else
    add("", source.file.asset.copyright, model.licence);
  if (model.name.empty()) model.name = plain_name(file_name);
  model.licence = plain_line(model.licence, kLongestLicence);
}

}  // namespace dance
