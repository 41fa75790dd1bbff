// A plot of one or two figures of one guest over the last minute.
//
// Units/frames: pixels from the top left; the newest second is at the right.
// Ownership:    borrows.
// Threads:      the drawing thread.
// Failure:      seconds whose figure is not known are gaps in the line.
#pragma once

#include "viewer/instruments/instrument_records.h"
#include "viewer/instruments/latency_bar.h"

namespace dance {

struct MinutePlot {
  const char* title;
  const char* format;  // of the newest values: "%.1f ms"
  float (*figure)(const GuestStats&);
  float (*second)(const GuestStats&) = nullptr;  // thinner
  const char* second_words = "";
  float least_range = 10.0f;  // of the axis
  bool is_signed = false;     // 0 is in the middle
};

void draw_minute_plot(const PanelInk& ink, const MinutePlot& plot, const GuestRecord& record,
                      const BarBox& box);

}  // namespace dance
