"""A display in memory."""

import esphome.codegen as cg
from esphome.components import display
import esphome.config_validation as cv
from esphome.const import CONF_HEIGHT, CONF_ID, CONF_LAMBDA, CONF_TYPE, CONF_WIDTH

from .. import memory_ns

MemoryDisplay = memory_ns.class_("MemoryDisplay", display.Display)

CONFIG_SCHEMA = display.FULL_DISPLAY_SCHEMA.extend(
    {
        cv.GenerateID(): cv.declare_id(MemoryDisplay),
        cv.Required(CONF_WIDTH): cv.int_range(1, 2047),
        cv.Required(CONF_HEIGHT): cv.int_range(1, 2047),
        cv.Optional(CONF_TYPE, default="color"): cv.one_of("color", "binary"),
    }
)


async def to_code(config):
    kind = cg.RawExpression(f"display::DISPLAY_TYPE_{config[CONF_TYPE].upper()}")
    var = cg.new_Pvariable(config[CONF_ID], config[CONF_WIDTH], config[CONF_HEIGHT], kind)
    await display.register_display(var, config)
    if CONF_LAMBDA in config:
        writer = await cg.process_lambda(config[CONF_LAMBDA], [(display.DisplayRef, "it")], return_type=cg.void)
        cg.add(var.set_writer(writer))
