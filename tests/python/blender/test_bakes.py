# ctest labels: metamorphic
"""Materials whose nodes uwvdb does not have, baked, against the same in Cycles."""

import os
import tempfile

os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="uwvdb-test-")  # nothing is known at first

from node_materials import *


def inner(indices, number):
    """Pixels of an object all of whose neighbours are of it, too."""
    own = indices == number
    result = own.copy()
    for axis in (0, 1):
        for step in (-1, 1):
            result &= numpy.roll(own, step, axis)
    return result


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
