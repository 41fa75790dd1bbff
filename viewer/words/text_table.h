// All texts of the windows for dancers, one row each: its name, then English, Spanish and German.
// A `{}` is filled in, in order. Included by texts.h and texts.cpp alone.
//
// Ownership: constants.
// Threads:   any.
// Failure:   a row that lacks a language does not compile; one whose languages have different
//            places to fill fails a test.
#pragma once

#include "viewer/words/check_texts.h"
#include "viewer/words/dance_texts.h"
#include "viewer/words/headset_texts.h"
#include "viewer/words/lobby_texts.h"

// clang-format off
#define DANCE_TEXTS(ROW) \
  ROW(kLeave, "Leave", "Salir", "Verlassen") \
  ROW(kBack, "Back", "Volver", "Zurück") \
  DANCE_CHECK_TEXTS(ROW) \
  DANCE_PANEL_TEXTS(ROW) \
  DANCE_HEADSET_TEXTS(ROW) \
  DANCE_LOBBY_TEXTS(ROW)
// clang-format on
