#!/usr/bin/env python3
"""Measures the lamp editor in a real browser: how long a dragged lamp's picture takes, and what
memory does while lamps are dragged, on a machine without a graphics card.

    tests/bench/edit_latency.py build/release/cli/uwvdb assets/scenes/plume.yaml [--drags 100]
    tests/bench/edit_latency.py build/release/cli/uwvdb assets/scenes/plume.yaml --minutes 10

Times are in milliseconds from the pointer's movement, as the page receives it, to the end of the
frame that draws the picture; CPU time and memory are those of the server and of the page.
"""

import argparse
import pathlib
import statistics
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/edit/browser"))

from chromium import WITHOUT_GRAPHICS, Chromium  # noqa: E402
from editor import Editor, EditorPage  # noqa: E402

# When the pointer moved last, and when each quality was drawn first since then.
LISTENER = """
    window.measured = {};
    addEventListener('pointermove', (event) => {
        if (event.buttons) window.measured = { moved: event.timeStamp, revision: window.newest ?? -1 };
    }, true);
    new PerformanceObserver((list) => {
        for (const { startTime, detail } of list.getEntries()) {
            const { measured } = window;
            window.newest = Math.max(window.newest ?? -1, detail.revision);
            if (measured.moved === undefined || detail.revision <= measured.revision) continue;
            measured[detail.quality] ??= startTime - measured.moved;
            measured.first ??= startTime - measured.moved;
        }
    }).observe({ entryTypes: ['mark'] });
"""


def percentile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


def report(what, values):
    print(f"{what:28} median {statistics.median(values):7.1f}   "
          f"95 % {percentile(values, 0.95):7.1f}   most {max(values):7.1f}   of {len(values)}")


def measure_drags(view, lamp, drags):
    page = view.page
    page.evaluate(LISTENER)
    page.evaluate(f"window.newest = {view.state('revision')}")
    times = {"first": [], "draft": []}
    for drag in range(drags):
        start = view.handle(lamp)
        side = 1 if drag % 2 == 0 else -1
        page.mouse("mouseMoved", *start)
        page.mouse("mousePressed", *start, buttons=1)
        page.mouse("mouseMoved", start[0] + 30 * side, start[1] + 12 * side, buttons=1)
        page.wait("window.measured.first !== undefined && (window.measured.draft ?? "
                  "window.measured['full-draft'] ?? window.measured.final) !== undefined", 30)
        found = page.evaluate("window.measured")
        times["first"].append(found["first"])
        times["draft"].append(found.get("draft", found.get("full-draft", found.get("final"))))
        page.mouse("mouseReleased", start[0] + 30 * side, start[1] + 12 * side)
        view.settle()
        # The handle of a lamp at the rim leaves the pointer once the answer is drawn.
        page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    report("first picture", times["first"])
    report("480x270, draft", times["draft"])


def measure_frames(view):
    """How often a slider's movements are drawn, without the server."""
    page = view.page
    page.evaluate("window.drawn = []; new PerformanceObserver(l => window.drawn.push("
                  "...l.getEntries().map(e => e.startTime))).observe({entryTypes: ['mark']})")
    x, y, width, height = page.box('[data-key="brightness.slider"]')
    page.mouse("mousePressed", x + width / 2, y + height / 2, buttons=1)
    for step in range(120):
        page.mouse("mouseMoved", x + width / 2 + 30 * ((step % 40) / 20 - 1), y + height / 2,
                   buttons=1)
    page.mouse("mouseReleased", x + width / 2, y + height / 2)
    page.pump(0.3)
    drawn = page.evaluate("window.drawn")
    report("between frames, slider", [b - a for a, b in zip(drawn, drawn[1:])])


def measure_memory(view, editor, lamp, minutes):
    page = view.page
    page.command("Performance.enable")
    end, next_report = time.monotonic() + 60 * minutes, 0.0
    print("minute  server MB  page's JavaScript MB  server CPU s")
    begin = time.monotonic()
    while time.monotonic() < end:
        start = view.handle(lamp)
        page.drag(start, (start[0] + 40, start[1] + 20), steps=20)
        start = view.handle(lamp)
        page.drag(start, (start[0] - 40, start[1] - 20), steps=20)
        if time.monotonic() >= next_report:
            next_report = time.monotonic() + 30
            page.command("HeapProfiler.collectGarbage")
            metrics = {m["name"]: m["value"] for m in page.command("Performance.getMetrics")["metrics"]}
            print(f"{(time.monotonic() - begin) / 60:6.1f}  {editor.resident_bytes / 1e6:9.1f}  "
                  f"{metrics['JSHeapUsedSize'] / 1e6:20.1f}  {editor.cpu_seconds:12.1f}", flush=True)
    view.wait_final()
    before = editor.cpu_seconds
    page.pump(10)
    print(f"idle: {(editor.cpu_seconds - before) * 100:.0f} ms of the server's CPU per second of ten")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--lamp", default="far", help="the lamp to drag")
    parser.add_argument("--drags", type=int, default=100)
    parser.add_argument("--minutes", type=float, help="drag that long and watch the memory")
    arguments = parser.parse_args()
    editor = Editor(str(pathlib.Path(arguments.program).resolve()), file=arguments.scene.resolve())
    try:
        with Chromium(graphics=WITHOUT_GRAPHICS) as browser:
            view = EditorPage(browser, editor)
            view.wait_final()
            if arguments.minutes:
                measure_memory(view, editor, arguments.lamp, arguments.minutes)
            else:
                measure_drags(view, arguments.lamp, arguments.drags)
                measure_frames(view)
    finally:
        editor.close()


if __name__ == "__main__":
    main()
