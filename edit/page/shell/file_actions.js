// Save, save as, load again: with the questions that go with them.

import { ask, askText } from "./dialogs.js";

const CONFLICT = 409;

export class FileActions {
    #scene;
    #editing;
    #status;

    constructor(scene, editing, status) {
        this.#scene = scene;
        this.#editing = editing;
        this.#status = status;
        addEventListener("beforeunload", (event) => {
            if (scene.value?.unsaved) event.preventDefault();
        });
    }

    async save() {
        let overwrite = false;
        if (this.#scene.value.changed_on_disk) {
            overwrite = await ask("Save over the other changes?",
                `${this.#scene.value.scene} has changed on disk since it was read. Saving replaces ` +
                "what was written there since.",
                [{ label: "Cancel", value: false }, { label: "Save all the same", value: true }]);
            if (!overwrite) return;
        }
        if (await this.#editing.run("save", { overwrite })) {
            this.#status.say(`Saved ${this.#scene.value.scene}`);
        }
    }

    async saveAs() {
        const file = await askText("Save as", "File name, in the folder of the scene",
            this.#scene.value.scene, "Save");
        if (!file) return;
        const run = (overwrite, onRefusal) =>
            this.#editing.run("save_as", { file, overwrite }, onRefusal);
        let refusal = null;
        if (await run(false, (error) => { refusal = error; })) {
            this.#status.say(`Saved ${file}`);
            return;
        }
        if (refusal.status !== CONFLICT) {
            this.#status.refuse(refusal.message);
            return;
        }
        const overwrite = await ask("Replace the file?", `${file} exists already.`,
            [{ label: "Cancel", value: false }, { label: "Replace", value: true }]);
        if (overwrite && await run(true)) this.#status.say(`Saved ${file}`);
    }

    /** Takes what is on disk in place of what is shown. */
    async reload() {
        if (this.#scene.value.unsaved) {
            const sure = await ask("Drop the unsaved changes?",
                `What was changed here since ${this.#scene.value.scene} was saved is lost.`,
                [{ label: "Cancel", value: false }, { label: "Drop and load", value: true }]);
            if (!sure) return;
        }
        if (await this.#editing.run("reload")) this.#status.say("Loaded from disk");
    }
}
