"""What uwvdb needs to know beyond Blender's own settings; stored in the .blend, and all of it can be
animated."""

import math

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty,
                       FloatVectorProperty, IntProperty, PointerProperty, StringProperty)

PRESETS = ("IB", "II", "III", "1C", "3C", "5C")


class UwvdbScene(bpy.types.PropertyGroup):
    quality: EnumProperty(name="Quality", default="FINAL", items=[
        ("DRAFT", "Draft", "One sample; within 3 % in a fraction of the time"),
        ("FINAL", "Final", "Within 0.03 % of the mean in water, 0.2 % in dense plumes"),
        ("EXACT", "Exact", "The water integrated for every pixel, for comparison")])
    integrator: EnumProperty(name="Integrator", default="VOLUME", items=[
        ("VOLUME", "Volume", "Fast, without noise"),
        ("PATH", "Path", "All light by random paths, without bias but with noise"),
        ("REFERENCE", "Reference", "Slow and simple, for comparison"),
        ("PLANES", "Planes", "Sum over slabs of uniform water")])
    scattering: EnumProperty(name="Scattering", default="MULTIPLE", items=[
        ("SINGLE", "Single", "Light scattered by the water, or reflected by a surface, once"),
        ("MULTIPLE", "Multiple", "All light, however often it was scattered and reflected")])
    samples: IntProperty(
        name="Samples", default=0, min=0, max=65536, soft_max=256,
        description="Samples per pixel for the edges of surfaces, with Path light paths; 0: uwvdb's "
                    "own choice")
    use_error: BoolProperty(
        name="Until Error", default=False,
        description="With Path: go on until the standard error of the image is below this fraction of "
                    "its mean")
    error: FloatProperty(name="Error", default=0.02, min=1e-4, max=1, precision=4,
                         description="Standard error of the image over its mean")
    threads: IntProperty(name="Threads", default=0, min=0, max=1024,
                         description="Threads to use; 0: all")
    bands: StringProperty(
        name="Bands", default="620, 540, 450",
        description="Wavelengths in nm, 1 to 32. Three are red, green and blue in this order; others "
                    "are shown as their colour by CIE 1931")
    kept_in: StringProperty(
        name="Keep Scenes In", subtype="DIR_PATH",
        description="A folder in which the scene files of all frames rendered stay, for uwvdb's other "
                    "commands: FRAME_VIEWLAYER/scene.yaml")
    bake_size: IntProperty(
        name="Baked Textures", default=2048, min=0, max=8192, soft_min=64,
        description="Greatest side in texels of the textures that Cycles bakes of materials whose nodes uwvdb does not "
                    "have. They are kept until the material or the mesh changes. 0: nothing is baked")
    use_gloss: BoolProperty(
        name="Gloss and Metal", default=True,
        description="Principled's roughness, metal and specular under the lamps; otherwise all "
                    "surfaces are diffuse")
    use_forward_scatter: BoolProperty(
        name="Forward Scatter", default=False,
        description="Light scattered by small angles blurs the image; for single scattering only")
    forward_strength: FloatProperty(name="Strength K", default=1, min=0, soft_max=2)
    forward_g: FloatProperty(name="G", default=0.02, soft_min=-1, soft_max=1, precision=3,
                             description="1/m, from -c to c of the water in every band")
    forward_b: FloatProperty(name="Width B", default=0.02, min=1e-4, soft_max=1, precision=3,
                             description="Width of the blur in rad per metre")
    forward_shape: EnumProperty(name="Shape", default="EXPONENTIAL", items=[
        ("GAUSSIAN", "Gaussian", "Sedlazeck's and Koch's"),
        ("EXPONENTIAL", "Exponential", "Jaffe's and McGlamery's, with long tails")])


def _layer(name, description):
    return BoolProperty(name=name, default=False, description=description)


class UwvdbViewLayer(bpy.types.PropertyGroup):
    use_direct: _layer("Direct", "Light from surfaces, reflected or emitted")
    use_backscatter: _layer("Backscatter", "Light from the water")
    use_forward: _layer("Forward", "Light from surfaces that is scattered forward and blurred")
    use_multiple: _layer("Multiple", "With multiple scattering: all light that the others leave out")
    use_clean: _layer("Clean", "The lit surface, without water between it and camera or lamps")
    use_transmittance: _layer("Transmittance", "From the surface to the port")
    use_irradiance: _layer("Irradiance", "Light that falls on the surface from the lamps [W/m²]")
    use_error: _layer("Error", "With Path: standard error of each pixel")
    use_albedo: _layer("Albedo", "Diffuse reflectance of the surface")
    use_range: _layer("Range", "Distance from the camera's centre [m]")
    use_path: _layer("Path", "Length in the water, from the outer glass surface [m]")
    use_lit: _layer("Lit", "Fraction of the lamps that see the surface")
    use_lamps: _layer("Lamps", "The contribution of each light by itself")


