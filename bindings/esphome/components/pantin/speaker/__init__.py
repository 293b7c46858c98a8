"""A speaker that passes sound on to another one, and moves a face's lips as it is played."""

import esphome.codegen as cg
from esphome.components import audio, speaker
import esphome.config_validation as cv
from esphome.const import (
    CONF_BITS_PER_SAMPLE,
    CONF_BUFFER_DURATION,
    CONF_ID,
    CONF_NUM_CHANNELS,
    CONF_OUTPUT_SPEAKER,
    CONF_SAMPLE_RATE,
)
from esphome.core.entity_helpers import inherit_property_from

from .. import Face, face_id, pantin_ns

AUTO_LOAD = ["audio"]
CODEOWNERS = []

CONF_FACE_ID = "face_id"

FaceSpeaker = pantin_ns.class_("FaceSpeaker", cg.Component, speaker.Speaker, cg.Parented.template(Face))


def _set_stream_limits(config):
    audio.set_stream_limits(min_bits_per_sample=16, max_bits_per_sample=32)(config)
    return config


CONFIG_SCHEMA = cv.All(
    speaker.SPEAKER_SCHEMA.extend(
        {
            cv.GenerateID(): cv.All(face_id, cv.declare_id(FaceSpeaker)),
            cv.GenerateID(CONF_FACE_ID): cv.use_id(Face),
            cv.Required(CONF_OUTPUT_SPEAKER): cv.use_id(speaker.Speaker),
            cv.Optional(CONF_BUFFER_DURATION, default="700ms"): cv.All(
                cv.positive_time_period_milliseconds,
                cv.Range(min=cv.TimePeriod(milliseconds=100), max=cv.TimePeriod(milliseconds=5000)),
            ),
        }
    ).extend(cv.COMPONENT_SCHEMA),
    _set_stream_limits,
)


def _final_validate(config):
    """Takes the format of sound from the output speaker, which plays it unchanged."""
    for key in [CONF_BITS_PER_SAMPLE, CONF_NUM_CHANNELS, CONF_SAMPLE_RATE]:
        inherit_property_from(key, CONF_OUTPUT_SPEAKER)(config)
    audio.final_validate_audio_schema(
        "pantin speaker",
        audio_device=CONF_OUTPUT_SPEAKER,
        bits_per_sample=config.get(CONF_BITS_PER_SAMPLE, cv.UNDEFINED),
        channels=config.get(CONF_NUM_CHANNELS, cv.UNDEFINED),
        sample_rate=config.get(CONF_SAMPLE_RATE, cv.UNDEFINED),
    )(config)


FINAL_VALIDATE_SCHEMA = _final_validate


async def to_code(config):
    var = cg.new_Pvariable(config[CONF_ID])
    await cg.register_component(var, config)
    await speaker.register_speaker(var, config)
    await cg.register_parented(var, config[CONF_FACE_ID])
    cg.add(var.set_output_speaker(await cg.get_variable(config[CONF_OUTPUT_SPEAKER])))
    cg.add(var.set_buffer_duration(config[CONF_BUFFER_DURATION]))
