#include <fmt/format.h>

#include <filesystem>

#include "bench/voice/bench_voice.h"
#include "core/program/figures.h"
#include "testing/line/lossy_line.h"
#include "testing/voice/voice_stream.h"

namespace dance {
namespace {

constexpr std::array kFixed = {Duration::ms(60), Duration::ms(100), Duration::ms(200)};

struct VoiceLine {
  std::string name;
  LossyWay way;
};

Result<std::vector<VoiceLine>> lines_of(const std::vector<std::string>& traces,
                                        const std::vector<std::string>& links) {
  std::vector<VoiceLine> lines;
  for (const std::string& file : traces) {
    LineWords words;
    words.traces = {file};
    DANCE_TRY(LossyLine line, load_line(words));
    lines.push_back({std::filesystem::path(file).filename().string(), std::move(line.up)});
  }
  for (const std::string& link : links) {
    LineWords words;
    words.link = link;
    DANCE_TRY(LossyLine line, load_line(words));
    lines.push_back({link, std::move(line.up)});
  }
  return lines;
}

double voice_percent(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

// Of all frames in percent: those that never came, nor did any of the `copies` packets after them,
// which could have brought a copy.
double gone_percent(const SentVoice& sent, const std::vector<VoiceArrival>& arrivals,
                    std::size_t copies) {
  std::vector<bool> came(sent.packets.size(), false);
  for (const VoiceArrival& arrival : arrivals) came[arrival.index] = true;
  std::size_t gone = 0;
  for (std::size_t i = 0; i < came.size(); ++i) {
    bool is_gone = !came[i];
    for (std::size_t k = 1; is_gone && k <= copies && i + k < came.size(); ++k)
      is_gone = !came[i + k];
    gone += is_gone ? 1 : 0;
  }
  return voice_percent(gone, came.size());
}

}  // namespace

Result<BenchReport> bench_voice_lines(const Speech& speech, const std::vector<std::string>& traces,
                                      const std::vector<std::string>& links) {
  DANCE_TRY(const auto lines, lines_of(traces, links));
  DANCE_TRY(const SentVoice sent, encode_voice(speech, {}));
  BenchReport report;
  report.text = fmt::format(
      "{:.0f} s of speech over each line. delay: from capture to played, of adaptive play-out;\n"
      "lost: never came; made up: concealed; recovered: from the next packet's copy;\n"
      "gone: never came, nor did the next packet, nor the next two, the next three, the next ten;\n"
      "fixed: made up with a buffer that plays at the same mean delay, and at 60, 100, 200 ms\n"
      "{:<40} {:>12} {:>6} {:>8} {:>10} {:>9} {:>24} {:>24}\n",
      static_cast<double>(speech.size()) / kVoiceRate_hz, "line", "delay / p95", "lost", "made up",
      "recovered", "stretched", "fixed same/60/100/200", "gone 1/2/3/10");
  for (const VoiceLine& line : lines) {
    LossyModel model(line.way, 0);
    const auto arrivals = voice_arrivals(sent, model);
    DANCE_TRY(const HeardVoice heard, play_voice(sent, arrivals));
    const VoicePlayout::Counters& counts = heard.counters;
    const double lost = voice_percent(model.counters().lost + model.counters().queue_dropped,
                                      model.counters().offered);
    const double made_up = voice_percent(counts.concealed, counts.played);
    const double recovered = voice_percent(counts.recovered, counts.played);
    const double stretched = voice_percent(counts.lengthened_samples + counts.shortened_samples,
                                           counts.played * kVoiceFrameSamples);
    std::vector<double> fixed{
        100.0 *
        missed_at_fixed_delay(sent, arrivals, Duration::seconds(heard.delay_mean_ms * 1e-3))};
    for (const Duration delay : kFixed)
      fixed.push_back(100.0 * missed_at_fixed_delay(sent, arrivals, delay));
    report.text += fmt::format(
        "{:<40} {:>5.0f} / {:<4.0f} {:>5.1f}% {:>7.2f}% {:>9.2f}% {:>8.1f}% {:>6.1f} {:>5.1f} "
        "{:>5.1f} {:>5.1f} % {:>6.2f} {:>5.2f} {:>5.2f} {:>5.2f} %\n",
        line.name, heard.delay_mean_ms, heard.delay_p95_ms, lost, made_up, recovered, stretched,
        fixed[0], fixed[1], fixed[2], fixed[3], gone_percent(sent, arrivals, 1),
        gone_percent(sent, arrivals, 2), gone_percent(sent, arrivals, 3),
        gone_percent(sent, arrivals, 10));
    report.json.push_back({{"line", line.name},
                           {"delay_mean_ms", rounded(heard.delay_mean_ms, 10.0)},
                           {"delay_p95_ms", rounded(heard.delay_p95_ms, 10.0)},
                           {"lost_percent", rounded(lost, 100.0)},
                           {"concealed_percent", rounded(made_up, 100.0)},
                           {"recovered_percent", rounded(recovered, 100.0)},
                           {"gone_1_percent", rounded(gone_percent(sent, arrivals, 1), 100.0)},
                           {"gone_2_percent", rounded(gone_percent(sent, arrivals, 2), 100.0)},
                           {"gone_3_percent", rounded(gone_percent(sent, arrivals, 3), 100.0)},
                           {"gone_10_percent", rounded(gone_percent(sent, arrivals, 10), 100.0)},
                           {"skipped_frames", counts.skipped},
                           {"late_packets", counts.late},
                           {"stretched_percent", rounded(stretched, 100.0)},
                           {"fixed_same_percent", rounded(fixed[0], 100.0)},
                           {"fixed_60ms_percent", rounded(fixed[1], 100.0)},
                           {"fixed_100ms_percent", rounded(fixed[2], 100.0)},
                           {"fixed_200ms_percent", rounded(fixed[3], 100.0)}});
  }
  return report;
}

}  // namespace dance
