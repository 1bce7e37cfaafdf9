"""File > Export > uwvdb Scene: the scene of the frame as files, for the program and for render farms."""

import json
import os
import shlex
import shutil

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from . import engine


class UWVDB_OT_export(bpy.types.Operator, ExportHelper):
    bl_idname = "export_scene.uwvdb"
    bl_label = "Export uwvdb Scene"
    bl_description = ("Write this frame as F12 renders it: a scene file, and beside it its meshes and "
                      "volumes")
    bl_options = {"PRESET"}

    filename_ext = ".yaml"
    filter_glob: StringProperty(default="*.yaml", options={"HIDDEN"})
    copies: BoolProperty(
        name="Copy Volumes", default=False,
        description="Copy VDB files into the folder, to take it to other machines, instead of linking "
                    "them")

    @classmethod
    def poll(cls, context):
        if context.scene.render.engine == "UWVDB":
            return True
        cls.poll_message_set("Choose uwvdb as the render engine first")
        return False

    def execute(self, context):
        try:
            commands = engine.export(bpy.path.abspath(self.filepath))
            if self.copies:
                for command in commands:
                    _copy_volumes(command[2])
        except RuntimeError as error:  # what the render has said
            self.report({"ERROR"}, str(error).strip())
            return {"CANCELLED"}
        except OSError as error:
            self.report({"ERROR"}, f"uwvdb: {error.filename}: {error.strerror}")
            return {"CANCELLED"}
        for command in commands:
            self.report({"INFO"}, f"uwvdb: exported; this renders it: {shlex.join(command)}")
        return {"FINISHED"} if commands else {"CANCELLED"}


def _copy_volumes(scene_file):
    """Puts the files that a scene's links lead to in their places."""
    with open(scene_file, encoding="utf-8") as file:
        volumes = json.load(file).get("volumes", ())
    for volume in volumes:
        link = os.path.join(os.path.dirname(scene_file), volume["file"])
        if os.path.islink(link):
            shutil.copyfile(link, link + ".new")
            os.replace(link + ".new", link)


def _draw_menu(menu, context):
    menu.layout.operator(UWVDB_OT_export.bl_idname, text="uwvdb Scene (.yaml)")


def register():
    bpy.utils.register_class(UWVDB_OT_export)
    bpy.types.TOPBAR_MT_file_export.append(_draw_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(_draw_menu)
    bpy.utils.unregister_class(UWVDB_OT_export)
