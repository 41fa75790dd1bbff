#include "research/touch/touch_spread.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

namespace dance {
namespace {

// By dance, delay and seed.
using Figures = std::vector<HoldFigures>;

struct Places {
  std::size_t dances, delays, seeds;
  std::size_t of(std::size_t dance, std::size_t delay, std::size_t seed) const {
    return (dance * delays + delay) * seeds + seed;
  }
  std::size_t count() const { return dances * delays * seeds; }
};

std::vector<PalmHold::Limits> limits_to_try(const PalmHold::Limits& built_in) {
  std::vector<PalmHold::Limits> all{built_in};
  for (const float begin_m : {0.065f, 0.075f, 0.09f})
    for (const float early_m : {0.09f, 0.12f, 0.15f})
      for (const float soon_m : {0.02f, 0.04f, 0.06f})
        for (const float end_m : {0.17f, 0.21f, 0.23f, 0.25f})
          for (const int release_ms : {150, 220, 260, 300}) {
            PalmHold::Limits limits = built_in;
            limits.begin_m = begin_m;
            limits.again_m = begin_m;
            limits.early_m = early_m;
            limits.soon_m = soon_m;
            limits.end_m = end_m;
            limits.release_delay = Duration::ms(release_ms);
            all.push_back(limits);
          }
  return all;
}

// What is missed, in percent of the pictures, and a false hold a minute as much as one percent.
double cost_of(const HoldFigures& figures) {
  return 100.0 * (1.0 - figures.found()) + figures.per_minute(figures.false_holds);
}

// Of all limits, those that cost least on all dances but one.
std::size_t best_without(const std::vector<Figures>& tried, const Places& places,
                         std::size_t dance) {
  std::size_t best = 0;
  double least = 1e9;
  for (std::size_t l = 0; l < tried.size(); ++l) {
    HoldFigures others;
    for (std::size_t d = 0; d < places.dances; ++d)
      for (std::size_t i = 0; d != dance && i < places.delays * places.seeds; ++i)
        others += tried[l][d * places.delays * places.seeds + i];
    const double cost = cost_of(others);
    if (cost >= least) continue;
    least = cost;
    best = l;
  }
  return best;
}

SpreadRow row_of(const char* way, Duration delay, const Places& places, std::size_t delay_index,
                 const std::function<const Figures&(std::size_t dance)>& figures_of) {
  SpreadRow row{delay, way, std::vector<HoldFigures>(places.seeds)};
  for (std::size_t dance = 0; dance < places.dances; ++dance)
    for (std::size_t seed = 0; seed < places.seeds; ++seed)
      row.figures[seed] += figures_of(dance)[places.of(dance, delay_index, seed)];
  return row;
}

struct SpreadOf {
  double mean = 0.0, least = 0.0, most = 0.0;
};

template <class Value>
SpreadOf spread_of(const SpreadRow& row, Value value) {
  SpreadOf spread{0.0, 1e9, -1e9};
  for (const HoldFigures& figures : row.figures) {
    const double x = value(figures);
    spread.mean += x / static_cast<double>(row.figures.size());
    spread.least = std::min(spread.least, x);
    spread.most = std::max(spread.most, x);
  }
  return spread;
}

std::string text_of(const SpreadOf& spread, int decimals) {
  return fmt::format("{:.{}f} ({:.{}f}-{:.{}f})", spread.mean, decimals, spread.least, decimals,
                     spread.most, decimals);
}

struct SpreadColumn {
  const char* name;
  int decimals;
  double (*value)(const HoldFigures&);
};
constexpr std::array<SpreadColumn, 5> kSpreadColumns{{
    {"found %", 1, [](const HoldFigures& f) { return 100.0 * f.found(); }},
    {"false/min", 2, [](const HoldFigures& f) { return f.per_minute(f.false_holds); }},
    {"far/min", 2, [](const HoldFigures& f) { return f.per_minute(f.far_holds); }},
    {"breaks/min", 1, [](const HoldFigures& f) { return f.per_minute(f.breaks); }},
    {"apart %", 1, [](const HoldFigures& f) { return 100.0 * f.apart(); }},
}};

}  // namespace

TouchSpread evaluate_spread(const std::vector<CoupleTake>& couples, const TouchLine& line,
                            const SpreadWish& wish) {
  const Places places{couples.size(), wish.delays.size(), wish.seeds};
  const std::vector<PalmHold::Limits> limits =
      wish.chooses ? limits_to_try(line.limits) : std::vector<PalmHold::Limits>{line.limits};
  Figures near(places.count());
  std::vector<Figures> tried(limits.size(), Figures(places.count()));
  for (std::size_t dance = 0; dance < places.dances; ++dance)
    for (std::size_t delay = 0; delay < places.delays; ++delay)
      for (std::size_t seed = 0; seed < places.seeds; ++seed) {
        TouchLine how = line;
        how.delay = wish.delays[delay];
        how.seed = line.seed + seed;
        const ShownStage stage = streamed_stage(couples[dance], how);
        if (stage.empty()) continue;
        const std::size_t place = places.of(dance, delay, seed);
        near[place] = near_on(couples[dance], stage);
        for (std::size_t l = 0; l < limits.size(); ++l)
          tried[l][place] = holds_on(couples[dance], stage, limits[l]);
      }

  TouchSpread spread;
  spread.dances = places.dances;
  std::vector<std::size_t> chosen;
  for (std::size_t dance = 0; wish.chooses && dance < places.dances; ++dance) {
    chosen.push_back(best_without(tried, places, dance));
    spread.chosen.push_back(limits[chosen.back()]);
  }
  for (std::size_t delay = 0; delay < places.delays; ++delay) {
    const Duration d = wish.delays[delay];
    spread.rows.push_back(row_of("within 8 cm", d, places, delay,
                                 [&](std::size_t) -> const Figures& { return near; }));
    spread.rows.push_back(
        row_of("holds", d, places, delay, [&](std::size_t) -> const Figures& { return tried[0]; }));
    if (wish.chooses)
      spread.rows.push_back(
          row_of("chosen on others", d, places, delay,
                 [&](std::size_t dance) -> const Figures& { return tried[chosen[dance]]; }));
  }
  return spread;
}

std::string touch_spread_table(const TouchSpread& spread) {
  if (spread.rows.empty()) return {};
  const SpreadRow& first = spread.rows.front();
  std::string text = fmt::format(
      "on the stage: {} dances, {:.1f} minutes, {} seeds: mean (least-most)\n\n{:<9}{:<18}",
      spread.dances, first.figures.front().seconds / 60.0, first.figures.size(), "delay", "");
  for (const SpreadColumn& column : kSpreadColumns) text += fmt::format("{:>20}", column.name);
  text += "\n";
  for (const SpreadRow& row : spread.rows) {
    text += fmt::format("{:<9}{:<18}", fmt::format("{} ms", row.delay.count_ms()), row.way);
    for (const SpreadColumn& column : kSpreadColumns)
      text += fmt::format("{:>20}", text_of(spread_of(row, column.value), column.decimals));
    text += "\n";
  }
  for (std::size_t dance = 0; dance < spread.chosen.size(); ++dance) {
    const PalmHold::Limits& limits = spread.chosen[dance];
    text += fmt::format(
        "{}for dance {}: begin {:.0f} mm, early {:.0f}, soon {:.0f}, end {:.0f}, release {} ms\n",
        dance == 0 ? "\nlimits chosen on the other dances\n" : "", dance + 1,
        1e3 * static_cast<double>(limits.begin_m), 1e3 * static_cast<double>(limits.early_m),
        1e3 * static_cast<double>(limits.soon_m), 1e3 * static_cast<double>(limits.end_m),
        limits.release_delay.count_ms());
  }
  return text;
}

std::string touch_spread_json(const TouchSpread& spread) {
  nlohmann::ordered_json report;
  report["dances"] = spread.dances;
  for (const SpreadRow& row : spread.rows) {
    nlohmann::ordered_json one{{"delay_ms", row.delay.count_ms()}, {"way", row.way}};
    for (const SpreadColumn& column : kSpreadColumns) {
      const SpreadOf figures = spread_of(row, column.value);
      one[column.name] = {figures.mean, figures.least, figures.most};
    }
    report["rows"].push_back(one);
  }
  for (const PalmHold::Limits& limits : spread.chosen)
    report["chosen"].push_back({{"begin_m", limits.begin_m},
                                {"early_m", limits.early_m},
                                {"soon_m", limits.soon_m},
                                {"end_m", limits.end_m},
                                {"release_ms", limits.release_delay.count_ms()}});
  return report.dump(2) + "\n";
}

}  // namespace dance
