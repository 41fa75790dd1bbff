// The figures of the salsa couple as tables: what one dancer does on each count of an eight.
//
// Units/frames: metres and degrees in the dancer's own frame at the begin of the eight: +Z towards
// the partner, +X to the own left; the foot's offset is from where it stands under the body, along
// the body's own direction on that count.
// Threads:      constants only.
// Failure:      none.
// Source:       the figures are common salsa vocabulary, danced "on 1"; the numbers are our own.
#pragma once

#include <array>

namespace dance::salsa {

struct Row {
  double body_x_m, body_z_m, body_yaw_deg;
  double foot_x_m, foot_z_m;
};
using Figure = std::array<Row, 8>;

// Half the distance between the feet when they stand side by side.
constexpr double kHalfStance_m = 0.085;
// The ball of a foot that one stands on is ahead of the hips by this.
constexpr double kBallAhead_m = 0.105;

// The rows are the lead's; the follow dances the same rows four counts later, which mirrors them.
constexpr Figure kForwardAndBack{{{0.0, 0.075, 0.0, 0.0, 0.165},
                                  {0.0, 0.035, 0.0, 0.0, -0.035},
                                  {0.0, 0.0, 0.0, 0.0, 0.0},
                                  {0.0, -0.005, 0.0, 0.0, 0.0},
                                  {0.0, -0.075, 0.0, 0.0, -0.165},
                                  {0.0, -0.035, 0.0, 0.0, 0.035},
                                  {0.0, 0.0, 0.0, 0.0, 0.0},
                                  {0.0, 0.005, 0.0, 0.0, 0.0}}};
constexpr Figure kSideAndSide{{{0.115, 0.0, 0.0, 0.150, -0.01},
                               {0.030, 0.0, 0.0, -0.030, 0.0},
                               {0.0, 0.0, 0.0, 0.0, 0.0},
                               {-0.005, 0.0, 0.0, 0.0, 0.0},
                               {-0.115, 0.0, 0.0, -0.150, -0.01},
                               {-0.030, 0.0, 0.0, 0.030, 0.0},
                               {0.0, 0.0, 0.0, 0.0, 0.0},
                               {0.005, 0.0, 0.0, 0.0, 0.0}}};
constexpr Figure kBackAndBack{{{0.0, -0.095, 6.0, 0.0, -0.165},
                               {0.0, -0.045, 2.0, 0.0, 0.045},
                               {0.0, 0.0, 0.0, 0.0, 0.0},
                               {0.0, 0.005, 0.0, 0.0, 0.0},
                               {0.0, -0.095, -6.0, 0.0, -0.165},
                               {0.0, -0.045, -2.0, 0.0, 0.045},
                               {0.0, 0.0, 0.0, 0.0, 0.0},
                               {0.0, 0.005, 0.0, 0.0, 0.0}}};

// The couple's places change; kCrossSpacing_m is how far apart they stand before and after.
constexpr double kCrossSpacing_m = 0.66;
constexpr Figure kCrossLead{{{0.0, 0.060, 0.0, 0.0, 0.140},
                             {-0.110, 0.015, 20.0, 0.0, -0.010},
                             {-0.270, 0.160, 75.0, 0.0, 0.0},
                             {-0.285, 0.240, 88.0, 0.0, 0.0},
                             {-0.290, 0.340, 102.0, 0.0, -0.030},
                             {-0.190, 0.540, 140.0, 0.0, 0.040},
                             {-0.030, 0.635, 172.0, 0.0, 0.0},
                             {0.0, 0.655, 180.0, 0.0, 0.0}}};
constexpr Figure kCrossFollow{{{0.0, -0.070, 0.0, 0.0, -0.150},
                               {0.0, -0.030, 0.0, 0.0, 0.030},
                               {-0.070, 0.070, 0.0, 0.0, 0.030},
                               {-0.150, 0.140, 0.0, 0.0, 0.0},
                               {-0.290, 0.290, 5.0, 0.0, 0.090},
                               {-0.300, 0.490, 45.0, 0.0, 0.060},
                               {-0.110, 0.640, 135.0, 0.0, 0.0},
                               {-0.010, 0.665, 178.0, 0.0, 0.0}}};

// She turns to her right; he marks his steps under the raised hand.
constexpr double kTurnSpacing_m = 0.66;
constexpr Figure kTurnLead{{{0.0, 0.060, 0.0, 0.0, 0.130},
                            {0.0, 0.030, 0.0, 0.0, -0.030},
                            {0.0, 0.0, 0.0, 0.0, 0.0},
                            {0.0, 0.0, 0.0, 0.0, 0.0},
                            {0.0, -0.030, -4.0, 0.0, -0.100},
                            {0.0, -0.015, -2.0, 0.0, 0.015},
                            {0.0, 0.0, 0.0, 0.0, 0.0},
                            {0.0, 0.0, 0.0, 0.0, 0.0}}};
constexpr Figure kTurnFollow{{{0.0, -0.060, 0.0, 0.0, -0.130},
                              {0.0, -0.030, 0.0, 0.0, 0.030},
                              {0.0, 0.0, 6.0, 0.0, 0.0},
                              {0.0, 0.010, 4.0, 0.0, 0.0},
                              {-0.030, 0.030, -95.0, 0.0, 0.030},
                              {-0.020, 0.010, -215.0, 0.0, 0.020},
                              {0.0, 0.0, -325.0, 0.0, 0.0},
                              {0.0, 0.0, -358.0, 0.0, 0.0}}};

}  // namespace dance::salsa
