# ctest labels: unit
"""What is no argument: objects that were never made, text that is no text, arrays of all kinds."""

import inspect
import subprocess
import sys

import numpy as np
import pytest

import uwvdb
from conftest import SECTIONS
from uwvdb import _uwvdb

SURROGATES = ["\udcff", "\ud800", "a\ud800b"]


def has_one_line(error):
    return str(error) and "\n" not in str(error).strip()


# In an interpreter of its own: what is wrong here ends it.
BARE = """
import inspect
from uwvdb import _uwvdb
import uwvdb

def bound():
    return [found for _, found in inspect.getmembers(_uwvdb, inspect.isclass)
            if found.__module__ == _uwvdb.__name__]

def refuses(call, name):
    try:
        call()
    except Exception as error:
        assert str(error).strip(), name
        return
    raise AssertionError(f"{name}: was taken")

def arguments(count):
    for filler in (None, "x", 0, {}, [], ()):
        yield [filler] * count

classes = bound()
assert len(classes) >= 5, classes
calls = 0
for found in classes:
    for name, member in inspect.getmembers(found):
        # object's own, which know nothing of what is bound
        if name in dir(object) and name not in ("__reduce__", "__reduce_ex__"):
            continue
        bare = found.__new__(found)
        what = f"{found.__name__}.{name}"
        if isinstance(member, property):
            refuses(lambda: getattr(bare, name), what)
        elif callable(member) and name not in ("__init__", "__setstate__"):
            doc = member.__doc__ or ""
            if "(self" not in doc and "(arg0" not in doc:
                continue  # static
            count = doc.splitlines()[0].count(": ") - 1
            for given in arguments(max(count, 0)):
                refuses(lambda: member(bare, *given), what)
                calls += 1
    # As an argument of others.
    bare = found.__new__(found)
    for name, function in inspect.getmembers(_uwvdb, inspect.isbuiltin):
        count = (function.__doc__ or "").splitlines()[0].count(": ")
        refuses(lambda: function(*[bare] * count), f"{name}({found.__name__})")
        calls += 1
    refuses(lambda: _uwvdb.Water.of_scene(bare), "Water.of_scene")
    refuses(lambda: _uwvdb.Camera(bare, 0, None, None), "Camera")
    refuses(lambda: _uwvdb.Renderer(1).render(bare, {}, None), "render")
    found.__new__(found).__class__  # and is freed
# Those of the package, which hold them.
for _, found in inspect.getmembers(uwvdb, inspect.isclass):
    if issubclass(found, (BaseException, tuple)):
        continue
    bare = found.__new__(found)
    for name, member in inspect.getmembers(found):
        if isinstance(member, property):
            try:
                getattr(bare, name)
            except Exception:
                pass
            calls += 1
print("calls", calls)
"""


