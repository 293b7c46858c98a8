# Writes pantin_emotes_data.py from the emotes' clips: python3 make_emotes.py ../../firmware/face/emotes > pantin_emotes_data.py
import os
import sys

print("# The 23 emotes as clips, written by make_emotes.py from firmware/face/emotes.")
print("EMOTES = {")
for name in sorted(os.listdir(sys.argv[1])):
    with open(os.path.join(sys.argv[1], name), "rb") as file:
        print("    %r: %r," % (name[: -len(".ptn")], file.read()))
print("}")
