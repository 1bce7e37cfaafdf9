"""Panels of the engine, and which of Blender's own it shares."""

import bpy

from . import meshes, preferences, program, units, volumes, water
from .notes import Refusal
from .words import Words

# Panels of Blender for all engines, but for what uwvdb does not have.
WITHOUT = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_freestyle", "WORLD_PT_preview",
           "RENDER_PT_gpencil", "MATERIAL_PT_preview", "DATA_PT_preview", "DATA_PT_light", "DATA_PT_spot",
           "DATA_PT_area"}
# EEVEE's panels that are the same for all engines: nodes of materials, depth of field.
SHARED = {"EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "DATA_PT_camera_dof",
          "DATA_PT_camera_dof_aperture"}


def _shared_panels():
    panels = bpy.types.Panel.__subclasses__()
    # Those of the node editor have the very sets of those that they stand for.
    left_out = [p.COMPAT_ENGINES for p in panels if p.__name__ in WITHOUT and hasattr(p, "COMPAT_ENGINES")]
    for panel in panels:
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None or any(engines is other for other in left_out):
            continue
        if "BLENDER_RENDER" in engines or panel.__name__ in SHARED:
            yield panel


class _Panel:
    bl_space_type, bl_region_type = "PROPERTIES", "WINDOW"
    COMPAT_ENGINES = {"UWVDB"}

    @classmethod
    def poll(cls, context):
        return context.engine == "UWVDB" and cls.applies(context)

    @classmethod
    def applies(cls, context):
        return True

    def begin(self):
        self.layout.use_property_split, self.layout.use_property_decorate = True, True
        return self.layout.column()


class RenderPanel(_Panel):
    bl_context = "render"


class UWVDB_PT_render(RenderPanel, bpy.types.Panel):
    bl_label = "uwvdb"

    def draw(self, context):
        settings, column = context.scene.uwvdb, self.begin()
        try:
            program.find(preferences.chosen_program())
        except Refusal as missing:
            column.label(text=str(missing), icon="ERROR")
        column.prop(settings, "integrator")
        if settings.integrator == "VOLUME":
            column.prop(settings, "scattering")
        column.prop(settings, "quality")
        column.prop(settings, "samples")
        if settings.integrator == "PATH":
            row = column.row(heading="Until Error")
            row.prop(settings, "use_error", text="")
            part = row.row()
            part.active = settings.use_error
            part.prop(settings, "error", text="")
        column.prop(settings, "bands")
        column.prop(settings, "use_gloss")
        column.prop(settings, "bake_size")
        column.prop(settings, "threads")
        column.prop(context.scene.render, "preview_pixel_size", text="Viewport Pixels")
        column.prop(settings, "kept_in")


class UWVDB_PT_motion_blur(RenderPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        render, column = context.scene.render, self.begin()
        column.active = render.use_motion_blur
        if hasattr(render, "motion_blur_position"):
            column.prop(render, "motion_blur_position", text="Position")
        elif hasattr(context.scene, "cycles"):
            column.prop(context.scene.cycles, "motion_blur_position", text="Position")
        column.prop(render, "motion_blur_shutter")


class UWVDB_PT_forward_scatter(RenderPanel, bpy.types.Panel):
    bl_label = "Forward Scatter"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.uwvdb, "use_forward_scatter", text="")

    def draw(self, context):
        settings, column = context.scene.uwvdb, self.begin()
        column.active = settings.use_forward_scatter
        for name in ("forward_strength", "forward_g", "forward_b", "forward_shape"):
            column.prop(settings, name)


class UWVDB_PT_passes(_Panel, bpy.types.Panel):
    bl_label, bl_context = "Passes", "view_layer"

    def draw(self, context):
        layer, column = context.view_layer, self.begin()
        column.prop(layer, "use_pass_z")
        for name in ("use_pass_position", "use_pass_normal", "use_pass_vector"):
            column.prop(layer, name)
        column.prop(layer, "use_pass_object_index")
        column.prop(layer, "use_pass_material_index")
        column.prop(layer, "use_pass_cryptomatte_object", text="Cryptomatte Object")
        column.prop(layer, "use_pass_cryptomatte_material", text="Cryptomatte Material")
        column.separator()
        for name in layer.uwvdb.__annotations__:
            column.prop(layer.uwvdb, name)


