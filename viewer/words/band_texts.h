// The texts of the house band and of roles, as rows of viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// The styles are in the order of lcmtypes/song_t.lcm.
// clang-format off
#define DANCE_BAND_TEXTS(ROW) \
  ROW(kBandSalsa, "Salsa", "Salsa", "Salsa") \
  ROW(kBandBachata, "Bachata", "Bachata", "Bachata") \
  ROW(kBandChaCha, "Cha-cha", "Chachachá", "Cha-Cha-Cha") \
  ROW(kBandMerengue, "Merengue", "Merengue", "Merengue") \
  ROW(kBandCumbia, "Cumbia", "Cumbia", "Cumbia") \
  ROW(kBandSwing, "Swing", "Swing", "Swing") \
  ROW(kBandTango, "Tango", "Tango", "Tango") \
  ROW(kBandWaltz, "Waltz", "Vals", "Walzer") \
  ROW(kBandLabel, "House band", "Banda de la casa", "Hausband") \
  ROW(kBandNone, "No band", "Sin banda", "Keine Band") \
  ROW(kBandTitle, "House band: {}", "Banda de la casa: {}", "Hausband: {}") \
  ROW(kBandNext, "Next song", "Siguiente canción", "Nächstes Lied") \
  ROW(kBandSlower, "Slower", "Más lento", "Langsamer") \
  ROW(kBandFaster, "Faster", "Más rápido", "Schneller") \
  ROW(kBandStop, "Stop", "Parar", "Anhalten") \
  ROW(kBandPlay, "Play", "Reproducir", "Abspielen") \
  ROW(kBandStyle, "Style: {}", "Estilo: {}", "Stil: {}") \
  ROW(kBandLock, "Lock the song", "Bloquear la canción", "Lied sperren") \
  ROW(kBandUnlock, "Unlock the song", "Desbloquear la canción", "Lied freigeben") \
  ROW(kBandLocked, \
      "The host has locked the song.", \
      "El anfitrión ha bloqueado la canción.", \
      "Der Gastgeber hat das Lied gesperrt.") \
  ROW(kRoleLead, "Lead", "Guiar", "Führen") \
  ROW(kRoleFollow, "Follow", "Seguir", "Folgen") \
  ROW(kRoleEither, "Either role", "Cualquier rol", "Beides")
// clang-format on
