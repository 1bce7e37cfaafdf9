"""All mutants in one build: every mutated expression becomes a choice between what it was and what
each of its mutants makes of it, taken when the program runs (mutant.h)."""

import re
import subprocess
import sys

from sites import Finder, draw

AREAS = {
    "core/light": ["core/light/*integrator*.*", "core/light/ray_panels.*", "core/light/slabs.*",
                   "core/light/surface_lighting.*"],
    "forward scatter": ["core/passes/forward*.*", "core/passes/water_scatter.*",
                        "core/passes/mirrored_blur.*", "core/passes/spline_grid.*"],
    "camera": ["camera/*.*"],
    "media/light": ["media/light/*.*"],
    "phase functions": ["media/water/*phase*", "media/water/henyey_greenstein.*",
                        "media/water/fournier_forand.*", "core/light/medium.*"],
}
LAYERS = ["core", "media", "camera", "render", "edit", "dataset", "cli"]
HEADER = "tests/mutation/mutant.h"


def all_sites(root, seed):
    """Number of each mutant (from 1) -> its site, in the order drawn."""
    areas = {}
    for area, patterns in AREAS.items():
        files = sorted(path for pattern in patterns for path in root.glob(pattern)
                       if path.suffix in (".h", ".cpp"))
        areas[area] = [site for path in files for site in
                       Finder(path.relative_to(root).as_posix(), path.read_text()).find()]
    return dict(enumerate(draw(areas, seed), 1))


def area_of(site):
    return next((area for area in AREAS if site.file.startswith(area + "/")), "phase functions")


def mutated_text(text, sites):
    """A source with the mutants `sites` ({number: Site}) in it. Lines stay where they are."""
    edits = [(site.constexpr, site.constexpr + len("constexpr"), -1, None)
             for site in sites.values() if site.constexpr >= 0]
    by_range = {}
    for number, site in sites.items():
        by_range.setdefault((site.start, site.end, site.kind == "dropped statement"),
                            []).append((number, site))
    edits += [(start, end, dropped, group) for (start, end, dropped), group in by_range.items()]
    # From the outermost in; of equal ranges, statements first.
    edits = sorted(set((e[0], e[1], e[2]) for e in edits), key=lambda e: (e[0], -e[1], -e[2]))

    def render(start, end, inner):
        out, at = "", start
        while inner:
            first = inner[0]
            within = [e for e in inner[1:] if e[1] <= first[1] and e[0] < first[1]]
            inner = [e for e in inner[1:] if e[0] >= first[1]]
            out += text[at:first[0]]
            if first[2] == -1:
                out += "const"
            else:
                body = render(first[0], first[1], within)
                group = by_range[(first[0], first[1], bool(first[2]))]
                out += wrapped(body, group, bool(first[2]))
            at = first[1]
        return out + text[at:end]

    return f'#include "{HEADER}"\n#line 1\n' + render(0, len(text), edits)


def wrapped(body, group, statement):
    if statement:
        condition = " || ".join(f"uw::is_mutant({number})" for number, _ in group)
        return f"{{ if (!({condition})) {{ {body} }} }}"
    for number, site in sorted(group, key=lambda g: g[0]):
        body = f"(uw::is_mutant({number}) ? ({site.text}) : ({body}))"
    return body


