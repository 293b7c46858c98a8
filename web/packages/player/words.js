// What <pantin-player> says in other languages: of the nearest element with a `lang`.
export const WORDS = {
  de: {
    figure: "bewegte Figur", play: "Abspielen", pause: "Anhalten", full: "Vollbild", time: "Zeit", of: "von", seconds: "Sekunden", bytes: "Bytes", frames: "Bilder", first: "die erste Pose fehlt noch",
    "no Pantin clip": "Dies ist kein Pantin-Clip.", "another version of the format": "Der Clip hat eine andere Version des Formats.", "ends early": "Der Clip endet zu früh.",
    "wrong checksum": "Der Clip ist beschädigt: Eine Prüfsumme stimmt nicht.", "the rig is another file": "Das Skelett des Clips liegt in einer anderen Datei.",
  },
  ru: {
    figure: "движущаяся фигура", play: "Воспроизвести", pause: "Пауза", full: "Во весь экран", time: "Время", of: "из", seconds: "секунд", bytes: "байт", frames: "кадров", first: "первой позы ещё нет",
    "no Pantin clip": "Это не клип Pantin.", "another version of the format": "Клип другой версии формата.", "ends early": "Клип обрывается.",
    "wrong checksum": "Клип повреждён: контрольная сумма не совпадает.", "the rig is another file": "Скелет клипа — в другом файле.",
  },
};
