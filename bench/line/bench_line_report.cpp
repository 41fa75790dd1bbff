#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/line/bench_line.h"
#include "core/program/figures.h"

namespace dance {
namespace {

constexpr std::size_t kColumns = 12;
using Row = std::array<std::string, kColumns>;

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

double at_ms(const std::vector<Duration>& sorted, double fraction) {
  return percentile<Duration>(sorted, fraction).as_ms();
}

std::string three(const std::vector<Duration>& sorted) {
  if (sorted.empty()) return "–";
  return fmt::format("{:.1f} / {:.1f} / {:.1f}", at_ms(sorted, 0.50), at_ms(sorted, 0.95),
                     at_ms(sorted, 0.99));
}

// Of the line as it was then, where that was slower than it mostly is.
double round_trips_after_gap(const LineFigures& figures, Duration usual) {
  const Duration round_trip = std::max(figures.worst_gap_round_trip, usual);
  return round_trip > Duration() ? figures.worst_gap_to_pose.as_seconds() / round_trip.as_seconds()
                                 : 0.0;
}

// A gap that is no more than a pose or two is not worth a word.
std::string after_gap(const LineFigures& figures, Duration round_trip) {
  if (!figures.worst_gap_is_over) return "never";
  if (figures.worst_gap < kFreeze) return "–";
  return fmt::format("{:.0f} ms, {:.1f}", figures.worst_gap_to_pose.as_ms(),
                     round_trips_after_gap(figures, round_trip));
}

Row row_of(const LineResult& line, const char* direction, const LineWayResult& way) {
  const LineFigures& figures = way.figures;
  return {line.name,
          direction,
          std::to_string(figures.sent),
          fmt::format("{:.2f}", percent(figures.delivered, figures.sent)),
          figures.has_first ? fmt::format("{:.0f}", figures.first.as_ms()) : "never",
          three(figures.ages),
          three(figures.stage_ages),
          fmt::format("{}, {:.1f} s", figures.freezes, figures.frozen.as_seconds()),
          fmt::format("{:.0f}", figures.worst_gap.as_ms()),
          after_gap(figures, line.round_trip),
          std::to_string(figures.older_delivered + figures.older_shown),
          line.has_converged ? "yes" : "no"};
}

std::vector<Row> rows_of(const BenchLineResult& result) {
  std::vector<Row> rows{{"line", "way", "sent", "delivered %", "first ms", "age ms p50 / p95 / p99",
                         "stage ms p50 / p95 / p99", "freezes", "worst gap ms", "then, round trips",
                         "older", "state"}};
  for (const LineResult& line : result.lines) {
    rows.push_back(row_of(line, "up", line.up));
    rows.push_back(row_of(line, "down", line.down));
  }
  return rows;
}

std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

std::uint64_t missed(const BenchLineResult& result) {
  std::uint64_t sum = 0;
  for (const LineResult& line : result.lines) sum += line.missed_frames;
  return sum;
}

std::string closing_words(const BenchLineOptions& options, const BenchLineResult& result) {
  return fmt::format(
      "{:g} s at {:g} Hz both ways; age: capture to handler, of what is delivered; stage: of what "
      "hold shows, and its stillness from 100 ms on. This process took {:.0f} % of a core; {} "
      "poses and moments were skipped because it was late.\n",
      options.seconds, options.hz, result.cpu_percent, missed(result));
}

nlohmann::ordered_json json_of(const std::vector<Duration>& sorted) {
  return {{"p50", rounded(at_ms(sorted, 0.50), 1e3)},
          {"p95", rounded(at_ms(sorted, 0.95), 1e3)},
          {"p99", rounded(at_ms(sorted, 0.99), 1e3)},
          {"max", rounded(at_ms(sorted, 1.0), 1e3)}};
}

nlohmann::ordered_json json_of(const LineWayResult& way, Duration round_trip) {
  const LineFigures& figures = way.figures;
  nlohmann::ordered_json json{
      {"sent", figures.sent},
      {"delivered", figures.delivered},
      {"delivered_percent", rounded(percent(figures.delivered, figures.sent), 1e3)},
      {"first_ms", nullptr},
      {"age_ms", json_of(figures.ages)},
      {"stage_age_ms", json_of(figures.stage_ages)},
      {"stage_moments", figures.stage_ages.size()},
      {"freezes", figures.freezes},
      {"frozen_s", rounded(figures.frozen.as_seconds(), 1e3)},
      {"worst_gap_ms", rounded(figures.worst_gap.as_ms(), 1e3)},
      {"worst_gap_is_over", figures.worst_gap_is_over},
      {"worst_gap_to_pose_ms", rounded(figures.worst_gap_to_pose.as_ms(), 1e3)},
      {"worst_gap_to_pose_round_trips", rounded(round_trips_after_gap(figures, round_trip), 1e2)},
      {"slowest_after_gap_ms", rounded(figures.slowest_after_gap.as_ms(), 1e3)},
      {"older_delivered", figures.older_delivered},
      {"older_shown", figures.older_shown},
      {"undecoded", way.undecoded},
      {"key_frames_asked", way.intra_frames},
      {"references", name_of(way.references)},
      {"line",
       {{"offered", way.line.line.offered},
        {"lost", way.line.line.lost},
        {"queue_dropped", way.line.line.queue_dropped},
        {"overflow", way.line.overflow},
        {"delivered", way.line.delivered}}}};
  if (figures.has_first) json["first_ms"] = rounded(figures.first.as_ms(), 1e3);
  return json;
}

}  // namespace

std::string bench_line_table(const BenchLineOptions& options, const BenchLineResult& result) {
  const std::vector<Row> rows = rows_of(result);
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], letters(row[i]));
  std::string out;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kColumns; ++i) {
      const std::string blanks(widths[i] - letters(row[i]), ' ');
      out += i < 2 ? row[i] + blanks : blanks + row[i];
      out += i + 1 < kColumns ? "  " : "\n";
    }
  }
  return out + '\n' + closing_words(options, result);
}

std::string bench_line_markdown(const BenchLineOptions& options, const BenchLineResult& result) {
  std::string out;
  bool is_head = true;
  for (const Row& row : rows_of(result)) {
    out += '|';
    for (const std::string& cell : row) out += ' ' + cell + " |";
    out += '\n';
    if (is_head) {
      out += '|';
      for (std::size_t i = 0; i < kColumns; ++i) out += i < 2 ? " --- |" : " ---: |";
      out += '\n';
    }
    is_head = false;
  }
  return out + '\n' + closing_words(options, result);
}

std::string bench_line_json(const BenchLineOptions& options, const BenchLineResult& result) {
  nlohmann::ordered_json json{{"seconds", options.seconds},
                              {"hz", options.hz},
                              {"cpu_percent", rounded(result.cpu_percent, 10.0)},
                              {"lines", nlohmann::ordered_json::array()}};
  for (const LineResult& line : result.lines)
    json["lines"].push_back({{"name", line.name},
                             {"round_trip_ms", rounded(line.round_trip.as_ms(), 1e3)},
                             {"has_converged", line.has_converged},
                             {"converged_after_ms", rounded(line.converged_after.as_ms(), 1e3)},
                             {"lapses", line.lapses},
                             {"reconnects", line.reconnects},
                             {"missed_frames", line.missed_frames},
                             {"up", json_of(line.up, line.round_trip)},
                             {"down", json_of(line.down, line.round_trip)}});
  return json.dump(2) + "\n";
}

}  // namespace dance
