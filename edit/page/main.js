// Puts the page together: the scene as the server has it, what this window shows of it, and the views.

import { byId, h, setText } from "./base/dom.js";
import { hasPlace } from "./base/lamps.js";
import { Observable } from "./base/observable.js";
import { NumbersFeed } from "./numbers/numbers_feed.js";
import { NumbersPanel, patchPixels } from "./numbers/numbers_panel.js";
import { LampForm } from "./panels/lamp_form.js";
import { LampList } from "./panels/lamp_list.js";
import { WaterForm } from "./panels/water_form.js";
import { ViewFeed } from "./picture/display_view.js";
import { ImageFeed } from "./picture/image_feed.js";
import { PictureView } from "./picture/picture_view.js";
import { barAcross } from "./plan/bar_marks.js";
import { PlanView } from "./plan/plan_view.js";
import { makeSnapTools } from "./plan/snap_tools.js";
import { Editing, newGroup } from "./server/editing.js";
import { SceneFeed } from "./server/scene_feed.js";
import { Banners } from "./shell/banners.js";
import { connect } from "./shell/connection.js";
import { exportNumbers, exportPicture, exportShown } from "./shell/exports.js";
import { FileActions } from "./shell/file_actions.js";
import { listenToKeys, showKeys } from "./shell/keys.js";
import { makeSettings } from "./shell/settings.js";
import { makeSplitter } from "./shell/splitter.js";
import { StatusBar } from "./shell/status_bar.js";
import { makeTabs } from "./shell/tabs.js";
import { Toolbar } from "./shell/toolbar.js";
import { SuggestDialog } from "./suggest/suggest_dialog.js";

const scene = new Observable(null);
const outlines = new Observable([]);
const settings = makeSettings();
const status = new StatusBar(byId("status"));
const banners = new Banners(byId("banners"));
// Nothing fails in silence: a browser that lacks something, or a mistake of ours.
const fail = (message) =>
    banners.show("fault", `The page does not work: ${message}`, { kind: "error" });
addEventListener("error", (event) => event.message && fail(event.message));
addEventListener("unhandledrejection", (event) => fail(event.reason?.message ?? event.reason));
const CONFLICT = 409;
// The line at the bottom is missed by who looks at the lamp that another window has moved.
const refuse = (error) => {
    status.refuse(error.message);
    if (error.status === CONFLICT) {
        banners.show("conflict", `Not done: ${error.message}.`,
            { buttons: [{ label: "Hide", action: () => banners.show("conflict", null) }] });
    }
};
const editing = new Editing(scene, refuse,
    (isBusy) => { document.body.dataset.edits = isBusy ? "sent" : "answered"; });
const files = new FileActions(scene, editing, status);
const list = new LampList(byId("lamps"), scene, settings, editing);

const lampActions = {
    select: (lamp) => list.select(lamp),
    edit: (label, changes, options) => editing.edit(label, changes, options),
    settled: () => editing.settled(),
    newGroup,
};

const picture = new PictureView(byId("picture"), scene, settings, lampActions);
for (const view of ["top", "side", "front"]) {
    new PlanView(byId(`plan-${view}`), view, scene, outlines, settings, lampActions);
}
const lampForm = new LampForm(byId("lamp-form"), settings, editing, picture);
const waterForm = new WaterForm(byId("water-form"), editing);
const numbers = new NumbersPanel(byId("numbers"), settings);
const suggest = new SuggestDialog(scene, editing);
const numbersFeed = new NumbersFeed(settings, (found) => {
    numbers.show(found);
    picture.showPatch(patchPixels(found));
}, refuse);
const viewFeed = new ViewFeed(scene, (view) => picture.setView(view));
const imageFeed = new ImageFeed((image) => {
    picture.setImage(image);
    status.showImage(image);
    numbersFeed.fetch(image.quality);
});