class UWVDB_PT_water(_Panel, bpy.types.Panel):
    bl_label, bl_context = "Water", "world"

    @classmethod
    def applies(cls, context):
        return context.world is not None

    def draw(self, context):
        settings, column = context.world.uwvdb, self.begin()
        column.prop(settings, "kind")
        if water.has_volume(context.world):
            column.operator("uwvdb.water_from_volume")
        if settings.kind == "NONE":
            return
        if settings.kind == "COEFFICIENTS":
            for name in ("absorption", "scattering", "hg_g", "salinity", "temperature"):
                column.prop(settings, name)
            return
        if settings.kind == "PRESET":
            column.prop(settings, "preset")
            column.prop(settings, "use_particles")
        else:
            column.prop(settings, "cdom")
            column.prop(settings, "chlorophyll")
        part = column.column()
        part.active = settings.kind == "CONSTITUENTS" or settings.use_particles
        part.prop(settings, "small")
        part.prop(settings, "large")
        column.prop(settings, "salinity")
        column.prop(settings, "temperature")


class UWVDB_PT_water_surface(_Panel, bpy.types.Panel):
    bl_label, bl_context = "Surface", "world"
    bl_parent_id = "UWVDB_PT_water"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.world.uwvdb, "use_surface", text="")

    def draw(self, context):
        column = self.begin()
        column.active = context.world.uwvdb.use_surface
        column.prop(context.world.uwvdb, "surface_height")


class UWVDB_PT_snow(_Panel, bpy.types.Panel):
    bl_label, bl_context = "Marine Snow", "world"
    bl_parent_id = "UWVDB_PT_water"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.world.uwvdb, "use_snow", text="")

    def draw(self, context):
        settings, column = context.world.uwvdb, self.begin()
        column.active = settings.use_snow
        for name in ("number", "least", "greatest", "exponent", "reflectance", "mean", "drift", "seed"):
            column.prop(settings, f"snow_{name}")


class CameraPanel(_Panel):
    bl_context = "data"

    @classmethod
    def applies(cls, context):
        return context.camera is not None


class UWVDB_PT_lens(CameraPanel, bpy.types.Panel):
    bl_label = "Fisheye"

    @classmethod
    def applies(cls, context):
        return context.camera is not None and context.camera.type == "PANO"

    def draw(self, context):
        camera, column = context.camera, self.begin()
        owner = camera if hasattr(camera, "panorama_type") else getattr(camera, "cycles", None)
        if owner is None:
            column.label(text="A fisheye of 180 degrees; the add-on Cycles has other angles")
            return
        column.prop(owner, "panorama_type")
        column.prop(owner, "fisheye_fov")


class UWVDB_PT_housing(CameraPanel, bpy.types.Panel):
    bl_label = "Housing"

    def draw(self, context):
        settings, column = context.camera.uwvdb, self.begin()
        column.prop(settings, "housing")
        names = {"NONE": (), "FLAT": ("distance", "thickness", "tilt", "tilt_towards"),
                 "DOME": ("radius", "thickness", "center")}[settings.housing]
        for name in names:
            column.prop(settings, name)
        if names:
            column.prop(settings, "n_air")
            for material, number in (("glass", "n_glass"), ("water", "n_water")):
                column.prop(settings, material)
                if getattr(settings, material) == "NUMBER":
                    column.prop(settings, number)
            for name in ("fresnel", "radiance_in"):
                column.prop(settings, name)
        column.prop(settings, "calibration")


class UWVDB_PT_sensor(CameraPanel, bpy.types.Panel):
    bl_label = "Sensor"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.camera.uwvdb, "use_sensor", text="")

    def draw(self, context):
        settings, column = context.camera.uwvdb, self.begin()
        column.active = settings.use_sensor
        for name in ("exposure", "pixel_pitch", "mosaic", "quantum_efficiency", "full_well",
                     "read_noise", "dark_current", "bit_depth", "sensor_seed"):
            column.prop(settings, name)
        column.prop(context.camera.dof, "aperture_fstop")


