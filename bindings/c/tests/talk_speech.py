"""Plays speech of espeak-ng to pantin_talk and prints how well the mouth follows it, against the phonemes' own times.

    talk_speech.py TALK.so
    talk_speech.py --say TEXT SOUND.pcm

Fails below what the README promises. Without espeak-ng's library it says so. The second form writes the sound of a text, and prints its rate and when each
phoneme begins and ends, in milliseconds.
"""
import array
import ctypes
import sys

SENTENCES = [
    "The quick brown fox jumps over the lazy dog, and Bob paid for a map.",
    "Peter picked up a purple pepper. Good morning, what may I do for you today?",
    "My mother moved the big blue boat, but nobody came home before Monday.",
    "Hello, my name is Pantin. People become a puppet.",
    "Maybe a map of the bottom, a plum and a bubble!",
    "How now brown cow? Papa bought a big apple pie.",
    "Five six seven, she sells sea shells by the shore. Moon, June, blue shoes.",
]
VOICES = ["en", "en-us", "en+f2", "en+f3", "en+m3", "en+m7", "en+croak"]

VISEMES = ["pp", "ff", "th", "dd", "kk", "ch", "ss", "nn", "rr", "aa", "e", "i", "o", "u"]
# How far each viseme opens the jaw.
JAW = {"aa": 1.0, "e": 0.8, "o": 0.8, "i": 0.3, "u": 0.3, "ss": 0.15}
FULL = 32768

# Phonemes by espeak-ng's mnemonics: the visemes that suit each.
VOWELS = {
    **dict.fromkeys(["aa", "a", "A:", "A@", "V", "a#", "0"], {"aa"}),
    **dict.fromkeys(["aI", "aU"], {"aa", "e", "o"}),
    **dict.fromkeys(["E", "e", "3:"], {"e"}),
    "eI": {"e", "i"},
    **dict.fromkeys(["i:", "I", "i", "I2", "I#"], {"i", "e"}),
    **dict.fromkeys(["O:", "O@", "o@", "O", "OI"], {"o", "aa"}),
    "oU": {"o", "u", "e"},
    **dict.fromkeys(["u:", "U", "w"], {"u", "o"}),
}
OPEN = {"aa", "a", "A:", "A@", "V", "a#", "0", "aI", "aU", "E", "e", "3:", "eI", "O:", "O@", "o@", "O", "OI", "oU"}
LIPS = {"p", "b", "m"}


class Event(ctypes.Structure):
    class Id(ctypes.Union):
        _fields_ = [("number", ctypes.c_int), ("name", ctypes.c_char_p), ("string", ctypes.c_char * 8)]

    _fields_ = [
        ("type", ctypes.c_int),
        ("identifier", ctypes.c_uint),
        ("text", ctypes.c_int),
        ("length", ctypes.c_int),
        ("ms", ctypes.c_int),
        ("sample", ctypes.c_int),
        ("user", ctypes.c_void_p),
        ("id", Id),
    ]


CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(Event))
PHONEME = 7


class Speaker:
    """espeak-ng, which gives sound and the times of its phonemes."""

    def __init__(self):
        self.library = ctypes.CDLL("libespeak-ng.so.1")
        # Sound is returned, and phonemes are events.
        self.rate = self.library.espeak_Initialize(1, 0, None, 1)
        self.callback = CALLBACK(self.receive)
        self.library.espeak_SetSynthCallback(self.callback)

    def receive(self, sound, count, events):
        index = 0
        while events[index].type != 0:
            if events[index].type == PHONEME:
                self.phonemes.append((events[index].ms, events[index].id.string.decode("utf-8", "replace")))
            index += 1
        if sound and count:
            self.samples.extend(sound[:count])
        return 0

    def say(self, voice, text):
        self.samples, self.phonemes = [], []
        self.library.espeak_SetVoiceByName(voice.encode())
        self.library.espeak_Synth(text.encode(), len(text) + 1, 0, 0, 0, 1, None, None)
        self.library.espeak_Synchronize()
        return self.samples, self.phonemes


