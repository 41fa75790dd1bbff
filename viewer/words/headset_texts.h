// The texts of the panel at a wrist (headset/panel/), as rows of viewer/words/text_table.h.
//
// Units/frames: none.
// Ownership:    constants.
// Threads:      any.
// Failure:      as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_HEADSET_TEXTS(ROW) \
  ROW(kHeadsetCalibrate, "Calibrate", "Calibrar", "Kalibrieren") \
  ROW(kHeadsetHoldToLeave, "Leave (hold)", "Salir (mantener)", "Verlassen (halten)") \
  ROW(kHeadsetMute, "Mute", "Silenciar", "Stumm") \
  ROW(kHeadsetNoVoice, "No voice", "Sin voz", "Keine Stimme") \
  ROW(kHeadsetPoints, "{} tracked", "{} con seguimiento", "{} verfolgt") \
  ROW(kHeadsetRecentre, "Recentre", "Recentrar", "Zentrieren") \
  ROW(kHeadsetTPose, \
      "Stand upright, arms to the sides, and hold still.", \
      "Ponte derecho, brazos en cruz, y no te muevas.", \
      "Steh aufrecht, Arme zur Seite, und halte still.") \
  ROW(kHeadsetTPoseSoon, \
      "For a better body: stand in a T once.", \
      "Para un cuerpo mejor: ponte una vez en cruz.", \
      "Für einen besseren Körper: steh einmal als T da.") \
  ROW(kHeadsetUnmute, "Unmute", "Activar voz", "Laut")
// clang-format on
