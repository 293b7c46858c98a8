"""A display and a speaker in memory, for tests on this machine."""

import esphome.codegen as cg

memory_ns = cg.esphome_ns.namespace("memory")
