"""What a user does in the lamp editor, done in a real browser. Run by ctest (edit.browser):

    python3 tests/edit/browser/editing_steps.py PROGRAM [--screenshots FOLDER] [test names]
"""

import json
import pathlib
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))

from chromium import Chromium  # noqa: E402
from editor import SCENE, Editor, EditorPage  # noqa: E402
from png import read_png  # noqa: E402

CTRL, SHIFT = 2, 8
# Redder than sRGB, and with another curve.
HOUSE = """\
ocio_profile_version: 2
roles: {default: lin, scene_linear: lin}
displays:
  monitor:
    - !<View> {name: Plain, colorspace: plain}
active_displays: []
active_views: []
colorspaces:
  - !<ColorSpace>
    name: lin
  - !<ColorSpace>
    name: plain
    from_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [0.7, 0.3, 0.2, 0, 0, 1, 0, 0, 0.1, 0.3, 0.4, 0, 0, 0, 0, 1]}
        - !<ExponentTransform> {value: [2, 2, 2, 1], direction: inverse}
"""


class EditingSteps(unittest.TestCase):
    program = None
    screenshots = None

    @classmethod
    def setUpClass(cls):
        cls.browser = Chromium()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()

    def setUp(self):
        self.editor = Editor(self.program)
        self.addCleanup(self.editor.close)
        self.view = EditorPage(self.browser, self.editor)
        self.page = self.view.page
        self.addCleanup(self.page.close)
        self.view.wait_final()

    def tearDown(self):
        if self.screenshots:
            self.page.screenshot(self.screenshots / f"{self._testMethodName}.png")
        self.assertEqual(self.page.complaints, [])

    def bright_column(self, picture):
        """Where along its width the picture is brightest, 0 to 1."""
        columns = 32
        width = picture.width / columns
        values = [picture.brightness(i * width, picture.height * 0.4, width, picture.height * 0.2)
                  for i in range(columns)]
        return (values.index(max(values)) + 0.5) / columns

    def assert_mixers_agree(self, looks):
        by_webgl = EditorPage(self.browser, self.editor, by_webgl=True)
        self.addCleanup(by_webgl.page.close)
        by_webgl.wait_final()
        is_webgl = "document.querySelector('.picture-box canvas').getContext('webgl2') !== null"
        self.assertFalse(self.page.evaluate(is_webgl))
        self.assertTrue(by_webgl.page.evaluate(is_webgl))
        for look in looks:
            pictures = []
            for view in (self.view, by_webgl):
                view.page.command("Page.bringToFront")
                view.page.click(f'[title="See {look}"]')
                view.page.evaluate("new Promise((done) => requestAnimationFrame(() => "
                                   "requestAnimationFrame(done)))")
                pictures.append(view.canvas())
            plain, graphics = pictures
            self.assertEqual((plain.width, plain.height), (graphics.width, graphics.height))
            self.assertGreater(graphics.brightness(), 5)
            differences = [abs(a - b) for p, g in zip(plain.planes, graphics.planes)
                           for a, b in zip(p, g)]
            # Enlarged, light is interpolated before or after it is turned into colours: a step of
            # light differs there.
            self.assertLess(sum(differences) / len(differences), 0.5, look)
            self.assertLess(sorted(differences)[int(0.99 * len(differences))], 8, look)
        self.assertEqual(by_webgl.page.complaints, [])
        self.page.command("Page.bringToFront")

    def assert_canvas_shows(self, rendered, slack):
        """At the exposure of a picture of `uwvdb render` the page shows it, to `slack` of 255."""
        exposure = float(rendered.texts["exposure"])
        self.page.evaluate("sessionStorage.setItem('uwvdb.settings', JSON.stringify({..."
                           "JSON.parse(sessionStorage.getItem('uwvdb.settings')), "
                           f"stops: Math.log2({exposure!r})}}))")
        self.view.open()
        self.view.wait_final()
        canvas = self.view.canvas()
        for y in range(10, 170, 9):
            for x in range(10, 310, 9):
                mixed = canvas.at((x + 0.5) / 320 * canvas.width, (y + 0.5) / 180 * canvas.height)
                near = [rendered.at(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
                for channel in range(3):
                    self.assertGreaterEqual(mixed[channel] + slack, min(n[channel] for n in near))
                    self.assertLessEqual(mixed[channel] - slack, max(n[channel] for n in near))

    def test_load(self):
        self.assertEqual(self.view.text(".scene-name"), "wall.yaml")
        names = self.page.evaluate(
            "[...document.querySelectorAll('.lamp-name')].map(e => e.textContent)")
        self.assertEqual(names, ["spot", "flood"])
        # The spot lights the wall before it, half a metre beyond its axis' handle.
        lit = self.bright_column(self.view.canvas())
        spot = self.view.lamp("spot")
        self.assertAlmostEqual(lit, spot["axis_handle"]["pixel"][0] / 320, delta=0.05)
        pixel = spot["handle"]["pixel"]
        x, y = self.view.handle("spot")
        left, top, width, height = self.page.box(".picture-box canvas")
        self.assertAlmostEqual((x - left) / width * 320, pixel[0], delta=0.5)
        self.assertAlmostEqual((y - top) / height * 180, pixel[1], delta=0.5)

    def test_drag_moves_the_light(self):
        before = self.view.canvas()
        spot = self.view.lamp("spot")
        self.view.drag("spot", -90 * self.view.scale, 0)
        self.view.wait_final()
        after = self.view.canvas()
        moved = self.view.lamp("spot")
        self.assertAlmostEqual(moved["handle"]["pixel"][0], spot["handle"]["pixel"][0] - 90, delta=1)
        self.assertAlmostEqual(moved["position"][2], spot["position"][2], delta=1e-3)
        # The wall is at 4 m, the lamp at 2.5 m: what it lights moves by so much less.
        self.assertAlmostEqual(self.bright_column(before) - self.bright_column(after),
                               90 / 320 * 2.5 / 4, delta=0.04)
        # One drag is one step.
        self.page.key("z", CTRL)
        self.view.wait_final()
        self.assertEqual(self.view.lamp("spot")["position"], spot["position"])
        self.assertFalse(self.view.state("can_undo"))
        self.assertEqual(self.view.canvas().planes, before.planes)
        self.page.key("z", CTRL | SHIFT)
        self.view.wait_final()
        self.assertEqual(self.view.lamp("spot")["position"], moved["position"])
        self.assertEqual(self.view.canvas().planes, after.planes)

    def test_drag_in_depth_and_axis(self):
        spot = self.view.lamp("spot")
        self.view.drag("spot", 0, -50, modifiers=SHIFT)
        self.view.wait_final()
        farther = self.view.lamp("spot")
        self.assertGreater(farther["position"][2], spot["position"][2] * 1.1)
        self.assertAlmostEqual(farther["handle"]["pixel"][0], spot["handle"]["pixel"][0], delta=0.5)
        self.view.drag("spot", -60 * self.view.scale, 0, kind="axis")
        self.view.wait_final()
        turned = self.view.lamp("spot")
        self.assertEqual(turned["position"], farther["position"])
        self.assertLess(turned["direction"][0], -0.05)

    def test_rim_handle(self):
        # A lamp beside the camera is outside the picture; its handle is on the side it lies on.
        x, _ = self.view.handle("flood")
        left, _, width, _ = self.page.box(".picture-box canvas")
        self.assertLess(x, left + width * 0.1)
        flood = self.view.lamp("flood")
        self.view.drag("flood", 60, 30)
        self.view.wait_final()
        moved = self.view.lamp("flood")
        self.assertGreater(moved["position"][0], flood["position"][0] + 0.05)
        self.assertGreater(moved["position"][1], flood["position"][1] + 0.02)
        self.assertAlmostEqual(moved["position"][2], flood["position"][2], delta=1e-6)

    def test_plan_view(self):
        self.page.click("#snap-tools .segments button:nth-child(2)")  # grid
        handle = '#plan-top .lamp-handle[aria-label^="Lamp spot"]'
        start = self.page.centre(handle)
        spot = self.view.lamp("spot")
        self.page.drag(start, (start[0] - 23, start[1] - 11))
        self.view.wait_final()
        moved = self.view.lamp("spot")
        self.assertLess(moved["world_position"][0], spot["world_position"][0] - 0.05)
        self.assertGreater(moved["world_position"][2], spot["world_position"][2] + 0.05)
        self.assertEqual(moved["world_position"][1], spot["world_position"][1])
        for k in (0, 2):
            steps = moved["world_position"][k] / 0.1
            self.assertAlmostEqual(steps, round(steps), places=6)

    def test_typed_number(self):
        field = '[data-key="position.0"]'
        self.page.type_into(field, "-0.6")
        self.view.wait_final()
        self.assertEqual(self.view.lamp("spot")["position"], [-0.6, 0, 2.5])
        self.assertLess(self.bright_column(self.view.canvas()), 0.45)
        # What makes no sense is refused in words, and changes nothing.
        revision = self.view.state("revision")
        self.page.type_into(field, "three")
        self.assertIn("no number", self.view.text("#lamp-form .field-message:not(:empty)"))
        self.page.type_into('[data-key="profile.beam"]', "-7")
        self.page.wait("[...document.querySelectorAll('#lamp-form .field-message')]"
                       ".some(e => e.textContent.includes('beam'))")
        self.assertEqual(self.view.state("revision"), revision)
        # The browser's console names the answer with status 422.
        self.page.complaints = [c for c in self.page.complaints if "422" not in c]

    def choose(self, key, value, form="#lamp-form"):
        """Chooses an entry of the form's list of that key."""
        self.page.evaluate(f"""(() => {{
            const list = document.querySelector('{form} select[data-key="{key}"]');
            list.value = {value!r};
            list.dispatchEvent(new Event('change'));
        }})()""")
        self.view.settle()

    def test_kind_and_unit(self):
        self.choose("type", "rectangle")
        extent = self.view.lamp("spot")["extent"]
        self.assertEqual([extent[key] for key in ("type", "width", "height")], ["rectangle", 0.2, 0.2])
        self.page.type_into('[data-key="width"]', "0.4")
        self.choose("type", "disk")
        extent = self.view.lamp("spot")["extent"]
        self.assertEqual((extent["type"], extent["radius"]), ("disk", 0.1))
        self.choose("type", "point")
        self.assertIsNone(self.view.lamp("spot")["extent"])
        # A sun shines the same way and, 2 m from where the lamp was, as brightly; back again.
        was = self.view.lamp("spot")
        self.choose("type", "sun")
        sun = self.view.lamp("spot")
        self.assertEqual((sun["profile"]["type"], sun["brightness"]["kind"]), ("sun", "irradiance"))
        for there, here in zip(was["band_intensity"], sun["band_intensity"]):
            self.assertAlmostEqual(here / (there / 4), 1, places=3)
        self.choose("type", "disk")
        lamp = self.view.lamp("spot")
        self.assertEqual((lamp["extent"]["type"], lamp["frame"], lamp["sun"]), ("disk", "world", None))
        for there, here in zip(was["band_intensity"], lamp["band_intensity"]):
            self.assertAlmostEqual(here / there, 1, places=3)
        for _ in range(2):
            self.page.click("button[title^=Undo]")
            self.view.settle()
        self.assertEqual(self.view.lamp("spot")["band_intensity"], was["band_intensity"])
        # As bright as it was, in other units.
        before = self.view.lamp("spot")
        self.choose("brightness.kind", "power")
        self.page.wait("document.querySelector('[data-key=\"brightness.0\"]').value !== '1'")
        after = self.view.lamp("spot")
        self.assertEqual(after["brightness"]["kind"], "power")
        for was, now in zip(before["band_intensity"], after["band_intensity"]):
            self.assertAlmostEqual(now / was, 1, places=3)

    def test_all_light_is_exposed_anew(self):
        self.page.wait("!document.querySelector('.light-note').hidden")
        shown = "[aria-label=\"Exposure in stops\"]"
        single = float(self.page.evaluate(f"document.querySelector('{shown}').value"))
        self.page.click(".light-note button")
        self.page.wait("document.querySelector('.light-note').hidden")
        self.view.settle()
        self.page.wait(f"{self.view.DRAWN}?.quality === 'final' && "
                       f"{self.view.DRAWN}.revision === {self.view.state('revision')}")
        self.assertLess(float(self.page.evaluate(f"document.querySelector('{shown}').value")), single)

    def test_other_water_is_exposed_anew(self):
        """Through other water the picture is as bright as it is when the page is opened with it."""
        bright = self.view.canvas().brightness()
        self.page.click("#tab-water")
        for step in (lambda: self.choose("water.preset", "jerlov-5C", "#water-form"),
                     lambda: self.page.key("z", CTRL)):
            step()
            self.view.wait_final()
            followed = self.view.canvas().brightness()
            self.assertGreater(followed, 0.5 * bright)
            self.page.key("a")
            self.page.pump(0.2)
            # The exposure was chosen from a small draft, in steps of a tenth of a stop (7 %).
            self.assertAlmostEqual(followed / self.view.canvas().brightness(), 1, delta=0.1)

    def test_layout_leaves_nothing_blank(self):
        parts = "#toolbar, #banners, #picture, #splitter, #plans, #side, #status"
        for width, height in ((390, 844), (768, 1024), (1280, 800)):
            self.page.resize(width, height, mobile=width < 1000)
            self.page.pump(0.3)
            if self.screenshots:
                self.page.screenshot(self.screenshots / f"test_layout_{width}.png")
            # The page is as wide as the window, which shows it at its size.
            self.assertEqual(self.page.evaluate(
                "[visualViewport.scale, innerWidth, document.documentElement.scrollWidth]"),
                [1, width, width])
            # Every spot of it, down to its end, belongs to one of its parts.
            blank = self.page.evaluate(f"""(() => {{
                const blank = [];
                const end = document.documentElement.scrollHeight;
                for (let top = 0; top < end; top += innerHeight) {{
                    scrollTo(0, top);
                    for (let y = 3; y < innerHeight; y += 23)
                        for (let x = 3; x < innerWidth; x += 23)
                            if (!document.elementFromPoint(x, y)?.closest('{parts}'))
                                blank.push([x, scrollY + y]);
                }}
                scrollTo(0, 0);
                return blank;
            }})()""")
            self.assertEqual(blank, [], width)
            # No control sticks out of the window, and the picture is as wide as its place.
            outside = self.page.evaluate(
                "[...document.querySelectorAll('button, input, select, summary')].filter(e => "
                "e.checkVisibility() && (e.getBoundingClientRect().right > innerWidth + 0.5 || "
                "e.getBoundingClientRect().left < -0.5)).map(e => e.outerHTML)")
            self.assertEqual(outside, [], width)
            _, _, *place = self.page.box("#picture")
            _, _, *box = self.page.box(".picture-box")
            self.assertGreater(max(box[0] / place[0], box[1] / place[1]), 0.97)
            self.assertGreater(box[0], 0.55 * width)

    def test_says_what_is_computed(self):
        """In words, whatever the picture is called in the API."""
        self.page.evaluate("""(() => {
            window.said = new Set();
            const place = document.querySelector('.status-stage');
            new MutationObserver(() => window.said.add(place.textContent))
                .observe(place, { childList: true, characterData: true, subtree: true });
        })()""")
        self.view.drag("spot", -40, 0)
        self.view.wait_final()
        said = [text for text in self.page.evaluate("[...window.said]") if text]
        self.assertIn("320×180, final picture", said)
        for text in said:
            self.assertRegex(
                text, r"^(computing: |\d+×\d+, )(small draft|draft|full-size draft|final picture)$")

    def test_slider_without_requests(self):
        before = self.view.canvas()
        slider = '[data-key="brightness.slider"]'
        x, y, width, height = self.page.box(slider)
        value = float(self.page.evaluate(f"document.querySelector('{slider}').value"))
        start = (x + 8 + value * (width - 16), y + height / 2)
        asked = len(self.page.requests)
        self.page.drag(start, (start[0] - width * 0.2, start[1]), steps=20, release=False)
        self.page.pump(0.3)
        darker = self.view.canvas()
        self.assertEqual(self.page.requests[asked:], [])
        self.assertLess(darker.brightness(),
                        0.8 * before.brightness())
        self.page.mouse("mouseReleased", start[0] - width * 0.2, start[1])
        self.view.settle()
        edits = [address for method, address in self.page.requests[asked:] if method == "POST"]
        self.assertEqual(len(edits), 1)
        self.assertLess(self.view.lamp("spot")["brightness"]["value"][0], 5)
        # What the browser mixed is what the server has.
        now = self.view.canvas()
        for mixed, exact in zip(darker.planes, now.planes):
            self.assertLessEqual(max(abs(a - b) for a, b in zip(mixed, exact)), 4)

    def test_exposure_without_requests(self):
        before = self.view.canvas()
        asked = len(self.page.requests)
        self.page.key("[")
        self.page.key("[")
        self.page.pump(0.2)
        darker = self.view.canvas()
        self.assertEqual(self.page.requests[asked:], [])
        self.assertLess(darker.brightness(),
                        0.95 * before.brightness())
        # It stays put while lamps change.
        stops = self.page.evaluate("document.querySelector('[aria-label=\"Exposure in stops\"]').value")
        self.page.click('.toggle.on[aria-label="Lamp spot on"]')
        self.view.settle()
        self.assertEqual(stops, self.page.evaluate(
            "document.querySelector('[aria-label=\"Exposure in stops\"]').value"))

    def test_solo_and_off(self):
        self.view.wait_final()
        together = self.view.canvas()
        self.page.click('.toggle.solo[aria-label="Only lamp spot"]')
        self.page.pump(0.2)
        alone = self.view.canvas()
        asked = len(self.page.requests)
        self.page.click('.toggle.solo[aria-label="Only lamp flood"]')
        self.page.pump(0.2)
        flood = self.view.canvas()
        self.page.click('.toggle.solo[aria-label="Only lamp flood"]')
        self.page.pump(0.2)
        self.assertEqual([r for r in self.page.requests[asked:] if r[0] == "POST"], [])
        self.assertEqual(self.view.canvas().planes, together.planes)
        area = (together.width * 0.05, together.height * 0.1, together.width * 0.2,
                together.height * 0.8)
        self.assertLess(alone.brightness(*area), 0.7 * together.brightness(*area))
        self.assertGreater(flood.brightness(*area), 0.9 * together.brightness(*area))
        # Off is part of the scene's state, solo is not; both look the same.
        self.page.click('.toggle.on[aria-label="Lamp flood on"]')
        self.page.wait("document.querySelector('.lamp-list .off')")
        self.page.pump(0.3)
        self.assertEqual(self.view.canvas().planes, alone.planes)
        self.assertFalse(self.view.lamp("flood")["on"])

    def test_snapshot(self):
        before = self.view.canvas()
        self.page.key("k")
        self.view.drag("spot", -90 * self.view.scale, 0)
        self.view.wait_final()
        split = self.view.canvas()
        self.page.key("v")
        self.page.pump(0.2)
        after = self.view.canvas()
        middle = split.width // 2
        for y in range(4, split.height - 40, 7):
            for x in range(4, middle - 12, 11):
                self.assertEqual(split.at(x, y), before.at(x, y))
            for x in range(middle + 12, split.width - 4, 11):
                self.assertEqual(split.at(x, y), after.at(x, y))

    def test_both_mixers_show_the_same(self):
        self.assert_mixers_agree(["total", "backscatter", "irradiance"])

    def test_through_a_view(self):
        """An OpenColorIO config with the scene: the page shows what `uwvdb render` writes."""
        before, revision = self.view.canvas(), self.view.state("revision")
        (self.editor.folder / "house.ocio").write_text(HOUSE)
        self.editor.scene.write_text(SCENE + "  view: {config: house.ocio}\n")
        # A scene without changes of its own is read anew.
        self.page.wait(f"{self.view.DRAWN}?.revision > {revision}")
        self.view.wait_final()
        self.assertEqual(self.view.state("view")["name"], "Plain / monitor")
        rendered = read_png(self.editor.render("viewed.exr"))
        shown = bytes(self.page.evaluate(
            "fetch('api/export/picture.png').then(r => r.arrayBuffer())"
            ".then(b => [...new Uint8Array(b)])"))
        self.assertEqual(read_png(shown).planes, rendered.planes)
        self.assertEqual(rendered.texts["view"], "Plain / monitor")
        self.assert_mixers_agree(["total"])
        # The page has a table of it, which is off by a step of 255 at most.
        self.assert_canvas_shows(rendered, 3)
        self.assertNotEqual(self.view.canvas().planes, before.planes)

    def test_suggest(self):
        self.page.click('.lamp-option:has(.swatch)')
        self.page.click('[title^="Search a place"]')
        self.page.type_into('dialog.suggest [data-key="samples"]', "12")
        self.page.click("dialog.suggest .dialog-buttons button:nth-child(1)")
        self.page.wait("!document.querySelector('dialog.suggest .dialog-buttons button:nth-child(3)')"
                       ".disabled", 30)
        said = self.view.text("dialog.suggest [role=status]")
        self.assertRegex(said, r"contrast of the target: [\d.]+ now, [\d.]+ at")
        self.assertTrue(self.page.evaluate(
            "document.querySelector('dialog.suggest .plot .mark.best') !== null"))
        if self.screenshots:
            self.page.screenshot(self.screenshots / "test_suggest_dialogue.png")
        before = self.view.lamp("spot")["position"]
        self.page.click("dialog.suggest .dialog-buttons button:nth-child(3)")
        self.page.wait("!document.querySelector('dialog.suggest').open")
        self.view.wait_final()
        self.assertNotEqual(self.view.lamp("spot")["position"], before)
        self.page.key("z", CTRL)
        self.view.wait_final()
        self.assertEqual(self.view.lamp("spot")["position"], before)
        self.assertFalse(self.view.state("can_undo"))

    def test_suggest_cancelled(self):
        self.page.click('[title^="Search a place"]')
        self.page.type_into('dialog.suggest [data-key="samples"]', "2000")
        self.page.click("dialog.suggest .dialog-buttons button:nth-child(1)")
        self.page.wait("document.querySelector('dialog.suggest progress').value > 0")
        self.page.click("dialog.suggest .dialog-buttons button:nth-child(2)")
        self.page.wait("document.querySelector('dialog.suggest [role=status]').textContent"
                       ".includes('Cancelled')", 3)
        self.assertFalse(self.view.state("can_undo"))

    def test_saved_file_renders_to_what_was_shown(self):
        self.view.drag("spot", -70 * self.view.scale, 20)
        self.view.wait_final()
        self.page.key("s", CTRL)
        self.page.wait("document.querySelector('.status-message').textContent.includes('Saved')")
        text = self.editor.scene.read_text()
        old, new = SCENE.splitlines(), text.splitlines()
        changed = [i for i, (a, b) in enumerate(zip(old, new)) if a != b]
        self.assertEqual(len(old), len(new))
        self.assertEqual(["position" in old[i] for i in changed], [True])
        # The picture of the scene as it was edited is, to the bit, that of the file.
        rendered = read_png(self.editor.render("saved.exr"))
        shown = bytes(self.page.evaluate(
            "fetch('api/export/picture.png').then(r => r.arrayBuffer())"
            ".then(b => [...new Uint8Array(b)])"))
        self.assertEqual(read_png(shown).planes, rendered.planes)
        exposure = float(rendered.texts["exposure"])
        # And so is what the page mixed of it, but for the rounding of half floats and the scaling.
        self.assert_canvas_shows(rendered, 2)

    def test_by_keyboard(self):
        self.page.evaluate("document.querySelector('[role=option]').focus()")
        self.page.key("m")
        self.page.wait("document.querySelectorAll('.lamp-list li').length === 3")
        self.view.settle()
        mirrored = self.view.state("lamps")[-1]
        self.assertAlmostEqual(mirrored["position"][0], -0.6, places=6)
        self.page.key("Delete")
        self.page.wait("document.querySelectorAll('.lamp-list li').length === 2")
        self.page.evaluate("document.querySelector('.picture-box .lamp-handle').focus()")
        before = self.view.lamp("spot")["handle"]["pixel"]
        for _ in range(3):
            self.page.key("ArrowLeft")
        self.view.settle()
        moved = self.view.lamp("spot")["handle"]["pixel"]
        self.assertAlmostEqual(before[0] - moved[0], 12 / self.view.scale, delta=0.3)
        # Each control can be reached, and says what it is.
        nameless = self.page.evaluate(
            "[...document.querySelectorAll('button, input, select, [tabindex]')].filter(e => "
            "e.checkVisibility() && !(e.getAttribute('aria-label') || e.textContent.trim() || "
            "e.labels?.length)).map(e => e.outerHTML)")
        self.assertEqual(nameless, [])

    def test_two_windows_and_reload(self):
        other = EditorPage(self.browser, self.editor)
        other.wait_final()
        self.page.type_into('[data-key="position.1"]', "0.4")
        other.page.wait("document.querySelector('[data-key=\"position.1\"]').value === '0.4'")
        other.page.close()
        self.page.click('[title="See irradiance"]')
        # The other window may know first.
        self.page.wait("![...document.querySelectorAll('button')]"
                       ".find(button => button.textContent === 'Save').disabled")
        self.view.open()
        self.assertEqual(self.page.questions, ["beforeunload"])  # for there are unsaved changes
        self.view.wait_final()
        self.assertTrue(self.page.evaluate(
            "document.querySelector('[title=\"See irradiance\"]').ariaPressed === 'true'"))
        self.assertEqual(self.view.lamp("spot")["position"][1], 0.4)

    def test_file_mended(self):
        self.editor.scene.write_text(SCENE.replace("beam: 40", "beam: forty"))
        self.page.wait("document.querySelector('[data-banner]')")
        said = self.view.text("[data-banner]")
        self.assertRegex(said, r"wall\.yaml.*")
        self.editor.scene.write_text(SCENE.replace("beam: 40", "beam: 50"))
        self.page.wait("document.querySelector('[data-key=\"profile.beam\"]').value === '50'")
        self.page.wait("document.querySelector('[data-banner]') === null")

    def test_file_deleted(self):
        self.editor.scene.unlink()
        self.page.wait("document.querySelector('[data-banner=deleted]')")
        self.page.click("[data-banner=deleted] button")
        self.page.wait("document.querySelector('[data-banner]') === null")
        self.assertEqual(self.editor.scene.read_text(), SCENE)

    def test_refused_for_another_window(self):
        # Another window has moved the lamp, and the news has not come here yet.
        self.page.evaluate("""(async () => {
            const { Editing } = await import('./page/server/editing.js');
            const { Observable } = await import('./page/base/observable.js');
            const state = await (await fetch('api/state')).json();
            const other = new Editing(new Observable(state), () => {}, () => {});
            await other.edit('move', [{ op: 'set', path: 'lamps.spot.position', value: [0, 0, 2] }]);
            const late = new Editing(new Observable(state),
                ({ status, message }) => { window.refusal = `${status} ${message}`; }, () => {});
            await late.edit('move', [{ op: 'set', path: 'lamps.spot.position', value: [1, 0, 2] }]);
        })()""")
        self.assertRegex(self.page.evaluate("window.refusal"), "^409 .*another window")
        self.page.complaints.clear()  # the console's own, of the answer 409
        # And what another window did is said here.
        self.page.wait("document.querySelector('.status-message').textContent.includes('elsewhere')")

    def test_text_grows_with_the_screen(self):
        def size():
            return float(self.page.evaluate(
                "getComputedStyle(document.querySelector('.lamp-name')).fontSize").rstrip("px"))
        self.page.resize(1280, 800)
        small = size()
        self.page.resize(3840, 2160)
        self.assertGreater(size(), 1.5 * small)

    def test_server_gone_and_back(self):
        self.editor.stop()
        self.page.wait("document.querySelector('[data-banner=server]')")
        self.assertIn("does not answer", self.view.text("[data-banner=server]"))
        self.page.complaints.clear()


def main():
    arguments = sys.argv[1:]
    EditingSteps.program = arguments.pop(0)
    if "--screenshots" in arguments:
        at = arguments.index("--screenshots")
        EditingSteps.screenshots = pathlib.Path(arguments[at + 1])
        EditingSteps.screenshots.mkdir(parents=True, exist_ok=True)
        del arguments[at:at + 2]
    unittest.main(argv=[sys.argv[0], *(f"EditingSteps.{name}" for name in arguments)])


if __name__ == "__main__":
    main()
