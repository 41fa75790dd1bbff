#include "house/headset/hosted_headset.h"

#include "core/base/comma_numbers.h"
#include "core/base/plain_number.h"
#include "core/pose/pose.h"
#include "house/toml_reader.h"

namespace dance {
namespace {

bool is_spot(const std::string& text) {
  const auto numbers = comma_numbers(text);
  return numbers && (numbers->size() == 2 || numbers->size() == 3) &&
         std::all_of(numbers->begin(), numbers->end(),
                     [](float number) { return std::abs(number) <= kMaxStageDistance_m; });
}

}  // namespace

HostedHeadset read_headset(TomlReader& reader) {
  HostedHeadset headset;
  headset.guest = read_guest(reader, "guest", reader.required_string("guest"));
  headset.at = reader.string_or("at", "");
  if (!headset.at.empty() && !is_spot(headset.at))
    reader.complain("at", "is X,Z or X,Z,HEADING, in metres and degrees, as \"0,1.5,180\"");
  headset.body = reader.string_or("body", "");
  if (!headset.body.empty() && headset.body != "auto" && headset.body != "rules" &&
      headset.body != "learned")
    reader.complain("body", "is auto, rules or learned");
  headset.tracking_only = reader.bool_or("tracking_only", false);
  headset.window = reader.bool_or("window", true);
  headset.haptics = reader.bool_or("haptics", true);
  headset.tags = reader.bool_or("tags", true);
  headset.personal_space_m = reader.number_or("personal_space", -1.0, 0.0, 3.0);
  headset.floor_m = reader.number_or("floor", -1.0, 1.5, 50.0);
  headset.scale = reader.number_or("scale", -1.0, 0.25, 2.0);
  reader.finish();
  return headset;
}

std::vector<std::string> headset_arguments(const HostedHeadset& headset, const std::string& bus) {
  std::vector<std::string> words{"--bus", bus, "--guest", std::string(headset.guest.view())};
  const auto add = [&](const char* option, const std::string& value) {
    words.push_back(std::string(option) + "=" + value);  // a value may begin with a dash
  };
  if (!headset.at.empty()) add("--at", headset.at);
  if (!headset.body.empty()) add("--body", headset.body);
  if (headset.tracking_only) words.emplace_back("--tracking-only");
  if (!headset.window) words.emplace_back("--no-mirror");
  if (!headset.haptics) words.emplace_back("--no-haptics");
  if (!headset.tags) words.emplace_back("--no-tags");
  if (headset.personal_space_m >= 0.0)
    add("--personal-space", plain_number(headset.personal_space_m));
  if (headset.floor_m >= 0.0) add("--floor", plain_number(headset.floor_m));
  if (headset.scale >= 0.0) add("--scale", plain_number(headset.scale));
  return words;
}

}  // namespace dance
