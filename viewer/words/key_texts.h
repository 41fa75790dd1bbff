// Texts of the list of keys, the timeline, exports, views and places, as rows of
// viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_KEY_TEXTS(ROW) \
  ROW(kDoBar, "one bar back, forward", "un compás atrás, adelante", "einen Takt zurück, vor") \
  ROW(kDoBeat, "one beat back, forward", "un tiempo atrás, adelante", "einen Schlag zurück, vor") \
  ROW(kDoChosen, \
      "dancer 1 to 9, by name", \
      "bailarín 1 a 9, por nombre", \
      "Tänzer 1 bis 9, nach Namen") \
  ROW(kDoClose, "close the window", "cerrar la ventana", "Fenster schließen") \
  ROW(kDoCompare, \
      "two halves: as received, as shown", \
      "dos mitades: como llega, como se muestra", \
      "zwei Hälften: wie empfangen, wie gezeigt") \
  ROW(kDoControls, \
      "from one control to the next", \
      "de un control al siguiente", \
      "von einem Feld zum nächsten") \
  ROW(kDoDancePanel, \
      "guests, music, recording, leave", \
      "invitados, música, grabación, salir", \
      "Gäste, Musik, Aufnahme, Verlassen") \
  ROW(kDoDelays, \
      "where each guest's delay comes from", \
      "de dónde viene el retraso de cada uno", \
      "woher die Verzögerung jedes Gastes kommt") \
  ROW(kDoDisplay, \
      "no tearing, or lowest delay", \
      "sin cortes, o con el mínimo retraso", \
      "ohne Risse im Bild, oder kleinste Verzögerung") \
  ROW(kDoEnds, "to the beginning, to the end", "al principio, al final", "zum Anfang, zum Ende") \
  ROW(kDoEverybody, "show everybody again", "mostrar a todos otra vez", "wieder alle zeigen") \
  ROW(kDoExport, \
      "make a video or another file; stop it", \
      "hacer un vídeo u otro archivo; pararlo", \
      "Video oder andere Datei erstellen; abbrechen") \
  ROW(kDoEyes, \
      "through a dancer's eyes", \
      "a través de los ojos de un bailarín", \
      "mit den Augen eines Tänzers") \
  ROW(kDoFrame, "one frame back, forward", "una imagen atrás, adelante", "ein Bild zurück, vor") \
  ROW(kDoFullScreen, \
      "full screen, or window", \
      "pantalla completa, o ventana", \
      "Vollbild, oder Fenster") \
  ROW(kDoGrid, \
      "each couple in its own picture", \
      "cada pareja en su propio cuadro", \
      "jedes Paar im eigenen Bild") \
  ROW(kDoJump, "5 s back, forward", "5 s atrás, adelante", "5 s zurück, vor") \
  ROW(kDoKeys, "these keys", "estas teclas", "diese Tasten") \
  ROW(kDoLoop, \
      "repeat the loop or not; Shift: forget it", \
      "repetir o no; Mayús: olvidar el tramo", \
      "wiederholen oder nicht; Umschalt: vergessen") \
  ROW(kDoLoopEdges, \
      "repeat from here, up to here", \
      "repetir desde aquí, hasta aquí", \
      "wiederholen ab hier, bis hier") \
  ROW(kDoMeasurements, \
      "measurements for engineers", \
      "mediciones para técnicos", \
      "Messwerte für Techniker") \
  ROW(kDoMuteMusic, \
      "mute or unmute the music here", \
      "silenciar la música aquí, o volver a oírla", \
      "Musik hier stumm oder wieder laut stellen") \
  ROW(kDoMicrophone, "microphone off, on", "micrófono apagado, encendido", "Mikrofon aus, an") \
  ROW(kDoMirror, \
      "a dancer as in a mirror", \
      "un bailarín como en el espejo", \
      "ein Tänzer wie im Spiegel") \
  ROW(kDoMove, \
      "move the camera; the right button too", \
      "mover la cámara; también con el botón derecho", \
      "Kamera verschieben; auch rechte Taste") \
  ROW(kDoNames, "names over heads", "nombres sobre las cabezas", "Namen über den Köpfen") \
  ROW(kDoNearer, "nearer, farther", "más cerca, más lejos", "näher, weiter weg") \
  ROW(kDoNextDancer, \
      "the next dancer; Shift: the one before", \
      "el bailarín siguiente; Mayús: el anterior", \
      "nächster Tänzer; Umschalt: voriger") \
  ROW(kDoNextGuest, \
      "while open: the next guest", \
      "abierto: el invitado siguiente", \
      "wenn offen: nächster Gast") \
  ROW(kDoNextView, \
      "the next view; Shift: the one before", \
      "la vista siguiente; Mayús: la anterior", \
      "nächste Ansicht; Umschalt: vorige") \
  ROW(kDoPicture, "take a picture", "hacer una foto", "ein Bild aufnehmen") \
  ROW(kDoPlay, "play, pause", "reproducir, pausa", "abspielen, Pause") \
  ROW(kDoPredict, \
      "predict dancers to now, or as received", \
      "predecir hasta ahora, o mostrar como llegan", \
      "Tänzer vorausberechnen oder wie empfangen") \
  ROW(kDoPress, "press", "pulsar", "drücken") \
  ROW(kDoPreviousDancer, \
      "the dancer before, the next", \
      "el bailarín anterior, el siguiente", \
      "voriger, nächster Tänzer") \
  ROW(kDoQuieter, "quieter, louder", "más bajo, más alto", "leiser, lauter") \
  ROW(kDoRotate, \
      "turn slowly by itself, or stop", \
      "girar despacio sola, o parar", \
      "langsam von selbst drehen, oder anhalten") \
  ROW(kDoSlower, "slower, faster", "más lento, más rápido", "langsamer, schneller") \
  ROW(kDoSpeaker, "loudspeaker off, on", "altavoz apagado, encendido", "Lautsprecher aus, an") \
  ROW(kDoStage, "the whole stage", "todo el escenario", "die ganze Bühne") \
  ROW(kDoStyle, \
      "size, rhythm and smoothness of a dancer", \
      "tamaño, ritmo y suavidad de un bailarín", \
      "Größe, Rhythmus und Glättung eines Tänzers") \
  ROW(kDoTalk, \
      "talk while it is held", \
      "hablar mientras se mantiene pulsada", \
      "sprechen, solange die Taste gedrückt ist") \
  ROW(kDoPlace, \
      "next place: studio, bar, terrace, none", \
      "siguiente lugar: estudio, bar, terraza, ninguno", \
      "nächster Ort: Studio, Bar, Terrasse, keiner") \
  ROW(kDoTrails, \
      "trails of light behind hands", \
      "estelas de luz tras las manos", \
      "Lichtspuren hinter den Händen") \
  ROW(kDoTurn, "turn the camera", "girar la cámara", "Kamera drehen") \
  ROW(kDoWalk, "walk behind a dancer", "detrás de un bailarín", "hinter einem Tänzer her") \
  ROW(kDoZoomTime, \
      "over the timeline: a shorter or longer part", \
      "sobre la línea de tiempo: menos o más", \
      "über der Zeitleiste: weniger oder mehr") \
  ROW(kExportAsks, \
      "Export the loop, or everything:", \
      "Exportar el tramo, o todo:", \
      "Schleife oder alles exportieren:") \
  ROW(kExportBvh, \
      "one dancer's motion (BVH)", \
      "movimiento de un bailarín (BVH)", \
      "Bewegung eines Tänzers (BVH)") \
  ROW(kExportCancel, "Esc  stop it", "Esc  pararlo", "Esc  abbrechen") \
  ROW(kExportGlb, \
      "all dancers in 3D (GLB)", \
      "todos los bailarines en 3D (GLB)", \
      "alle Tänzer in 3D (GLB)") \
  ROW(kExportGoesOn, "E  keep writing", "E  dejar que siga", "E  weiterlaufen lassen") \
  ROW(kExportPictures, "pictures (PNG)", "imágenes (PNG)", "Bilder (PNG)") \
  ROW(kExportRuns, \
      "A file is being written.", \
      "Se está escribiendo un archivo.", \
      "Eine Datei wird geschrieben.") \
  ROW(kExportVideo, "a video", "un vídeo", "ein Video") \
  ROW(kKeyControlArrows, "Ctrl ← →", "Ctrl ← →", "Strg ← →") \
  ROW(kKeyDrag, "Drag", "Arrastrar", "Ziehen") \
  ROW(kKeyEnter, "Enter", "Intro", "Eingabe") \
  ROW(kKeyHomeEnd, "Home End", "Inicio Fin", "Pos1 Ende") \
  ROW(kKeyShiftArrows, "Shift ← →", "Mayús ← →", "Umschalt ← →") \
  ROW(kKeyShiftDrag, "Shift drag", "Mayús y arrastrar", "Umschalt und Ziehen") \
  ROW(kKeySpace, "Space", "Espacio", "Leertaste") \
  ROW(kKeyWheel, "Wheel", "Rueda", "Mausrad") \
  ROW(kKeyWheelArrows, "Wheel ↑ ↓", "Rueda ↑ ↓", "Mausrad ↑ ↓") \
  ROW(kKeysCamera, "Camera", "Cámara", "Kamera") \
  ROW(kKeysDancers, "Dancers", "Bailarines", "Tänzer") \
  ROW(kKeysEngineers, "Measurements", "Mediciones", "Messwerte") \
  ROW(kKeysHint, "? shows all keys", "? muestra todas las teclas", "? zeigt alle Tasten") \
  ROW(kKeysPage, \
      "{} of {}: ? turns the page", \
      "{} de {}: ? pasa la página", \
      "{} von {}: ? blättert um") \
  ROW(kKeysPicture, "Picture", "Imagen", "Bild") \
  ROW(kKeysRecording, "Recording", "Grabación", "Aufnahme") \
  ROW(kKeysStyle, "Style", "Estilo", "Stil") \
  ROW(kKeysViews, "Views", "Vistas", "Ansichten") \
  ROW(kKeysVoice, "Voice", "Voz", "Stimme") \
  ROW(kStageEmpty, \
      "Nobody is dancing here yet.", \
      "Aún no baila nadie aquí.", \
      "Hier tanzt noch niemand.") \
  ROW(kTipBack, "5 s back (←)", "5 s atrás (←)", "5 s zurück (←)") \
  ROW(kTipExport, \
      "make a video or another file (E)", \
      "hacer un vídeo u otro archivo (E)", \
      "Video oder andere Datei erstellen (E)") \
  ROW(kTipFaster, "faster (↑)", "más rápido (↑)", "schneller (↑)") \
  ROW(kTipFrameBack, "one frame back (,)", "una imagen atrás (,)", "ein Bild zurück (,)") \
  ROW(kTipFrameOn, "one frame forward (.)", "una imagen adelante (.)", "ein Bild vor (.)") \
  ROW(kTipLoop, \
      "repeat the loop, or not (L)", \
      "repetir el tramo, o no (L)", \
      "Schleife wiederholen, oder nicht (L)") \
  ROW(kTipLoopBegin, \
      "repeat from here ([)", \
      "repetir desde aquí ([)", \
      "wiederholen ab hier ([)") \
  ROW(kTipLoopEnd, \
      "repeat up to here (])", \
      "repetir hasta aquí (])", \
      "wiederholen bis hier (])") \
  ROW(kTipOn, "5 s forward (→)", "5 s adelante (→)", "5 s vor (→)") \
  ROW(kTipSlower, "slower (↓)", "más lento (↓)", "langsamer (↓)") \
  ROW(kTipStart, "to the beginning", "al principio", "zum Anfang") \
  ROW(kPlaceLabel, "Place", "Lugar", "Ort") \
  ROW(kPlacePlain, "Empty stage", "Escenario vacío", "Leere Bühne") \
  ROW(kPlaceStudio, "Dance studio", "Estudio de baile", "Tanzstudio") \
  ROW(kPlaceBar, "Bar at night", "Bar de noche", "Bar bei Nacht") \
  ROW(kPlaceTerrace, "Terrace", "Terraza", "Terrasse") \
  ROW(kViewCompare, \
      "nothing to compare: no dancer on the stage is also received by this house", \
      "no hay nada que comparar: esta casa no recibe a ningún bailarín del escenario", \
      "nichts zu vergleichen: dieses Haus empfängt keinen Tänzer, der auf der Bühne ist") \
  ROW(kViewEyes, "through the eyes of {}", "a través de los ojos de {}", "mit den Augen von {}") \
  ROW(kViewFollow, "following {}", "siguiendo a {}", "hinter {} her") \
  ROW(kViewMirror, "in the mirror: {}", "en el espejo: {}", "im Spiegel: {}")
// clang-format on
