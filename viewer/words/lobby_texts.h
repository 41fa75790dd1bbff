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
      "That is no whole invitation. Copy all of the line that begins with dance://.", \
      "Eso no es una invitación completa. Copia toda la línea que empieza por dance://.", \
      "Das ist keine ganze Einladung. Kopiere die ganze Zeile, die mit dance:// beginnt.") \
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
      "Las flechas e Intro sirven en todo", \
      "Pfeiltasten und Eingabe gehen überall") \
  ROW(kLobbyYouTitle, \
      "How the others see you", \
      "Cómo te ven los demás", \
      "Wie dich die anderen sehen") \
  ROW(kLobbyDanceTitle, "With whom do you dance?", "¿Con quién bailas?", "Mit wem tanzt du?") \
  ROW(kLobbyHostTitle, \
      "A room on this computer", \
      "Una sala en este ordenador", \
      "Ein Raum auf diesem Rechner") \
  ROW(kLobbyYourName, "Your name", "Tu nombre", "Dein Name") \
  ROW(kLobbyNameRule, \
      "Small letters, digits and hyphens", \
      "Letras minúsculas, cifras y guiones", \
      "Kleinbuchstaben, Ziffern und Striche") \
  ROW(kLobbyYourHeight, "Your height", "Tu estatura", "Deine Größe") \
  ROW(kLobbyHeightNotSaid, \
      "as the camera sees it", \
      "según la cámara", \
      "wie die Kamera sie sieht") \
  ROW(kLobbyHeightMetres, "{} m", "{} m", "{} m") \
  ROW(kLobbyWhoDances, "Who dances for you?", "¿Quién baila por ti?", "Wer tanzt für dich?") \
  ROW(kLobbyFromCamera, "You, before a camera", "Tú, ante una cámara", "Du, vor einer Kamera") \
  ROW(kLobbyFromFile, "A recorded dance", "Un baile grabado", "Ein aufgenommener Tanz") \
  ROW(kLobbyFromHeadset, "You, with a headset", "Tú, con un visor", "Du, mit Headset") \
  ROW(kLobbyHeadsetHow, \
      "Join, then put it on. In it, look at the back of your left wrist for the panel.", \
      "Entra y póntelo. Dentro, mira el dorso de tu muñeca izquierda para ver el panel.", \
      "Tritt bei und setz es auf. Darin zeigt ein Blick aufs linke Handgelenk die Tafel.") \
  ROW(kLobbyNoHeadsetBuilt, \
      "This build knows no headsets.", \
      "Esta versión no conoce visores.", \
      "Diese Fassung kennt keine Headsets.") \
  ROW(kLobbyFromNobody, "A made-up dancer", "Un bailarín inventado", "Eine erfundene Figur") \
  ROW(kLobbyFromElsewhere, "As written in the file", "Como dice el archivo", "Wie in der Datei") \
  ROW(kLobbyLeads, "leads", "guía", "führt") \
  ROW(kLobbyFollows, "follows", "sigue", "folgt") \
  ROW(kLobbyFirstCamera, \
      "The first camera there is", \
      "La primera cámara que haya", \
      "Die erste Kamera, die da ist") \
  ROW(kLobbyLookAgain, "Look again", "Mirar otra vez", "Noch einmal suchen") \
  ROW(kLobbyNoCamera, \
      "There is no camera. Plug one in, or let a made-up dancer dance for you.", \
      "No hay ninguna cámara. Conecta una, o deja que baile por ti un bailarín inventado.", \
      "Hier ist keine Kamera. Schließe eine an, oder lass eine erfundene Figur für dich " \
      "tanzen.") \
  ROW(kLobbyNoCameraBuilt, \
      "This DanceGraph was made without cameras. Choose a recorded or a made-up dancer.", \
      "Este DanceGraph se hizo sin cámaras. Elige un baile grabado o un bailarín inventado.", \
      "Dieses DanceGraph kennt keine Kameras. Wähle einen aufgenommenen Tanz oder eine " \
      "erfundene Figur.") \
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
  ROW(kLobbyMannequin, "Mannequin", "Maniquí", "Gliederpuppe") \
  ROW(kLobbyOwnFigure, "One of your own…", "Una tuya…", "Eine eigene…") \
  ROW(kLobbyVoice, "Voice", "Voz", "Stimme") \
  ROW(kLobbyTalk, "Talk with the others", "Hablar con los demás", "Mit den anderen sprechen") \
  ROW(kLobbyHeadphones, "I wear headphones", "Llevo auriculares", "Ich trage Kopfhörer") \
  ROW(kLobbyYes, "Yes", "Sí", "Ja") \
  ROW(kLobbyNo, "No", "No", "Nein") \
  ROW(kLobbyMicrophone, "Microphone", "Micrófono", "Mikrofon") \
  ROW(kLobbyLoudspeaker, "Loudspeaker", "Altavoz", "Lautsprecher") \
  ROW(kLobbyUsualDevice, "The usual one", "El habitual", "Das übliche") \
  ROW(kLobbyNow, "Dance now", "Bailar ahora", "Gleich tanzen") \
  ROW(kLobbyAlone, "With a partner, alone", "A solas, con pareja", "Allein, mit Partner") \
  ROW(kLobbyAloneNote, \
      "A partner who is made up or recorded. Nobody else sees you.", \
      "Una pareja inventada o grabada. Nadie más te ve.", \
      "Ein erfundener oder aufgenommener Partner. Sonst sieht dich niemand.") \
  ROW(kLobbyPractise, "Practise", "Practicar", "Üben") \
  ROW(kLobbyPractiseNote, \
      "Your own music, and yourself as in a mirror.", \
      "Tu propia música, y tú como en un espejo.", \
      "Deine eigene Musik, und du wie im Spiegel.") \
  ROW(kLobbyPartner, "Your partner", "Tu pareja", "Dein Partner") \
  ROW(kLobbyRecordedPartner, "recorded…", "grabada…", "aufgenommen…") \
  ROW(kLobbyMusic, "Music", "Música", "Musik") \
  ROW(kLobbyNoMusic, "No music", "Sin música", "Keine Musik") \
  ROW(kLobbyMirror, "Before a mirror", "Ante un espejo", "Vor dem Spiegel") \
  ROW(kLobbyRooms, "Rooms you know", "Salas que conoces", "Räume, die du kennst") \
  ROW(kLobbyNoRooms, \
      "None yet: an invitation, or a room that you join, comes here.", \
      "Aún ninguna: aquí aparecen las salas a las que entras o te invitan.", \
      "Noch keiner: Einladungen und Räume, die du betrittst, stehen hier.") \
  ROW(kLobbyRoomAt, "{} at {}", "{} en {}", "{} bei {}") \
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
  ROW(kLobbyJoin, "Join", "Entrar", "Hinein") \
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
      "La sala está cerrada. Abierta, dura mientras esta ventana esté abierta.", \
      "Der Raum ist zu. Geöffnet bleibt er offen, solange dieses Fenster offen ist.") \
  ROW(kLobbyRoomOpening, "The room opens…", "La sala se abre…", "Der Raum öffnet…") \
  ROW(kLobbyRoomOpen, "The room is open.", "La sala está abierta.", "Der Raum ist offen.") \
  ROW(kLobbyReachedHere, \
      "Others in your home reach it at", \
      "Los de tu casa la encuentran en", \
      "Wer bei dir im Haus ist, findet ihn unter") \
  ROW(kLobbyReachedOutside, \
      "From elsewhere it is reached at your internet address. Your router must send UDP " \
      "port {} on to this computer, and a firewall here must let it in.", \
      "Desde fuera se llega por tu dirección de internet. Tu rúter debe pasar el puerto " \
      "UDP {} a este ordenador, y su cortafuegos debe dejarlo entrar.", \
      "Von außen erreicht man ihn unter deiner Internetadresse. Dein Router muss den " \
      "UDP-Port {} an diesen Rechner weitergeben, und die Firewall muss ihn hereinlassen.") \
  ROW(kLobbyWasReached, \
      "Someone from elsewhere has come in: the way from outside is open.", \
      "Alguien de fuera ha entrado: el camino desde fuera está abierto.", \
      "Von außen ist schon jemand gekommen: der Weg ist offen.") \
  ROW(kLobbyNotReached, \
      "Whether the way from outside is open shows when the first guest from elsewhere " \
      "comes in.", \
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
  ROW(kLobbyInvite, "Make an invitation", "Hacer una invitación", "Einladung machen") \
  ROW(kLobbyInvitationNote, \
      "Send this line to {} alone: it opens the room for one person.", \
      "Envía esta línea solo a {}: abre la sala a una persona.", \
      "Schicke diese Zeile nur an {}: sie öffnet den Raum für eine Person.") \
  ROW(kLobbyWithdraw, "Withdraw", "Retirar", "Zurückziehen") \
  ROW(kLobbyNoInvited, \
      "Nobody is invited yet.", \
      "Aún no hay invitados.", \
      "Noch ist niemand eingeladen.") \
  ROW(kLobbyShowCommand, "Show the command", "Ver la orden", "Befehl zeigen") \
  ROW(kLobbyHideCommand, "Hide the command", "Ocultar la orden", "Befehl verbergen") \
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
  ROW(kLobbyGoingIn, "Going in…", "Entrando…", "Es geht hinein…") \
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
  ROW(kLobbyNoKey, \
      "You have no invitation to {}. Ask the person who runs it for one.", \
      "No tienes invitación para {}. Pídesela a quien lo lleva.", \
      "Du hast keine Einladung für {}. Bitte die Person, die ihn betreibt, um eine.") \
  ROW(kLobbyNameTaken, \
      "Someone called {} is in the room already. Choose another name on the first page.", \
      "Ya hay alguien llamado {} en la sala. Elige otro nombre en la primera página.", \
      "Im Raum ist schon jemand, der {} heißt. Wähle auf der ersten Seite einen anderen " \
      "Namen.") \
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
      "Your invitation is not for this room or this name. Ask for another one.", \
      "Tu invitación no es para esta sala o este nombre. Pide otra.", \
      "Deine Einladung gilt nicht für diesen Raum oder Namen. Bitte um eine andere.") \
  ROW(kLobbyNotBegun, \
      "The dance did not begin. Try again.", \
      "El baile no ha empezado. Inténtalo otra vez.", \
      "Der Tanz hat nicht begonnen. Versuch es noch einmal.") \
  ROW(kLobbyDanceEnded, \
      "The dance ended by itself.", \
      "El baile terminó por sí solo.", \
      "Der Tanz endete von selbst.") \
  ROW(kLobbySettingsBroken, \
      "What was chosen could not be read. The old file was kept as {}.", \
      "No se pudo leer lo elegido. El archivo anterior quedó como {}.", \
      "Was gewählt war, ließ sich nicht lesen. Die alte Datei heißt jetzt {}.") \
  ROW(kLobbyNotSaved, \
      "What you choose cannot be kept.", \
      "Lo que eliges no se puede guardar.", \
      "Was du wählst, lässt sich nicht behalten.") \
  ROW(kLobbyNoGraphics, \
      "There is no graphics card here: pictures are plain, and slow in a large window.", \
      "Aquí no hay tarjeta gráfica: la imagen es sencilla, y lenta en una ventana grande.", \
      "Hier ist keine Grafikkarte: Bilder sind einfach, und in einem großen Fenster " \
      "langsam.") \
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
      "Die Einladung ließ sich nicht machen.")
// clang-format on
