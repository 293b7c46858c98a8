"""A speaker in memory."""

import esphome.codegen as cg
from esphome.components import audio, speaker
import esphome.config_validation as cv
from esphome.const import CONF_ID

from .. import memory_ns

MemorySpeaker = memory_ns.class_("MemorySpeaker", cg.Component, speaker.Speaker)


def _set_stream_limits(config):
    audio.set_stream_limits(
        min_bits_per_sample=16, max_bits_per_sample=16, min_channels=1, max_channels=2, min_sample_rate=8000, max_sample_rate=48000
    )(config)
    return config


CONFIG_SCHEMA = cv.All(
    speaker.SPEAKER_SCHEMA.extend({cv.GenerateID(): cv.declare_id(MemorySpeaker)}).extend(cv.COMPONENT_SCHEMA),
    _set_stream_limits,
)


async def to_code(config):
    var = cg.new_Pvariable(config[CONF_ID])
    await cg.register_component(var, config)
    await speaker.register_speaker(var, config)
