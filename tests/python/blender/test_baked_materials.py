# ctest labels: metamorphic slow
"""A table of materials whose nodes uwvdb does not have, baked, against the same in Cycles."""

import os
import tempfile

os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="uwvdb-test-")  # nothing is known at first

from node_materials import *


def by_object(ours, theirs, makers):
    """{name: (mean error of the mean colour, rms of the difference, mean colour of Cycles)} of the albedo."""
    indices, found = ours["IndexOB"][..., 0], {}
    for number, make in enumerate(makers, 1):
        where = inner(indices, number) & (theirs["IndexOB"][..., 0] == number)
        assert where.sum() > 300, (make.__name__, where.sum())
        mine, wanted = ours["albedo"][where], theirs["DiffCol"][where]
        found[make.__name__] = (numpy.abs(mine.mean(0) - wanted.mean(0)).max(),
                                math.sqrt(((mine - wanted)**2).mean()), wanted.mean(0))
    return found


# The root mean square of what a texel of a pixel's size makes of borders that are sharp in Cycles.
AT_BORDERS = 0.05


def test_albedo_by_object():
    """Nothing is said of them, and their mean colours are those of Cycles."""
    shelf(MATERIALS)
    ours = render()
    assert not any("Material" in note or "baked" in note for note in notes()), notes()
    for name, (mean, rms, wanted) in by_object(ours, render("CYCLES", samples=32), MATERIALS).items():
        print(f"    {name}: mean {mean:.4f}, rms {rms:.4f}, Cycles {wanted.round(3)}")
        assert mean < 2e-3 and rms < AT_BORDERS, name


# Relative errors of the mean light and its root mean square, and the median error of normals. Cycles bends normals by
# what a pixel spans, a bake by what a texel does; and it dims light on bumps that is nearly parallel to the surface.
LIGHT = {bumps_by_noise: (0.04, 0.15, 0.02), normal_map_in_a_group: (0.04, 0.15, 1e-3),
         metal_and_roughness_by_noise: (0.01, 0.03, 1e-3), glow_by_a_wave: (0.002, 0.01, 1e-3),
         holes_by_a_checker: (0.03, 0.15, 1e-3)}


def test_light_by_object():
    """Bumps, metal, roughness, glow and holes; what glows lights other things in Cycles, so it is by itself."""
    for makers in ([make for make in LIGHT if make is not glow_by_a_wave], [glow_by_a_wave]):
        shelf(makers)
        ours = render()
        assert not any("Material" in note or "baked" in note for note in notes()), notes()
        theirs = render("CYCLES", samples=64)
        for number, make in enumerate(makers, 1):
            where = inner(ours["IndexOB"][..., 0], number) & (theirs["IndexOB"][..., 0] == number)
            mine, wanted = (passes["Combined"][where][:, :3] for passes in (ours, theirs))
            mean, rms = abs(mine.mean() / wanted.mean() - 1), math.sqrt(((mine - wanted)**2).mean()) / wanted.mean()
            bent = numpy.median(numpy.abs(ours["Normal"] - theirs["Normal"])[where].max(axis=-1))
            print(f"    {make.__name__}: mean {mean:.4f}, rms {rms:.4f}, normals' median {bent:.4f}")
            assert (numpy.array([mean, rms, bent]) < LIGHT[make]).all(), make.__name__
            if make is holes_by_a_checker:
                areas = [(passes["IndexOB"][..., 0] == number).sum() for passes in (ours, theirs)]
                assert abs(areas[0] / areas[1] - 1) < 0.01, areas