const undo = async (path, label) => {
    const what = scene.value[label];
    if (await editing.run(path)) status.say(`${path === "undo" ? "Undone" : "Redone"}: ${what}`);
};
const actions = {
    save: () => files.save(),
    saveAs: () => files.saveAs(),
    reload: () => files.reload(),
    show: (what) => editing.run("show", what),
    undo: () => scene.value.can_undo && undo("undo", "undo_label"),
    redo: () => scene.value.can_redo && undo("redo", "redo_label"),
    chooseExposure: () => picture.chooseExposure(),
    keepSnapshot: () => {
        picture.keepSnapshot();
        numbers.keepSnapshot();
        toolbar.showSnapshot(picture.hasSnapshot);
    },
    exportNumbers: () => exportNumbers(scene.value, settings.value),
    exportPicture: () => exportPicture(scene.value, settings.value),
    exportShown: () => exportShown(scene.value, settings.value, picture.canvas),
    suggest: () => (list.chosen?.editable && hasPlace(list.chosen) ? suggest.open(list.chosen)
        : status.refuse("choose a lamp that may be moved")),
    help: showKeys,
    nextLamp: () => {
        const { lamps } = scene.value;
        list.select(lamps[(lamps.indexOf(list.chosen) + 1) % lamps.length]);
    },
    toggleOn: () => list.toggleOn(),
    toggleSolo: () => list.toggleSolo(),
    duplicate: () => list.duplicate(),
    mirror: () => list.mirror(),
    remove: () => list.remove(),
};
const toolbar = new Toolbar(byId("toolbar"), scene, settings, actions);
toolbar.showSnapshot(false);
makeTabs(byId("tabs"), settings);
makeSplitter(byId("splitter"), byId("views"), settings);
makeSnapTools(byId("snap-tools"), settings);
listenToKeys(settings, actions);

const showForms = () => {
    if (!scene.value) return;
    if (settings.value.bar === null) {
        settings.update({ bar: barAcross(scene.value.camera) });
        return;
    }
    lampForm.update(scene.value, list.chosen);
    waterForm.update(scene.value);
};
scene.observe(showForms);
settings.observe(showForms);
const showState = ({ error, changed_on_disk: changed, deleted_on_disk: deleted, scene: name }) => {
    const last = scene.value ? " The last good state is shown." : "";
    banners.show("error", error && `${error.message} – the page goes on when this is mended.${last}`,
        { kind: "error" });
    banners.show("changed", changed && !error ? `${name} has changed on disk since it was read.` : null,
        { buttons: [{ label: "Load it", action: () => files.reload() }] });
    banners.show("deleted", deleted ? `${name} was deleted, or has another name now. Saving writes ` +
        "it again." : null, { buttons: [{ label: "Save", action: () => files.save() }] });
};
const lightNote = h("span", { class: "light-note-text" });
const allLight = h("button", { type: "button",
    title: "Sets render.scattering to multiple, which takes longer",
    onclick: () => editing.edit("render all light",
        [{ op: "set", path: "render.scattering", value: "multiple" }]) }, "All light");
const lightBox = h("div", { class: "light-note", role: "note", hidden: true }, lightNote, allLight);
byId("snap-tools").append(lightBox);
const showLightNote = ({ light_note: note }) => {
    setText(lightNote, note ? `Note: ${note}.` : "");
    lightNote.title = note ?? "";
    lightBox.hidden = !note;
};
let shownRevision = null;
scene.observe((state) => {
    // What was said before is about another scene.
    if (shownRevision !== null && shownRevision !== state.revision) status.sayNothing();
    shownRevision = state.revision;
    showState(state);
    showLightNote(state);
    byId("not-shown").replaceChildren(...state.not_shown.map((text) => h("li", {}, text)));
    byId("not-shown").hidden = state.not_shown.length === 0;
    byId("warnings").replaceChildren(...state.warnings.map((text) => h("li", {}, text)));
    byId("warnings-box").hidden = state.warnings.length === 0;
});

const sceneFeed = new SceneFeed(scene, outlines, editing, showState,
    ({ undo_label: what }) => status.say(`Changed elsewhere${what ? `: ${what}` : ""}`));
connect({ sceneFeed, imageFeed, viewFeed, status, banners, suggest, refuse });