def test_objects_that_were_never_made_are_refused():
    done = subprocess.run([sys.executable, "-B", "-c", BARE], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert int(done.stdout.split()[1]) > 50


def test_the_refusal_names_the_class():
    with pytest.raises(TypeError, match="Scene: the object was never made"):
        _uwvdb.Scene.__new__(_uwvdb.Scene).hash


def callables(scene, image, renderer):
    """Every function and method of the package that takes arguments, bound to what it needs."""
    owners = {uwvdb: uwvdb, uwvdb.calibration: uwvdb.calibration, uwvdb.Scene: scene,
              uwvdb.Image: image, uwvdb.Renderer: renderer, uwvdb.Water: scene.water,
              uwvdb.Camera: scene.camera, type(scene.volumes): scene.volumes,
              type(scene.geometry): scene.geometry}
    for owner, holder in owners.items():
        for name, member in inspect.getmembers(owner):
            if name.startswith("_") and name not in ("__getitem__", "__setitem__", "__delitem__",
                                                     "__contains__"):
                continue
            if inspect.isfunction(member) or inspect.ismethod(member):
                yield f"{getattr(owner, '__name__', owner)}.{name}", getattr(holder, name)


def strings_of(function):
    """The parameters that are documented as text, by their annotations."""
    return [name for name, p in inspect.signature(function).parameters.items()
            if any(word in str(p.annotation) for word in ("str", "Path", "Layers"))]


# What the other parameters of a function need to be for it to come to its text.
def others_of(name, scene):
    return {"scene": scene, "array": np.zeros((2, 2, 2), np.float32), "voxel_size": 0.1,
            "concentration": {"small": 1}, "vertices": np.eye(3), "faces": [[0, 1, 2]],
            "texture": np.zeros((2, 2, 3)), "value": 1, "values": {"lamps": []}, "default": None,
            "gradient": np.zeros((8, 12, 3)), "directions": {"water.salinity": 1},
            "of": "camera.lens", "file": "none.yaml", "text": "uwvdb: 1"}.get(name)


# Where text that nothing is called by is not found, as another name is not.
NOT_FOUND = (KeyError,)


def test_text_with_lone_surrogates_is_refused_everywhere(scene, renderer):
    image = renderer.render(scene)
    tried = set()
    for name, function in callables(scene.copy(), image, renderer):
        parameters = inspect.signature(function).parameters
        for text in strings_of(function):
            for surrogate in SURROGATES:
                given = {}
                for other, parameter in parameters.items():
                    if other == text:
                        is_mapping = str(parameter.annotation).startswith("Mapping[str")
                        given[other] = {surrogate: 1} if is_mapping else surrogate
                    elif parameter.default is inspect.Parameter.empty and parameter.kind not in (
                            parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL):
                        given[other] = others_of(other, scene)
                for keyed in ("voxel_size", "concentration"):
                    if keyed in parameters and keyed != text:
                        given[keyed] = others_of(keyed, scene)
                error = None
                try:
                    found = function(**given) if not name.endswith("__") else function(
                        *given.values())
                    if inspect.isgenerator(found):
                        next(found)
                except (ValueError, OSError, *NOT_FOUND) as raised:
                    error = raised
                # A name of a file may hold the byte that "\\udcff" stands for.
                assert isinstance(error, (uwvdb.Error, *NOT_FOUND)), (name, text, repr(error))
                assert has_one_line(error) and not isinstance(error, UnicodeError), (name, text)
                tried.add((name, text))
    assert len(tried) > 20, tried


def test_text_in_sections_is_looked_at(scene):
    for surrogate in SURROGATES:
        for make in (lambda: uwvdb.Scene(**{**SECTIONS, surrogate: 1}),
                     lambda: uwvdb.Scene(**{**SECTIONS, "lamps": [{"name": surrogate}]}),
                     lambda: uwvdb.Water(preset=surrogate),
                     lambda: uwvdb.Water(**{surrogate: 1}),
                     lambda: scene.update({surrogate: 1}),
                     lambda: scene.update({"water.preset": surrogate}),
                     lambda: scene.update({"lamps.left.profile": {surrogate: 1}}),
                     lambda: uwvdb.Scene.parse("uwvdb: 1\nwater: " + surrogate)):
            with pytest.raises(uwvdb.InputError, match="surrogate") as raised:
                make()
            assert has_one_line(raised.value)
            str(raised.value).encode()  # can be printed


def test_files_may_have_names_that_are_no_utf8(tmp_path, scene):
    file = tmp_path / "a\udcff.yaml"  # the byte 0xff
    file.write_text("uwvdb: 1\n")
    with pytest.raises(uwvdb.InputError) as raised:  # it has no camera
        uwvdb.Scene.load(file)
    str(raised.value).encode()
    with pytest.raises(uwvdb.IoError) as raised:
        uwvdb.Scene.load(tmp_path / "b\udcff.yaml")
    str(raised.value).encode()


# Arrays of so many rows have a few bytes.
ROWS = 10 ** 12


@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.int64, np.uint8])
def test_arrays_beyond_memory_are_refused_before_they_are_copied(scene, dtype):
    def wide(width, *more):
        return np.broadcast_to(np.zeros(width, dtype), (ROWS, *more, width))

    corners = np.broadcast_to(np.zeros(3, np.int64), (ROWS, 3))
    triangle = np.eye(3)
    calls = [lambda: scene.geometry.add(wide(3), [[0, 1, 2]]),
             lambda: scene.geometry.add(triangle, corners),
             lambda: scene.geometry.add(triangle, corners.astype(np.int64, copy=False)[::-1]),
             lambda: scene.geometry.add(triangle, [[0, 1, 2]], uvs=np.zeros((3, 2)),
                                        texture=wide(3, 1)),
             lambda: scene.volumes.add(wide(1, 1), voxel_size=1, concentration={"small": 1}),
             lambda: scene.camera.rays(wide(2)), lambda: scene.camera.project(wide(3)),
             lambda: scene.water.scattering_function(wide(1)),
             lambda: scene.water.phase(wide(1)),
             lambda: scene.update({"water.absorption": wide(1)})]
    for call in calls:
        with pytest.raises((uwvdb.InputError, MemoryError)) as raised:
            call()
        assert has_one_line(raised.value)


