"""A talking face for ESPHome's displays."""

import re
from pathlib import Path

from esphome import automation
import esphome.codegen as cg
from esphome.components import display
from esphome.components.const import BYTE_ORDER_LITTLE, CONF_BYTE_ORDER
import esphome.config_validation as cv
from esphome.core import Lambda
import esphome.final_validate as fv
from esphome.const import (
    CONF_DISPLAY_ID,
    CONF_FILE,
    CONF_HEIGHT,
    CONF_ID,
    CONF_LEVEL,
    CONF_MODEL,
    CONF_NAME,
    CONF_RAW_DATA_ID,
    CONF_WIDTH,
    CONF_X,
    CONF_Y,
)

CODEOWNERS = []
DEPENDENCIES = ["display"]
MULTI_CONF = True

CONF_CLIP = "clip"
CONF_CLIPS = "clips"
CONF_EMOTE = "emote"
CONF_TRANSITION = "transition"
CONF_WIDGET = "widget"

pantin_ns = cg.esphome_ns.namespace("pantin")
Face = pantin_ns.class_("Face", cg.Component)
EmoteAction = pantin_ns.class_("EmoteAction", automation.Action, cg.Parented.template(Face))
LevelAction = pantin_ns.class_("LevelAction", automation.Action, cg.Parented.template(Face))
PlayAction = pantin_ns.class_("PlayAction", automation.Action, cg.Parented.template(Face))
LookAction = pantin_ns.class_("LookAction", automation.Action, cg.Parented.template(Face))

# Arrays of pantin_face_data.h and pantin_face_themes.h.
MODELS = {"cartoon": "pantin_cartoon", "eyes": "pantin_eyes", "minimal": "pantin_minimal"}


def _emotes():
    """The names in the C library's list of emotes."""
    header = Path(__file__).with_name("pantin_face_data.h")
    if not header.is_file():
        raise cv.Invalid(
            f"{header.name} is missing beside pantin's __init__.py: use the folder that `cargo xtask esphome` writes"
        )
    return re.findall(r'\{"(\w+)", pantin_emote_', header.read_text(encoding="utf-8"))


def emote(value):
    """Validates the name of an emote."""
    return cv.one_of(*_emotes(), lower=True)(value)


def widget(value):
    """Validates the id of a widget of LVGL, which is loaded only if it is used."""
    from esphome.components.lvgl.types import lv_obj_base_t

    return cv.use_id(lv_obj_base_t)(cv.requires_component("lvgl")(value))


def face_id(value):
    """Refuses an id that is a name of the C library: the generated program declares both."""
    if isinstance(value, str) and value.startswith("pantin_"):
        raise cv.Invalid(f"'{value}' may be a name of the C library: choose an id that does not start with pantin_")
    return value


def clip_file(value):
    """Validates the path of a clip, of which the first bytes are looked at. The face itself checks all of it, and says in the log what is damaged."""
    path = cv.file_(value)
    head = path.read_bytes()[:3]
    if head[:2] != b"Pn":
        raise cv.Invalid(f"{value} is not a clip: `pantin convert MOTION --segments -o CLIP.ptn` writes one")
    if head[2:] != b"\x01":
        raise cv.Invalid(f"{value} is a key clip, or of another version: convert its motion with --segments")
    return path


CLIP_SCHEMA = cv.Schema(
    {
        cv.Required(CONF_NAME): cv.string_strict,
        cv.Required(CONF_FILE): clip_file,
        cv.GenerateID(CONF_RAW_DATA_ID): cv.declare_id(cg.uint8),
    }
)


def clips(value):
    """A mapping of names to files, or the list that it becomes. Two clips of one name are refused."""
    if isinstance(value, dict):
        value = [{CONF_NAME: name, CONF_FILE: file} for name, file in value.items()]
    value = cv.ensure_list(CLIP_SCHEMA)(value)
    names = [clip[CONF_NAME] for clip in value]
    if len(set(names)) < len(names):
        raise cv.Invalid("two clips have the same name")
    return value


CONFIG_SCHEMA = cv.All(
    cv.Schema(
        {
            cv.GenerateID(): cv.All(face_id, cv.declare_id(Face)),
            cv.Required(CONF_WIDTH): cv.int_range(min=1, max=2047),
            cv.Required(CONF_HEIGHT): cv.int_range(min=1, max=2047),
            cv.Optional(CONF_MODEL, default="cartoon"): cv.one_of(*MODELS, lower=True),
            cv.Optional(CONF_EMOTE, default="neutral"): emote,
            cv.Optional(CONF_TRANSITION, default="300ms"): cv.All(
                cv.positive_time_period_milliseconds, cv.Range(max=cv.TimePeriod(milliseconds=65535))
            ),
            cv.Optional(CONF_CLIPS, default=[]): clips,
            cv.Optional(CONF_DISPLAY_ID): cv.use_id(display.Display),
            cv.Optional(CONF_WIDGET): widget,
            cv.Optional(CONF_X, default=0): cv.int_range(min=-2047, max=2047),
            cv.Optional(CONF_Y, default=0): cv.int_range(min=-2047, max=2047),
        }
    ).extend(cv.COMPONENT_SCHEMA),
    cv.has_at_most_one_key(CONF_DISPLAY_ID, CONF_WIDGET),
)


def _played(config, face):
    """Yields the clips that `pantin.play` names for a face, anywhere in a configuration."""
    if isinstance(config, dict):
        action = config.get("pantin.play")
        if isinstance(action, dict) and action.get(CONF_ID) == face and not isinstance(action[CONF_CLIP], Lambda):
            yield action[CONF_CLIP]
        config = config.values()
    if not isinstance(config, str):
        for part in config if hasattr(config, "__iter__") else ():
            yield from _played(part, face)


