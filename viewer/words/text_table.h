// All texts of the windows for dancers, one row each: its name, then English, Spanish and German.
// A `{}` is filled in, in order. Included by texts.h and texts.cpp alone.
//
// Ownership: constants.
// Threads:   any.
// Failure:   a row that lacks a language does not compile; one whose languages have different
//            places to fill fails a test.
#pragma once

#include "viewer/words/band_texts.h"
#include "viewer/words/chat_texts.h"
#include "viewer/words/check_texts.h"
#include "viewer/words/dance_texts.h"
#include "viewer/words/figure_texts.h"
#include "viewer/words/headset_texts.h"
#include "viewer/words/invite_texts.h"
#include "viewer/words/key_texts.h"
#include "viewer/words/lobby_texts.h"
#include "viewer/words/own_texts.h"
#include "viewer/words/practice_texts.h"
#include "viewer/words/shelf_texts.h"

// clang-format off
#define DANCE_TEXTS(ROW) \
  ROW(kLeave, "Leave", "Salir", "Verlassen") \
  ROW(kNameDancer, "dancer", "bailarín", "Tänzer") \
  ROW(kNamePartner, "partner", "pareja", "Partner") \
  ROW(kBack, "Back", "Volver", "Zurück") \
  DANCE_BAND_TEXTS(ROW) \
  DANCE_CHAT_TEXTS(ROW) \
  DANCE_CHECK_TEXTS(ROW) \
  DANCE_PANEL_TEXTS(ROW) \
  DANCE_FIGURE_TEXTS(ROW) \
  DANCE_HEADSET_TEXTS(ROW) \
  DANCE_INVITE_TEXTS(ROW) \
  DANCE_KEY_TEXTS(ROW) \
  DANCE_LOBBY_TEXTS(ROW) \
  DANCE_OWN_TEXTS(ROW) \
  DANCE_PRACTICE_TEXTS(ROW) \
  DANCE_SHELF_TEXTS(ROW)
// clang-format on
