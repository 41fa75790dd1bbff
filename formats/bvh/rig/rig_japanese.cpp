#include "formats/bvh/rig/rig_japanese.h"

#include <algorithm>

namespace dance {
namespace {

struct Translation {
  std::string_view japanese;
  std::string_view english;
};

// A word stands before every word that it begins with.
constexpr Translation kTranslations[] = {
    {"左", "left"},        {"右", "right"},     {"上半身", "spine"}, {"下半身", "pelvis"},
    {"腰", "waist"},       {"首", "neck"},      {"頭", "head"},      {"肩", "collar"},
    {"腕捩", "twist"},     {"手捩", "twist"},   {"捩", "twist"},     {"腕", "upper arm"},
    {"ひじ", "elbow"},     {"肘", "elbow"},     {"手首", "wrist"},   {"手先", "tip"},
    {"足首", "ankle"},     {"足先", "tip"},     {"つま先", "toe"},   {"爪先", "toe"},
    {"足", "thigh"},       {"ひざ", "knee"},    {"膝", "knee"},      {"親指", "thumb"},
    {"人差し指", "index"}, {"人差指", "index"}, {"人指", "index"},   {"中指", "middle"},
    {"薬指", "ring"},      {"小指", "little"},  {"指先", "tip"},     {"先", "tip"},
    {"親", "parent"},      {"ＩＫ", "ik"},      {"ダミー", "dummy"}, {"キャンセル", "cancel"},
    {"補助", "helper"},    {"髪", "hair"},      {"胸", "breast"},    {"スカート", "skirt"},
    {"目", "eye"},         {"両", "both"},      {"０", "0"},         {"１", "1"},
    {"２", "2"},           {"３", "3"},         {"４", "4"},         {"５", "5"},
};

}  // namespace

std::string in_english(std::string_view name) {
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  if (std::all_of(name.begin(), name.end(), is_ascii)) return std::string(name);
  std::string english;
  while (!name.empty()) {
    const auto* found =
        std::find_if(std::begin(kTranslations), std::end(kTranslations),
                     [&](const Translation& word) { return name.starts_with(word.japanese); });
    if (found == std::end(kTranslations)) {
      english += name.front();
      name.remove_prefix(1);
      continue;
    }
    english += ' ';
    english += found->english;
    english += ' ';
    name.remove_prefix(found->japanese.size());
  }
  return english;
}

}  // namespace dance
