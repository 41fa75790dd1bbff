#include "viewer/instruments/instrument_records.h"

#include <algorithm>

namespace dance {

const GuestRecord* InstrumentRecords::find(const GuestId& guest) const {
  const auto at = std::find_if(guests_.begin(), guests_.end(),
                               [&](const GuestRecord& record) { return record.guest() == guest; });
  return at == guests_.end() ? nullptr : &*at;
}

GuestRecord* InstrumentRecords::record_of(const GuestId& guest) {
  const auto at = std::lower_bound(
      guests_.begin(), guests_.end(), guest,
      [](const GuestRecord& record, const GuestId& id) { return record.guest() < id; });
  if (at != guests_.end() && at->guest() == guest) return &*at;
  if (guests_.size() == kMost) return nullptr;
  return &*guests_.insert(at, GuestRecord(guest));
}

void InstrumentRecords::take(InstrumentBoard& board) {
  MonoTime newest;
  while (const auto news = board.take_figures()) {
    newest = news->what.time;
    GuestRecord* record = record_of(news->guest);
    if (record == nullptr) continue;
    // A recording that was sought in, or repeats.
    if (record->size() > 0 && news->what.time < record->newest().time) record->clear();
    record->add(news->what);
    // A manager that has ended says nothing any more.
    if (record->playout && news->what.time - record->playout->time > kPlayoutForgotten)
      record->playout.reset();
  }
  while (const auto news = board.take_flow())
    if (GuestRecord* record = record_of(news->guest)) record->flow = news->what;
  while (const auto news = board.take_playout())
    if (GuestRecord* record = record_of(news->guest)) record->playout = news->what;
  if (!newest.is_set()) return;
  std::erase_if(guests_, [&](const GuestRecord& record) {
    return record.size() > 0 && newest - record.newest().time > kForgotten;
  });
}

}  // namespace dance
