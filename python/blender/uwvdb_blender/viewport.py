"""The rendered 3D view: what of the scene has changed is described anew, and the pictures of a Session
are drawn as they come."""

import weakref

import bpy
import gpu
from gpu_extras.presets import draw_texture_2d
from mathutils import Matrix, Vector

from . import bakes, cameras, features, meshes, preferences, program, scene as scenes, units, volumes
from .notes import Notes, Refusal
from .session import Session
from .words import Words

SECONDS_BETWEEN_LOOKS = 0.02
SECONDS_OF_READING = 0.008  # at a time, between two drawings of the view
SECONDS_OF_FIRST_READING = 0.05  # the sooner there is a picture
# Kinds of data that surfaces are made of; where objects are is compared besides.
OF_SURFACES = ("MESH", "CURVE", "META", "FONT", "MATERIAL", "IMAGE", "NODETREE", "TEXTURE", "PARTICLE",
               "COLLECTION")
STEPS = {"first": "single scattering first", "small": "draft", "draft": "draft",
         "full-draft": "full size", "final": ""}


class Frame:
    """What a 3D view shows: a `camera` for the scene, and the rectangle (x, y, width, height) of the region
    that its picture fills."""

    def __init__(self, camera, rectangle):
        self.camera, self.rectangle = camera, rectangle


