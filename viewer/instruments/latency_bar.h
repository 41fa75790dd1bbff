// The stages of a pose's way as a bar, side by side in their order and colours, on one scale for
// all guests.
//
// Units/frames: pixels from the top left; ms.
// Ownership:    borrows.
// Threads:      the drawing thread.
// Failure:      stages that are not known are left out.
#pragma once

#include "core/bus/messages.h"
#include "viewer/instruments/panel_ink.h"

namespace dance {

struct BarBox {
  float left, top, right, bottom;
};

// The end of the scale that has room for `longest_ms`.
float bar_scale_ms(float longest_ms);
void draw_latency_bar(const PanelInk& ink, const GuestStats& stats, const BarBox& box,
                      float scale_ms);
// Ticks with their ms, over the bars.
void draw_bar_ticks(const PanelInk& ink, const BarBox& box, float scale_ms);
// Each stage of one guest with its p50 and p99, in two columns.
void draw_gap_table(const PanelInk& ink, const GuestStats& stats, const BarBox& box);
// What colour means what. Returns the height that it took.
float draw_bar_legend(const PanelInk& ink, float left, float top, float right);

}  // namespace dance