def mouth(talk, samples, rate):
    """The weights after each 10 ms."""
    memory = (ctypes.c_uint32 * 256)()
    assert talk.pantin_talk_open(memory, rate) == 0
    sound = (ctypes.c_int16 * len(samples))(*samples)
    weights = ctypes.cast(memory, ctypes.POINTER(ctypes.c_uint16))
    hops, begin = [], 0
    for hop in range(1, len(samples) * 100 // rate + 1):
        end = hop * rate // 100
        talk.pantin_talk_push(memory, ctypes.byref(sound, 2 * begin), ctypes.c_size_t(end - begin))
        hops.append({name: weights[index] / FULL for index, name in enumerate(VISEMES)})
        begin = end
    return hops


def jaw(weights):
    return sum(weights[name] * part for name, part in JAW.items())


def loudness(samples, rate, begin, end):
    part = samples[max(0, int(begin * rate / 1000)) : max(0, int(end * rate / 1000))]
    return (sum(x * x for x in part) / len(part)) ** 0.5 if part else 0.0


def is_gap(samples, rate, begin, end):
    """Whether the lips can be heard to close: the sound is at most a quarter as loud as what is beside it."""
    gap = min(loudness(samples, rate, at, at + 15) for at in range(begin, max(end - 10, begin + 1), 5))
    near = max(loudness(samples, rate, begin - 60, begin - 20), loudness(samples, rate, end + 10, end + 50))
    return gap < near / 4


def say(text, path):
    try:
        speaker = Speaker()
    except OSError as error:
        print(f"espeak-ng's library is not here ({error})")
        return
    samples, phonemes = speaker.say("en", text)
    with open(path, "wb") as file:
        file.write(array.array("h", samples).tobytes())
    print(speaker.rate)
    ends = [ms for ms, _ in phonemes[1:]] + [len(samples) * 1000 // speaker.rate]
    for (begin, phoneme), end in zip(phonemes, ends):
        closed = phoneme in LIPS and is_gap(samples, speaker.rate, begin, end)
        kind = "closed" if closed else "open" if phoneme in OPEN and end - begin >= 50 else "other"
        print(begin, end, kind, phoneme)


def main():
    if sys.argv[1] == "--say":
        return say(sys.argv[2], sys.argv[3])
    talk = ctypes.CDLL(sys.argv[1])
    try:
        speaker = Speaker()
    except OSError as error:
        print(f"espeak-ng's library is not here ({error}): the mouth was not compared with speech")
        return
    suited, vowels, opened, late, gaps, closed = 0, 0, 0, [], 0, 0
    for voice in VOICES:
        for sentence in SENTENCES:
            samples, phonemes = speaker.say(voice, sentence)
            hops = mouth(talk, samples, speaker.rate)
            ends = [ms for ms, _ in phonemes[1:]] + [len(hops) * 10]
            for (begin, phoneme), end in zip(phonemes, ends):
                first, last = begin // 10, min(end // 10 + 3, len(hops) - 1)
                if last <= first:
                    continue
                if phoneme in VOWELS and end - begin >= 50:
                    middle = hops[min((begin + end) // 20 + 1, last)]
                    shown = max(middle, key=middle.get)
                    vowels += 1
                    suited += shown in VOWELS[phoneme] and middle[shown] > 0.15
                if phoneme in OPEN and end - begin >= 50:
                    jaws = [jaw(hop) for hop in hops[first : last + 1]]
                    opened += max(jaws) >= 0.35
                    half = next(index for index, value in enumerate(jaws) if value >= max(jaws) / 2)
                    late.append((first + half + 1) * 10 - begin)
                if phoneme in LIPS:
                    if is_gap(samples, speaker.rate, begin, end):
                        gaps += 1
                        closed += min(jaw(hop) for hop in hops[first : last + 1]) <= 0.1
    late.sort()
    print(f"{len(late)} open vowels: the jaw opens at {opened / len(late):.1%}, half open {sum(late) / len(late):.0f} ms after the start in the mean,")
    print(f"within 60 ms at {sum(ms <= 60 for ms in late) / len(late):.1%}, {late[-1]} ms at most")
    print(f"{gaps} gaps of p, b and m: closed at {closed / gaps:.1%}")
    print(f"{vowels} vowels: the viseme suits {suited / vowels:.1%}")
    assert len(late) > 200 and gaps > 200 and vowels > 500
    assert opened / len(late) >= 0.98
    assert sum(ms <= 60 for ms in late) / len(late) >= 0.98
    assert closed / gaps >= 0.96
    assert suited / vowels >= 0.75


main()
