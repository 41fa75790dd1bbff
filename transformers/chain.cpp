#include "transformers/chain.h"

#include <algorithm>
#include <array>

#include "transformers/conceal/bridge.h"
#include "transformers/playout/hold.h"
#include "transformers/predict/predict.h"
#include "transformers/rhythm/rhythm.h"
#include "transformers/style/style_presets.h"
#include "transformers/style/stylize.h"

namespace dance {
namespace {

using Arguments = std::vector<std::string_view>;

Result<std::unique_ptr<Transformer>> make_bridge(const Arguments& arguments, const ChainParts&) {
  BridgeOptions options;
  Settings settings("bridge", arguments);
  settings.duration("blend", options.blend, Duration::ms(5), Duration::s(1));
  if (auto done = settings.done(); !done) return tl::make_unexpected(done.error());
  return std::make_unique<Bridge>(options);
}

Result<std::unique_ptr<Transformer>> make_hold(const Arguments& arguments, const ChainParts&) {
  if (arguments.empty()) return std::make_unique<Hold>();
  if (arguments.size() != 1)
    return fail(
        "hold takes one length of time, like 'hold 20ms', or none: as short as the line lets");
  DANCE_TRY(const Duration window, parse_duration(arguments[0]));
  if (window < Duration() || window > Duration::s(2))
    return fail("hold takes 0ms to 2s, not '" + std::string(arguments[0]) + "'");
  return std::make_unique<Hold>(window);
}

Result<std::unique_ptr<Transformer>> make_predict(const Arguments& arguments,
                                                  const ChainParts& parts) {
  PredictOptions options;
  options.model = parts.predict_model;
  Settings settings("predict", arguments);
  settings.number("lead", options.lead, 0.0, 1.5)
      .duration("most", options.most, Duration(), DancePredictor::kFurthest);
  if (auto done = settings.done(); !done) return tl::make_unexpected(done.error());
  return std::make_unique<Predict>(options);
}

Result<std::unique_ptr<Transformer>> make_rhythm(const Arguments& arguments, const ChainParts&) {
  RhythmOptions options;
  double most_error_mm = options.most_error_m * 1e3;
  Settings settings("rhythm", arguments);
  settings.number_or("beats", "auto", -1.0, options.beats, 0.0, 8.0)
      .number("count", options.count, 1.0, 8.0)
      .number("strength", options.strength, 0.0, 1.0)
      .number("error", most_error_mm, 1.0, 1000.0);
  if (auto done = settings.done(); !done) return tl::make_unexpected(done.error());
  options.most_error_m = most_error_mm * 1e-3;
  return std::make_unique<Rhythm>(options);
}

Result<std::unique_ptr<Transformer>> make_stylize(const Arguments& arguments, const ChainParts&) {
  DANCE_TRY(const Style style, read_style("stylize", arguments, kUsualMix));
  return std::make_unique<Stylize>(style);
}

struct Entry {
  std::string_view name;
  Result<std::unique_ptr<Transformer>> (*make)(const Arguments& arguments, const ChainParts& parts);
};

// Every transformer of the tree.
constexpr Entry kTransformers[]{
    {"bridge", make_bridge}, {"hold", make_hold},       {"predict", make_predict},
    {"rhythm", make_rhythm}, {"stylize", make_stylize},
};

Arguments split(std::string_view text) {
  Arguments words;
  while (!text.empty()) {
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find(' '), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

Result<std::unique_ptr<Transformer>> make_station(std::string_view specification,
                                                  const ChainParts& parts) {
  Arguments words = split(specification);
  std::string known;
  for (const Entry& entry : kTransformers) {
    if (!words.empty() && entry.name == words[0]) {
      words.erase(words.begin());
      return entry.make(words, parts);
    }
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  return fail("there is no transformer '" + std::string(specification) + "'; there are: " + known);
}

}  // namespace

Result<Chain> Chain::make(const std::vector<std::string>& specifications, const ChainParts& parts) {
  Chain chain;
  for (const std::string& specification : specifications) {
    DANCE_TRY(auto station, make_station(specification, parts));
    if (!chain.stations_.empty()) station->set_input(chain.stations_.back().get());
    chain.stations_.push_back(std::move(station));
  }
  return chain;
}

std::vector<std::shared_ptr<Learner>> Chain::learners() const {
  std::vector<std::shared_ptr<Learner>> learners;
  for (const auto& station : stations_)
    if (auto learner = station->learner()) learners.push_back(std::move(learner));
  return learners;
}

Duration Chain::patience() const {
  Duration longest;
  for (const auto& station : stations_) longest = std::max(longest, station->patience());
  return longest;
}

Transformer::Counters Chain::counters() const {
  Transformer::Counters sum;
  for (const auto& station : stations_) {
    sum.refused += station->counters().refused;
    sum.restarts += station->counters().restarts;
    sum.starved += station->counters().starved;
  }
  return sum;
}

}  // namespace dance