def odd_arrays(shape, value):
    """Arrays of this shape and of others, of what is no number and of odd layouts."""
    plain = np.full(shape, value)
    masked = np.ma.masked_array(plain, mask=np.ones(shape, bool))
    wide = np.full([2 * n for n in shape], value)
    yield from ((f"{what}", np.full(shape, what)) for what in (np.inf, -np.inf, np.nan))
    yield "complex", plain.astype(complex)
    yield "object", plain.astype(object)
    yield "text", plain.astype(str)
    yield "void", np.zeros(shape, [("a", "f8")])
    yield "date", np.zeros(shape, "datetime64[s]")
    yield "masked", masked
    yield "strided", wide[tuple(slice(None, None, 2) for _ in shape)]
    yield "negative", plain[tuple(slice(None, None, -1) for _ in shape)]
    yield "Fortran", np.asfortranarray(plain)
    yield "big-endian", plain.astype(">f8")
    yield "unaligned", np.frombuffer(b"x" + plain.tobytes(), plain.dtype, offset=1).reshape(shape)
    yield "0-d", np.array(value)
    yield "empty", np.zeros((0, *shape[1:]))
    yield "no axis", np.zeros(0)
    yield "more axes", np.full((1, 1, 1, *shape), value)
    yield "half", plain.astype(np.float16)
    yield "long", plain.astype(np.longdouble)
    yield "bool", plain.astype(bool)
    yield "huge", np.full(shape, 1e300)
    yield "ragged", [[0], [0, 1]]
    yield "none", None
    yield "a text", "text"


def test_arrays_of_all_kinds_are_taken_or_refused_in_a_line(scene, renderer):
    image = renderer.render(scene)
    scene.volumes.add(np.ones((2, 2, 2)), name="box", voxel_size=0.1, concentration={"small": 0})
    scene.geometry.add(np.eye(3), [[0, 1, 2]], name="tile", uvs=np.zeros((3, 2)),
                       texture=np.full((2, 2, 3), 0.5))
    place = dict(voxel_size=0.1, concentration={"small": 0})
    matrix = uwvdb.LightMatrix(["a", "b"], np.zeros((2, 4, 4, 3), np.float32),
                               np.zeros((4, 4, 3), np.float32))
    takers = [
        ((2, 2, 2), 1.0, lambda a: scene.copy().volumes.add(a, **place)),
        ((2, 2, 2), 1.0, lambda a: scene.copy().volumes.set_values("box", a)),
        ((3,), 0.1, lambda a: scene.copy().volumes.add(np.ones((2, 2, 2)),
                                                       **{**place, "voxel_size": a})),
        ((3,), 0.1, lambda a: scene.copy().volumes.add(np.ones((2, 2, 2)), origin=a, **place)),
        ((4, 4), 0.0, lambda a: scene.copy().volumes.add(np.ones((2, 2, 2)), world_from_index=a,
                                                         concentration={"small": 0})),
        ((3,), 0.1, lambda a: scene.copy().volumes.add(np.ones((2, 2, 2)), voxel_size=0.1,
                                                       absorption=a, scattering=0.1)),
        ((3, 3), 0.5, lambda a: scene.copy().geometry.add(a, [[0, 1, 2]])),
        ((1, 3), 0.0, lambda a: scene.copy().geometry.add(np.eye(3), a)),
        ((3, 2), 0.5, lambda a: scene.copy().geometry.add(np.eye(3), [[0, 1, 2]], uvs=a,
                                                          texture=np.zeros((2, 2, 3)))),
        ((2, 2, 3), 0.5, lambda a: scene.copy().geometry.set_texture("tile", a)),
        ((3,), 0.5, lambda a: scene.copy().geometry.add(np.eye(3), [[0, 1, 2]], reflectance=a)),
        ((5, 2), 3.0, lambda a: scene.camera.rays(a)),
        ((5, 3), 3.0, lambda a: scene.camera.project(a)),
        ((5,), 30.0, lambda a: scene.water.scattering_function(a)),
        ((5,), 30.0, lambda a: scene.water.phase(a)),
        ((3,), 0.5, lambda a: scene.copy().update({"water.absorption": a})),
        ((8, 12, 3), 1.0, lambda a: image.backward(a, "water.preset")),
        ((3,), 1.0, lambda a: image.jvp({"lamps.left.intensity": a}, samples=1)),
        ((2,), 1.0, lambda a: matrix.mix(a)),
    ]
    taken = refused = 0
    for shape, value, take in takers:
        for what, array in odd_arrays(shape, value):
            try:
                take(array)
                taken += 1
            except (uwvdb.Error, ValueError, TypeError) as error:
                assert has_one_line(error), (shape, what, error)
                refused += 1
    assert taken > 100 and refused > 200
