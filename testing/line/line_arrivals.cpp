#include "testing/line/line_arrivals.h"

#include <algorithm>

namespace dance {
namespace {

void sort_by_arrival(std::vector<LineArrival>& arrivals) {
  std::sort(arrivals.begin(), arrivals.end(), [](const LineArrival& a, const LineArrival& b) {
    return a.at != b.at ? a.at < b.at : a.index < b.index;
  });
}

}  // namespace

std::vector<LineArrival> arrivals_over(LossyModel& line, std::size_t count,
                                       const std::function<MonoTime(std::size_t)>& sent_at,
                                       std::size_t every) {
  constexpr std::size_t kPose_bytes = 90;
  std::vector<LineArrival> arrivals;
  for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, every)) {
    const LossyModel::Fate fate = line.offer(kPose_bytes, sent_at(i));
    for (const MonoTime at : fate.deliveries()) arrivals.push_back({at, i});
  }
  sort_by_arrival(arrivals);
  return arrivals;
}

void stall(std::vector<LineArrival>& arrivals, MonoTime begin, Duration length) {
  for (LineArrival& arrival : arrivals)
    if (arrival.at >= begin) arrival.at = std::max(arrival.at, begin + length);
  sort_by_arrival(arrivals);
}

}  // namespace dance