class UwvdbWorld(bpy.types.PropertyGroup):
    kind: EnumProperty(name="Water", default="PRESET", items=[
        ("PRESET", "Jerlov Type", "Sea water as Jerlov classified it"),
        ("CONSTITUENTS", "Constituents", "Pure sea water and what is in it"),
        ("COEFFICIENTS", "Coefficients", "Absorption and scattering by numbers"),
        ("NONE", "None", "No water: nothing absorbs or scatters but plumes")])
    preset: EnumProperty(name="Preset", default="jerlov-II", items=[
        (f"jerlov-{name}", f"Jerlov {name}",
         "Oceanic water" if name.startswith("I") else "Coastal water") for name in PRESETS])
    salinity: FloatProperty(name="Salinity", default=35, min=0, max=100, description="PSU")
    temperature: FloatProperty(name="Temperature", default=20, min=-3, max=50, description="°C")
    cdom: FloatProperty(
        name="Dissolved Matter", default=0, min=0, soft_max=1, precision=3,
        description="Absorption of dissolved organic matter at 440 nm [1/m]")
    chlorophyll: FloatProperty(name="Chlorophyll", default=0, min=0, soft_max=20, precision=3,
                               description="mg/m³")
    use_particles: BoolProperty(name="Own Particles", default=False,
                                description="In place of those of the preset")
    small: FloatProperty(name="Small Particles", default=0.03, min=0, max=1e6, soft_max=1, precision=3,
                         description="Kopelevich's small, mineral particles, everywhere [ppm by volume]")
    large: FloatProperty(name="Large Particles", default=0.05, min=0, max=1e6, soft_max=1, precision=3,
                         description="Kopelevich's large, organic particles, everywhere [ppm by volume]")
    absorption: FloatVectorProperty(name="Absorption", default=(0.30, 0.07, 0.03), min=0, soft_max=2,
                                    precision=4, description="1/m at red, green and blue")
    scattering: FloatVectorProperty(name="Scattering", default=(0.2, 0.2, 0.2), min=0, soft_max=2,
                                    precision=4, description="1/m at red, green and blue")
    hg_g: FloatProperty(name="Asymmetry g", default=0.9, min=-0.99, max=0.99, precision=3,
                        description="Henyey and Greenstein's, towards 1 for light scattered forward")
    use_surface: BoolProperty(name="Surface", default=False,
                              description="Where the water ends; only suns need it")
    surface_height: FloatProperty(name="Height", default=10, unit="LENGTH",
                                  description="z of the water's surface")
    use_snow: BoolProperty(name="Marine Snow", default=False,
                           description="Particles drawn one by one")
    snow_number: FloatProperty(name="Number", default=1000, min=1e-3, soft_max=1e6,
                               description="Particles per m³")
    snow_least: FloatProperty(name="Least Diameter", default=0.5, min=1e-3, max=100, description="mm")
    snow_greatest: FloatProperty(name="Greatest Diameter", default=8, min=1e-3, max=100,
                                 description="mm")
    snow_exponent: FloatProperty(name="Exponent", default=4, min=0, max=10,
                                 description="Junge's: how much rarer large particles are")
    snow_reflectance: FloatProperty(name="Reflectance", default=0.4, min=0, max=1)
    snow_drift: FloatVectorProperty(name="Drift", subtype="VELOCITY", unit="VELOCITY",
                                    description="Velocity of all particles: current and sinking")
    snow_seed: IntProperty(name="Seed", default=0, min=0)
    snow_mean: EnumProperty(name="Mean", default="INCLUDED", items=[
        ("INCLUDED", "Included", "The water holds the particles' mean, which is taken out of it"),
        ("ADDED", "Added", "The water is that without snow")])


