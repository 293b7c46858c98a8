# Writes pantin_tables.py from the format's tables: python3 make_tables.py TABLES.json > pantin_tables.py
import json
import struct
import sys

tables = json.load(open(sys.argv[1]))
print("# Tables of the format, written by make_tables.py from tests/vectors/tables.json.")
for name in ["version", "listed", "start_mode", "first_step"]:
    print("%s = %d" % (name.upper(), tables[name]))
print("MAGIC = %r" % bytes(tables["magic"]))
for name in ["frame_rates", "lengths", "status_in", "mode_after", "number_in"]:
    print("%s = %r" % (name.upper(), bytes(tables[name])))
print("STEPS = %r" % (tuple(tables["steps"]),))
# Sizes of symbols, 16 bits each.
for name in ["status", "step_change", "position", "velocity", "mode", "number", "far"]:
    rows = tables[name]
    rows = rows if isinstance(rows[0], list) else [rows]
    packed = tuple(struct.pack("<%dH" % len(row), *row) for row in rows)
    print("%s = %r" % (name.upper(), packed if len(packed) > 1 else packed[0]))
print("LIVE_LINK = %r" % " ".join(tables["live_link"]))
