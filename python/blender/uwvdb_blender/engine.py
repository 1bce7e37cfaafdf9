"""The render engine: writes the scene, runs uwvdb, and hands its layers to Blender."""

import math
import os
import shutil
import tempfile
import time

import bpy
import numpy
from mathutils import Matrix

from . import bands as colours
from . import exr, motion, passes, preferences, program, scene as scenes, units, viewport
from .notes import Notes, Refusal
from .words import Words

# uwvdb counts frames from 0; movement is looked at a little before the frame, too.
FRAME_OFFSET = 10
MOTION_STEPS = 5
MOST_FRAMES_OPEN = 100_000  # of the shutter; Blender has no frames much farther away
PREVIEW_PART = 4  # of the image's sides
LEAST_PREVIEWED = 200 * 150
SECONDS_BETWEEN_LINES = 5
# How much, differs from frame to frame; it is said of the first.
LEFT_OUT = "single scattering leaves out"
TOO_DARK = "the picture is dark"
# Said of the keys of the file of meshes, which are where the shutter opens and closes.
OF_KEYS = "its keys are those of frames at"
DARK = 0.1  # of white

_said = set()  # notes of this render, of which an animation repeats most


@bpy.app.handlers.persistent
def _forget_notes(*_):
    _said.clear()


class Export:
    """A render that ends once the scene is written: Blender evaluates a scene for renders in these alone."""

    def __init__(self, path):
        self._path, self.commands = path, []

    def path_of(self, view):
        """The scene's file; each eye of a stereo pair has one."""
        stem, suffix = os.path.splitext(self._path)
        return f"{stem}_{view}{suffix}" if view else self._path


_export = None


def export(path):
    """Writes the scene of the frame, and returns the commands, by view, that render it as F12 does."""
    global _export
    _export = Export(path)
    try:
        bpy.ops.render.render()
        return _export.commands
    finally:
        _export = None


