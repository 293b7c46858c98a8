"""ESPHome's component audio, for this machine too. The test copies its audio.h and audio.cpp here."""

import importlib.util
from pathlib import Path

import esphome
import esphome.config_validation as cv

_place = Path(esphome.__file__).parent / "components" / "audio" / "__init__.py"
_spec = importlib.util.spec_from_file_location("esphome_audio", _place)
_audio = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_audio)
globals().update({name: value for name, value in vars(_audio).items() if not name.startswith("__")})

# The original is for the ESP32 alone, and adds libraries of decoders.
AUTO_LOAD = []
CONFIG_SCHEMA = cv.Schema({})


async def to_code(config):
    pass
