#!/usr/bin/env python3
"""What scripts/check-all does with small tables of its own, and that the suites of tests/suites.tsv are all there
is: python3 tests/style/suites.py BUILD_FOLDER."""
import csv
import json
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv.pop()).resolve()
TABLE = ROOT / "tests/suites.tsv"
SLICE = 25  # minutes of suites for each commit
OLDEST = 20  # commits
# Longer than a slice, so by hand and with --full: days under the sanitizers, and all of scripts/test once more.
BY_HAND = {"asan.slow", "source.bookworm"}


def rows_of(path):
    with path.open(newline="") as file:
        return {row["suite"]: row for row in csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE)}


class Suites(unittest.TestCase):
    """The table of the repository."""

    def setUp(self):
        self.rows = rows_of(TABLE)
        self.commands = [row["command"] for row in self.rows.values()]
        self.rotation = [row["command"] for name, row in self.rows.items() if name not in BY_HAND]

    def listed(self, *options):
        """The tests that ctest takes with these options, in a folder of its own: this may be run by ctest."""
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "CTestTestfile.cmake").write_text(f'subdirs("{BUILD}")\n')
            done = subprocess.run(["ctest", "--test-dir", folder, "--show-only=json-v1", *options], check=True,
                                  capture_output=True, text=True)
        return {test["name"] for test in json.loads(done.stdout)["tests"]}

    def reached(self, preset):
        """The tests that the suites of the rotation run in the build of a preset."""
        found = set()
        for command in self.rotation:
            for part in command.split(";"):
                words = shlex.split(part)
                while words and "=" in words[0]:
                    words.pop(0)
                if words[:3] == ["ctest", "--preset", preset]:
                    found |= self.listed(*words[3:])
        return found

    def test_every_slow_test_is_in_a_suite(self):
        slow = self.listed("-L", "slow")
        self.assertGreater(len(slow), 50)
        self.assertEqual(slow - self.reached("test"), {"core.base.assertions"} & slow)
        self.assertIn("core.base.assertions", self.reached("asan"))

    def test_every_quick_test_in_cpp_is_in_a_suite_of_the_address_sanitizer(self):
        layers = re.search(r"foreach\(layer ([a-z ]+)\)", (ROOT / "tests/CMakeLists.txt").read_text())[1].split()
        quick = {name for name in self.listed("-LE", "slow") if name.split(".")[0] in layers}
        self.assertGreater(len(quick), 300)
        self.assertEqual(quick - self.reached("asan"), set())
        built = {word for command in self.rotation if "build_preset asan" in command
                 for word in re.findall(r"tests_[a-z]+", command)}
        self.assertEqual(built, {f"tests_{layer}" for layer in layers})

    def test_every_shard_of_the_random_scenes_is_in_a_suite(self):
        shards = [re.search(r"TOTAL_SHARDS=(\d+) \S+SHARD_INDEX=(\d+)", command) for command in self.rotation]
        found = {(int(shard[1]), int(shard[2])) for shard in shards if shard}
        number = next(iter(found))[0]
        self.assertEqual(found, {(number, index) for index in range(number)})

    def test_every_fuzzer_is_in_a_suite(self):
        fuzzers = re.findall(r"(?m)^uwvdb_add_fuzzer\((\w+)", (ROOT / "tests/fuzz/CMakeLists.txt").read_text())
        self.assertGreater(len(fuzzers), 10)
        run = [word for command in self.rotation if command.startswith("scripts/fuzz ")
               for word in command.split()[1:]]
        self.assertEqual(sorted(run), sorted(fuzzers))

    def test_every_kind_of_build_is_in_a_suite(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
        used = "\n".join(self.rotation)
        for preset in presets:
            name = preset["name"]
            if not preset.get("hidden") and name != "release":  # a part of the preset test
                self.assertRegex(used, rf"build_preset {name}\b|scripts/{name}\b")

    def test_every_script_that_checks_is_in_a_suite_or_a_test(self):
        cmake = (ROOT / "tests/CMakeLists.txt").read_text() + (ROOT / "tests/bench/CMakeLists.txt").read_text()
        used = "\n".join(self.rotation) + cmake
        scripts = {path.name for path in (ROOT / "scripts").iterdir()
                   if re.match(r"(check|test)-|fuzz$|tidy$|docs-site$|container$", path.name)} - {"check-all"}
        self.assertEqual({name for name in scripts if not re.search(rf"scripts/{name}\b", used)}, set())

    def test_every_folder_of_sources_is_tidied(self):
        text = (ROOT / "scripts/tidy").read_text()
        folders = re.search(r"\|\| set -- ([a-z ]+)", text)[1].split()
        tidied = [word for command in self.rotation if command.startswith("scripts/tidy ")
                  for word in command.split()[1:]]
        self.assertEqual(sorted(tidied), sorted(folders))

    def test_a_year_of_commits_leaves_no_suite_older_than_twenty(self):
        """With commands that do nothing, by the script itself; commits 1000 to 1059 stand for all, whose numbers
        the script takes modulo that of the turns."""
        with tempfile.TemporaryDirectory() as folder:
            fake = Fake(folder)
            fake.write([(name, row["minutes"], "2026-01-01", "-", "true") for name, row in self.rows.items()])
            slices = [fake.run("--slice", str(number), str(SLICE + 1)).passed for number in range(1000, 1060)]
        for name in self.rows.keys() - BY_HAND:
            at = [number for number, passed in enumerate(slices) if name in passed]
            self.assertTrue(at, f"{name} never runs")
            gaps = [after - before for before, after in zip([-1, *at], [*at, len(slices)])]
            self.assertLessEqual(max(gaps), OLDEST, name)
        for passed in slices:
            self.assertLessEqual(sum(float(self.rows[name]["minutes"]) for name in passed), SLICE)
        for name in BY_HAND:
            self.assertGreater(float(self.rows[name]["minutes"]), SLICE)


class Ran:
    def __init__(self, done):
        self.status = done.returncode
        self.text = done.stdout + done.stderr
        ended = dict(part.split(": ", 1) for part in done.stdout.rstrip().split("\n")[-1].split("; ") if ": " in part)
        for how in ("passed", "failed", "stopped", "cannot"):
            setattr(self, how, ended.get(how, "").split())


class Fake:
    """A table in a folder, and the script that runs it."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.table = self.folder / "suites.tsv"

    def write(self, rows):
        lines = ["suite\tminutes\tpassed\tfailed\tcommand"] + ["\t".join(row) for row in rows]
        self.table.write_text("\n".join(lines) + "\n")

    def run(self, *arguments):
        return Ran(subprocess.run([ROOT / "scripts/check-all", "--table", self.table, "--work", self.folder / "work",
                                   *arguments], capture_output=True, text=True))


class Script(unittest.TestCase):
    """The script, with tables of small suites."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.fake = Fake(folder.name)
        self.marker = Path(folder.name, "marker")

    def test_next_runs_failed_ones_and_then_the_oldest_within_the_minutes(self):
        self.fake.write([("young", "10", "2026-03-01", "-", "true"),
                         ("old", "10", "2026-01-01", "2025-12-31", "true"),
                         ("never", "10", "-", "-", "true"),
                         ("bad", "10", "2026-03-02", "2026-03-03", "true")])
        self.assertEqual(self.fake.run("--next", "30").passed, ["bad", "never", "old"])

    def test_what_does_not_fit_is_not_begun(self):
        self.fake.write([("long", "31", "-", "-", "true"), ("short", "1", "2026-01-01", "-", "true")])
        self.assertEqual(self.fake.run("--next", "30").passed, ["short"])
        self.assertEqual(self.fake.run("--slice", "0", "30").passed, ["short"])
        done = self.fake.run("--slice", "0", "-2")
        self.assertEqual((done.status, done.passed), (0, []))

    def test_what_failed_is_first_next_time_and_until_it_passes(self):
        self.fake.write([(f"s{n}", "20", "2026-01-01", "-", "true") for n in range(3)] +
                        [("bad", "20", "2026-01-01", "-", f"echo why; test -e {self.marker}")])
        number = next(n for n in range(4) if self.fake.run("--slice", str(n), "25").failed)
        for _ in range(2):
            done = self.fake.run("--slice", str(number + 1), "25")
            self.assertEqual((done.status, done.failed, done.passed), (1, ["bad"], []))
            self.assertIn("why", done.text)
        before = self.fake.table.read_text()
        self.assertEqual(rows_of(self.fake.table)["bad"]["failed"], "-")  # a slice leaves the checkout clean
        self.marker.touch()
        done = self.fake.run("--slice", str(number + 1), "25")
        self.assertEqual((done.status, done.passed), (0, ["bad"]))
        self.assertEqual(before, self.fake.table.read_text())
        self.assertNotIn("bad", self.fake.run("--slice", str(number + 1), "25").passed)

    def test_one_over_its_limit_is_stopped_and_has_not_passed(self):
        child = f"(trap '' TERM HUP; sleep 600) & echo $! >>{self.marker}; wait"
        self.fake.write([("slow", "0.005", "2026-01-01", "-", child),
                         ("quick", "0.004", "2026-01-01", "-", "true")])
        done = self.fake.run("--slice", "0", "25")
        self.assertEqual((done.status, done.stopped, done.passed), (0, ["slow"], ["quick"]))
        self.assertIn("not finished", done.text)
        self.assertEqual(rows_of(self.fake.folder / "work/results.tsv")["slow"]["passed"], "2026-01-01")
        done = self.fake.run("slow")
        self.assertEqual((done.status, done.stopped), (1, ["slow"]))
        self.assertEqual(rows_of(self.fake.table)["slow"]["passed"], "2026-01-01")
        began = self.marker.read_text().split()
        self.assertEqual(len(began), 2)
        for process in began:  # nothing that it began goes on, though it does not heed SIGTERM
            stat = Path("/proc", process, "stat")
            self.assertTrue(not stat.exists() or stat.read_text().rpartition(")")[2].split()[0] == "Z")

    def test_what_cannot_run_says_why_and_the_next_in_turn_runs(self):
        self.fake.write([("bare", "25", "2026-01-01", "-", "bash -c 'echo no root >&2; exit 77'; echo not here"),
                         ("other", "24", "2026-01-01", "-", "true"), ("third", "23", "2026-01-01", "-", "true")])
        done = self.fake.run("--slice", "0", "30")
        self.assertEqual((done.status, done.cannot, done.passed), (0, ["bare"], ["other"]))
        self.assertIn("bare: cannot run here: no root", done.text)
        row = rows_of(self.fake.folder / "work/results.tsv")["bare"]
        self.assertEqual((row["passed"], row["failed"]), ("2026-01-01", "-"))
        self.assertEqual(self.fake.run("bare").status, 1)

    def test_a_slice_draws_no_suite_that_has_never_passed(self):
        self.fake.write([("new", "10", "-", "-", "true"), ("known", "10", "2026-01-01", "-", "true")])
        self.assertEqual(self.fake.run("--slice", "0", "30").passed, ["known"])
        self.assertEqual(self.fake.run("--next", "30").passed, ["new", "known"])
        self.assertEqual(self.fake.run("--slice", "0", "30").passed, ["new", "known"])
        self.fake.write([("new", "10", "-", "-", "true")])
        self.assertEqual(self.fake.run("--slice", "7", "30").status, 0)

    def test_names_stand_for_groups(self):
        self.fake.write([(name, "1", "-", "-", "true") for name in ("a.x", "a.y", "ab", "b")])
        self.assertEqual(self.fake.run("a", "b").passed, ["a.x", "a.y", "b"])
        self.assertEqual(self.fake.run().passed, ["a.x", "a.y", "ab", "b"])
        self.assertIn("there is no suite c", self.fake.run("c").text)

    def test_a_run_is_noted_with_the_commit_and_minutes_only_rise(self):
        self.fake.write([("a", "7", "-", "2026-01-01", "true"), ("b", "0.01", "-", "-", "sleep 1")])
        self.fake.run("a", "b")
        rows = rows_of(self.fake.table)
        self.assertRegex(rows["a"]["passed"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d( [0-9a-f]{8,})?$")
        self.assertEqual((rows["a"]["failed"], rows["a"]["minutes"], rows["b"]["minutes"]), ("2026-01-01", "7", "1"))


unittest.main()
