// The texts of an invitation for people (lobby/invite), as rows of viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_INVITE_TEXTS(ROW) \
  ROW(kPageTitle, \
      "{} invites you to dance", \
      "{} te invita a bailar", \
      "{} lädt dich zum Tanzen ein") \
  ROW(kPageFor, \
      "For {}, in the room {}", \
      "Para {}, en la sala {}", \
      "Für {}, im Raum {}") \
  ROW(kPageHow, \
      "Open this link on a computer with DanceGraph:", \
      "Abre este enlace en un ordenador con DanceGraph:", \
      "Öffne diesen Link auf einem Rechner mit DanceGraph:") \
  ROW(kPageHowElse, \
      "If a click does nothing: copy the link, open the page {} in DanceGraph and press {}.", \
      "Si al hacer clic no pasa nada: copia el enlace, abre la página {} en DanceGraph y pulsa " \
      "{}.", \
      "Wenn beim Klick nichts passiert: Kopiere den Link, öffne in DanceGraph die Seite {} und " \
      "klicke auf {}.") \
  ROW(kPageThisComputer, \
      "It only works on the computer of {}.", \
      "Solo funciona en el ordenador de {}.", \
      "Der Link funktioniert nur auf dem Rechner von {}.") \
  ROW(kPageHome, \
      "It only works in the home network of {}.", \
      "Solo funciona en la red de casa de {}.", \
      "Der Link funktioniert nur im Heimnetz von {}.") \
  ROW(kPageEverywhere, \
      "It works from anywhere while {} has the room open.", \
      "Funciona desde cualquier lugar mientras {} tenga la sala abierta.", \
      "Der Link funktioniert von überall, solange {} den Raum geöffnet hat.") \
  ROW(kPageUntil, "It is valid until {}.", "Es válido hasta el {}.", "Er ist gültig bis {}.") \
  ROW(kPageOnce, \
      "It can be used once and is only for you: please do not pass it on.", \
      "Sirve una sola vez y es solo para ti: no se lo pases a nadie.", \
      "Er gilt nur einmal und nur für dich: Bitte gib ihn nicht weiter.") \
  ROW(kPageCode, \
      "The code holds the same link. A phone can read it, but you need a computer to dance.", \
      "El código contiene el mismo enlace. Un móvil puede leerlo, pero para bailar hace " \
      "falta un ordenador.", \
      "Der Code enthält denselben Link. Ein Handy kann ihn lesen, zum Tanzen brauchst du aber " \
      "einen Rechner.") \
  ROW(kInviteHome, \
      "This link only works in your home network. For friends elsewhere, enter your internet " \
      "address above and make a new invitation.", \
      "Este enlace solo funciona en tu red de casa. Para amigos de fuera, escribe arriba tu " \
      "dirección de internet y crea otra invitación.", \
      "Dieser Link funktioniert nur in deinem Heimnetz. Für Freunde von außerhalb trage oben " \
      "deine Internetadresse ein und erstelle eine neue Einladung.") \
  ROW(kInviteEverywhere, \
      "This link works from anywhere if your router forwards UDP port {} to this computer.", \
      "Este enlace funciona desde cualquier lugar si tu router redirige el puerto UDP {} a " \
      "este ordenador.", \
      "Dieser Link funktioniert von überall, wenn dein Router den UDP-Port {} an diesen " \
      "Rechner weiterleitet.") \
  ROW(kRouterAsk, \
      "Ask my router to let guests in", \
      "Abrir mi router a los invitados", \
      "Router für Gäste öffnen") \
  ROW(kRouterAsking, "Asking the router…", "Consultando el router…", "Router wird angefragt…") \
  ROW(kRouterOpen, \
      "Your router lets guests in at your internet address {}. New invitations work from " \
      "anywhere.", \
      "Tu router deja entrar a los invitados por tu dirección de internet {}. Las invitaciones " \
      "nuevas funcionan desde cualquier lugar.", \
      "Dein Router lässt Gäste unter deiner Internetadresse {} herein. Neue Einladungen " \
      "funktionieren von überall.") \
  ROW(kRouterBehind, \
      "Your router has no internet address of its own ({}), so guests from elsewhere cannot " \
      "reach it. Your provider can give it one.", \
      "Tu router no tiene dirección de internet propia ({}), así que los invitados de fuera no " \
      "pueden llegar a él. Tu proveedor puede asignarle una.", \
      "Dein Router hat keine eigene Internetadresse ({}) und ist von außen nicht erreichbar. " \
      "Dein Anbieter kann ihm eine zuweisen.") \
  ROW(kRouterRefused, \
      "Your router refused. Turn on NAT-PMP in its settings, or forward the port there " \
      "yourself.", \
      "Tu router lo ha rechazado. Activa NAT-PMP en su configuración o redirige allí el puerto " \
      "tú mismo.", \
      "Dein Router hat abgelehnt. Schalte in seinen Einstellungen NAT-PMP ein oder leite den " \
      "Port dort selbst weiter.") \
  ROW(kRouterSilent, \
      "Your router did not answer. Forward the port in its settings yourself.", \
      "Tu router no ha respondido. Redirige tú mismo el puerto en su configuración.", \
      "Dein Router hat nicht geantwortet. Leite den Port in seinen Einstellungen selbst weiter.") \
  ROW(kInviteCopyMessage, "Copy as a message", "Copiar como mensaje", "Als Nachricht kopieren") \
  ROW(kInviteSavePage, "Save as a page", "Guardar como página", "Als Seite speichern") \
  ROW(kInvitePageSaved, \
      "Saved as {}. Send this file only to {}.", \
      "Guardada como {}. Envía este archivo solo a {}.", \
      "Gespeichert als {}. Schicke diese Datei nur an {}.") \
  ROW(kInvitePageNotSaved, \
      "The page could not be saved.", \
      "No se pudo guardar la página.", \
      "Die Seite konnte nicht gespeichert werden.")
// clang-format on