class UwvdbEngine(bpy.types.RenderEngine):
    bl_idname = "UWVDB"
    bl_label = "uwvdb"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_eevee_viewport = True  # for the shading Material Preview

    _told_at = 0.0  # when progress was shown
    _viewport = None
    _refusal = ""
    _words = Words()

    def __del__(self):
        if self._viewport is not None:
            self._viewport.close()

    def view_update(self, context, depsgraph):
        """A 3D view in Rendered shading begins, or the scene has changed."""
        try:
            if self._viewport is None:
                self._viewport = viewport.start(self)
            self._viewport.update(depsgraph)
            self._refusal = ""
        except Refusal as refusal:
            self._refusal = str(refusal)

    def view_draw(self, context, depsgraph):
        try:
            if self._viewport is not None and not self._refusal:
                self._viewport.draw(self, context, depsgraph)
        except Refusal as refusal:
            self.update_stats("uwvdb", str(refusal))
        if self._refusal:
            self.update_stats("uwvdb", self._refusal)

    def update_render_passes(self, scene=None, renderlayer=None):
        try:
            bands = colours.parse(scene.uwvdb.bands)
        except Refusal:
            bands = colours.RGB_BANDS
        lights = [scenes.lamps.plain_name(o.name) for o in scene.objects if o.type == "LIGHT"]
        for made in passes.passes_of(renderlayer, scene, bands, lights):
            self.register_pass(scene, renderlayer, made.name, len(made.channel_ids), made.channel_ids,
                               made.kind)

    def render(self, depsgraph):
        notes = Notes()
        folder = tempfile.mkdtemp(prefix="uwvdb-blender-")
        try:
            self._render(depsgraph, folder, notes)
        except program.Stopped:
            pass
        except Refusal as refusal:
            self.report({"ERROR"}, f"uwvdb: {self._words.why(refusal)}")
        except OSError as error:
            self.report({"ERROR"}, f"uwvdb: {error.filename}: cannot write: {error.strerror}")
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        for text in notes.texts:
            if text not in _said:
                _said.add(text)
                self.report({"WARNING"}, f"uwvdb: {text}")

    def _render(self, depsgraph, folder, notes):
        scene = depsgraph.scene
        self._words = Words(folder)
        if scene.camera is None:
            raise Refusal("the scene has no camera")
        path = program.find(preferences.chosen_program())
        size = (self.resolution_x, self.resolution_y)
        views = [v.name for v in scene.render.views if v.use] if scene.render.use_multiview else [""]
        for name in views:
            if name:
                self.active_view_set(name)
            part = os.path.join(folder, name or "image")
            os.mkdir(part)
            file = _export.path_of(name) if _export else os.path.join(part, scenes.SCENE_FILE)
            self.update_stats("", "uwvdb: writing the scene")
            view = self._view(depsgraph)
            moments = self._moments(depsgraph)
            written = scenes.write(depsgraph, file, path, view, size, moments, notes, self.test_break,
                                   self._on_progress)
            self._words = written.words
            if _export:
                image = os.path.splitext(written.path)[0] + ".exr"
                _export.commands.append(self._image_arguments(depsgraph, path, written, size, image))
                continue
            for made in passes.passes_of(depsgraph.view_layer, scene, written.bands,
                                         written.lamp_names):
                if made.name != "Combined":
                    self.add_pass(made.name, len(made.channel_ids), made.channel_ids,
                                  layer=depsgraph.view_layer.name)
            if scene.uwvdb.kept_in:
                _keep(part, scene, depsgraph.view_layer, name)
            if not bpy.app.background and preferences.wants_preview():
                self._show_preview(depsgraph, path, part, written, size, name)
            image = self._image(depsgraph, path, part, written, size, notes)
            _note_darkness(image, scene, notes)
            self._hand_over(depsgraph, written, image, name)

    def _view(self, depsgraph):
        camera = self.camera_override or depsgraph.scene.camera
        camera = camera.evaluated_get(depsgraph)
        matrix = Matrix([row[:] for row in _as_rows(self.camera_model_matrix(camera))])
        return scenes.View(camera, matrix, self.camera_shift_x(camera))

    def _moments(self, depsgraph):
        """Where everything is while the shutter is open, and in the next frames for the Vector pass;
        None if neither is asked for."""
        scene = depsgraph.scene
        render, now = scene.render, scene.frame_current + scene.frame_subframe
        offsets = set()
        centre = 0.0
        if render.use_motion_blur:
            if render.motion_blur_shutter > MOST_FRAMES_OPEN:
                raise Refusal(f"Render > Motion Blur > Shutter: {render.motion_blur_shutter:g} frames is longer than "
                              f"{MOST_FRAMES_OPEN}")
            centre = {"START": 0.5, "CENTER": 0.0, "END": -0.5}[_shutter_position(scene)]
            centre *= render.motion_blur_shutter
            offsets |= {centre + render.motion_blur_shutter * (step / (MOTION_STEPS - 1) - 0.5)
                        for step in range(MOTION_STEPS)}
        if passes.needs_flow(depsgraph.view_layer):
            offsets |= {centre - 1, centre, centre + 1}
        if not offsets:
            return None
        offsets = sorted(offsets)
        rate = scenes.frame_rate(scene)
        # On uwvdb's clock the shutter is open around the frame's moment.
        moments = motion.Motion([_number(scene) + offset - centre for offset in offsets], rate)
        to_metres = units.to_metres(scene)
        for at, offset in enumerate(offsets):
            frame = int((now + offset) // 1)
            self.frame_set(frame, now + offset - frame)
            moments.gather(depsgraph, at, to_metres @ self._view(depsgraph).matrix, to_metres)
        self.frame_set(int(now // 1), now - now // 1)
        return moments

    def _image(self, depsgraph, path, folder, written, size, notes):
        out = os.path.join(folder, "image.exr")
        arguments = self._image_arguments(depsgraph, path, written, size, out)
        for line in program.run(arguments, folder, self.test_break, self._on_progress):
            kind, _, text = line.partition(": ")
            if OF_KEYS not in text and (kind == "warning" or kind == "note" and not _has_said(LEFT_OUT)):
                notes.add(written.words.of(text))
        return exr.read(out)

    def _image_arguments(self, depsgraph, path, written, size, out):
        # A calibration has a size of its own.
        arguments = self._arguments(depsgraph, path, written, size, out) + ["--size", "{}x{}".format(*size)]
        settings = depsgraph.scene.uwvdb
        arguments += ["--quality", settings.quality.lower()]
        arguments += ["--layers", ",".join(passes.layers_of(depsgraph.view_layer, depsgraph.scene,
                                                               written.held_out))]
        if settings.integrator == "PATH" and settings.use_error:
            arguments += ["--error", repr(settings.error)]
        return arguments

    def _arguments(self, depsgraph, path, written, size, out):
        arguments = [path, "render", written.path, "-o", out, "--frames", str(_number(depsgraph.scene)),
                     "--compression", "none", "--precision", "float"]
        if depsgraph.scene.uwvdb.threads > 0:
            arguments += ["--threads", str(depsgraph.scene.uwvdb.threads)]
        render = depsgraph.scene.render
        if render.use_border:
            width, height = size
            left, right = int(render.border_min_x * width), int(render.border_max_x * width)
            low, high = int(render.border_min_y * height), int(render.border_max_y * height)
            arguments += ["--crop", f"{left},{height - high},{right},{height - low}"]
        return arguments

    def _on_progress(self, stage, fraction, seconds_left):
        self.update_progress(fraction)
        now = time.monotonic()
        # Without windows each of these is a line on the terminal.
        if not bpy.app.background or now - self._told_at > SECONDS_BETWEEN_LINES:
            self._told_at = now
            left = "" if seconds_left is None else f" | {_duration(seconds_left)} left"
            self.update_stats("", f"uwvdb: {stage}{left}")

    def _show_preview(self, depsgraph, path, folder, written, size, view):
        """A draft of a sixteenth of the pixels, shown until the image is there."""
        if size[0] * size[1] < LEAST_PREVIEWED or depsgraph.scene.render.use_border:
            return
        small = [max(side // PREVIEW_PART, 1) for side in size]
        out = os.path.join(folder, "preview.exr")
        arguments = self._arguments(depsgraph, path, written, size, out)
        arguments += ["--size", "{}x{}".format(*small), "--quality", "draft", "--integrator", "volume",
                      "--set", "render.scattering=single", "--samples", "1"]
        try:
            program.run(arguments, folder, self.test_break, lambda *_: None)
        except program.Failed:
            return  # The image itself will say why.
        rows = exr.read(out).get("", "RGBA")
        y = [at * small[1] // size[1] for at in range(size[1])]
        x = [at * small[0] // size[0] for at in range(size[0])]
        result = self.begin_result(0, 0, *size, layer=depsgraph.view_layer.name, view=view)
        _fill(result.layers[0].passes.find_by_name("Combined", view), rows[y][:, x])
        self.end_result(result)

    def _hand_over(self, depsgraph, written, image, view):
        size = (self.resolution_x, self.resolution_y)
        result = self.begin_result(0, 0, *size, layer=depsgraph.view_layer.name, view=view)
        for made in passes.passes_of(depsgraph.view_layer, depsgraph.scene, written.bands,
                                     written.lamp_names, written):
            values = made.make(image)
            target = result.layers[0].passes.find_by_name(made.name, view)
            if values is not None and target is not None:
                _fill(target, values)
        self.end_result(result)
        for field, text in passes.matte_texts(depsgraph.view_layer, image):
            self.get_result().stamp_data_add_field(field, text)


def _has_said(beginning):
    return any(text.startswith(beginning) for text in _said)


def _note_darkness(image, scene, notes):
    """Lamps lose most of their light under water, so that many a first picture is nearly black."""
    bright = numpy.percentile(image.get("", "RGB").max(axis=-1), 99)
    exposure = scene.view_settings.exposure
    if 0 < bright * 2**exposure < DARK and not _has_said(TOO_DARK):
        notes.add(f"{TOO_DARK}: Render > Color Management > Exposure {-math.log2(bright):.1f} shows it")


def _keep(folder, scene, view_layer, view):
    """Copies a scene's files to where the user wants to have them."""
    names = [f"{scene.frame_current:04d}", bpy.path.clean_name(view_layer.name)] + [view] * bool(view)
    target = os.path.join(bpy.path.abspath(scene.uwvdb.kept_in), "_".join(names))
    try:
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(folder, target, symlinks=True)
    except OSError as error:
        raise Refusal(f"Render > uwvdb > Keep Scenes In: {target}: {error.strerror}") from error


def _fill(target, rows_from_top):
    """Blender's rows begin at the bottom."""
    values = numpy.ascontiguousarray(rows_from_top[::-1], numpy.float32)
    try:
        target.rect.foreach_set(values.reshape(-1))
    except TypeError:  # Blender 3 wants as many items as pixels
        target.rect.foreach_set(values.reshape(-1, target.channels))


def _duration(seconds):
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = int(seconds // 60)
    return f"{minutes // 60} h {minutes % 60:02} min" if minutes >= 60 else f"{minutes} min"


def _number(scene):
    return max(scene.frame_current + FRAME_OFFSET, 1)


def _as_rows(matrix):
    """A matrix, or its 16 values column by column."""
    if len(matrix) == 4:
        return matrix
    return [[matrix[column * 4 + row] for column in range(4)] for row in range(4)]


def _shutter_position(scene):
    """Blender's own since 4.2, of Cycles before."""
    for source in (scene.render, getattr(scene, "cycles", None)):
        if hasattr(source, "motion_blur_position"):
            return source.motion_blur_position
    return "CENTER"


def register():
    bpy.utils.register_class(UwvdbEngine)
    bpy.app.handlers.render_init.append(_forget_notes)


def unregister():
    bpy.app.handlers.render_init.remove(_forget_notes)
    bpy.utils.unregister_class(UwvdbEngine)
