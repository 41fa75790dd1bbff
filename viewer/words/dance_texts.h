// The texts of the panel and the banners of the dance (viewer/dance_panel/), as rows of
// viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_PANEL_TEXTS(ROW) \
  ROW(kBannerClock, \
      "This computer's clock jumped by {} s.", \
      "El reloj de este ordenador ha saltado {} s.", \
      "Die Uhr dieses Rechners ist um {} s gesprungen.") \
  ROW(kBannerClockCure, \
      "Did it sleep, or was its clock set? The others saw you stand still; it settles by " \
      "itself.", \
      "¿Estuvo suspendido o se ajustó la hora? Los demás te vieron parado; se arregla solo.", \
      "Hat er geschlafen, oder wurde sie gestellt? Die anderen sahen dich stillstehen; es " \
      "gibt sich von selbst.") \
  ROW(kBannerHostClosed, \
      "{} has closed the room.", \
      "{} ha cerrado la sala.", \
      "{} hat den Raum geschlossen.") \
  ROW(kBannerHostClosedCure, \
      "If it opens again, you rejoin automatically.", \
      "Si vuelve a abrirse, entrarás automáticamente.", \
      "Wird er wieder geöffnet, bist du automatisch wieder dabei.") \
  ROW(kBannerKey, \
      "The server does not accept this house's key.", \
      "El servidor no acepta la clave de esta casa.", \
      "Der Server nimmt den Schlüssel dieses Hauses nicht an.") \
  ROW(kBannerKeyCure, \
      "It was revoked or replaced. Ask the person who runs the server for a new invitation.", \
      "Fue revocada o cambiada. Pide una nueva invitación a quien lleva el servidor.", \
      "Er wurde widerrufen oder ersetzt. Bitte um eine neue Einladung.") \
  ROW(kBannerLinkGone, \
      "This house is no longer linked to the server.", \
      "Esta casa ya no está enlazada con el servidor.", \
      "Dieses Haus ist nicht mehr mit dem Server verbunden.") \
  ROW(kBannerLinkGoneCure, \
      "Its link has ended. Leave, and join again.", \
      "Su enlace ha terminado. Sal y vuelve a entrar.", \
      "Die Verbindung wurde beendet. Verlasse den Tanz und tritt wieder bei.") \
  ROW(kBannerMicrophone, \
      "Your microphone gives no sound at all.", \
      "Tu micrófono no da ningún sonido.", \
      "Dein Mikrofon gibt keinen Ton von sich.") \
  ROW(kBannerMicrophoneCure, \
      "Is its own switch off, or is another one chosen in the sound settings?", \
      "¿Está apagado o hay otro elegido en los ajustes de sonido?", \
      "Ist sein Schalter aus, oder ist in den Toneinstellungen ein anderes gewählt?") \
  ROW(kBannerMuted, \
      "You speak, and are muted.", \
      "Hablas, pero estás en silencio.", \
      "Du sprichst, bist aber stumm.") \
  ROW(kBannerMutedCure, "Nobody hears you.", "Nadie te oye.", "Niemand hört dich.") \
  ROW(kBannerNoMicrophone, \
      "There is no microphone.", \
      "No hay micrófono.", \
      "Es ist kein Mikrofon da.") \
  ROW(kBannerNoMicrophoneCure, \
      "Plug one in; it is used at once.", \
      "Conecta uno; se usa enseguida.", \
      "Schließe eines an; es wird sofort verwendet.") \
  ROW(kBannerNoPoses, \
      "{} is not seen: no movement for {} s.", \
      "No se ve a {}: sin movimiento desde hace {} s.", \
      "{} ist nicht zu sehen: seit {} s keine Bewegung.") \
  ROW(kBannerNoPosesCure, \
      "Step into the camera's view. If it was unplugged, or another program has taken it, " \
      "plug it in or close that program.", \
      "Ponte delante de la cámara. Si se desconectó o la usa otro programa, conéctala o " \
      "cierra ese programa.", \
      "Tritt ins Bild. Wurde die Kamera ausgesteckt, oder hat sie ein anderes Programm, so " \
      "stecke sie ein oder schließe es.") \
  ROW(kBannerNoSound, \
      "Your microphone cannot be reached: this computer's sound system does not answer.", \
      "No se puede acceder a tu micrófono: el sistema de sonido no responde.", \
      "Dein Mikrofon ist nicht erreichbar: Das Soundsystem antwortet nicht.") \
  ROW(kBannerNoSoundCure, \
      "Is its sound server (PipeWire or PulseAudio) running? Once it is, the others hear " \
      "you.", \
      "¿Está en marcha el servidor de sonido (PipeWire o PulseAudio)? En cuanto lo esté, se te " \
      "oirá.", \
      "Läuft der Soundserver (PipeWire oder PulseAudio)? Sobald er läuft, hört man dich.") \
  ROW(kBannerNotTrusted, \
      "The server and this house do not trust each other.", \
      "El servidor y esta casa no se reconocen.", \
      "Server und Haus vertrauen einander nicht.") \
  ROW(kBannerNotTrustedCure, \
      "One of the certificates is not signed by an authority that the other trusts: ask " \
      "the person who runs the server.", \
      "Uno de los certificados no lo firma una autoridad conocida: pregunta a quien lleva " \
      "el servidor.", \
      "Eines der Zertifikate ist nicht von anerkannter Stelle unterschrieben: Frage den " \
      "Betreiber des Servers.") \
  ROW(kBannerServerKey, \
      "The server has another key than before, so no dance was sent to it.", \
      "El servidor tiene otra clave que antes, así que no se le ha enviado ningún baile.", \
      "Der Server hat einen anderen Schlüssel als bisher; es wurde kein Tanz an ihn gesendet.") \
  ROW(kBannerServerKeyCure, \
      "Another machine may have taken its place. Ask the person who runs it whether the key has " \
      "changed; if so, open a new invitation.", \
      "Puede que otra máquina ocupe su lugar. Pregunta a quien lleva el servidor si ha " \
      "cambiado la clave; si es así, abre una invitación nueva.", \
      "Vielleicht hat ein anderer Rechner seinen Platz eingenommen. Frage den Betreiber, ob " \
      "sich der Schlüssel geändert hat; wenn ja, öffne eine neue Einladung.") \
  ROW(kBannerRecording, \
      "The recording has ended.", \
      "La grabación se ha interrumpido.", \
      "Die Aufnahme ist abgebrochen.") \
  ROW(kBannerRefused, \
      "The server does not let this house in.", \
      "El servidor no deja entrar a esta casa.", \
      "Der Server lässt dieses Haus nicht ein.") \
  ROW(kBannerRefusedCure, \
      "The name may be taken, or the room full: choose another name, or wait. It is asked " \
      "again.", \
      "Quizá el nombre esté ocupado o la sala llena: elige otro nombre o espera. Se vuelve " \
      "a intentar.", \
      "Der Name ist vergeben oder der Raum voll: wähle einen anderen Namen oder warte. Es " \
      "wird weiter gefragt.") \
  ROW(kBannerRefusedGuest, \
      "The server does not let {} in.", \
      "El servidor no deja entrar a {}.", \
      "Der Server lässt {} nicht ein.") \
  ROW(kBannerRemoved, \
      "A host has removed you from the room.", \
      "Un anfitrión te ha sacado de la sala.", \
      "Ein Gastgeber hat dich aus dem Raum entfernt.") \
  ROW(kBannerRemovedCure, \
      "This house may come back in {} min. Ask the host.", \
      "Esta casa podrá volver en {} min. Pregunta al anfitrión.", \
      "Dieses Haus darf in {} min zurückkommen. Frage den Gastgeber.") \
  ROW(kBannerRoomClosed, \
      "The room has been closed.", \
      "La sala se ha cerrado.", \
      "Der Raum wurde geschlossen.") \
  ROW(kBannerRoomClosedCure, \
      "Its server has stopped. If it starts again, you rejoin automatically.", \
      "Su servidor se ha detenido. Si vuelve a arrancar, entrarás automáticamente.", \
      "Sein Server wurde beendet. Startet er wieder, bist du automatisch wieder dabei.") \
  ROW(kBannerServer, \
      "The server does not answer.", \
      "El servidor no responde.", \
      "Der Server antwortet nicht.") \
  ROW(kBannerServerCure, \
      "Is the network there? The house goes on asking, and your dance goes on here.", \
      "¿Hay red? La casa sigue intentándolo y aquí el baile sigue.", \
      "Ist das Netz da? Das Haus fragt weiter, und hier geht der Tanz weiter.") \
  ROW(kDanceJoined, "{} is here", "{} ha llegado", "{} ist da") \
  ROW(kDanceCloseRoom, "Close the room", "Cerrar la sala", "Raum schließen") \
  ROW(kDanceClosing, \
      "This ends the room for {}.", \
      "La sala se cerrará también para {}.", \
      "Damit endet der Raum auch für {}.") \
  ROW(kDanceCountIn, "Count in", "Cuenta de entrada", "Einzählen") \
  ROW(kDanceCountWaits, \
      "Count in: next bar", \
      "Cuenta: próximo compás", \
      "Einzählen: nächster Takt") \
  ROW(kDanceDrawPlainly, "Draw plainly", "Dibujar sencillo", "Schlicht zeichnen") \
  ROW(kDanceFindsBeat, "Finding the beat…", "Buscando el ritmo…", "Der Takt wird gesucht…") \
  ROW(kDanceGuests, "Guests: {}", "Invitados: {}", "Gäste: {}") \
  ROW(kDanceHearsNobody, "cannot hear you", "no te oye", "hört dich nicht") \
  ROW(kDanceHidden, "hidden", "oculto", "verborgen") \
  ROW(kDanceHide, "Hide", "Ocultar", "Verbergen") \
  ROW(kDanceKeep, "No", "No", "Nein") \
  ROW(kDanceLeft, "{} has left", "{} se ha ido", "{} ist gegangen") \
  ROW(kDanceMicrophoneOff, "Microphone off", "Micrófono apagado", "Mikrofon aus") \
  ROW(kDanceMicrophoneOn, "Microphone on", "Micrófono encendido", "Mikrofon an") \
  ROW(kDanceMusic, "Music", "Música", "Musik") \
  ROW(kDanceMusicMuted, "music muted", "música en silencio", "Musik stumm") \
  ROW(kDanceMusicSpeed, "speed {} %", "velocidad {} %", "Tempo {} %") \
  ROW(kDanceMusicVolume, "music {} %", "música {} %", "Musik {} %") \
  ROW(kDanceMute, "Mute voice", "Silenciar voz", "Stumm schalten") \
  ROW(kDanceMuted, "muted by you", "silenciado por ti", "von dir stumm gestellt") \
  ROW(kDanceMutedSelf, "muted", "en silencio", "stumm") \
  ROW(kDanceNoMicrophone, "no microphone", "sin micrófono", "ohne Mikrofon") \
  ROW(kDanceNoMusic, "No music", "Sin música", "Keine Musik") \
  ROW(kDanceNoVoice, \
      "You are not in the voice chat.", \
      "No estás en el chat de voz.", \
      "Du bist nicht im Sprachchat.") \
  ROW(kDanceNobody, \
      "Nobody else is here yet.", \
      "Aún no hay nadie más.", \
      "Noch ist niemand sonst da.") \
  ROW(kDancePanel, "In the dance", "En el baile", "Beim Tanz") \
  ROW(kDancePicture, "Picture", "Foto", "Bild") \
  ROW(kDancePictureKept, "Picture saved: {}", "Foto guardada: {}", "Bild gespeichert: {}") \
  ROW(kDancePictureLost, \
      "Picture not saved: {}", \
      "Foto no guardada: {}", \
      "Bild nicht gespeichert: {}") \
  ROW(kDanceRecord, "Record", "Grabar", "Aufnehmen") \
  ROW(kDanceRecordEnds, "Saving...", "Guardando...", "Wird gespeichert ...") \
  ROW(kDanceRecordStop, "Stop  {}", "Parar  {}", "Stopp  {}") \
  ROW(kDanceRecordTo, "Recording to {}", "Se graba en {}", "Aufnahme nach {}") \
  ROW(kDanceRecorded, "Saved: {}", "Guardado: {}", "Gespeichert: {}") \
  ROW(kDanceRecordedBy, "Being recorded by {}", "Grabando: {}", "Aufnahme läuft: {}") \
  ROW(kDanceRemove, "Remove", "Expulsar", "Entfernen") \
  ROW(kDanceRemoveAsked, \
      "The server is asked to remove {}.", \
      "Se pide al servidor que saque a {}.", \
      "Der Server wird gebeten, {} zu entfernen.") \
  ROW(kDanceRemoveDone, \
      "{} was removed for 10 minutes.", \
      "{} ha sido expulsado por 10 minutos.", \
      "{} wurde für 10 Minuten entfernt.") \
  ROW(kDanceRemoveGone, \
      "{} is no longer in the room.", \
      "{} ya no está en la sala.", \
      "{} ist nicht mehr im Raum.") \
  ROW(kDanceRemoveMany, \
      "Too many at once: wait a little.", \
      "Demasiados a la vez: espera un poco.", \
      "Zu viele auf einmal: warte ein wenig.") \
  ROW(kDanceRemoveNot, \
      "Only a host may remove guests.", \
      "Solo un anfitrión puede expulsar.", \
      "Nur ein Gastgeber darf Gäste entfernen.") \
  ROW(kDanceRemoveOwn, \
      "{} dances in this house.", \
      "{} baila en esta casa.", \
      "{} tanzt in diesem Haus.") \
  ROW(kDanceRemovePassed, \
      "Sent to {}'s server.", \
      "Se avisó al servidor de {}.", \
      "An den Server von {} gesendet.") \
  ROW(kDanceRemoveSilent, \
      "The server did not answer.", \
      "El servidor no respondió.", \
      "Der Server hat nicht geantwortet.") \
  ROW(kDanceRemoveSure, \
      "Remove {} for 10 minutes?", \
      "¿Expulsar a {} por 10 minutos?", \
      "{} für 10 Minuten entfernen?") \
  ROW(kDanceRemoveUnheard, \
      "Your connection did not accept the request.", \
      "Tu conexión no aceptó la petición.", \
      "Deine Verbindung hat die Anfrage nicht angenommen.") \
  ROW(kDanceShow, "Show", "Mostrar", "Zeigen") \
  ROW(kDanceSlow, \
      "Slow picture, {} a second: no graphics card here.", \
      "Imagen lenta, {} por segundo: no hay tarjeta gráfica.", \
      "Langsames Bild, {} pro Sekunde: keine Grafikkarte.") \
  ROW(kDanceSlowPlain, \
      "Slow picture, {} a second. A smaller window helps.", \
      "Imagen lenta, {} por segundo. Una ventana más pequeña ayuda.", \
      "Langsames Bild, {} pro Sekunde. Ein kleineres Fenster hilft.") \
  ROW(kDanceSpeakerOff, "Loudspeaker off", "Altavoz apagado", "Lautsprecher aus") \
  ROW(kDanceSpeakerOn, "Loudspeaker on", "Altavoz encendido", "Lautsprecher an") \
  ROW(kDanceStay, "Stay", "Quedarse", "Bleiben") \
  ROW(kDanceTalkHint, "Hold B to talk", "Mantén B para hablar", "Zum Sprechen B halten") \
  ROW(kDanceTalks, "talking", "habla", "spricht") \
  ROW(kDanceTalking, "You are heard", "Se te oye", "Du wirst gehört") \
  ROW(kDanceTempo, "{} BPM", "{} BPM", "{} BPM") \
  ROW(kDanceUnmute, "Unmute", "Activar voz", "Stummschaltung aufheben") \
  ROW(kDanceUnmuteMe, "Unmute me", "Activar mi micrófono", "Mein Mikrofon einschalten") \
  ROW(kDanceUntitled, "Music without a title", "Música sin título", "Musik ohne Titel") \
  ROW(kDanceVolume, "voice {} %", "voz {} %", "Stimme {} %") \
  ROW(kDanceYou, "You", "Tú", "Du") \
  ROW(kDanceYours, "here with you", "aquí contigo", "hier bei dir") \
  ROW(kVoiceDeafened, \
      "Your loudspeaker is off. Press J first, to be heard.", \
      "Tienes el altavoz apagado. Pulsa J para que te oigan.", \
      "Dein Lautsprecher ist aus. Drücke erst J, damit man dich hört.") \
  ROW(kVoiceKeyNotNeeded, \
      "You can be heard without pressing the key.", \
      "Se te oye sin pulsar la tecla.", \
      "Man hört dich auch ohne die Taste.") \
  ROW(kVoiceMuted, \
      "You are muted. Press U first, to be heard.", \
      "Estás en silencio. Pulsa U para que te oigan.", \
      "Du bist stumm. Drücke erst U, damit man dich hört.") \
  ROW(kQualityFew, "only {} poses a second", "solo {} posturas por segundo", \
      "nur {} Posen pro Sekunde") \
  ROW(kQualityLate, "{} ms delay", "{} ms de retraso", "{} ms Verzögerung") \
  ROW(kQualityLatePredicted, "{} ms delay, predicted", \
      "{} ms de retraso, predicho", \
      "{} ms Verzögerung, vorhergesagt") \
  ROW(kQualityLoses, "{} % packet loss", "{} % de paquetes perdidos", "{} % Paketverlust") \
  ROW(kQualitySilent, "no data for {} s", "sin datos desde hace {} s", \
      "seit {} s keine Daten") \
  ROW(kQualityUneven, "{} ms jitter: shown later", \
      "{} ms de fluctuación: se muestra más tarde", \
      "{} ms Schwankung: wird später gezeigt")
// clang-format on
