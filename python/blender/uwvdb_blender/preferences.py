"""Preferences of the add-on."""

import bpy
from bpy.props import BoolProperty, StringProperty

from . import program
from .notes import Refusal


class UwvdbPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The program uwvdb; empty: the one on PATH")
    preview: BoolProperty(
        name="Preview while rendering", default=True,
        description="Show a draft of a sixteenth of the pixels until the image is there")

    def draw(self, context):
        self.layout.prop(self, "program")
        try:
            self.layout.label(text=f"Found: {program.find(self.program)}", icon="CHECKMARK")
        except Refusal as missing:
            self.layout.label(text=str(missing), icon="ERROR")
        self.layout.prop(self, "preview")


def _own():
    found = bpy.context.preferences.addons.get(__package__)
    return found.preferences if found is not None else None


def chosen_program():
    own = _own()
    return own.program if own is not None else ""


def wants_preview():
    own = _own()
    return own is None or own.preview


def register():
    bpy.utils.register_class(UwvdbPreferences)


def unregister():
    bpy.utils.unregister_class(UwvdbPreferences)
