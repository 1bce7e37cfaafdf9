# ctest labels: metamorphic slow
"""Volume objects are where Cycles shows them: what they leave of a bright wall's light, pixel by pixel."""

from plumes import *
from support import *

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


def test_volume_object():
    wall_scene()
    thing = volume_object(PLUME, location=(-3, 7, -1))
    absorbing(thing, 2)
    shadows_agree("unturned")


def test_volume_object_turned_and_scaled():
    wall_scene()
    parent = add("Parent", None, location=(0.2, 7, -0.5), rotation=(0.3, -0.5, 0.9))
    thing = volume_object(PLUME, location=(-1.2, -0.3, -0.2), rotation=(0.5, 0.2, -0.4),
                          scale=(0.5, 0.8, -1.1))
    thing.parent = parent
    absorbing(thing, 4)
    for grid in thing.uwvdb.grids:
        grid.small = 6
    shadows_agree("turned")


def test_instances_of_a_volume_object():
    """Two of them, by empties that show its collection, each in its own place and size."""
    scene = wall_scene()
    thing = volume_object(PLUME, location=(-1, 0, -0.5), scale=(0.5, 0.5, 0.5))
    absorbing(thing, 3)
    thing.data.render.space = "WORLD"  # the density of water does not change with an object's size
    group = bpy.data.collections.new("Plumes")
    scene.collection.objects.unlink(thing)
    group.objects.link(thing)
    for x, size in ((-1, 0.7), (1.5, 1.1)):
        holder = add(f"Holder{x}", None, (x, 7, 0), (0.2, 0.1, x), (size, size, size))
        holder.instance_type, holder.instance_collection = "COLLECTION", group
    shadows_agree("instances")


def test_advice_is_the_default():
    """Without concentrations of its own a plume is neither invisible nor black, and a note says what
    they are; a smaller one is denser."""
    scene = wall_scene()
    thing = volume_object(PLUME, location=(-3, 7, -1))
    thing.uwvdb.grids.clear()
    whole = -numpy.log(render()["Combined"][..., 1].min())
    assert any("by advice: density" in note for note in notes()), notes()
    thing.scale, thing.location = (0.5, 0.5, 0.5), (-1.5, 3.5, -0.5)
    half = -numpy.log(render()["Combined"][..., 1].min())
    print(f"    absorption by the densest part: {whole:.3f}, {half:.3f}")
    assert whole > 0.01 and abs(half / whole - 1) < 1e-3, (whole, half)


def test_files_that_are_missing_are_named():
    wall_scene()
    volume_object("/nowhere/plume.vdb")
    render()
    assert any("/nowhere/plume.vdb" in note and "left out" in note for note in notes()), notes()
