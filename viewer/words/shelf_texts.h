// The texts of the page with recorded dances (lobby/screen/shelf_screen.cpp), as rows of
// viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_SHELF_TEXTS(ROW) \
  ROW(kLobbyShelf, "My dances", "Mis bailes", "Meine Tänze") \
  ROW(kLobbyShelfTitle, \
      "Dances that you recorded", \
      "Bailes que has grabado", \
      "Aufgenommene Tänze") \
  ROW(kLobbyShelfEmpty, \
      "Nothing is recorded yet. Press Record during a dance: it is saved in {}.", \
      "Aún no hay grabaciones. Pulsa Grabar durante un baile: se guarda en {}.", \
      "Noch ist nichts aufgenommen. Drücke beim Tanzen auf Aufnehmen: Der Tanz wird in {} " \
      "gespeichert.") \
  ROW(kLobbyDateFormat, "%Y-%m-%d, %H:%M", "%d/%m/%Y, %H:%M", "%d.%m.%Y, %H:%M") \
  ROW(kLobbyToday, "Today, {}", "Hoy, {}", "Heute, {}") \
  ROW(kLobbyYesterday, "Yesterday, {}", "Ayer, {}", "Gestern, {}") \
  ROW(kLobbyNoDanceInIt, \
      "no dance in this file", \
      "no hay ningún baile en este archivo", \
      "kein Tanz in dieser Datei") \
  ROW(kLobbyTempo, "{} BPM", "{} BPM", "{} BPM") \
  ROW(kLobbyWatch, "Watch", "Ver", "Ansehen") \
  ROW(kLobbyMakeVideo, "Make a video", "Crear un vídeo", "Video erstellen") \
  ROW(kLobbyExport, "Export", "Exportar", "Exportieren") \
  ROW(kLobbyExportNote, \
      "BVH for animation programs, one file for each dancer; GLB for Blender and games, all in " \
      "one file.", \
      "BVH para programas de animación, un archivo por persona; GLB para Blender y juegos, " \
      "todos en uno.", \
      "BVH für Animationsprogramme, je Person eine Datei; GLB für Blender und Spiele, alle in " \
      "einer Datei.") \
  ROW(kLobbyRename, "Rename", "Cambiar nombre", "Umbenennen") \
  ROW(kLobbyDelete, "Delete", "Borrar", "Löschen") \
  ROW(kLobbyAskDelete, \
      "Delete {} for good?", \
      "¿Borrar {} para siempre?", \
      "{} endgültig löschen?") \
  ROW(kLobbyShowFile, "Show the file", "Mostrar el archivo", "Datei zeigen") \
  ROW(kLobbyOpenFolder, "Open the folder", "Abrir la carpeta", "Ordner öffnen") \
  ROW(kLobbyNewName, "New name", "Nombre nuevo", "Neuer Name") \
  ROW(kLobbyExporting, "Writing {}…", "Escribiendo {}…", "{} wird geschrieben…") \
  ROW(kLobbyExported, "Saved: {}", "Guardado: {}", "Gespeichert: {}") \
  ROW(kLobbyExportFailed, \
      "The file could not be written.", \
      "No se pudo escribir el archivo.", \
      "Die Datei ließ sich nicht schreiben.") \
  ROW(kLobbyNotRenamed, \
      "The recording keeps its name: choose another.", \
      "La grabación conserva su nombre: elige otro.", \
      "Die Aufnahme behält ihren Namen: Wähle einen anderen.") \
  ROW(kLobbyNotDeleted, \
      "The recording could not be deleted.", \
      "No se pudo borrar la grabación.", \
      "Die Aufnahme ließ sich nicht löschen.") \
  ROW(kLobbyNotShown, \
      "The recording could not be shown.", \
      "No se pudo mostrar la grabación.", \
      "Die Aufnahme ließ sich nicht zeigen.") \
  ROW(kLobbySavedDance, \
      "Your dance is saved. Watch it now?", \
      "Tu baile está guardado. ¿Quieres verlo ahora?", \
      "Dein Tanz ist gespeichert. Jetzt ansehen?")
// clang-format on
