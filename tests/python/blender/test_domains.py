# ctest labels: metamorphic slow
"""Fluid domains, baked here, are where Cycles shows them: adaptive or not, with noise or without."""

from plumes import *
from support import *

# Blender's solver starts Python once more in a way that Python 3.12 and later end the program for (Ubuntu 24.04,
# Debian 13).
CANNOT_RUN = sys.version_info >= (3, 12) and "Blender's fluid solver does not work with Python 3.12 or later"


def baked(folder, frames=10, parents=(), **settings):
    """A small plume of smoke in a domain that is turned and no multiple of its cells; `parents` are the places of a
    chain of objects that it hangs from, which leave it where it is."""
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, frames
    made = material("Skin")[0]
    source = box("Source", size=(0.3, 0.3, 0.3), location=(0.35, 5.1, -0.3))
    source.data.materials.append(made)
    source.hide_render = True
    flow = source.modifiers.new("Fluid", "FLUID")
    flow.fluid_type = "FLOW"
    flow.flow_settings.flow_type, flow.flow_settings.flow_behavior = "SMOKE", "INFLOW"
    domain = box("Domain", location=(0.2, 5, 0.1), rotation=(0, 0, 0.5), scale=(2.0, 1.3, 1.47))
    place = Matrix.LocRotScale(domain.location, domain.rotation_euler, domain.scale)
    for location, rotation, scale in parents:
        parent = add("Parent", None, location, rotation, scale)
        parent.parent, domain.parent = domain.parent, parent
        place = Matrix.LocRotScale(Vector(location), Euler(rotation), Vector(scale)).inverted() @ place
    domain.location, domain.rotation_euler = place.to_translation(), place.to_euler()
    domain.scale = place.to_scale()
    # Blender counts on the domain's having been evaluated before it is one.
    bpy.context.view_layer.update()
    modifier = domain.modifiers.new("Fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    cache = modifier.domain_settings
    cache.domain_type, cache.resolution_max, cache.cache_directory = "GAS", 24, str(folder)
    for key, value in settings.items():
        setattr(cache, key, value)
    cache.cache_frame_start, cache.cache_frame_end, cache.cache_data_format = 1, frames, "OPENVDB"
    cache.cache_type = "ALL"
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()
    node = absorbing(domain, 4)
    node.inputs["Density Attribute"].default_value = "density"
    grid = domain.uwvdb.grids.add()
    grid.name, grid.small = "density", 3
    return domain, cache


def domain_agrees(what, frames=(4, 10), **settings):
    with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
        wall_scene()
        domain, cache = baked(folder, **settings)
        for frame in frames:
            shadows_agree(f"{what}, frame {frame}", frame)


def test_domain():
    domain_agrees("domain")


def test_adaptive_domain():
    domain_agrees("adaptive", use_adaptive_domain=True)


def test_domain_with_noise():
    domain_agrees("noise", use_noise=True)


def test_adaptive_domain_with_noise():
    domain_agrees("adaptive with noise", use_noise=True, use_adaptive_domain=True)


def test_frame_offset():
    """A cache that is shown three frames later."""
    with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
        wall_scene()
        _, cache = baked(folder)
        cache.cache_frame_offset = 3
        # Blender takes a new offset when it opens the file.
        bpy.ops.wm.save_as_mainfile(filepath=f"{folder}/offset.blend")
        bpy.ops.wm.open_mainfile(filepath=f"{folder}/offset.blend")
        shadows_agree("offset", 13)
        render(frame=2)
        assert any("frame -1 is not baked" in note for note in notes()), notes()


def test_sequence():
    """A Volume object of the files of a cache, started later and at another file, is at its frame."""
    with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
        scene = wall_scene()
        domain, _ = baked(folder)
        bpy.data.objects.remove(domain)
        thing = volume_object(f"{folder}/data/fluid_data_0001.vdb", location=(-0.8, 5, -0.5))
        thing.data.is_sequence, thing.data.frame_duration = True, 10
        thing.data.frame_start, thing.data.frame_offset = 4, 2
        absorbing(thing, 4)
        shadows_agree("sequence", 9)


CHAINS = {
    "scaled": [((1, 2, -1), (0, 0, 0), (1.6, 1.6, 1.6))],
    "turned and scaled": [((0, 1, 0), (0.2, -0.3, 0.7), (0.6, 0.6, 0.6))],
    "scaled by axis": [((0, 0, 1), (0, 0, 0.5), (1.5, 0.7, 2))],
    "chain": [((0.5, 0, 0), (0.3, 0, 0), (2, 2, 2)),  # turned there and back, so that nothing is sheared
              ((0, 0.2, 0), (Matrix.Rotation(-0.3, 3, "X") @ Matrix.Rotation(0.5, 3, "Z")).to_euler(),
               (1.4, 0.5, 0.8))],
    "mirrored": [((0, 0, 0), (0, 0, 0.5), (1, -1, 1))],
}


def test_domains_of_scaled_parents():
    """Seen where Cycles shows them, and `uwvdb info` says the place that their objects have: the solver's files and
    the size that they state know nothing of parents."""
    for what, parents in CHAINS.items():
        with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
            wall_scene()
            domain, _ = baked(folder, frames=6, parents=parents)
            shadows_agree(what, 6)
            told = json.loads(uwvdb("info", "data/fluid_data_0006.vdb", "--json", folder=folder))["advice"]
            # From the domain's own lengths, y up, by the advice, against Blender's own matrix.
            world, corners = domain.matrix_world, [Vector(c) for c in domain.bound_box]
            low = Vector([min(c[axis] for c in corners) for axis in range(3)])
            block = Matrix.LocRotScale(
                Vector(told["translate"]), Euler([math.radians(angle) for angle in told["rotate"]]),
                told["scale"] * Vector(told["mirror"]))
            worst = 0
            for corner in corners:
                sides = [(corner[axis] - low[axis]) * world.col[axis].to_3d().length for axis in range(3)]
                found, wanted = block @ Vector((sides[0], sides[2], -sides[1])), world @ corner
                worst = max(worst, (found - Vector((wanted.x, wanted.z, -wanted.y))).length)
            print(f"    {what}: corners are at most {worst:.1e} m off; {told['lines'][-1][:60]}")
            assert worst < 1e-4, (what, worst, told)
