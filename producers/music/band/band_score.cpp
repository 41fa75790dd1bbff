#include "producers/music/band/band_score.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/base/assert.h"
#include "producers/music/band/compose/band_writer.h"

namespace dance {
namespace {

// Positions between frames have 16 binary digits.
constexpr std::int64_t kFrame = std::int64_t{1} << 16;

std::int64_t on_block(std::int64_t position) {
  constexpr std::int64_t kBlock = kBandBlock_frames * kFrame;
  return (position + kBlock / 2) / kBlock * kBandBlock_frames;
}

// The frames at which bars begin and ticks lie.
class Ruler {
 public:
  Ruler(const BandSong& song, int bars, int bar_beats) : bar_ticks_(bar_beats * kBeat_ticks) {
    std::int64_t position = 0;
    std::size_t tempo = 0;
    for (int bar = 0; bar < bars; ++bar) {
      begins_.push_back(position);
      while (tempo + 1 < song.tempi.size() && song.tempi[tempo + 1].bar <= bar) ++tempo;
      position += bar_beats * (std::int64_t{60} * 100 * kBandRate_hz) * kFrame /
                  song.tempi[tempo].centi_bpm;
    }
    begins_.push_back(position);
  }

  std::vector<std::int64_t> bar_begins() const {
    std::vector<std::int64_t> frames;
    for (const std::int64_t begin : begins_) frames.push_back(on_block(begin));
    return frames;
  }
  std::int64_t frame_of(int tick) const {
    const auto bar = static_cast<std::size_t>(tick / bar_ticks_);
    if (bar + 1 >= begins_.size()) return on_block(begins_.back());
    const std::int64_t length = begins_[bar + 1] - begins_[bar];
    return on_block(begins_[bar] + length * (tick % bar_ticks_) / bar_ticks_);
  }

 private:
  int bar_ticks_;
  std::vector<std::int64_t> begins_;
};

BeatGrid grid_of(const Ruler& ruler, int bars, int bar_beats) {
  std::vector<GridBeat> beats;
  for (int beat = 0; beat < bars * bar_beats; ++beat)
    beats.push_back({static_cast<double>(ruler.frame_of(beat * kBeat_ticks)) / kBandRate_hz,
                     beat % bar_beats + 1});
  auto grid = BeatGrid::make(beats);
  DANCE_ASSERT(grid, bars, bar_beats);
  return *std::move(grid);
}

std::vector<BandSection> empty_sections(std::span<const BandPart> form,
                                        std::span<const std::int64_t> bar_begins) {
  std::vector<BandSection> sections;
  for (const BandPart& part : form)
    for (int bar = 0; bar < part.bars; bar += BandScore::kSection_bars) {
      BandSection section;
      section.first_bar = part.first_bar + bar;
      section.bars = std::min(BandScore::kSection_bars, part.bars - bar);
      section.part = part.kind;
      section.begin_frame = bar_begins[static_cast<std::size_t>(section.first_bar)];
      section.end_frame = bar_begins[static_cast<std::size_t>(section.first_bar + section.bars)];
      sections.push_back(std::move(section));
    }
  return sections;
}

// A key that is struck again ends before that; of two strokes at once the louder one counts.
void end_before_next(std::vector<BandNote>& notes) {
  std::sort(notes.begin(), notes.end(), [](const BandNote& a, const BandNote& b) {
    return std::tuple(a.begin_frame, a.voice, a.key, -a.velocity) <
           std::tuple(b.begin_frame, b.voice, b.key, -b.velocity);
  });
  const auto same = [](const BandNote& a, const BandNote& b) {
    return std::tuple(a.begin_frame, a.voice, a.key) == std::tuple(b.begin_frame, b.voice, b.key);
  };
  notes.erase(std::unique(notes.begin(), notes.end(), same), notes.end());
  std::map<std::pair<BandVoice, int>, BandNote*> latest;
  for (BandNote& note : notes) {
    BandNote*& before = latest[{note.voice, note.key}];
    if (before != nullptr) before->end_frame = std::min(before->end_frame, note.begin_frame);
    before = &note;
  }
}

}  // namespace

BandScore::BandScore(const BandSong& song, BeatGrid grid) : song_(song), grid_(std::move(grid)) {}

BandScore BandScore::make(const BandSong& song) {
  DANCE_ASSERT(is_valid(song), static_cast<int>(song.style), song.tempi.size());
  BandWriter writer(song.style, song.seed);
  const int bars = writer.bars();
  const Ruler ruler(song, bars, writer.bar_beats());
  BandScore score(song, grid_of(ruler, bars, writer.bar_beats()));
  score.bar_begins_ = ruler.bar_begins();
  score.sections_ = empty_sections(writer.form(), score.bar_begins_);
  for (const BandSheetNote& written : compose(writer)) {
    const std::int64_t begin = ruler.frame_of(written.tick);
    BandSection& section = score.sections_[score.section_at(begin)];
    const std::int64_t end =
        std::max(ruler.frame_of(written.tick + written.length_ticks), begin + kBandBlock_frames);
    if (begin >= section.end_frame) continue;
    section.notes.push_back({begin, std::min(end, section.end_frame), written.voice,
                             static_cast<std::uint8_t>(written.key),
                             static_cast<std::uint8_t>(written.velocity)});
  }
  for (BandSection& section : score.sections_) end_before_next(section.notes);
  return score;
}

std::vector<std::int64_t> BandScore::bar_begins(const BandSong& song) {
  const BandPart last = band_form(song.style, song.seed).back();
  return Ruler(song, last.first_bar + last.bars, beats_per_bar(song.style)).bar_begins();
}

std::int64_t BandScore::bar_begin_frame(int bar) const {
  DANCE_ASSERT(bar >= 0 && bar <= bars(), bar, bars());
  return bar_begins_[static_cast<std::size_t>(bar)];
}

int BandScore::bar_at(std::int64_t frame) const {
  const auto after = std::upper_bound(bar_begins_.begin(), bar_begins_.end(), frame);
  return std::clamp(static_cast<int>(after - bar_begins_.begin()) - 1, 0, bars() - 1);
}

std::size_t BandScore::section_at(std::int64_t frame) const {
  const auto after = std::upper_bound(
      sections_.begin(), sections_.end(), frame,
      [](std::int64_t at, const BandSection& section) { return at < section.begin_frame; });
  return after == sections_.begin() ? 0 : static_cast<std::size_t>(after - sections_.begin()) - 1;
}

}  // namespace dance