def _final_validate(config):
    """Checks the names of clips that are played, and that nothing else draws on a display to which the face sends its rows; finds the byte order of its
    pixels."""
    names = [clip[CONF_NAME] for clip in config[CONF_CLIPS]]
    for name in _played(fv.full_config.get(), config[CONF_ID]):
        if name not in names:
            there = ", ".join(names) or "none"
            raise cv.Invalid(f"pantin.play: the face has no clip '{name}'; under {CONF_CLIPS} it has {there}", [CONF_CLIPS])
    if CONF_WIDGET in config:
        from esphome.components.lvgl.defines import add_lv_use

        # LVGL's image needs labels.
        add_lv_use("image", "label")
    if CONF_DISPLAY_ID not in config:
        return config
    data = display.get_display_metadata(config[CONF_DISPLAY_ID])
    if data.has_writer:
        raise cv.Invalid(
            f"With {CONF_DISPLAY_ID} the face draws on this display itself: remove lambda, pages, show_test_card and "
            f"auto_clear_enabled from the display, or {CONF_DISPLAY_ID} from the face and draw it in the lambda",
            [CONF_DISPLAY_ID],
        )
    if data.byte_order is not cv.UNDEFINED:
        config[CONF_BYTE_ORDER] = data.byte_order
    return config


FINAL_VALIDATE_SCHEMA = _final_validate


async def to_code(config):
    model = cg.RawExpression(MODELS[config[CONF_MODEL]])
    size = cg.RawExpression(f"sizeof({model})")
    var = cg.new_Pvariable(config[CONF_ID], config[CONF_WIDTH], config[CONF_HEIGHT], model, size)
    await cg.register_component(var, config)
    cg.add(var.set_initial_emote(config[CONF_EMOTE]))
    cg.add(var.set_transition(config[CONF_TRANSITION]))
    for clip in config[CONF_CLIPS]:
        data = clip[CONF_FILE].read_bytes()
        array = cg.static_const_array(clip[CONF_RAW_DATA_ID], cg.ArrayInitializer(*data))
        cg.add(var.add_clip(clip[CONF_NAME], array, len(data)))
    if CONF_DISPLAY_ID in config:
        panel = await cg.get_variable(config[CONF_DISPLAY_ID])
        # A display that states no byte order takes either, or the one that is usual.
        big_endian = config.get(CONF_BYTE_ORDER) != BYTE_ORDER_LITTLE
        cg.add(var.set_display(panel, config[CONF_X], config[CONF_Y], big_endian))
    if CONF_WIDGET in config:
        from esphome.components.lvgl.widgets import get_widgets, wait_for_widgets

        parent = (await get_widgets(config, CONF_WIDGET))[0]
        await wait_for_widgets()
        cg.add(var.set_widget(parent.obj, config[CONF_X], config[CONF_Y]))


@automation.register_action(
    "pantin.emote",
    EmoteAction,
    cv.maybe_simple_value(
        {
            cv.GenerateID(): cv.use_id(Face),
            cv.Required(CONF_EMOTE): cv.templatable(emote),
        },
        key=CONF_EMOTE,
    ),
    synchronous=True,
)
async def emote_to_code(config, action_id, template_arg, args):
    var = cg.new_Pvariable(action_id, template_arg)
    await cg.register_parented(var, config[CONF_ID])
    cg.add(var.set_emote(await cg.templatable(config[CONF_EMOTE], args, cg.std_string)))
    return var


@automation.register_action(
    "pantin.play",
    PlayAction,
    cv.maybe_simple_value(
        {
            cv.GenerateID(): cv.use_id(Face),
            cv.Required(CONF_CLIP): cv.templatable(cv.string_strict),
        },
        key=CONF_CLIP,
    ),
    synchronous=True,
)
async def play_to_code(config, action_id, template_arg, args):
    var = cg.new_Pvariable(action_id, template_arg)
    await cg.register_parented(var, config[CONF_ID])
    cg.add(var.set_clip(await cg.templatable(config[CONF_CLIP], args, cg.std_string)))
    return var


@automation.register_action(
    "pantin.level",
    LevelAction,
    cv.maybe_simple_value(
        {
            cv.GenerateID(): cv.use_id(Face),
            cv.Required(CONF_LEVEL): cv.templatable(cv.percentage),
        },
        key=CONF_LEVEL,
    ),
    synchronous=True,
)
async def level_to_code(config, action_id, template_arg, args):
    var = cg.new_Pvariable(action_id, template_arg)
    await cg.register_parented(var, config[CONF_ID])
    cg.add(var.set_level(await cg.templatable(config[CONF_LEVEL], args, cg.float_)))
    return var


@automation.register_action(
    "pantin.look",
    LookAction,
    cv.Schema(
        {
            cv.GenerateID(): cv.use_id(Face),
            cv.Optional(CONF_X, default=0.0): cv.templatable(cv.float_range(min=-1.0, max=1.0)),
            cv.Optional(CONF_Y, default=0.0): cv.templatable(cv.float_range(min=-1.0, max=1.0)),
        }
    ),
    synchronous=True,
)
async def look_to_code(config, action_id, template_arg, args):
    var = cg.new_Pvariable(action_id, template_arg)
    await cg.register_parented(var, config[CONF_ID])
    cg.add(var.set_x(await cg.templatable(config[CONF_X], args, cg.float_)))
    cg.add(var.set_y(await cg.templatable(config[CONF_Y], args, cg.float_)))
    return var
