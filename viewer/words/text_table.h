// All texts of the windows for dancers, one row each: its name, then English, Spanish and German.
// A `{}` is filled in, in order. Included by texts.h and texts.cpp alone.
//
// Ownership: constants.
// Threads:   any.
// Failure:   a row that lacks a language does not compile; one whose languages have different
//            places to fill fails a test.
#pragma once

#include "viewer/words/lobby_texts.h"

// clang-format off
#define DANCE_TEXTS(ROW) \
  ROW(kLeave, "Leave", "Salir", "Verlassen") \
  ROW(kBack, "Back", "Volver", "Zurück") \
  /* lobby/checks: the camera */ \
  ROW(kCameraBackLight, \
      "A bright window is behind you: turn the camera, or close the curtain", \
      "Hay una ventana luminosa detrás de ti: gira la cámara o cierra la cortina", \
      "Hinter dir ist ein helles Fenster: dreh die Kamera oder zieh den Vorhang zu") \
  ROW(kCameraComeCloser, \
      "You are far away: come closer", \
      "Estás lejos: acércate", \
      "Du bist weit weg: komm näher") \
  ROW(kCameraEnded, \
      "The camera's program has ended: choose the camera again", \
      "El programa de la cámara ha terminado: vuelve a elegir la cámara", \
      "Das Programm der Kamera ist beendet: wähle die Kamera noch einmal") \
  ROW(kCameraFailed, \
      "The camera cannot be opened: unplug it, plug it in again, or choose another", \
      "No se puede abrir la cámara: desconéctala y vuelve a conectarla, o elige otra", \
      "Die Kamera lässt sich nicht öffnen: steck sie neu ein oder wähle eine andere") \
  ROW(kCameraFeetCutOff, \
      "Your feet are cut off: step back, or tilt the camera down", \
      "No se te ven los pies: da un paso atrás o inclina la cámara hacia abajo", \
      "Deine Füße sind nicht im Bild: geh zurück oder neige die Kamera nach unten") \
  ROW(kCameraHandsCutOff, \
      "Your hands leave the picture: step back", \
      "Tus manos se salen de la imagen: da un paso atrás", \
      "Deine Hände sind nicht im Bild: geh zurück") \
  ROW(kCameraHeadCutOff, \
      "Your head is cut off: step back, or tilt the camera up", \
      "No se te ve la cabeza: da un paso atrás o inclina la cámara hacia arriba", \
      "Dein Kopf ist nicht im Bild: geh zurück oder neige die Kamera nach oben") \
  ROW(kCameraInUse, \
      "Another program uses the camera: close that program", \
      "Otro programa está usando la cámara: cierra ese programa", \
      "Ein anderes Programm benutzt die Kamera: schließ dieses Programm") \
  ROW(kCameraLegsHidden, \
      "Something hides your legs: clear the space before you", \
      "Algo te tapa las piernas: despeja el espacio delante de ti", \
      "Etwas verdeckt deine Beine: räum den Platz vor dir frei") \
  ROW(kCameraLensCovered, \
      "The picture is black: is the lens covered, or the light off?", \
      "La imagen está negra: ¿está tapado el objetivo o apagada la luz?", \
      "Das Bild ist schwarz: ist die Linse abgedeckt oder das Licht aus?") \
  ROW(kCameraNobody, \
      "Nobody is seen: step into the picture, two to four metres from the camera", \
      "No se ve a nadie: ponte delante de la cámara, a una distancia de dos a cuatro metros", \
      "Niemand ist zu sehen: stell dich ins Bild, zwei bis vier Meter vor die Kamera") \
  ROW(kCameraNoNetwork, \
      "The pose network is missing: `dance fetch-models` fetches it", \
      "Falta la red que reconoce las posturas: `dance fetch-models` la descarga", \
      "Das Netz, das Haltungen erkennt, fehlt: `dance fetch-models` lädt es") \
  ROW(kCameraNone, \
      "No camera is there: plug one in", \
      "No hay ninguna cámara: conecta una", \
      "Keine Kamera ist da: steck eine ein") \
  ROW(kCameraNoPermission, \
      "You may not use the camera: join the group `video` and log in again", \
      "No tienes permiso para usar la cámara: únete al grupo `video` y vuelve a iniciar sesión", \
      "Du darfst die Kamera nicht benutzen: tritt der Gruppe `video` bei und melde dich neu an") \
  ROW(kCameraNotBuilt, \
      "Dancing before a camera is not installed here: install the whole package", \
      "Aquí no está instalada la captura con cámara: instala el paquete completo", \
      "Das Tanzen vor der Kamera ist hier nicht installiert: installiere das ganze Paket") \
  ROW(kCameraOpening, \
      "The camera is being opened", \
      "Se está abriendo la cámara", \
      "Die Kamera wird geöffnet") \
  ROW(kCameraOtherVersion, \
      "The camera's program is of another version: install DanceGraph again", \
      "El programa de la cámara es de otra versión: vuelve a instalar DanceGraph", \
      "Das Programm der Kamera hat eine andere Version: installiere DanceGraph neu") \
  ROW(kCameraSeenWhole, \
      "You are seen from head to feet: good", \
      "Se te ve de la cabeza a los pies: muy bien", \
      "Du bist von Kopf bis Fuß zu sehen: gut so") \
  ROW(kCameraShakes, \
      "The camera moves: put it on something firm", \
      "La cámara se mueve: ponla sobre algo firme", \
      "Die Kamera bewegt sich: stell sie auf etwas Festes") \
  ROW(kCameraSilent, \
      "The camera gives no pictures: unplug it and plug it in again", \
      "La cámara no envía imágenes: desconéctala y vuelve a conectarla", \
      "Die Kamera liefert keine Bilder: zieh sie ab und steck sie wieder ein") \
  ROW(kCameraSlow, \
      "The camera gives few pictures: turn on more light, or close other programs", \
      "La cámara envía pocas imágenes: enciende más luz o cierra otros programas", \
      "Die Kamera liefert wenige Bilder: mach mehr Licht oder schließ andere Programme") \
  ROW(kCameraStepBack, \
      "You are too near: step back", \
      "Estás demasiado cerca: da un paso atrás", \
      "Du bist zu nah: geh zurück") \
  ROW(kCameraStepToMiddle, \
      "You stand at the edge of the picture: step to the middle", \
      "Estás al borde de la imagen: ponte en el centro", \
      "Du stehst am Bildrand: geh zur Mitte") \
  ROW(kCameraTooBright, \
      "Too bright: turn the camera away from the light", \
      "Demasiada luz: aparta la cámara de la luz", \
      "Zu hell: dreh die Kamera vom Licht weg") \
  ROW(kCameraTooDark, \
      "Too dark: turn on a light in front of you", \
      "Demasiado oscuro: enciende una luz delante de ti", \
      "Zu dunkel: mach vor dir ein Licht an") \
  ROW(kCameraUnplugged, \
      "The camera was unplugged: plug it in again", \
      "La cámara se ha desconectado: vuelve a conectarla", \
      "Die Kamera wurde abgezogen: steck sie wieder ein") \
  /* lobby/checks: sound */ \
  ROW(kSoundClips, \
      "You are too loud for the microphone: turn it down, or move away", \
      "Suenas demasiado fuerte para el micrófono: bájalo o aléjate", \
      "Du bist zu laut für das Mikrofon: stell es leiser oder geh weiter weg") \
  ROW(kSoundEchoHeard, \
      "The microphone hears the loudspeaker: headphones help", \
      "El micrófono oye el altavoz: unos auriculares ayudan", \
      "Das Mikrofon hört den Lautsprecher: Kopfhörer helfen") \
  ROW(kSoundGood, \
      "The microphone hears you: good", \
      "El micrófono te oye: muy bien", \
      "Das Mikrofon hört dich: gut so") \
  ROW(kSoundLoudspeakerGone, \
      "That loudspeaker is not there: choose another", \
      "Ese altavoz no está: elige otro", \
      "Dieser Lautsprecher ist nicht da: wähle einen anderen") \
  ROW(kSoundLoudspeakerMuted, \
      "The loudspeaker is muted: turn it on", \
      "El altavoz está silenciado: actívalo", \
      "Der Lautsprecher ist stumm: schalte ihn ein") \
  ROW(kSoundLoudspeakerNowhere, \
      "No loudspeaker is there: plug one in, or choose another", \
      "No hay ningún altavoz: conecta uno o elige otro", \
      "Kein Lautsprecher ist da: steck einen ein oder wähle einen anderen") \
  ROW(kSoundMicrophoneGone, \
      "That microphone is not there: choose another", \
      "Ese micrófono no está: elige otro", \
      "Dieses Mikrofon ist nicht da: wähle ein anderes") \
  ROW(kSoundMicrophoneMuted, \
      "The microphone is muted: turn it on", \
      "El micrófono está silenciado: actívalo", \
      "Das Mikrofon ist stumm: schalte es ein") \
  ROW(kSoundMicrophoneNone, \
      "No microphone is there: plug one in", \
      "No hay ningún micrófono: conecta uno", \
      "Kein Mikrofon ist da: steck eines ein") \
  ROW(kSoundNoEcho, \
      "The microphone does not hear the loudspeaker", \
      "El micrófono no oye el altavoz", \
      "Das Mikrofon hört den Lautsprecher nicht") \
  ROW(kSoundNoServer, \
      "No sound server is running: log in again, or start PipeWire or PulseAudio", \
      "No hay ningún servidor de sonido: vuelve a iniciar sesión o arranca PipeWire o PulseAudio", \
      "Kein Klangserver läuft: melde dich neu an oder starte PipeWire oder PulseAudio") \
  ROW(kSoundNotBuilt, \
      "Sound is not installed here: install the whole package", \
      "Aquí no está instalado el sonido: instala el paquete completo", \
      "Ton ist hier nicht installiert: installiere das ganze Paket") \
  ROW(kSoundOpening, \
      "Microphone and loudspeaker are being opened", \
      "Se están abriendo el micrófono y el altavoz", \
      "Mikrofon und Lautsprecher werden geöffnet") \
  ROW(kSoundRoundTrip, \
      "Loudspeaker and microphone: {} ms there and back", \
      "Altavoz y micrófono: {} ms de ida y vuelta", \
      "Lautsprecher und Mikrofon: {} ms hin und zurück") \
  ROW(kSoundSaySomething, "Say something", "Di algo", "Sag etwas") \
  ROW(kSoundSilent, \
      "The microphone is silent: it is muted, or another one is in use", \
      "El micrófono no capta nada: está silenciado o se usa otro", \
      "Das Mikrofon ist still: es ist stumm, oder ein anderes wird benutzt") \
  DANCE_LOBBY_TEXTS(ROW)
// clang-format on
