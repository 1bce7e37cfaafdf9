"""Runs every function test_... of one file inside Blender and leaves it with 1 if one fails:

    UWVDB_PROGRAM=build/release/cli/uwvdb BLENDER_USER_SCRIPTS=FOLDER \\
        blender -b --factory-startup --python tests/blender/run_inside.py -- tests/blender/test_FILE.py [NAME]

FOLDER holds addons/uwvdb_blender, a link to blender/uwvdb_blender.
"""

import importlib.util
import os
import pathlib
import sys
import tempfile
import traceback


SKIPPED = 77  # as tests/CMakeLists.txt tells ctest


def main():
    file, *chosen = sys.argv[sys.argv.index("--") + 1:]
    file = os.path.abspath(file)
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
    spec = importlib.util.spec_from_file_location(pathlib.Path(file).stem, file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if getattr(module, "CANNOT_RUN", False):
        print(f"skipped: {module.CANNOT_RUN}")
        return SKIPPED
    tests = [name for name in vars(module) if name.startswith("test_") and (not chosen or name in chosen)]
    if not tests:
        print(f"{file}: no tests")
        return 1
    failed = 0
    with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
        os.chdir(folder)  # where Blender's solver leaves a file
        failed = sum(not passes(name, getattr(module, name)) for name in tests)
    print(f"{len(tests) - failed} of {len(tests)} tests passed")
    return 1 if failed else 0


def passes(name, test):
    print(name, flush=True)
    try:
        test()
    except Exception:
        traceback.print_exc()
        return False
    return True


code = main()
sys.stdout.flush()
sys.stderr.flush()
os._exit(code)  # Blender's own way out takes seconds and may end otherwise
