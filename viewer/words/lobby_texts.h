// The texts of the window before the dance (lobby/), as rows of viewer/words/text_table.h.
//
// Ownership: constants.
// Threads:   any.
// Failure:   as viewer/words/text_table.h.
#pragma once

// clang-format off
#define DANCE_LOBBY_TEXTS(ROW) \
  ROW(kLobbyYou, "You", "Tú", "Du") \
  ROW(kLobbyDance, "Dance", "Bailar", "Tanzen") \
  ROW(kLobbyInvitation, "An invitation", "Una invitación", "Eine Einladung") \
  ROW(kLobbyInvitationPaste, \
      "Paste the line that you were sent: dance://…", \
      "Pega la línea que te enviaron: dance://…", \
      "Füge die Zeile ein, die du bekommen hast: dance://…") \
  ROW(kLobbyPaste, "Paste", "Pegar", "Einfügen") \
  ROW(kLobbyOpenInvitation, "Open and dance", "Abrir y bailar", "Öffnen und tanzen") \
  ROW(kLobbyInvitationBad, \
      "This invitation is incomplete. Copy all of the line that begins with dance://.", \
      "Esta invitación está incompleta. Copia toda la línea que empieza por dance://.", \
      "Diese Einladung ist unvollständig. Kopiere die ganze Zeile, die mit dance:// beginnt.") \
  ROW(kLobbyInvitationFailed, \
      "The invitation could not be opened. Ask the person who sent it for another.", \
      "No se pudo abrir la invitación. Pide otra a quien te la envió.", \
      "Die Einladung ließ sich nicht öffnen. Bitte die Person, die sie geschickt hat, um " \
      "eine neue.") \
  ROW(kLobbyTestSound, "Test the sound", "Probar el sonido", "Ton prüfen") \
  ROW(kLobbyEndTestSound, "End the test", "Terminar la prueba", "Prüfung beenden") \
  ROW(kLobbyPlayCountIn, "Play a count-in", "Oír una entrada", "Einzähler abspielen") \
  ROW(kLobbyHost, "Host a room", "Abrir una sala", "Raum öffnen") \
  ROW(kLobbyKeysHint, \
      "Arrow keys and Enter work everywhere", \
      "Todo se maneja también con las flechas e Intro", \
      "Alles geht auch mit Pfeiltasten und Eingabe") \
  ROW(kLobbyYouTitle, \
      "How the others see you", \
      "Cómo te ven los demás", \
      "Wie dich die anderen sehen") \
  ROW(kLobbyDanceTitle, "Who are you dancing with?", "¿Con quién bailas?", "Mit wem tanzt du?") \
  ROW(kLobbyHostTitle, \
      "A room on this computer", \
      "Una sala en este ordenador", \
      "Ein Raum auf diesem Rechner") \
  ROW(kLobbyYourName, "Your name", "Tu nombre", "Dein Name") \
  ROW(kLobbyYourId, "ID in rooms: {}", "Tu ID en las salas: {}", "Kennung in Räumen: {}") \
  ROW(kLobbyYourHeight, "Your height", "Tu estatura", "Deine Größe") \
  ROW(kLobbyHeightNotSaid, \
      "as the camera sees it", \
      "según la cámara", \
      "wie die Kamera sie sieht") \
  ROW(kLobbyHeightMetres, "{} m", "{} m", "{} m") \
  ROW(kLobbyWhoDances, \
      "How do you want to dance?", \
      "¿Cómo quieres bailar?", \
      "Wie möchtest du tanzen?") \
  ROW(kLobbyFromCamera, "Me, with my camera", "Yo, con mi cámara", "Ich, mit meiner Kamera") \
  ROW(kLobbyFromFile, "A recorded dance", "Un baile grabado", "Ein aufgenommener Tanz") \
  ROW(kLobbyFromHeadset, "Me, with my headset", "Yo, con mi visor", "Ich, mit meinem Headset") \
  ROW(kLobbyHeadsetHow, \
      "Join, then put it on. In it, look at the back of your left wrist for the panel.", \
      "Entra y póntelo. Dentro, mira el dorso de tu muñeca izquierda para ver el panel.", \
      "Tritt bei und setz es auf. Darin zeigt ein Blick aufs linke Handgelenk die Tafel.") \
  ROW(kLobbyNoHeadset, \
      "No headset is ready. Start its program (SteamVR, Monado or WiVRn), then look again.", \
      "No hay ningún visor listo. Inicia su programa (SteamVR, Monado o WiVRn) y busca de nuevo.", \
      "Kein Headset ist bereit. Starte sein Programm (SteamVR, Monado oder WiVRn) und suche " \
      "noch einmal.") \
  ROW(kLobbyOnlyWatch, "Only watch", "Solo mirar", "Nur zusehen") \
  ROW(kLobbyOnlyWatchNote, \
      "You see the others dance; nothing of you is sent.", \
      "Ves bailar a los demás; no se envía nada tuyo.", \
      "Du siehst die anderen tanzen; von dir wird nichts gesendet.") \
  ROW(kLobbyVideoFile, "A video…", "Un vídeo…", "Ein Video…") \
  ROW(kLobbyMicrophoneUnreachable, \
      "Your microphone cannot be reached: the others would not hear you.", \
      "No se puede acceder a tu micrófono: los demás no te oirían.", \
      "Dein Mikrofon ist nicht erreichbar: Die anderen würden dich nicht hören.") \
  ROW(kLobbyWithoutVoice, "Dance without voice", "Bailar sin voz", "Ohne Stimme tanzen") \
  ROW(kLobbyNoHeadsetBuilt, \
      "This version has no headset support.", \
      "Esta versión no admite visores.", \
      "Diese Version unterstützt keine Headsets.") \
  ROW(kLobbyFromNobody, "A virtual dancer", "Un bailarín virtual", "Eine virtuelle Figur") \
  ROW(kLobbyFromElsewhere, "As written in the file", "Como dice el archivo", "Wie in der Datei") \
  ROW(kLobbyAnyRole, "either role", "cualquier rol", "beide Rollen") \
  ROW(kLobbyLeads, "leads", "guía", "führt") \
  ROW(kLobbyFollows, "follows", "sigue", "folgt") \
  ROW(kLobbyFirstCamera, \
      "The first camera there is", \
      "La primera cámara que haya", \
      "Die erste Kamera, die da ist") \
  ROW(kLobbyLookAgain, "Look again", "Buscar de nuevo", "Noch einmal suchen") \
  ROW(kLobbyNoCamera, \
      "There is no camera. Plug one in, or let a virtual dancer dance for you.", \
      "No hay ninguna cámara. Conecta una, o deja que baile por ti un bailarín virtual.", \
      "Hier ist keine Kamera. Schließe eine an, oder lass eine virtuelle Figur für dich " \
      "tanzen.") \
  ROW(kLobbyNoCameraBuilt, \
      "This DanceGraph was made without cameras. Choose a recorded dance or a virtual dancer.", \
      "Este DanceGraph se hizo sin cámaras. Elige un baile grabado o un bailarín virtual.", \
      "Dieses DanceGraph kennt keine Kameras. Wähle einen aufgenommenen Tanz oder eine " \
      "virtuelle Figur.") \
  ROW(kLobbyCameraTaken, \
      "The camera {} cannot be used: another program has it, or it is not yours to use. " \
      "Close that program, then look again.", \
      "La cámara {} no se puede usar: otro programa la tiene, o no tienes permiso. Cierra " \
      "ese programa y mira otra vez.", \
      "Die Kamera {} ist belegt oder gesperrt. Schließe das Programm, das sie benutzt, und " \
      "suche noch einmal.") \
  ROW(kLobbyChooseFile, "Choose a file…", "Elegir un archivo…", "Datei wählen…") \
  ROW(kLobbyNothingChosen, \
      "Nothing chosen yet", \
      "Aún no has elegido nada", \
      "Noch nichts gewählt") \
  ROW(kLobbyYourFigure, "Your figure", "Tu figura", "Deine Figur") \
  ROW(kLobbyMannequin, "Default figure", "Figura estándar", "Standardfigur") \
  ROW(kLobbyOwnFigure, "One of your own…", "Una tuya…", "Eine eigene…") \
  ROW(kLobbyVoice, "Voice", "Voz", "Stimme") \
  ROW(kLobbyTalk, "Talk with the others", "Hablar con los demás", "Mit den anderen sprechen") \
  ROW(kLobbyHeadphones, "I wear headphones", "Llevo auriculares", "Ich trage Kopfhörer") \
  ROW(kLobbyYes, "Yes", "Sí", "Ja") \
  ROW(kLobbyNo, "No", "No", "Nein") \
  ROW(kLobbyMicrophone, "Microphone", "Micrófono", "Mikrofon") \
  ROW(kLobbyLoudspeaker, "Loudspeaker", "Altavoz", "Lautsprecher") \
  ROW(kLobbyUsualDevice, "Default", "Predeterminado", "Standard") \
  ROW(kLobbyDanceNow, "Dance now", "Bailar ya", "Jetzt tanzen") \
  ROW(kLobbyAloneNote, \
      "With a virtual or recorded partner. Nobody else sees you.", \
      "Con una pareja virtual o grabada. Nadie más te ve.", \
      "Mit einem virtuellen oder aufgenommenen Partner. Sonst sieht dich niemand.") \
  ROW(kLobbyPractise, "Practise", "Practicar", "Üben") \
  ROW(kLobbyPractiseNote, \
      "Your own music, and yourself as in a mirror.", \
      "Tu propia música, y tú como en un espejo.", \
      "Deine eigene Musik, und du wie im Spiegel.") \
  ROW(kLobbyPartner, "Your partner", "Tu pareja", "Dein Partner") \
  ROW(kLobbyRecordedPartner, "recorded…", "grabada…", "aufgenommen…") \
  ROW(kLobbyMusic, "Music", "Música", "Musik") \
  ROW(kLobbyNoMusic, "No music", "Sin música", "Keine Musik") \
  ROW(kLobbyMusicSeeks, \
      "The song starts right away. Finding its beat can take half a minute.", \
      "La canción empieza enseguida. Detectar su ritmo puede tardar medio minuto.", \
      "Das Lied beginnt sofort. Es kann eine halbe Minute dauern, bis sein Takt erkannt ist.") \
  ROW(kLobbyMirror, "Mirror view", "Vista de espejo", "Spiegelansicht") \
  ROW(kLobbyRooms, "Rooms you know", "Salas que conoces", "Räume, die du kennst") \
  ROW(kLobbyNoRooms, \
      "None yet: an invitation, or a room that you join, comes here.", \
      "Aún ninguna: aquí aparecen las salas a las que entras o te invitan.", \
      "Noch keiner: Einladungen und Räume, die du betrittst, stehen hier.") \
  ROW(kLobbyRoomAt, "{} at {}", "{} en {}", "{} bei {}") \
  ROW(kLobbyOwnRoom, "{}, your room", "{}, tu sala", "{}, dein Raum") \
  ROW(kLobbyOwnRoomClosed, "closed", "cerrada", "geschlossen") \
  ROW(kLobbyOpenIt, "Open it", "Abrirla", "Öffnen") \
  ROW(kLobbyRoomNotOpen, \
      "The room {} does not answer. It is probably not open.", \
      "La sala {} no responde. Seguramente no está abierta.", \
      "Der Raum {} antwortet nicht. Wahrscheinlich ist er nicht geöffnet.") \
  ROW(kLobbyTryAnyway, "Try anyway", "Intentarlo de todos modos", "Trotzdem versuchen") \
  ROW(kLobbyAsking, "asking…", "preguntando…", "wird gefragt…") \
  ROW(kLobbySilent, "does not answer", "no responde", "antwortet nicht") \
  ROW(kLobbyNear, "near: {} ms", "cerca: {} ms", "nah: {} ms") \
  ROW(kLobbyFar, "far: {} ms", "lejos: {} ms", "fern: {} ms") \
  ROW(kLobbyThere, "In the room: {}", "En la sala: {}", "Im Raum: {}") \
  ROW(kLobbyThereMore, \
      "In the room: {} and {} more", \
      "En la sala: {} y {} más", \
      "Im Raum: {} und {} weitere") \
  ROW(kLobbyThereNobody, "Nobody is there.", "No hay nadie.", "Niemand ist da.") \
  ROW(kLobbyThereNoKey, \
      "You have no key to this room: ask for an invitation.", \
      "No tienes clave para esta sala: pide una invitación.", \
      "Du hast keinen Schlüssel für diesen Raum: bitte um eine Einladung.") \
  ROW(kLobbyThereRefused, \
      "Your key cannot be used here, or the server does not let you in.", \
      "Tu clave no sirve aquí, o el servidor no te deja entrar.", \
      "Dein Schlüssel gilt hier nicht, oder der Server lässt dich nicht hinein.") \
  ROW(kLobbyInvitationFirst, \
      "An invitation opens once. You will see who is in the room after that.", \
      "Una invitación se abre una sola vez. Después verás quién está en la sala.", \
      "Eine Einladung lässt sich einmal öffnen. Danach siehst du, wer im Raum ist.") \
  ROW(kLobbyAskJoin, \
      "Join {} on {} as {}?", \
      "¿Entrar en {}, en {}, como {}?", \
      "Dem Raum {} auf {} als {} beitreten?") \
  ROW(kLobbyAskMotion, \
      "The others receive your motion, but not your voice.", \
      "Los demás reciben tus movimientos, pero no tu voz.", \
      "Die anderen bekommen deine Bewegungen, aber nicht deine Stimme.") \
  ROW(kLobbyAskWatch, \
      "You only watch and listen; nothing of you is sent.", \
      "Solo miras y escuchas; no se envía nada tuyo.", \
      "Du siehst und hörst nur zu; von dir wird nichts gesendet.") \
  ROW(kLobbyAskMotionAndVoice, \
      "The others receive your motion and your voice.", \
      "Los demás reciben tus movimientos y tu voz.", \
      "Die anderen bekommen deine Bewegungen und deine Stimme.") \
  ROW(kLobbyAskNewKey, \
      "Careful: this server has another key than the one you joined before, so it may be " \
      "another machine. Join only if its host told you that the key has changed.", \
      "Cuidado: este servidor tiene otra clave que aquel en el que entraste, así que puede ser " \
      "otra máquina. Entra solo si quien lo lleva te dijo que la clave ha cambiado.", \
      "Vorsicht: Dieser Server hat einen anderen Schlüssel als der bisherige und ist vielleicht " \
      "ein anderer Rechner. Tritt nur bei, wenn der Gastgeber dir den Wechsel bestätigt hat.") \
  ROW(kLobbyAskNew, \
      "Until you join, camera and microphone stay off and nothing is sent.", \
      "Hasta que entres, la cámara y el micrófono siguen apagados y no se envía nada.", \
      "Bis du beitrittst, bleiben Kamera und Mikrofon aus, und nichts wird gesendet.") \
  ROW(kLobbyJoin, "Join", "Entrar", "Beitreten") \
  ROW(kLobbyForget, "Forget", "Olvidar", "Vergessen") \
  ROW(kLobbyAskAgain, "Ask again", "Preguntar otra vez", "Noch einmal fragen") \
  ROW(kLobbyOtherRoom, "Another room", "Otra sala", "Ein anderer Raum") \
  ROW(kLobbyServer, "Server", "Servidor", "Server") \
  ROW(kLobbyRoom, "Room", "Sala", "Raum") \
  ROW(kLobbyNoRoomYet, \
      "Say which room: its name, and the server it is on, as dance.example.org.", \
      "Di qué sala: su nombre y el servidor en que está, como dance.example.org.", \
      "Sag, welcher Raum: sein Name und der Server, auf dem er ist, wie dance.example.org.") \
  ROW(kLobbyOpenRoom, "Open the room", "Abrir la sala", "Raum öffnen") \
  ROW(kLobbyCloseRoom, "Close the room", "Cerrar la sala", "Raum schließen") \
  ROW(kLobbyRoomClosed, \
      "The room is closed. Opened, it lasts as long as this window.", \
      "La sala está cerrada. Una vez abierta, se cierra al cerrar esta ventana.", \
      "Der Raum ist geschlossen. Er bleibt offen, bis du dieses Fenster schließt.") \
  ROW(kLobbyRoomOpening, "Opening the room…", "Abriendo la sala…", "Raum wird geöffnet…") \
  ROW(kLobbyRoomOpen, "The room is open.", "La sala está abierta.", "Der Raum ist offen.") \
  ROW(kLobbyReachedHere, \
      "Guests on your network use", \
      "Desde tu propia red se entra por", \
      "Im eigenen Netz erreichbar unter") \
  ROW(kLobbyReachedOutside, \
      "From elsewhere it is reached at your internet address. Your router must send UDP " \
      "port {} on to this computer, and a firewall here must let it in.", \
      "Desde fuera se llega por tu dirección de internet. Tu router debe redirigir el puerto " \
      "UDP {} a este ordenador y el cortafuegos debe permitirlo.", \
      "Von außen erreicht man ihn unter deiner Internetadresse. Dein Router muss den " \
      "UDP-Port {} an diesen Rechner weitergeben, und die Firewall muss ihn hereinlassen.") \
  ROW(kLobbyWasReached, \
      "Someone from elsewhere has come in: the way from outside is open.", \
      "Alguien de fuera ha entrado: el camino desde fuera está abierto.", \
      "Von außen ist schon jemand gekommen: der Weg ist offen.") \
  ROW(kLobbyNotReached, \
      "You will know that guests from elsewhere can reach you when the first one joins.", \
      "Si el camino desde fuera está abierto se verá cuando entre la primera persona de " \
      "fuera.", \
      "Ob der Weg von außen offen ist, zeigt sich, wenn der erste Gast von außen kommt.") \
  ROW(kLobbyWhoIsHere, "Who is here", "Quién está", "Wer da ist") \
  ROW(kLobbyNobodyHere, "Nobody yet", "Aún nadie", "Noch niemand") \
  ROW(kLobbyInvitations, "Invitations", "Invitaciones", "Einladungen") \
  ROW(kLobbyGuestName, "For whom?", "¿Para quién?", "Für wen?") \
  ROW(kLobbyHostAddress, \
      "Your address, as guests reach you", \
      "Tu dirección para los invitados", \
      "Deine Adresse für die Gäste") \
  ROW(kLobbyInvite, "Make an invitation", "Hacer una invitación", "Einladung erstellen") \
  ROW(kLobbyInvitationNote, \
      "Send this line to {} alone: it opens the room for one person.", \
      "Envía esta línea solo a {}: abre la sala a una persona.", \
      "Schicke diese Zeile nur an {}: sie öffnet den Raum für eine Person.") \
  ROW(kLobbyWithdraw, "Withdraw", "Retirar", "Zurückziehen") \
  ROW(kLobbyInvitedUntil, \
      "not used yet, open until {}", \
      "aún sin usar, vale hasta {}", \
      "noch nicht benutzt, gilt bis {}") \
  ROW(kLobbyInvitationUsed, "has come in", "ya ha entrado", "war schon da") \
  ROW(kLobbyInvitationUsedUntil, \
      "has come in; may come back until {}", \
      "ya ha entrado; puede volver hasta {}", \
      "war schon da; darf bis {} wiederkommen") \
  ROW(kLobbyInvitationExpired, "expired", "caducada", "abgelaufen") \
  ROW(kLobbyInviteSelf, \
      "You are {} yourself: your guest needs another name.", \
      "{} eres tú: tu invitado necesita otro nombre.", \
      "{} bist du selbst: Dein Gast braucht einen anderen Namen.") \
  ROW(kLobbyNoInvited, \
      "Nobody is invited yet.", \
      "Aún no hay invitados.", \
      "Noch ist niemand eingeladen.") \
  ROW(kLobbyShowCommand, "Show the command", "Ver el comando", "Befehl zeigen") \
  ROW(kLobbyHideCommand, "Hide the command", "Ocultar el comando", "Befehl verbergen") \
  ROW(kLobbyCommandNote, \
      "The same, in a terminal:", \
      "Lo mismo, en una terminal:", \
      "Dasselbe, im Terminal:") \
  ROW(kLobbyCopy, "Copy", "Copiar", "Kopieren") \
  ROW(kLobbyClose, "Close", "Cerrar", "Schließen") \
  ROW(kLobbyUp, "Folder above", "Carpeta superior", "Ordner darüber") \
  ROW(kLobbyEmptyFolder, \
      "Nothing of that kind in this folder.", \
      "No hay nada de eso en esta carpeta.", \
      "In diesem Ordner ist nichts davon.") \
  ROW(kLobbyGoingIn, "Joining…", "Entrando…", "Beitreten…") \
  ROW(kLobbyGoingInNote, \
      "The first time takes some seconds.", \
      "La primera vez tarda unos segundos.", \
      "Beim ersten Mal dauert es einige Sekunden.") \
  ROW(kLobbyCancel, "Cancel", "Cancelar", "Abbrechen") \
  ROW(kLobbyServerSilent, \
      "{} does not answer. Is it running, is the name right, and is your network up?", \
      "{} no responde. ¿Está en marcha, es correcto el nombre y funciona tu red?", \
      "{} antwortet nicht. Läuft er, stimmt der Name, und steht dein Netz?") \
  ROW(kLobbyKeyRefused, \
      "{} does not know you. Ask the person who runs it for a new invitation.", \
      "{} no te conoce. Pide otra invitación a quien lo lleva.", \
      "{} kennt dich nicht. Bitte die Person, die ihn betreibt, um eine neue Einladung.") \
  ROW(kLobbyServerKeyChanged, \
      "{} has another key than before and may be another machine. Ask the person who runs it; " \
      "if the key has changed, open a new invitation.", \
      "{} tiene otra clave que antes y puede ser otra máquina. Pregunta a quien lo lleva; si " \
      "ha cambiado, abre una invitación nueva.", \
      "{} hat einen anderen Schlüssel als bisher und ist vielleicht ein anderer Rechner. Frage " \
      "die Person, die ihn betreibt; wenn er sich geändert hat, öffne eine neue Einladung.") \
  ROW(kLobbyKeyExpired, \
      "Your invitation to {} has expired. Ask the person who runs it for a new one.", \
      "Tu invitación para {} ha caducado. Pide otra a quien lo lleva.", \
      "Deine Einladung für {} ist abgelaufen. Bitte die Person, die ihn betreibt, um eine neue.") \
  ROW(kLobbyKeyBusy, \
      "Your key for {} is in use too often. Close another dance that uses it, then try again.", \
      "Tu clave para {} se usa en demasiados sitios. Cierra otro baile e inténtalo de nuevo.", \
      "Dein Schlüssel für {} ist zu oft in Gebrauch. Beende einen anderen Tanz damit.") \
  ROW(kLobbyNoKey, \
      "You have no invitation to {}. Ask the person who runs it for one.", \
      "No tienes invitación para {}. Pídesela a quien te invitó.", \
      "Du hast keine Einladung für {}. Bitte die Person, die ihn betreibt, um eine.") \
  ROW(kLobbyNameTaken, \
      "{} is already in the room, perhaps from another of your computers. Try again to join as " \
      "well.", \
      "{} ya está en la sala, quizá desde otro ordenador tuyo. Inténtalo otra vez para entrar " \
      "también.", \
      "{} ist schon im Raum, vielleicht von einem anderen deiner Rechner aus. Versuche es noch " \
      "einmal, um auch von hier beizutreten.") \
  ROW(kLobbyRoomFull, \
      "The room is full. Wait until someone leaves, or join another.", \
      "La sala está llena. Espera a que salga alguien, o entra en otra.", \
      "Der Raum ist voll. Warte, bis jemand geht, oder nimm einen anderen.") \
  ROW(kLobbyVersions, \
      "That server is of another version. Update DanceGraph, here or there.", \
      "Ese servidor es de otra versión. Actualiza DanceGraph, aquí o allí.", \
      "Der Server hat eine andere Version. Aktualisiere DanceGraph, hier oder dort.") \
  ROW(kLobbyMicrophoneSilent, \
      "Your microphone could not be used: the others do not hear you.", \
      "No se pudo usar tu micrófono: los demás no te oyen.", \
      "Dein Mikrofon ging nicht: die anderen hören dich nicht.") \
  ROW(kLobbyFileUnreadable, \
      "The file could not be used. Choose another on the first page.", \
      "No se pudo usar el archivo. Elige otro en la primera página.", \
      "Die Datei war nicht zu gebrauchen. Wähle auf der ersten Seite eine andere.") \
  ROW(kLobbyRemoved, \
      "A host has asked you to leave this room for a while. Talk to the host.", \
      "Un anfitrión te ha pedido que dejes esta sala un rato. Habla con el anfitrión.", \
      "Ein Gastgeber hat dich gebeten, den Raum für eine Weile zu verlassen. Sprich mit ihm.") \
  ROW(kLobbyNotForYou, \
      "Your invitation is for another room, or for another guest. Ask for one of your own.", \
      "Tu invitación es para otra sala o para otra persona. Pide una para ti.", \
      "Deine Einladung gilt für einen anderen Raum oder jemand anderen. Bitte um eine eigene.") \
  ROW(kLobbyNotBegun, \
      "The dance did not begin. Try again.", \
      "El baile no ha empezado. Inténtalo otra vez.", \
      "Der Tanz hat nicht begonnen. Versuch es noch einmal.") \
  ROW(kLobbyDanceEnded, \
      "The dance ended by itself.", \
      "El baile terminó por sí solo.", \
      "Der Tanz endete von selbst.") \
  ROW(kLobbySettingsBroken, \
      "Your settings could not be read. The old file was kept as {}.", \
      "No se pudieron leer tus ajustes. El archivo anterior quedó como {}.", \
      "Deine Einstellungen ließen sich nicht lesen. Die alte Datei heißt jetzt {}.") \
  ROW(kLobbyNotSaved, \
      "Your settings cannot be saved.", \
      "Tus ajustes no se pueden guardar.", \
      "Deine Einstellungen lassen sich nicht speichern.") \
  ROW(kLobbyNoGraphics, \
      "There is no graphics card here: pictures are plain, and slow in a large window.", \
      "Aquí no hay tarjeta gráfica: la imagen es sencilla, y lenta en una ventana grande.", \
      "Hier ist keine Grafikkarte: Das Bild ist vereinfacht und ruckelt in großen Fenstern.") \
  ROW(kLobbyPortTaken, \
      "Port {} is taken: perhaps a room is open here already, in another window.", \
      "El puerto {} está ocupado: quizá ya hay una sala abierta en otra ventana.", \
      "Port {} ist belegt: vielleicht ist hier schon ein Raum offen, in einem anderen " \
      "Fenster.") \
  ROW(kLobbyRoomFailed, \
      "The room could not be opened.", \
      "No se pudo abrir la sala.", \
      "Der Raum ließ sich nicht öffnen.") \
  ROW(kLobbyInviteFailed, \
      "The invitation could not be made.", \
      "No se pudo hacer la invitación.", \
      "Die Einladung ließ sich nicht erstellen.")
// clang-format on
