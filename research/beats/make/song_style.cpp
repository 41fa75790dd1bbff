#include "research/beats/make/song_style.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/assert.h"

namespace dance {

std::span<const std::uint8_t> song_styles_file();  // song_styles.toml, by dance_embed

namespace {

template <class T>
T value_of(const toml::node_view<const toml::node> node) {
  const auto value = node.value<T>();
  DANCE_ASSERT(value.has_value());
  return *value;
}

SongVoice voice_of(std::string_view name) {
  constexpr std::array<std::string_view, 8> kNames{"drums",     "bass",  "keys", "guitar",
                                                   "distorted", "brass", "lead", "pad"};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  DANCE_ASSERT(found != kNames.end());
  return static_cast<SongVoice>(found - kNames.begin());
}

SongLayer layer_of(const toml::table& table) {
  SongLayer layer{voice_of(value_of<std::string_view>(table["voice"])),
                  table["chance"].value_or(1.0),
                  value_of<int>(table["loudness"]),
                  table["length_beats"].value_or(0.1),
                  {},
                  {},
                  {},
                  {}};
  if (const toml::array* sets = table["drums"].as_array())
    for (const toml::node& set : *sets) {
      std::array<int, 3>& drums = layer.drums.emplace_back();
      const toml::array& keys = *set.as_array();
      DANCE_ASSERT(keys.size() <= drums.size());
      for (std::size_t i = 0; i < keys.size(); ++i) drums[i] = keys[i].value_or(0);
    }
  if (const toml::array* programs = table["programs"].as_array())
    for (const toml::node& program : *programs) layer.programs.push_back(program.value_or(0));
  for (const toml::node& row : *table["rows"].as_array())
    layer.rows.push_back(row.value_or(std::string()));
  if (const toml::array* rows = table["kept_rows"].as_array())
    for (const toml::node& row : *rows) layer.kept_rows.push_back(row.value_or(std::string()));
  return layer;
}

std::vector<SongStyle> read_styles(const toml::table& document) {
  std::vector<SongStyle> styles;
  for (const toml::node& node : *document["style"].as_array()) {
    const toml::table& table = *node.as_table();
    SongStyle style{value_of<std::string>(table["name"]),
                    value_of<double>(table["tempo_bpm"][0]),
                    value_of<double>(table["tempo_bpm"][1]),
                    table["is_steady"].value_or(false),
                    table["swing"][0].value_or(0.5),
                    table["swing"][1].value_or(0.5),
                    {}};
    if (const auto other = table["layers_of"].value<std::string_view>()) {
      const auto is_other = [&](const SongStyle& s) { return s.name == *other; };
      style.layers = std::find_if(styles.begin(), styles.end(), is_other)->layers;
    } else {
      for (const toml::node& layer : *table["layers"].as_array())
        style.layers.push_back(layer_of(layer.is_string()
                                            ? *document[layer.ref<std::string>()].as_table()
                                            : *layer.as_table()));
    }
    styles.push_back(std::move(style));
  }
  return styles;
}

}  // namespace

const std::vector<SongStyle>& song_styles() {
  static const std::vector<SongStyle> kStyles = [] {
    const std::span<const std::uint8_t> file = song_styles_file();
    return read_styles(
        toml::parse(std::string_view(reinterpret_cast<const char*>(file.data()), file.size())));
  }();
  return kStyles;
}

}  // namespace dance
