// The texts for choosing a figure (lobby/screen/figure_card.cpp), as rows of
// viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_FIGURE_TEXTS(ROW) \
  ROW(kFigureStored, "one of yours", "una tuya", "eigene") \
  ROW(kFigureUnreadable, \
      "This file cannot be shown: the others see the default figure.", \
      "Este archivo no se puede mostrar: los demás ven la figura estándar.", \
      "Diese Datei lässt sich nicht zeigen: Die anderen sehen die Standardfigur.") \
  ROW(kFigureSeen, \
      "This is how the others see you.", \
      "Así te ven los demás.", \
      "So sehen dich die anderen.") \
  ROW(kFigureHeight, "Height", "Estatura", "Größe") \
  ROW(kFigureAsYou, "as tall as you", "tan alta como tú", "so groß wie du") \
  ROW(kFigureOfYours, "{} % of yours", "{} % de la tuya", "{} % deiner Größe") \
  ROW(kFigureLegs, "Clothes", "Ropa", "Kleidung") \
  ROW(kFigureTrousers, "Trousers", "Pantalón", "Hose") \
  ROW(kFigureFlared, "Flares", "Acampanado", "Schlaghose") \
  ROW(kFigureDress, "Dress", "Vestido", "Kleid") \
  ROW(kFigureSleeves, "Sleeves", "Mangas", "Ärmel") \
  ROW(kFigureNoSleeves, "None", "Sin mangas", "Keine") \
  ROW(kFigureShortSleeves, "Short", "Cortas", "Kurz") \
  ROW(kFigureLongSleeves, "Long", "Largas", "Lang") \
  ROW(kFigureHair, "Hair", "Pelo", "Haare") \
  ROW(kFigureShortHair, "Short", "Corto", "Kurz") \
  ROW(kFigureBob, "Bob", "Melena", "Bob") \
  ROW(kFigureBun, "Bun", "Moño", "Dutt") \
  ROW(kFigurePonytail, "Ponytail", "Coleta", "Pferdeschwanz") \
  ROW(kFigureHairColour, "Hair colour", "Color del pelo", "Haarfarbe") \
  ROW(kFigureSkin, "Skin", "Piel", "Haut") \
  ROW(kFigureColour, "Clothes colour", "Color de la ropa", "Kleiderfarbe") \
  ROW(kFigureSurprise, "Surprise me", "Sorpréndeme", "Überrasch mich")
// clang-format on
