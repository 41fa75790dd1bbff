// Texts of practice: steps on the beat, and the recorded teacher; as rows of
// viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_PRACTICE_TEXTS(ROW) \
  ROW(kDoPractice, \
      "practice: your steps on the beat", \
      "práctica: tus pasos a tiempo", \
      "Üben: deine Schritte im Takt") \
  ROW(kDoTeacherSpeed, \
      "the teacher slower, faster", \
      "el profe más lento, más rápido", \
      "Vortänzer langsamer, schneller") \
  ROW(kKeysPractice, "Practice", "Práctica", "Üben") \
  ROW(kLobbyDanceBeside, "Dance beside it", "Bailar al lado", "Daneben tanzen") \
  ROW(kLobbyTeacher, "Teacher beside you", "Profe a tu lado", "Vortänzer neben dir") \
  ROW(kNameTeacher, "teacher", "profe", "Vortänzer") \
  ROW(kPracticeNoMusic, \
      "No music yet: your steps are counted against its beat.", \
      "Aún no hay música: tus pasos se comparan con su pulso.", \
      "Noch keine Musik: Deine Schritte werden an ihr gemessen.") \
  ROW(kPracticeNoSteps, "Dance: your steps are counted.", "Baila: se cuentan tus pasos.", \
      "Tanz los: Deine Schritte werden gezählt.") \
  ROW(kPracticeOnTheBeat, "On the beat: {} of {}", "A tiempo: {} de {}", "Im Takt: {} von {}") \
  ROW(kPracticeEarly, \
      "Steps come {} ms early", \
      "Los pasos llegan {} ms antes", \
      "Schritte kommen {} ms zu früh") \
  ROW(kPracticeLate, \
      "Steps come {} ms late", \
      "Los pasos llegan {} ms tarde", \
      "Schritte kommen {} ms zu spät") \
  ROW(kTeacherMirror, "Mirrored", "En espejo", "Gespiegelt") \
  ROW(kTeacherOver, "In my place", "En mi sitio", "An meiner Stelle")
// clang-format on