class UwvdbCamera(bpy.types.PropertyGroup):
    housing: EnumProperty(name="Port", default="NONE", items=[
        ("NONE", "None", "A pinhole in the water"),
        ("FLAT", "Flat", "A plane of glass"),
        ("DOME", "Dome", "Two concentric spheres of glass")])
    distance: FloatProperty(
        name="Distance", default=0.02, min=0, soft_max=0.5, unit="LENGTH", precision=4,
        description="From the camera's centre to the inner glass surface, along its normal")
    thickness: FloatProperty(name="Thickness", default=0.01, min=0, soft_max=0.1, unit="LENGTH",
                             precision=4, description="Of the glass")
    tilt: FloatProperty(name="Tilt", default=0, min=0, max=math.radians(80), subtype="ANGLE",
                        description="Angle between the glass's normal and the camera's axis")
    tilt_towards: FloatProperty(name="Towards", default=0, subtype="ANGLE",
                                description="Where the normal leans: 0 to the right, 90 degrees up")
    radius: FloatProperty(name="Radius", default=0.05, min=1e-4, soft_max=0.5, unit="LENGTH",
                          precision=4, description="Of the dome's inner glass surface")
    center: FloatVectorProperty(
        name="Centre", default=(0, 0, 0), unit="LENGTH", precision=4,
        description="Of the dome, from the camera's centre: right, up, forward")
    glass: EnumProperty(name="Glass", default="NUMBER", items=[
        ("NUMBER", "Index", "The same index for all light"),
        ("BK7", "BK7", ""), ("FUSED-SILICA", "Fused Silica", ""), ("SAPPHIRE", "Sapphire", ""),
        ("PMMA", "PMMA", "Acrylic glass"), ("POLYCARBONATE", "Polycarbonate", "")])
    water: EnumProperty(name="Water", default="NUMBER", items=[
        ("NUMBER", "Index", "The same index for all light"),
        ("SEAWATER", "Sea Water", "By the salinity and temperature of World > Water"),
        ("FRESHWATER", "Fresh Water", "By the temperature of World > Water")],
        description="Of the port: each band has its own rays")
    n_air: FloatProperty(name="Index of Air", default=1.0, min=1, max=3, precision=4)
    n_glass: FloatProperty(name="Index of Glass", default=1.49, min=1, max=3, precision=4)
    n_water: FloatProperty(name="Index of Water", default=1.334, min=1, max=3, precision=4)
    fresnel: BoolProperty(name="Reflection Losses", default=False,
                          description="What both glass surfaces reflect is lost")
    radiance_in: EnumProperty(name="Radiance In", default="WATER", items=[
        ("WATER", "Water", "That along the ray in the water"),
        ("AIR", "Air", "That behind the glass, 0.56 of it")])
    calibration: StringProperty(
        name="Calibration", subtype="FILE_PATH",
        description="A file of OpenCV, ROS, Kalibr, Calibmar or COLMAP, in place of lens and "
                    "resolution and, where it has one, port")
    use_sensor: BoolProperty(name="Sensor", default=False,
                             description="The pass 'sensor': the digital numbers that a camera stores")
    exposure: FloatProperty(name="Exposure", default=0.01, min=1e-6, max=60, unit="TIME_ABSOLUTE",
                            precision=5)
    pixel_pitch: FloatProperty(name="Pixel Pitch", default=0, min=0, max=1000,
                               description="µm; 0: that of Blender's sensor and resolution")
    mosaic: EnumProperty(name="Mosaic", default="MONO", items=[
        (name, label, "") for name, label in (
            ("MONO", "Mono"), ("RGGB", "RGGB"), ("BGGR", "BGGR"), ("GRBG", "GRBG"),
            ("GBRG", "GBRG"), ("THREE", "All Colours"))])
    quantum_efficiency: FloatProperty(name="Quantum Efficiency", default=0.6, min=1e-3, max=1,
                                      description="Photoelectrons per photon")
    full_well: FloatProperty(name="Full Well", default=10000, min=1, description="e⁻")
    read_noise: FloatProperty(name="Read Noise", default=2.5, min=0, description="e⁻ rms")
    dark_current: FloatProperty(name="Dark Current", default=0, min=0, description="e⁻/s")
    bit_depth: IntProperty(name="Bits", default=12, min=8, max=16)
    sensor_seed: IntProperty(name="Seed", default=0, min=0)


class UwvdbGrid(bpy.types.PropertyGroup):
    # `name` is the group's own.
    small: FloatProperty(name="Small", default=0, min=0, soft_max=100, precision=3,
                         description="ppm by volume of small, mineral particles per unit of the grid")
    large: FloatProperty(name="Large", default=0, min=0, soft_max=100, precision=3,
                         description="ppm by volume of large, organic particles per unit of the grid")


class UwvdbObject(bpy.types.PropertyGroup):
    grids: CollectionProperty(type=UwvdbGrid)


PLACES = ((bpy.types.Scene, UwvdbScene), (bpy.types.ViewLayer, UwvdbViewLayer),
          (bpy.types.World, UwvdbWorld), (bpy.types.Camera, UwvdbCamera),
          (bpy.types.Object, UwvdbObject))


def register():
    bpy.utils.register_class(UwvdbGrid)
    for owner, group in PLACES:
        bpy.utils.register_class(group)
        owner.uwvdb = PointerProperty(type=group)


def unregister():
    for owner, group in reversed(PLACES):
        del owner.uwvdb
        bpy.utils.unregister_class(group)
    bpy.utils.unregister_class(UwvdbGrid)
