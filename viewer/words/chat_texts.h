// Texts of the chat, as rows of viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_CHAT_TEXTS(ROW) \
  ROW(kChatHint, \
      "To everybody in the room. Enter sends, Esc closes.", \
      "Para toda la sala. Intro envía, Esc cierra.", \
      "An alle im Raum. Eingabe sendet, Esc schließt.") \
  ROW(kChatNobody, \
      "You are only watching: you can write once you dance.", \
      "Solo estás mirando: podrás escribir cuando bailes.", \
      "Du schaust nur zu: Schreiben kannst du, sobald du tanzt.") \
  ROW(kDoApplaud, "applaud", "aplaudir", "applaudieren") \
  ROW(kDoHeart, "show a heart", "mostrar un corazón", "ein Herz zeigen") \
  ROW(kDoWrite, "write to the room", "escribir a la sala", "an alle im Raum schreiben") \
  ROW(kKeysChat, "Chat", "Chat", "Chat")
// clang-format on
