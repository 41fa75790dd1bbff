// All texts of the windows for dancers, one row each: its name, then English, Spanish and German.
// A `{}` is filled in, in order. Included by texts.h and texts.cpp alone.
//
// Ownership: constants.
// Threads:   any.
// Failure:   a row that lacks a language does not compile; one whose languages have different
//            places to fill fails a test.
#pragma once

// clang-format off
#define DANCE_TEXTS(ROW) \
  ROW(kLeave, "Leave", "Salir", "Verlassen") \
  ROW(kBack, "Back", "Volver", "Zurück")
// clang-format on
