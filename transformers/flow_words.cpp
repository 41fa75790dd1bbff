// The words of a session file's `through`, and the slot of the flow that each fills.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "transformers/flow.h"
#include "transformers/playout/hold_clock.h"
#include "transformers/playout/live_clock.h"
#include "transformers/playout/newest_clock.h"
#include "transformers/predict/dance_extrapolator.h"
#include "transformers/rhythm/rhythm_clock.h"
#include "transformers/settings.h"
#include "transformers/style/style_presets.h"
#include "transformers/style/stylize.h"

namespace dance {
namespace {

using Arguments = std::vector<std::string_view>;

constexpr std::size_t kHeldPoses = 256;        // 4 s at 60 Hz, 2 s at 120 Hz
constexpr std::size_t kMeasuredPoses = 512;    // of predictions that rhythm waits for the truth of
constexpr std::size_t kPredictedPoses = 1024;  // 12 s at 60 Hz and somewhat more

// What the words of one route ask for.
struct Draft {
  Flow::Slots slots;
  std::unique_ptr<PlayoutClock> hold;
  std::optional<RhythmOptions> rhythm;
  double lead = 1.0;
};

Result<void> take_hold(const Arguments& arguments, const FlowParts&, Draft& draft) {
  std::optional<Duration> window;
  if (arguments.size() > 1)
    return fail(
        "hold takes one length of time, like 'hold 20ms', or none: as short as the line allows");
  if (!arguments.empty()) {
    DANCE_TRY(window, parse_duration(arguments[0]));
    if (*window < Duration() || *window > Duration::s(2))
      return fail("hold takes 0ms to 2s, not '" + std::string(arguments[0]) + "'");
  }
  if (window) draft.slots.setting.hold_ms = static_cast<float>(window->as_ms());
  draft.hold = std::make_unique<HoldClock>(window);
  return {};
}

Result<void> take_predict(const Arguments& arguments, const FlowParts& parts, Draft& draft) {
  Settings settings("predict", arguments);
  bool has_partner = true;
  settings.number("lead", draft.lead, 0.0, 1.5)
      .flag("partner", has_partner)
      .duration("most", draft.slots.source.reach, Duration(), DancePredictor::kFurthest);
  draft.slots.setting.lead = static_cast<float>(draft.lead);
  draft.slots.setting.reach_ms = static_cast<float>(draft.slots.source.reach.as_ms());
  draft.slots.source.extrapolator = std::make_unique<DanceExtrapolator>(parts.predict_model);
  if (has_partner) draft.slots.source.partner = std::make_unique<PartnerGuide>();
  return settings.done();
}

Result<void> take_bridge(const Arguments& arguments, const FlowParts&, Draft& draft) {
  Settings settings("bridge", arguments);
  settings.duration("blend", draft.slots.half_life, Duration::ms(5), Duration::s(1));
  draft.slots.source.concealment = std::make_unique<Concealment>();
  return settings.done();
}

Result<void> take_rhythm(const Arguments& arguments, const FlowParts&, Draft& draft) {
  RhythmOptions options;
  double most_error_mm = options.most_error_m * 1e3;
  Settings settings("rhythm", arguments);
  settings.number_or("beats", "auto", -1.0, options.beats, 0.0, 8.0)
      .number("count", options.count, 1.0, 8.0)
      .number("strength", options.strength, 0.0, 1.0)
      .number("error", most_error_mm, 1.0, 1000.0);
  options.most_error_m = most_error_mm * 1e-3;
  FlowSetting& setting = draft.slots.setting;
  setting.rhythm_beats = static_cast<float>(options.beats);
  setting.rhythm_count = static_cast<float>(options.count);
  setting.rhythm_strength = static_cast<float>(options.strength);
  setting.rhythm_error_mm = static_cast<float>(most_error_mm);
  draft.rhythm = options;
  return settings.done();
}

Result<void> take_stylize(const Arguments& arguments, const FlowParts&, Draft& draft) {
  DANCE_TRY(const Style style, read_style("stylize", arguments, kUsualMix));
  FlowSetting& setting = draft.slots.setting;
  setting.gain = style.gain;
  setting.periodic = style.periodic;
  setting.dynamic = style.dynamic;
  draft.slots.filters.push_back(std::make_unique<Stylize>(style));
  return {};
}

// Changes nothing in the flow: two dancers are needed for it.
Result<void> take_hold_hands(const Arguments& arguments, const FlowParts&, Draft& draft) {
  draft.slots.holds_hands = true;
  return Settings("hold-hands", arguments).done();
}

struct Word {
  std::string_view name;
  Result<void> (*take)(const Arguments& arguments, const FlowParts& parts, Draft& draft);
  // What it is while dancing, where it can be set and switched then.
  std::optional<FlowWord> setting;
  // Whether it fills a slot of the flow; without such a word poses pass as they come.
  bool fills_slot = true;
};

// Every transformer of the tree, in the order in which they stand in a route.
constexpr auto kWords = std::to_array<Word>({
    {"hold", take_hold, FlowWord::kHold},           // which moment
    {"predict", take_predict, FlowWord::kPredict},  // its pose, where it has not come
    {"bridge", take_bridge, FlowWord::kBridge},     // and where nothing comes for long
    {"rhythm", take_rhythm, FlowWord::kRhythm},     // which moment, by the music
    {"stylize", take_stylize, FlowWord::kStylize},  // how it looks
    {"hold-hands", take_hold_hands, {}, false},     // and how two dancers look together
});

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

// on=0: the word stands in the route, to be switched on while dancing.
Result<bool> take_switch(std::string_view word, Arguments& arguments) {
  bool is_on = true;
  for (const std::string_view argument : arguments) {
    if (!argument.starts_with("on=")) continue;
    if (argument != "on=0" && argument != "on=1")
      return fail(fmt::format("{} takes on=0 or on=1, not '{}'", word, argument));
    is_on = argument == "on=1";
  }
  std::erase_if(arguments, [](std::string_view argument) { return argument.starts_with("on="); });
  return is_on;
}

// The place of a transformer in the table.
Result<std::size_t> place_of(std::string_view text) {
  const Arguments words = split(text);
  std::string known;
  for (std::size_t place = 0; place < kWords.size(); ++place) {
    if (!words.empty() && kWords[place].name == words[0]) return place;
    known += (known.empty() ? "" : ", ") + std::string(kWords[place].name);
  }
  return fail(fmt::format("there is no transformer '{}'; there are: {}", text, known));
}

Result<void> check_order(const std::vector<std::string>& through,
                         const std::vector<std::size_t>& places) {
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::count(places.begin(), places.end(), places[i]) > 1)
      return fail(fmt::format("'{}' stands twice in this route: it can be there once",
                              kWords[places[i]].name));
  const auto wrong = std::is_sorted_until(places.begin(), places.end());
  if (wrong == places.end()) return {};
  std::array<std::string_view, kWords.size()> ordered;
  for (std::size_t i = 0; i < places.size(); ++i) ordered[places[i]] = through[i];
  std::string right;
  for (const std::string_view text : ordered)
    if (!text.empty()) right += fmt::format("{}\"{}\"", right.empty() ? "" : ", ", text);
  return fail(fmt::format("'{}' cannot stand before '{}'; the right order is: [{}]",
                          kWords[*(wrong - 1)].name, kWords[*wrong].name, right));
}

Flow::Slots assemble(Draft draft) {
  Flow::Slots slots = std::move(draft.slots);
  const bool predicts = slots.source.extrapolator != nullptr;
  const bool conceals = slots.source.concealment != nullptr;
  std::unique_ptr<PlayoutClock> clock = std::move(draft.hold);
  const bool has_clock = clock || predicts || conceals;
  // At strength 0 rhythm changes nothing, unless it alone plays out.
  const bool is_in_rhythm = draft.rhythm && (draft.rhythm->strength > 0.0 || !has_clock);
  if (!clock && has_clock) clock = std::make_unique<LiveClock>(draft.lead);
  if (!clock && !is_in_rhythm) clock = std::make_unique<NewestClock>();
  if (is_in_rhythm) clock = std::make_unique<RhythmClock>(*draft.rhythm, std::move(clock));
  // rhythm measures how far predictions are good.
  if (is_in_rhythm) slots.source.reach = DancePredictor::kFurthest;
  slots.source.is_final = !is_in_rhythm && !predicts;
  // A rhythm that was left out, as it changes nothing, cannot be set.
  slots.setting.has[index_of(FlowWord::kRhythm)] = is_in_rhythm;
  slots.clock = std::move(clock);
  slots.corrects_from_now = is_in_rhythm;
  slots.has_finish = is_in_rhythm || predicts || conceals;
  slots.poses = conceals       ? Concealment::kPoses
                : predicts     ? kPredictedPoses
                : is_in_rhythm ? kMeasuredPoses
                               : kHeldPoses;
  return slots;
}

}  // namespace

Result<Flow> Flow::make(const std::vector<std::string>& through, const FlowParts& parts) {
  std::vector<std::size_t> places;
  for (const std::string& text : through) {
    DANCE_TRY(const std::size_t place, place_of(text));
    places.push_back(place);
  }
  if (auto right = check_order(through, places); !right) return tl::make_unexpected(right.error());
  Draft draft;
  for (std::size_t i = 0; i < through.size(); ++i) {
    Arguments arguments = split(through[i]);
    arguments.erase(arguments.begin());
    FlowSetting& setting = draft.slots.setting;
    const Word& word = kWords[places[i]];
    if (word.setting) {
      setting.has[index_of(*word.setting)] = true;
      DANCE_TRY(setting.on[index_of(*word.setting)], take_switch(word.name, arguments));
    }
    if (auto taken = word.take(arguments, parts, draft); !taken)
      return tl::make_unexpected(taken.error());
  }
  if (std::ranges::none_of(places, [](std::size_t place) { return kWords[place].fills_slot; })) {
    Flow flow;
    flow.holds_hands_ = draft.slots.holds_hands;
    return flow;
  }
  return Flow(assemble(std::move(draft)));
}

}  // namespace dance