class UWVDB_PT_light(_Panel, bpy.types.Panel):
    bl_label, bl_context = "Light", "data"

    @classmethod
    def applies(cls, context):
        return context.light is not None

    def draw(self, context):
        light, column = context.light, self.begin()
        column.row().prop(light, "type", expand=True)
        column.prop(light, "color")
        column.prop(light, "energy", text="Strength (W/m²)" if light.type == "SUN" else "Power")
        if light.type == "SUN":
            column.prop(light, "angle")
            if context.scene.world is None or not context.scene.world.uwvdb.use_surface:
                column.label(text="A sun needs World > Water > Surface", icon="INFO")
        elif light.type == "AREA":
            column.prop(light, "shape")
            column.prop(light, "size")
            if light.shape in ("RECTANGLE", "ELLIPSE"):
                column.prop(light, "size_y")
        elif light.type == "SPOT":
            column.prop(light, "shadow_soft_size", text="Radius")
            column.prop(light, "spot_size")
            column.prop(light, "spot_blend", slider=True)


class UWVDB_OT_water_from_volume(bpy.types.Operator):
    """Make water of the world's volume shader: its absorption, scattering and anisotropy"""
    bl_idname, bl_label = "uwvdb.water_from_volume", "From Volume Shader"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return water.has_volume(context.scene.world)

    def execute(self, context):
        world = context.scene.world
        try:
            found = water.of_volume(world, units.metres_per_unit(context.scene))
        except Refusal as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        settings = world.uwvdb
        settings.kind = "COEFFICIENTS"
        settings.absorption, settings.scattering, settings.hg_g = found.absorption, found.scattering, found.g
        return {"FINISHED"}


class UWVDB_OT_read_grids(bpy.types.Operator):
    """List the grids of this volume with the concentrations that make it well visible"""
    bl_idname, bl_label = "uwvdb.read_grids", "Read Grids"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        shown = context.object
        try:
            depsgraph = context.evaluated_depsgraph_get()
            source = volumes.source_of(shown.evaluated_get(depsgraph), context.scene.frame_current)
            if source is None:
                raise Refusal(f"'{shown.name}' has no volume in this frame")
            path = program.find(preferences.chosen_program())
            mapped, names = volumes.for_size(volumes.advice(path, source),
                                               volumes.size_of(shown, context.scene))
        except Refusal as refusal:
            self.report({"ERROR"}, Words().why(refusal))
            return {"CANCELLED"}
        grids = shown.uwvdb.grids
        grids.clear()
        for name in sorted(names, key=lambda name: name not in mapped):
            grid = grids.add()
            grid.name = name
            grid.small, grid.large = mapped.get(name, (0, 0))
        return {"FINISHED"}


class UWVDB_OT_forget_grids(bpy.types.Operator):
    """Go back to the concentrations that uwvdb advises"""
    bl_idname, bl_label = "uwvdb.forget_grids", "Use Advice"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        context.object.uwvdb.grids.clear()
        return {"FINISHED"}


class _VolumePanel(_Panel):
    bl_label = "Concentrations"

    def draw(self, context):
        grids, layout = context.object.uwvdb.grids, self.layout
        if len(grids) == 0:
            layout.label(text="As advised by uwvdb when rendered")
        else:
            header = layout.row()
            for text in ("Grid", "Small [ppm]", "Large [ppm]"):
                header.label(text=text)
        for grid in grids:
            row = layout.row()
            row.label(text=grid.name)
            row.prop(grid, "small", text="")
            row.prop(grid, "large", text="")
        row = layout.row()
        row.operator("uwvdb.read_grids")
        if len(grids) > 0:
            row.operator("uwvdb.forget_grids")


class UWVDB_PT_volume(_VolumePanel, bpy.types.Panel):
    bl_context = "data"

    @classmethod
    def applies(cls, context):
        return context.object is not None and context.object.type == "VOLUME"


class UWVDB_PT_domain(_VolumePanel, bpy.types.Panel):
    bl_context = "physics"

    @classmethod
    def applies(cls, context):
        shown = context.object
        return (shown is not None and shown.type == "MESH"
                and meshes.domain_settings(shown) is not None)


CLASSES = (UWVDB_PT_render, UWVDB_PT_motion_blur, UWVDB_PT_forward_scatter, UWVDB_PT_passes,
           UWVDB_PT_water, UWVDB_PT_water_surface, UWVDB_PT_snow, UWVDB_PT_lens, UWVDB_PT_housing,
           UWVDB_PT_sensor, UWVDB_PT_light, UWVDB_OT_water_from_volume, UWVDB_OT_read_grids,
           UWVDB_OT_forget_grids, UWVDB_PT_volume, UWVDB_PT_domain)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.add("UWVDB")


def unregister():
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.discard("UWVDB")
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