def frame_of(depsgraph, region_size, view, through_camera, notes, pixel_size=1):
    """The Frame of a 3D view, whose matrices `view` (a RegionView3D) has. Through the camera its frame shows
    what a render does, housing and all."""
    scene = depsgraph.scene
    to_metres = units.to_metres(scene)
    width, height = region_size
    if not through_camera or scene.camera is None:
        size = [max(side // pixel_size, 1) for side in region_size]
        return Frame(cameras.of_view(view.window_matrix, view.view_matrix, size, to_metres),
                     (0, 0, width, height))
    camera = scene.camera.evaluated_get(depsgraph)
    corners = [view.window_matrix @ view.view_matrix @ camera.matrix_world.normalized()
               @ Vector((*corner, 1)) for corner in camera.data.view_frame(scene=scene)]
    x = [(corner.x / corner.w + 1) * width / 2 for corner in corners]
    y = [(corner.y / corner.w + 1) * height / 2 for corner in corners]
    rectangle = (min(x), min(y), max(x) - min(x), max(y) - min(y))
    # However far the frame is zoomed in, there are no more pixels than the view has.
    scale = min(1, width / rectangle[2], height / rectangle[3]) / pixel_size
    size = [max(round(side * scale), 1) for side in rectangle[2:]]
    world_from_camera = to_metres @ camera.matrix_world
    described = cameras.describe(depsgraph, camera, size, to_metres, world_from_camera,
                                 camera.data.shift_x, notes)
    described["pose"] = {"matrix": cameras.pose_rows(world_from_camera)}
    if camera.data.uwvdb.use_sensor:
        notes.add("the camera's sensor is left out")
    return Frame(described, rectangle)


class Surroundings:
    """The scene but for its camera, described anew where Blender says that it has changed."""

    def __init__(self, session, program_path):
        self._session, self._program = session, program_path
        self._places, self._settings, self._number = {}, None, 0
        self._entries = self._meshes = None  # of the scene's `geometry`; (name, gltf.Glb)
        self._keys = []                      # of the file's nodes, by which their places are known
        self._unfinished = None              # the meshes.MeshFile that is being read
        self._known = {}                     # what it read of objects that do not change
        self._bake_error = ""
        self._baking, self._failed = None, set()  # a bakes.InBackground, and digests of what could not be baked
        self._mesh_notes, self._notes, self._content = Notes(), Notes(), {}
        self.words = Words()

    @property
    def notes(self):
        return self._mesh_notes.texts + self._notes.texts

    @property
    def meshes(self):
        return self._meshes

    @property
    def is_reading(self):
        return self._unfinished is not None

    def update(self, depsgraph):
        """Looks at the scene again. If is_reading then, read_on() is to be called until it is not."""
        self._update_surfaces(depsgraph)
        self._notes = Notes()
        plumes = volumes.Volumes(self._session.folder, self._notes,
                                 lambda source: volumes.advice_soon(self._program, source))
        content, self.words = scenes.describe_water_and_lamps(depsgraph, self._session.folder, None, plumes,
                                                              self._notes)
        camera = depsgraph.scene.camera
        features.note_all(depsgraph, self._notes, camera and camera.evaluated_get(depsgraph), None, is_view=True)
        content["render"] = self._render(depsgraph.scene)
        self._content = content

    @property
    def is_baking(self):
        return self._baking is not None

    def has_baked(self):
        """Whether a bake has ended since: then the surfaces are to be looked at again."""
        if self._baking is None or not self._baking.is_done:
            return False
        if self._baking.error:
            self._failed |= self._baking.work.digests
            self._bake_error = self._baking.error
        self._baking, self._settings = None, None
        return True

    def close(self):
        if self._baking is not None:
            self._baking.cancel()

    def _bakes(self, depsgraph):
        """What is baked of the scene now; of the rest a bake begins."""
        settings = depsgraph.scene.uwvdb
        baked = bakes.Bakes(settings.bake_size, settings.threads, self._mesh_notes)
        missing = [job for job in baked.look(depsgraph) if job.digest not in self._failed]
        if self._bake_error:
            self._mesh_notes.add(self._bake_error)
        if missing and self._baking is None:
            work = bakes.Work(missing)
            try:
                work.hand_over(depsgraph.scene, settings.threads)
                self._baking = bakes.InBackground(work)
            except bakes.FAILURES as error:
                self._failed |= work.digests
                self._mesh_notes.add(f"{work.names} could not be baked: {error}")
                work.close()
        baked.find()
        return baked

    def with_camera(self, camera):
        geometry = {"geometry": self._entries} if self._entries else {}
        return {"uwvdb": 2, "camera": camera, **self._content, **geometry}

    def read_on(self, depsgraph):
        """Reads the next of the meshes, so few of them that Blender is not held up."""
        seconds = SECONDS_OF_FIRST_READING if self._entries is None else SECONDS_OF_READING
        if not self._unfinished.read_some(depsgraph, seconds):
            return
        made, self._unfinished = self._unfinished, None
        made.add_all(depsgraph, units.to_metres(depsgraph.scene), None)
        self._keys = made.keys
        names = {key[0] for key in made.keys}
        self._known = {name: corners for name, corners in self._known.items() if name in names}
        self._name_meshes(depsgraph.scene, made.glb)

    def _update_surfaces(self, depsgraph):
        scene = depsgraph.scene
        places = {meshes.key_of(instance): instance.matrix_world.copy().freeze()
                  for instance in meshes.surfaces(depsgraph)}
        settings = (scene.uwvdb.use_gloss, units.metres_per_unit(scene), scene.uwvdb.bands,
                    scene.uwvdb.bake_size)
        are_others = (settings != self._settings or places.keys() != self._places.keys()
                      or any(map(depsgraph.id_type_updated, OF_SURFACES))
                      or any(isinstance(update.id, bpy.types.Object) and update.is_updated_geometry
                             and update.id.type in meshes.SURFACES for update in depsgraph.updates))
        for update in depsgraph.updates:
            if isinstance(update.id, bpy.types.Object) and update.is_updated_geometry:
                self._known.pop(update.id.name_full, None)
        if are_others or self._unfinished is not None:
            self._mesh_notes = Notes()
            self._unfinished = meshes.MeshFile(self._mesh_notes, self._known, self._bakes(depsgraph))
            self.read_on(depsgraph)
        elif places != self._places and self._keys:
            to_metres = units.to_metres(scene)
            self._name_meshes(scene, self._meshes[1].moved([to_metres @ places[key] for key in self._keys]))
        self._places, self._settings = places, settings

    def _name_meshes(self, scene, glb):
        """Under a name of its own each time, since the program compares what the scene's text says."""
        self._number += 1
        name = f"meshes{self._number}.glb"
        self._meshes = (name, glb) if self._keys else None
        self._entries = [scenes.geometry_entry(scene, name)] if self._keys else None

    def _render(self, scene):
        settings = scene.uwvdb
        render = {"integrator": "volume", "fps": scenes.frame_rate(scene),
                  "scattering": settings.scattering.lower()}
        if settings.integrator == "PATH":
            render["scattering"] = "multiple"
        if settings.integrator != "VOLUME":
            self._notes.add("the viewport's integrator is Volume")
        elif settings.samples > 0:
            render["samples"] = settings.samples
        if scene.render.use_motion_blur:
            self._notes.add("motion blur is left out")
        return render


class Viewport:
    """What a render engine has for a 3D view of its own."""

    def __init__(self, engine, program_path):
        self._session = Session(program_path)
        self._surroundings = Surroundings(self._session, program_path)
        self._engine = weakref.ref(engine)
        self._shown = self._texture = self._rectangle = None
        self._seen, self._drawn, self._was_asking, self._is_new = 0, 0, False, True
        bpy.app.timers.register(self._look)

    def close(self):
        """Ends the process; returns at once."""
        self._session.close()
        self._surroundings.close()
        if bpy.app.timers.is_registered(self._look):
            bpy.app.timers.unregister(self._look)

    def update(self, depsgraph):
        self._surroundings.update(depsgraph)
        self._is_new = True
        self._was_asking = program.is_asking()

    def draw(self, engine, context, depsgraph):
        """Draws the newest picture, and asks for another one if the view shows something else now."""
        region, view = context.region, context.region_data
        notes = Notes()
        pixel_size = depsgraph.scene.render.preview_pixel_size
        frame = frame_of(depsgraph, (region.width, region.height), view,
                         view.view_perspective == "CAMERA", notes,
                         1 if pixel_size == "AUTO" else int(pixel_size))
        if self._surroundings.is_reading:
            self._surroundings.read_on(depsgraph)
        elif self._is_new or frame.camera != self._shown:
            self._shown, self._is_new = frame.camera, False
            self._session.show(self._surroundings.with_camera(frame.camera), self._surroundings.words,
                               self._surroundings.meshes)
        picture = self._session.picture
        if picture is not None:
            if self._drawn is not picture:
                height, width = picture.rows.shape[:2]
                data = gpu.types.Buffer("FLOAT", picture.rows.size, picture.rows.reshape(-1))
                self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=data)
                self._drawn = picture
            engine.bind_display_space_shader(depsgraph.scene)
            draw_texture_2d(self._texture, frame.rectangle[:2], *frame.rectangle[2:])
            engine.unbind_display_space_shader()
        self._say(engine, picture, notes)

    def _say(self, engine, picture, notes):
        if self._session.message:
            engine.update_stats("uwvdb", self._session.message)
            return
        step = "starting" if picture is None else STEPS[picture.quality]
        step = "reading meshes" if self._surroundings.is_reading else step
        step = ", ".join([step] * bool(step) + ["baking materials"] * self._surroundings.is_baking)
        texts = [step] * bool(step) + notes.texts + self._surroundings.notes
        engine.update_stats("uwvdb", " | ".join(texts))

    def _look(self):
        """On Blender's main thread, some times a second: has the view to be drawn or looked at anew?"""
        engine = self._engine()
        if engine is None:
            self._session.close()
            return None
        try:
            if self._was_asking and not program.is_asking():
                self._was_asking = False
                engine.tag_update()
            if self._surroundings.has_baked():
                engine.tag_update()
            if self._seen != self._session.version or self._surroundings.is_reading or self._is_new:
                self._seen = self._session.version
                engine.tag_redraw()
        except ReferenceError:  # Blender has freed it
            self._session.close()
            return None
        return SECONDS_BETWEEN_LOOKS


def start(engine):
    """Raises Refusal if there is no program."""
    return Viewport(engine, program.find(preferences.chosen_program()))
