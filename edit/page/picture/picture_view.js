// The camera's picture: as large as its place allows, mixed from the lamps' planes, with the handles
// of the lamps, a kept snapshot beside it and the patch that contrast is measured in.

import { h, setText, svg } from "../base/dom.js";
import { oncePerFrame } from "../base/frame.js";
import { automaticStops } from "./exposure.js";
import { GraphicsMixer, hasGraphicsCard } from "./graphics_mixer.js";
import { LampHandles } from "./lamp_handles.js";
import { lampGains, LOOKS, mixOf } from "./mix.js";
import { PatchRectangle } from "./patch_rectangle.js";
import { PlainMixer } from "./plain_mixer.js";
import { SplitBar } from "./split_bar.js";

export class PictureView {
    #place;
    #scene;
    #settings;
    #mixer;
    #canvas;
    #overlay;
    #handles;
    #split;
    #patch;
    #note;
    #box;
    #image = null;
    #planes;
    #snapshot = null; // {image, planes, gains, revision}
    #factors = {}; // of brightness sliders that are being moved, by lamp name
    #medium = null; // what the water and its light were when the exposure was chosen
    #outdated = null; // {stops, revision}: the exposure until there is a picture of that revision
    #drawSoon;

    /** `actions` as those of LampHandles, but for redraw. */
    constructor(place, scene, settings, actions) {
        this.#place = place;
        this.#scene = scene;
        this.#settings = settings;
        this.#canvas = h("canvas", { role: "img", "aria-label": "The camera's picture" });
        this.#overlay = svg("svg", { class: "overlay" });
        this.#note = h("div", { class: "picture-note" });
        this.#box = h("div", { class: "picture-box" }, this.#canvas, this.#overlay, this.#note);
        place.append(this.#box);
        const Mixer = hasGraphicsCard() ? GraphicsMixer : PlainMixer;
        this.#mixer = new Mixer(this.#canvas);
        this.#planes = this.#mixer.newPlanes();
        this.#drawSoon = oncePerFrame(() => this.#draw());
        this.#patch = new PatchRectangle(this.#overlay, this.#box, settings);
        this.#handles = new LampHandles(this.#overlay,
            { ...actions, redraw: () => this.#drawSoon() });
        this.#split = new SplitBar(this.#box, settings);
        this.#listenToResets();
        new ResizeObserver(this.#drawSoon).observe(place);
        scene.observe((state) => this.#watchMedium(state));
        scene.observe(this.#drawSoon);
        settings.observe(this.#drawSoon);
    }

    get canvas() {
        return this.#canvas;
    }

    get image() {
        return this.#image;
    }

    get hasSnapshot() {
        return this.#snapshot !== null;
    }

    setImage(image) {
        this.#image = image;
        this.#planes.upload(image);
        this.#exposeIfDue();
        this.#drawSoon();
    }

    /** What pictures are seen through (ViewFeed). */
    setView(view) {
        this.#mixer.setView(view);
        this.#drawSoon();
    }

    /** Brightness as a slider has it that is being moved: mixed here, without the server. */
    setFactor(name, factor) {
        if (factor === null) delete this.#factors[name];
        else this.#factors[name] = factor;
        this.#drawSoon();
    }

    /** The patch in which the numbers at hand were measured [pixels of the image]. */
    showPatch(pixels) {
        this.#patch.showMeasured(pixels);
    }

    chooseExposure() {
        if (!this.#image) return;
        this.#settings.update({ stops: automaticStops(this.#image, this.#mix(this.#image)) });
    }


    /** Keeps the picture at hand for the split view. Exposure and layer apply to both. */
    keepSnapshot() {
        if (!this.#image) return;
        this.#snapshot?.planes.free();
        this.#snapshot = {
            image: this.#image, planes: this.#planes, gains: this.#gains(this.#image),
        };
        this.#planes = this.#mixer.newPlanes();
        this.#planes.upload(this.#image);
        this.#settings.update({ split: { ...this.#settings.value.split, on: true } });
    }

    dropSnapshot() {
        this.#snapshot?.planes.free();
        this.#snapshot = null;
        this.#settings.update({ split: { ...this.#settings.value.split, on: false } });
    }

    /** Other water, or more of its light, makes another picture: an exposure that suits the old one
        may show nothing of it. Lamps are compared at the same exposure. */
    #watchMedium({ revision, water, volumes, light }) {
        const medium = JSON.stringify([water, volumes.map((each) => each.concentrations), light]);
        if (this.#medium !== null && medium !== this.#medium) this.#exposeFrom(revision);
        this.#medium = medium;
    }

    /** Chooses the exposure anew for the picture of a revision, unless the user does before. */
    #exposeFrom(revision) {
        this.#outdated = { stops: this.#settings.value.stops, revision };
        this.#exposeIfDue();
    }

    #exposeIfDue() {
        // Of the first picture of all light most is still missing: another exposure suits the next.
        if (this.#outdated === null || !this.#image || this.#image.quality === "first" ||
            this.#image.revision < this.#outdated.revision) return;
        if (this.#settings.value.stops === this.#outdated.stops) this.#settings.update({ stops: null });
        this.#outdated = null;
    }

    #listenToResets() {
        this.#canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
        this.#canvas.addEventListener("webglcontextrestored", () => {
            this.#mixer.rebuild();
            this.#planes = this.#mixer.newPlanes();
            if (this.#image) this.#planes.upload(this.#image);
            if (this.#snapshot) {
                this.#snapshot.planes = this.#mixer.newPlanes();
                this.#snapshot.planes.upload(this.#snapshot.image);
            }
            this.#drawSoon();
        });
    }

    #gains(image) {
        const { solo } = this.#settings.value;
        return lampGains(image, this.#scene.value.lamps, { solo, factors: this.#factors });
    }

    #mix(image) {
        const { look, onlyLamp } = this.#settings.value;
        return mixOf(image, look, this.#gains(image), onlyLamp);
    }

    #fit() {
        const { width, height } = this.#scene.value.image;
        this.#place.style.setProperty("--picture-aspect", `${width} / ${height}`);
        const room = this.#place.getBoundingClientRect();
        const scale = Math.max(Math.min(room.width / width, room.height / height), 0.01);
        const shown = [Math.floor(width * scale), Math.floor(height * scale)];
        this.#box.style.width = `${shown[0]}px`;
        this.#box.style.height = `${shown[1]}px`;
        const pixels = shown.map((size) => Math.max(Math.round(size * devicePixelRatio), 1));
        if (this.#canvas.width !== pixels[0]) this.#canvas.width = pixels[0];
        if (this.#canvas.height !== pixels[1]) this.#canvas.height = pixels[1];
        this.#overlay.setAttribute("viewBox", `0 0 ${shown[0]} ${shown[1]}`);
        return scale;
    }

    #draw() {
        if (!this.#scene.value) return;
        const scale = this.#fit();
        const { look, onlyLamp, stops, split, selected } = this.#settings.value;
        this.#handles.update(this.#scene.value, selected, scale);
        this.#patch.update(this.#scene.value, scale);
        const splits = split.on && this.#snapshot !== null;
        this.#split.update(splits, split.at);
        this.#mixer.clear();
        setText(this.#note, this.#image ? "" : "The first picture is being computed…");
        if (!this.#image) return;
        if (stops === null) {
            this.chooseExposure();
            if (this.#image.quality === "first") this.#exposeFrom(this.#image.revision);
            return;
        }
        const from = splits ? split.at : 0;
        const options = {
            exposure: 2 ** stops, falseColour: LOOKS[look].falseColour ?? false,
        };
        if (splits) {
            const { image, planes, gains } = this.#snapshot;
            this.#mixer.draw(planes, mixOf(image, look, gains, onlyLamp),
                { ...options, from: 0, to: from });
        }
        this.#mixer.draw(this.#planes, this.#mix(this.#image), { ...options, from, to: 1 });
        performance.mark("picture", {
            detail: { revision: this.#image.revision, quality: this.#image.quality },
        });
    }
}