class Build:
    """A copy of the sources, in which mutants are put, and its build. `tests`: a build of the same
    sources without mutants, the objects of whose tests are linked instead of compiled again; only
    where there are no mutants in headers."""

    def __init__(self, root, folder, jobs, tests=None):
        self.root, self.jobs = root, jobs
        self.tests = tests and tests.resolve()
        self.source, self.build = folder / "source", folder / "build"
        self.log = folder / "build.log"

    def copy(self):
        """Brings in what is in the working tree and known to git; mutated files keep their time if
        they stay the same."""
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others",
                                 "--exclude-standard"], cwd=self.root,
                                check=True, capture_output=True, text=True).stdout
        self.files = [name for name in listed.split("\0") if name and (self.root / name).is_file()]
        known = set(self.files)
        for top in {name.split("/")[0] for name in known}:
            for path in sorted((self.source / top).rglob("*")):
                if path.is_file() and path.relative_to(self.source).as_posix() not in known:
                    path.unlink()

    def put(self, sites):
        by_file = {}
        for number, site in sites.items():
            by_file.setdefault(site.file, {})[number] = site
        for name in self.files:
            here, there = self.root / name, self.source / name
            data = here.read_bytes()
            if name in by_file:
                data = mutated_text(data.decode(), by_file[name]).encode()
            if not there.is_file() or there.read_bytes() != data:
                there.parent.mkdir(parents=True, exist_ok=True)
                there.write_bytes(data)
                there.chmod(here.stat().st_mode)

    def configure(self):
        options = ["-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=12",
                   "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O2 -D_GLIBCXX_ASSERTIONS",
                   "-DUWVDB_WARNINGS_AS_ERRORS=ON", "-DUWVDB_BUILD_TESTS=ON"]
        subprocess.run(["cmake", "-G", "Ninja", "-S", self.source, "-B", self.build, *options],
                       check=True, stdout=subprocess.DEVNULL)

    def make(self):
        """Builds the programs of tests; returns what the compiler said if it failed."""
        targets = [f"tests_{layer}" for layer in LAYERS]
        if self.tests:
            targets = sorted({"uwvdb", *(word for target in targets
                                         for word in self.linking(self.build, target).split()
                                         if re.fullmatch(r"[^/].*\.a", word))})
        said = self.run(["ninja", "-k", "0", "-j", str(self.jobs), "uwvdb_failing_calls", *targets])
        if said is None and self.tests:
            said = self.link()
        return said

    def run(self, command):
        result = subprocess.run(command, cwd=self.build, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)
        self.log.write_text(result.stdout)
        return None if result.returncode == 0 else result.stdout

    @staticmethod
    def linking(build, target):
        """The command that links a program of tests."""
        said = subprocess.run(["ninja", "-C", build, "-t", "commands", target], check=True,
                              capture_output=True, text=True).stdout
        return said.splitlines()[-1]

    def link(self):
        """Links the programs of tests from the other build's objects and the mutated libraries."""
        programs = [f"tests_{layer}" for layer in LAYERS]
        said = self.run(["ninja", "-C", self.tests, *programs])
        for program in programs:
            if said is None:
                command = self.linking(self.tests, program)
                said = self.run(["sh", "-c", command.replace(
                    " tests/CMakeFiles/", f" {self.tests}/tests/CMakeFiles/")])
        return said

    def build_with(self, drawn, count, refused):
        """Puts in the first `count` mutants of those drawn that compile, and returns them; adds
        the others to `refused`."""
        self.copy()
        order, tried = list(drawn), count + count // 3
        while True:
            while len(set(order[:tried]) - refused) < count:
                tried += count // 3
            chosen = [n for n in order[:tried] if n not in refused]
            sites = {n: drawn[n] for n in chosen}
            self.put(sites)
            if not (self.build / "build.ninja").is_file():
                self.configure()
            print(f"building with {len(chosen)} mutants", flush=True)
            said = self.make()
            if said is None:
                return {n: drawn[n] for n in chosen[:count]}
            found = self.blamed(said, sites)
            if not found:
                sys.exit(f"the build fails; see {self.log}")
            print(f"{len(found)} of them do not compile", flush=True)
            refused |= found

    def blamed(self, said, sites):
        """The mutants on the lines of which the compiler found errors; else those that took a
        constexpr away in the files where it did."""
        found, files = set(), set()
        prefix = str(self.source.resolve()) + "/"
        for marks in (": error:|: fatal error:", ":"):
            for name, line in re.findall(rf"^(\S+?):(\d+):\d+(?:{marks})", said, re.MULTILINE):
                name = name.removeprefix(prefix)
                files.add(name)
                for number, site in sites.items():
                    if site.file == name and int(line) in self.lines(site):
                        found.add(number)
            if found:
                return found
        return {n for n, site in sites.items() if site.constexpr >= 0 and site.file in files}

    def lines(self, site):
        return site.lines((self.root / site.file).read_text())
