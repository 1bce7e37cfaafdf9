# ctest labels: unit
"""Volume objects of a sequence of files show the file that Blender shows in each frame, or none."""

import shutil

from plumes import *
from support import *

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


def wanted_number(mode, frame, start, duration, offset):
    """The file's number by Blender's manual: the first frame shows the first file; None outside."""
    at = frame - start
    if mode == "CLIP" and not 0 <= at < duration:
        return None
    if mode == "EXTEND":
        at = min(max(at, 0), duration - 1)
    if mode == "REPEAT":
        at %= duration
    if mode == "PING_PONG":  # forwards and back again, the ends shown once
        at %= 2 * duration - 2
        at = min(at, 2 * duration - 2 - at)
    return at + 1 + offset


def sequence(folder, count):
    for number in range(1, count + 1):
        shutil.copyfile(PLUME, f"{folder}/plume_{number:03}.vdb")
    thing = volume_object(f"{folder}/plume_001.vdb", location=(-3, 7, -1))
    thing.data.is_sequence = True
    return thing


def test_each_frame_has_its_file():
    with tempfile.TemporaryDirectory() as folder:
        scene = empty_scene()
        volumes = sys.modules["uwvdb_blender.volumes"]
        thing = sequence(folder, 6)
        seen = set()
        for mode in ("CLIP", "EXTEND", "REPEAT", "PING_PONG"):
            for start, duration, offset in ((1, 3, 0), (4, 4, 2), (-2, 2, 1)):
                data = thing.data
                data.sequence_mode, data.frame_start = mode, start
                data.frame_duration, data.frame_offset = duration, offset
                for frame in range(-8, 14):
                    scene.frame_set(frame)
                    shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
                    source = volumes.source_of(shown, frame)
                    found = int(source.path[-7:-4]) if source is not None else None
                    wanted = wanted_number(mode, frame, start, duration, offset)
                    assert found == wanted, (mode, start, duration, offset, frame, found, wanted)
                    seen.add((mode, found))
        assert ("CLIP", None) in seen and len(seen) > 15, seen


def test_a_clipped_sequence_is_not_there_outside():
    """So it is in Cycles, and nothing is said of a file that is missing."""
    with tempfile.TemporaryDirectory() as folder:
        scene = wall_scene(60, 45)
        thing = sequence(folder, 2)
        thing.data.sequence_mode, thing.data.frame_start, thing.data.frame_duration = "CLIP", 2, 2
        absorbing(thing, 2)
        for frame, is_there in ((1, False), (2, True), (3, True), (4, False)):
            for engine in ("UWVDB", "CYCLES"):
                seen = render(engine, frame=frame, samples=16)["Combined"][..., 1]
                assert (seen.min() < 0.9 * seen.max()) == is_there, (frame, engine, seen.min(), seen.max())
            assert not any("Plume" in note for note in notes()), notes()
