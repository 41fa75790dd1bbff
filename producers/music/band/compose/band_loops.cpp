#include "producers/music/band/compose/band_loops.h"

#include <array>

namespace dance {
namespace {

using enum BandChordKind;

constexpr BandLoopChord kNone{0, BandChordKind::kMajor, 0};

// i iv V7 i, and its like.
constexpr std::array kLatinVerse{
    BandLoop{true,
             {{{0, kMinor}, {5, kMinor}, {7, kSeventh}, {0, kMinor}, kNone, kNone, kNone, kNone}}},
    BandLoop{true,
             {{{0, kMinor},
               {10, kSeventh},
               {8, kMajorSeventh},
               {7, kSeventh},
               kNone,
               kNone,
               kNone,
               kNone}}},
    BandLoop{true,
             {{{0, kMinor},
               {5, kMinorSeventh},
               {10, kSeventh},
               {3, kMajorSeventh},
               {8, kMajorSeventh},
               {2, kHalfDiminished},
               {7, kSeventh},
               {0, kMinor}}}},
    BandLoop{false,
             {{{0, kSixth},
               {9, kMinorSeventh},
               {2, kMinorSeventh},
               {7, kSeventh},
               {0, kSixth},
               {9, kSeventh},
               {2, kMinorSeventh},
               {7, kSeventh}}}}};
constexpr std::array kLatinChorus{
    BandLoop{true,
             {{{0, kMinor}, {5, kMinor}, {7, kSeventh}, {5, kMinor}, kNone, kNone, kNone, kNone}}},
    BandLoop{
        true,
        {{{0, kMinor}, {7, kSeventh}, {7, kSeventh}, {0, kMinor}, kNone, kNone, kNone, kNone}}},
    BandLoop{false,
             {{{0, kMajor}, {5, kMajor}, {7, kSeventh}, {5, kMajor}, kNone, kNone, kNone, kNone}}},
    BandLoop{false,
             {{{0, kSixth},
               {2, kMinorSeventh},
               {7, kSeventh},
               {0, kSixth},
               kNone,
               kNone,
               kNone,
               kNone}}}};
constexpr std::array kBachataVerse{
    BandLoop{true,
             {{{0, kMinor}, {10, kMajor}, {8, kMajor}, {7, kSeventh}, kNone, kNone, kNone, kNone}}},
    BandLoop{true,
             {{{0, kMinor}, {8, kMajor}, {3, kMajor}, {10, kMajor}, kNone, kNone, kNone, kNone}}},
    BandLoop{true,
             {{{5, kMinor}, {0, kMinor}, {7, kSeventh}, {0, kMinor}, kNone, kNone, kNone, kNone}}},
    BandLoop{false,
             {{{0, kMajor}, {9, kMinor}, {5, kMajor}, {7, kSeventh}, kNone, kNone, kNone, kNone}}}};
constexpr std::array kMerengueVerse{
    BandLoop{true,
             {{{0, kMinor},
               {0, kMinor},
               {7, kSeventh},
               {7, kSeventh},
               {7, kSeventh},
               {7, kSeventh},
               {0, kMinor},
               {0, kMinor}}}},
    BandLoop{true,
             {{{0, kMinor},
               {5, kMinor},
               {10, kMajor},
               {3, kMajor},
               {8, kMajor},
               {5, kMinor},
               {7, kSeventh},
               {0, kMinor}}}},
    BandLoop{false,
             {{{0, kMajor}, {0, kMajor}, {5, kMajor}, {7, kSeventh}, kNone, kNone, kNone, kNone}}}};
constexpr std::array kMerengueChorus{
    BandLoop{true, {{{0, kMinor}, {7, kSeventh}, kNone, kNone, kNone, kNone, kNone, kNone}}},
    BandLoop{
        false,
        {{{0, kMajor}, {7, kSeventh}, {7, kSeventh}, {0, kMajor}, kNone, kNone, kNone, kNone}}},
    BandLoop{
        true,
        {{{0, kMinor}, {10, kMajor}, {8, kMajor}, {7, kSeventh}, kNone, kNone, kNone, kNone}}}};
constexpr std::array kSwingVerse{BandLoop{false,
                                          {{{0, kSixth},
                                            {9, kSeventh},
                                            {2, kMinorSeventh},
                                            {7, kSeventh},
                                            {4, kMinorSeventh},
                                            {9, kSeventh},
                                            {2, kMinorSeventh},
                                            {7, kSeventh}}}},
                                 BandLoop{false,
                                          {{{0, kMajorSeventh},
                                            {5, kSeventh},
                                            {4, kMinorSeventh},
                                            {9, kSeventh},
                                            {2, kSeventh},
                                            {7, kSeventh},
                                            {0, kSixth},
                                            {7, kSeventh}}}},
                                 BandLoop{true,
                                          {{{0, kMinorSixth},
                                            {8, kSeventh},
                                            {2, kHalfDiminished},
                                            {7, kSeventh},
                                            {0, kMinorSixth},
                                            {5, kMinorSeventh},
                                            {7, kSeventh},
                                            {0, kMinorSixth}}}}};
constexpr std::array kSwingChorus{BandLoop{false,
                                           {{{0, kSixth},
                                             {0, kSeventh},
                                             {5, kSixth},
                                             {6, kDiminished},
                                             {0, kSixth},
                                             {9, kSeventh},
                                             {2, kSeventh},
                                             {7, kSeventh}}}},
                                  BandLoop{false,
                                           {{{4, kSeventh},
                                             {4, kSeventh},
                                             {9, kSeventh},
                                             {9, kSeventh},
                                             {2, kSeventh},
                                             {2, kSeventh},
                                             {7, kSeventh},
                                             {7, kSeventh}}}},
                                  BandLoop{true,
                                           {{{0, kMinorSixth},
                                             {5, kMinorSixth},
                                             {0, kMinorSixth},
                                             {0, kMinorSixth},
                                             {5, kMinorSixth},
                                             {0, kMinorSixth},
                                             {8, kSeventh},
                                             {7, kSeventh}}}}};
constexpr std::array kTangoVerse{BandLoop{true,
                                          {{{0, kMinor},
                                            {0, kMinor},
                                            {7, kSeventh},
                                            {7, kSeventh},
                                            {7, kSeventh},
                                            {7, kSeventh},
                                            {0, kMinor},
                                            {0, kMinor}}}},
                                 BandLoop{true,
                                          {{{0, kMinor},
                                            {5, kMinorSixth},
                                            {7, kSeventh},
                                            {0, kMinor},
                                            {8, kMajor},
                                            {5, kMinor},
                                            {7, kSeventh},
                                            {0, kMinor}}}},
                                 BandLoop{true,
                                          {{{0, kMinor},
                                            {0, kSeventh},
                                            {5, kMinor},
                                            {5, kMinorSixth},
                                            {0, kMinor},
                                            {2, kHalfDiminished},
                                            {7, kSeventh},
                                            {0, kMinor}}}}};
constexpr std::array kTangoChorus{BandLoop{false,
                                           {{{0, kMajor},
                                             {0, kDiminished},
                                             {2, kMinorSeventh},
                                             {7, kSeventh},
                                             {2, kMinorSeventh},
                                             {7, kSeventh},
                                             {0, kMajor},
                                             {7, kSeventh}}}},
                                  BandLoop{true,
                                           {{{8, kMajor},
                                             {3, kMajor},
                                             {10, kSeventh},
                                             {3, kMajor},
                                             {5, kMinor},
                                             {0, kMinor},
                                             {7, kSeventh},
                                             {0, kMinor}}}}};
constexpr std::array kWaltzVerse{BandLoop{false,
                                          {{{0, kMajor},
                                            {0, kMajor},
                                            {2, kMinorSeventh},
                                            {7, kSeventh},
                                            {2, kMinorSeventh},
                                            {7, kSeventh},
                                            {0, kMajor},
                                            {0, kMajor}}}},
                                 BandLoop{false,
                                          {{{0, kMajor},
                                            {9, kMinor},
                                            {5, kMajor},
                                            {7, kSeventh},
                                            {4, kMinor},
                                            {9, kMinor},
                                            {2, kMinorSeventh},
                                            {7, kSeventh}}}},
                                 BandLoop{true,
                                          {{{0, kMinor},
                                            {5, kMinor},
                                            {10, kSeventh},
                                            {3, kMajor},
                                            {8, kMajor},
                                            {2, kHalfDiminished},
                                            {7, kSeventh},
                                            {0, kMinor}}}}};
constexpr std::array kWaltzChorus{BandLoop{false,
                                           {{{5, kMajor},
                                             {5, kMajor},
                                             {0, kMajor},
                                             {0, kMajor},
                                             {2, kSeventh},
                                             {7, kSeventh},
                                             {0, kMajor},
                                             {0, kMajor}}}},
                                  BandLoop{true,
                                           {{{3, kMajor},
                                             {10, kSeventh},
                                             {0, kMinor},
                                             {0, kMinor},
                                             {5, kMinor},
                                             {0, kMinor},
                                             {7, kSeventh},
                                             {0, kMinor}}}}};

}  // namespace

BandLoops loops_of(BandStyle style) {
  switch (style) {
    case BandStyle::kSalsa:
    case BandStyle::kChaCha:
      return {kLatinVerse, kLatinChorus};
    case BandStyle::kBachata:
      return {kBachataVerse, kBachataVerse};
    case BandStyle::kMerengue:
      return {kMerengueVerse, kMerengueChorus};
    case BandStyle::kCumbia:
      return {kMerengueChorus, kMerengueChorus};
    case BandStyle::kSwing:
      return {kSwingVerse, kSwingChorus};
    case BandStyle::kTango:
      return {kTangoVerse, kTangoChorus};
    case BandStyle::kWaltz:
      return {kWaltzVerse, kWaltzChorus};
  }
  return {kLatinVerse, kLatinChorus};
}

}  // namespace dance
