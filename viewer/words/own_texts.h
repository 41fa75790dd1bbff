// The texts of what a dancer changes about themselves during the dance
// (viewer/dance_panel/own/), as rows of viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_OWN_TEXTS(ROW) \
  ROW(kOwnName, "Name", "Nombre", "Name") \
  ROW(kOwnFigure, "Figure", "Figura", "Figur") \
  ROW(kOwnNameHint, \
      "The name that others see:", \
      "El nombre que ven los demás:", \
      "Der Name, den andere sehen:") \
  ROW(kOwnNameRule, \
      "This name is too long or cannot be shown.", \
      "Este nombre es demasiado largo o no se puede mostrar.", \
      "Dieser Name ist zu lang oder lässt sich nicht anzeigen.") \
  ROW(kOwnFigureFile, "A file…", "Un archivo…", "Eine Datei…") \
  ROW(kOwnFileHint, \
      "The path of a .vrm or .glb file:", \
      "La ruta de un archivo .vrm o .glb:", \
      "Der Pfad einer .vrm- oder .glb-Datei:") \
  ROW(kOwnFigureStored, "Stored figure {}", "Figura guardada {}", "Gespeicherte Figur {}") \
  ROW(kOwnFigureComes, \
      "Changing the figure …", \
      "Cambiando la figura…", \
      "Die Figur wird gewechselt …") \
  ROW(kOwnVoiceOn, "Turn the voice on", "Activar la voz", "Stimme einschalten") \
  ROW(kOwnVoiceOff, "Voice off", "Sin voz", "Stimme aus") \
  ROW(kOwnApply, "OK", "Aceptar", "OK") \
  ROW(kOwnCancel, "Cancel", "Cancelar", "Abbrechen")
// clang-format on
